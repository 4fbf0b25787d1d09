// SPDX-License-Identifier: GPL-3.0-or-later
#include "jit/lane_encode.hpp"

#include <algorithm>
#include <stdexcept>

#include "jit/assembler.hpp"
#include "jit/kernels.hpp"

namespace eomgen::jit {
namespace {

using asmjit::Label;
namespace x86 = asmjit::x86;

// Registers that calls preserve hold the arguments.
const x86::Gp lane_state = x86::rbx, lane_parameters = x86::rbp, lane_prepared = x86::r12, lane_inputs = x86::r13,
              lane_numbers = x86::r14, lane_arguments = x86::r15, lane_result = x86::rax;

constexpr std::int32_t lane_bytes = lane_width * sizeof(double);

/// Predicates of vcmppd. All are false for NaN but `not_above` and `unordered`.
enum Predicate : std::uint32_t {
  equal = 0x00,
  unordered = 0x03,
  below = 0x11,
  not_above = 0x1a,
  above_or_equal = 0x1d,
  above = 0x1e
};

std::int32_t lane_offset(std::size_t index) { return array_offset(index, lane_bytes); }

class LaneBody {
 public:
  LaneBody(x86::Assembler& to, const FunctionSteps& steps, const double* constants)
      : a_(to),
        function_(steps),
        constants_(constants),
        sign_mask_(to.newLabel()),
        value_mask_(to.newLabel()),
        ones_(to.newLabel()),
        leave_(to.newLabel()) {}

  void write() {
    enter();
    for (const Step& step : function_.steps) write(step);
    test_finite();
    a_.xor_(x86::eax, x86::eax);
    a_.bind(leave_);
    a_.vzeroupper();
    a_.add(x86::rsp, frame_);
    for (const x86::Gp& reg : {lane_arguments, lane_numbers, lane_inputs, lane_prepared, lane_parameters, lane_state})
      a_.pop(reg);
    a_.ret();
    embed_numbers<lane_width>(a_, sign_mask_, 0x8000000000000000u);
    embed_numbers<lane_width>(a_, value_mask_, 0x7fffffffffffffffu);
    embed_numbers<lane_width>(a_, ones_, 0x3ff0000000000000u);
  }

 private:
  void enter() {
    for (const x86::Gp& reg : {lane_state, lane_parameters, lane_prepared, lane_inputs, lane_numbers, lane_arguments})
      a_.push(reg);
    // The scratch array, then a register that gave way, a value, and two arguments of a call. Calls need 16 bytes'
    // alignment: the return address and six registers are on the stack.
    saved_ = function_.scratch_size;
    frame_ = lane_offset(saved_ + 4) + 8;
    make_frame(a_, frame_);
    a_.mov(lane_arguments, x86::rdi);
    const auto argument = [&](const x86::Gp& reg, std::size_t offset) {
      a_.mov(reg, x86::ptr(lane_arguments, static_cast<std::int32_t>(offset)));
    };
    argument(lane_state, offsetof(LaneArguments, state));
    argument(lane_parameters, offsetof(LaneArguments, parameters));
    argument(lane_prepared, offsetof(LaneArguments, prepared));
    argument(lane_inputs, offsetof(LaneArguments, inputs));
    a_.mov(lane_numbers, reinterpret_cast<std::uint64_t>(constants_));
    if (function_.reads_time) {
      argument(x86::rax, offsetof(LaneArguments, t));
      a_.vmovupd(x86::ymm0, x86::ymmword_ptr(x86::rax));
      a_.vmovupd(scratch(function_.time), x86::ymm0);
    }
    for (const ModeValue& value : function_.mode_values) {
      if (value.is_side) {
        a_.vxorpd(x86::ymm0, x86::ymm0, x86::ymm0);
      } else {
        a_.mov(x86::rax, reinterpret_cast<std::uint64_t>(contact_signs(value.index % 2)));
        a_.vbroadcastsd(x86::ymm0, x86::qword_ptr(x86::rax));
      }
      a_.vmovupd(scratch(value.scratch), x86::ymm0);
    }
  }

  x86::Mem scratch(std::size_t index) const { return x86::ymmword_ptr(x86::rsp, lane_offset(index)); }
  x86::Mem memory(const Location& location) const {
    const std::int32_t offset = lane_offset(location.index);
    switch (location.place) {
      case Place::scratch: return scratch(location.index);
      case Place::state: return x86::ymmword_ptr(lane_state, offset);
      case Place::parameter: return x86::ymmword_ptr(lane_parameters, offset);
      case Place::prepared: return x86::ymmword_ptr(lane_prepared, offset);
      case Place::input: return x86::ymmword_ptr(lane_inputs, offset);
      case Place::constant: return x86::ymmword_ptr(lane_numbers, offset);
      case Place::result: return x86::ymmword_ptr(lane_result, offset);
      case Place::register_: break;
    }
    throw std::logic_error("a register is no memory");
  }

  /// operation(source) with the source in a register or in memory.
  void apply(auto&& operation, const Location& source) {
    if (source.place == Place::register_)
      operation(x86::ymm(source.index));
    else
      operation(memory(source));
  }

  void call(const void* function) {
    a_.mov(x86::rax, reinterpret_cast<std::uint64_t>(function));
    a_.call(x86::rax);
  }

  void write(const Step& step) {
    const x86::Ymm target = x86::ymm(step.target);
    switch (step.action) {
      case Action::load: return load(step);
      case Action::store: a_.vmovupd(memory(step.source), target); return;
      case Action::add: return apply([&](auto s) { a_.vaddpd(target, target, s); }, step.source);
      case Action::subtract: return apply([&](auto s) { a_.vsubpd(target, target, s); }, step.source);
      case Action::multiply: return apply([&](auto s) { a_.vmulpd(target, target, s); }, step.source);
      case Action::divide: return apply([&](auto s) { a_.vdivpd(target, target, s); }, step.source);
      case Action::least: return apply([&](auto s) { a_.vminpd(target, target, s); }, step.source);
      case Action::greatest: return apply([&](auto s) { a_.vmaxpd(target, target, s); }, step.source);
      case Action::root: return apply([&](auto s) { a_.vsqrtpd(target, s); }, step.source);
      case Action::negate: a_.vxorpd(target, target, x86::ymmword_ptr(sign_mask_)); return;
      case Action::absolute: a_.vandpd(target, target, x86::ymmword_ptr(value_mask_)); return;
      case Action::sign: return sign(step.target);
      case Action::add_sign: {
        const x86::Ymm source = x86::ymm(step.source.index);
        a_.vandpd(source, source, x86::ymmword_ptr(sign_mask_));
        a_.vxorpd(target, target, source);
        return;
      }
      case Action::compare: compared_ = step; return;
      case Action::load_unless_above: return load_unless_above(step);
      case Action::return_if_above: return return_if(above);
      case Action::return_if_above_or_equal: return return_if(above_or_equal);
      case Action::return_if_equal: return return_if(equal);
      case Action::call: return call_for_each(library_function(static_cast<Library>(step.extra)));
      case Action::sincos_group:  // the angles of all lanes follow one another, and so do their sines and cosines
        a_.vzeroupper();
        a_.lea(x86::rdi, memory(step.source));
        a_.mov(x86::esi, static_cast<std::uint32_t>(step.extra * lane_width));
        call(reinterpret_cast<const void*>(wide_sincos_group()));
        return;
      case Action::begin_result:
        if (step.extra != 0) throw std::logic_error("a function of lanes has one result");
        a_.mov(lane_result, x86::ptr(lane_arguments, static_cast<std::int32_t>(offsetof(LaneArguments, result))));
        return;
      case Action::end_result: return;
    }
  }

  void load(const Step& step) {
    if (step.source.place != Place::register_ || step.source.index != step.target)
      apply([&](auto s) { a_.vmovupd(x86::ymm(step.target), s); }, step.source);
  }

  /// A register that none of these is; its value is in the frame until restore().
  x86::Ymm give_way(std::initializer_list<std::uint32_t> used) {
    std::uint32_t k = 0;
    while (std::find(used.begin(), used.end(), k) != used.end()) ++k;
    a_.vmovupd(scratch(saved_), x86::ymm(k));
    return x86::ymm(k);
  }
  void restore(const x86::Ymm& reg) { a_.vmovupd(reg, scratch(saved_)); }  // keeps the flags
  static std::uint32_t register_of(const Location& location) {
    return location.place == Place::register_ ? location.index : static_cast<std::uint32_t>(register_count);
  }
  void compare(const x86::Ymm& mask, Predicate predicate) {
    apply([&](auto s) { a_.vcmppd(mask, x86::ymm(compared_.target), s, predicate); }, compared_.source);
  }

  void return_if(Predicate predicate) {
    const x86::Ymm mask = give_way({compared_.target, register_of(compared_.source)});
    const Label past = a_.newLabel();
    compare(mask, predicate);
    a_.vptest(mask, mask);
    restore(mask);
    a_.jz(past);
    a_.mov(x86::eax, 1);
    a_.jmp(leave_);
    a_.bind(past);
  }

  void load_unless_above(const Step& step) {
    const x86::Ymm target = x86::ymm(step.target);
    const x86::Ymm mask =
        give_way({compared_.target, register_of(compared_.source), step.target, register_of(step.source)});
    compare(mask, not_above);
    apply([&](auto s) { a_.vblendvpd(target, target, s, mask); }, step.source);
    restore(mask);
  }

  /// 1 above 0, -1 below, else 0, also for NaN.
  void sign(std::uint32_t target) {
    const x86::Ymm value = x86::ymm(target), other = give_way({target});
    a_.vxorpd(other, other, other);
    a_.vcmppd(other, other, value, below);
    a_.vandpd(other, other, x86::ymmword_ptr(ones_));
    a_.vmovupd(scratch(saved_ + 1), other);
    a_.vxorpd(other, other, other);
    a_.vcmppd(other, value, other, below);
    a_.vandpd(other, other, x86::ymmword_ptr(ones_));
    a_.vmovupd(value, scratch(saved_ + 1));
    a_.vsubpd(value, value, other);
    restore(other);
  }

  /// The registers 0 and 1 are the arguments; no other has a value.
  void call_for_each(const void* function) {
    const std::int32_t first = lane_offset(saved_ + 2), second = first + lane_bytes;
    a_.vmovupd(scratch(saved_ + 2), x86::ymm0);
    a_.vmovupd(scratch(saved_ + 3), x86::ymm1);
    a_.vzeroupper();
    for (std::int32_t lane = 0; lane < lane_bytes; lane += static_cast<std::int32_t>(sizeof(double))) {
      a_.movsd(x86::xmm0, x86::qword_ptr(x86::rsp, first + lane));
      a_.movsd(x86::xmm1, x86::qword_ptr(x86::rsp, second + lane));
      call(function);
      a_.movsd(x86::qword_ptr(x86::rsp, first + lane), x86::xmm0);
    }
    a_.vmovupd(x86::ymm0, scratch(saved_ + 2));
  }

  void test_finite() {
    if (function_.finite_to <= function_.finite_from) return;
    a_.mov(lane_result, x86::ptr(lane_arguments, static_cast<std::int32_t>(offsetof(LaneArguments, result))));
    a_.vmovupd(x86::ymm0, memory({Place::result, function_.finite_from}));
    for (std::uint32_t i = function_.finite_from + 1; i < function_.finite_to; ++i)
      a_.vaddpd(x86::ymm0, x86::ymm0, memory({Place::result, i}));
    // inf - inf and nan - nan are nan
    a_.vsubpd(x86::ymm0, x86::ymm0, x86::ymm0);
    compared_ = {Action::compare, 0, {Place::register_, 0}, 0};
    return_if(unordered);
  }

  x86::Assembler& a_;
  const FunctionSteps& function_;
  const double* constants_;
  Label sign_mask_, value_mask_, ones_, leave_;
  Step compared_;
  std::size_t saved_ = 0;
  std::int32_t frame_ = 0;
};

}  // namespace

bool has_lanes() { return asmjit::CpuInfo::host().features().x86().hasAVX2(); }

std::unique_ptr<ExecutableMemory> encode_lanes(const FunctionSteps& steps, const double* constants) {
  AssemblyFailure failure;
  asmjit::CodeHolder code;
  require(code.init(asmjit::Environment::host()));
  code.setErrorHandler(&failure);
  x86::Assembler to(&code);
  LaneBody(to, steps, constants).write();
  return executable(code);
}

}  // namespace eomgen::jit

// SPDX-License-Identifier: GPL-3.0-or-later
#include "jit/encode.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>
#include <stdexcept>

#include "jit/assembler.hpp"
#include "jit/kernels.hpp"

namespace eomgen::jit {
namespace {

using asmjit::Label;
namespace x86 = asmjit::x86;

// Registers that calls preserve hold the arguments.
const x86::Gp state = x86::rbx, parameters = x86::rbp, prepared = x86::r12, inputs = x86::r13, numbers = x86::r14,
              result = x86::rax;

constexpr std::size_t argument_registers = 6, saved_registers = 5, most_results = 3;

x86::Gp argument_register(std::size_t k) {
  const std::array<x86::Gp, argument_registers> order{x86::rdi, x86::rsi, x86::rdx, x86::rcx, x86::r8, x86::r9};
  return order.at(k);
}

bool is_integer(abi::Input input) { return input != abi::Input::time; }

std::int32_t offset_of(std::size_t index) { return array_offset(index, sizeof(double)); }

/// One function.
class Body {
 public:
  Body(x86::Assembler& to, const FunctionSteps& steps, const double* constants, const double* default_inputs,
       const Label& sign_mask, const Label& value_mask)
      : a_(to),
        function_(steps),
        constants_(constants),
        default_inputs_(default_inputs),
        sign_mask_(sign_mask),
        value_mask_(value_mask),
        leave_(to.newLabel()) {}

  void write() {
    enter();
    for (const Step& step : function_.steps) write(step);
    test_finite();
    a_.xor_(x86::eax, x86::eax);
    a_.bind(leave_);
    a_.add(x86::rsp, frame_);
    for (const x86::Gp& reg : {numbers, inputs, prepared, parameters, state}) a_.pop(reg);
    a_.ret();
  }

 private:
  void enter() {
    for (const x86::Gp& reg : {state, parameters, prepared, inputs, numbers}) a_.push(reg);
    // The scratch array, then the pointers to the results. Calls need 16 bytes' alignment: the return address and five
    // registers are on the stack.
    result_pointers_ = function_.scratch_size;
    frame_ = offset_of((result_pointers_ + most_results + 1) / 2 * 2);
    make_frame(a_, frame_);
    std::size_t k = 0;
    x86::Gp mode = x86::rax;
    bool has_mode = false;
    for (const abi::Input input : function_.inputs) {
      if (!is_integer(input)) continue;
      const x86::Gp from = argument_register(k++);
      switch (input) {
        case abi::Input::state: a_.mov(state, from); break;
        case abi::Input::parameters: a_.mov(parameters, from); break;
        case abi::Input::prepared:
        case abi::Input::state_vector:
        case abi::Input::state_vectors:
        case abi::Input::accelerations: a_.mov(prepared, from); break;  // no function takes both
        case abi::Input::inputs: a_.mov(inputs, from); break;
        case abi::Input::mode:
          mode = from;
          has_mode = true;
          break;
        default: throw std::logic_error("this argument has no machine code");
      }
      if (input != abi::Input::inputs) continue;
      a_.mov(x86::rax, reinterpret_cast<std::uint64_t>(default_inputs_));
      a_.test(inputs, inputs);
      a_.cmovz(inputs, x86::rax);
    }
    for (std::size_t r = 0; r < function_.may_be_null.size(); ++r, ++k) {
      x86::Gp from = x86::rax;
      if (k < argument_registers)
        from = argument_register(k);
      else
        a_.mov(from, stack_argument(k));
      a_.mov(x86::ptr(x86::rsp, offset_of(result_pointers_ + r)), from);
    }
    a_.mov(numbers, reinterpret_cast<std::uint64_t>(constants_));
    if (function_.reads_time) a_.movsd(x86::ptr(x86::rsp, offset_of(function_.time)), x86::xmm0);
    if (!function_.mode_values.empty()) load_mode(has_mode ? std::optional(mode) : std::nullopt);
  }

  /// The seventh argument and further ones are above the frame, the saved registers and the return address.
  x86::Mem stack_argument(std::size_t k) const {
    return x86::ptr(x86::rsp, frame_ + offset_of(saved_registers + 1 + k - argument_registers));
  }

  /// Stores the values that `mode` determines. Without it, or if it is null, all entries are 0.
  void load_mode(const std::optional<x86::Gp>& mode) {
    const Label zeros = a_.newLabel(), end = a_.newLabel();
    if (mode) {
      a_.test(*mode, *mode);
      a_.jz(zeros);
      for (const ModeValue& value : function_.mode_values) {
        const auto entry = x86::dword_ptr(*mode, static_cast<std::int32_t>(4 * value.entry));
        if (value.is_side) {
          a_.cvtsi2sd(x86::xmm1, entry);
        } else {
          a_.mov(x86::eax, entry);
          a_.and_(x86::eax, contact_state_mask);
          a_.mov(x86::r10, reinterpret_cast<std::uint64_t>(contact_signs(value.index % 2)));
          a_.movsd(x86::xmm1, x86::qword_ptr(x86::r10, x86::rax, 3));
        }
        a_.movsd(x86::ptr(x86::rsp, offset_of(value.scratch)), x86::xmm1);
      }
      a_.jmp(end);
    }
    a_.bind(zeros);
    for (const ModeValue& value : function_.mode_values) {
      if (value.is_side) {
        a_.xorps(x86::xmm1, x86::xmm1);
      } else {
        a_.mov(x86::r10, reinterpret_cast<std::uint64_t>(contact_signs(value.index % 2)));
        a_.movsd(x86::xmm1, x86::qword_ptr(x86::r10));
      }
      a_.movsd(x86::ptr(x86::rsp, offset_of(value.scratch)), x86::xmm1);
    }
    a_.bind(end);
  }

  void call(const void* function) {
    a_.mov(x86::rax, reinterpret_cast<std::uint64_t>(function));
    a_.call(x86::rax);
  }

  x86::Mem memory(const Location& location) const {
    const std::int32_t offset = offset_of(location.index);
    switch (location.place) {
      case Place::scratch: return x86::qword_ptr(x86::rsp, offset);
      case Place::state: return x86::qword_ptr(state, offset);
      case Place::parameter: return x86::qword_ptr(parameters, offset);
      case Place::prepared: return x86::qword_ptr(prepared, offset);
      case Place::input: return x86::qword_ptr(inputs, offset);
      case Place::constant: return x86::qword_ptr(numbers, offset);
      case Place::result: return x86::qword_ptr(result, offset);
      case Place::register_: break;
    }
    throw std::logic_error("a register is no memory");
  }

  /// operation(target, source) with the source in a register or in memory.
  void apply(auto&& operation, const Step& step) {
    const x86::Xmm target = x86::xmm(step.target);
    if (step.source.place == Place::register_)
      operation(target, x86::xmm(step.source.index));
    else
      operation(target, memory(step.source));
  }

  void return_if(auto&& jump_past, std::uint32_t code) {
    const Label past = a_.newLabel();
    jump_past(past);
    a_.mov(x86::eax, code);
    a_.jmp(leave_);
    a_.bind(past);
  }

  void write(const Step& step) {
    const x86::Xmm target = x86::xmm(step.target);
    switch (step.action) {
      case Action::load: return load(step);
      case Action::store: a_.movsd(memory(step.source), target); return;
      case Action::add: return apply([&](auto t, auto s) { a_.addsd(t, s); }, step);
      case Action::subtract: return apply([&](auto t, auto s) { a_.subsd(t, s); }, step);
      case Action::multiply: return apply([&](auto t, auto s) { a_.mulsd(t, s); }, step);
      case Action::divide: return apply([&](auto t, auto s) { a_.divsd(t, s); }, step);
      case Action::least: return apply([&](auto t, auto s) { a_.minsd(t, s); }, step);
      case Action::greatest: return apply([&](auto t, auto s) { a_.maxsd(t, s); }, step);
      case Action::root: return apply([&](auto t, auto s) { a_.sqrtsd(t, s); }, step);
      case Action::negate: a_.xorpd(target, x86::ptr(sign_mask_)); return;
      case Action::absolute: a_.andpd(target, x86::ptr(value_mask_)); return;
      case Action::sign: return sign(target);
      case Action::add_sign:
        a_.andpd(x86::xmm(step.source.index), x86::ptr(sign_mask_));
        a_.xorpd(target, x86::xmm(step.source.index));
        return;
      case Action::compare: return apply([&](auto t, auto s) { a_.comisd(t, s); }, step);
      case Action::load_unless_above: {
        const Label past = a_.newLabel();
        a_.ja(past);
        load(step);
        a_.bind(past);
        return;
      }
      // Comparisons with a NaN set the carry flag, as "below" does, and the flags of equality and parity.
      case Action::return_if_above: return return_if([&](const Label& past) { a_.jbe(past); }, step.extra);
      case Action::return_if_above_or_equal: return return_if([&](const Label& past) { a_.jb(past); }, step.extra);
      case Action::return_if_equal:
        return return_if(
            [&](const Label& past) {
              a_.jne(past);
              a_.jp(past);
            },
            step.extra);
      case Action::call: call(library_function(static_cast<Library>(step.extra))); return;
      case Action::sincos_group:
        a_.lea(x86::rdi, memory(step.source));
        a_.mov(x86::esi, step.extra);
        call(reinterpret_cast<const void*>(sincos_group()));
        return;
      case Action::begin_result:
        a_.mov(result, x86::ptr(x86::rsp, offset_of(result_pointers_ + step.extra)));
        after_result_ = a_.newLabel();
        if (!function_.may_be_null.at(step.extra)) return;
        a_.test(result, result);
        a_.jz(after_result_);
        return;
      case Action::end_result: a_.bind(after_result_); return;
    }
  }

  void load(const Step& step) {
    const x86::Xmm target = x86::xmm(step.target);
    if (step.source.place != Place::register_)
      a_.movsd(target, memory(step.source));
    else if (step.source.index != step.target)
      a_.movapd(target, x86::xmm(step.source.index));
  }

  /// 1 above 0, -1 below, else 0, also for NaN.
  void sign(const x86::Xmm& value) {
    const Label done = a_.newLabel();
    a_.sub(x86::rsp, 16);
    a_.movsd(x86::ptr(x86::rsp), value);
    a_.xorpd(value, value);
    a_.comisd(value, x86::ptr(x86::rsp));  // 0 with the value
    a_.jp(done);
    a_.je(done);
    a_.mov(x86::eax, 1);
    a_.mov(x86::ecx, -1);
    a_.cmova(x86::eax, x86::ecx);
    a_.cvtsi2sd(value, x86::eax);
    a_.bind(done);
    a_.add(x86::rsp, 16);
  }

  void test_finite() {
    if (function_.finite_to <= function_.finite_from) return;
    a_.mov(result, x86::ptr(x86::rsp, offset_of(result_pointers_)));
    a_.movsd(x86::xmm0, memory({Place::result, function_.finite_from}));
    for (std::uint32_t i = function_.finite_from + 1; i < function_.finite_to; ++i)
      a_.addsd(x86::xmm0, memory({Place::result, i}));
    // inf - inf and nan - nan are nan
    a_.subsd(x86::xmm0, x86::xmm0);
    a_.comisd(x86::xmm0, x86::xmm0);
    return_if([&](const Label& past) { a_.jnp(past); }, 5);
  }

  x86::Assembler& a_;
  const FunctionSteps& function_;
  const double *constants_, *default_inputs_;
  Label sign_mask_, value_mask_, leave_, after_result_;
  std::size_t result_pointers_ = 0;
  std::int32_t frame_ = 0;
};

}  // namespace

struct Encoder::Assembly {
  AssemblyFailure failure;
  asmjit::CodeHolder code;
  x86::Assembler to;
  std::vector<Label> entries;
  Label sign_mask, value_mask;
};

Encoder::Encoder() : assembly_(std::make_unique<Assembly>()) {
  Assembly& a = *assembly_;
  require(a.code.init(asmjit::Environment::host()));
  a.code.setErrorHandler(&a.failure);
  require(a.code.attach(&a.to));
  a.sign_mask = a.to.newLabel();
  a.value_mask = a.to.newLabel();
}

Encoder::~Encoder() = default;

FunctionNumber Encoder::function(const FunctionSteps& steps, const double* constants, const double* default_inputs) {
  Assembly& a = *assembly_;
  a.to.align(asmjit::AlignMode::kCode, 16);
  a.entries.push_back(a.to.newLabel());
  a.to.bind(a.entries.back());
  Body(a.to, steps, constants, default_inputs, a.sign_mask, a.value_mask).write();
  return a.entries.size() - 1;
}

FunctionNumber Encoder::choice(const std::vector<abi::Input>& inputs, std::size_t results,
                               const eom::ModeLayout& layout, const std::vector<ChartCase>& cases, bool has_mode) {
  x86::Assembler& to = assembly_->to;
  to.align(asmjit::AlignMode::kCode, 16);
  assembly_->entries.push_back(to.newLabel());
  to.bind(assembly_->entries.back());
  std::size_t count = 0, mode = 0, w = 0;
  for (const abi::Input input : inputs) {
    if (input == abi::Input::mode) mode = count;
    if (input == abi::Input::prepared) w = count;
    count += is_integer(input) ? 1 : 0;
  }
  count += results;
  // The set of second charts, bit by bit; none if `mode` is null.
  const Label chosen = to.newLabel();
  to.xor_(x86::eax, x86::eax);
  to.test(argument_register(mode), argument_register(mode));
  to.jz(chosen);
  for (std::size_t j = 0; j < layout.charts; ++j) {
    to.xor_(x86::r10d, x86::r10d);
    to.cmp(x86::dword_ptr(argument_register(mode), static_cast<std::int32_t>(4 * layout.chart(j))), 0);
    to.setne(x86::r10b);
    to.shl(x86::r10d, static_cast<std::uint32_t>(j));
    to.or_(x86::eax, x86::r10d);
  }
  to.bind(chosen);
  const auto leave_out = [&](std::size_t k) {
    for (; k + 1 < count; ++k) to.mov(argument_register(k), argument_register(k + 1));
  };
  for (const ChartCase& one : cases) {
    const Label past = to.newLabel();
    to.cmp(x86::eax, one.charts);
    to.jne(past);
    if (one.prepared_offset > 0) to.add(argument_register(w), offset_of(one.prepared_offset));
    if (one.without_prepared) leave_out(w);
    if (!has_mode) leave_out(mode);
    to.jmp(assembly_->entries.at(one.function));
    to.bind(past);
  }
  to.mov(x86::eax, 2);
  to.ret();
  return assembly_->entries.size() - 1;
}

FunctionNumber Encoder::with_context(const void* driver, const void* context, const std::vector<abi::Input>& inputs,
                                     std::size_t results) {
  x86::Assembler& to = assembly_->to;
  const std::size_t arguments =
      static_cast<std::size_t>(std::count_if(inputs.begin(), inputs.end(), is_integer)) + results;
  to.align(asmjit::AlignMode::kCode, 16);
  assembly_->entries.push_back(to.newLabel());
  to.bind(assembly_->entries.back());
  if (arguments < argument_registers) {
    to.mov(argument_register(arguments), reinterpret_cast<std::uint64_t>(context));
    to.mov(x86::rax, reinterpret_cast<std::uint64_t>(driver));
    to.jmp(x86::rax);
  } else {  // the seventh argument is on the stack
    to.mov(x86::rax, reinterpret_cast<std::uint64_t>(context));
    to.push(x86::rax);
    to.mov(x86::rax, reinterpret_cast<std::uint64_t>(driver));
    to.call(x86::rax);
    to.add(x86::rsp, 8);
    to.ret();
  }
  return assembly_->entries.size() - 1;
}

Encoder::Finished Encoder::finish() {
  Assembly& a = *assembly_;
  embed_numbers<2>(a.to, a.sign_mask, 0x8000000000000000u);
  embed_numbers<2>(a.to, a.value_mask, 0x7fffffffffffffffu);
  Finished finished{executable(a.code), {}};
  for (const Label& label : a.entries) finished.entries.push_back(finished.memory->at(a.code.labelOffset(label)));
  return finished;
}

std::unique_ptr<ExecutableMemory> executable(asmjit::CodeHolder& code) {
  require(code.flatten());
  require(code.resolveUnresolvedLinks());
  require(code.relocateToBase(0));  // nothing depends on the address
  std::vector<unsigned char> bytes(code.codeSize());
  require(code.copyFlattenedData(bytes.data(), bytes.size()));
  return std::make_unique<ExecutableMemory>(bytes.data(), bytes.size());
}

const char* encoder_refusal() { return ""; }

}  // namespace eomgen::jit

// Debian has asmjit as a static library that was not compiled for shared ones. Only its diagnostics prevent that: they
// refer to stderr directly. These definitions replace them in the archive.
ASMJIT_BEGIN_NAMESPACE
namespace DebugUtils {
const char* errorAsString(Error) noexcept { return "an instruction that cannot be encoded"; }
void debugOutput(const char*) noexcept {}
void assertionFailed(const char*, int, const char*) noexcept { std::abort(); }
}  // namespace DebugUtils
ASMJIT_END_NAMESPACE

// SPDX-License-Identifier: GPL-3.0-or-later
// Functions as WebAssembly, for the program that is WebAssembly itself: a module that shares its memory and its table
// of functions (WebAssembly Core Specification 1.0, section 5, "Binary Format"). A register is a local variable. All
// operations are those of IEEE 754 and round alike on every machine.
#include <algorithm>
#include <cstdint>
#include <stdexcept>

#include "jit/encode.hpp"
#include "jit/kernels.hpp"
#include "jit/lane_encode.hpp"
#include "jit/wasm_module.hpp"

// The stack of arrays, which emscripten's runtime defines.
extern "C" {
void* stackAlloc(std::size_t size);
void* stackSave();
void stackRestore(void* to);
}

namespace eomgen::jit {
namespace {

using wasm::Code;
using wasm::Op;
using wasm::Type;

wasm::Signature signature_of(const std::vector<abi::Input>& inputs, std::size_t pointers) {
  wasm::Signature signature;
  for (const abi::Input input : inputs)
    signature.parameters.push_back(input == abi::Input::time ? Type::f64 : Type::i32);
  signature.parameters.insert(signature.parameters.end(), pointers, Type::i32);
  signature.result = Type::i32;
  return signature;
}

std::uint32_t number_of(const void* address) {
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(address));
}

/// One function.
class FunctionBody {
 public:
  FunctionBody(wasm::Module& module, const FunctionSteps& steps, const double* constants, const double* default_inputs)
      : module_(module), function_(steps), constants_(constants), default_inputs_(default_inputs) {}

  std::size_t write() {
    const wasm::Signature signature = signature_of(function_.inputs, function_.may_be_null.size());
    const auto arguments = static_cast<std::uint32_t>(signature.parameters.size());
    first_result_ = static_cast<std::uint32_t>(function_.inputs.size());
    frame_ = arguments;
    stack_ = arguments + 1;
    result_ = arguments + 2;
    registers_ = arguments + 3;
    left_ = registers_ + register_count;
    right_ = left_ + 1;
    enter();
    code_.block(Type::i32);
    for (const Step& step : function_.steps) write(step);
    test_finite();
    code_.integer(0);
    code_.end();
    if (function_.scratch_size > 0) {
      code_.get(stack_);
      call(reinterpret_cast<const void*>(&stackRestore), {{Type::i32}, {}});
    }
    code_.end();
    return module_.add(signature, {{3, Type::i32}, {register_count + 2, Type::f64}}, code_);
  }

 private:
  std::uint32_t argument(abi::Input input) const {
    for (std::size_t k = 0; k < function_.inputs.size(); ++k) {
      if (function_.inputs[k] == input) return static_cast<std::uint32_t>(k);
    }
    throw std::logic_error("this argument is not there");
  }
  bool has(abi::Input input) const {
    return std::find(function_.inputs.begin(), function_.inputs.end(), input) != function_.inputs.end();
  }

  void enter() {
    if (has(abi::Input::inputs)) {
      const std::uint32_t u = argument(abi::Input::inputs);
      code_.get(u);
      code_.op(Op::i32_eqz);
      code_.begin_if();
      code_.integer(number_of(default_inputs_));
      code_.set(u);
      code_.end();
    }
    if (function_.scratch_size > 0) {
      call(reinterpret_cast<const void*>(&stackSave), {{}, Type::i32});
      code_.set(stack_);
      code_.integer(function_.scratch_size * sizeof(double));
      call(reinterpret_cast<const void*>(&stackAlloc), {{Type::i32}, Type::i32});
      code_.set(frame_);
    }
    if (function_.reads_time) store({Place::scratch, function_.time}, [&] { code_.get(argument(abi::Input::time)); });
    if (!function_.mode_values.empty()) load_mode();
  }

  /// Stores the values that `mode` determines. Without it, or if it is null, all entries are 0.
  void load_mode() {
    const auto zeros = [&] {
      for (const ModeValue& value : function_.mode_values)
        store({Place::scratch, value.scratch},
              [&] { code_.number(value.is_side ? 0 : contact_signs(value.index % 2)[0]); });
    };
    if (!has(abi::Input::mode)) return zeros();
    const std::uint32_t mode = argument(abi::Input::mode);
    code_.get(mode);
    code_.begin_if();
    for (const ModeValue& value : function_.mode_values) {
      store({Place::scratch, value.scratch}, [&] {
        code_.get(mode);
        code_.load(Op::i32_load, 4 * value.entry);
        if (value.is_side) return code_.op(Op::f64_convert_i32_s);
        code_.integer(contact_state_mask);
        code_.op(Op::i32_and);
        code_.integer(3);
        code_.op(Op::i32_shl);
        code_.load(Op::f64_load, number_of(contact_signs(value.index % 2)));
      });
    }
    code_.begin_else();
    zeros();
    code_.end();
  }

  void call(const void* function, const wasm::Signature& signature) {
    code_.integer(number_of(function));
    code_.call_indirect(module_.type(signature));
  }

  std::uint32_t pointer(Place place) const {
    switch (place) {
      case Place::scratch: return frame_;
      case Place::state: return argument(abi::Input::state);
      case Place::parameter: return argument(abi::Input::parameters);
      case Place::input: return argument(abi::Input::inputs);
      case Place::result: return result_;
      case Place::prepared:  // no function takes several of these
        for (const abi::Input input :
             {abi::Input::prepared, abi::Input::state_vector, abi::Input::state_vectors, abi::Input::accelerations}) {
          if (has(input)) return argument(input);
        }
        break;
      case Place::register_:
      case Place::constant: break;
    }
    throw std::logic_error("this place is no array of the function");
  }

  static std::uint32_t offset_of(const Location& location) {
    return static_cast<std::uint32_t>(location.index * sizeof(double));
  }

  void push(const Location& source) {
    if (source.place == Place::register_) return code_.get(registers_ + source.index);
    if (source.place == Place::constant) return code_.number(constants_[source.index]);
    code_.get(pointer(source.place));
    code_.load(Op::f64_load, offset_of(source));
  }

  void store(const Location& to, auto&& push_value) {
    code_.get(pointer(to.place));
    push_value();
    code_.store(Op::f64_store, offset_of(to));
  }

  void return_if(Op comparison, std::uint32_t code) {
    code_.get(left_);
    code_.get(right_);
    return_if_compared(comparison, code);
  }
  void return_if_compared(Op comparison, std::uint32_t code) {
    code_.op(comparison);
    code_.begin_if();
    code_.integer(code);
    code_.leave(1);  // the block of the whole body
    code_.end();
  }

  void write(const Step& step) {
    const std::uint32_t target = registers_ + step.target;
    const auto arithmetic = [&](Op op) {
      code_.get(target);
      push(step.source);
      code_.op(op);
      code_.set(target);
    };
    const auto extreme = [&](Op comparison) {
      code_.get(target);
      push(step.source);
      code_.get(target);
      push(step.source);
      code_.op(comparison);
      code_.op(Op::select);
      code_.set(target);
    };
    const auto change = [&](Op op) {
      code_.get(target);
      code_.op(op);
      code_.set(target);
    };
    switch (step.action) {
      case Action::load: push(step.source); return code_.set(target);
      case Action::store: return store(step.source, [&] { code_.get(target); });
      case Action::add: return arithmetic(Op::f64_add);
      case Action::subtract: return arithmetic(Op::f64_sub);
      case Action::multiply: return arithmetic(Op::f64_mul);
      case Action::divide: return arithmetic(Op::f64_div);
      case Action::least: return extreme(Op::f64_lt);
      case Action::greatest: return extreme(Op::f64_gt);
      case Action::root:
        push(step.source);
        code_.op(Op::f64_sqrt);
        return code_.set(target);
      case Action::negate: return change(Op::f64_neg);
      case Action::absolute: return change(Op::f64_abs);
      case Action::sign:  // 1 above 0, -1 below, else 0, also for NaN
        for (const Op comparison : {Op::f64_gt, Op::f64_lt}) {
          code_.get(target);
          code_.number(0);
          code_.op(comparison);
        }
        code_.op(Op::i32_sub);
        code_.op(Op::f64_convert_i32_s);
        return code_.set(target);
      case Action::add_sign:
        code_.get(target);
        code_.op(Op::i64_reinterpret_f64);
        push(step.source);
        code_.op(Op::i64_reinterpret_f64);
        code_.sign_bit();
        code_.op(Op::i64_and);
        code_.op(Op::i64_xor);
        code_.op(Op::f64_reinterpret_i64);
        return code_.set(target);
      case Action::compare:
        code_.get(target);
        code_.set(left_);
        push(step.source);
        return code_.set(right_);
      case Action::load_unless_above:
        code_.get(left_);
        code_.get(right_);
        code_.op(Op::f64_gt);
        code_.op(Op::i32_eqz);
        code_.begin_if();
        push(step.source);
        code_.set(target);
        return code_.end();
      // Comparisons with a NaN are false.
      case Action::return_if_above: return return_if(Op::f64_gt, step.extra);
      case Action::return_if_above_or_equal: return return_if(Op::f64_ge, step.extra);
      case Action::return_if_equal: return return_if(Op::f64_eq, step.extra);
      case Action::call: {
        const auto library = static_cast<Library>(step.extra);
        const bool takes_two = library == Library::pow || library == Library::atan2;
        wasm::Signature signature{{Type::f64}, Type::f64};
        code_.get(registers_);
        if (takes_two) {
          code_.get(registers_ + 1);
          signature.parameters.push_back(Type::f64);
        }
        call(library_function(library), signature);
        return code_.set(registers_);
      }
      case Action::sincos_group:
        code_.get(pointer(step.source.place));
        code_.integer(offset_of(step.source));
        code_.op(Op::i32_add);
        code_.integer(step.extra);
        return call(reinterpret_cast<const void*>(sincos_group()), {{Type::i32, Type::i32}, {}});
      case Action::begin_result:
        code_.get(first_result_ + step.extra);
        code_.set(result_);
        code_.block({});
        if (!function_.may_be_null.at(step.extra)) return;
        code_.get(result_);
        code_.op(Op::i32_eqz);
        return code_.branch_if(0);
      case Action::end_result: return code_.end();
    }
  }

  void test_finite() {
    if (function_.finite_to <= function_.finite_from) return;
    code_.get(first_result_);
    code_.set(result_);
    push({Place::result, function_.finite_from});
    for (std::uint32_t i = function_.finite_from + 1; i < function_.finite_to; ++i) {
      push({Place::result, i});
      code_.op(Op::f64_add);
    }
    code_.set(left_);
    // inf - inf and nan - nan are nan
    for (int twice = 0; twice < 2; ++twice) {
      code_.get(left_);
      code_.get(left_);
      code_.op(Op::f64_sub);
    }
    return_if_compared(Op::f64_ne, 5);
  }

  wasm::Module& module_;
  const FunctionSteps& function_;
  const double *constants_, *default_inputs_;
  Code code_;
  // Local variables: the first of the results, pointers, registers, the operands of a comparison.
  std::uint32_t first_result_ = 0, frame_ = 0, stack_ = 0, result_ = 0, registers_ = 0, left_ = 0, right_ = 0;
};

}  // namespace

struct Encoder::Assembly {
  wasm::Module module;
};

Encoder::Encoder() : assembly_(std::make_unique<Assembly>()) {}
Encoder::~Encoder() = default;

FunctionNumber Encoder::function(const FunctionSteps& steps, const double* constants, const double* default_inputs) {
  return FunctionBody(assembly_->module, steps, constants, default_inputs).write();
}

FunctionNumber Encoder::choice(const std::vector<abi::Input>& inputs, std::size_t results,
                               const eom::ModeLayout& layout, const std::vector<ChartCase>& cases, bool has_mode) {
  const wasm::Signature signature = signature_of(inputs, results);
  const auto count = static_cast<std::uint32_t>(signature.parameters.size());
  std::uint32_t mode = 0;
  for (std::uint32_t k = 0; k < inputs.size(); ++k) {
    if (inputs[k] == abi::Input::mode) mode = k;
  }
  Code code;
  const std::uint32_t charts = count;
  // The set of second charts, bit by bit; none if `mode` is null.
  code.get(mode);
  code.begin_if();
  for (std::size_t j = 0; j < layout.charts; ++j) {
    code.get(charts);
    code.get(mode);
    code.load(Op::i32_load, static_cast<std::uint32_t>(4 * layout.chart(j)));
    code.integer(0);
    code.op(Op::i32_ne);
    code.integer(static_cast<std::uint32_t>(j));
    code.op(Op::i32_shl);
    code.op(Op::i32_or);
    code.set(charts);
  }
  code.end();
  code.block(Type::i32);
  for (const ChartCase& one : cases) {
    code.get(charts);
    code.integer(one.charts);
    code.op(Op::i32_eq);
    code.begin_if();
    for (std::uint32_t k = 0; k < count; ++k) {
      const bool is_prepared = k < inputs.size() && inputs[k] == abi::Input::prepared;
      if ((is_prepared && one.without_prepared) || (k == mode && !has_mode)) continue;
      code.get(k);
      if (!is_prepared || one.prepared_offset == 0) continue;
      code.integer(static_cast<std::uint32_t>(one.prepared_offset * sizeof(double)));
      code.op(Op::i32_add);
    }
    code.call(static_cast<std::uint32_t>(one.function));
    code.leave(1);
    code.end();
  }
  code.integer(2);
  code.end();
  code.end();
  return assembly_->module.add(signature, {{1, Type::i32}}, code);
}

FunctionNumber Encoder::with_context(const void* driver, const void* context, const std::vector<abi::Input>& inputs,
                                     std::size_t results) {
  const wasm::Signature signature = signature_of(inputs, results), of_driver = signature_of(inputs, results + 1);
  Code code;
  for (std::uint32_t k = 0; k < signature.parameters.size(); ++k) code.get(k);
  code.integer(number_of(context));
  code.integer(number_of(driver));
  code.call_indirect(assembly_->module.type(of_driver));
  code.end();
  return assembly_->module.add(signature, {}, code);
}

Encoder::Finished Encoder::finish() {
  const std::vector<unsigned char> bytes = assembly_->module.bytes();
  Finished finished{std::make_unique<ExecutableMemory>(bytes.data(), bytes.size()), {}};
  for (std::size_t k = 0; k < assembly_->module.size(); ++k) finished.entries.push_back(finished.memory->at(k));
  return finished;
}

const char* encoder_refusal() { return ""; }

bool has_lanes() { return false; }
std::unique_ptr<ExecutableMemory> encode_lanes(const FunctionSteps&, const double*) { return nullptr; }

}  // namespace eomgen::jit

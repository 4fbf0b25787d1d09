// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <eom/modes/mode_array.hpp>
#include <limits>
#include <optional>
#include <stdexcept>

#include "abi/compiled.hpp"
#include "emit/context.hpp"
#include "error.hpp"
#include "jit/machine_code.hpp"
#include "program/program.hpp"
#include "program/taylor.hpp"
#include "work.hpp"

namespace eomgen::pipeline {

run::Code describe_code(const program::Program& program) {
  run::Code code;
  code.prepared = program.prepared_count();
  code.output_names = program.outputs;
  code.free = program.free;
  code.first_order = program.layout().first_order;
  code.discrete = program.layout().discrete;
  code.active_constraints = program.active_constraints;
  code.reset_values = program.result_size("resets");
  code.holonomic = program.holonomic;
  code.contact_set = program.contact_set;
  code.kinks = program.kinks;
  for (const program::ContactInfo& contact : program.contacts) code.contacts.push_back({contact, contact.name, 0});
  if (program.taylor) code.taylor_order = static_cast<int>(program::taylor_order(*program.taylor));
  for (const program::Program& second : program.chart_variants) {
    code.own_outputs.push_back({second.in_charts, {}});
    for (const program::Function& function : second.functions) {
      if (function.name != "outputs") continue;
      for (std::uint32_t i = 0; i < program.outputs.size(); ++i) {
        if (std::find(function.result_indices.begin(), function.result_indices.end(), i) ==
            function.result_indices.end())
          code.own_outputs.back().outputs.push_back(i);
      }
    }
  }
  return code;
}

namespace {

// The self test of emitted code (docs/abi.md) for functions in memory: the same states, values and tolerances.

// Of arrays before a call, so that an entry that is never written differs from its expected value.
constexpr double unset = std::numeric_limits<double>::quiet_NaN();

/// Whether a function has its values at a test vector. `inputs`: null if they are left out.
bool satisfies(const abi::CompiledFunctions& functions, const program::Program& program, const emit::TestVector& at,
               const emit::FunctionValues& expected, const double* inputs) {
  if (!functions.has(expected.function)) return false;
  abi::CallArguments given;
  given.t = at.t;
  given.x = at.x.data();
  given.p = at.p.data();
  given.u = inputs;
  given.v = at.v.data();
  std::vector<int> mode = at.mode;
  mode.resize(program.mode_layout().size());
  eom::ModeArray to(program.mode_layout());
  to.set_charts(expected.to);
  given.mode = mode.data();
  given.to = to.data();
  // Code in second charts leaves entries of the own charts as they are.
  const double before = program.charts.empty() ? unset : 0;
  std::vector<double> w(program.prepared_count() + 1, before);
  given.w = w.data();
  if (abi::find(expected.function)->has_input(abi::Input::prepared) && functions.prepare(at.p.data(), w.data()) != 0)
    return false;
  if (expected.function == "taylor")
    given.order = static_cast<int>(expected.values.at(0).size() / program.state_count()) - 1;
  std::vector<std::vector<double>> arrays;
  for (std::size_t r = 0; r < expected.values.size(); ++r) {
    arrays.emplace_back(std::max<std::size_t>(1, expected.values[r].size()), before);
    given.results.at(r) = arrays[r].data();
  }
  if (functions.call(expected.function, given) != 0) return false;
  for (std::size_t r = 0; r < expected.values.size(); ++r) {
    for (std::size_t i = 0; i < expected.values[r].size(); ++i) {
      if (!(std::fabs(arrays[r][i] - expected.values[r][i]) <= expected.tolerances[r])) return false;
    }
  }
  return true;
}

/// The index of the first test vector of `context` that the functions do not satisfy, if there is one.
std::optional<std::size_t> failed_test_vector(const abi::CompiledFunctions& functions, const program::Program& program,
                                              const emit::EmissionContext& context) {
  for (std::size_t k = 0; k < context.tests.size(); ++k) {
    const emit::TestVector& at = context.tests[k];
    // At the start inputs have their defaults.
    const bool at_defaults = std::equal(at.u.begin(), at.u.end(), context.inputs.begin(), context.inputs.end(),
                                        [](double u, const emit::Quantity& input) { return u == input.value; });
    for (const emit::FunctionValues& expected : at.functions) {
      const double* const inputs = at_defaults ? nullptr : at.u.data();
      if (!satisfies(functions, program, at, expected, inputs)) return k;
    }
  }
  return std::nullopt;
}

std::map<std::string, std::vector<std::size_t>> array_sizes(const program::Program& program) {
  std::map<std::string, std::vector<std::size_t>> arrays;
  for (const program::Function& function : program.functions) {
    for (const auto& result : function.results) {
      if (!result.is_test()) arrays[function.name].push_back(result.entries.size());
    }
  }
  if (program.taylor) arrays["taylor"] = {};
  return arrays;
}

/// The description of a program's code with the functions of a run.
run::Code bound_code(const abi::CompiledFunctions& functions, const program::Program& program) {
  run::Code code = describe_code(program);
  const auto bind = [&](const auto& one) { one(code, functions); };
#define ABI_FUNCTION(name, takes, gives, comes, purpose)      \
  bind([](auto& to, const auto& from) {                       \
    if constexpr (requires { to.name; }) to.name = from.name; \
  });
#include "abi/functions.inc"
#undef ABI_FUNCTION
  if (!program.open_saves_work()) code.rhs_open = nullptr;
  return code;
}

}  // namespace

CompiledCode::CompiledCode(emit::CompiledModel compiled, const program::Program& program)
    : seconds_(compiled.seconds), cached_(compiled.cached), arrays_(array_sizes(program)) {
  const auto kept = std::make_shared<const emit::CompiledModel>(std::move(compiled));
  functions_ = &kept->model;
  owner_ = kept;
  code_ = bound_code(*functions_, program);
}

CompiledCode::CompiledCode(jit::MachineCode code, double seconds, const program::Program& program)
    : tier_(Tier::jit), seconds_(seconds), arrays_(array_sizes(program)) {
  const auto kept = std::make_shared<const jit::MachineCode>(std::move(code));
  functions_ = kept.get();
  owner_ = kept;
  code_ = bound_code(*functions_, program);
}

namespace {

std::vector<double> rounded(const std::vector<verify::Real>& values) {
  std::vector<double> result;
  for (const verify::Real& value : values) result.push_back(cln::double_approx(value));
  return result;
}

/// The argument `mode` for states of the contacts.
std::vector<int> mode_array(std::vector<int> contacts, const run::Code& code) {
  contacts.resize(code.contacts.size() + code.contact_set.contacts.size() + code.kinks.size() + eom::max_charts);
  return contacts;
}

/// Calls a compiled function by name; nothing if it returns an error code.
std::optional<std::vector<std::vector<double>>> called(const abi::CompiledFunctions& m, const run::Code& described,
                                                       const std::string& function, const verify::AbiArguments& at,
                                                       const std::vector<std::size_t>& sizes) {
  const double t = cln::double_approx(at.t);
  const std::vector<double> x = rounded(at.x), p = rounded(at.p), u = rounded(at.u);
  std::vector<std::vector<double>> y;
  for (const std::size_t size : sizes) y.emplace_back(std::max<std::size_t>(1, size));
  if (function == "taylor") y.emplace_back(x.size() * static_cast<std::size_t>(at.order + 1));
  y.resize(std::max<std::size_t>(3, y.size()));
  std::vector<double> w(described.prepared + 1);
  if (abi::find(function)->has_input(abi::Input::prepared) && m.prepare(p.data(), w.data()) != 0) return std::nullopt;
  const std::vector<int> mode = mode_array(at.mode, described);
  const std::vector<double> v = rounded(at.v);
  const abi::CallArguments given{t,        x.data(),    p.data(), w.data(), u.data(),
                                 v.data(), mode.data(), nullptr,  at.order, {y[0].data(), y[1].data(), y[2].data()}};
  if (m.call(function, given) != 0) return std::nullopt;
  return y;
}

}  // namespace

verify::CompiledForm CompiledCode::form() const {
  const abi::CompiledFunctions* const model = functions_;
  verify::CompiledForm form;
  form.name = "emitted code";
  form.call = [model, arrays = arrays_, described = code_](const std::string& function,
                                                           const verify::AbiArguments& at) {
    return called(*model, described, function, at, arrays.at(function));
  };
  form.rhs = [model, described = code_](double t, const std::vector<double>& x, const std::vector<double>& p,
                                        const std::vector<double>& u,
                                        const std::vector<int>& contacts) -> std::optional<std::vector<double>> {
    std::vector<double> dx(described.layout().size()), w(described.prepared);
    const std::vector<int> mode = mode_array(contacts, described);
    // The function that `run` integrates; the self test has compared it with `rhs`.
    const int code = w.empty() ? model->rhs(t, x.data(), p.data(), u.data(), mode.data(), dx.data())
                     : model->prepare(p.data(), w.data()) != 0
                         ? 1
                         : model->rhs_prepared(t, x.data(), p.data(), w.data(), u.data(), mode.data(), dx.data());
    if (code != 0) return std::nullopt;
    return dx;
  };
  return form;
}

CompiledCode compile(const program::Program& program, const emit::EmissionContext& context, bool again) {
  const std::string name = emit::mangled_id(context.id);
  std::string source, header;
  for (const emit::EmittedFile& file : emit::emit(program, context, "cpp")) {
    if (file.name == name + ".c") source = file.text;
    if (file.name == name + ".h") header = file.text;
  }
  if (source.empty() || header.empty()) throw std::logic_error("the cpp target emitted no C source");
  const work::DeferInterrupt heeded;  // the wait for the compiler handles an interrupt itself, and leaves no files
  emit::CompiledModel compiled = emit::compile_and_load(source, header, name, &work::stop_flag());
  if (!compiled.note.empty() && !again) {
    work::warn(format_warning({{},
                               compiled.note + "; what is compiled now is kept in a private one, for this run alone",
                               "chmod 700 a folder of your own, or name one in EOMGEN_CACHE_DIR"}));
  }
  return {std::move(compiled), program};
}

CompiledCode assemble(const program::Program& program, const emit::EmissionContext& context) {
  const auto start = std::chrono::steady_clock::now();
  std::vector<double> inputs;
  for (const emit::Quantity& input : context.inputs) inputs.push_back(input.value);
  jit::MachineCode code(program, inputs);
  if (const std::optional<std::size_t> failed = failed_test_vector(code, program, context)) {
    throw Error("run", {}, fmt::format("machine code in memory fails its self test, vector {}", *failed + 1),
                "please report the model; --tier compiled uses the C compiler", ErrorKind::tool);
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {std::move(code), seconds, program};
}

CompiledCode make_code(Tier tier, const program::Program& program, const emit::EmissionContext& context, bool again) {
  return tier == Tier::jit ? assemble(program, context) : compile(program, context, again);
}

std::vector<double> default_inputs(DerivedModel& derived) {
  const run::Scene scene =
      run::resolve_scene(derived.mechanics, derived.candidates.front(), derived.model.scene("default"), {});
  std::vector<double> result;
  for (const run::Signal& input : scene.inputs) result.push_back(input(scene.t0, scene.t0));
  return result;
}

CompiledCode compile_for_verification(DerivedModel& derived, const program::Program& program) {
  const run::Scene scene =
      run::resolve_scene(derived.mechanics, derived.candidates.front(), derived.model.scene("default"), {});
  verify::Certificate pending;
  return compile(program, emission_context(derived, program, scene, pending));
}

}  // namespace eomgen::pipeline

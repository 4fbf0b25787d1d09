// SPDX-License-Identifier: GPL-3.0-or-later
// Target python: NAME.py, NAME.c and NAME.h of target c, and the integrator NAME_simulate.c. The module compiles the C
// code on import. Names, units and defaults are those of NAME_info.
#include <fmt/format.h>

#include <eom/outcome.hpp>

#include "abi/functions.hpp"
#include "emit/metadata.hpp"
#include "emit/targets.hpp"
#include "error.hpp"
#include "skeletons/python_model_py.hpp"
#include "skeletons/python_run_cpp.hpp"
#include "skeletons/python_simulate_c.hpp"

namespace eomgen::emit {
namespace {

// Functions that the module wraps.
// clang-format off
constexpr const char* wrapped_functions[] = {
    "rhs", "jac", "jac_p", "jac_u", "jvp", "vjp", "adjoint", "hvp", "inverse", "coriolis", "gravity", "mass", "momenta",
    "momenta_jac", "momenta_jac_p", "momenta_jac_u", "constraints", "reactions", "outputs", "events", "contact_rows",
    "rhs_open", "power", "resets", "frames", "energy_gradients", "taylor", "regressor", "momentum", "reactions_jac",
    "reactions_jac_p", "reactions_jac_u", "outputs_jac", "outputs_jac_p", "outputs_jac_u"};
// clang-format on

/// _rhs = _function("rhs", "daaaia"): one letter per argument type.
std::string c_function_declarations() {
  std::string lines;
  for (const char* name : wrapped_functions) {
    const abi::Function& function = *abi::find(name);
    std::string types;
    for (const abi::Input input : function.inputs)
      types += input == abi::Input::time    ? 'd'
               : input == abi::Input::mode  ? 'I'
               : input == abi::Input::order ? 'i'
                                            : 'a';
    types.append(function.results.size(), 'a');
    lines += fmt::format("{0}_{1} = _function(\"{1}\", \"{2}\")", lines.empty() ? "" : "\n", name, types);
  }
  return lines;
}

/// The outcomes of runs by the codes of NAME_simulate: those of the ABI, and its own.
std::string outcomes() {
  using eom::Outcome;
  std::string list;
  for (int code = 1; code <= eom::code_not_finite; ++code)
    list += fmt::format("{}: \"{}\", ", code, eom::name(eom::outcome_of_abi_code(code)));
  return list + fmt::format("10: \"{}\", 11: \"{}\", 12: \"{}\"", eom::name(Outcome::step_too_small),
                            eom::name(Outcome::max_steps), eom::name(Outcome::diverged));
}

/// Lines of `simulate` where velocities may jump.
constexpr const char* refuse_impulses =
    "    raise NotImplementedError(\"a prescribed motion has a kink in time, where velocities may jump, and simulate "
    "has \"\n"
    "                              \"no impulses: use run, emitted with --with run\")\n";

/// Values for the skeletons that depend on the floating-point type.
std::vector<std::pair<std::string, std::string>> number_values(bool single) {
  if (!single) {
    return {{"real", "double"},          {"cast", ""},
            {"c_real", "c_double"},      {"tolerances", "rtol=1e-9, atol=1e-12"},
            {"epsilon", "2.220446e-16"}, {"about_numbers", ""},
            {"require_place", ""}};
  }
  return {{"real", "float"},
          {"cast", "(float)"},
          {"c_real", "c_float"},
          {"tolerances", "rtol=1e-5, atol=1e-7"},
          {"epsilon", "1.192093e-07"},
          {"about_numbers",
           "\n\nNumbers are in single precision: numpy arrays are float32. `simulate` keeps the time and its "
           "sums in\ndouble precision; states are rounded at every stage."},
          {"require_place", R"(    if any(map(math.isinf, array)) and not any(map(math.isinf, values)):
        raise ValueError("%s: a number has no place in single precision" % what)
)"}};
}

}  // namespace

std::vector<EmittedFile> emit_python(const program::Program& program, const EmissionContext& context) {
  if (!program.charts.empty()) {
    throw Error("emit", {}, "the Python target does not support charts yet",
                "use the target c or cpp, or leave --with charts out");
  }
  std::vector<EmittedFile> files = emit_c(program, context);
  const std::string name = mangled_id(context.id);
  std::vector<std::pair<std::string, std::string>> values = {{"name", name},
                                                             {"banner", banner(program, context, "# ", "# ", "")},
                                                             {"functions_of_c", c_function_declarations()},
                                                             {"outcomes", outcomes()},
                                                             {"impulses", context.jumps_in_time ? refuse_impulses : ""},
                                                             {"resets", context.has_resets() ? "True" : "False"}};
  const std::vector<std::pair<std::string, std::string>> numbers = number_values(context.single_error.has_value());
  values.insert(values.end(), numbers.begin(), numbers.end());
  files.push_back({name + "_simulate.c", render_template(skeleton::python_simulate_c, values, {})});
  files.push_back({module_name(context.id) + ".py", render_template(skeleton::python_model_py, values, {})});
  if (context.run) {
    files.push_back({name + "_run.cpp",
                     render_template(skeleton::python_run_cpp,
                                     {{"banner", banner(program, context, "// ", "// ", "")}, {"name", name}}, {})});
  }
  return files;
}

}  // namespace eomgen::emit

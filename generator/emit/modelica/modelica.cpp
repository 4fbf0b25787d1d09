// SPDX-License-Identifier: GPL-3.0-or-later
// Target modelica: NAME.mo, a flat model: parameters, inputs, states and their equations in explicit form.
#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "emit/languages/language.hpp"
#include "emit/metadata.hpp"
#include "emit/names.hpp"
#include "emit/targets.hpp"
#include "emit/text.hpp"
#include "error.hpp"
#include "lists.hpp"
#include "skeletons/modelica_model_mo.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::emit {
namespace {

// Keywords of Modelica, its built-in functions and types, and names of the model.
// clang-format off
constexpr std::string_view modelica_words[] = {
    "algorithm", "annotation", "block", "class", "connect", "connector", "constant", "constrainedby", "der",
    "discrete", "each", "elseif", "elsewhen", "encapsulated", "end", "enumeration", "equation", "expandable",
    "extends", "external", "final", "flow", "function", "import", "impure", "in", "initial", "inner", "input", "loop",
    "model", "outer", "output", "package", "parameter", "partial", "protected", "pure", "record", "redeclare",
    "replaceable", "stream", "then", "type", "when", "within", "time", "Real", "Integer", "Boolean", "String",
    "StateSelect", "Clock", "abs", "assert", "ceil", "cross", "delay", "diagonal", "div", "edge", "fill", "floor",
    "homotopy", "identity", "integer", "matrix", "max", "min", "mod", "ndims", "noEvent", "ones", "pre", "product",
    "reinit", "rem", "sample", "scalar", "semiLinear", "sign", "size", "skew", "smooth", "spatialDistribution", "sum",
    "symmetric", "terminal", "terminate", "transpose", "vector", "zeros", "power", "loaded"};
// clang-format on

// Lines of print_statements that the equations of a model state in another way.
constexpr std::string_view let_prefix = "let ", dropped_line = "dropped";

std::string modelica_number(double value) {
  if (!std::isfinite(value))
    throw Error("emit", {}, "a number of the model is not finite, which Modelica cannot state",
                "give parameters and the start finite values");
  return decimal(value);
}

const char* modelica_function(symbolic::Op op) {
  return op == symbolic::Op::pow ? "power" : symbolic::function_of(op).code;
}

Language modelica_language() {
  Language language;
  Dialect& dialect = language.dialect;
  set_numbers<modelica_number>(dialect, "3.141592653589793");
  dialect.abs_function = "abs";
  dialect.is_typed = false;
  dialect.conditional = [](const std::string& a, const std::string& b, const std::string& x, const std::string& y) {
    return fmt::format("(if {} < {} then {} else {})", a, b, x, y);
  };
  dialect.element = [](const std::string& array, std::size_t index) { return fmt::format("{}[{}]", array, index + 1); };
  dialect.function_name = modelica_function;
  language.comment = "// ";
  language.declaration = [](const std::string& name, const std::string& value) {
    return fmt::format("{}{} = {};", let_prefix, name, value);
  };
  language.stop = [](const std::string& condition, int code) {
    // A value that is not finite ends a run by itself.
    if (code == 5) return std::string(dropped_line);
    return fmt::format("assert(not ({}), \"the mass matrix is singular\");", condition);
  };
  language.negation = [](const std::string& condition) { return fmt::format("not ({})", condition); };
  language.reserved = modelica_words;
  return language;
}

/// "kg*m^2/s^2" as "kg.m2/s2"; empty if Modelica has no such form (roots).
std::string modelica_unit(const std::string& unit) {
  if (unit.find("^(") != std::string::npos) return "";
  std::string text;
  for (const char c : unit) {
    if (c != '^') text += c == '*' ? '.' : c;
  }
  return text;
}

std::string modelica_attributes(const std::string& unit, const std::vector<std::string>& others) {
  std::vector<std::string> list = others;
  if (const std::string text = modelica_unit(unit); !text.empty()) list.push_back("unit = " + quoted(text));
  return list.empty() ? "" : fmt::format("({})", fmt::join(list, ", "));
}

std::string modelica_description(const std::string& note) { return note.empty() ? "" : " " + quoted(note); }

/// Units of Modelica have one quotient: none is stated if the coordinate has one.
std::string modelica_rate_unit(const std::string& unit) {
  return unit.empty() || unit.find('/') != std::string::npos ? "" : unit + "/s";
}

std::string modelica_declarations(const EmissionContext& context, const program::Program& program,
                                  const ModelNames& names) {
  std::string text;
  for (std::size_t i = 0; i < context.parameters.size(); ++i) {
    const Quantity& p = context.parameters[i];
    std::string note = p.note;
    if (!p.expression.empty()) note += fmt::format("{}follows from others: {}", note.empty() ? "" : "; ", p.expression);
    text += fmt::format("  parameter Real {}{} = {}{};\n", names.parameters[i], modelica_attributes(p.unit, {}),
                        modelica_number(p.value), modelica_description(note));
  }
  for (std::size_t i = 0; i < context.inputs.size(); ++i) {
    const Quantity& u = context.inputs[i];
    text +=
        fmt::format("  input Real {}{}{};\n", names.inputs[i],
                    modelica_attributes(u.unit, {"start = " + modelica_number(u.value)}), modelica_description(u.note));
  }
  const std::size_t n = program.free.size();
  for (std::size_t i = 0; i < names.state.size(); ++i) {
    std::string unit;
    if (i < n) unit = context.coordinates.at(program.free[i]).unit;
    if (i >= n && i < 2 * n) unit = modelica_rate_unit(context.coordinates.at(program.free[i - n]).unit);
    if (i >= 2 * n) unit = context.states.at(program.states.at(i - 2 * n).index).unit;
    text += fmt::format("  Real {}{};\n", names.state[i],
                        modelica_attributes(unit, {"start = " + modelica_number(context.start.at(i)), "fixed = true"}));
  }
  return text;
}

struct ModelicaEquations {
  std::string values, equations;  // declarations of intermediate values, and equations of all
  bool has_powers = false;
};

/// Statements become equations: `let a = b` declares a, and `dx[i] = b` is the equation of a state.
ModelicaEquations modelica_equations(const FunctionText& text, const ModelNames& names) {
  ModelicaEquations result;
  std::istringstream lines(text.body);
  const std::string derivative = text.results.at(0) + "[";
  std::string last_let;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == std::string::npos || line.compare(begin, 2, "//") == 0) {
      result.equations += line + "\n";
      continue;
    }
    std::string statement = line.substr(begin);
    if (statement == dropped_line) {  // with the sum that it tests
      result.equations.resize(result.equations.size() - last_let.size());
      result.values.resize(result.values.rfind("  Real "));
      continue;
    }
    result.has_powers = result.has_powers || statement.find("power(") != std::string::npos;
    if (statement.starts_with(let_prefix)) {
      statement.erase(0, let_prefix.size());
      const std::size_t equals = statement.find(" = ");
      const std::string name = statement.substr(0, equals), value = statement.substr(equals + 3);
      if (value.starts_with("side(")) {
        result.values += fmt::format("  constant Real {} = 0.0 \"the branch follows the state\";\n", name);
        continue;
      }
      const auto is_of = [&](const std::string& array) { return value.starts_with(array + "["); };
      if (is_of(names.x) || is_of(names.p) || is_of(names.u)) continue;  // declared as a state, a parameter, an input
      result.values += fmt::format("  Real {};\n", name);
      last_let = fmt::format("  {}\n", statement);
      result.equations += last_let;
      continue;
    }
    if (statement.starts_with(derivative)) {
      const std::size_t close = statement.find(']');
      const std::size_t index = std::stoul(statement.substr(derivative.size(), close - derivative.size()));
      const std::size_t remark = statement.find(";  // ");
      statement = fmt::format("der({}){}", names.state.at(index - 1),
                              statement.substr(close + 1, remark == std::string::npos ? remark : remark - close));
    }
    result.equations += fmt::format("  {}\n", statement);
  }
  return result;
}

[[noreturn]] void refuse_statement(const std::string& what, const std::string& remedy) {
  throw Error("emit", {}, "the target modelica cannot state " + what, remedy);
}

void require_smooth(const program::Program& program, const EmissionContext& context) {
  const char* const remedy = "use --target fmu, which has the runtime for them inside";
  if (!program.contacts.empty())
    refuse_statement(fmt::format("the contact '{}'", program.contacts.front().name), remedy);
  if (!program.contact_set.empty())
    refuse_statement(fmt::format("the contact '{}'", program.contact_set.contacts.front().name), remedy);
  for (const EventDescription& event : context.events) {
    if (!event.reset.set.empty()) refuse_statement(fmt::format("the reset at the event '{}'", event.name), remedy);
  }
  if (context.jumps_in_time)
    refuse_statement("the jump of velocities at a kink in time of a prescribed motion", remedy);
  if (!context.samples.empty()) refuse_statement(fmt::format("the sample '{}'", context.samples.front().name), remedy);
}

/// Parts of the model that the file does not have.
std::string modelica_omissions(const program::Program& program, const EmissionContext& context) {
  std::string text;
  std::string functions;
  for (const program::Function& function : program.functions) {
    if (function.name == "rhs" || function.name == "prepare" || function.name == "rhs_prepared") continue;
    functions += (functions.empty() ? "" : ", ") + function.name;
  }
  const std::string events = joined(context.events, [](const EventDescription& event) { return event.name; });
  const auto add = [&](const std::string& line) { text += "// " + comment_text(line) + "\n"; };
  if (!functions.empty()) add("Without the functions " + functions + ": a model has equations only.");
  if (!events.empty()) add("Without the events " + events + ", which record or end a run.");
  if (program.active_constraints > 0)
    add("The accelerations satisfy the constraints. No projection keeps positions and rates from drifting.");
  return text;
}

}  // namespace

std::string modelica_name(const std::string& id) { return id_beside(id, modelica_words); }

std::vector<EmittedFile> emit_modelica(const program::Program& program, const EmissionContext& context) {
  require_consistent(program, context);
  require_plain(program, "modelica");
  require_no_start(context, "modelica", ": the start values of the default scene are attributes of the states");
  if (context.single_error)
    throw Error("emit", {}, "the target modelica has no single precision: Real of Modelica has 64 bits",
                "leave --real float out");
  require_smooth(program, context);
  const std::string name = modelica_name(context.id);
  ModelNames names = model_names(program, context, modelica_words);
  names.time = "time";
  const auto* const rhs = find_named(program.functions, "rhs");
  const ModelicaEquations stated =
      modelica_equations(print_statements(*rhs, names, context, modelica_language()), names);
  const std::string power =
      "  function power\n    input Real a;\n    input Real b;\n    output Real y;\n  algorithm\n    y := a^b;\n"
      "  end power;\n";
  const std::vector<std::pair<std::string, std::string>> values = {
      {"banner", banner(program, context, "// ", "// ", "")},
      {"omissions", modelica_omissions(program, context)},
      {"name", name},
      {"title", modelica_description(context.title)},
      {"declarations", modelica_declarations(context, program, names)},
      {"values", (stated.values.empty() && !stated.has_powers ? "" : "protected\n") + (stated.has_powers ? power : "") +
                     stated.values},
      {"equations", stated.equations},
      {"start_time", modelica_number(context.start_time)}};
  return {{name + ".mo", render_template(skeleton::modelica_model_mo, values, {})}};
}

}  // namespace eomgen::emit

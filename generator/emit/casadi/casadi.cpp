// SPDX-License-Identifier: GPL-3.0-or-later
// Target casadi: the C sources, and NAME_casadi.c with functions that CasADi loads by `external`.
#include <fmt/format.h>

#include <algorithm>

#include "emit/metadata.hpp"
#include "emit/targets.hpp"
#include "emit/text.hpp"
#include "error.hpp"
#include "lists.hpp"
#include "skeletons/casadi_model_casadi_c.hpp"

namespace eomgen::emit {
namespace {

/// The pattern of a matrix by columns, without entries that are always zero.
struct Pattern {
  std::size_t rows = 0, columns = 1;
  std::vector<std::size_t> places;  // of its entries, in a dense matrix by columns
};

Pattern dense(std::size_t rows, std::size_t columns = 1) {
  Pattern pattern{rows, columns, {}};
  for (std::size_t i = 0; i < rows * columns; ++i) pattern.places.push_back(i);
  return pattern;
}

/// The place of the k-th array among the results, which also have tests.
std::size_t place_of_array(const program::Function& function, std::size_t k) {
  std::size_t place = 0;
  for (;; ++place) {
    if (!function.results[place].is_test() && k-- == 0) return place;
  }
}

/// The entries of an array of results that are not the constant 0.
Pattern pattern_of(const program::Function& function, std::size_t array, std::size_t rows) {
  const std::size_t result = place_of_array(function, array);
  const std::vector<program::Operand>& entries = function.results[result].entries;
  Pattern pattern{rows, rows == 0 ? 0 : entries.size() / rows, {}};
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const program::Operand& entry = entries[i];
    if (entry.slot == program::Slot::constant && function.constants[entry.index] == 0) continue;
    pattern.places.push_back(result > 0 || function.result_indices.empty() ? i : function.result_indices[i]);
  }
  std::sort(pattern.places.begin(), pattern.places.end());
  return pattern;
}

/// An argument or result of a function of CasADi.
struct Port {
  std::string name;
  Pattern pattern;
};

struct CasadiFunction {
  std::string name, purpose;
  std::vector<Port> inputs, outputs;
  std::size_t work = 0;
  std::string body;
};

class Casadi {
 public:
  Casadi(const program::Program& program, const EmissionContext& context)
      : program_(program),
        name_(mangled_id(context.id)),
        states_(program.state_count()),
        inputs_{{"t", dense(1)},
                {"x", dense(states_)},
                {"p", dense(context.parameters.size())},
                {"u", dense(context.inputs.size())}} {
    for (const Port& input : inputs_) {
      places_.push_back(values_);
      values_ += input.pattern.rows;
    }
  }

  std::vector<CasadiFunction> functions() {
    std::vector<CasadiFunction> all{scene(), ode()};
    if (!has_derivatives()) return all;
    all.push_back(jacobian());
    all.push_back(forward());
    all.push_back(reverse());
    return all;
  }

  bool has_derivatives() const {
    return find("jac") != nullptr && (size(2) == 0 || find("jac_p") != nullptr) &&
           (size(3) == 0 || find("jac_u") != nullptr);
  }

  std::size_t values() const { return values_; }

  /// Statements that copy the arguments to w, with zeros for those that are missing.
  std::string read() const {
    std::string text;
    for (std::size_t i = 0; i < inputs_.size(); ++i)
      if (size(i) > 0) text += fmt::format("  {}_copy(arg[{}], {}, w{});\n", name_, i, size(i), offset(places_[i]));
    return text;
  }

 private:
  const program::Function* find(const std::string& name) const {
    for (const program::Function& function : program_.functions) {
      if (function.name == name) return &function;
    }
    return nullptr;
  }
  std::size_t size(std::size_t input) const { return inputs_[input].pattern.rows; }
  static std::string offset(std::size_t place) { return place == 0 ? "" : fmt::format(" + {}", place); }

  std::string arguments() const {
    return fmt::format("w[0], w{}, w{}, w{}, NULL", offset(places_[1]), offset(places_[2]), offset(places_[3]));
  }

  CasadiFunction scene() const {
    CasadiFunction f{
        name_ + "_scene", "The default scene: its start x, the parameters p and the inputs u.", {}, {}, 0, ""};
    f.outputs = {inputs_[1], inputs_[2], inputs_[3]};
    f.work = size(1) + size(2);
    f.body = fmt::format(
        "  (void)arg;\n  {0}_defaults(w, w{1});\n  {0}_give(w, {2}, res[0]);\n  {0}_give(w{1}, {3}, res[1]);\n", name_,
        offset(size(1)), size(1), size(2));
    if (size(3) > 0) f.body += fmt::format("  {0}_give({0}_default_inputs, {1}, res[2]);\n", name_, size(3));
    f.body += "  return 0;\n";
    return f;
  }

  CasadiFunction ode() const {
    CasadiFunction f{name_ + "_ode", "dx = d/dt of the state x. Contacts and kinks have mode 0.", inputs_, {}, 0, ""};
    f.outputs = {{"dx", dense(states_)}};
    f.work = values_ + states_;
    f.body = fmt::format(
        "  int code;\n  {0}_read(arg, w);\n  code = {0}_rhs({1}, w{2});\n  if (code != 0) return code;\n"
        "  {0}_give(w{2}, {3}, res[0]);\n  return 0;\n",
        name_, arguments(), offset(values_), states_);
    return f;
  }

  std::vector<Port> derivative_inputs() const {
    std::vector<Port> list = inputs_;
    list.push_back({"out_dx", {states_, 1, {}}});  // not read
    return list;
  }

  /// The Jacobian by each input, dense from this place of w on.
  std::vector<std::size_t> blocks() const {
    std::vector<std::size_t> list;
    std::size_t place = values_;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      list.push_back(place);
      place += states_ * size(i);
    }
    list.push_back(place);
    return list;
  }

  std::string evaluate() const {
    const std::vector<std::size_t> at = blocks();
    std::string text = fmt::format("  int code;\n  {0}_read(arg, w);\n  code = {0}_jac({1}, w{2}, w{3});\n", name_,
                                   arguments(), offset(at[1]), offset(at[0]));
    for (const auto& [input, function] : {std::pair<std::size_t, const char*>{2, "jac_p"}, {3, "jac_u"}})
      if (size(input) > 0)
        text +=
            fmt::format("  if (code == 0) code = {}_{}({}, w{});\n", name_, function, arguments(), offset(at[input]));
    return text + "  if (code != 0) return code;\n";
  }

  CasadiFunction jacobian() const {
    CasadiFunction f{"jac_" + name_ + "_ode", "The Jacobian of " + name_ + "_ode by every argument.",
                     derivative_inputs(),     {},
                     blocks().back(),         evaluate()};
    const std::vector<std::size_t> at = blocks();
    const Pattern patterns[] = {pattern_of(*find("jac"), 1, states_), pattern_of(*find("jac"), 0, states_),
                                size(2) > 0 ? pattern_of(*find("jac_p"), 0, states_) : Pattern{states_, 0, {}},
                                size(3) > 0 ? pattern_of(*find("jac_u"), 0, states_) : Pattern{states_, 0, {}}};
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      f.outputs.push_back({"jac_dx_" + inputs_[i].name, patterns[i]});
      const std::vector<std::size_t>& places = patterns[i].places;
      if (places.empty()) continue;
      f.body += wrapped(fmt::format("  {{ static const int at[{}] = {{{}}};", places.size(), fmt::join(places, ", ")),
                        "      ") +
                fmt::format("\n    {}_pick(w{}, {}, at, res[{}]); }}\n", name_, offset(at[i]), places.size(), i);
    }
    f.body += "  return 0;\n";
    return f;
  }

  CasadiFunction forward() const {
    CasadiFunction f{"fwd1_" + name_ + "_ode",
                     "A directional derivative: the Jacobian times a vector.",
                     derivative_inputs(),
                     {},
                     0,
                     evaluate()};
    const std::vector<std::size_t> at = blocks();
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      f.inputs.push_back({"fwd_" + inputs_[i].name, inputs_[i].pattern});
      if (size(i) > 0)
        f.body += fmt::format("  {}_add(w{}, {}, arg[{}], {}w{});\n", name_, offset(at[i]), size(i), 5 + i,
                              i == 0 ? "1, " : "0, ", offset(at.back()));
    }
    f.outputs = {{"fwd_dx", dense(states_)}};
    f.work = at.back() + states_;
    f.body += fmt::format("  {}_give(w{}, {}, res[0]);\n  return 0;\n", name_, offset(at.back()), states_);
    return f;
  }

  CasadiFunction reverse() const {
    CasadiFunction f{"adj1_" + name_ + "_ode", "An adjoint derivative: a row vector times the Jacobian.",
                     derivative_inputs(),      {},
                     blocks().back(),          evaluate()};
    f.inputs.push_back({"adj_dx", dense(states_)});
    const std::vector<std::size_t> at = blocks();
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      f.outputs.push_back({"adj_" + inputs_[i].name, inputs_[i].pattern});
      if (size(i) > 0)
        f.body += fmt::format("  {}_transposed(w{}, {}, arg[5], res[{}]);\n", name_, offset(at[i]), size(i), i);
    }
    f.body += "  return 0;\n";
    return f;
  }

  const program::Program& program_;
  std::string name_;
  std::size_t states_, values_ = 0;
  std::vector<Port> inputs_;
  std::vector<std::size_t> places_;
};

/// A sparsity pattern as CasADi reads it: rows, columns, the start of each column, the row of each entry.
std::string compressed(const Pattern& pattern) {
  std::vector<std::size_t> numbers{pattern.rows, pattern.columns, 0};
  std::vector<std::size_t> rows;
  for (std::size_t column = 0; column < pattern.columns; ++column) {
    for (const std::size_t place : pattern.places)
      if (place / pattern.rows == column) rows.push_back(place % pattern.rows);
    numbers.push_back(rows.size());
  }
  numbers.insert(numbers.end(), rows.begin(), rows.end());
  return fmt::format("{}", fmt::join(numbers, ", "));
}

class Patterns {
 public:
  explicit Patterns(std::string name) : name_(std::move(name)) {}
  std::string place(const Pattern& pattern) {
    const std::string text = compressed(pattern);
    const auto found = std::find(texts_.begin(), texts_.end(), text);
    const auto index = static_cast<std::size_t>(found - texts_.begin());
    if (found == texts_.end()) texts_.push_back(text);
    return fmt::format("{}_sparsity_{}", name_, index);
  }
  std::string declarations() const {
    std::string text;
    for (std::size_t i = 0; i < texts_.size(); ++i)
      text += wrapped(fmt::format("static const casadi_int {}_sparsity_{}[] = {{{}}};", name_, i, texts_[i]), "    ") +
              "\n";
    return text;
  }

 private:
  std::string name_;
  std::vector<std::string> texts_;
};

/// "case 0: return ..;" for each port.
std::string cases(const std::vector<std::string>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) text += fmt::format("    case {}: return {};\n", i, values[i]);
  return text;
}

}  // namespace

std::vector<EmittedFile> emit_casadi(const program::Program& program, const EmissionContext& context) {
  if (context.single_error)
    throw Error("emit", {}, "the target casadi has no single precision: CasADi computes with doubles",
                "leave --real float out, or use the target c");
  std::vector<EmittedFile> files = emit_c(program, context);
  const std::string name = mangled_id(context.id);
  Casadi casadi(program, context);
  Patterns patterns(name);
  std::vector<std::vector<std::pair<std::string, std::string>>> functions;
  for (const CasadiFunction& f : casadi.functions()) {
    const auto names = [](const std::vector<Port>& ports) {
      std::vector<std::string> list = mapped(ports, [&](const Port& port) { return "\"" + port.name + "\""; });
      return cases(list);
    };
    const auto sparsities = [&patterns](const std::vector<Port>& ports) {
      std::vector<std::string> list = mapped(ports, [&](const Port& port) { return patterns.place(port.pattern); });
      return cases(list);
    };
    functions.push_back({{"f", f.name},
                         {"purpose", f.purpose},
                         {"body", f.body},
                         {"n_in", std::to_string(f.inputs.size())},
                         {"n_out", std::to_string(f.outputs.size())},
                         {"names_in", names(f.inputs)},
                         {"names_out", names(f.outputs)},
                         {"sparsities_in", sparsities(f.inputs)},
                         {"sparsities_out", sparsities(f.outputs)},
                         {"work", std::to_string(f.work)}});
  }
  std::string inputs = joined(values_of(context.inputs), decimal);
  if (!inputs.empty())
    inputs = wrapped(fmt::format("static const double {}_default_inputs[] = {{{}}};", name, inputs), "    ") + "\n\n";
  const std::string hint =
      casadi.has_derivatives() ? "" : "\n * Derivatives are missing: emit with --with jac,jac_p,jac_u.";
  files.push_back({name + "_casadi.c", render_template(skeleton::casadi_model_casadi_c,
                                                       {{"banner", banner(program, context, "/* ", " * ", " */")},
                                                        {"name", name},
                                                        {"hint", hint},
                                                        {"default_inputs", inputs},
                                                        {"states", std::to_string(program.state_count())},
                                                        {"read", casadi.read()},
                                                        {"patterns", patterns.declarations()},
                                                        {"unused", casadi.has_derivatives() ? "1" : "0"}},
                                                       functions)});
  return files;
}

}  // namespace eomgen::emit

// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/straight_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "emit/names.hpp"
#include "emit/text.hpp"

namespace eomgen::emit {
namespace {

using program::Function;
using program::Instruction;
using program::Operand;
using program::Slot;
using symbolic::Op;

/// A piece of text and how tightly it binds.
struct Expression {
  enum Binding : std::uint8_t { sum, product, atom };
  std::string text;
  Binding binding = atom;
};

std::string in_parentheses(const Expression& e) { return fmt::format("({})", e.text); }
std::string at_least(const Expression& e, Expression::Binding binding) {
  return e.binding >= binding && e.text[0] != '-' ? e.text : in_parentheses(e);
}

// Shorter values that are used once are written where they are used.
constexpr std::size_t longest_inline = 64;

/// Operands that the printed form repeats must be names.
bool repeats_operands(Op op) { return op == Op::min || op == Op::max || op == Op::sign || op == Op::select; }

const char* function_name(Op op) {
  switch (op) {
    case Op::pow: return "pow";
    case Op::sqrt: return "sqrt";
    case Op::sin: return "sin";
    case Op::cos: return "cos";
    case Op::tan: return "tan";
    case Op::asin: return "asin";
    case Op::acos: return "acos";
    case Op::atan: return "atan";
    case Op::sinh: return "sinh";
    case Op::cosh: return "cosh";
    case Op::tanh: return "tanh";
    case Op::exp: return "exp";
    case Op::log: return "log";
    case Op::atan2: return "atan2";
    default: return nullptr;
  }
}

class Printer {
 public:
  Printer(const Function& function, const ModelNames& names, const EmissionContext& context, const Dialect& dialect)
      : function_(function), names_(names), context_(context), dialect_(dialect) {}

  FunctionText run() {
    declare_names();
    count_uses();
    test_ready(-1);
    for (std::size_t i = 0; i < function_.code.size(); ++i) {
      statement(i);
      test_ready(static_cast<std::ptrdiff_t>(i));
    }
    write_results();
    text_.body = unused_arguments() + using_declarations() + loads() + body_;
    return std::move(text_);
  }

 private:
  void declare_names() {
    for (const auto* list : {&names_.state, &names_.parameters, &names_.inputs}) {
      for (const std::string& name : *list) table_.declare(name);
    }
    for (const std::string& name : {names_.arguments_t, names_.x, names_.p, names_.u, names_.mode}) table_.declare(name);
    for (const auto& result : function_.results) text_.results.push_back(table_.declare(result.first));
  }

  void use(const Operand& operand, bool repeated) {
    if (operand.slot == Slot::value) {
      uses_[operand.index] += repeated ? 2 : 1;
    } else {
      leaves_.insert({operand.slot, operand.index});
    }
  }
  void count_uses() {
    uses_.assign(function_.code.size(), 0);
    for (const Instruction& instruction : function_.code) {
      for (const Operand& operand : instruction.operands) use(operand, repeats_operands(instruction.op));
    }
    for (const auto& [name, entries] : function_.results) {
      for (const Operand& operand : entries) use(operand, false);
    }
    for (const auto& test : function_.pivots) use(test.pivot, true), use(test.scale, true);
    value_.resize(function_.code.size());
  }

  Expression size_of(const Operand& operand) const {
    switch (operand.slot) {
      case Slot::constant: {
        const std::string text = dialect_.constant(function_.constants[operand.index]);
        return {text, text.find('/') == std::string::npos ? Expression::atom : Expression::product};
      }
      case Slot::pi: return {dialect_.pi, Expression::atom};
      case Slot::time: return {names_.arguments_t, Expression::atom};
      case Slot::state: return {names_.state[operand.index], Expression::atom};
      case Slot::parameter: return {names_.parameters[operand.index], Expression::atom};
      case Slot::input: return {names_.inputs[operand.index], Expression::atom};
      case Slot::value: break;
    }
    return value_[operand.index];
  }
  Expression signed_value(const Operand& operand) const {
    const Expression size = size_of(operand);
    if (!operand.negated) return size;
    return {fmt::format("-{}", at_least(size, Expression::product)), Expression::product};
  }

  Expression expression(const Instruction& instruction) {
    const auto& o = instruction.operands;
    const auto name = [&](std::size_t i) { return at_least(signed_value(o[i]), Expression::atom); };
    switch (instruction.op) {
      case Op::add: return sum(o);
      case Op::mul: return product(o);
      case Op::div: return {fmt::format("{}/{}", first_factor(o[0]), name(1)), Expression::product};
      case Op::abs: return call(dialect_.absolute, o);
      case Op::min: return conditional(name(1), name(0), name(1), name(0));
      case Op::max: return conditional(name(0), name(1), name(1), name(0));
      case Op::select: return conditional(name(0), name(1), name(2), name(3));
      case Op::sign: {
        const std::string zero = dialect_.constant(0), one = dialect_.constant(1);
        return {fmt::format("({0} > {1} ? {2} : {0} < {1} ? -{2} : {1})", name(0), zero, one), Expression::atom};
      }
      default: return call(function_name(instruction.op), o);
    }
  }
  static Expression conditional(const std::string& a, const std::string& b, const std::string& x, const std::string& y) {
    return {fmt::format("({} < {} ? {} : {})", a, b, x, y), Expression::atom};
  }
  Expression call(const std::string& name, const std::vector<Operand>& operands) {
    called_.insert(name);
    std::string arguments;
    for (const Operand& operand : operands) arguments += fmt::format("{}{}", arguments.empty() ? "" : ", ", signed_value(operand).text);
    return {fmt::format("{}({})", name, arguments), Expression::atom};
  }
  std::string first_factor(const Operand& operand) const {
    return operand.negated ? signed_value(operand).text : at_least(size_of(operand), Expression::product);
  }
  Expression product(const std::vector<Operand>& operands) const {
    std::string text = first_factor(operands[0]);
    for (std::size_t i = 1; i < operands.size(); ++i) {
      text += fmt::format("*{}", at_least(signed_value(operands[i]), Expression::atom));
    }
    return {text, Expression::product};
  }
  Expression sum(const std::vector<Operand>& operands) const {
    std::string text = first_factor(operands[0]);
    for (std::size_t i = 1; i < operands.size(); ++i) {
      text += operands[i].negated ? " - " : " + ";
      text += at_least(size_of(operands[i]), Expression::product);
    }
    return {text, Expression::sum};
  }

  /// "{3}_ddot" -> "phi_ddot".
  std::string suggested(const std::string& pattern) const {
    std::string result;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
      const std::size_t close = pattern[i] == '{' ? pattern.find('}', i) : std::string::npos;
      if (close == std::string::npos) {
        result += pattern[i];
      } else {
        result += names_.all_coordinates.at(std::stoul(pattern.substr(i + 1, close - i - 1)));
        i = close;
      }
    }
    return result;
  }

  /// A name that says what a sine or cosine is of: "sin_theta", "cos_theta1_minus_theta2".
  std::string trig_name(const Instruction& instruction) const {
    const std::string head = instruction.op == Op::sin ? "sin_" : "cos_";
    const Operand& argument = instruction.operands[0];
    if (argument.negated) return "";
    if (argument.slot != Slot::value) return argument.slot == Slot::constant ? "" : head + size_of(argument).text;
    const Instruction& inner = function_.code[argument.index];
    const auto& o = inner.operands;
    if (inner.op != Op::add || o.size() != 2 || o[0].negated) return "";
    for (const Operand& operand : o) {
      if (operand.slot != Slot::state && operand.slot != Slot::parameter) return "";
    }
    return head + size_of(o[0]).text + (o[1].negated ? "_minus_" : "_plus_") + size_of(o[1]).text;
  }

  void statement(std::size_t index) {
    const Instruction& instruction = function_.code[index];
    if (!instruction.section.empty()) section_ = instruction.section;
    const Expression e = expression(instruction);
    std::string name = suggested(instruction.name);
    const bool trig = instruction.op == Op::sin || instruction.op == Op::cos;
    if (name.empty() && trig) name = trig_name(instruction);
    if (name.empty() && !trig && uses_[index] <= 1 && e.text.size() <= longest_inline) {
      value_[index] = e;
      return;
    }
    name = name.empty() ? fmt::format("v{}", ++temporaries_) : table_.declare(name);
    line(fmt::format("const {} {} = {};", dialect_.real, name, e.text));
    value_[index] = {name, Expression::atom};
  }

  void line(const std::string& text) {
    if (section_ != printed_section_) {
      body_ += fmt::format("\n{}", comment(section_));
      printed_section_ = section_;
    }
    body_ += wrapped(fmt::format("  {}", text), "      ") + "\n";
  }
  std::string comment(const std::string& text) const {
    const std::string safe = comment_text(text);
    return dialect_.line_comments ? fmt::format("  // {}\n", safe) : fmt::format("  /* {} */\n", safe);
  }

  /// Tests whose values are known once instruction `last` is (-1: those of parameters and states).
  void test_ready(std::ptrdiff_t last) {
    for (const auto& test : function_.pivots) {
      std::ptrdiff_t needs = -1;
      for (const Operand* operand : {&test.pivot, &test.scale}) {
        if (operand->slot == Slot::value) needs = std::max(needs, static_cast<std::ptrdiff_t>(operand->index));
      }
      if (needs != last) continue;
      const std::string pivot = size_of(test.pivot).text;
      const bool exact = test.scale.slot == Slot::constant && function_.constants[test.scale.index] == 0;
      if (exact) {
        line(fmt::format("if ({} == {}) return 1;", pivot, dialect_.constant(0)));
      } else {
        called_.insert(dialect_.absolute);
        line(fmt::format("if ({0}({1}) <= {2}*{0}({3})) return 1;", dialect_.absolute, pivot,
                         dialect_.value(program::pivot_tolerance), size_of(test.scale).text));
      }
    }
  }

  void write_results() {
    section_ = "results";
    for (std::size_t r = 0; r < function_.results.size(); ++r) {
      const auto& entries = function_.results[r].second;
      for (std::size_t i = 0; i < entries.size(); ++i) {
        line(fmt::format("{}[{}] = {};", text_.results[r], i, signed_value(entries[i]).text) + remark(r, i));
      }
    }
    if (function_.name != "rhs") {
      line("return 0;");
      return;
    }
    const std::string& dx = text_.results[0];
    const std::size_t n = names_.acceleration.size();
    std::string sum = fmt::format("{}[{}]", dx, n);
    for (std::size_t i = 1; i < n; ++i) sum += fmt::format(" + {}[{}]", dx, n + i);
    // inf - inf and nan - nan are nan, which equals nothing
    const std::string finite = table_.declare("finite");
    line(fmt::format("const {} {} = {};", dialect_.real, finite, sum));
    line(fmt::format("return {0} - {0} == {1} ? 0 : 5;", finite, dialect_.constant(0)));
  }

  /// What an entry is, behind its line.
  std::string remark(std::size_t result, std::size_t entry) const {
    const std::size_t n = names_.acceleration.size();
    std::string text;
    if (function_.name == "rhs") text = entry < n ? "" : names_.acceleration[entry - n];
    if (function_.name == "jac" && result == 0 && entry % (2 * n) == 0) text = fmt::format("d/d {}", names_.state[entry / (2 * n)]);
    if (function_.name == "jac_p" && entry % (2 * n) == 0) text = fmt::format("d/d {}", names_.parameters[entry / (2 * n)]);
    if (function_.name == "outputs") text = names_.outputs[entry];
    if (function_.name == "reactions") text = names_.reactions[entry];
    if (text.empty()) return "";
    return dialect_.line_comments ? fmt::format("  // {}", text) : fmt::format("  /* {} */", text);
  }

  bool is_used(Slot slot) const {
    return std::any_of(leaves_.begin(), leaves_.end(), [slot](const auto& leaf) { return leaf.first == slot; });
  }
  /// The ABI gives these two functions no inputs: they see the defaults.
  bool takes_inputs() const { return function_.name != "mass" && function_.name != "constraints"; }
  std::string unused_arguments() const {
    std::vector<std::string> unused;
    if (!is_used(Slot::time)) unused.push_back(names_.arguments_t);
    if (!is_used(Slot::state)) unused.push_back(names_.x);
    if (!is_used(Slot::parameter)) unused.push_back(names_.p);
    if (takes_inputs() && !is_used(Slot::input)) unused.push_back(names_.u);
    if (takes_inputs()) unused.push_back(names_.mode);
    for (std::size_t r = 0; r < function_.results.size(); ++r) {
      if (function_.results[r].second.empty()) unused.push_back(text_.results[r]);
    }
    std::string result;
    for (const std::string& name : unused) result += fmt::format("{}(void){};", result.empty() ? "  " : " ", name);
    return result.empty() ? "" : result + "\n";
  }
  std::string using_declarations() const {
    if (!dialect_.using_std) return "";
    std::string result;
    for (const std::string& name : called_) result += fmt::format("{}using std::{};", result.empty() ? "  " : " ", name);
    return result.empty() ? "" : wrapped(result, "  ") + "\n";
  }

  std::string loads() const {
    std::string result;
    const auto load = [&](Slot slot, auto&& value) {
      std::string list;
      for (const auto& [leaf_slot, index] : leaves_) {
        if (leaf_slot != slot) continue;
        list += fmt::format("{} {} = {}", list.empty() ? fmt::format("  const {}", dialect_.real) : ",",
                            size_of({slot, index, false}).text, value(index));
      }
      if (!list.empty()) result += wrapped(list + ";", "      ") + "\n";
    };
    load(Slot::state, [&](std::uint32_t i) { return fmt::format("{}[{}]", names_.x, i); });
    load(Slot::parameter, [&](std::uint32_t i) { return fmt::format("{}[{}]", names_.p, i); });
    load(Slot::input, [&](std::uint32_t i) {
      if (!takes_inputs()) return dialect_.value(context_.inputs.at(i).value);
      return fmt::format("{0} ? {0}[{1}] : {2}", names_.u, i, dialect_.value(context_.inputs.at(i).value));
    });
    return result;
  }

  const Function& function_;
  const ModelNames& names_;
  const EmissionContext& context_;
  const Dialect& dialect_;
  NameTable table_;
  FunctionText text_;
  std::vector<std::uint32_t> uses_;
  std::set<std::pair<Slot, std::uint32_t>> leaves_;
  std::vector<Expression> value_;
  std::set<std::string> called_;
  std::string body_, section_, printed_section_;
  std::size_t temporaries_ = 0;
};

}  // namespace

ModelNames model_names(const program::Program& program, const EmissionContext& context) {
  NameTable table;
  ModelNames names;
  std::vector<std::string> dots;
  for (const Quantity& coordinate : context.coordinates) names.all_coordinates.push_back(identifier(coordinate.name));
  for (const std::uint32_t i : program.free) names.state.push_back(table.declare(context.coordinates.at(i).name));
  for (const std::uint32_t i : program.free) names.state.push_back(table.declare(context.coordinates.at(i).name + "_dot"));
  for (const std::uint32_t i : program.free) names.acceleration.push_back(context.coordinates.at(i).name + "_ddot");
  for (const Quantity& q : context.parameters) names.parameters.push_back(table.declare(q.name));
  for (const Quantity& q : context.inputs) names.inputs.push_back(table.declare(q.name));
  names.arguments_t = table.declare("t");
  names.x = table.declare("x");
  names.p = table.declare("p");
  names.u = table.declare("u");
  names.mode = table.declare("mode");
  NameTable outputs, reactions;
  for (const std::string& name : program.outputs) names.outputs.push_back(outputs.declare(name));
  for (const std::string& name : program.reactions) names.reactions.push_back(reactions.declare(name));
  return names;
}

FunctionText print_function(const program::Function& function, const ModelNames& names, const EmissionContext& context,
                            const Dialect& dialect) {
  return Printer(function, names, context, dialect).run();
}

}  // namespace eomgen::emit

// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/straight_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "emit/expressions.hpp"
#include "emit/names.hpp"
#include "emit/signature.hpp"
#include "emit/text.hpp"
#include "program/kinks.hpp"

namespace eomgen::emit {
namespace {

using program::Function;
using program::Instruction;
using program::Operand;
using program::Slot;
using symbolic::Op;
using Expression = Expressions::Expression;

// Shorter values that are used once are written where they are used.
constexpr std::size_t longest_inline = 64;

// Instructions of a function that stays whole, and of a part of a longer one.
constexpr std::size_t longest_function = 3000, longest_part = 1000;

// Of a function that has been told that its angles are near, and found that they are not.
constexpr int code_too_far = -1;

class Printer {
 public:
  Printer(const Function& function, const ModelNames& names, const EmissionContext& context, const Dialect& dialect)
      : function_(function), names_(names), context_(context), dialect_(dialect), expressions_(function, names, dialect) {}

  FunctionText run() {
    const auto& code = function_.code;
    const bool packs = std::any_of(code.begin(), code.end(), [](const Instruction& i) { return i.pack > 0; });
    text_.near_first = packs && dialect_.near_first && is_rhs();
    declare_names();
    divide();
    count_uses();
    test_ready(-1);
    for (std::size_t i = 0; i < function_.code.size(); ++i) {
      if (i > 0 && part_[i] != part_[i - 1]) close_part(part_[i - 1]);
      statement(i);
      test_ready(static_cast<std::ptrdiff_t>(i));
    }
    write_results();
    if (leaves_.size() == 1) text_.body = unused_arguments() + using_declarations() + loads(leaves_[0]) + body_;
    else close_part(leaves_.size() - 1);
    return std::move(text_);
  }

 private:
  void declare_names() {
    for (const auto* list : {&names_.sides, &names_.contacts, &names_.state, &names_.parameters, &names_.inputs}) {
      for (const std::string& name : *list) table_.declare(name);
    }
    for (const std::string& name : {names_.arguments_t, names_.x, names_.p, names_.w, names_.u, names_.mode}) table_.declare(name);
    if (text_.near_first) text_.guarded = guarded_ = table_.declare("guarded");
    for (const auto& result : function_.results) {
      if (!program::is_code(result.first)) text_.results.push_back(table_.declare(result.first));
    }
  }

  /// Which part each instruction is in; sines and cosines that are computed together stay so.
  void divide() {
    const auto& code = function_.code;
    part_.assign(code.size(), 0);
    std::size_t parts = 1;
    const bool long_one = code.size() > longest_function && function_.name != "taylor_next";
    for (std::size_t i = 0, since = 0; long_one && i < code.size(); ++i, ++since) {
      const bool together = i > 0 && code[i].pack != 0 && code[i].pack == code[i - 1].pack;
      if (since >= longest_part && !together) {
        ++parts;
        since = 0;
      }
      part_[i] = parts - 1;
    }
    leaves_.resize(parts);
    kept_.assign(code.size(), false);
    if (parts == 1) return;
    text_.work = table_.declare("work");
    text_.code = table_.declare("code");
  }
  void close_part(std::size_t part) {
    text_.parts.push_back(all_arguments() + using_declarations() + loads(leaves_[part]) + body_ + (part + 1 < leaves_.size() ? "  return 0;\n" : ""));
    body_.clear();
    printed_section_.clear();
  }

  void use(const Operand& operand, bool repeated, std::size_t part) {
    if (operand.slot == Slot::value) {
      uses_[operand.index] += repeated ? 2 : 1;
      if (part != part_[operand.index]) kept_[operand.index] = true;
    } else {
      leaves_[part].insert({operand.slot, operand.index});
    }
  }
  std::size_t part_of(const program::PivotTest& test) const {
    std::size_t part = 0;
    for (const Operand* operand : {&test.pivot, &test.scale})
      if (operand->slot == Slot::value) part = std::max(part, part_[operand->index]);
    return part;
  }
  void count_uses() {
    uses_.assign(function_.code.size(), 0);
    for (std::size_t i = 0; i < function_.code.size(); ++i) {
      const Instruction& instruction = function_.code[i];
      const bool same_angle = instruction.pack != 0 && i > 0 && function_.code[i - 1].pack == instruction.pack &&
                              function_.code[i - 1].lane == instruction.lane;
      if (same_angle) continue;  // the pack names it once
      for (const Operand& operand : instruction.operands) use(operand, repeats_operands(instruction.op), part_[i]);
    }
    for (const auto& [name, entries] : function_.results) {
      for (const Operand& operand : entries) use(operand, false, leaves_.size() - 1);
    }
    for (const auto& test : function_.pivots) use(test.pivot, true, part_of(test)), use(test.scale, true, part_of(test));
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
    if (argument.slot != Slot::value) return argument.slot == Slot::constant ? "" : head + expressions_.size_of(argument).text;
    const Instruction& inner = function_.code[argument.index];
    const auto& o = inner.operands;
    if (inner.op != Op::add || o.size() != 2 || o[0].negated) return "";
    for (const Operand& operand : o) {
      if (operand.slot != Slot::state && operand.slot != Slot::parameter) return "";
    }
    return head + expressions_.size_of(o[0]).text + (o[1].negated ? "_minus_" : "_plus_") + expressions_.size_of(o[1]).text;
  }

  void statement(std::size_t index) {
    const Instruction& instruction = function_.code[index];
    if (!instruction.section.empty()) section_ = instruction.section;
    if (instruction.pack > text_.packs) open_pack(index);
    const Expression e = instruction.pack == 0 ? expressions_.of(instruction) : from_pack(instruction);
    if (kept_[index]) {
      const std::string place = fmt::format("{}[{}]", text_.work, kept_count_++);
      text_.work_size = kept_count_;
      line(fmt::format("{} = {};", place, e.text));
      expressions_.set(index, {place, Expression::atom});
      return;
    }
    std::string name = suggested(instruction.name);
    const bool trig = instruction.op == Op::sin || instruction.op == Op::cos;
    if (name.empty() && trig) name = trig_name(instruction);
    if (name.empty() && !trig && uses_[index] <= 1 && e.text.size() <= longest_inline) {
      expressions_.set(index, e);
      return;
    }
    name = name.empty() ? fmt::format("v{}", ++temporaries_) : table_.declare(name);
    line(fmt::format("{} {} = {};", constant(), name, e.text));
    expressions_.set(index, {name, Expression::atom});
  }

  /// The angles that are ready with that of instruction `first`, and their sines and cosines.
  void open_pack(std::size_t first) {
    text_.packs = function_.code[first].pack;
    std::vector<std::string> angles;
    for (std::size_t i = first; i < function_.code.size() && function_.code[i].pack == text_.packs; ++i) {
      const Instruction& instruction = function_.code[i];
      if (instruction.lane == angles.size()) angles.push_back(expressions_.signed_value(instruction.operands[0]).text);
    }
    const std::size_t count = angles.size();
    if (count % 2 == 1) angles.push_back(dialect_.constant(0));
    const auto declared = [this](const char* name) {
      return table_.declare(text_.packs == 1 ? name : fmt::format("{}_{}", name, text_.packs));
    };
    sine_ = declared("sine");
    cosine_ = declared("cosine");
    line(fmt::format("{0} {2}[{1}], {3}[{1}];", dialect_.real, angles.size(), sine_, cosine_));
    if (!text_.near_first) return sincos_of(angles, "  ", "sincos", "");
    const std::string reach = declared("reach");
    line(fmt::format("{}lanes {} = {{0}};", dialect_.kernels, reach));
    body_ += fmt::format("  if ({}) {{\n", guarded_);
    sincos_of(angles, "    ", "sincos", "");
    body_ += "  } else {\n";
    sincos_of(angles, "    ", "sincos_near", ", &" + reach);
    body_ += fmt::format("    if (!{}is_near(&{})) return {};\n  }}\n", dialect_.kernels, reach, code_too_far);
  }
  void sincos_of(const std::vector<std::string>& angles, const std::string& indent, const std::string& function,
                 const std::string& more) {
    for (std::size_t i = 0; i < angles.size(); i += 2) {
      const std::string place = i == 0 ? "" : fmt::format(" + {}", i);
      body_ += wrapped(fmt::format("{}{}{}({}, {}, {}{}, {}{}{});", indent, dialect_.kernels, function, angles[i], angles[i + 1],
                                   sine_, place, cosine_, place, more), indent + "    ") + "\n";
    }
  }
  Expression from_pack(const Instruction& instruction) const {
    return {fmt::format("{}[{}]", instruction.op == Op::sin ? sine_ : cosine_, instruction.lane), Expression::atom};
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
      const std::string pivot = expressions_.size_of(test.pivot).text;
      const bool exact = test.scale.slot == Slot::constant && function_.constants[test.scale.index] == 0;
      if (exact) {
        line(fmt::format("if ({} == {}) return 1;", pivot, dialect_.constant(0)));
      } else {
        expressions_.call(dialect_.absolute);
        line(fmt::format("if ({0}({1}) <= {2}*{0}({3})) return 1;", dialect_.absolute, pivot,
                         dialect_.value(program::pivot_tolerance), expressions_.size_of(test.scale).text));
      }
    }
  }

  void write_results() {
    section_ = "results";
    for (std::size_t r = 0; r < function_.results.size(); ++r) {
      const auto& entries = function_.results[r].second;
      if (program::is_code(function_.results[r].first)) {
        end_where_negative(function_.results[r].first, entries);
        continue;
      }
      const bool optional = function_.name == "jac" && r == 1;  // dfdt may be NULL
      if (optional) body_ += fmt::format("  if ({}) {{\n", text_.results[r]);
      for (std::size_t i = 0; i < entries.size(); ++i) {
        const std::size_t place = r > 0 || function_.places.empty() ? i : function_.places[i];
        line(fmt::format("{}{}[{}] = {};", optional ? "  " : "", text_.results[r], place, expressions_.signed_value(entries[i]).text) + remark(r, place));
      }
      if (optional) body_ += "  }\n";
    }
    if (!is_rhs()) {
      line("return 0;");
      return;
    }
    const std::string& dx = text_.results[0];
    const std::size_t n = names_.acceleration.size();
    std::string sum = fmt::format("{}[{}]", dx, n);
    for (std::size_t i = n + 1; i < names_.state.size(); ++i) sum += fmt::format(" + {}[{}]", dx, i);
    // inf - inf and nan - nan are nan, which equals nothing
    const std::string finite = table_.declare("finite");
    line(fmt::format("{} {} = {};", constant(), finite, sum));
    line(fmt::format("return {0} - {0} <= {1} ? 0 : 5;", finite, dialect_.constant(0)));
  }

  void end_where_negative(const std::string& code, const std::vector<Operand>& entries) {
    for (const Operand& entry : entries) {
      line(fmt::format("if ({} < {}) return {};", expressions_.signed_value(entry).text, dialect_.constant(0), code.substr(1)));
    }
  }

  /// What an entry is, behind its line.
  std::string remark(std::size_t result, std::size_t entry) const {
    const std::size_t n = names_.acceleration.size(), all = names_.state.size();
    std::string text;
    if (function_.name == "rhs" && entry >= n && entry < 2 * n) text = names_.acceleration[entry - n];
    if (function_.name == "jac" && result == 0 && entry % all == 0) text = fmt::format("d/d {}", names_.state[entry / all]);
    if (function_.name == "jac_p" && entry % all == 0) text = fmt::format("d/d {}", names_.parameters[entry / all]);
    if (function_.name == "outputs") text = names_.outputs[entry];
    if (function_.name == "reactions") text = names_.reactions[entry];
    if (function_.name == "events") text = names_.events[entry];
    if (text.empty()) return "";
    return dialect_.line_comments ? fmt::format("  // {}", text) : fmt::format("  /* {} */", text);
  }

  /// What a declaration begins with.
  std::string constant() const { return dialect_.typed ? "const " + dialect_.real : "const"; }
  bool is_rhs() const { return function_.name == "rhs" || function_.name == "rhs_prepared"; }
  bool is_used(Slot slot) const {
    return std::any_of(leaves_[0].begin(), leaves_[0].end(), [slot](const auto& leaf) { return leaf.first == slot && slot != Slot::constant; });
  }
  /// Of a part, which has all arguments of the function whether it needs them or not.
  std::string all_arguments() const {
    if (!dialect_.typed) return "";
    std::string result = text_.near_first ? fmt::format("  (void){};", guarded_) : "";
    for (const Argument& argument : arguments(function_.name, text_, names_)) result += fmt::format("{}(void){};", result.empty() ? "  " : " ", argument.name);
    return result + fmt::format(" (void){};\n", text_.work);
  }
  /// The ABI gives these two functions no inputs: they see the defaults.
  bool takes_inputs() const { return function_.name != "mass" && function_.name != "constraints"; }
  std::string unused_arguments() const {
    if (!dialect_.typed) return "";
    std::vector<std::string> unused;
    for (const Argument& argument : arguments(function_.name, text_, names_)) {
      const bool used = is_used(argument.slot) || (argument.kind == Argument::Kind::mode && is_used(Slot::contact));
      if (argument.kind != Argument::Kind::result && !used) unused.push_back(argument.name);
    }
    for (std::size_t r = 0; r < text_.results.size(); ++r) {
      if (function_.results[r].second.empty()) unused.push_back(text_.results[r]);
    }
    std::string result;
    for (const std::string& name : unused) result += fmt::format("{}(void){};", result.empty() ? "  " : " ", name);
    return result.empty() ? "" : result + "\n";
  }
  std::string using_declarations() const {
    if (!dialect_.using_std) return "";
    std::string result;
    for (const std::string& name : expressions_.called()) result += fmt::format("{}using std::{};", result.empty() ? "  " : " ", name);
    return result.empty() ? "" : wrapped(result, "  ") + "\n";
  }

  using Leaves = std::set<std::pair<Slot, std::uint32_t>>;
  std::string loads(const Leaves& leaves) const {
    std::string result;
    const auto load = [&](Slot slot, auto&& value) {
      std::string list;
      for (const auto& [leaf_slot, index] : leaves) {
        if (leaf_slot != slot) continue;
        list += fmt::format("{} {} = {}", list.empty() ? "  " + constant() : ",",
                            expressions_.size_of({slot, index, false}).text, value(index));
      }
      if (!list.empty()) result += wrapped(list + ";", "      ") + "\n";
    };
    load(Slot::state, [&](std::uint32_t i) { return fmt::format("{}[{}]", names_.x, i); });
    load(Slot::parameter, [&](std::uint32_t i) { return fmt::format("{}[{}]", names_.p, i); });
    load(Slot::contact, [&](std::uint32_t i) {
      std::string digit = fmt::format("({} & {})", names_.mode, eom::contact_bits);
      for (std::uint32_t j = 0; j < i / 2; ++j) digit += fmt::format("/{}", eom::contact_states);
      if (!dialect_.typed) digit = fmt::format("({} | 0)", digit);  // whole numbers do not divide as such there
      const std::string one = dialect_.constant(1);
      if (i % 2 == 1) return fmt::format("{0} % {1} < {2} ? {3} : -{3}", digit, eom::contact_states, eom::contact_states / 2, one);
      return fmt::format("{0} % 3 == 2 ? -{1} : {0} % 3 == 1 ? {1} : {2}", digit, one, dialect_.constant(0));
    });
    load(Slot::input, [&](std::uint32_t i) {
      if (!takes_inputs()) return dialect_.value(context_.inputs.at(i).value);
      return fmt::format("{0} ? {0}[{1}] : {2}", names_.u, i, dialect_.value(context_.inputs.at(i).value));
    });
    // Two bits for each kink: held above its surface, held below.
    load(Slot::side, [&](std::uint32_t i) {
      const std::size_t bit = program::first_kink_bit + 2 * i;
      const std::string side = fmt::format("(({0} >> {1} & 1) - ({0} >> {2} & 1))", names_.mode, bit, bit + 1);
      if (!dialect_.typed) return side;
      return dialect_.using_std ? dialect_.real + side : fmt::format("({}){}", dialect_.real, side);
    });
    return result;
  }

  const Function& function_;
  const ModelNames& names_;
  const EmissionContext& context_;
  const Dialect& dialect_;
  Expressions expressions_;
  NameTable table_;
  FunctionText text_;
  std::vector<std::uint32_t> uses_;
  std::vector<std::size_t> part_;  // of each instruction
  std::vector<bool> kept_;         // values that a later part needs
  std::size_t kept_count_ = 0;
  std::vector<Leaves> leaves_;     // of each part
  std::string body_, section_, printed_section_, sine_, cosine_, guarded_;
  std::size_t temporaries_ = 0;
};

}  // namespace

std::string calls_of_parts(const std::string& name, const FunctionText& text, const std::string& arguments, const std::string& real) {
  std::string result = fmt::format("  {} {}[{}];\n", real, text.work, text.work_size);
  for (std::size_t k = 1; k <= text.parts.size(); ++k) {
    const std::string call = fmt::format("{}_part{}({}, {})", name, k, arguments, text.work);
    if (k == text.parts.size()) result += fmt::format("  return {};\n", call);
    else result += fmt::format("  {}{} = {};\n  if ({} != 0) return {};\n", k == 1 ? "int " : "", text.code, call, text.code, text.code);
  }
  return result;
}

FunctionText print_function(const program::Function& function, const ModelNames& names, const EmissionContext& context,
                            const Dialect& dialect) {
  return Printer(function, names, context, dialect).run();
}

}  // namespace eomgen::emit

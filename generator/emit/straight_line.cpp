// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/straight_line.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <eom/modes/contact_state.hpp>
#include <stdexcept>
#include <utility>

#include "emit/expressions.hpp"
#include "emit/names.hpp"
#include "emit/signature.hpp"
#include "emit/text.hpp"
#include "emit/uses.hpp"
#include "emit/value_names.hpp"
#include "program/internal_functions.hpp"

namespace eomgen::emit {
namespace {

// Loads of values that a function does not compute: entries of its arguments, and values decoded from `mode`.

/// The leaves of one kind and their values.
struct LeafLoads {
  program::Slot slot;
  std::vector<std::pair<std::uint32_t, std::string>> values;  // never empty
};

/// An entry of `mode`, which may be null.
std::string mode_entry(const ModelNames& names, std::size_t entry) {
  return fmt::format("({0} ? {0}[{1}] : 0)", names.mode, entry);
}

/// The value of a leaf from the arguments of one state. Without `takes_inputs`, inputs have their defaults.
std::string leaf_value(const Dialect& dialect, const ModelNames& names, const EmissionContext& context, Slot slot,
                       std::uint32_t i, bool takes_inputs) {
  switch (slot) {
    case Slot::state: return dialect.rounded(fmt::format("{}[{}]", names.x, i));
    case Slot::parameter: return dialect.rounded(fmt::format("{}[{}]", names.p, i));
    case Slot::vector: return dialect.rounded(fmt::format("{}[{}]", names.v, i));
    case Slot::contact: {
      const std::string state = mode_entry(names, i / 2), one = dialect.constant(1);
      if (i % 2 == 1) return fmt::format("{0} < {1} ? {2} : -{2}", state, eom::contact_states / 2, one);
      return fmt::format("{0} % 3 == 2 ? -{1} : {0} % 3 == 1 ? {1} : {2}", state, one, dialect.constant(0));
    }
    case Slot::input: {
      const std::string standing = dialect.value(context.inputs.at(i).value);
      const std::string given = dialect.rounded(fmt::format("{}[{}]", names.u, i));
      return takes_inputs ? fmt::format("{} ? {} : {}", names.u, given, standing) : standing;
    }
    case Slot::side: {  // 1: frozen above the surface, -1: below it
      const std::string side = mode_entry(names, names.first_kink + i);
      if (!dialect.is_typed) return side;
      return dialect.using_std ? dialect.real + side : fmt::format("({}){}", dialect.real, side);
    }
    default: break;
  }
  throw std::logic_error("this operand is no leaf");
}

/// The value of a leaf from the lanes of `block`.
std::string leaf_of_lanes(const Dialect& dialect, const ModelNames& names, const EmissionContext& context,
                          const std::string& block, Slot slot, std::uint32_t i, bool takes_inputs) {
  const auto entry = [&](int array) {
    return fmt::format("{}at({}, {}, {})", dialect.lane_prefix, block, array, i);
  };  // loads an entry of the arrays t, x, p, w, u, v
  switch (slot) {
    case Slot::time: return entry(0);
    case Slot::state: return entry(1);
    case Slot::parameter: return entry(2);
    case Slot::prepared: return entry(3);
    case Slot::vector: return entry(5);
    case Slot::input:
      return takes_inputs ? entry(4)
                          : fmt::format("{}all({})", dialect.lane_prefix, dialect.value(context.inputs.at(i).value));
    case Slot::contact:
      return fmt::format("{}{}({}, {})", dialect.lane_prefix, i % 2 == 1 ? "normal_sign" : "slides", block, i / 2);
    case Slot::side: return fmt::format("{}side({}, {})", dialect.lane_prefix, block, names.first_kink + i);
    default: break;
  }
  throw std::logic_error("this operand is no leaf");
}

/// The leaves of a function that need a name, and the expressions that load them: from the arguments of one state, or
/// from the lanes of `block` (templates/batch) if the dialect has lanes.
std::vector<LeafLoads> leaf_loads(const std::string& function, const Leaves& leaves, const ModelNames& names,
                                  const EmissionContext& context, const Dialect& dialect, const std::string& block) {
  const bool lanes = !dialect.lane_prefix.empty(), inputs = program::takes_inputs(function);
  std::vector<LeafLoads> result;
  for (const Slot slot : {Slot::time, Slot::prepared, Slot::state, Slot::parameter, Slot::vector, Slot::contact,
                          Slot::input, Slot::side}) {
    if ((slot == Slot::time || slot == Slot::prepared) && !lanes) continue;
    LeafLoads of{slot, {}};
    for (const auto& [leaf_slot, i] : leaves) {
      if (leaf_slot != slot) continue;
      of.values.emplace_back(i, lanes ? leaf_of_lanes(dialect, names, context, block, slot, i, inputs)
                                      : leaf_value(dialect, names, context, slot, i, inputs));
    }
    if (!of.values.empty()) result.push_back(std::move(of));
  }
  return result;
}

using Expression = Expressions::Expression;

// Return code of a function that assumed small angles and found a large one.
constexpr int code_too_far = -1;

class Printer {
 public:
  Printer(const Function& function, const ModelNames& names, const EmissionContext& context, const Dialect& dialect)
      : function_(function),
        names_(names),
        context_(context),
        dialect_(dialect),
        expressions_(function, names, dialect),
        uses_(count_uses(function)) {}

  FunctionText run() {
    const auto& code = function_.code;
    const bool packs = std::any_of(code.begin(), code.end(), [](const Instruction& i) { return i.pack > 0; });
    text_.near_angles_first = packs && dialect_.near_angles_first && is_rhs();
    declare_names();
    declare_work();
    test_ready(-1);
    for (std::size_t i = 0; i < function_.code.size(); ++i) {
      if (i > 0 && uses_.part[i] != uses_.part[i - 1]) close_part(uses_.part[i - 1]);
      statement(i);
      test_ready(static_cast<std::ptrdiff_t>(i));
    }
    write_results();
    if (parts() == 1)
      text_.body = (in_lanes() ? initial_lane_mask(0) : unused_arguments() + using_declarations()) + loads(0) + body_;
    else
      close_part(parts() - 1);
    if (in_lanes()) text_.library = expressions_.library_calls();
    return std::move(text_);
  }

 private:
  void declare_names() {
    for (const auto* list :
         {&names_.sides, &names_.contacts, &names_.state, &names_.parameters, &names_.inputs, &names_.vector}) {
      for (const std::string& name : *list) table_.declare(name);
    }
    for (const std::string& name : {names_.time, names_.x, names_.p, names_.w, names_.u, names_.mode})
      table_.declare(name);
    if (text_.near_angles_first) text_.guarded = guarded_ = table_.declare("guarded");
    if (in_lanes()) {
      text_.block = table_.declare("block");
      text_.block_index = table_.declare("now");
      valid_lanes_ = table_.declare("fine");
    }
    for (const auto& result : function_.results) {
      if (!result.is_test()) text_.results.push_back(table_.declare(result.name));
    }
  }

  void declare_work() {
    if (parts() == 1) return;
    text_.work = table_.declare("work");
    if (in_lanes()) kept_count_ = 1;
    text_.code = table_.declare("code");
  }
  void close_part(std::size_t part) {
    const bool last = part + 1 == parts();
    if (in_lanes()) {  // the first entry of the array passes the mask of valid lanes on
      const std::string hand_on =
          last ? "" : fmt::format("  {}[0] = ({}){};\n  return 0;\n", text_.work, dialect_.real, valid_lanes_);
      text_.parts.push_back(
          fmt::format("  (void){}; (void){}; (void){};\n", text_.block, text_.block_index, text_.work) +
          initial_lane_mask(part) + loads(part) + body_ + hand_on);
    } else {
      text_.parts.push_back(all_arguments() + using_declarations() + loads(part) + body_ +
                            (last ? "" : "  return 0;\n"));
    }
    body_.clear();
    printed_section_.clear();
  }

  void statement(std::size_t index) {
    const Instruction& instruction = function_.code[index];
    if (!instruction.section.empty()) section_ = instruction.section;
    if (instruction.pack > text_.packs) open_pack(index);
    const Expression e = instruction.pack == 0 ? expressions_.print(instruction) : from_pack(instruction);
    if (uses_.needed_later[index]) {
      const std::string place = fmt::format("{}[{}]", text_.work, kept_count_++);
      text_.work_size = kept_count_;
      line(fmt::format("{} = {};", place, e.text));
      expressions_.set(index, {place, Expression::atom});
      return;
    }
    std::string name = suggested_name(instruction.name, names_);
    const bool trig = instruction.op == Op::sin || instruction.op == Op::cos;
    if (name.empty() && trig) name = trig_name(function_, instruction, expressions_);
    if (name.empty() && !trig && uses_.count[index] <= 1 && e.text.size() <= max_inline_length) {
      expressions_.set(index, e);
      return;
    }
    name = name.empty() ? fmt::format("v{}", ++temporaries_) : table_.declare(name);
    line(fmt::format("{} {} = {};", dialect_.declaration_prefix(), name, e.text));
    expressions_.set(index, {name, Expression::atom});
  }

  /// The angles in the pack of instruction `first`, and their sines and cosines.
  void open_pack(std::size_t first) {
    text_.packs = function_.code[first].pack;
    std::vector<std::string> angles;
    for (std::size_t i = first; i < function_.code.size() && function_.code[i].pack == text_.packs; ++i) {
      const Instruction& instruction = function_.code[i];
      if (instruction.lane == angles.size())
        angles.push_back(expressions_.in_lanes(instruction.operands[0], true).text);
    }
    const std::size_t count = angles.size();
    if (count % 2 == 1 && !in_lanes()) angles.push_back(dialect_.constant(0));
    const auto declared = [this](const char* name) {
      return table_.declare(text_.packs == 1 ? name : fmt::format("{}_{}", name, text_.packs));
    };
    sine_ = declared("sine");
    cosine_ = declared("cosine");
    line(fmt::format("{0} {2}[{1}], {3}[{1}];", dialect_.real, angles.size(), sine_, cosine_));
    if (in_lanes()) return sincos_of_lanes(angles, declared("reach"));
    if (!text_.near_angles_first) return sincos_of(angles, "  ", "sincos", "");
    const std::string reach = declared("reach");
    line(fmt::format("{}lanes {} = {{0}};", dialect_.kernel_prefix, reach));
    body_ += fmt::format("  if ({}) {{\n", guarded_);
    sincos_of(angles, "    ", "sincos", "");
    body_ += "  } else {\n";
    sincos_of(angles, "    ", "sincos_near", ", &" + reach);
    body_ += fmt::format("    if (!{}is_near(&{})) return {};\n  }}\n", dialect_.kernel_prefix, reach, code_too_far);
  }
  void sincos_of(const std::vector<std::string>& angles, const std::string& indent, const std::string& function,
                 const std::string& more) {
    for (std::size_t i = 0; i < angles.size(); i += 2) {
      const std::string place = i == 0 ? "" : fmt::format(" + {}", i);
      body_ += wrapped(fmt::format("{}{}{}({}, {}, {}{}, {}{}{});", indent, dialect_.kernel_prefix, function, angles[i],
                                   angles[i + 1], sine_, place, cosine_, place, more),
                       indent + "    ") +
               "\n";
    }
  }
  void sincos_of_lanes(const std::vector<std::string>& angles, const std::string& reach) {
    body_ += fmt::format("  {} {} = {{0}};\n", dialect_.real, reach);
    for (std::size_t i = 0; i < angles.size(); ++i) {
      body_ += wrapped(fmt::format("  {0}sincos({1}, &{2}[{4}], &{3}[{4}], &{5});", dialect_.lane_prefix, angles[i],
                                   sine_, cosine_, i, reach),
                       "      ") +
               "\n";
    }
    require(fmt::format("{} <= {}", reach, dialect_.sincos_range));
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

  /// Prints the tests whose values are known after instruction `last` (-1: those of parameters and states).
  void test_ready(std::ptrdiff_t last) {
    for (const auto& test : function_.pivots) {
      std::ptrdiff_t needs = -1;
      for (const Operand* operand : {&test.pivot, &test.scale}) {
        if (operand->slot == Slot::value) needs = std::max(needs, static_cast<std::ptrdiff_t>(operand->index));
      }
      if (needs != last) continue;
      const std::string pivot = expressions_.in_lanes(test.pivot).text;
      const bool exact = test.scale.slot == Slot::constant && function_.constants[test.scale.index] == 0;
      if (in_lanes()) {
        require(exact ? fmt::format("{} != {}", pivot, dialect_.constant(0))
                      : fmt::format("{0}abs({1}) > {2}*{0}abs({3})", dialect_.lane_prefix, pivot,
                                    dialect_.value(dialect_.pivot_tolerance), expressions_.in_lanes(test.scale).text));
      } else if (exact) {
        line(fmt::format("if ({} == {}) return 1;", pivot, dialect_.constant(0)));
      } else {
        expressions_.call(dialect_.abs_function);
        const std::string least =
            dialect_.rounded(fmt::format("{}*{}({})", dialect_.value(dialect_.pivot_tolerance), dialect_.abs_function,
                                         expressions_.unsigned_value(test.scale).text));
        line(fmt::format("if ({}({}) <= {}) return 1;", dialect_.abs_function, pivot, least));
      }
    }
  }

  void write_results() {
    section_ = "results";
    if (in_lanes()) return results_of_lanes();
    for (std::size_t r = 0; r < function_.results.size(); ++r) {
      const auto& entries = function_.results[r].entries;
      if (function_.results[r].is_test()) {
        end_where_negative(function_.results[r].code, entries);
        continue;
      }
      const bool optional = may_be_null(r);
      if (optional) body_ += fmt::format("  if ({}) {{\n", text_.results[r]);
      for (std::size_t i = 0; i < entries.size(); ++i) {
        const std::size_t place = r > 0 || function_.result_indices.empty() ? i : function_.result_indices[i];
        line(fmt::format("{}{}[{}] = {};", optional ? "  " : "", text_.results[r], place,
                         expressions_.signed_value(entries[i]).text) +
             remark(r, place));
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
    for (std::size_t i = n + 1; i < names_.state.size(); ++i)
      sum = dialect_.rounded(fmt::format("{} + {}[{}]", sum, dx, i));
    // inf - inf and nan - nan are nan, which compares false
    const std::string finite = table_.declare("finite");
    line(fmt::format("{} {} = {};", dialect_.declaration_prefix(), finite, sum));
    line(fmt::format("return {0} - {0} <= {1} ? 0 : 5;", finite, dialect_.constant(0)));
  }

  /// Lanes that fail a test are recomputed by the function of one state, which returns the code.
  void results_of_lanes() {
    std::string finite;
    for (const program::Result& result : function_.results) {
      if (!result.is_test()) continue;
      for (const Operand& entry : result.entries)
        require(fmt::format("{} >= {}", expressions_.in_lanes(entry, true).text, dialect_.constant(0)));
    }
    for (std::size_t i = 0; is_rhs() && i < function_.results[0].entries.size(); ++i) {
      const std::size_t place = function_.result_indices.empty() ? i : function_.result_indices[i];
      if (place >= names_.acceleration.size())
        finite += (finite.empty() ? "" : " + ") + expressions_.in_lanes(function_.results[0].entries[i], true).text;
    }
    if (!finite.empty()) {
      const std::string sum = table_.declare("finite");
      line(fmt::format("const {} {} = {};", dialect_.real, sum, finite));
      require(fmt::format("{0} - {0} <= {1}", sum, dialect_.constant(0)));
    }
    const std::string place = table_.declare("place");
    line(fmt::format("const struct {0}target* {1} = {0}place({2}, {3});", dialect_.lane_prefix, place, text_.block,
                     valid_lanes_));
    const std::string step = table_.declare("step");
    line(fmt::format("const size_t {0} = {1}->step;", step, place));
    for (std::size_t r = 0, k = 0; r < function_.results.size(); ++r) {
      const std::vector<Operand>& entries = function_.results[r].entries;
      if (function_.results[r].is_test()) continue;
      const std::string& to = text_.results[k];
      body_ += fmt::format("  {}* const {} = {}to({}, {}, {});\n", dialect_.lane_type, to, dialect_.lane_prefix, place,
                           text_.block_index, k++);
      if (entries.empty()) body_ += fmt::format("  (void){};\n", to);
      const bool optional = may_be_null(r);
      if (optional) body_ += fmt::format("  if ({}) {{\n", to);
      for (std::size_t i = 0; i < entries.size(); ++i) {
        const std::size_t at = r > 0 || function_.result_indices.empty() ? i : function_.result_indices[i];
        line(fmt::format("{}{}store({} + {}*{}, {});", optional ? "  " : "", dialect_.lane_prefix, to, at, step,
                         expressions_.in_lanes(entries[i], true).text) +
             remark(r, at));
      }
      if (optional) body_ += "  }\n";
    }
    line(fmt::format("return {} != &{}->target;", place, text_.block));
  }
  void require(const std::string& condition) {
    line(fmt::format("{} &= ({}mask)({});", valid_lanes_, dialect_.lane_prefix, condition));
  }
  std::string initial_lane_mask(std::size_t part) const {
    return part == 0
               ? fmt::format("  {0}mask {1} = {0}whole();\n", dialect_.lane_prefix, valid_lanes_)
               : fmt::format("  {0}mask {1} = ({0}mask){2}[0];\n", dialect_.lane_prefix, valid_lanes_, text_.work);
  }

  void end_where_negative(int code, const std::vector<Operand>& entries) {
    for (const Operand& entry : entries) {
      line(fmt::format("if ({} < {}) return {};", expressions_.signed_value(entry).text, dialect_.constant(0), code));
    }
  }

  std::string remark(std::size_t result, std::size_t entry) const {
    const std::string text = result_entry_name(function_, names_, result, entry);
    if (text.empty()) return "";
    return dialect_.line_comments ? fmt::format("  // {}", text) : fmt::format("  /* {} */", text);
  }

  bool in_lanes() const { return !dialect_.lane_prefix.empty(); }
  bool is_rhs() const { return program::is_right_hand_side(function_); }
  /// Unused-argument casts of a part, which has all arguments of the function.
  std::string all_arguments() const {
    if (!dialect_.is_typed) return "";
    std::vector<std::string> names;
    if (text_.near_angles_first) names.push_back(guarded_);
    for (const Argument& argument : arguments(function_.name, text_, names_)) names.push_back(argument.name);
    names.push_back(text_.work);
    return void_casts(names);
  }
  bool may_be_null(std::size_t result) const { return program::may_be_null(function_.name, result); }
  std::string unused_arguments() const {
    return dialect_.is_typed ? void_casts(unread_arguments(function_, text_, names_, uses_.leaves[0])) : "";
  }
  std::string using_declarations() const {
    if (!dialect_.using_std) return "";
    std::string result;
    for (const std::string& name : expressions_.library_calls())
      result += fmt::format("{}using std::{};", result.empty() ? "  " : " ", name);
    return result.empty() ? "" : wrapped(result, "  ") + "\n";
  }

  std::size_t parts() const { return uses_.leaves.size(); }
  std::string loads(std::size_t part) const {
    std::string result;
    for (const auto& [slot, values] : leaf_loads(function_.name, uses_.leaves[part], names_, context_, dialect_,
                                                 text_.block + ", " + text_.block_index)) {
      std::string list;
      for (const auto& [index, value] : values)
        list += fmt::format("{} {} = {}", list.empty() ? "  " + dialect_.declaration_prefix() : ",",
                            expressions_.unsigned_value({slot, index, false}).text, value);
      result += wrapped(list + ";", "      ") + "\n";
    }
    return result;
  }

  const Function& function_;
  const ModelNames& names_;
  const EmissionContext& context_;
  const Dialect& dialect_;
  Expressions expressions_;
  NameTable table_;
  FunctionText text_;
  Uses uses_;
  std::size_t kept_count_ = 0;
  std::string body_, section_, printed_section_, sine_, cosine_, guarded_, valid_lanes_;
  std::size_t temporaries_ = 0;
};

}  // namespace

FunctionText print_function(const program::Function& function, const ModelNames& names, const EmissionContext& context,
                            const Dialect& dialect) {
  return Printer(function, names, context, dialect).run();
}

}  // namespace eomgen::emit

// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emit/expressions.hpp"
#include "emit/languages/language.hpp"
#include "emit/names.hpp"
#include "emit/text.hpp"
#include "emit/uses.hpp"
#include "emit/value_names.hpp"
#include "error.hpp"
#include "program/internal_functions.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::emit {
namespace {

// Shorter values that are used once are printed inline.
constexpr std::size_t longest_inline_value = 64;

class StatementPrinter {
 public:
  StatementPrinter(const program::Function& function, const ModelNames& names, const EmissionContext& context,
                   const Language& language)
      : function_(function),
        names_(names),
        context_(context),
        language_(language),
        expressions_(function, names, language.dialect),
        uses_(count_uses(function)),
        table_(language.longest_name) {}

  FunctionText run() {
    declare_names();
    test_ready(-1);
    for (std::size_t i = 0; i < function_.code.size(); ++i) {
      if (i > 0 && is_split() && uses_.part[i] != uses_.part[i - 1]) close_part(uses_.part[i - 1]);
      statement(i);
      test_ready(static_cast<std::ptrdiff_t>(i));
    }
    write_results();
    if (is_split())
      close_part(uses_.leaves.size() - 1);
    else
      text_.body = loads(all_leaves()) + body_;
    return std::move(text_);
  }

 private:
  bool is_split() const { return language_.has_parts && uses_.leaves.size() > 1; }

  void declare_names() {
    for (const std::string_view word : language_.reserved) table_.declare(std::string(word));
    for (const auto* list :
         {&names_.sides, &names_.contacts, &names_.state, &names_.parameters, &names_.inputs, &names_.vector}) {
      for (const std::string& name : *list) table_.declare(name);
    }
    for (const std::string& name : {names_.time, names_.x, names_.p, names_.w, names_.u, names_.mode})
      table_.declare(name);
    for (const program::Result& result : function_.results) {
      if (!result.is_test()) text_.results.push_back(table_.declare(result.name));
    }
    text_.code = table_.declare("code");
    if (is_split()) text_.work = table_.declare("work");
    text_.work_size = 0;
  }

  void close_part(std::size_t part) {
    const bool last = part + 1 == uses_.leaves.size();
    text_.parts.push_back(loads(uses_.leaves[part]) + body_ + (last ? "" : "  " + language_.end + "\n"));
    body_.clear();
    printed_section_.clear();
  }

  void statement(std::size_t index) {
    const program::Instruction& instruction = function_.code[index];
    if (!instruction.section.empty()) section_ = instruction.section;
    const Expressions::Expression e = expressions_.print(instruction);
    if (is_split() && uses_.needed_later[index]) {
      const std::string place = element(text_.work, text_.work_size++);
      line(fmt::format("{} = {};", place, e.text));
      expressions_.set(index, {place, Expressions::Expression::atom});
      return;
    }
    std::string name = suggested_name(instruction.name, names_);
    const bool trig = instruction.op == symbolic::Op::sin || instruction.op == symbolic::Op::cos;
    if (name.empty() && trig) name = trig_name(function_, instruction, expressions_);
    if (name.empty() && !trig && uses_.count[index] <= 1 && e.text.size() <= longest_inline_value) {
      expressions_.set(index, e);
      return;
    }
    name = name.empty() ? fmt::format("v{}", ++temporaries_) : table_.declare(name);
    line(language_.declaration(name, e.text));
    expressions_.set(index, {name, Expressions::Expression::atom});
  }

  void line(const std::string& text) {
    if (section_ != printed_section_) {
      body_ += fmt::format("\n  {}{}\n", language_.comment, comment_text(section_));
      printed_section_ = section_;
    }
    body_ += fmt::format("  {}\n", text);
  }

  /// Tests whose values are known after instruction `last` (-1: those of arguments).
  void test_ready(std::ptrdiff_t last) {
    const Dialect& dialect = language_.dialect;
    for (const program::PivotTest& test : function_.pivots) {
      std::ptrdiff_t needs = -1;
      for (const program::Operand* operand : {&test.pivot, &test.scale}) {
        if (operand->slot == program::Slot::value) needs = std::max(needs, static_cast<std::ptrdiff_t>(operand->index));
      }
      if (needs != last) continue;
      const std::string pivot = expressions_.unsigned_value(test.pivot).text;
      const bool exact = test.scale.slot == program::Slot::constant && function_.constants[test.scale.index] == 0;
      line(language_.stop(
          exact ? fmt::format("{} == {}", pivot, dialect.constant(0))
                : fmt::format("{0}({1}) <= {2}*{0}({3})", dialect.abs_function, pivot,
                              dialect.value(dialect.pivot_tolerance), expressions_.unsigned_value(test.scale).text),
          1));
    }
  }

  void write_results() {
    section_ = "results";
    std::size_t written = 0;
    for (std::size_t r = 0; r < function_.results.size(); ++r) {
      const program::Result& result = function_.results[r];
      if (result.is_test()) {
        for (const program::Operand& entry : result.entries)
          line(language_.stop(
              fmt::format("{} < {}", expressions_.signed_value(entry).text, language_.dialect.constant(0)),
              result.code));
        continue;
      }
      const std::string& array = text_.results[written++];
      const bool optional = language_.if_wanted != nullptr && program::may_be_null(function_.name, r);
      if (optional) line(language_.if_wanted(array));
      for (std::size_t i = 0; i < result.entries.size(); ++i) {
        const std::size_t place = r > 0 || function_.result_indices.empty() ? i : function_.result_indices[i];
        const std::string remark = result_entry_name(function_, names_, r, place);
        line(fmt::format("{}{} = {};{}", optional ? "  " : "", element(array, place),
                         expressions_.signed_value(result.entries[i]).text,
                         remark.empty() ? "" : "  " + language_.comment + remark));
      }
      if (optional) line(language_.end_if);
    }
    if (program::is_right_hand_side(function_)) test_finite();
    if (!language_.end.empty()) line(language_.end);
  }

  /// inf - inf and nan - nan are nan, which compares false.
  void test_finite() {
    const std::size_t n = names_.acceleration.size();
    std::string sum;
    for (std::size_t i = n; i < names_.state.size(); ++i)
      sum += (sum.empty() ? "" : " + ") + element(text_.results[0], i);
    const std::string finite = table_.declare("finite");
    line(language_.declaration(finite, sum));
    line(language_.stop(language_.negation(fmt::format("{0} - {0} <= {1}", finite, language_.dialect.constant(0))), 5));
  }

  std::string element(const std::string& array, std::size_t index) const {
    return language_.dialect.element(array, index);
  }

  Leaves all_leaves() const {
    Leaves all;
    for (const Leaves& leaves : uses_.leaves) all.insert(leaves.begin(), leaves.end());
    return all;
  }

  std::string loads(const Leaves& leaves) const {
    std::string text;
    for (const auto& [slot, index] : leaves) {
      const std::string value = loaded(slot, index);
      if (value.empty()) continue;
      const std::string name = expressions_.unsigned_value({slot, index, false}).text;
      text += fmt::format("  {}\n", language_.declaration(name, value));
    }
    return text;
  }

  std::string converted(const std::string& text) const {
    return language_.conversion.empty() ? text : fmt::format("{}({})", language_.conversion, text);
  }

  /// The value of a leaf that needs a name, or nothing.
  std::string loaded(program::Slot slot, std::uint32_t index) const {
    using program::Slot;
    switch (slot) {
      case Slot::state: return converted(element(names_.x, index));
      case Slot::parameter: return converted(element(names_.p, index));
      case Slot::input:
        return program::takes_inputs(function_.name)
                   ? converted(element(names_.u, index))
                   : converted(language_.dialect.value(context_.inputs.at(index).value));
      case Slot::vector: return converted(element(names_.v, index));
      case Slot::contact:
        return fmt::format("{}({})", index % 2 == 1 ? "normal_sign" : "slides", element(names_.mode, index / 2));
      case Slot::side: return fmt::format("side({})", element(names_.mode, names_.first_kink + index));
      default: return "";
    }
  }

  const program::Function& function_;
  const ModelNames& names_;
  const EmissionContext& context_;
  const Language& language_;
  Expressions expressions_;
  Uses uses_;
  NameTable table_;
  FunctionText text_;
  std::string body_, section_, printed_section_;
  std::size_t temporaries_ = 0;
};

}  // namespace

FunctionText print_statements(const program::Function& function, const ModelNames& names,
                              const EmissionContext& context, const Language& language) {
  program::Function alone = function;  // sines and cosines one by one
  for (program::Instruction& instruction : alone.code) instruction.pack = instruction.lane = 0;
  return StatementPrinter(alone, names, context, language).run();
}

std::string quoted(const std::string& text, const std::string& also) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte >= 0x7f) {
      result += '?';
    } else {
      if (c == '"' || c == '\\' || also.find(c) != std::string::npos) result += '\\';
      result += c;
    }
  }
  return result + "\"";
}

std::string number_or(double value, const char* not_a_number, const char* infinity, const char* minus_infinity) {
  if (std::isfinite(value)) return decimal(value);
  return std::isnan(value) ? not_a_number : value > 0 ? infinity : minus_infinity;
}

const char* real_function(symbolic::Op op) {
  using symbolic::Op;
  switch (op) {
    case Op::sqrt: return "real_sqrt";
    case Op::log: return "real_log";
    case Op::pow: return "real_pow";
    case Op::acos: return "real_acos";
    case Op::asin: return "real_asin";
    default: return symbolic::function_of(op).code;
  }
}

void require_no_start(const EmissionContext& context, const std::string& target, const std::string& remedy) {
  // A run needs the start too: the command warns that the target has none.
  if (context.start_functions && !context.run)
    throw Error("emit", {}, fmt::format("the target {} has no function start", target),
                "leave start out of --with" + remedy);
}

void require_plain(const program::Program& program, const std::string& target) {
  const auto refuse = [&](bool is_there, const std::string& what, const std::string& option) {
    if (is_there)
      throw Error("emit", {}, fmt::format("the target {} does not support {}", target, what),
                  fmt::format("leave {} out of --with, or use the target c or cpp", option));
  };
  refuse(program.taylor.has_value(), "Taylor series", "taylor");
  refuse(!program.charts.empty(), "charts", "charts");
}

}  // namespace eomgen::emit

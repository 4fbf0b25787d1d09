// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/self_test.hpp"

#include <cln/dfloat.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/output/decimal.hpp>
#include <numbers>

#include "abi/functions.hpp"
#include "emit/single_precision.hpp"
#include "emit/start/start.hpp"
#include "emit/text.hpp"
#include "lists.hpp"
#include "numeric/numbers.hpp"
#include "program/abi_values.hpp"
#include "program/internal_functions.hpp"

namespace eomgen::emit {
namespace {

constexpr int digits = 40;
// Relative to the largest entry; smaller errors are not detected.
constexpr double relative_tolerance = 1e-11, single_relative_tolerance = 1e-5;
// The range of normal numbers of single precision, with a margin.
constexpr double single_least_number = 1e-37, single_largest_number = 1e37;
// Safety factor on the first-order rounding bound.
constexpr double safety_factor = 16;
constexpr int taylor_order = 4;
// Limit of values per function. The second vector is always tested, the others while they fit.
constexpr std::size_t max_values = 3000;

std::vector<cln::cl_R> exact(const std::vector<double>& values) { return mapped<cln::cl_R>(values, numeric::exact); }

program::AbiArguments arguments_of(const TestVector& at, const EmissionContext& context) {
  program::AbiArguments arguments;
  arguments.at.t = numeric::exact(at.t);
  arguments.at.x = exact(at.x);
  arguments.at.p = exact(at.p);
  arguments.at.u = exact(at.u);
  arguments.at.v = exact(at.v);
  arguments.at.mode = at.mode;
  arguments.order = taylor_order;
  for (const Quantity& input : context.inputs) arguments.default_inputs.push_back(numeric::exact(input.value));
  return arguments;
}

/// Values rounded to double, with tolerances from the rounding bounds; nothing if a number is out of range.
std::optional<FunctionValues> rounded(const std::string& function, const program::AbiResults& results,
                                      const std::vector<std::vector<double>>& bounds, bool single) {
  const double largest_number = single ? single_largest_number : 1e290;
  constexpr double least_number = 1e-290;
  FunctionValues values{function, 0, {}, {}};
  for (std::size_t r = 0; r < results.size(); ++r) {
    double largest = 0, off = 0;
    values.values.emplace_back();
    for (std::size_t i = 0; i < results[r].size(); ++i) {
      const double value = cln::double_approx(results[r][i]);
      if (!(std::fabs(value) < largest_number) || !(bounds[r][i] < largest_number)) return std::nullopt;
      values.values.back().push_back(value);
      largest = std::max(largest, std::fabs(value));
      off = std::max(off, bounds[r][i]);
    }
    // Tolerances are rounded up to two digits.
    const double tolerance = single ? std::max({single_relative_tolerance * largest,
                                                single_to_double_ulp * safety_factor * off, single_least_number})
                                    : std::max({relative_tolerance * largest, safety_factor * off, least_number});
    const std::string text = fmt::format("{:.1e}", 1.05 * tolerance);
    eom::decimals::read_decimal(text, values.tolerances.emplace_back());
  }
  return values;
}

std::optional<FunctionValues> values_at(const program::Program& program, const std::string& function,
                                        const program::AbiArguments& arguments, bool single) {
  const std::optional<program::AbiResults> results = program::abi_values(program, function, arguments, digits);
  if (!results) return std::nullopt;
  return rounded(function, *results, program::abi_error_bounds(program, function, arguments), single);
}

std::size_t entries(const program::Program& program, const std::string& function) {
  if (function == "taylor") return program.state_count() * (taylor_order + 1);
  std::size_t count = 0;
  for (const program::Function& f : program.functions) {
    if (f.name != function) continue;
    for (const auto& result : f.results) count += result.is_test() ? 0 : result.entries.size();
  }
  return count;
}

bool has_mode(const TestVector& test) {
  return std::any_of(test.mode.begin(), test.mode.end(), [](int entry) { return entry != 0; });
}

bool is_held(std::size_t count, std::size_t index) { return (index + 1) * count <= max_values || index == 1; }

/// The state in other charts, bit by bit as in NAME_chart.
void add_charts(const program::Program& program, const program::AbiArguments& arguments, bool single,
                TestVector& vector) {
  const unsigned from = program::program_in_charts(program, arguments.at.mode)->in_charts;
  for (unsigned to = 0; to < 1u << program.charts.size(); ++to) {
    if (to == from) continue;
    program::Arguments<cln::cl_R> at = arguments.at;
    FunctionValues values{"chart", to, {}, {}};
    std::vector<double> off;
    try {
      for (std::size_t j = 0; j < program.charts.size(); ++j) {
        if (((to ^ from) >> j & 1u) == 0) continue;
        const program::Function& exchange = (to >> j & 1u) != 0 ? program.charts[j].to : program.charts[j].back;
        at.x = program::interpret(exchange, at, digits).results[0];
      }
    } catch (const std::domain_error&) {
      continue;
    }
    // At half a turn rounding selects pi or -pi, which are the same angle.
    const auto at_half_a_turn = [](const cln::cl_R& x) {
      return std::fabs(std::fabs(cln::double_approx(x)) - std::numbers::pi) < 1e-6;
    };
    if (std::any_of(at.x.begin(), at.x.end(), at_half_a_turn)) continue;
    // The formulas contain a few sines; their rounding error is far below this.
    const std::vector<std::vector<double>> bounds{std::vector<double>(at.x.size(), 1e-14)};
    if (const auto found = rounded("chart", {at.x}, bounds, single)) {
      vector.functions.push_back(*found);
      vector.functions.back().to = to;
    }
  }
}

std::string comment(const Dialect& dialect, const std::string& text) {
  return dialect.line_comments ? "// " + text : "/* " + text + " */";
}

/// C++ has both types and tests its templates in double precision.
std::string real_of(const EmissionContext& context, const Dialect& dialect) {
  return context.single_error && dialect.real == "float" ? "float" : "double";
}

class Body {
 public:
  Body(const program::Program& program, const EmissionContext& context, const SelfTestNames& names,
       const Dialect& dialect)
      : program_(program),
        context_(context),
        names_(names),
        dialect_(dialect),
        real_(real_of(context, dialect)),
        suffix_(real_ == "float" ? "f" : ""),
        at_p_(1 + program.state_count()),
        at_u_(at_p_ + context.parameters.size()),
        at_v_(at_u_ + context.inputs.size()) {}

  std::string operator()() {
    points();
    defaults();
    if (names_.start)
      text_ += start_comparison(context_, program_.state_count(), names_.function_name(""), names_.null_pointer, real_);
    std::vector<std::pair<std::string, unsigned>> keys;  // in order of first occurrence
    for (const TestVector& test : context_.tests) {
      for (const FunctionValues& f : test.functions) {
        const std::pair<std::string, unsigned> key{f.function, f.to};
        if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
      }
    }
    for (const auto& [function, to] : keys) check_function(function, to);
    return text_ + "  return 0;";
  }

 private:
  std::string list(const std::vector<double>& values) const {
    std::string text;
    for (const double value : values) {
      const double kept = suffix_.empty() ? value : static_cast<double>(static_cast<float>(value));
      text += (text.empty() ? "" : ", ") + decimal(kept) + suffix_;
    }
    return text;
  }

  void points() {
    std::string rows, modes;
    for (const TestVector& test : context_.tests) {
      std::vector<double> all{test.t};
      for (const auto* part : {&test.x, &test.p, &test.u, &test.v}) all.insert(all.end(), part->begin(), part->end());
      rows += wrapped("      {" + list(all) + "}", "       ") + ",\n";
      modes += wrapped("      {" + integers(test.mode) + "}", "       ") + ",\n";
    }
    rows.erase(rows.size() - 2);
    const std::size_t vector = program::vector_size(program_);
    text_ += fmt::format("  {}\n",
                         comment(dialect_, vector > 0 ? "t, x, p, u, v of each state" : "t, x, p, u of each state"));
    text_ += fmt::format("  static const {} points[{}][{}] = {{\n{}}};\n", real_, context_.tests.size(), at_v_ + vector,
                         rows);
    with_modes_ = std::any_of(context_.tests.begin(), context_.tests.end(),
                              [](const TestVector& test) { return has_mode(test); });
    if (with_modes_) {
      modes.erase(modes.size() - 2);
      text_ += fmt::format("  static const int modes[{}][{}] = {{\n{}}};\n", context_.tests.size(),
                           program_.mode_layout().size(), modes);
    }
    starts_ = begins_with_defaults(context_, !suffix_.empty());
  }

  /// The entries of `mode`, all of them.
  std::string integers(std::vector<int> mode) const {
    mode.resize(program_.mode_layout().size());
    return fmt::format("{}", fmt::join(mode, ", "));
  }
  std::string integers(unsigned charts) const {
    eom::ModeArray mode(program_.mode_layout());
    mode.set_charts(charts);
    return integers(mode.entries());
  }

  /// The first state is the default state.
  void defaults() {
    if (!starts_) return;
    const std::size_t n = program_.state_count(), count = context_.parameters.size();
    text_ += fmt::format("  {{\n    {} x[{}], p[{}];\n    int i;\n", real_, n, std::max<std::size_t>(1, count));
    text_ += fmt::format("    for (i = 0; i < {}; ++i) x[i] = NAN;\n", n);
    if (count > 0) text_ += fmt::format("    for (i = 0; i < {}; ++i) p[i] = NAN;\n", count);
    text_ += fmt::format("    {}(x, p);\n", names_.function_name("defaults"));
    text_ +=
        fmt::format("    for (i = 0; i < {}; ++i) {{\n      if (!(x[i] == points[0][1 + i])) return 1;\n    }}\n", n);
    if (count > 0)
      text_ += fmt::format(
          "    for (i = 0; i < {}; ++i) {{\n      if (!(p[i] == points[0][{} + i])) return 1;\n    }}\n", count, at_p_);
    text_ += "  }\n";
  }

  struct Row {
    std::size_t state;
    const FunctionValues* values;
  };
  std::vector<Row> rows_of(const std::string& function, unsigned to) const {
    std::vector<Row> rows;
    for (std::size_t k = 0; k < context_.tests.size(); ++k) {
      for (const FunctionValues& f : context_.tests[k].functions) {
        if (f.function == function && f.to == to) rows.push_back({k, &f});
      }
    }
    return rows;
  }

  void check_function(const std::string& function, unsigned to) {
    const std::vector<Row> rows = rows_of(function, to);
    std::string numbers, states;
    for (const Row& row : rows) {
      std::vector<double> all;
      for (std::size_t r = 0; r < row.values->values.size(); ++r) {
        all.push_back(row.values->tolerances[r]);
        all.insert(all.end(), row.values->values[r].begin(), row.values->values[r].end());
      }
      numbers += wrapped("        {" + list(all) + "}", "         ") + ",\n";
      states += (states.empty() ? "" : ", ") + std::to_string(row.state);
    }
    numbers.erase(numbers.size() - 2);
    const std::vector<std::vector<double>>& shape = rows.front().values->values;
    std::size_t width = 0;
    for (const auto& array : shape) width += 1 + array.size();
    text_ += fmt::format("  {{  {}\n", comment(dialect_, function + ": for each array the tolerance, then the values"));
    text_ += wrapped(fmt::format("    static const int at[{}] = {{{}}};", rows.size(), states), "        ") + "\n";
    if (to != 0)
      text_ +=
          wrapped(fmt::format("    static const int to[{}] = {{{}}};", program_.mode_layout().size(), integers(to)),
                  "        ") +
          "\n";
    const bool empty = std::all_of(shape.begin(), shape.end(), [](const auto& array) { return array.empty(); });
    if (!empty)
      text_ += fmt::format("    static const {} expected[{}][{}] = {{\n{}}};\n", real_, rows.size(), width, numbers);
    text_ += fmt::format("    for (int k = 0; k < {}; ++k) {{\n", rows.size());
    text_ += "      const int state = at[k];\n";
    text_ += fmt::format("      const {}* const point = points[state];\n", real_);
    std::string arrays;
    for (std::size_t r = 0; r < shape.size(); ++r) {
      text_ += fmt::format("      {} y{}[{}];\n", real_, r + 1, std::max<std::size_t>(1, shape[r].size()));
      arrays += fmt::format(", y{}", r + 1);
    }
    const std::size_t prepared = program_.prepared_count();
    const bool takes_prepared = abi::find(function)->has_input(abi::Input::prepared);
    if (takes_prepared) text_ += fmt::format("      {} w[{}];\n", real_, prepared);
    for (std::size_t r = 0; r < shape.size(); ++r) text_ += unset(fmt::format("y{}", r + 1), shape[r].size());
    if (takes_prepared)
      text_ += unset("w", prepared) + fmt::format("      if ({}(point + {}, w) != 0) return state + 1;\n",
                                                  names_.function_name("prepare"), at_p_);
    text_ += wrapped(fmt::format("      if ({}({}{}) != 0) return state + 1;", names_.function_name(function),
                                 arguments(function, to), arrays),
                     "          ") +
             "\n";
    std::size_t place = 0;
    for (std::size_t r = 0; r < shape.size(); ++r) {
      if (!shape[r].empty())
        text_ += fmt::format("      if ({}({}, y{}, expected[k] + {})) return state + 1;\n", names_.comparison,
                             shape[r].size(), r + 1, place);
      place += 1 + shape[r].size();
    }
    text_ += "    }\n  }\n";
  }

  /// A statement that fills an array with numbers that no comparison accepts, so that an entry that is never written is
  /// a difference.
  std::string unset(const std::string& array, std::size_t count) const {
    if (count == 0) return "";
    // Code in second charts leaves entries of the own charts as they are.
    return fmt::format("      for (int i = 0; i < {}; ++i) {}[i] = {};\n", count, array,
                       program_.charts.empty() ? "NAN" : "0");
  }

  std::string arguments(const std::string& function, unsigned to) const {
    std::string list;
    for (const abi::Input input : abi::find(function)->inputs) list += (list.empty() ? "" : ", ") + argument(input, to);
    return list;
  }

  std::string argument(abi::Input input, unsigned to) const {
    switch (input) {
      case abi::Input::time: return "point[0]";
      case abi::Input::state: return "point + 1";
      case abi::Input::parameters: return fmt::format("point + {}", at_p_);
      case abi::Input::prepared: return "w";
      case abi::Input::mode: return with_modes_ ? "modes[state]" : names_.null_pointer;
      case abi::Input::order: return std::to_string(taylor_order);
      case abi::Input::state_vector:
      case abi::Input::state_vectors:
      case abi::Input::accelerations: return fmt::format("point + {}", at_v_);
      case abi::Input::to: return to == 0 ? names_.null_pointer : "to";
      case abi::Input::inputs: break;
    }
    // At the first state the inputs have their defaults, as with a null pointer.
    const std::string given = fmt::format("point + {}", at_u_);
    return context_.inputs.empty() ? names_.null_pointer
           : starts_               ? fmt::format("state > 0 ? {} : {}", given, names_.null_pointer)
                                   : given;
  }

  const program::Program& program_;
  const EmissionContext& context_;
  const SelfTestNames& names_;
  const Dialect& dialect_;
  std::string real_, suffix_;
  std::size_t at_p_, at_u_, at_v_;
  bool with_modes_ = false, starts_ = false;
  std::string text_;
};

}  // namespace

std::optional<TestVector> test_vector(const program::Program& program, const EmissionContext& context, TestVector at,
                                      std::size_t index) {
  const program::AbiArguments arguments = arguments_of(at, context);
  const program::Program* const here = program::program_in_charts(program, at.mode);
  const std::size_t first_chart = std::min(at.mode.size(), program.mode_layout().chart(0));
  const auto is_zero = [](int entry) { return entry == 0; };
  const bool smooth = std::all_of(at.mode.begin(), at.mode.begin() + static_cast<std::ptrdiff_t>(first_chart), is_zero);
  const bool own = here != nullptr && here->in_charts == 0;
  const bool single = context.single_error.has_value();
  at.functions.clear();
  const std::optional<FunctionValues> rhs = values_at(program, "rhs", arguments, single);
  if (!rhs) return std::nullopt;
  for (const std::string& name : program::abi_function_names(program)) {
    const bool of_mode = abi::find(name + "_in") == nullptr;
    if (!of_mode && !smooth) continue;
    if (name != "rhs" && !is_held(entries(program, name), index)) continue;
    std::optional<FunctionValues> values = name == "rhs" ? rhs : values_at(program, name, arguments, single);
    if (!values) continue;
    if (of_mode || own) at.functions.push_back(*values);
    if (of_mode || program.charts.empty()) continue;
    values->function += "_in";
    at.functions.push_back(*values);
  }
  if (smooth) add_charts(program, arguments, single, at);
  return at;
}

bool begins_with_defaults(const EmissionContext& context, bool single) {
  if (context.tests.empty() || has_mode(context.tests.front())) return false;
  const auto same = [single](double a, double b) {
    return single ? static_cast<float>(a) == static_cast<float>(b) : a == b;
  };
  const auto same_value = [&same](double a, const Quantity& b) { return same(a, b.value); };
  const TestVector& first = context.tests.front();
  return same(first.t, context.start_time) &&
         std::equal(first.x.begin(), first.x.end(), context.start.begin(), context.start.end(), same) &&
         std::equal(first.p.begin(), first.p.end(), context.parameters.begin(), context.parameters.end(), same_value) &&
         std::equal(first.u.begin(), first.u.end(), context.inputs.begin(), context.inputs.end(), same_value);
}

std::string selftest_body(const program::Program& program, const EmissionContext& context, const SelfTestNames& names,
                          const Dialect& dialect) {
  if (context.tests.empty()) return fmt::format("  {}\n  return 0;", comment(dialect, "no values were given"));
  return Body(program, context, names, dialect)();
}

std::string selftest_comparison(const EmissionContext& context, const SelfTestNames& names, const Dialect& dialect) {
  if (context.tests.empty()) return "";
  return fmt::format(
      "{}\n{} int {}(int count, const {}* got, const {}* expected){}{{\n  for (int i = 0; i < count; ++i) {{\n"
      "    if (!({}(got[i] - expected[i + 1]) <= expected[0])) return 1;\n  }}\n  return 0;\n}}\n\n",
      comment(dialect, "Whether values differ from the expected ones by more than expected[0]."),
      dialect.line_comments ? "inline" : "static", names.comparison, real_of(context, dialect),
      real_of(context, dialect), dialect.line_comments ? " " : "\n", dialect.line_comments ? "std::fabs" : "fabs");
}

}  // namespace eomgen::emit

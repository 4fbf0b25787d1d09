// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/abi_values.hpp"

#include <cln/rational.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "abi/functions.hpp"
#include "lists.hpp"
#include "numeric/numbers.hpp"
#include "program/kinks.hpp"
#include "program/rounding.hpp"

namespace eomgen::program {
namespace {

using cln::cl_R;

const Function* find(const Program& program, const std::string& name) { return find_named(program.functions, name); }

template <class Real>
Arguments<Real> prepared_for(const Program& program, const std::string& function, Arguments<Real> at,
                             const std::vector<Real>& defaults) {
  at.side.assign(program.kinks.size(), Real(0));
  if (!abi::find(function)->has_input(abi::Input::mode)) {
    at.u = defaults;
    at.mode.clear();
    return at;
  }
  for (std::size_t k = 0; k < at.side.size(); ++k) {
    const std::size_t entry = program.mode_layout().kink(k);
    if (entry < at.mode.size()) at.side[k] = Real(at.mode[entry]);
  }
  return at;
}

Values<cl_R> run(const Function& function, const Arguments<cl_R>& at, int digits) {
  return interpret(function, at, digits);
}
Values<double> run(const Function& function, const Arguments<double>& at, int) { return interpret(function, at); }

// Whether emitted code would return 0: checks pivots and the tests that return a code.
bool passes_tests(const Function& function, const Values<cl_R>& values) {
  for (const auto& [pivot, scale] : values.pivots) {
    const cl_R least = cl_R(2 * pivot_tolerance) * cln::abs(scale);
    if (cln::zerop(pivot) || cln::abs(pivot) <= least) return false;
  }
  for (std::size_t r = 0; r < values.results.size(); ++r) {
    if (!function.results[r].is_test()) continue;
    if (std::any_of(values.results[r].begin(), values.results[r].end(),
                    [](const cl_R& code) { return cln::minusp(code); }))
      return false;
  }
  return true;
}

template <class Real>
void drop_codes(const Function& function, std::vector<std::vector<Real>>& results) {
  for (std::size_t r = results.size(); r-- > 0;) {
    if (function.results[r].is_test()) results.erase(results.begin() + static_cast<std::ptrdiff_t>(r));
  }
}

/// Scatters results to their indices. Entries that exist only in other charts stay 0.
template <class Real>
void scatter_results(const Program& all, const Function& function, std::vector<std::vector<Real>>& results) {
  if (function.result_indices.empty()) return;
  std::vector<Real> whole(function.name == "outputs" ? all.outputs.size() : results[0].size(), Real(0));
  for (std::size_t i = 0; i < function.result_indices.size(); ++i) whole.at(function.result_indices[i]) = results[0][i];
  results[0] = std::move(whole);
}

/// The prepared values of all charts in order.
template <class Result, class One>
Result all_prepared(const Program& program, const One& one) {
  Result result = one(*find(program, "prepare"));
  for (const Program& other : program.chart_variants) {
    const Function* prepare = find(other, "prepare");
    if (prepare == nullptr) continue;
    const Result more = one(*prepare);
    result.insert(result.end(), more.begin(), more.end());
  }
  return result;
}

/// Runs the recurrences as emitted code does (templates, emit/taylor.cpp). `checked` decides whether the values of
/// order 0 are regular.
template <class Real>
std::vector<Real> taylor_coefficients(const Taylor& taylor, const Arguments<Real>& at, int order, int digits,
                                      const std::function<bool(const Values<Real>&)>& checked) {
  std::vector<Real> coefficients = at.x;
  const std::size_t n = at.x.size();
  if (order == 0) return coefficients;
  const Values<Real> start = run(taylor.start, at, digits);
  if (!checked(start)) throw std::domain_error("the start of the series is singular");
  std::vector<Real> w = start.results[0], after = start.results[1];
  w.resize(taylor.workspace_size(), Real(0));
  coefficients.insert(coefficients.end(), after.begin(), after.end());
  std::vector<std::vector<Real>> a{{}}, b{{}};  // factors by order, from order 1 on
  for (int k = 1; k < order; ++k) {
    for (std::size_t i = 0; i < taylor.product_count; ++i) {
      Real sum = 0;
      for (int j = 1; j < k; ++j) sum = sum + a[static_cast<std::size_t>(j)][i] * b[static_cast<std::size_t>(k - j)][i];
      w[taylor.order_zero_count + i] = sum;
    }
    w[taylor.workspace_size() - 2] = Real(k == 1 ? 1 : 0);
    w[taylor.workspace_size() - 1] = Real(1) / Real(k);
    Arguments<Real> next{Real(k), {coefficients.end() - static_cast<std::ptrdiff_t>(n), coefficients.end()},
                         at.p,    at.u,
                         w,       at.side,
                         at.mode, {}};
    const Values<Real> values = run(taylor.next, next, digits);
    a.push_back(values.results[0]);
    b.push_back(values.results[1]);
    a.back().resize(taylor.product_count, Real(0));
    b.back().resize(taylor.product_count, Real(0));
    for (const Real& value : values.results[2]) coefficients.push_back(value / Real(k + 1));
  }
  return coefficients;
}

/// Conversion to binary64; infinite on overflow.
double to_binary64(const cl_R& value) {
  const bool held = cln::abs(value) <= numeric::exact(std::numeric_limits<double>::max());
  return held ? cln::double_approx(value)
              : std::copysign(std::numeric_limits<double>::infinity(), cln::minusp(value) ? -1.0 : 1.0);
}

Arguments<double> in_binary64(const Arguments<cl_R>& at) {
  Arguments<double> result{to_binary64(at.t), {}, {}, {}, {}, {}, at.mode, {}};
  for (const auto& [from, to] :
       {std::pair{&at.x, &result.x}, {&at.p, &result.p}, {&at.u, &result.u}, {&at.v, &result.v}}) {
    for (const cl_R& value : *from) to->push_back(to_binary64(value));
  }
  return result;
}

std::vector<double> in_binary64(const std::vector<cl_R>& values) {
  return mapped(values, [&](const cl_R& value) { return to_binary64(value); });
}

}  // namespace

const Program* program_in_charts(const Program& program, const std::vector<int>& mode) {
  unsigned charts = 0;
  for (std::size_t j = 0; j < program.charts.size(); ++j) {
    const std::size_t entry = program.mode_layout().chart(j);
    if (entry < mode.size() && mode[entry] != 0) charts |= 1u << j;
  }
  if (charts == program.in_charts) return &program;
  for (const Program& other : program.chart_variants) {
    if (charts == other.in_charts) return &other;
  }
  return nullptr;
}

std::vector<std::string> abi_function_names(const Program& program) {
  std::vector<std::string> names = mapped(program.functions, &Function::name);
  if (program.taylor) names.emplace_back("taylor");
  return names;
}

std::optional<AbiResults> abi_values(const Program& program, const std::string& function, const AbiArguments& arguments,
                                     int digits) try {
  const Program* const here = program_in_charts(program, arguments.at.mode);
  if (here == nullptr) return std::nullopt;
  Arguments<cl_R> at = prepared_for(*here, function, arguments.at, arguments.default_inputs);
  if (function == "taylor") {
    const auto checked = [&](const Values<cl_R>& values) { return passes_tests(here->taylor->start, values); };
    return AbiResults{taylor_coefficients<cl_R>(*here->taylor, at, arguments.order, digits, checked)};
  }
  if (function == "prepare") {
    return AbiResults{all_prepared<std::vector<cl_R>>(program, [&](const Function& prepare) {
      Values<cl_R> values = interpret(prepare, at, digits);
      if (!passes_tests(prepare, values)) throw std::domain_error("singular");
      return values.results[0];
    })};
  }
  const Function* wanted = find(*here, function);
  if (function == "rhs_prepared") {
    if (wanted == nullptr)
      wanted = find(*here, "rhs");  // this chart has no prepared values
    else
      at.w = interpret(*find(*here, "prepare"), at, digits).results[0];
  }
  if (wanted == nullptr) return std::nullopt;
  Values<cl_R> values = interpret(*wanted, at, digits);
  if (!passes_tests(*wanted, values)) return std::nullopt;
  drop_codes(*wanted, values.results);
  scatter_results(program, *wanted, values.results);
  return std::move(values.results);
} catch (const std::domain_error&) {
  return std::nullopt;
}

std::vector<std::vector<double>> abi_error_bounds(const Program& program, const std::string& function,
                                                  const AbiArguments& arguments) {
  const Program& here = *program_in_charts(program, arguments.at.mode);
  Arguments<double> at = prepared_for(here, function, in_binary64(arguments.at), in_binary64(arguments.default_inputs));
  if (function == "taylor") {
    // The recurrences couple orders. The estimate is a hundred times the actual error of binary64 here.
    constexpr int digits = 40;
    constexpr double safety_factor = 100;
    const std::optional<AbiResults> exact = abi_values(program, function, arguments, digits);
    if (!exact)
      return {std::vector<double>(at.x.size() * static_cast<std::size_t>(arguments.order + 1),
                                  std::numeric_limits<double>::infinity())};
    const std::vector<double> got =
        taylor_coefficients<double>(*here.taylor, at, arguments.order, 0, [](const Values<double>&) { return true; });
    std::vector<double> off;
    double largest = 0;
    for (const double value : got) largest = std::max(largest, std::fabs(value));
    for (std::size_t i = 0; i < got.size(); ++i)
      off.push_back(safety_factor * (std::fabs(got[i] - to_binary64(exact->front()[i])) + unit_roundoff * largest));
    return {off};
  }
  if (function == "prepare") {
    return {all_prepared<std::vector<double>>(
        program, [&](const Function& prepare) { return rounding_bounds(prepare, at)[0]; })};
  }
  const Function* wanted = find(here, function);
  std::vector<double> w_error;
  if (function == "rhs_prepared") {
    if (wanted == nullptr) {
      wanted = find(here, "rhs");
    } else {
      const Function& prepare = *find(here, "prepare");
      at.w = interpret(prepare, at).results[0];
      w_error = rounding_bounds(prepare, at)[0];
    }
  }
  std::vector<std::vector<double>> bounds = rounding_bounds(*wanted, at, w_error);
  drop_codes(*wanted, bounds);
  scatter_results(program, *wanted, bounds);
  return bounds;
}

}  // namespace eomgen::program

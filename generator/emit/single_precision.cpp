// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/single_precision.hpp"

#include <cln/dfloat.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/output/decimal.hpp>
#include <limits>

#include "emit/self_test.hpp"
#include "emit/text.hpp"
#include "error.hpp"
#include "lists.hpp"
#include "numeric/numbers.hpp"
#include "program/interpret.hpp"

namespace eomgen::emit {
namespace {

constexpr int many_digits = 40;
constexpr double pivot_tolerance = single_to_double_ulp * program::pivot_tolerance;
constexpr float least_pivot = static_cast<float>(pivot_tolerance);

double rounded(double value) { return static_cast<double>(static_cast<float>(value)); }

/// Rounds all numbers; returns false if one overflows.
bool round(TestVector& at) {
  at.t = rounded(at.t);
  bool fits = std::isfinite(at.t);
  for (std::vector<double>* part : {&at.x, &at.p, &at.u}) {
    for (double& value : *part) {
      value = rounded(value);
      fits = fits && std::isfinite(value);
    }
  }
  return fits;
}

std::vector<float> single(const std::vector<double>& values) { return {values.begin(), values.end()}; }

std::vector<cln::cl_R> exact_values(const std::vector<double>& values) {
  return mapped<cln::cl_R>(values, numeric::exact);
}

/// The error relative to the largest entry of each result. Returns nothing if there is no value, no value in single
/// precision, or the code reports a singular matrix.
std::optional<double> error_of(const program::Function& function, const TestVector& at) {
  program::Arguments<cln::cl_R> arguments{numeric::exact(at.t), exact_values(at.x), exact_values(at.p),
                                          exact_values(at.u)};
  program::Arguments<float> rounded_ones{static_cast<float>(at.t), single(at.x), single(at.p), single(at.u)};
  arguments.mode = rounded_ones.mode = at.mode;
  try {
    const auto right = program::interpret(function, arguments, many_digits).results;
    const auto [found, pivots] = program::interpret(function, rounded_ones);
    for (const auto& [pivot, scale] : pivots)
      if (!(std::abs(pivot) > least_pivot * std::abs(scale))) return std::nullopt;
    double error = 0;
    for (std::size_t r = 0; r < right.size(); ++r) {
      double largest = 0, off = 0;
      for (std::size_t i = 0; i < right[r].size(); ++i) {
        const double value = cln::double_approx(right[r][i]);
        largest = std::max(largest, std::abs(value));
        if (!std::isfinite(found[r][i])) return std::nullopt;
        off = std::max(off, std::abs(static_cast<double>(found[r][i]) - value));
      }
      if (largest > 0) error = std::max(error, off / largest);
    }
    return error;
  } catch (const std::domain_error&) {
    return std::nullopt;
  }
}

void require_place(double value, const std::string& what = "number") {
  const double size = std::abs(value);
  if (size > static_cast<double>(std::numeric_limits<float>::max()) ||
      (size > 0 && size < static_cast<double>(std::numeric_limits<float>::min()))) {
    throw Error("emit", {}, fmt::format("the {} {} is outside the range of single precision", what, decimal(value)),
                "leave --real float out, or take other units");
  }
}

std::string literal(double value) {
  require_place(value);
  return decimal(value) + "f";
}

}  // namespace

double to_single(double value) {
  require_place(value);
  const std::string text = decimal(value);
  float number = 0;
  eom::decimals::read_decimal(text, number);
  return static_cast<double>(number);
}

void convert_to_single(const program::Program& program, EmissionContext& context) {
  for (const Quantity& p : context.parameters) require_place(p.value, fmt::format("parameter {} =", p.name));
  context.single_error = 0;
  std::vector<TestVector> tests;
  for (TestVector test : context.tests) {
    if (!round(test)) continue;
    const std::optional<double> error = error_of(program.functions.front(), test);
    if (!error) continue;
    const std::optional<TestVector> made = test_vector(program, context, test, tests.size());
    if (!made) continue;
    context.single_error = std::max(*context.single_error, *error);
    tests.push_back(*made);
  }
  if (tests.empty()) {
    throw Error("emit", {}, "the right-hand side has no value in single precision at any state of the certificate",
                "leave --real float out");
  }
  context.tests = std::move(tests);
  context.verdict += fmt::format("; in single precision the right-hand side is off by {:.1e} of its size at most",
                                 *context.single_error);
}

Dialect single_dialect() {
  Dialect dialect;
  dialect.real = "float";
  dialect.constant = [](const symbolic::Rational& value) { return literal(nearest_double(value)); };
  dialect.value = literal;
  dialect.pi = "3.14159265f";
  dialect.abs_function = "fabs";  // of both precisions, like all functions (c/c.cpp)
  dialect.sincos_range = "2048.0f";
  dialect.pivot_tolerance = pivot_tolerance;
  return dialect;
}

}  // namespace eomgen::emit

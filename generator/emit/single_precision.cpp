// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/single_precision.hpp"

#include <cln/dfloat.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "emit/self_test.hpp"
#include "emit/text.hpp"
#include "error.hpp"
#include "numeric/numbers.hpp"
#include "program/interpret.hpp"

namespace eomgen::emit {
namespace {

constexpr int single_digits = 5, many_digits = 40;  // CLN gives five digits the 24 bits of single precision

double rounded(double value) { return static_cast<double>(static_cast<float>(value)); }

void round(std::vector<double>& values) {
  for (double& value : values) value = rounded(value);
}

std::vector<cln::cl_R> exact(const std::vector<double>& values) {
  std::vector<cln::cl_R> result;
  for (const double value : values) result.push_back(numeric::exact(value));
  return result;
}

/// By the largest entry of each result; nothing where there is no value.
std::optional<double> error_of(const program::Function& function, const TestVector& at) {
  program::Arguments<cln::cl_R> arguments{numeric::exact(at.t), exact(at.x), exact(at.p), exact(at.u)};
  arguments.mode = at.mode;
  try {
    const auto right = program::interpret(function, arguments, many_digits).results,
               single = program::interpret(function, arguments, single_digits).results;
    double error = 0;
    for (std::size_t r = 0; r < right.size(); ++r) {
      double largest = 0, off = 0;
      for (std::size_t i = 0; i < right[r].size(); ++i) {
        const double value = cln::double_approx(right[r][i]);
        largest = std::max(largest, std::abs(value));
        off = std::max(off, std::abs(cln::double_approx(single[r][i]) - value));
      }
      if (largest > 0) error = std::max(error, off / largest);
    }
    return error;
  } catch (const std::domain_error&) {
    return std::nullopt;
  }
}

void require_place(double value) {
  const double size = std::abs(value);
  if (size > static_cast<double>(std::numeric_limits<float>::max()) ||
      (size > 0 && size < static_cast<double>(std::numeric_limits<float>::min()))) {
    throw Error("emit", {}, fmt::format("the number {} has no place in single precision", decimal(value)),
                "leave --real float out, or take other units");
  }
}

std::string literal(double value) {
  require_place(value);
  return decimal(value) + "f";
}

}  // namespace

double single_number(double value) {
  require_place(value);
  const std::string text = decimal(value);
  float number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return static_cast<double>(number);
}

void make_single(const program::Program& program, EmissionContext& context) {
  context.single_error = 0;
  std::vector<TestVector> tests;
  for (TestVector test : context.tests) {
    test.t = rounded(test.t);
    for (std::vector<double>* part : {&test.x, &test.p, &test.u}) round(*part);
    const std::optional<TestVector> made = test_vector(program, context, test, tests.size());
    const std::optional<double> error = error_of(program.functions.front(), test);
    if (!made || !error) continue;
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

void require_single(const std::string& target) {
  if (target != "batch") return;
  throw Error("emit", {}, fmt::format("the target {} knows double precision alone", target),
              "take another target, or leave --real float out");
}

Dialect single_dialect() {
  Dialect dialect;
  dialect.real = "float";
  dialect.constant = [](const symbolic::Rational& value) { return literal(nearest_double(value)); };
  dialect.value = literal;
  dialect.pi = "3.14159265f";
  dialect.absolute = "fabs";  // of tgmath.h, like all functions
  dialect.pivot_tolerance = single_by_double * program::pivot_tolerance;
  return dialect;
}

std::string single_sincos(const std::string& prefix) {
  return fmt::format(R"(static inline void {}sincos(float a, float b, float* sine, float* cosine)
{{
  sine[0] = sinf(a);
  sine[1] = sinf(b);
  cosine[0] = cosf(a);
  cosine[1] = cosf(b);
}}

)",
                     prefix);
}

}  // namespace eomgen::emit

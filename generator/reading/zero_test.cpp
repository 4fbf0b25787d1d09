// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/zero_test.hpp"

#include <cln/float.h>

#include "reading/atom_table.hpp"
#include "reading/rational_function.hpp"
#include "reading/trig.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/sample.hpp"

namespace eomgen::reading {
namespace {

constexpr int digits = 50, agreed_digits = 40;
constexpr std::uint64_t points = 5;

ZeroTestResult numerically(const Sum& sum) {
  symbolic::Dag dag;
  std::vector<symbolic::Ref> terms;
  for (const auto& [monomial, coefficient] : sum.terms()) terms.push_back(to_dag(dag, Sum(monomial, coefficient)));
  const cln::cl_R small = cln::cl_R(cln::expt(Rational(1) / 10, agreed_digits));
  bool evaluated = false;
  for (std::uint64_t point = 0; point < points; ++point) {
    try {
      cln::cl_R total = 0, size = 0;
      for (const cln::cl_R& value : symbolic::evaluate(
               dag, terms, [&](const Symbol& s) { return cln::cl_R(symbolic::sample(s, point)); }, digits)) {
        total = total + value;
        size = size + cln::abs(value);
      }
      if (cln::abs(total) > small * size) return ZeroTestResult::no;
      evaluated = true;
    } catch (const std::domain_error&) {
      continue;
    }
  }
  return evaluated ? ZeroTestResult::numerical : ZeroTestResult::unknown;
}

}  // namespace

bool is_zero(const Sum& sum) {
  if (sum.is_zero()) return true;
  const ZeroTestResult numbers = numerically(sum);
  return numbers == ZeroTestResult::numerical ||
         (numbers == ZeroTestResult::unknown && zero_test(sum) == ZeroTestResult::proven);
}

ZeroTestResult zero_test(const Sum& sum) {
  if (sum.is_zero()) return ZeroTestResult::proven;
  const ZeroTestResult numbers = numerically(sum);
  if (numbers == ZeroTestResult::no) return numbers;
  try {
    if (cancel(expand_angles(sum)).is_zero()) return ZeroTestResult::proven;
  } catch (const work::BudgetExceeded&) {
    return numbers;
  }
  return numbers;
}

}  // namespace eomgen::reading

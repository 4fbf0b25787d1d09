// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/derivative_comparisons.hpp"

#include <cln/rational.h>
#include <cln/real.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "symbolic/evaluate.hpp"
#include "verify/applied_forces.hpp"
#include "verify/central_differences.hpp"
#include "verify/function_comparisons.hpp"

namespace eomgen::verify {
namespace {

using symbolic::Ref;

constexpr const char* differences = "differences of dx";

class DerivativeComparison {
 public:
  explicit DerivativeComparison(const FunctionAt& given) : g_(given), n_(given.system.free.size()) {}

  using Check = void (DerivativeComparison::*)();
  static const std::map<std::string_view, Check>& checks() {
    static const std::map<std::string_view, Check> table{
        {"jac", &DerivativeComparison::jac},           {"jac_p", &DerivativeComparison::jac_p},
        {"jac_u", &DerivativeComparison::jac_u},       {"jvp", &DerivativeComparison::jvp},
        {"vjp", &DerivativeComparison::vjp},           {"adjoint", &DerivativeComparison::adjoint},
        {"hvp", &DerivativeComparison::hvp},           {"inverse", &DerivativeComparison::inverse},
        {"coriolis", &DerivativeComparison::coriolis}, {"gravity", &DerivativeComparison::gravity}};
    return table;
  }

 private:
  using Numbers = std::vector<Real>;

  void note(const std::string& function, const char* against, double difference) {
    g_.table.record(function + " of " + g_.program.name, against, true, difference);
  }

  /// Steps of differences are small relative to 1/range: with rates of 1e300 a time of 1e-50 is long.
  int step_digits() const { return g_.oracle.digits() - guard_digits; }

  /// A direction without zero components; of parameters, relative to their values.
  static Numbers direction(std::size_t size, std::size_t first = 0) {
    Numbers result;
    for (std::size_t j = 0; j < size; ++j) result.push_back(direction_component(first + j));
    return result;
  }
  Numbers direction_of_parameters() const {
    Numbers result = direction(g_.at.p.size());
    for (std::size_t j = 0; j < result.size(); ++j) {
      if (!cln::zerop(g_.at.p[j])) result[j] = result[j] * cln::rational(g_.at.p[j]);
    }
    return result;
  }

  static void move(Numbers& values, const Numbers& direction, const Real& step) {
    for (std::size_t j = 0; j < direction.size(); ++j) values[j] = values[j] + step * direction[j];
  }

  std::optional<CentralDifference> slope(Numbers AbiArguments::*part, const Numbers& direction) const {
    return central_difference(
        g_.program, "rhs", g_.at, [&](AbiArguments& at, const Real& step) { move(at.*part, direction, step); },
        step_digits());
  }

  /// The rounding error of differences of the right-hand side; empty where it has no value.
  Numbers noise() const {
    const std::optional<AbiResults> rhs = g_.program.call("rhs", g_.at, g_.oracle.digits());
    if (!rhs) return {};
    const AbiResults size = value_sizes(g_.program, "rhs", g_.at, *rhs, g_.oracle);
    Numbers result;
    if (size.empty()) return result;
    for (const Real& one : size[0]) result.push_back(one * power_of_ten(-g_.table.digits()));
    return result;
  }

  /// Compares the columns of array `r`, times the components of a direction, with the central difference along it.
  void along(const std::string& name, std::size_t r, const Numbers& direction,
             const std::optional<CentralDifference>& slope) {
    const Numbers lost = noise();
    if (!slope || lost.empty()) return;
    const std::size_t rows = lost.size();
    double largest = 0;
    for (std::size_t i = 0; i < rows; ++i) {
      Real sum = 0, size = lost[i] + slope->errors[0][i];
      for (std::size_t j = 0; j < direction.size(); ++j) {
        sum = sum + g_.values[r][i + rows * j] * direction[j];
        size = size + g_.sizes[r][i + rows * j] * cln::abs(direction[j]);
      }
      largest = std::max(largest, relative_difference(sum - slope->values[0][i], size));
    }
    note(name, differences, largest);
  }

  void jac() {
    const Numbers d = direction(g_.at.x.size());
    along("jac", 0, d, slope(&AbiArguments::x, d));
    along("df/dt", 1, {Real(1)},
          central_difference(
              g_.program, "rhs", g_.at, [](AbiArguments& at, const Real& h) { at.t = at.t + h; }, step_digits()));
  }
  void jac_p() {
    const Numbers d = direction_of_parameters();
    along("jac_p", 0, d, slope(&AbiArguments::p, d));
  }
  void jac_u() {
    const Numbers d = direction(g_.at.u.size());
    along("jac_u", 0, d, slope(&AbiArguments::u, d));
  }

  /// One column: the product with v.
  void jvp() {
    const Numbers d(g_.at.v.begin(), g_.at.v.begin() + static_cast<std::ptrdiff_t>(g_.at.x.size()));
    along("jvp", 0, {Real(1)}, slope(&AbiArguments::x, d));
  }

  /// Compares array `r` times a direction with v times the difference of dx along it.
  void across(const std::string& name, std::size_t r, const Numbers& direction,
              const std::optional<CentralDifference>& slope) {
    const Numbers lost = noise();
    if (!slope || lost.empty()) return;
    Real sum = 0, size = 0;
    for (std::size_t j = 0; j < direction.size(); ++j) {
      sum = sum + g_.values[r][j] * direction[j];
      size = size + g_.sizes[r][j] * cln::abs(direction[j]);
    }
    for (std::size_t i = 0; i < lost.size(); ++i) {
      const Real& weight = g_.at.v[i];
      sum = sum - weight * slope->values[0][i];
      size = size + cln::abs(weight) * (lost[i] + slope->errors[0][i] + cln::abs(slope->values[0][i]));
    }
    note(name, differences, relative_difference(sum, size));
  }

  void vjp() {
    const Numbers d = direction(g_.at.x.size(), 3);
    across("vjp", 0, d, slope(&AbiArguments::x, d));
  }
  void adjoint() {
    const Numbers d = direction(g_.at.x.size(), 3), of_p = direction_of_parameters(), of_u = direction(g_.at.u.size());
    across("adjoint", 0, d, slope(&AbiArguments::x, d));
    across("adjoint by p", 1, of_p, slope(&AbiArguments::p, of_p));
    across("adjoint by u", 2, of_u, slope(&AbiArguments::u, of_u));
  }

  /// d^2(c^T f) along the direction d of v and another one, e, by differences with steps h and 2 h.
  void hvp() {
    const std::size_t states = g_.at.x.size();
    const int digits = step_digits(), more = 4 * digits + 10;
    const Precision precision(more);
    const AbiArguments here = with_digits(g_.at, precision);
    const Numbers d(here.v.begin() + static_cast<std::ptrdiff_t>(states),
                    here.v.begin() + static_cast<std::ptrdiff_t>(2 * states)),
        e = direction(states, 3);
    const auto weighted = [&](const Real& along_d, const Real& along_e) -> std::optional<Real> {
      AbiArguments at = here;
      move(at.x, d, along_d);
      move(at.x, e, along_e);
      const std::optional<AbiResults> rhs = g_.program.call("rhs", at, more);
      if (!rhs) return std::nullopt;
      Real sum = 0;
      for (std::size_t i = 0; i < states; ++i) sum = sum + here.v[i] * (*rhs)[0][i];
      return sum;
    };
    const auto mixed = [&](const Real& h) -> std::optional<Real> {
      const std::optional<Real> a = weighted(h, h), b = weighted(h, -h), c = weighted(-h, h), f = weighted(-h, -h);
      if (!a || !b || !c || !f) return std::nullopt;
      return Real((*a - *b - *c + *f) / (4 * h * h));
    };
    const Real h = precision.round(power_of_ten(-digits));
    const std::optional<Real> near = mixed(h), far = mixed(2 * h);
    if (!near || !far) return;
    Real sum = 0, size = cln::abs(*near - *far) * power_of_ten(g_.table.digits()) + cln::abs(*near);
    for (std::size_t j = 0; j < states; ++j) {
      sum = sum + g_.values[0][j] * e[j];
      size = size + g_.sizes[0][j] * cln::abs(e[j]);
    }
    note("hvp", "second differences of dx", relative_difference(sum - *near, size));
  }

  /// The entries of M and f without friction, with the inputs of `at`.
  SymbolValues without_friction() const {
    SymbolValues symbols = g_.symbols;
    std::fill(symbols.state.phi.begin(), symbols.state.phi.end(), Real(0));
    return symbols;
  }

  void inverse() {
    const int digits = g_.oracle.digits(), more = digits + 20;
    const SymbolValues symbols = without_friction();
    const Numbers M = symbolic::evaluate(*g_.system.dag, g_.system.M, symbols, more),
                  f = symbolic::evaluate(*g_.system.dag, g_.system.f, symbols, more);
    double largest = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      Real sum = g_.values[0][i] + f[i], size = g_.sizes[0][i] + cln::abs(f[i]);
      for (std::size_t j = 0; j < n_; ++j) {
        const Real term = M[i * n_ + j] * g_.at.v[j];
        sum = sum - term;
        size = size + cln::abs(term);
      }
      largest = std::max(largest, relative_difference(sum, size));
    }
    note("inverse", "M and f of the system", largest);
  }

  /// Values of expressions along a direction of the coordinates, at +h and -h: their central difference.
  Numbers slope_along(const std::vector<Ref>& roots, const Numbers& direction, int digits) const {
    const int more = 3 * digits + 10;
    const Precision precision(more);
    const Real h = precision.round(power_of_ten(-digits));
    const auto at = [&](const Real& step) {
      SymbolValues moved = g_.symbols;
      for (std::size_t i = 0; i < n_; ++i) {
        Real& q = moved.state.q[g_.system.free[i]];
        q = precision.round(q) + step * direction[i];
      }
      return symbolic::evaluate(*g_.system.dag, roots, moved, more);
    };
    Numbers high = at(h);
    const Numbers low = at(-h);
    for (std::size_t i = 0; i < high.size(); ++i) high[i] = (high[i] - low[i]) / (2 * h);
    return high;
  }

  /// c^T C b = (c^T D_qdot M b + c^T D_b M qdot - b^T D_c M qdot)/2 for two directions b and c.
  void coriolis() {
    const Numbers b = direction(n_, 1), c = direction(n_, 4);
    Numbers qdot;
    for (const std::uint32_t i : g_.system.free) qdot.push_back(to_exact(g_.symbols.state.qdot[i]));
    Real expected = 0, size = 0;
    const auto add = [&](const Numbers& left, const Numbers& slope_of_M, const Numbers& right, int sign) {
      for (std::size_t i = 0; i < n_; ++i) {
        for (std::size_t j = 0; j < n_; ++j) {
          const Real term = left[i] * slope_of_M[i * n_ + j] * right[j] / 2;
          expected = expected + sign * term;
          size = size + cln::abs(term);
        }
      }
    };
    // The slopes of a constant M, such as of sin^2 + cos^2, are rounding errors of M.
    const Numbers M = symbolic::evaluate(*g_.system.dag, g_.system.M, g_.symbols, g_.oracle.digits());
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < n_; ++j)
        size =
            size + cln::abs(M[i * n_ + j]) * (cln::abs(qdot[i]) + cln::abs(qdot[j])) * power_of_ten(-g_.table.digits());
    }
    const int digits = step_digits();
    add(c, slope_along(g_.system.M, qdot, digits), b, 1);
    add(c, slope_along(g_.system.M, b, digits), qdot, 1);
    add(b, slope_along(g_.system.M, c, digits), qdot, -1);
    Real sum = 0;
    for (std::size_t j = 0; j < n_; ++j) {
      for (std::size_t i = 0; i < n_; ++i) {
        sum = sum + c[i] * g_.values[0][i + n_ * j] * b[j];
        size = size + g_.sizes[0][i + n_ * j] * cln::abs(c[i] * b[j]);
      }
    }
    note("coriolis", "differences of M", relative_difference(sum - expected, size));
  }

  void gravity() {
    const Numbers c = direction(n_, 4);
    const Real expected = slope_along({g_.system.potential}, c, step_digits()).front();
    const Numbers U = symbolic::evaluate(*g_.system.dag, {g_.system.potential}, g_.symbols, g_.oracle.digits());
    Real sum = 0, size = cln::abs(U.front()) * power_of_ten(-g_.table.digits()) + cln::abs(expected);
    for (std::size_t i = 0; i < n_; ++i) {
      sum = sum + c[i] * g_.values[0][i];
      size = size + g_.sizes[0][i] * cln::abs(c[i]);
    }
    note("gravity", "differences of the potential", relative_difference(sum - expected, size));
  }

  const FunctionAt& g_;
  std::size_t n_;
};

}  // namespace

AbiResults value_sizes(const ProgramForm& program, const std::string& function, const AbiArguments& at,
                       const AbiResults& values, const Oracle& oracle) {
  constexpr double least_number = 1e-290;  // bounds are binary64, and smaller numbers have fewer digits there
  const std::vector<std::vector<double>> bounds = program.bounds(function, at);
  AbiResults result;
  for (std::size_t r = 0; r < values.size(); ++r) {
    result.emplace_back();
    for (std::size_t i = 0; i < values[r].size(); ++i) {
      if (!std::isfinite(bounds[r][i])) return {};
      result.back().push_back(cln::abs(values[r][i]) +
                              rounding_scale(std::max(bounds[r][i], least_number), oracle.precision()));
    }
  }
  return result;
}

bool compare_derivative(const FunctionAt& given) {
  const auto found = DerivativeComparison::checks().find(given.function);
  if (found == DerivativeComparison::checks().end()) return false;
  DerivativeComparison comparison(given);
  (comparison.*found->second)();
  return true;
}

}  // namespace eomgen::verify

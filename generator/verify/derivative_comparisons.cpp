// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/derivative_comparisons.hpp"

#include <cln/rational.h>
#include <cln/real.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <tuple>

#include "oracle/applied_forces.hpp"
#include "symbolic/evaluate.hpp"
#include "verify/abi_arguments.hpp"
#include "verify/central_differences.hpp"

namespace eomgen::verify {
namespace {

using symbolic::Ref;

constexpr const char* differences = "differences of dx";
constexpr std::size_t across_direction = 3, coriolis_left = 4, coriolis_right = 1;  // first components of directions

}  // namespace

class DerivativeComparisons::Comparison {
 public:
  Comparison(const ProgramForm& program, const system::EquationSystem& system, const Oracle& oracle,
             const SymbolValues& symbols, const AbiArguments& at, ComparisonTable& table)
      : program_(program),
        system_(system),
        oracle_(oracle),
        symbols_(symbols),
        at_(at),
        table_(table),
        n_(system.free.size()) {}

  bool operator()(const std::string& function, const AbiResults& values, const AbiResults& sizes) {
    static const std::map<std::string_view, void (Comparison::*)()> checks{
        {"jac", &Comparison::jac},        {"jac_p", &Comparison::jac_p},     {"jac_u", &Comparison::jac_u},
        {"jvp", &Comparison::jvp},        {"vjp", &Comparison::vjp},         {"adjoint", &Comparison::adjoint},
        {"hvp", &Comparison::hvp},        {"inverse", &Comparison::inverse}, {"coriolis", &Comparison::coriolis},
        {"gravity", &Comparison::gravity}};
    const auto found = checks.find(function);
    values_ = &values;
    sizes_ = &sizes;
    if (found == checks.end()) return value_jacobian(function);
    (this->*found->second)();
    return true;
  }

 private:
  using Numbers = std::vector<Real>;

  void note(const std::string& function, const char* against, double difference) {
    table_.record(function + " of " + program_.name, against, true, difference);
  }

  /// Steps of differences are small relative to 1/range: with rates of 1e300 a time of 1e-50 is long.
  int step_digits() const { return oracle_.digits() - guard_digits; }

  /// A direction without zero components; of parameters, relative to their values.
  static Numbers direction(std::size_t size, std::size_t first = 0) {
    Numbers result;
    for (std::size_t j = 0; j < size; ++j) result.push_back(direction_component(first + j));
    return result;
  }
  Numbers direction_of_parameters() const {
    Numbers result = direction(at_.p.size());
    for (std::size_t j = 0; j < result.size(); ++j) {
      if (!cln::zerop(at_.p[j])) result[j] = result[j] * cln::rational(at_.p[j]);
    }
    return result;
  }

  static void move(Numbers& values, const Numbers& direction, const Real& step) {
    for (std::size_t j = 0; j < direction.size(); ++j) values[j] = values[j] + step * direction[j];
  }

  /// The differences of a function along a direction.
  const std::optional<CentralDifference>& slope(Numbers AbiArguments::*part, std::size_t first = 0,
                                                const std::string& of = "rhs") {
    const auto key = std::tuple{of, part == &AbiArguments::x ? 0 : part == &AbiArguments::p ? 1 : 2, first};
    const auto found = slopes_.find(key);
    if (found != slopes_.end()) return found->second;
    const Numbers along = part == &AbiArguments::p ? direction_of_parameters() : direction((at_.*part).size(), first);
    return slopes_
        .emplace(key, central_difference(
                          program_, of, at_, [&](AbiArguments& at, const Real& step) { move(at.*part, along, step); },
                          step_digits()))
        .first->second;
  }

  /// The rounding error of differences of a function; empty where it has no value.
  const Numbers& noise(const std::string& of = "rhs") {
    const auto [found, is_new] = noise_.try_emplace(of);
    Numbers& noise = found->second;
    if (!is_new) return noise;
    const std::optional<AbiResults> values = program_.call(of, at_, oracle_.digits());
    if (!values) return noise;
    const AbiResults size = value_sizes(program_, of, at_, *values, oracle_);
    if (size.empty()) return noise;
    for (std::size_t r = 0; r < arrays_of(of); ++r)
      for (const Real& one : size[r]) noise.push_back(one * power_of_ten(-table_.digits()));
    return noise;
  }

  /// The number of arrays of a function whose derivatives are in one array.
  static std::size_t arrays_of(const std::string& function) { return function == "momenta" ? 2 : 1; }

  static Numbers in_one_array(const AbiResults& arrays, const std::string& of) {
    Numbers result;
    for (std::size_t r = 0; r < arrays_of(of); ++r) result.insert(result.end(), arrays[r].begin(), arrays[r].end());
    return result;
  }

  /// Compares the columns of array `r`, times the components of a direction, with the central difference along it.
  void along(const std::string& name, std::size_t r, const Numbers& direction,
             const std::optional<CentralDifference>& slope, const std::string& of = "rhs") {
    const Numbers& lost = noise(of);
    if (!slope || lost.empty()) return;
    const std::size_t rows = lost.size();
    const Numbers expected = in_one_array(slope->values, of), errors = in_one_array(slope->errors, of);
    double largest = 0;
    for (std::size_t i = 0; i < rows; ++i) {
      Real sum = 0, size = lost[i] + errors[i];
      for (std::size_t j = 0; j < direction.size(); ++j) {
        sum = sum + (*values_)[r][i + rows * j] * direction[j];
        size = size + (*sizes_)[r][i + rows * j] * cln::abs(direction[j]);
      }
      largest = std::max(largest, relative_difference(sum - expected[i], size));
    }
    note(name, of == "rhs" ? differences : ("differences of " + of).c_str(), largest);
  }

  /// The derivatives of `outputs`, `reactions` or `momenta`, which are in the program too.
  bool value_jacobian(const std::string& function) {
    const std::size_t end = function.find("_jac");
    if (end == std::string::npos) return false;
    const std::string of = function.substr(0, end);
    if (function.ends_with("_p")) {
      along(function, 0, direction_of_parameters(), slope(&AbiArguments::p, 0, of), of);
    } else if (function.ends_with("_u")) {
      along(function, 0, direction(at_.u.size()), slope(&AbiArguments::u, 0, of), of);
    } else {
      along(function, 0, direction(at_.x.size()), slope(&AbiArguments::x, 0, of), of);
      along("d" + of + "/dt", 1, {Real(1)},
            central_difference(
                program_, of, at_, [](AbiArguments& at, const Real& h) { at.t = at.t + h; }, step_digits()),
            of);
    }
    return true;
  }

  void jac() {
    along("jac", 0, direction(at_.x.size()), slope(&AbiArguments::x));
    along("df/dt", 1, {Real(1)},
          central_difference(
              program_, "rhs", at_, [](AbiArguments& at, const Real& h) { at.t = at.t + h; }, step_digits()));
  }
  void jac_p() { along("jac_p", 0, direction_of_parameters(), slope(&AbiArguments::p)); }
  void jac_u() { along("jac_u", 0, direction(at_.u.size()), slope(&AbiArguments::u)); }

  /// One column: the product with v, which begins with the direction of `jac` (arguments_at).
  void jvp() { along("jvp", 0, {Real(1)}, slope(&AbiArguments::x)); }

  /// Compares array `r` times a direction with v times the difference of dx along it.
  void across(const std::string& name, std::size_t r, const Numbers& direction,
              const std::optional<CentralDifference>& slope) {
    const Numbers& lost = noise();
    if (!slope || lost.empty()) return;
    Real sum = 0, size = 0;
    for (std::size_t j = 0; j < direction.size(); ++j) {
      sum = sum + (*values_)[r][j] * direction[j];
      size = size + (*sizes_)[r][j] * cln::abs(direction[j]);
    }
    for (std::size_t i = 0; i < lost.size(); ++i) {
      const Real& weight = at_.v[i];
      sum = sum - weight * slope->values[0][i];
      size = size + cln::abs(weight) * (lost[i] + slope->errors[0][i] + cln::abs(slope->values[0][i]));
    }
    note(name, differences, relative_difference(sum, size));
  }

  void across_states(const std::string& name) {
    across(name, 0, direction(at_.x.size(), across_direction), slope(&AbiArguments::x, across_direction));
  }
  void vjp() { across_states("vjp"); }
  void adjoint() {
    across_states("adjoint");
    across("adjoint by p", 1, direction_of_parameters(), slope(&AbiArguments::p));
    across("adjoint by u", 2, direction(at_.u.size()), slope(&AbiArguments::u));
  }

  /// d^2(c^T f) along the direction d of v and another one, e, by differences with steps h and 2 h.
  void hvp() {
    const std::size_t states = at_.x.size();
    const int digits = step_digits(), more = 4 * digits + 10;
    const Precision precision(more);
    const AbiArguments here = with_digits(at_, precision);
    const Numbers d(here.v.begin() + static_cast<std::ptrdiff_t>(states),
                    here.v.begin() + static_cast<std::ptrdiff_t>(2 * states)),
        e = direction(states, across_direction);
    const auto weighted = [&](const Real& along_d, const Real& along_e) -> std::optional<Real> {
      AbiArguments at = here;
      move(at.x, d, along_d);
      move(at.x, e, along_e);
      const std::optional<AbiResults> rhs = program_.call("rhs", at, more);
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
    const Numbers& lost = noise();
    if (lost.empty()) return;
    // The truncation error of `near` is a third of the difference; the digits compared take it as it is.
    Real sum = 0, size = cln::abs(*near - *far) * power_of_ten(table_.digits()) + cln::abs(*near);
    for (std::size_t j = 0; j < states; ++j) {
      size = size + cln::abs(here.v[j]) * lost[j];
      sum = sum + (*values_)[0][j] * e[j];
      size = size + (*sizes_)[0][j] * cln::abs(e[j]);
    }
    note("hvp", "second differences of dx", relative_difference(sum - *near, size));
  }

  /// The entries of M and f without friction, with the inputs of `at`.
  SymbolValues without_friction() const {
    SymbolValues symbols = symbols_;
    std::fill(symbols.state.phi.begin(), symbols.state.phi.end(), Real(0));
    return symbols;
  }

  void inverse() {
    const int digits = oracle_.digits(), more = digits + 20;
    const SymbolValues symbols = without_friction();
    const Numbers M = symbolic::evaluate(*system_.dag, system_.M, symbols, more),
                  f = symbolic::evaluate(*system_.dag, system_.f, symbols, more);
    double largest = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      Real sum = (*values_)[0][i] + f[i], size = (*sizes_)[0][i] + cln::abs(f[i]);
      for (std::size_t j = 0; j < n_; ++j) {
        const Real term = M[i * n_ + j] * at_.v[j];
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
      SymbolValues moved = symbols_;
      for (std::size_t i = 0; i < n_; ++i) {
        Real& q = moved.state.q[system_.free[i]];
        q = precision.round(q) + step * direction[i];
      }
      return symbolic::evaluate(*system_.dag, roots, moved, more);
    };
    Numbers high = at(h);
    const Numbers low = at(-h);
    for (std::size_t i = 0; i < high.size(); ++i) high[i] = (high[i] - low[i]) / (2 * h);
    return high;
  }

  /// c^T C b = (c^T D_qdot M b + c^T D_b M qdot - b^T D_c M qdot)/2 for two directions b and c.
  void coriolis() {
    const Numbers b = direction(n_, coriolis_right), c = direction(n_, coriolis_left);
    Numbers qdot;
    for (const std::uint32_t i : system_.free) qdot.push_back(to_exact(symbols_.state.qdot[i]));
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
    const Numbers M = symbolic::evaluate(*system_.dag, system_.M, symbols_, oracle_.digits());
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < n_; ++j)
        size =
            size + cln::abs(M[i * n_ + j]) * (cln::abs(qdot[i]) + cln::abs(qdot[j])) * power_of_ten(-table_.digits());
    }
    const int digits = step_digits();
    add(c, slope_along(system_.M, qdot, digits), b, 1);
    add(c, slope_along(system_.M, b, digits), qdot, 1);
    add(b, slope_along(system_.M, c, digits), qdot, -1);
    Real sum = 0;
    for (std::size_t j = 0; j < n_; ++j) {
      for (std::size_t i = 0; i < n_; ++i) {
        sum = sum + c[i] * (*values_)[0][i + n_ * j] * b[j];
        size = size + (*sizes_)[0][i + n_ * j] * cln::abs(c[i] * b[j]);
      }
    }
    note("coriolis", "differences of M", relative_difference(sum - expected, size));
  }

  void gravity() {
    const Numbers c = direction(n_, coriolis_left);
    const Real expected = slope_along({system_.potential}, c, step_digits()).front();
    const Numbers U = symbolic::evaluate(*system_.dag, {system_.potential}, symbols_, oracle_.digits());
    Real sum = 0, size = cln::abs(U.front()) * power_of_ten(-table_.digits()) + cln::abs(expected);
    for (std::size_t i = 0; i < n_; ++i) {
      sum = sum + c[i] * (*values_)[0][i];
      size = size + (*sizes_)[0][i] * cln::abs(c[i]);
    }
    note("gravity", "differences of the potential", relative_difference(sum - expected, size));
  }

  const ProgramForm& program_;
  const system::EquationSystem& system_;
  const Oracle& oracle_;
  const SymbolValues& symbols_;
  const AbiArguments& at_;
  ComparisonTable& table_;
  std::size_t n_;
  const AbiResults *values_ = nullptr, *sizes_ = nullptr;  // of the function that is compared
  std::map<std::tuple<std::string, int, std::size_t>, std::optional<CentralDifference>> slopes_;
  std::map<std::string, Numbers> noise_;
};

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

DerivativeComparisons::DerivativeComparisons(const ProgramForm& program, const system::EquationSystem& system,
                                             const Oracle& oracle, const SymbolValues& symbols, const AbiArguments& at,
                                             ComparisonTable& table)
    : comparison_(std::make_unique<Comparison>(program, system, oracle, symbols, at, table)) {}

DerivativeComparisons::~DerivativeComparisons() = default;

bool DerivativeComparisons::operator()(const std::string& function, const AbiResults& values, const AbiResults& sizes) {
  return (*comparison_)(function, values, sizes);
}

}  // namespace eomgen::verify

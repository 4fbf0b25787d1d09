// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/function_comparisons.hpp"

#include <cln/integer.h>
#include <cln/rational.h>
#include <cln/real.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string_view>

#include "lists.hpp"
#include "oracle/applied_forces.hpp"
#include "symbolic/evaluate.hpp"
#include "system/contact_set.hpp"
#include "verify/abi_arguments.hpp"
#include "verify/abi_differences.hpp"
#include "verify/central_differences.hpp"
#include "verify/derivative_comparisons.hpp"
#include "verify/series_comparison.hpp"

namespace eomgen::verify {
namespace {

using symbolic::Ref;
using system::EquationSystem;

class FunctionComparisons {
 public:
  FunctionComparisons(const Subjects& subjects, const SystemValues& v, const Oracle& oracle,
                      const std::vector<int>& mode, ComparisonTable& tally)
      : program_(subjects.programs.front()),
        v_(v),
        oracle_(oracle),
        tally_(tally),
        s_(system_of(subjects)),
        at_(arguments_at(subjects.systems.front(), v.state, mode)),
        lookup_(oracle, v.state) {
    lookup_.lambda = v.lambda;
  }

  void operator()() {
    DerivativeComparisons derivatives(program_, s_, oracle_, lookup_, at_, tally_);
    for (const std::string& function : program_.functions) {
      if (function == "rhs" || function == "prepare") continue;  // compared elsewhere, or through other functions
      const std::optional<AbiResults> values = program_.call(function, at_, oracle_.digits());
      if (!values) continue;
      sizes_ = sizes(function, *values);
      if (sizes_.empty()) continue;  // too close to another branch
      if (derivatives(function, *values, sizes_)) continue;
      if (const auto off = inertia_difference(function, *values, sizes_, s_.free, oracle_, v_.state, at_.v))
        tally_.record(function + " of " + program_.name, oracle_name, false, *off);
      else
        (this->*check_of(function))(*values);
    }
  }

 private:
  using CheckFunction = void (FunctionComparisons::*)(const AbiResults&);

  /// The comparison for a function.
  static CheckFunction check_of(const std::string& function) {
    static const std::map<std::string_view, CheckFunction> statements{
        {"rhs_prepared", &FunctionComparisons::prepared},
        {"mass", &FunctionComparisons::mass},
        {"momenta", &FunctionComparisons::momenta},
        {"constraints", &FunctionComparisons::constraints},
        {"reactions", &FunctionComparisons::reactions},
        {"outputs", &FunctionComparisons::outputs},
        {"events", &FunctionComparisons::events},
        {"resets", &FunctionComparisons::resets},
        {"contact_rows", &FunctionComparisons::contact_rows},
        {"rhs_open", &FunctionComparisons::open},
        {"power", &FunctionComparisons::power},
        {"frames", &FunctionComparisons::frames},
        {"energy_gradients", &FunctionComparisons::energy_gradients},
        {"taylor", &FunctionComparisons::taylor}};
    const auto found = statements.find(function);
    if (found == statements.end()) throw std::logic_error("nothing is said of the function '" + function + "'");
    return found->second;
  }

  /// The system of the program's formulation.
  const EquationSystem& system_of(const Subjects& subjects) const {
    for (const EquationSystem& s : subjects.systems) {
      if (s.formulation == program_.formulation && s.approach == program_.approach) return s;
    }
    return subjects.systems.front();
  }

  AbiResults sizes(const std::string& function, const AbiResults& values) const {
    return value_sizes(program_, function, at_, values, oracle_);
  }

  void note(const std::string& function, const std::string& against, double difference) {
    tally_.record(function + " of " + program_.name, against, true, difference);
  }

  std::vector<Real> evaluate(const std::vector<Ref>& roots, const SymbolValues& lookup) const {
    return symbolic::evaluate(*s_.dag, roots, lookup, oracle_.digits());
  }

  /// Values of the system's expressions, each with the size of its terms. The size comes from the digits lost in the
  /// sum, and from the value for accelerations, multipliers and friction as large as their scales. Sticking friction
  /// balances the other forces and may vanish: its scale is that of these forces.
  struct Sized {
    std::vector<Real> values, sizes;
  };
  Sized sized(const std::vector<Ref>& roots, const SymbolValues& lookup) const {
    constexpr int more = 20, caution = 3;  // digits
    SymbolValues large = lookup;
    for (std::size_t i = 0; i < large.state.qddot.size(); ++i)
      large.state.qddot[i] = cln::abs(large.state.qddot[i]) + v_.scale[i];
    for (std::size_t k = 0; k < large.lambda.size(); ++k)
      large.lambda[k] = cln::abs(large.lambda[k]) + v_.scale[large.state.qddot.size() + k];
    Real forces = 0;
    for (const Residual& row : v_.rows) forces = cln::max(forces, row.scale);
    for (Real& phi : large.state.phi) phi = cln::abs(phi) + forces;
    const std::vector<Real> precise = symbolic::evaluate(*s_.dag, roots, lookup, oracle_.digits() + more);
    const std::vector<Real> largest = evaluate(roots, large);
    Sized result{evaluate(roots, lookup), {}};
    for (std::size_t i = 0; i < roots.size(); ++i) {
      const Real& value = result.values[i];
      result.sizes.push_back(cln::abs(value) + cln::abs(largest[i]) +
                             cln::abs(value - precise[i]) * power_of_ten(oracle_.digits() + caution));
    }
    return result;
  }

  /// Difference of array `r` from these expressions of the system.
  double against(const AbiResults& values, std::size_t r, const std::vector<Ref>& roots,
                 const SymbolValues& lookup) const {
    const Sized expected = sized(roots, lookup);
    double largest = 0;
    for (std::size_t i = 0; i < roots.size(); ++i) {
      largest = std::max(
          largest, relative_difference(values[r].at(i) - expected.values[i], sizes_[r].at(i) + expected.sizes[i]));
    }
    return largest;
  }

  /// Steps of differences are small relative to 1/range: with rates of 1e300 a time of 1e-50 is long.
  int step_digits() const { return oracle_.digits() - guard_digits; }
  std::optional<CentralDifference> slope(const std::string& function, const Shift& shift) const {
    return verify::central_difference(program_, function, at_, shift, step_digits());
  }
  /// The rounding error of differences of the right-hand side.
  std::vector<Real> noise(const std::string& function) const {
    const std::optional<AbiResults> values = program_.call(function, at_, oracle_.digits());
    if (!values) return {};
    const AbiResults size = sizes(function, *values);
    if (size.empty()) return {};
    return mapped(size[0], [&](const Real& one) { return one * power_of_ten(-tally_.digits()); });
  }

  void prepared(const AbiResults& values) { same_as("rhs", values, 0, "rhs_prepared", "its rhs", at_); }

  void open(const AbiResults& values) {
    AbiArguments without_forces = at_;
    for (const auto& [force, input] : s_.contact_inputs) without_forces.u.at(input.index) = 0;
    same_as("rhs", values, 0, "rhs_open", "its rhs without forces of contacts", without_forces);
    if (std::find(program_.functions.begin(), program_.functions.end(), "power") != program_.functions.end())
      same_as("power", values, 1, "rhs_open", "its power without forces of contacts", without_forces);
  }

  void power(const AbiResults& values) { note("power", system_name(s_), against(values, 0, {s_.power}, lookup_)); }

  /// Compares result r of a function with the first one of another function.
  void same_as(const char* other, const AbiResults& values, std::size_t r, const char* function, const char* what,
               const AbiArguments& at) {
    const std::optional<AbiResults> expected = program_.call(other, at, oracle_.digits());
    if (!expected) return;
    // An exact 0 in one of them may be a rounded sum in the other.
    const AbiResults own = value_sizes(program_, other, at, *expected, oracle_);
    double largest = 0;
    for (std::size_t i = 0; i < values[r].size() && !own.empty(); ++i)
      largest = std::max(largest, relative_difference(values[r][i] - (*expected)[0][i], sizes_[r][i] + own[0][i]));
    note(function, what, largest);
  }

  /// Symbol values without friction and with inputs at their defaults, as in the functions without a mode.
  SymbolValues without_mode() const {
    SymbolValues lookup = lookup_;
    std::fill(lookup.state.phi.begin(), lookup.state.phi.end(), Real(0));
    lookup.state.inputs = program_.default_inputs;
    return lookup;
  }

  void mass(const AbiResults& values) {
    const std::size_t n = s_.free.size();
    std::vector<Ref> M;
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) M.push_back(s_.M[i * n + j]);
    std::vector<Ref> h = mapped(s_.f, [&](Ref f) { return s_.dag->neg(f); });
    const SymbolValues lookup = without_mode();
    note("mass", system_name(s_), std::max(against(values, 0, M, lookup), against(values, 1, h, lookup)));
  }

  void constraints(const AbiResults& values) {
    const std::size_t n = s_.free.size(), m = s_.active.size();
    std::vector<Ref> A;
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t k = 0; k < m; ++k) A.push_back(s_.A[k * n + j]);
    const SymbolValues lookup = without_mode();
    note("constraints", system_name(s_),
         std::max(
             {against(values, 0, s_.psi, lookup), against(values, 1, A, lookup), against(values, 2, s_.b, lookup)}));
  }

  void reactions(const AbiResults& values) {
    std::vector<Ref> roots = mapped(s_.reactions, &system::Reaction::value);
    note("reactions", system_name(s_), against(values, 0, roots, lookup_));
  }

  /// Compares the outputs that the system has; only the program's own system has conserved quantities.
  void outputs(const AbiResults& values) {
    std::vector<Ref> roots;
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < program_.outputs.size(); ++i) {
      const auto* const found = find_named(s_.outputs, program_.outputs[i]);
      if (found == nullptr) continue;
      roots.push_back(found->value);
      places.push_back(i);
    }
    const Sized expected = sized(roots, lookup_);
    double largest = 0;
    for (std::size_t i = 0; i < roots.size(); ++i) {
      largest = std::max(largest, relative_difference(values[0].at(places[i]) - expected.values[i],
                                                      sizes_[0].at(places[i]) + expected.sizes[i]));
    }
    if (!roots.empty()) note("outputs", system_name(s_), largest);
  }

  void energy_gradients(const AbiResults& values) {
    tally_.record("energies of " + program_.name, oracle_name, false,
                  energy_difference(values, sizes_, oracle_.energy_values(v_.state)));
    std::vector<Real> direction;
    for (std::size_t j = 0; j < 2 * s_.free.size(); ++j) direction.push_back(direction_component(j));
    const std::optional<CentralDifference> differences =
        slope("energy_gradients", [&](AbiArguments& at, const Real& h) {
          for (std::size_t j = 0; j < direction.size(); ++j) at.x[j] = at.x[j] + h * direction[j];
        });
    if (differences)
      note("energy_gradients", "differences of energies",
           gradient_difference(values, sizes_, direction, *differences, power_of_ten(-tally_.digits())));
  }

  void frames(const AbiResults& values) {
    for (const FrameDifference& part : frame_differences(values, sizes_, s_.free, oracle_, v_.state))
      tally_.record(fmt::format("{} of {}", part.what, program_.name), oracle_name, false, part.largest);
  }

  void events(const AbiResults& values) {
    std::vector<Ref> roots = mapped(s_.events, &system::Event::value);
    if (!roots.empty()) note("events", system_name(s_), against(values, 0, roots, lookup_));
  }

  void resets(const AbiResults& values) {
    std::vector<Ref> roots;
    const auto add = [&roots](const system::Reset& reset) {
      if (reset.condition) roots.push_back(*reset.condition);
      for (const system::Reset::Entry& entry : reset.set) roots.push_back(entry.value);
    };
    for (const system::Event& event : s_.events) add(event.reset);
    for (const system::Sample& sample : s_.samples) add(sample.reset);
    if (!roots.empty()) note("resets", system_name(s_), against(values, 0, roots, lookup_));
  }

  /// Compares gaps with the oracle; velocities with the differences of gaps, and their accelerations with differences
  /// of velocities, along the path; derivatives with the forces of the contact, which do the work of these velocities.
  void contact_rows(const AbiResults& values) {
    const std::vector<Real>& c = values[0];
    const std::optional<AbiResults> rhs = program_.call("rhs", at_, oracle_.digits());
    if (!rhs) return;
    const std::optional<CentralDifference> slopes = slope("contact_rows", [&](AbiArguments& at, const Real& step) {
      at.t = at.t + step;
      for (std::size_t i = 0; i < at.x.size(); ++i) at.x[i] = at.x[i] + step * to_exact((*rhs)[0][i]);
    });
    const std::vector<Real> lost = noise("contact_rows");
    if (!slopes || lost.empty()) return;
    const eom::contacts::Set set = system::contact_set(s_);
    const std::size_t n = s_.free.size();
    double gaps = 0, rates = 0, work = 0;
    const auto follows = [&](std::size_t of, const Real& expected, const Real& size) {
      rates = std::max(rates, relative_difference(slopes->values[0][of] - expected,
                                                  size + lost[of] + slopes->errors[0][of] + cln::abs(expected)));
    };
    // Forces of different sizes at all rows together: the sum shows an error of any of them.
    SymbolValues pushed = lookup_;
    std::vector<Real> push(n, Real(0)), push_size(n, Real(1));
    const auto row = [&](const eom::contacts::Row& place, std::size_t input) {
      constexpr std::size_t prime = 1'000'003, factor = 7919;  // no two of a million inputs have equal forces
      const Real force = 1 + to_exact(static_cast<double>(input * factor % prime)) / prime;
      Real acceleration = c[place.bias()], size = sizes_[0][place.bias()];
      for (std::size_t k = 0; k < place.columns.size(); ++k) {
        const std::size_t column = place.columns[k];
        const Real term = c[place.slope(k)] * (*rhs)[0][n + column], pushes = force * c[place.slope(k)];
        acceleration = acceleration + term;
        size = size + cln::abs(term);
        push[column] = push[column] + pushes;
        push_size[column] = push_size[column] + cln::abs(pushes);
      }
      follows(place.rate(), acceleration, size);
      pushed.state.inputs[input] = pushed.state.inputs[input] + force;
    };
    const ConstraintValues constraints = oracle_.constraint_values(v_.state);
    for (std::size_t j = 0; j < set.contacts.size(); ++j) {
      const eom::contacts::Description& contact = set.contacts[j];
      if (contact.has_constraint()) {
        for (std::size_t k = 0; k < constraints.psi.size(); ++k) {
          if (oracle_.force_input(k) == contact.force_input)
            gaps = std::max(gaps, relative_difference(c[contact.gap] - constraints.psi[k], sizes_[0][contact.gap]));
        }
        follows(contact.gap, c[contact.normal.rate()], sizes_[0][contact.normal.rate()]);
        row(contact.normal, contact.force_input);
      }
      for (std::size_t a = 0; a < contact.slip.size(); ++a) row(contact.slip[a], contact.friction_input + a);
    }
    const std::vector<Real> f = evaluate(s_.f, lookup_), with = evaluate(s_.f, pushed);
    for (std::size_t i = 0; i < n; ++i)
      work = std::max(work,
                      relative_difference(with[i] - f[i] - push[i], cln::abs(with[i]) + cln::abs(f[i]) + push_size[i]));
    tally_.record("gaps of contacts of " + program_.name, oracle_name, false, gaps);
    note("contact_rows", "gaps and velocities along the path", rates);
    note("contact_rows", "the forces of contacts", work);
  }

  /// Compares dL/dqdot along a direction of the rates, and the rates of the momenta along the path, which include
  /// constraint forces and friction.
  void momenta(const AbiResults& values) {
    const std::size_t n = s_.free.size();
    const int digits = step_digits(), more = 3 * digits + 10;
    const Precision precision(more);
    const Real h = precision.round(power_of_ten(-digits));
    const auto lagrangian = [&](const Real& step) {
      SymbolValues lookup = lookup_;
      for (std::size_t i = 0; i < n; ++i) {
        Real& rate = lookup.state.qdot[s_.free[i]];
        rate = precision.round(rate) + step * direction_component(i);
      }
      const std::vector<Real> energies = symbolic::evaluate(*s_.dag, {s_.kinetic, s_.potential}, lookup, more);
      return Real(energies[0] - energies[1]);
    };
    Real sum = 0, size = (cln::abs(v_.kinetic) + cln::abs(v_.potential)) * power_of_ten(-tally_.digits());
    for (std::size_t i = 0; i < n; ++i) {
      sum = sum + values[0][i] * direction_component(i);
      size = size + sizes_[0][i] * cln::abs(direction_component(i));
    }
    note("momenta", "the Lagrangian of " + system_name(s_),
         relative_difference(sum - (lagrangian(h) - lagrangian(-h)) / (2 * h), size));

    const std::optional<AbiResults> rhs = program_.call("rhs", at_, oracle_.digits());
    if (!rhs) return;
    const std::optional<CentralDifference> slopes = slope("momenta", [&](AbiArguments& at, const Real& step) {
      at.t = at.t + step;
      for (std::size_t i = 0; i < at.x.size(); ++i) at.x[i] = at.x[i] + step * to_exact((*rhs)[0][i]);
    });
    const std::vector<Real> lost = noise("momenta");
    if (!slopes || lost.empty()) return;
    SymbolValues frictionless = lookup_;
    std::fill(frictionless.state.phi.begin(), frictionless.state.phi.end(), Real(0));
    const std::vector<Real> with = evaluate(s_.f, lookup_), without = evaluate(s_.f, frictionless),
                            A = evaluate(s_.A, lookup_), M = evaluate(s_.M, lookup_);
    std::vector<Residual> expected;
    Real most = 0;
    for (std::size_t i = 0; i < n; ++i) {
      expected.push_back({values[1][i] + with[i] - without[i],
                          sizes_[1][i] + lost[i] + slopes->errors[0][i] + cln::abs(with[i]) + cln::abs(without[i])});
      for (std::size_t k = 0; k < s_.active.size(); ++k) {
        const Real& slope = A[k * n + i];
        expected.back().add(slope * v_.lambda[s_.active[k]],
                            cln::abs(slope) * v_.scale[v_.state.qddot.size() + s_.active[k]]);
      }
      // For a conserved momentum the terms of M qddot may cancel to zero.
      for (std::size_t j = 0; j < n; ++j)
        expected.back().scale = expected.back().scale + cln::abs(M[i * n + j] * (*rhs)[0][n + j]);
      most = cln::max(most, expected.back().scale);
    }
    // Sliding friction along one direction leaves only rounding errors of its size in the others.
    constexpr int digits_of_none = 20;
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) {
      largest = std::max(largest, relative_difference(slopes->values[0][i] - expected[i].value,
                                                      expected[i].scale + most * power_of_ten(-digits_of_none)));
    }
    note("rates of momenta", "momenta along the path", largest);
  }

  void taylor(const AbiResults&) {
    const auto sizes_of_rhs = [this](const AbiResults& rhs) { return sizes("rhs", rhs); };
    if (const auto largest = series_difference(program_, at_, step_digits(), sizes_of_rhs))
      note("taylor", "dx along the series", *largest);
  }

  const ProgramForm& program_;
  const SystemValues& v_;
  const Oracle& oracle_;
  ComparisonTable& tally_;
  const EquationSystem& s_;
  AbiArguments at_;
  SymbolValues lookup_;
  AbiResults sizes_;
};

}  // namespace

void compare_functions(const Subjects& subjects, const SystemValues& values, const Oracle& oracle,
                       const std::vector<int>& mode, ComparisonTable& tally) {
  if (subjects.programs.empty() || !subjects.programs.front().call) return;
  FunctionComparisons(subjects, values, oracle, mode, tally)();
}

}  // namespace eomgen::verify

// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/code_comparisons.hpp"

#include <cln/real.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "lists.hpp"
#include "oracle/applied_forces.hpp"
#include "verify/abi_arguments.hpp"
#include "verify/friction_law.hpp"
#include "verify/function_comparisons.hpp"

namespace eomgen::verify {
namespace {

using system::EquationSystem;

/// Relative differences of dx = (qdot, qddot): velocities relative to themselves, accelerations relative to their
/// scale, both with the rounding error added to the scale, if it is known.
double rhs_difference(const std::vector<Real>& a, const std::vector<Real>& b, const EquationSystem& s,
                      const SystemValues& v, const std::vector<Real>& rounding = {}) {
  const std::size_t n = s.free.size();
  if (a.size() != s.layout().size() || b.size() != a.size()) return 1;
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    Real size = s.layout().is_rate(i) ? v.scale[s.free[i - n]] : cln::abs(b[i]);
    if (!rounding.empty()) size = size + rounding[i];
    largest = std::max(largest, relative_difference(a[i] - b[i], size));
  }
  return largest;
}

constexpr const char* beyond_binary64 = "a value beyond what binary64 holds";

double to_binary64(const Real& value) {
  if (cln::abs(value) > exact(std::numeric_limits<double>::max())) throw std::domain_error(beyond_binary64);
  return cln::double_approx(value);
}

std::vector<double> binary_values(const std::vector<Real>& values) {
  return mapped(values, [&](const Real& value) { return to_binary64(value); });
}

/// The state rounded to binary64.
State in_binary64(const State& state, const Oracle& oracle) {
  const auto exactly = [&](const Real& value) { return oracle.precision().round(exact(to_binary64(value))); };
  State at = state;
  at.t = exactly(at.t);
  for (auto* part : {&at.q, &at.qdot, &at.parameters, &at.inputs, &at.z})
    for (Real& value : *part) value = exactly(value);
  return at;
}

/// Scales of dx at a state that correspond to its rounding errors; empty if these are unknown.
std::vector<Real> rounding_of_rhs(const ProgramForm& program, const AbiArguments& at, const Oracle& oracle) {
  std::vector<Real> sizes;
  if (!program.bounds) return sizes;
  constexpr double least_number = 1e-290;  // smaller numbers have fewer digits
  const std::vector<std::vector<double>> bounds = program.bounds("rhs", at);
  for (const double bound : bounds[0]) {
    if (!std::isfinite(bound)) return {};
    sizes.push_back(rounding_scale(std::max(bound, least_number), oracle.precision()));
  }
  return sizes;
}

bool overflows(const Subjects& subjects, const AbiArguments& at) {
  if (subjects.programs.empty() || !subjects.programs.front().bounds) return false;
  const std::vector<std::vector<double>> bounds = subjects.programs.front().bounds("rhs", at);
  return std::any_of(bounds[0].begin(), bounds[0].end(), [](double bound) { return !std::isfinite(bound); });
}

/// Compares code in binary64 with the system at the same binary64 numbers.
double compiled_difference(const CompiledForm& form, const Subjects& subjects, State at, const SystemValues& v,
                           const Oracle& oracle, const std::vector<int>& mode) {
  const EquationSystem& s = subjects.systems.front();
  if (!s.contacts.empty()) at.phi = solve_friction_law(s, oracle, at);
  const std::vector<Real> reference = right_hand_side(s, oracle, at);
  const AbiArguments arguments = arguments_at(s, at, mode);
  const auto dx = form.rhs(cln::double_approx(at.t), binary_values(arguments.x), binary_values(at.parameters),
                           binary_values(at.inputs), mode);
  const std::vector<Real> rounding =
      subjects.programs.empty() ? std::vector<Real>{} : rounding_of_rhs(subjects.programs.front(), arguments, oracle);
  const bool finite = dx && std::all_of(dx->begin(), dx->end(), [](double value) { return std::isfinite(value); });
  if (!finite) {
    // If the bounds are not finite either, an intermediate value overflows.
    if (rounding.empty() && overflows(subjects, arguments)) throw std::domain_error(beyond_binary64);
    return 1;
  }
  std::vector<Real> precise = mapped(*dx, [&](double value) { return exact(value); });
  const double difference = rhs_difference(precise, reference, s, v, rounding);
  // A sine at a time of 1e300 is pure rounding error in any code: no comparison is possible.
  if (difference > tolerance_binary64 && rounding.empty() && overflows(subjects, arguments))
    throw std::domain_error("what rounding does in binary64 has no bound");
  return difference;
}

/// Compares compiled functions with those of the first program at the same binary64 numbers.
void compare_compiled_functions(const Subjects& subjects, const State& rounded, const Oracle& oracle,
                                const std::vector<int>& mode, ComparisonTable& tally) {
  if (subjects.programs.empty() || !subjects.programs.front().call) return;
  const ProgramForm& program = subjects.programs.front();
  const AbiArguments at = arguments_at(subjects.systems.front(), rounded, mode);
  constexpr double largest_number = 1e300, least_number = 1e-290;
  for (const CompiledForm& form : subjects.compiled) {
    if (!form.call) continue;
    for (const std::string& function : program.functions) {
      const std::optional<AbiResults> expected = program.call(function, at, oracle.digits());
      if (!expected) continue;
      const std::vector<std::vector<double>> bounds = program.bounds(function, at);
      const std::optional<std::vector<std::vector<double>>> got = form.call(function, at);
      double largest = got ? 0 : 1;
      bool known = true;  // values beyond binary64 are not compared
      for (std::size_t r = 0; r < expected->size() && known; ++r) {
        for (std::size_t i = 0; i < (*expected)[r].size() && known; ++i) {
          const Real& value = (*expected)[r][i];
          known = std::isfinite(bounds[r][i]) && cln::abs(value) < exact(largest_number);
          if (!known || !got) continue;
          const double entry = (*got)[r][i];
          if (!std::isfinite(entry)) {
            largest = 1;
            continue;
          }
          const Real size = cln::abs(value) + rounding_scale(std::max(bounds[r][i], least_number), oracle.precision());
          largest = std::max(largest, relative_difference(exact(entry) - value, size));
        }
      }
      if (known)
        tally.record(function + " of " + form.name, function + " of " + program.name, true, largest,
                     Arithmetic::binary64);
    }
  }
}

}  // namespace

void compare_code(const Subjects& subjects, const SystemValues& v, const Oracle& oracle, const std::vector<int>& mode,
                  ComparisonTable& tally) {
  const EquationSystem& first = subjects.systems.front();
  bool undecided = false;  // the friction law has no solution here, or several
  for (const ProgramForm& form : subjects.programs) {
    const AbiArguments arguments = arguments_at(first, v.state, mode);
    const std::vector<Real> dx = form.rhs(v.state.t, arguments.x, v.state.parameters, v.state.inputs, mode);
    undecided = undecided || (dx.empty() && !first.contacts.empty());
    if (undecided) continue;
    // An acceleration may be 0 because its terms cancel: it is compared relative to these terms.
    const std::vector<Real> rounding = rounding_of_rhs(form, arguments, oracle);
    tally.record(form.name, system_name(first), true,
                 rhs_difference(dx, right_hand_side(first, oracle, v.state), first, v, rounding));
  }
  if (undecided) return;
  compare_functions(subjects, v, oracle, mode, tally);
  if (subjects.compiled.empty()) return;
  const State at = in_binary64(v.state, oracle);
  for (const CompiledForm& form : subjects.compiled) {
    tally.record(form.name, system_name(first), true, compiled_difference(form, subjects, at, v, oracle, mode),
                 Arithmetic::binary64);
  }
  compare_compiled_functions(subjects, at, oracle, mode, tally);
}

}  // namespace eomgen::verify

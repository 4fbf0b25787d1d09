// SPDX-License-Identifier: MIT
// Changes of the accelerations for unit forces of contacts. In: compiled code whose inputs hold the forces, a state,
// the accelerations without the forces. Out: one column for each unit force.
//
// Forces that change no common acceleration share one evaluation of the right-hand side (Curtis, Powell and Reid, J.
// Inst. Math. Appl. 13, 1974). The accelerations that a force changes are those that are NaN if its input is NaN.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "eom/contacts/description.hpp"

namespace eom::contacts {

/// The compiled code as these classes need it: a right-hand side and the rows of contacts, with all inputs given.
struct System {
  virtual ~System() = default;
  /// n, the number of free coordinates.
  virtual std::size_t coordinates() const = 0;
  /// qddot of the free coordinates. Returns a code of the ABI.
  virtual int accelerations(double t, const double* x, const double* u, double* qddot) = 0;
  /// Writes the array c (description.hpp) at a state. Returns a code of the C ABI.
  virtual int rows(double t, const double* x, const double* u, double* c) = 0;
  /// Differs after each change of the equations, as by another branch or another chart.
  virtual std::size_t equations() { return 0; }
};

/// A unit force: an input, and the further inputs in proportion to it.
struct Pattern {
  std::size_t contact = 0;
  int component = -1;  // -1: the normal, with the friction that follows from it; 0, 1: a tangent
  std::vector<std::pair<std::size_t, double>> inputs = {};
};

/// Adds `amount` times the unit force to the inputs u.
inline void push(double* u, const Pattern& pattern, double amount) {
  for (const auto& [input, share] : pattern.inputs) u[input] += share * amount;
}

/// The changes of the accelerations for unit forces, at one state after the other.
class UnitResponses {
 public:
  using Index = Eigen::Index;
  using Vector = Eigen::VectorXd;
  using Matrix = Eigen::MatrixXd;

  static constexpr int code_not_finite = 5;  // as in the C ABI

  /// Both must outlive this object.
  UnitResponses(const Set& set, System& system)
      : set_(set),
        system_(system),
        n_(system.coordinates()),
        amplitude_(3 * set.contacts.size(), 1.0),
        affected_(set.contacts.size()),
        work_(static_cast<Index>(n_)) {}

  /// Patterns that change no common acceleration, kept from one evaluation to the next.
  struct Groups {
    std::vector<std::pair<std::size_t, int>> grouped = {};  // contacts and components of the patterns
    std::vector<std::vector<std::size_t>> members = {};     // indices of patterns, per group
    std::size_t equations = 0, changes = 0;                 // changes: grows with each change of the others
  };

  /// Column k of `result` (n x patterns): the change for a unit force of pattern k. `free`: the accelerations with u. A
  /// change is computed from a force with an effect of the size of the accelerations, so that few digits are lost.
  /// Returns a code of the ABI.
  int evaluate(double t, const double* x, double* u, const Vector& free, const std::vector<Pattern>& patterns,
               Groups& groups, Matrix& result) {
    update(groups, t, x, u, patterns);
    const double size = free.lpNorm<Eigen::Infinity>();
    result.setZero(static_cast<Index>(n_), static_cast<Index>(patterns.size()));
    for (const std::vector<std::size_t>& members : groups.members) {
      bool again = true;
      for (int attempt = 0; attempt < 2 && again; ++attempt) {
        for (const std::size_t k : members) push(u, patterns[k], amplitude(patterns[k]));
        const int code = system_.accelerations(t, x, u, work_.data());
        for (const std::size_t k : members) push(u, patterns[k], -amplitude(patterns[k]));
        if (code != 0 || !work_.allFinite()) return code != 0 ? code : code_not_finite;
        again = false;
        for (const std::size_t k : members) {
          double &a = amplitude(patterns[k]), effect = 0;
          for (const std::size_t i : affected_[patterns[k].contact]) {
            const auto row = static_cast<Index>(i);
            const double change = (work_(row) - free(row)) / a;
            result(row, static_cast<Index>(k)) = change;
            effect = std::max(effect, std::abs(change) * a);
          }
          if (attempt > 0 || size == 0 || effect == 0 || (effect > 1e-2 * size && effect < 1e2 * size)) continue;
          a *= size / effect;
          again = true;
        }
      }
    }
    return 0;
  }

  /// After evaluate(): the indices of the accelerations that pattern k may change, in ascending order.
  const std::vector<std::size_t>& affected(const Pattern& pattern) const { return affected_[pattern.contact]; }

 private:
  double& amplitude(const Pattern& pattern) {
    return amplitude_[3 * pattern.contact + static_cast<std::size_t>(pattern.component + 1)];
  }

  /// Groups the patterns anew if they, or the equations, are others.
  void update(Groups& groups, double t, const double* x, double* u, const std::vector<Pattern>& patterns) {
    if (const std::size_t now = system_.equations(); now != equations_) {
      equations_ = now;
      for (std::vector<std::size_t>& affected : affected_) affected.clear();
    }
    const auto is_same = [](const std::pair<std::size_t, int>& a, const Pattern& b) {
      return a.first == b.contact && a.second == b.component;
    };
    const auto& old = groups.grouped;
    if (groups.equations == equations_ && std::equal(old.begin(), old.end(), patterns.begin(), patterns.end(), is_same))
      return;
    groups = {{}, {}, equations_, groups.changes + 1};
    std::vector<std::vector<bool>> taken;  // per group and coordinate
    for (std::size_t k = 0; k < patterns.size(); ++k) {
      groups.grouped.emplace_back(patterns[k].contact, patterns[k].component);
      std::vector<std::size_t>& affected = affected_[patterns[k].contact];
      if (affected.empty()) affected = find_affected(t, x, u, patterns[k].contact);
      std::size_t g = 0;
      while (g < taken.size() &&
             std::any_of(affected.begin(), affected.end(), [&](std::size_t i) { return taken[g][i]; }))
        ++g;
      if (g == taken.size()) groups.members.emplace_back(), taken.emplace_back(n_, false);
      groups.members[g].push_back(k);
      for (const std::size_t i : affected) taken[g][i] = true;
    }
  }

  /// The accelerations that forces of contact j may change.
  std::vector<std::size_t> find_affected(double t, const double* x, double* u, std::size_t j) {
    const Description& at = set_.contacts[j];
    std::vector<std::size_t> inputs;
    if (at.has_constraint()) inputs.push_back(at.force_input);
    for (std::size_t a = 0; a < at.slip.size(); ++a) inputs.push_back(at.friction_input + a);
    std::vector<double> before;
    for (const std::size_t input : inputs)
      before.push_back(std::exchange(u[input], std::numeric_limits<double>::quiet_NaN()));
    const int code = system_.accelerations(t, x, u, work_.data());
    const bool known = code == 0 || code == code_not_finite;
    for (std::size_t i = 0; i < inputs.size(); ++i) u[inputs[i]] = before[i];
    std::vector<bool> changes(n_, !known);
    for (std::size_t i = 0; i < n_ && known; ++i) changes[i] = !std::isfinite(work_(static_cast<Index>(i)));
    for (const std::size_t i : at.normal.columns) changes[i] = true;
    for (const Row& slip : at.slip)
      for (const std::size_t i : slip.columns) changes[i] = true;
    std::vector<std::size_t> affected;
    for (std::size_t i = 0; i < n_; ++i)
      if (changes[i]) affected.push_back(i);
    return affected;
  }

  const Set& set_;
  System& system_;
  std::size_t n_;
  std::vector<double> amplitude_;
  std::vector<std::vector<std::size_t>> affected_;  // per contact; empty: not known
  Vector work_;
  std::size_t equations_ = 0;
};

}  // namespace eom::contacts

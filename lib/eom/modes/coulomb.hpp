// SPDX-License-Identifier: MIT
// Coulomb friction as modes: which functions bound sticking and sliding, and what follows where one of them is crossed.
// In: the contacts of a model and its functions rhs(t, x, mode, dx) and contacts(t, x, mode, g) in the numbering of the C ABI
// (docs/abi.md, "Modes"), five values per contact: slip, mu_s |N| - phi, mu_s |N| + phi, p x (the normal force), margin. Out: the
// table and the rule of integrate_modes(), and the mode in which a start is.
//
// Contacts that slide in two directions at once are not taken yet: std::invalid_argument.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "eom/modes/machine.hpp"

namespace eom {

struct CoulombContact {
  std::string name;
  std::size_t dimensions = 1;  // directions in which it slides
  bool surface = false;        // its normal force has a sign
};

template <class Rhs, class Functions>
class Coulomb {
 public:
  Coulomb(std::vector<CoulombContact> contacts, std::size_t states, Rhs rhs, Functions functions)
      : contacts_(std::move(contacts)), dx_(states), g_(values * contacts_.size()), rhs_(std::move(rhs)), functions_(std::move(functions)) {
    for (const CoulombContact& contact : contacts_) {
      if (contact.dimensions != 1) throw std::invalid_argument("eom::Coulomb: '" + contact.name + "' slides in two directions");
    }
    make_table();
  }

  std::size_t functions() const { return g_.size(); }
  std::span<const Mode> table() const { return table_; }

  /// The mode of a state: what slips slides; what does not sticks if the static law allows, else slides off. `tiny`: slip
  /// speeds up to here count as none.
  int mode_at(double t, const double* x, double tiny) {
    int mode = 0;
    for (std::size_t j = 0; j < contacts_.size(); ++j) {
      functions_(t, x, mode, g_.data());
      const double slip = g_[values * j];
      if (slip > tiny) mode = with(mode, j, 1);
      if (slip < -tiny) mode = with(mode, j, 2);
    }
    // One change may call for another; contacts that do not settle are left to the rule.
    for (std::size_t round = 0; round < 4 * contacts_.size(); ++round) {
      functions_(t, x, mode, g_.data());
      const int next = settled(mode);
      if (next == mode) break;
      mode = next;
    }
    return mode;
  }

  Transition operator()(const ModePoint& point) {
    const std::size_t j = point.crossing.function / values, what = point.crossing.function % values;
    const int digit = state(point.mode, j), sign = digit - digit % 3;
    const std::string& name = contacts_[j].name;
    switch (what) {
      case 0: {
        const int sticking = with(point.mode, j, sign);
        functions_(point.t, point.x.data(), sticking, g_.data());
        if (g_[values * j + 1] >= 0 && g_[values * j + 2] >= 0) return {sticking, "stick", name};
        return {with(point.mode, j, sign + 3 - digit % 3), "reverse", name};
      }
      // Friction at its limit along the tangent gives way against it, and the other way round.
      case 1: return {with(point.mode, j, sign + 2), "slip", name};
      case 2: return {with(point.mode, j, sign + 1), "slip", name};
      case 3: return {with(point.mode, j, (digit + 3) % 6)};
      default: break;
    }
    const int code = rhs_(point.t, point.x.data(), point.mode, dx_.data());
    return {point.mode, "singular_configuration", name, code == 4 ? Outcome::friction_many_solutions : Outcome::friction_no_solution};
  }

 private:
  static constexpr std::size_t values = 5;
  static constexpr int base = 6;

  static int weight(std::size_t j) {
    int result = 1;
    while (j-- > 0) result *= base;
    return result;
  }
  static int state(int mode, std::size_t j) { return mode / weight(j) % base; }
  static int with(int mode, std::size_t j, int digit) { return mode + (digit - state(mode, j)) * weight(j); }

  int settled(int mode) const {
    for (std::size_t j = 0; j < contacts_.size(); ++j) {
      const int digit = state(mode, j);
      const double* g = g_.data() + values * j;
      if (contacts_[j].surface && g[3] < 0) return with(mode, j, (digit + 3) % 6);
      if (digit % 3 != 0) continue;
      if (g[1] < 0) return with(mode, j, digit + 2);
      if (g[2] < 0) return with(mode, j, digit + 1);
    }
    return mode;
  }

  void make_table() {
    table_.resize(static_cast<std::size_t>(weight(contacts_.size())));
    for (std::size_t m = 0; m < table_.size(); ++m) {
      for (std::size_t j = 0; j < contacts_.size(); ++j) {
        const int digit = state(static_cast<int>(m), j);
        std::vector<WatchedSurface>& watched = table_[m].watched;
        const std::size_t first = values * j;
        if (digit % 3 == 0) {
          watched.push_back({first + 1, Direction::down});
          watched.push_back({first + 2, Direction::down});
        } else {
          watched.push_back({first, digit % 3 == 1 ? Direction::down : Direction::up});
          watched.push_back({first + 4, Direction::down});
        }
        if (contacts_[j].surface) watched.push_back({first + 3, Direction::down});
        table_[m].name += (table_[m].name.empty() ? "" : ", ") + contacts_[j].name + (digit % 3 == 0 ? " sticks" : " slides");
      }
    }
  }

  std::vector<CoulombContact> contacts_;
  std::vector<double> dx_, g_;
  std::vector<Mode> table_;
  Rhs rhs_;
  Functions functions_;
};

}  // namespace eom

// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/jumps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "numeric/dense.hpp"
#include "symbolic/calculus.hpp"

namespace eomgen::run {
namespace {

using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

constexpr double rounding = 1e-9;     // of what jumps: a smaller difference is none
constexpr double far = 1e-6;          // of the time: a change over so much
constexpr double part_of_far = 1e-4;  // what changes by less than this part of it at the kink does not jump

/// t, free coordinates and rates, integrals, inputs.
RangeCode::Lookup symbols_of(const system::EquationSystem& s, const std::vector<double>& parameters) {
  return [&s, &parameters](const Symbol& symbol) {
    const std::size_t n = s.free.size();
    switch (symbol.kind) {
      case SymbolKind::time: return RangeCode::Leaf::of_variable(0);
      case SymbolKind::parameter: return RangeCode::Leaf::of(parameters[symbol.index]);
      case SymbolKind::input: return RangeCode::Leaf::of_variable(1 + 2 * n + s.integrals.size() + symbol.index);
      case SymbolKind::side: return RangeCode::Leaf::of(0);
      case SymbolKind::coordinate: {
        const auto place = std::find(s.free.begin(), s.free.end(), symbol.index);
        if (symbol.order > 1 || place == s.free.end()) return RangeCode::Leaf{};
        return RangeCode::Leaf::of_variable(1 + symbol.order * n + static_cast<std::size_t>(place - s.free.begin()));
      }
      case SymbolKind::integral:
        for (std::size_t i = 0; i < s.integrals.size(); ++i) {
          if (s.integrals[i].integral == symbol.index) return RangeCode::Leaf::of_variable(1 + 2 * n + i);
        }
        return RangeCode::Leaf{};
      default: return RangeCode::Leaf{};
    }
  };
}

}  // namespace

Jumps::Jumps(const mechanics::Mechanics& m, const system::EquationSystem& s, const std::vector<double>& parameters,
             const Clock& clock)
    : n_(s.free.size()), inputs_(m.model->inputs.size()), integrals_(s.integrals.size()) {
  symbolic::Dag& dag = *s.dag;
  const auto lookup = symbols_of(s, parameters);
  std::vector<Ref> roots{s.potential};
  what_.push_back(What::potential);
  names_.emplace_back();
  const auto add = [&](Ref r, What what, const std::string& name = "") {
    roots.push_back(r);
    what_.push_back(what);
    names_.push_back(name);
  };
  for (std::size_t i = 0; i < s.psi.size(); ++i) add(s.psi[i], What::psi);
  for (const Ref r : s.A) add(r, What::row);
  for (const Ref r : s.b) add(r, What::rate);
  for (const system::Output& output : s.outputs) {
    using system::OutputKind;
    if (output.kind == OutputKind::coordinate || output.kind == OutputKind::position)
      add(output.value, What::place, output.name);
    if (output.kind == OutputKind::velocity) add(output.value, What::velocity, output.name);
  }
  std::vector<Ref> energies{s.kinetic};
  energies.insert(energies.end(), roots.begin(), roots.end());
  if (!dag.has_kinks(energies)) return;
  const Ref lagrangian = dag.sub(s.kinetic, s.potential);
  for (const std::uint32_t q : s.free)
    add(symbolic::partial(dag, {SymbolKind::coordinate, q, 1})(lagrangian), What::momentum);
  code_ = RangeCode(dag, roots, lookup);
  if (!code_.complete()) {
    code_ = {};
    return;
  }
  for (std::size_t k = 0; k < code_.kinks(); ++k) {
    if (!code_.moves(k)) {
      by_time_ = by_time_ || !clock.breaks.empty();
      continue;
    }
    if (!code_.jumps(k)) continue;
    const bool known = std::any_of(surfaces_.begin(), surfaces_.end(),
                                   [&](std::size_t other) { return code_.same_surface(k, other); });
    if (!known) surfaces_.push_back(k);
  }
  if (by_time_) mass_ = RangeCode(dag, s.M, lookup);
}

const std::vector<double>& Jumps::variables(const At& at) const {
  variables_.assign(1, at.t);
  variables_.insert(variables_.end(), at.x.begin(), at.x.begin() + static_cast<std::ptrdiff_t>(2 * n_ + integrals_));
  variables_.insert(variables_.end(), at.u, at.u + inputs_);
  return variables_;
}

std::string Jumps::name(std::size_t root) const {
  switch (what_[root]) {
    case What::potential: return "the potential energy";
    case What::momentum: return "the kinetic energy";
    case What::psi: return "the place where a constraint holds";
    case What::row: return "the direction of a constraint";
    case What::rate: return "the rate of a constraint";
    default: return names_[root];
  }
}

/// Of each kind beside what its values are made of: a potential beside the kinetic energy, a constraint beside the
/// coordinates and rates.
std::array<double, Jumps::kinds> Jumps::sizes(const std::vector<double>& one, const std::vector<double>& other,
                                              std::span<const double> x) const {
  std::array<double, kinds> size{};
  const auto of = [&](What what) -> double& { return size[static_cast<std::size_t>(what)]; };
  double energy = 0, position = 0, rate = 0;
  for (std::size_t i = 0, k = 0; i < what_.size(); ++i) {
    of(what_[i]) = std::max({of(what_[i]), std::abs(one[i]), std::abs(other[i])});
    if (what_[i] == What::momentum) energy += std::abs(one[i] * x[n_ + k++]) / 2;
  }
  for (std::size_t i = 0; i < n_; ++i) {
    position = std::max(position, std::abs(x[i]));
    rate = std::max(rate, std::abs(x[n_ + i]));
  }
  of(What::potential) += energy;
  of(What::place) += position;
  of(What::velocity) += rate;
  of(What::psi) += of(What::row) * position;
  of(What::rate) += of(What::row) * rate;
  return size;
}

Jumps::Told Jumps::cross(const At& before, double after, const double* u_after, std::span<double> x) const {
  Told told;
  const double later = after + far * (std::abs(after) > 0 ? std::abs(after) : 1);
  const auto at = [&](double t, const double* u) -> const std::vector<double>& { return variables({t, before.x, u}); };
  const auto three = [&](const RangeCode& code) {
    std::array<std::vector<double>, 3> values;
    for (auto& v : values) v.resize(code.roots());
    code.values(at(before.t, before.u), values[0]);
    code.values(at(after, u_after), values[1]);
    code.values(at(later, u_after), values[2]);
    return values;
  };
  const auto jumps = [](const auto& values, std::size_t i, double size) {
    const double change = std::abs(values[1][i] - values[0][i]), on = std::abs(values[2][i] - values[1][i]);
    return change > std::max(rounding * size, part_of_far * on) &&
           change > 1e-14 * std::max(std::abs(values[0][i]), std::abs(values[1][i]));
  };
  const auto values = three(code_);
  const std::array<double, kinds> size = sizes(values[0], values[1], before.x);
  Eigen::VectorXd change = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n_));
  Eigen::Index row = 0;
  bool momentum = false;
  for (std::size_t i = 0; i < what_.size(); ++i) {
    const bool jump = jumps(values, i, size[static_cast<std::size_t>(what_[i])]);
    if (what_[i] == What::momentum) {
      change(row++) = jump ? values[0][i] - values[1][i] : 0;
      momentum = momentum || jump;
    }
    if (!jump) continue;
    told.potential = told.potential || what_[i] == What::potential;
    told.velocities = told.velocities || what_[i] != What::potential;
    if (what_[i] == What::velocity && told.what.empty()) told.what = names_[i];
    if (what_[i] != What::psi && what_[i] != What::place) continue;
    told.undetermined = fmt::format(
        "{} jumps at t = {:.15g} by {:.6g}, with an unbounded velocity: make it a motion that takes some time", name(i),
        after, values[1][i] - values[0][i]);
    return told;
  }
  if (!momentum) return told;
  std::vector<double> M(n_ * n_);
  mass_.values(at(after, u_after), M);
  const auto n = static_cast<Eigen::Index>(n_);
  const Eigen::VectorXd moved = numeric::least_squares(Eigen::Map<const Eigen::MatrixXd>(M.data(), n, n), change).x;
  for (std::size_t i = 0; i < n_; ++i) x[n_ + i] += moved(static_cast<Eigen::Index>(i));
  return told;
}

void Jumps::values(const At& at, double* g) const {
  code_.values(variables(at), {});
  for (std::size_t i = 0; i < surfaces_.size(); ++i) g[i] = code_.surface(surfaces_[i]);
}

std::string Jumps::cross(const At& at, std::size_t surface) {
  std::array<std::vector<double>, 2> sides;
  for (const int side : {0, 1}) {
    for (std::size_t k = 0; k < code_.kinks(); ++k) {
      if (code_.same_surface(k, surfaces_[surface])) code_.hold(k, side == 0 ? -1 : 1);
    }
    auto& values = sides[static_cast<std::size_t>(side)];
    values.resize(code_.roots());
    code_.values(variables(at), values);
  }
  code_.release();
  const std::array<double, kinds> size = sizes(sides[0], sides[1], at.x);
  for (std::size_t i = 0; i < what_.size(); ++i) {
    const double change = sides[1][i] - sides[0][i];
    if (!(std::abs(change) > rounding * size[static_cast<std::size_t>(what_[i])])) continue;
    return fmt::format(
        "{} jumps by {:.6g} at t = {:.15g}, where a branch of `if` or `sign` changes: the equations do not say what "
        "the impulse does there; make it a steep but "
        "smooth step, tanh((x - a)/w) say, or a constraint with unilateral = true",
        name(i), change, at.t);
  }
  return "";
}

}  // namespace eomgen::run

// SPDX-License-Identifier: GPL-3.0-or-later
// If the curl vanishes, the work along a closed path depends only on the singular points it encloses.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "conservation/conserved.hpp"
#include "conservation/potential.hpp"
#include "mechanics/vanishes.hpp"
#include "symbolic/antiderivative.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/polynomial.hpp"
#include "symbolic/sample.hpp"

namespace eomgen::conservation {
namespace {

using mechanics::Vec3;

Symbol coordinate(std::size_t i) { return {SymbolKind::coordinate, static_cast<std::uint32_t>(i), 0}; }

class Paths {
 public:
  Paths(mechanics::Mechanics& m, const std::vector<Ref>& Q) : m_(m), dag_(*m.dag), Q_(Q) {}

  /// Whether q -> q + 2 pi restores every place, and moves some in between.
  bool is_turn(std::size_t i, const std::vector<Vec3>& places) {
    symbolic::Substitution turned = turn(i);
    std::vector<Ref> difference;
    bool moves = false;
    for (const Vec3& place : places) {
      for (const Ref x : place) {
        moves = moves || symbolic::depends_on(dag_, x, coordinate(i));
        difference.push_back(dag_.sub(turned(x), x));
      }
    }
    return moves && mechanics::vanishes(dag_, difference);
  }

  symbolic::Substitution turn(std::size_t i) {
    return {dag_, {{coordinate(i), dag_.add(m_.q[i], dag_.mul(dag_.integer(2), dag_.pi()))}}};
  }

  /// The work around circles in the plane of coordinates i and k: none, some, or undecided if the quadrature does not
  /// converge.
  Circulation::Answer around_circles(std::size_t i, std::size_t k) {
    // Circles about the origin, and about another point. Quadratures over circles through a singular point do not
    // converge.
    static constexpr double circles[][3] = {
        {0, 0, 0.61}, {0, 0, 2.3}, {0, 0, 11.7}, {0.83, -0.57, 0.71}, {0.83, 0.57, 2.9}};
    bool settled = false;
    for (const auto& circle : circles) {
      const auto [work, size] = integral(i, k, circle, 256);
      const auto [again, again_size] = integral(i, k, circle, 512);
      if (!std::isfinite(work) || !std::isfinite(again) || std::abs(work - again) > 1e-7 * again_size) continue;
      settled = true;
      if (std::abs(again) > 1e-6 * again_size) return Circulation::Answer::some;
    }
    return settled ? Circulation::Answer::none : Circulation::Answer::undecided;
  }

 private:
  // The trapezoidal rule, which converges geometrically on a circle: the integral, and that of the absolute value.
  std::pair<double, double> integral(std::size_t i, std::size_t k, const double (&circle)[3], int points) const {
    double work = 0, size = 0;
    for (int p = 0; p < points; ++p) {
      const double angle = 2 * std::numbers::pi * (p + 0.5) / points, c = std::cos(angle), s = std::sin(angle);
      const std::vector<double> Q = symbolic::evaluate(dag_, {Q_[i], Q_[k]}, [&](const Symbol& symbol) {
        if (symbol == coordinate(i)) return circle[0] + circle[2] * c;
        if (symbol == coordinate(k)) return circle[1] + circle[2] * s;
        return symbolic::sample_double(symbol, 1);
      });
      const double along = (-Q[0] * s + Q[1] * c) * circle[2] * 2 * std::numbers::pi / points;
      work += along;
      size += (std::abs(Q[0]) + std::abs(Q[1])) * circle[2] * 2 * std::numbers::pi / points;
    }
    return {work, size};
  }

  mechanics::Mechanics& m_;
  Dag& dag_;
  const std::vector<Ref>& Q_;
};

// A function without inverse trigonometric functions is single-valued: its change along closed paths is 0.
bool has_branches(const Dag& dag, Ref U) {
  using symbolic::Op;
  const std::vector<Ref> nodes = dag.reachable({U});
  return std::any_of(nodes.begin(), nodes.end(), [&](Ref r) {
    const Op op = dag[r].op;
    return op == Op::atan || op == Op::atan2 || op == Op::asin || op == Op::acos;
  });
}

}  // namespace

Circulation circulation(mechanics::Mechanics& m, const std::vector<Ref>& Q, const std::optional<Potential>& potential,
                        const std::vector<Vec3>& places) {
  Dag& dag = *m.dag;
  Paths paths(m, Q);
  Circulation result;
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < Q.size(); ++i) {
    const std::string& name = m.model->coordinates[i].name;
    const bool present = !dag.is_zero(Q[i]) || std::any_of(Q.begin(), Q.end(), [&](Ref q) {
      return symbolic::depends_on(dag, q, coordinate(i));
    });
    if (!present) continue;
    if (!paths.is_turn(i, places)) {
      others.push_back(i);
      continue;
    }
    if (!potential) {
      result.answer = Circulation::Answer::undecided;
      continue;
    }
    symbolic::Substitution turned = paths.turn(i);
    const Ref work = dag.sub(potential->U, turned(potential->U));
    if (mechanics::vanishes(dag, {work})) continue;
    return {Circulation::Answer::some, "one turn of " + name, symbolic::expand_or_keep(dag, work)};
  }
  if (domain_of(m, Q).empty() || (potential && !has_branches(dag, potential->U))) return result;
  if (others.size() < 2 && result.answer == Circulation::Answer::none) return result;  // a line has no closed paths
  if (!potential)
    result.answer = Circulation::Answer::undecided;  // circles can show that there is work, not that there is none
  for (std::size_t a = 0; a < others.size(); ++a) {
    for (std::size_t b = a + 1; b < others.size(); ++b) {
      const Circulation::Answer answer = paths.around_circles(others[a], others[b]);
      const std::string plane = m.model->coordinates[others[a]].name + " and " + m.model->coordinates[others[b]].name;
      if (answer == Circulation::Answer::some) return {answer, "a closed path in the plane of " + plane};
      if (answer == Circulation::Answer::undecided) result.answer = answer;
    }
  }
  return result;
}

}  // namespace eomgen::conservation

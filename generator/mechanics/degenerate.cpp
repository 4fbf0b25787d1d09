// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/degenerate.hpp"

#include <cmath>
#include <map>

#include "symbolic/evaluate.hpp"
#include "symbolic/sample.hpp"

namespace eomgen::mechanics {

using symbolic::Ref;
using symbolic::Symbol;

namespace {

enum class Convergence { none, regular, multiple };

// At a root of multiplicity k, a Newton step reduces psi by the factor (1 - 1/k)^k: 1/4 for a square, 1/e at most.
// Convergence to a simple root is quadratic.
constexpr double least_left = 0.2, most_left = 0.4;
constexpr int in_a_row = 12, most_steps = 40;

Convergence convergence(const symbolic::Dag& dag, const std::vector<Ref>& roots, const std::vector<Symbol>& of,
                        std::uint64_t point) {
  std::map<Symbol, double> q;
  for (const Symbol& symbol : of) q[symbol] = symbolic::sample_double(symbol, point);
  const std::function<double(const Symbol&)> at = [&](const Symbol& symbol) {
    const auto found = q.find(symbol);
    return found == q.end() ? symbolic::sample_double(symbol, point) : found->second;
  };
  double before = 0, first = 0;
  int row = 0;
  for (int step = 0; step < most_steps; ++step) {
    const std::vector<double> value = symbolic::evaluate(dag, roots, at);
    double square = 0;
    for (std::size_t i = 0; i < of.size(); ++i) square += value[i + 1] * value[i + 1];
    const double size = std::fabs(value[0]);
    if (!std::isfinite(size) || !std::isfinite(square)) return Convergence::none;
    if (step == 0) first = size;
    const double left = size / before;
    row = step > 0 && left > least_left && left < most_left ? row + 1 : 0;
    if (row >= in_a_row) return Convergence::multiple;
    if (size <= 1e-12 * first) return Convergence::regular;
    if (square == 0) return Convergence::none;
    for (std::size_t i = 0; i < of.size(); ++i) q[of[i]] -= value[0] * value[i + 1] / square;
    before = size;
  }
  return Convergence::none;
}

}  // namespace

bool is_degenerate(const symbolic::Dag& dag, Ref psi, const std::vector<Symbol>& of, const std::vector<Ref>& gradient) {
  std::vector<Ref> roots{psi};
  roots.insert(roots.end(), gradient.begin(), gradient.end());
  bool multiple = false;
  for (std::uint64_t point = 1; point <= 4; ++point) {
    const Convergence found = convergence(dag, roots, of, point);
    if (found == Convergence::regular) return false;
    multiple = multiple || found == Convergence::multiple;
  }
  return multiple;
}

}  // namespace eomgen::mechanics

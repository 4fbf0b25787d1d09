// SPDX-License-Identifier: MIT
// Loops over the stages of a collocation method, its polynomial, and the hooks of methods that extend it.
#pragma once

#include <cstddef>

#include "eom/implicit/radau_tableau.hpp"

namespace eom::implicit {

/// act(k) for each stage; most: largest number of stages; for 3 the loop is unrolled.
template <std::size_t most, class Act>
void each_stage(const RadauTableau& tableau, Act act) {
  if constexpr (most == 3)
    act(0), act(1), act(2);
  else
    for (std::size_t k = 0; k < tableau.stages; ++k) act(k);
}

/// Weights of the values at the nodes at s, with value 0 at 0: Lagrange's polynomials.
template <std::size_t most>
void stage_weights(const RadauTableau& tableau, double s, RadauTableau::Row& weight) {
  each_stage<most>(tableau, [&](std::size_t k) {
    weight[k] = s * tableau.node[k];
    each_stage<most>(tableau, [&](std::size_t j) { weight[k] *= j == k ? 1 : s - tableau.c[j]; });
  });
}

/// The quartic with value 0 at 0 and 1, slope 1 at 0 and slope 0 at the three stages of order 5.
inline constexpr double bump(double s) { return s * (1 + s * (-4.5 + s * (6 - 2.5 * s))); }

/// Hooks of methods with algebraic equations or a variable number of stages. A Method overrides those that it needs.
struct CollocationHooks {
  int linearise() { return 0; }  // at the start of a step, with df/dx; returns a code
  template <class Matrix>
  void border(Matrix&) const {}  // rows and columns beyond the motion
  int add_algebraic(double, const double*, const double*, double*) {
    return 0;
  }  // t, x, u, derivatives followed by g; returns a code
  template <class Size>
  void border_units(double*, const Size&) const {}  // right-hand sides for the correction units
  int correct_last_stage() { return 0; }            // after the iteration: corrects the last stage; returns a code
  void choose_stages(double) {}                     // after an accepted step; argument: growth of the next
};

}  // namespace eom::implicit

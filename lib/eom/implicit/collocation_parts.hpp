// SPDX-License-Identifier: MIT
// Loops over the stages of a collocation method, its polynomial, and the hooks of methods that are more than that.
#pragma once

#include <cstddef>

#include "eom/implicit/radau_tableau.hpp"

namespace eom::implicit {

/// act(k) for each stage; most: stages at most, and where that is 3 the loop is written out.
template <std::size_t most, class Act>
void each_stage(const RadauTableau& tableau, Act act) {
  if constexpr (most == 3)
    act(0), act(1), act(2);
  else
    for (std::size_t k = 0; k < tableau.stages; ++k) act(k);
}

/// What the values at the nodes weigh at s, with 0 at 0: Lagrange's polynomials.
template <std::size_t most>
void stage_weights(const RadauTableau& tableau, double s, RadauTableau::Row& weight) {
  each_stage<most>(tableau, [&](std::size_t k) {
    weight[k] = s * tableau.node[k];
    each_stage<most>(tableau, [&](std::size_t j) { weight[k] *= j == k ? 1 : s - tableau.c[j]; });
  });
}

/// Hooks of what has algebraic equations, or chooses its stages: a Method hides those that it needs.
struct CollocationHooks {
  int linearise() { return 0; }  // at the step's start, with df/dx; returns a code
  template <class Matrix>
  void border(Matrix&) const {}  // rows and columns beyond the motion
  int add_algebraic(double, const double*, const double*, double*) {
    return 0;
  }  // t, x, u, derivatives in which g stands too; a code
  template <class Size>
  void border_units(double*, const Size&) const {}  // right-hand sides for Units
  int settle() { return 0; }                        // after the iteration: of the last stage; returns a code
  void choose_stages(double) {}                     // after an accepted step; growth of the next
};

}  // namespace eom::implicit

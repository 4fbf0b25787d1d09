// SPDX-License-Identifier: GPL-3.0-or-later
// The published problems by hand: their equations from a textbook or a test set, in quadruple precision, integrated by
// extrapolation. They use nothing of the generator, so that agreement is significant.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace published {

using Quad = __float128;
using State = std::vector<Quad>;
using Values = std::map<std::string, Quad>;  // by the names of the model: parameters, or coordinates and their rates

struct Problem {
  std::string model, scene;
  std::string literature;                                            // source of the values, or the quantity compared
  std::vector<std::pair<std::string, std::string>> parameters;       // exact decimals
  std::function<Values(const Values& p)> start;                      // exact, by names of the model
  std::function<State(const Values& p, const Values& start)> begin;  // to the state of the handwritten equations
  std::function<void(const Values& p, Quad t, const State& x, State& dx)> rhs;
  std::function<Values(const Values& p, const State& x)> end;  // the inverse
  std::string t1;                                              // decimal, or "2 pi"
  std::vector<std::pair<std::string, std::string>>
      values;  // of the literature at t1; missing entries are not published
  std::function<Values(const Values& p, const Values& start, Quad t)> closed_form = {};  // replaces rhs
  bool start_is_binary64 = false;  // uses the given start instead of the one that a run computes
  bool by_hand_alone = false;
};

const std::vector<Problem>& problems();

Quad number(const std::string& decimal);  // "2 pi" too
std::string text(Quad x, int digits);

/// The state at t1 by Gragg's method with extrapolation of `columns` columns. The error of each step is below
/// `tolerance` of the largest value of each component along the run, or of 1e-2 of the largest of all.
State integrate(const std::function<void(Quad t, const State& x, State& dx)>& rhs, State x, Quad t1, int columns,
                Quad tolerance);

}  // namespace published

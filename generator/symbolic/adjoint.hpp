// SPDX-License-Identifier: GPL-3.0-or-later
// Gradients by reverse accumulation: their cost is a small multiple of that of the expressions, for any number of
// symbols. Source: Griewank and Walther, Evaluating Derivatives, 2008, section 3.2.
#pragma once

#include <vector>

#include "symbolic/dag.hpp"
#include "symbolic/norm_slope.hpp"

namespace eomgen::symbolic {

/// d(sum_i weights_i roots_i)/d(symbol) for each of `symbols`. The weights are held. As many weights as roots. The
/// slopes of `norms` are 0 where they vanish.
std::vector<Ref> gradient(Dag& dag, const std::vector<Ref>& roots, const std::vector<Ref>& weights,
                          const std::vector<Symbol>& symbols, const VanishingNorms& norms = {});

}  // namespace eomgen::symbolic

// SPDX-License-Identifier: GPL-3.0-or-later
// Values that are computed in loops over arrays, as Dag expressions of one pass: the same operations for many columns
// of a matrix. As straight-line code they would not fit into the instruction cache.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "symbolic/factorisation.hpp"

namespace eomgen::system {

/// An entry of the working memory or of the result.
struct ArrayEntry {
  bool in_result = false;
  std::size_t index = 0;
};

/// For k = 0, .., count - 1: work[outputs[i] + k] = values[i], in which the symbol {vector, j} is work[inputs[j] + k].
/// A pass reads nothing that another pass writes.
struct ArrayLoop {
  std::size_t count = 0;
  std::vector<std::size_t> inputs, outputs;
  std::vector<symbolic::Ref> values;
};

struct ArrayStore {
  symbolic::Ref value;  // of t, the state, parameters, inputs and accelerations
  ArrayEntry to;
};

struct ArrayCopy {
  ArrayEntry from, to;
};

/// Stores, then copies, then a loop, then copies.
struct ArrayStep {
  std::vector<ArrayStore> stores;
  std::vector<ArrayCopy> before;
  ArrayLoop loop;  // no passes: none
  std::vector<ArrayCopy> after;
};

/// The derivative of a generalised force, which stands in the expressions as a symbol: dQ_row/dx_column of the state
/// x = (q, qdot).
struct ForceSlope {
  symbolic::Symbol symbol;
  std::size_t row = 0, column = 0;
};

/// d(qddot)/d(q, qdot) in loops: n x 2n, column-major.
struct AccelerationSlopes {
  std::size_t work = 0;  // entries of the working memory, which is 0 at first
  std::vector<ArrayStep> steps;
  std::vector<ForceSlope> forces;  // all others are zero
};

}  // namespace eomgen::system

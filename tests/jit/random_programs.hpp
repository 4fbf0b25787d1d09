// SPDX-License-Identifier: GPL-3.0-or-later
// Programs of random operations, for comparisons of two ways to run them.
#pragma once

#include <cstdint>

#include "emit/examples.hpp"

namespace test_systems {

/// A program whose functions hold every operation with operands of every kind, negated or not, with tests of pivots,
/// groups of sines and values that are used at once or much later. `length`: instructions of `outputs`.
Example random_example(std::uint64_t seed, std::size_t length);

}  // namespace test_systems

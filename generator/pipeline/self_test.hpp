// SPDX-License-Identifier: GPL-3.0-or-later
// The self test of emitted code (docs/abi.md) for functions in memory: the same states, values and tolerances.
#pragma once

#include <optional>

#include "abi/compiled.hpp"
#include "emit/context.hpp"
#include "program/program.hpp"

namespace eomgen::pipeline {

/// The index of the first test vector of `context` that the functions do not satisfy, if there is one.
std::optional<std::size_t> failed_test_vector(const abi::CompiledFunctions& functions, const program::Program& program,
                                              const emit::EmissionContext& context);

}  // namespace eomgen::pipeline

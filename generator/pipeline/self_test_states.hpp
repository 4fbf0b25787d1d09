// SPDX-License-Identifier: GPL-3.0-or-later
// The states at which emitted code tests itself.
#pragma once

#include <vector>

#include "emit/context.hpp"
#include "program/program.hpp"

namespace eomgen::pipeline {

/// Three points in mode 0, of contacts one in every other mode, the first ones, two in second charts.
std::vector<emit::TestVector> test_vectors(const program::Program& program, const emit::EmissionContext& context);

}  // namespace eomgen::pipeline

// SPDX-License-Identifier: GPL-3.0-or-later
// The states of the self test of emitted code.
#pragma once

#include <vector>

#include "emit/context.hpp"
#include "program/program.hpp"

namespace eomgen::pipeline {

/// Three states in mode 0; with contacts one in each of the first other modes; two in second charts.
std::vector<emit::TestVector> test_vectors(const program::Program& program, const emit::EmissionContext& context);

}  // namespace eomgen::pipeline

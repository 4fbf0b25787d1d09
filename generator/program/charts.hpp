// SPDX-License-Identifier: GPL-3.0-or-later
// One program for several charts. In: programs of one model in its own charts and in second charts, and the formulas of
// the chart change. Out: one program.
#pragma once

#include "program/program.hpp"
#include "system/chart_change.hpp"

namespace eomgen::program {

/// Indices of the outputs that a program in second charts can compute with the same meaning. Excluded are momenta and
/// accelerations of exchanged angles, and quantities that only the own charts conserve. `own`, `second`: outputs of the
/// equations in these charts; `exchanged`: coordinates of the model.
std::vector<std::uint32_t> chart_independent_outputs(const std::vector<std::string>& outputs,
                                                     const std::vector<system::Output>& own,
                                                     const std::vector<system::Output>& second,
                                                     const std::vector<std::uint32_t>& exchanged);

/// Adds the functions of the chart changes to `program`. `dag`: the graph of `changes`.
void add_charts(Program& program, const symbolic::Dag& dag, const std::vector<system::ChartChange>& changes);

/// Adds the variant `second`, in the second charts `charts`, to `program`. The variant computes only the outputs at the
/// indices `places`. Throws Error if the two programs are incompatible.
void add_chart_variant(Program& program, Program second, unsigned charts, const std::vector<std::uint32_t>& places);

}  // namespace eomgen::program

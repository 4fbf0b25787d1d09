// SPDX-License-Identifier: GPL-3.0-or-later
// One program in several charts. In: programs of one model in its own charts and in second ones, formulas of the
// exchange. Out: one.
#pragma once

#include "program/program.hpp"
#include "system/chart_change.hpp"

namespace eomgen::program {

/// With charts fewer kinks can be held: their bits come after.
inline constexpr std::size_t most_kinks_with_charts = 10;

/// Which of these outputs a program in second charts can give as they are meant: all but momenta and accelerations of
/// exchanged angles and what only the own charts conserve. `own`, `second`: of the equations in these charts;
/// `exchanged`: coordinates of the model.
std::vector<std::uint32_t> shared_outputs(const std::vector<std::string>& outputs,
                                          const std::vector<system::Output>& own,
                                          const std::vector<system::Output>& second,
                                          const std::vector<std::uint32_t>& exchanged);

/// Puts the functions of the exchange into `program`; `dag`: that of the changes.
void add_charts(Program& program, const symbolic::Dag& dag, const std::vector<system::ChartChange>& changes);

/// Puts one in second charts beside it, which was asked for the outputs at `places` only. Throws Error where the two do
/// not go together.
void add_second(Program& program, Program second, unsigned charts, const std::vector<std::uint32_t>& places);

}  // namespace eomgen::program

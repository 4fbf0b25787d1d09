// SPDX-License-Identifier: GPL-3.0-or-later
// In: charts that can be switched. Out: the formulas of the switch, on a Dag.
#pragma once

#include "model/charts.hpp"
#include "system/chart_change.hpp"

namespace eomgen::derive {

/// Expresses the attitude or the direction in the one chart and extracts the coordinates of the other. Rates are
/// converted through the angular velocity or the velocity of the direction.
system::ChartChange chart_change(symbolic::Dag& dag, const model::Model& model, const model::ChartPair& chart);

}  // namespace eomgen::derive

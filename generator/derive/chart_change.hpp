// SPDX-License-Identifier: GPL-3.0-or-later
// In: charts that can be exchanged. Out: the formulas of the exchange, on a Dag.
#pragma once

#include "model/charts.hpp"
#include "system/chart_change.hpp"

namespace eomgen::derive {

/// The attitude or the direction is written down in the one chart and read off in the other; rates by way of the
/// angular velocity or the velocity of the direction, which both share.
system::ChartChange chart_change(symbolic::Dag& dag, const model::Model& model, const model::SwitchedChart& chart);

}  // namespace eomgen::derive

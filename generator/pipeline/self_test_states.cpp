// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/self_test_states.hpp"

#include <algorithm>
#include <cmath>
#include <eom/modes/mode_array.hpp>
#include <optional>

#include "emit/self_test.hpp"
#include "program/internal_functions.hpp"

namespace eomgen::pipeline {
namespace {

/// The k-th state for the self test: the start, then nearby states with other parameters and inputs. All values differ,
/// so that neither vanishing nor interchanged terms go undetected. If a value is undefined, states closer to the start
/// are used.
std::optional<emit::TestVector> test_vector(const program::Program& program, const emit::EmissionContext& context,
                                            int k, const std::vector<int>& mode, std::size_t index) {
  for (const double share : {1.0, 0.125, 0x1p-6, 0x1p-10}) {
    emit::TestVector at;
    at.t = context.start_time + 0.125 * k * share;
    at.mode = mode;
    const double step = k * share;
    for (std::size_t i = 0; i < context.start.size(); ++i) {
      // Dyadic offsets: exact in binary64, different for every component.
      at.x.push_back(context.start[i] + step * (static_cast<double>((5 * i + 3) % 16) - 7.5) / 64);
    }
    const std::size_t count = context.parameters.size();
    for (std::size_t i = 0; i < count; ++i) {
      const double value = context.parameters[i].value;
      const std::size_t rank = k % 2 == 1 ? i + 1 : count - i;
      const double more = step * static_cast<double>(rank) / (8 * static_cast<double>(count) + 8);
      at.p.push_back(value == 0 ? more : value * (1 + more));
    }
    for (std::size_t i = 0; i < context.inputs.size(); ++i)
      at.u.push_back(context.inputs[i].value + step * (0.25 + 0.0625 * static_cast<double>(i)));
    // Dyadic numbers, none of them 0 and all different.
    for (std::size_t i = 0; i < program::vector_size(program); ++i)
      at.v.push_back((i % 2 == 0 ? 1.0 : -1.0) *
                     (0.25 + static_cast<double>((7 * i + 5 * static_cast<std::size_t>(k)) % 64) / 64));
    if (auto vector = emit::test_vector(program, context, std::move(at), index)) return vector;
    if (k == 0) break;
  }
  return std::nullopt;
}

/// Whether a state of second charts is far enough from their singularities, where rounding errors dominate.
bool far_from_failing(const program::Program& program, unsigned in_charts, const std::vector<double>& x) {
  constexpr double far = 0.3;
  bool result = true;
  for (std::size_t j = 0; j < program.charts.size(); ++j) {
    const program::ChartInfo& chart = program.charts[j];
    const double angle = x[chart.guarded];
    if ((in_charts >> j & 1u) != 0)
      result = result && std::abs(chart.second_at_sine ? std::sin(angle) : std::cos(angle)) > far;
  }
  return result;
}

}  // namespace

std::vector<emit::TestVector> test_vectors(const program::Program& program, const emit::EmissionContext& context) {
  constexpr std::size_t most_modes = 12;
  std::vector<emit::TestVector> result;
  const auto add = [&](int k, const std::vector<int>& mode) {
    if (auto vector = test_vector(program, context, k, mode, result.size())) result.push_back(std::move(*vector));
  };
  for (const int k : {0, 1, 2}) add(k, {});
  const std::vector<eom::ContactShape> shapes(program.contacts.begin(), program.contacts.end());
  for (const std::vector<int>& states : eom::contact_modes(shapes, most_modes)) {
    if (std::all_of(states.begin(), states.end(), [](int state) { return state == 0; })) continue;
    std::vector<int> mode = states;
    mode.resize(program.mode_layout().size());
    add(1, mode);
  }
  if (!program.kinks.empty()) {
    for (const int side : {1, -1}) {  // every kink on one side
      eom::ModeArray mode(program.mode_layout());
      for (std::size_t k = 0; k < program.kinks.size(); ++k) mode.set_kink(k, side);
      add(side > 0 ? 1 : 2, mode.entries());
    }
  }
  for (const program::Program& other : program.chart_variants) {
    std::size_t count = 0;
    eom::ModeArray mode(program.mode_layout());
    mode.set_charts(other.in_charts);
    for (int k = 1; k < 9 && count < 2; ++k) {
      std::optional<emit::TestVector> vector = test_vector(program, context, k, mode.entries(), result.size());
      if (!vector || !far_from_failing(program, other.in_charts, vector->x)) continue;
      result.push_back(std::move(*vector));
      ++count;
    }
  }
  return result;
}

}  // namespace eomgen::pipeline

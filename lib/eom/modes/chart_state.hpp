// SPDX-License-Identifier: MIT
// The argument `mode` of the C ABI: one bit per exchangeable chart, from bit 28 on (docs/abi.md, "Charts"). A set bit:
// the state is in the second chart.
#pragma once

#include <cstddef>

namespace eom {

inline constexpr int first_chart_bit = 28;
inline constexpr std::size_t max_charts = 3;  // exchangeable ones: bit 31 is the sign
inline constexpr int chart_bits = 7 << first_chart_bit;

constexpr int charts_of(int mode) { return mode >> first_chart_bit & 7; }
constexpr int mode_of_charts(unsigned charts) { return static_cast<int>(charts & 7u) << first_chart_bit; }

}  // namespace eom

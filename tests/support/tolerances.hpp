// The tolerances of the tests, each with a name and a reason. Comparisons are two-sided.
#pragma once

#include <limits>

namespace tolerances {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

// --- lib: integrators -----------------------------------------------------------------------------------------------
// A measured order is a slope between two step sizes; higher-order terms of the error change it by about h.
inline constexpr double measured_order = 0.2;
// Order conditions: sums of up to 16^2 products of binary64 coefficients up to 45 in size (dense output: up to 530).
inline constexpr double order_condition = 1e-13;
inline constexpr double dense_order_condition = 1e-11;
// The same for Rosenbrock methods, published with 16 digits: coefficients up to 150, inverted and multiplied once more.
inline constexpr double rosenbrock_condition = 1e-12;
// Weights sum to 1 up to half a unit in the last place. This is a relative error of each step that no step size
// reduces.
inline constexpr double weight_sum = epsilon / 2;
// The end state of a run at rtol 1e-12 over a few periods: errors of some 1000 steps add up.
inline constexpr double closed_form = 1e-8;
// Two computations of one number that differ only by a few rounding errors.
inline constexpr double rounding = 64 * epsilon;
// A useful error estimate is within this factor of the true error, in both directions.
inline constexpr double estimate_factor = 10;

// --- lib: events and modes ------------------------------------------------------------------------------------------
// Runs at rtol 1e-12 over some periods (rk4 with steps of 2e-3: also 1e-12); the requirement is 1e-10.
inline constexpr double event_time = 1e-10;
inline constexpr double event_state = 1e-10;
// A root whose slope is 1e-3 of the function's size: the same divided by the slope.
inline constexpr double grazing_time = 1e-7;

// --- lib: projection ------------------------------------------------------------------------------------------------
// A projected state meets its constraints up to the rounding of their terms.
inline constexpr double on_constraint = 1e-13;
// A correction against a reference solution of the KKT system: condition numbers up to 1e3.
inline constexpr double same_correction = 1e-11;

// --- program --------------------------------------------------------------------------------------------------------
// 60 digits, some hundred operations with condition numbers up to 1e10.
inline constexpr double same_value = 1e-45;
// A central difference in 60 digits with a step of 1e-15: the error is the step squared times third derivatives.
inline constexpr double difference_quotient = 1e-20;
// A solve in binary64 against another, condition numbers up to 1e4.
inline constexpr double unrolled_solve = 1e-11;
// The packed sines and cosines: half a unit for the last rounding, the rest for errors of the angle and the
// polynomials.
inline constexpr double packed_sincos_ulps = 1;
// Optimisation without derivation: half a second on one core; a shared machine may take several times as long.
inline constexpr double chain_seconds = 10;

}  // namespace tolerances

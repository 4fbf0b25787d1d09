// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/self_test.hpp"

#include <algorithm>
#include <cmath>
#include <eom/modes/mode_array.hpp>
#include <limits>

namespace eomgen::pipeline {
namespace {

// Of arrays before a call, so that an entry that is never written differs from its expected value.
constexpr double unset = std::numeric_limits<double>::quiet_NaN();

/// Whether a function has its values at a test vector. `inputs`: null if they are left out.
bool satisfies(const abi::CompiledFunctions& functions, const program::Program& program, const emit::TestVector& at,
               const emit::FunctionValues& expected, const double* inputs) {
  if (!functions.has(expected.function)) return false;
  abi::CallArguments given;
  given.t = at.t;
  given.x = at.x.data();
  given.p = at.p.data();
  given.u = inputs;
  given.v = at.v.data();
  std::vector<int> mode = at.mode;
  mode.resize(program.mode_layout().size());
  eom::ModeArray to(program.mode_layout());
  to.set_charts(expected.to);
  given.mode = mode.data();
  given.to = to.data();
  // Code in second charts leaves entries of the own charts as they are.
  const double before = program.charts.empty() ? unset : 0;
  std::vector<double> w(program.prepared_count() + 1, before);
  given.w = w.data();
  if (abi::find(expected.function)->has_input(abi::Input::prepared) && functions.prepare(at.p.data(), w.data()) != 0)
    return false;
  if (expected.function == "taylor")
    given.order = static_cast<int>(expected.values.at(0).size() / program.state_count()) - 1;
  std::vector<std::vector<double>> arrays;
  for (std::size_t r = 0; r < expected.values.size(); ++r) {
    arrays.emplace_back(std::max<std::size_t>(1, expected.values[r].size()), before);
    given.results.at(r) = arrays[r].data();
  }
  if (functions.call(expected.function, given) != 0) return false;
  for (std::size_t r = 0; r < expected.values.size(); ++r) {
    for (std::size_t i = 0; i < expected.values[r].size(); ++i) {
      if (!(std::fabs(arrays[r][i] - expected.values[r][i]) <= expected.tolerances[r])) return false;
    }
  }
  return true;
}

}  // namespace

std::optional<std::size_t> failed_test_vector(const abi::CompiledFunctions& functions, const program::Program& program,
                                              const emit::EmissionContext& context) {
  for (std::size_t k = 0; k < context.tests.size(); ++k) {
    const emit::TestVector& at = context.tests[k];
    // At the start inputs have their defaults.
    const bool at_defaults = std::equal(at.u.begin(), at.u.end(), context.inputs.begin(), context.inputs.end(),
                                        [](double u, const emit::Quantity& input) { return u == input.value; });
    for (const emit::FunctionValues& expected : at.functions) {
      const double* const inputs = at_defaults ? nullptr : at.u.data();
      if (!satisfies(functions, program, at, expected, inputs)) return k;
    }
  }
  return std::nullopt;
}

}  // namespace eomgen::pipeline

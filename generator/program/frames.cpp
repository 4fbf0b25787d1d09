// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/frames.hpp"

namespace eomgen::program {

FunctionExpressions frame_function(Dag& dag, const std::vector<system::Frame>& frames,
                                   const std::vector<std::uint32_t>& free,
                                   const std::map<std::uint32_t, symbolic::Rational>& fix) {
  FunctionExpressions function = empty_function("frames");
  std::map<symbolic::Symbol, Ref> values;
  for (const auto& [index, value] : fix) values[{symbolic::SymbolKind::parameter, index, 0}] = dag.constant(value);
  symbolic::Substitution fixed(dag, std::move(values));
  const auto append = [&](std::size_t result, const auto& entries) {
    for (const Ref r : entries) function.results[result].entries.push_back(fixed(r));
  };
  std::vector<symbolic::Derivation> by_rate;
  for (const std::uint32_t i : free)
    by_rate.push_back(symbolic::partial_derivative(dag, {symbolic::SymbolKind::coordinate, i, 1}));
  for (const system::Frame& frame : frames) {
    append(0, frame.position);
    append(0, frame.rotation);
    for (symbolic::Derivation& slope : by_rate) {
      std::array<Ref, 6> column;
      for (std::size_t c = 0; c < 6; ++c) column[c] = slope(frame.velocity[c]);
      append(1, column);
    }
    append(2, frame.bias);
  }
  return function;
}

}  // namespace eomgen::program

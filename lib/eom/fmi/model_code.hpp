// SPDX-License-Identifier: MIT
// The model of an FMU as data: compiled functions, the default scene, the variables. The emitted NAME_fmu.cpp defines
// it; the sources of FMI 2.0 and 3.0, which are the same for every model, read it.
//
// Value references number the variables from 0 in this order: time; the state x (coordinates, rates, states of first
// order, discrete values); the derivatives of its continuous part; inputs; parameters; outputs that are no states;
// event indicators.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "eom/hybrid/code.hpp"
#include "eom/hybrid/problem.hpp"

namespace eom::fmi {

struct ModelCode {
  hybrid::Code code;
  hybrid::Problem (*problem)(const hybrid::Code& code) = nullptr;
  /// NAME_set_start of NAME_run.hpp.
  int (*set_start)(hybrid::Problem& problem, const int* given, const double* t, const double* x,
                   const double* p) = nullptr;
  int (*selftest)() = nullptr;
  const char* token = "";              // instantiation token (FMI 3), guid (FMI 2)
  std::vector<double> nominals;        // of the continuous states
  std::vector<double> inputs;          // default values
  std::vector<bool> calculated;        // per parameter: computed from others or from the start
  std::vector<bool> from_start;        // per parameter: computed from the start
  std::vector<std::uint32_t> outputs;  // indices in y
  std::size_t event_indicators = 0;
};

/// Defined by the emitted file.
const ModelCode& model_code();

/// The place of a variable.
struct Variable {
  enum class Kind : std::uint8_t { none, time, state, derivative, input, parameter, output, indicator };
  Kind kind = Kind::none;
  std::size_t index = 0;
};

inline Variable variable(const ModelCode& model, std::size_t reference) {
  using Kind = Variable::Kind;
  const StateLayout layout = model.code.layout();
  const std::size_t continuous = layout.discrete_begin();
  struct Block {
    Kind kind;
    std::size_t size;
  };
  for (const Block& block :
       {Block{Kind::time, 1}, Block{Kind::state, layout.size()}, Block{Kind::derivative, continuous},
        Block{Kind::input, model.inputs.size()}, Block{Kind::parameter, model.calculated.size()},
        Block{Kind::output, model.outputs.size()}, Block{Kind::indicator, model.event_indicators}}) {
    if (reference < block.size) return {block.kind, reference};
    reference -= block.size;
  }
  return {};
}

}  // namespace eom::fmi

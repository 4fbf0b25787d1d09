// SPDX-License-Identifier: GPL-3.0-or-later
#include "jit/lanes.hpp"

#include <algorithm>

#include "jit/assign.hpp"

namespace eomgen::jit {

LaneCode::LaneCode(const program::Program& program, const program::Function& function,
                   std::span<const double> default_inputs) {
  Constants constants;
  const FunctionSteps steps = assign_registers(function, default_inputs, program.free.size(), constants);
  for (const double value : constants.values()) constants_.insert(constants_.end(), lane_width, value);
  memory_ = encode_lanes(steps, constants_.data());
  // Four calls in a row cost some 2 ns more than one in each function, what 64 operations save.
  constexpr std::size_t least_steps = 64;
  const auto calls = static_cast<std::size_t>(std::count_if(
      steps.steps.begin(), steps.steps.end(), [](const Step& step) { return step.action == Action::call; }));
  is_faster_ = steps.steps.size() >= least_steps * calls;
  function_ = reinterpret_cast<LaneFunction>(const_cast<void*>(memory_->at(0)));
}

}  // namespace eomgen::jit

// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/estimate_cost.hpp"

#include <fmt/format.h>

#include "error.hpp"
#include "model/names.hpp"

namespace eomgen::pipeline {

std::vector<std::string> estimate_cost_names() { return {"bounded", "full"}; }

eom::EstimateCost parse_estimate_cost(const std::string& text, bool without) {
  const std::vector<std::string> names = estimate_cost_names();
  if (text == names[0]) return eom::EstimateCost::bounded;
  if (text != names[1])
    throw Error("cli", {}, fmt::format("there is no estimate {}", model::quote(text)),
                model::suggest_choice(text, names));
  if (without)
    throw Error("cli", {}, "the estimate 'full' asks for an error estimate, and another option leaves it out",
                "leave 'full' out, or the option without estimates");
  return eom::EstimateCost::full;
}

}  // namespace eomgen::pipeline

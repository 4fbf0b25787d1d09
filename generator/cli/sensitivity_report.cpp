// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sensitivity_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "cli/output.hpp"

namespace eomgen::cli {

std::string text_of(const run::Sensitivities& found, const std::vector<std::string>& states) {
  std::string out = fmt::format("\nsensitivities     of the state at t = {}, by {}: {}\n", found.t, found.solver,
                                eom::name(found.outcome));
  for (const run::Sensitivity& s : found.list) {
    const auto line = [&](const std::string& state, double value, double error) {
      out += fmt::format("  d {} / d {:<16} {:>24}{}\n", state, s.of, unsigned_zero(value),
                         s.error.empty() ? "" : fmt::format("   +- {:.1e}", error));
    };
    for (std::size_t i = 0; i < states.size(); ++i) line(states[i], s.value[i], s.error.empty() ? 0 : s.error[i]);
    if (s.of_time != 0) line("t", s.of_time, s.error_of_time);
  }
  return found.estimate_note.empty() ? out : out + "  " + found.estimate_note + "\n";
}

Json json_of(const run::Sensitivities& found, const std::vector<std::string>& states) {
  Json values = Json::object(), errors = Json::object();
  bool estimated = false;
  for (const run::Sensitivity& s : found.list) {
    for (std::size_t i = 0; i < states.size(); ++i) {
      values[s.of][states[i]] = finite_or_null(s.value[i]);
      if (!s.error.empty()) errors[s.of][states[i]] = finite_or_null(s.error[i]), estimated = true;
    }
    if (s.of_time == 0) continue;
    values[s.of]["t"] = finite_or_null(s.of_time);
    if (!s.error.empty()) errors[s.of]["t"] = finite_or_null(s.error_of_time);
  }
  return {{"method", found.solver},
          {"t", found.t},
          {"outcome", eom::name(found.outcome)},
          {"values", values},
          {"error_estimate", estimated ? errors : Json(nullptr)},
          {"rhs_evaluations", found.statistics.rhs_evaluations}};
}

}  // namespace eomgen::cli

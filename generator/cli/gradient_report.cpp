// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/gradient_report.hpp"

#include <fmt/format.h>

#include "cli/output.hpp"

namespace eomgen::cli {

std::string text_of(const run::Gradients& found) {
  std::string out = fmt::format("\ngradients         at t = {}, by the adjoint equations with {}: {}\n", found.t,
                                found.solver, eom::name(found.outcome));
  for (const run::Gradient& gradient : found.list) {
    for (std::size_t d = 0; d < found.directions.size(); ++d)
      out +=
          fmt::format("  d {} / d {:<16} {:>24}{}\n", gradient.of, found.directions[d], unsigned_zero(gradient.by[d]),
                      gradient.error.empty() ? "" : fmt::format("   +- {:.1e}", gradient.error[d]));
  }
  return found.estimate_note.empty() ? out : out + "  " + found.estimate_note + "\n";
}

Json json_of(const run::Gradients& found) {
  Json outputs = Json::object(), values = Json::object(), errors = Json::object();
  bool estimated = false;
  for (const run::Gradient& gradient : found.list) {
    outputs[gradient.of] = finite_or_null(gradient.value);
    values[gradient.of] = Json::object();
    for (std::size_t d = 0; d < found.directions.size(); ++d) {
      values[gradient.of][found.directions[d]] = finite_or_null(gradient.by[d]);
      if (!gradient.error.empty())
        errors[gradient.of][found.directions[d]] = finite_or_null(gradient.error[d]), estimated = true;
    }
  }
  return {{"method", found.solver},
          {"t", found.t},
          {"outcome", eom::name(found.outcome)},
          {"outputs", outputs},
          {"values", values},
          {"error_estimate", estimated ? errors : Json(nullptr)},
          {"rhs_evaluations", found.statistics.rhs_evaluations},
          {"adjoint_evaluations", found.adjoint_evaluations},
          {"seconds", found.seconds}};
}

}  // namespace eomgen::cli

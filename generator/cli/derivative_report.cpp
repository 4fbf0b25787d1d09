// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/derivative_report.hpp"

#include <fmt/format.h>

#include "cli/output.hpp"

namespace eomgen::cli {
namespace {

/// "d x / d m  0.5   +- 1e-12": with `error` if `errors` were estimated.
std::string derivative_line(const std::string& of, const std::string& by, double value,
                            const std::vector<double>& errors, double error) {
  return fmt::format("  d {} / d {:<16} {:>24}{}\n", of, by, unsigned_zero(value),
                     errors.empty() ? "" : fmt::format("   +- {:.1e}", error));
}

std::string note_line(const std::string& note) { return note.empty() ? "" : "  " + note + "\n"; }

/// {name: value}, appended to an object.
void add_values(Json& to, const std::vector<std::string>& names, const std::vector<double>& values) {
  for (std::size_t i = 0; i < names.size(); ++i) to[names[i]] = finite_or_null(values[i]);
}

}  // namespace

std::string text_of(const run::Sensitivities& found, const std::vector<std::string>& states) {
  std::string out = fmt::format("\nsensitivities     of the state at t = {}, by {}: {}\n", found.t, found.solver,
                                eom::name(found.outcome));
  for (const run::Sensitivity& s : found.list) {
    for (std::size_t i = 0; i < states.size(); ++i)
      out += derivative_line(states[i], s.of, s.value[i], s.error, s.error.empty() ? 0 : s.error[i]);
    if (s.of_time != 0) out += derivative_line("t", s.of, s.of_time, s.error, s.error_of_time);
  }
  return out + note_line(found.estimate_note);
}

Json json_of(const run::Sensitivities& found, const std::vector<std::string>& states) {
  Json values = Json::object(), errors = Json::object();
  for (const run::Sensitivity& s : found.list) {
    add_values(values[s.of], states, s.value);
    if (s.of_time != 0) values[s.of]["t"] = finite_or_null(s.of_time);
    if (s.error.empty()) continue;
    add_values(errors[s.of], states, s.error);
    if (s.of_time != 0) errors[s.of]["t"] = finite_or_null(s.error_of_time);
  }
  return {{"method", found.solver},
          {"t", found.t},
          {"outcome", eom::name(found.outcome)},
          {"values", values},
          {"error_estimate", errors.empty() ? Json(nullptr) : errors},
          {"rhs_evaluations", found.statistics.rhs_evaluations}};
}

std::string text_of(const run::Gradients& found) {
  std::string out = fmt::format("\ngradients         at t = {}, by the adjoint equations with {}: {}\n", found.t,
                                found.solver, eom::name(found.outcome));
  for (const run::Gradient& g : found.list) {
    for (std::size_t d = 0; d < found.directions.size(); ++d)
      out += derivative_line(g.of, found.directions[d], g.by[d], g.error, g.error.empty() ? 0 : g.error[d]);
  }
  return out + note_line(found.estimate_note);
}

Json json_of(const run::Gradients& found) {
  Json outputs = Json::object(), values = Json::object(), errors = Json::object();
  for (const run::Gradient& g : found.list) {
    outputs[g.of] = finite_or_null(g.value);
    values[g.of] = Json::object();
    add_values(values[g.of], found.directions, g.by);
    if (!g.error.empty()) add_values(errors[g.of], found.directions, g.error);
  }
  return {{"method", found.solver},
          {"t", found.t},
          {"outcome", eom::name(found.outcome)},
          {"outputs", outputs},
          {"values", values},
          {"error_estimate", errors.empty() ? Json(nullptr) : errors},
          {"rhs_evaluations", found.statistics.rhs_evaluations},
          {"adjoint_evaluations", found.adjoint_evaluations},
          {"seconds", found.seconds}};
}

}  // namespace eomgen::cli

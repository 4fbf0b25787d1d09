// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/report/recorded_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/output/decimal.hpp>
#include <eom/output/svg_plot.hpp>

#include "cli/report/page_json.hpp"

namespace eomgen::cli {
namespace {

constexpr double least_seconds = 4, most_seconds = 20;  // duration of an animation, for any time span of the run
constexpr int digits_of_states = 10, digits_of_screens = 6;

// Rounds to the digits needed, to save bytes.
double shortened(double x, int digits) {
  double result = 0;
  const std::string text = std::isfinite(x) ? fmt::format("{:.{}g}", x, digits) : "0";
  eom::decimals::read_decimal(text, result);
  return result;
}

}  // namespace

void RecordedMotion::row(double t, std::span<const double> values) {
  t_.push_back(t);
  rows_.emplace_back(values.begin(), values.end());
}

void RecordedMotion::drop_every_second_row() {
  std::size_t kept = 0;
  for (std::size_t k = 0; k < t_.size(); ++k) {
    if (k % 2 == 1 && k + 1 < t_.size()) continue;
    t_[kept] = t_[k];
    std::swap(rows_[kept], rows_[k]);
    ++kept;
  }
  t_.resize(kept);
  rows_.resize(kept);
}

std::vector<double> RecordedMotion::column(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  std::vector<double> result;
  if (found == names_.end()) return result;
  const auto index = static_cast<std::size_t>(found - names_.begin());
  for (const std::vector<double>& row : rows_) result.push_back(row[index]);
  return result;
}

std::string RecordedMotion::plots(const std::vector<Panel>& panels) const {
  std::string result;
  for (const Panel& panel : panels) {
    eom::Plot plot;
    plot.x_label = "t in s";
    plot.y_label = panel.title;
    plot.height = 320;
    for (const std::string& name : panel.names) plot.series.push_back({name, t_, column(name)});
    result += "<figure>" + eom::svg(plot) + "</figure>\n";
  }
  return result;
}

Json RecordedMotion::rows(const std::vector<std::string>& names, int digits) const {
  std::vector<std::vector<double>> columns;
  for (const std::string& name : names) columns.push_back(column(name));
  Json result = Json::array();
  for (std::size_t k = 0; k < t_.size(); ++k) {
    Json row = Json::array();
    for (const std::vector<double>& values : columns) row.push_back(values.empty() ? 0 : shortened(values[k], digits));
    result.push_back(std::move(row));
  }
  return result;
}

Json RecordedMotion::json(const pipeline::Simulation& simulation, const analysis::Drawing& drawing,
                          const analysis::DrawnForces& forces, const analysis::LiveModel& live,
                          const std::vector<std::string>& outputs, const std::vector<Panel>& panels) const {
  if (t_.size() < 2) return nullptr;
  const model::Model& model = simulation.derived->model;
  const std::vector<std::string> states = pipeline::state_names(*simulation.derived);
  Json times = Json::array(), curves = Json::array(), events = Json::array(), sizes = Json::array();
  for (const double t : t_) times.push_back(shortened(t, digits_of_states));
  for (const Panel& panel : panels) {
    Json of = Json::array();
    for (const std::string& name : panel.names) {
      const auto state = std::find(states.begin(), states.end(), name);
      const bool is_state = !live.script.empty() && state != states.end();
      const auto place =
          is_state ? state - states.begin() : std::find(outputs.begin(), outputs.end(), name) - outputs.begin();
      of.push_back({{"name", name}, {"state", is_state}, {"at", place}});
    }
    curves.push_back({{"title", panel.title}, {"of", of}});
  }
  for (const run::RunEvent& event : simulation.result.events) events.push_back({{"t", event.t}, {"name", event.name}});
  const symbolic::Dag& dag = *simulation.derived->mechanics.dag;
  for (const double size : analysis::sizes_of(drawing, dag, simulation.scene.parameters))
    sizes.push_back(shortened(size, digits_of_states));
  const double span = t_.back() - t_.front();
  const auto down = analysis::gravity_direction(simulation.derived->mechanics, simulation.scene.parameters);
  const bool is_live = !live.script.empty();
  Json parts = to_json(drawing.parts(), model, simulation.scene);
  add_forces(parts, forces);
  return {{"t", times},
          {"x", is_live ? rows(states, digits_of_states) : Json(nullptr)},
          {"y", is_live && !live.has_contacts() ? Json(nullptr) : rows(outputs, digits_of_screens)},
          {"t0", simulation.scene.t0},
          {"t1", simulation.scene.t1},
          {"speed", span / std::clamp(span, least_seconds, most_seconds)},
          {"down", down ? Json(*down) : Json(nullptr)},
          {"parts", parts},
          {"p", simulation.scene.parameters},
          {"sizes", sizes},
          {"panels", curves},
          {"events", events},
          {"live", is_live ? to_json(live.start) : Json(nullptr)},
          {"reason", live.reason},
          {"model", model.id}};
}

}  // namespace eomgen::cli

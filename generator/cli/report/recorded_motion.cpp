// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/report/recorded_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <eom/output/svg_plot.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace eomgen::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr double least_seconds = 4, most_seconds = 20;  // of an animation, whatever the time span of the run

bool is_shown(const model::Model& model, std::uint32_t place) { return place > 0 && place < model.places.size(); }

std::string position(const model::Place& place, int axis) { return place.name + ".position" + std::to_string(axis); }

// Six digits are more than a screen has; fewer bytes.
double shortened(double x) { return std::isfinite(x) ? std::strtod(fmt::format("{:.6g}", x).c_str(), nullptr) : 0; }

bool has_mass(const model::Model& model, std::uint32_t place) {
  const auto at = [=](const auto& heavy) { return heavy.place == place; };
  return std::any_of(model.particles.begin(), model.particles.end(), at) || std::any_of(model.bodies.begin(), model.bodies.end(), at);
}

}  // namespace

std::vector<std::string> RecordedMotion::needed(const model::Model& model) {
  std::vector<std::string> result;
  for (std::uint32_t i = 1; i < model.places.size(); ++i) {
    for (int axis = 1; axis <= 3; ++axis) result.push_back(position(model.places[i], axis));
  }
  return result;
}

void RecordedMotion::row(double t, std::span<const double> values) {
  t_.push_back(t);
  rows_.emplace_back(values.begin(), values.end());
}

std::vector<double> RecordedMotion::column(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  std::vector<double> result;
  if (found == names_.end()) return result;
  const auto index = static_cast<std::size_t>(found - names_.begin());
  for (const std::vector<double>& row : rows_) result.push_back(row[index]);
  return result;
}

std::string RecordedMotion::plots(const model::Model& model) const {
  std::string result;
  const auto add = [&](const std::string& label, const std::vector<std::string>& names) {
    eom::Plot plot;
    plot.x_label = "t in s";
    plot.y_label = label;
    plot.height = 320;
    for (const std::string& name : names) plot.series.push_back({name, t_, column(name)});
    result += eom::svg(plot);
  };
  std::vector<std::string> units;
  for (const model::Coordinate& c : model.coordinates) {
    if (std::find(units.begin(), units.end(), c.unit.text) == units.end()) units.push_back(c.unit.text);
  }
  for (const std::string& unit : units) {
    std::vector<std::string> names;
    for (const model::Coordinate& c : model.coordinates) {
      if (c.unit.text == unit) names.push_back(c.name);
    }
    add(unit.empty() || unit == "1" ? "coordinates" : "coordinates in " + unit, names);
  }
  add("energies in J", {"energy", "kinetic", "potential"});
  return result;
}

std::string RecordedMotion::animation(const model::Model& model) const {
  if (model.places.size() < 2 || t_.size() < 2) return "";
  Json places = Json::array();
  bool flat = true;
  for (std::uint32_t i = 1; i < model.places.size(); ++i) {
    const model::Place& place = model.places[i];
    Json r = Json::array();
    std::array<std::vector<double>, 3> x;
    for (int axis = 1; axis <= 3; ++axis) x[static_cast<std::size_t>(axis - 1)] = column(position(place, axis));
    for (std::size_t k = 0; k < t_.size(); ++k) {
      r.push_back({shortened(x[0][k]), shortened(x[1][k]), shortened(x[2][k])});
      flat = flat && x[2][k] == 0;
    }
    // What a position is measured from, a rod or a thread as often as not; free coordinates of space are no line to the origin.
    const bool linked = place.chart && (place.from > 0 || place.chart->system != "cartesian") && is_shown(model, i);
    places.push_back({{"name", place.name}, {"heavy", has_mass(model, i)},
                      {"from", linked ? Json(static_cast<int>(place.from) - 1) : Json(nullptr)}, {"r", r}});
  }
  Json times = Json::array();
  for (const double t : t_) times.push_back(shortened(t));
  const double span = t_.back() - t_.front();
  return Json{{"t", times}, {"flat", flat}, {"speed", span / std::clamp(span, least_seconds, most_seconds)}, {"places", places}}.dump();
}

}  // namespace eomgen::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/panels.hpp"

#include <algorithm>

#include "error.hpp"

namespace eomgen::cli {
namespace {

bool is_plain(const std::string& unit) { return unit.empty() || unit == "1"; }

std::string per_second(const std::string& unit) {
  if (is_plain(unit)) return unit.empty() ? "" : "1/s";
  return unit.find('/') == std::string::npos ? unit + "/s" : "(" + unit + ")/s";
}

void add(std::vector<Panel>& panels, const std::string& title, const std::string& name) {
  const auto found = std::find_if(panels.begin(), panels.end(),
                                  [&](const Panel& panel) { return panel.title == title && panel.over.empty(); });
  if (found == panels.end())
    panels.push_back({title, {name}, {}});
  else
    found->names.push_back(name);
}

std::string titled(const std::string& what, const std::string& unit) {
  return is_plain(unit) ? what : what + " in " + unit;
}

// A single curve has no legend to be told by.
void name_single_curves(const model::Model& model, std::vector<Panel>& panels) {
  for (Panel& panel : panels) {
    if (panel.over.empty() && panel.names.size() == 1)
      panel.title = titled(panel.names[0], unit_of(model, panel.names[0]));
  }
}

}  // namespace

std::string unit_of(const model::Model& model, const std::string& name) {
  for (const model::Coordinate& c : model.coordinates) {
    if (c.name == name) return c.unit.text;
    if (c.name + "_dot" == name) return per_second(c.unit.text);
    if (c.name + "_ddot" == name)
      return is_plain(c.unit.text)                        ? (c.unit.text.empty() ? "" : "1/s^2")
             : c.unit.text.find('/') == std::string::npos ? c.unit.text + "/s^2"
                                                          : "(" + c.unit.text + ")/s^2";
  }
  for (const model::Definition& d : model.definitions) {
    if (d.name == name) return d.unit.text;
  }
  if (name == "energy" || name == "kinetic" || name == "potential") return "J";
  if (name == "power") return "W";
  if (name.find(".position") != std::string::npos) return "m";
  if (name.find(".velocity") != std::string::npos) return "m/s";
  if (name.find(".omega") != std::string::npos) return "rad/s";
  return "";
}

std::vector<Panel> coordinate_panels(const model::Model& model) {
  std::vector<Panel> result;
  for (const model::Coordinate& c : model.coordinates) add(result, titled("coordinates", c.unit.text), c.name);
  name_single_curves(model, result);
  return result;
}

std::vector<Panel> panels(const model::Model& model, const std::vector<std::string>& outputs) {
  std::vector<Panel> result = coordinate_panels(model);
  for (const std::string& name : outputs) {
    if (unit_of(model, name) != "J") add(result, titled("outputs", unit_of(model, name)), name);
  }
  name_single_curves(model, result);
  result.push_back({"energies in J", {"energy", "kinetic", "potential"}, {}});
  return result;
}

std::vector<Panel> chosen_panels(const model::Model& model, const std::vector<std::string>& wanted) {
  std::vector<Panel> result;
  for (const std::string& item : wanted) {
    const std::size_t comma = item.find(',');
    if (comma == std::string::npos) {
      const std::string unit = unit_of(model, item);
      add(result, is_plain(unit) ? "pure numbers, and what has no known unit" : "in " + unit, item);
      continue;
    }
    const std::string over = item.substr(0, comma), name = item.substr(comma + 1);
    if (over.empty() || name.empty() || name.find(',') != std::string::npos) {
      throw Error("run", {}, "--plot-of " + item + " is no phase plane",
                  "write one as x,x_dot: first what is along the horizontal axis");
    }
    result.push_back({titled(name, unit_of(model, name)), {name}, over});
  }
  name_single_curves(model, result);
  return result;
}

}  // namespace eomgen::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/panels.hpp"

#include <algorithm>

#include "error.hpp"

namespace eomgen::cli {
namespace {

bool is_plain(const std::string& unit) { return unit.empty() || unit == "1"; }

void add(std::vector<Panel>& panels, const std::string& title, const std::string& name) {
  const auto found = std::find_if(panels.begin(), panels.end(),
                                  [&](const Panel& panel) { return panel.title == title && panel.x_name.empty(); });
  if (found == panels.end())
    panels.push_back({title, {name}, {}});
  else
    found->names.push_back(name);
}

std::string titled(const std::string& what, const std::string& unit) {
  return is_plain(unit) ? what : what + " in " + unit;
}

// A panel with a single curve has no legend, so its title names the curve.
void name_single_curves(const std::vector<system::Output>& outputs, std::vector<Panel>& panels) {
  for (Panel& panel : panels) {
    if (panel.x_name.empty() && panel.names.size() == 1)
      panel.title = titled(panel.names[0], unit_of(outputs, panel.names[0]));
  }
}

}  // namespace

std::string unit_of(const std::vector<system::Output>& outputs, const std::string& name) {
  const system::Output* output = system::find(outputs, name);
  return output == nullptr ? "" : output->unit;
}

std::vector<Panel> coordinate_panels(const std::vector<system::Output>& outputs) {
  std::vector<Panel> result;
  for (const system::Output& output : outputs) {
    if (output.kind == system::OutputKind::coordinate) add(result, titled("coordinates", output.unit), output.name);
  }
  name_single_curves(outputs, result);
  return result;
}

std::vector<Panel> panels(const std::vector<system::Output>& outputs, const std::vector<std::string>& wanted) {
  using system::OutputKind;
  std::vector<Panel> result = coordinate_panels(outputs);
  for (const std::string& name : wanted) {
    const system::Output* output = system::find(outputs, name);
    const bool energy =
        output != nullptr && (output->kind == OutputKind::energy || output->kind == OutputKind::kinetic ||
                              output->kind == OutputKind::potential);
    if (!energy) add(result, titled("outputs", unit_of(outputs, name)), name);
  }
  name_single_curves(outputs, result);
  result.push_back({"energies in J", {"energy", "kinetic", "potential"}, {}});
  return result;
}

std::vector<Panel> chosen_panels(const std::vector<system::Output>& outputs, const std::vector<std::string>& wanted) {
  std::vector<Panel> result;
  for (const std::string& item : wanted) {
    const std::size_t comma = item.find(',');
    if (comma == std::string::npos) {
      const std::string unit = unit_of(outputs, item);
      add(result, is_plain(unit) ? "pure numbers, and what has no known unit" : "in " + unit, item);
      continue;
    }
    const std::string x_name = item.substr(0, comma), name = item.substr(comma + 1);
    if (x_name.empty() || name.empty() || name.find(',') != std::string::npos) {
      throw Error("run", {}, "--plot-of " + item + " is no phase plane",
                  "write one as x,x_dot: first what is along the horizontal axis");
    }
    result.push_back({titled(name, unit_of(outputs, name)), {name}, x_name});
  }
  name_single_curves(outputs, result);
  return result;
}

}  // namespace eomgen::cli

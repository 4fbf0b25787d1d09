// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "conservation/conserved.hpp"
#include "run/scene.hpp"

namespace eomgen::run {
namespace {

using mechanics::Mechanics;

// A component of a joint's reaction, or all of them, or the force of a constraint, that the motion does not determine.
void refuse_undetermined(const Mechanics& m, const model::Named& want) {
  for (const mechanics::Constraint& c : m.constraints) {
    const std::string label = "reaction." + c.label;
    const bool joint = std::any_of(m.model->joints.begin(), m.model->joints.end(),
                                   [&](const model::Joint& j) { return j.name == c.name; });
    if (c.determined || joint || (want.name != label && want.name != "reaction." + c.name)) continue;
    throw Error("scene", want.span.line > 0 ? m.model->where(want.span) : Where{},
                fmt::format("the motion does not determine '{}'", label),
                "other constraints hold the same, or nothing moves against it (`check` lists such constraints): ask "
                "for the force of another, or give the bodies coordinates that it binds");
  }
  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    const std::string name = "reaction." + m.model->joints[i].name;
    if (want.name != name && !want.name.starts_with(name + ".")) continue;
    std::string known;
    for (std::size_t j = 0; j < m.joints[i].determined.size(); ++j) {
      if (m.joints[i].determined[j]) known += fmt::format("{}{}.{}", known.empty() ? "" : ", ", name, j + 1);
    }
    if (want.name.size() != name.size() + 2 || want.name.back() < '1' || want.name.back() > '6') return;
    throw Error("scene", want.span.line > 0 ? m.model->where(want.span) : Where{},
                fmt::format("the motion does not determine '{}'", want.name),
                fmt::format("it is left open by equations of the joint that hold identically or repeat others (`check` "
                            "lists them): give the bodies coordinates "
                            "that this equation binds, or a joint that leaves the motion free{}",
                            known.empty() ? "" : "; determined are " + known));
  }
}

}  // namespace

std::vector<std::string> expand_outputs(const Mechanics& m, const system::EquationSystem& system,
                                        const std::vector<model::Named>& wanted) {
  std::set<std::string> coordinates;
  for (const model::Coordinate& c : m.model->coordinates) {
    coordinates.insert(c.name);
    coordinates.insert(c.name + "_dot");
  }
  std::vector<std::string> result;
  std::set<std::string> seen;
  const auto take = [&](const std::string& name) {
    if (!coordinates.contains(name) && seen.insert(name).second) result.push_back(name);
  };
  for (const model::Named& want : wanted) {
    bool found = coordinates.contains(want.name);
    for (const system::Output& output : system.outputs) {
      const bool part = output.name.starts_with(want.name + ".") && want.name.find('.') != std::string::npos;
      const bool table = !output.name.starts_with(conservation::differential_prefix) &&
                         !output.name.starts_with(conservation::magnitude_prefix) &&
                         !output.name.starts_with(system::contact_prefix) &&
                         !output.name.starts_with(system::watched_prefix);
      const bool of_all = want.name == "all" && table;
      if (!of_all && output.name != want.name && !part) continue;
      take(output.name);
      found = true;
    }
    if (!found) {
      refuse_undetermined(m, want);
      std::string names;
      for (const system::Output& output : system.outputs) {
        const bool hidden = output.name.starts_with(conservation::magnitude_prefix) ||
                            output.name.starts_with(system::contact_prefix) ||
                            output.name.starts_with(system::watched_prefix);
        if (!coordinates.contains(output.name) && !hidden) names += (names.empty() ? "" : ", ") + output.name;
      }
      const Where where = want.span.line > 0 ? m.model->where(want.span) : Where{};
      throw Error("scene", where, fmt::format("there is no output '{}'", want.name), "choose from: " + names + ", all");
    }
  }
  return result;
}

}  // namespace eomgen::run

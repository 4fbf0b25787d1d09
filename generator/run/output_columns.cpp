// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "run/requested_outputs.hpp"
#include "run/scene.hpp"

namespace eomgen::run {
namespace {

using mechanics::Mechanics;
using system::OutputKind;

// Rejects a component of a joint's reaction, all of them, or a constraint force that the motion does not determine.
void refuse_undetermined(const Mechanics& m, const model::OutputReference& want) {
  for (const mechanics::Constraint& c : m.constraints) {
    const std::string label = "reaction." + c.label;
    const bool joint = std::any_of(m.model->joints.begin(), m.model->joints.end(),
                                   [&](const model::Joint& j) { return j.name == c.name; });
    if (c.determined || joint || (want.name != label && want.name != "reaction." + c.name)) continue;
    throw Error(
        "scene", want.span.line > 0 ? m.model->where(want.span) : SourceLocation{},
        fmt::format("the motion does not determine '{}'", label),
        "other constraints impose the same condition, or it holds identically (`check` lists such constraints): "
        "request the force of another one, or give the bodies coordinates that it constrains");
  }
  for (std::size_t i = 0; i < m.joints.size(); ++i) {
    const std::string name = "reaction." + m.model->joints[i].name;
    if (want.name != name && !want.name.starts_with(name + ".")) continue;
    std::string known;
    for (std::size_t j = 0; j < m.joints[i].determined.size(); ++j) {
      if (m.joints[i].determined[j]) known += fmt::format("{}{}.{}", known.empty() ? "" : ", ", name, j + 1);
    }
    if (want.name.size() != name.size() + 2 || want.name.back() < '1' || want.name.back() > '6') return;
    throw Error("scene", want.span.line > 0 ? m.model->where(want.span) : SourceLocation{},
                fmt::format("the motion does not determine '{}'", want.name),
                fmt::format("it is left open by equations of the joint that hold identically or repeat others (`check` "
                            "lists them): give the bodies coordinates "
                            "that this equation binds, or a joint that leaves the motion free{}",
                            known.empty() ? "" : "; determined are " + known));
  }
}

}  // namespace

std::vector<std::string> expand_outputs(const Mechanics& m, const system::EquationSystem& system,
                                        const std::vector<model::OutputReference>& wanted) {
  // These are part of every table.
  const auto of_state = [](const system::Output& output) {
    return output.kind == OutputKind::coordinate || output.kind == OutputKind::rate || output.kind == OutputKind::state;
  };
  const auto for_reader = [](const system::Output& output) {
    return system::audience(output.kind) == system::Audience::reader;
  };
  std::vector<std::string> result;
  std::set<std::string> seen;
  for (const model::OutputReference& want : wanted) {
    bool found = false;
    for (const system::Output& output : system.outputs) {
      const bool of_all = want.name == "all" && for_reader(output);
      const bool part = !output.vector.empty() && output.vector == want.name;
      if (!of_all && output.name != want.name && !part) continue;
      found = true;
      if (!of_state(output) && seen.insert(output.name).second) result.push_back(output.name);
    }
    if (!found) {
      refuse_undetermined(m, want);
      std::string names;
      for (const system::Output& output : system.outputs) {
        if (!of_state(output) && for_reader(output)) names += (names.empty() ? "" : ", ") + output.name;
      }
      const SourceLocation where = want.span.line > 0 ? m.model->where(want.span) : SourceLocation{};
      throw Error("scene", where, fmt::format("there is no output '{}'", want.name), "choose from: " + names + ", all");
    }
  }
  return result;
}

std::vector<std::string> requested_outputs(const Mechanics& m, const system::EquationSystem& system,
                                           const std::vector<std::string>& names) {
  const std::vector<std::string> states = state_columns(*m.model);
  std::vector<std::string> result;
  for (const std::string& name : names) {
    const bool is_state = std::find(states.begin(), states.end(), name) != states.end();
    const std::vector<std::string> expanded =
        is_state ? std::vector<std::string>{name} : expand_outputs(m, system, {{name, {}}});
    for (const std::string& one : expanded) {
      if (std::find(result.begin(), result.end(), one) == result.end()) result.push_back(one);
    }
  }
  return result;
}

}  // namespace eomgen::run

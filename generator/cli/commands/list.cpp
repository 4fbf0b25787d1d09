// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "analysis/latex_document.hpp"
#include "cli/commands/commands.hpp"
#include "cli/output.hpp"
#include "coordinates/coordinate_system.hpp"
#include "couplings/coupling.hpp"
#include "derive/formulations.hpp"
#include "emit/targets.hpp"
#include "eom/ode.hpp"
#include "forces/kind.hpp"
#include "joints/joint.hpp"
#include "pipeline/archives.hpp"
#include "rotations/rotation.hpp"
#include "run/eligibility.hpp"

namespace eomgen::cli::list_command {
namespace {

Json registries() {
  Json result{{"format", 1}};
  Json coordinates = Json::array(), formulations = Json::array(), solvers = Json::array(), targets = Json::array();
  for (const coordinates::CoordinateSystem& system : coordinates::registry()) {
    Json slots = Json::array();
    for (const coordinates::Slot& slot : system.slots) slots.push_back(slot.name);
    coordinates.push_back(
        {{"name", system.name}, {"title", system.title}, {"slots", slots}, {"singular", system.singular}});
  }
  // Defined by the model itself, so not in that registry.
  coordinates.push_back({{"name", "custom"},
                         {"title", "coordinates that a model defines, by x(q) or by q(x)"},
                         {"slots", Json::array()},
                         {"singular", ""}});
  for (const derive::FormulationEntry& formulation : derive::formulations())
    formulations.push_back({{"name", formulation.name}, {"title", formulation.title}});
  for (const eom::MethodInfo& method : eom::methods()) {
    const auto requires_feature = [&](eom::Feature feature) { return method.needs.required.has(feature); };
    solvers.push_back({{"name", method.name},
                       {"order", method.order},
                       {"dense_order", method.dense_order},
                       {"adaptive", method.adaptive},
                       {"implicit", run::uses_jacobian(method)},
                       {"series", requires_feature(eom::Feature::series)},
                       {"variational", requires_feature(eom::Feature::momenta)},
                       {"constrained", requires_feature(eom::Feature::constraints)}});
  }
  for (const emit::TargetEntry& target : emit::targets())
    targets.push_back({{"name", target.name}, {"title", target.title}});
  for (const pipeline::Archive& archive : pipeline::archives())
    targets.push_back({{"name", archive.name}, {"title", archive.title}});
  // The document uses the display form instead of a program, so it is not in that registry.
  targets.push_back({{"name", analysis::latex_document_target},
                     {"title", "a LaTeX document: both approaches side by side, constraint forces"}});
  result["coordinates"] = coordinates;
  Json rotations = Json::array();
  for (const rotations::Rotation& rotation : rotations::registry()) {
    Json entries = Json::array();
    for (const rotations::Entry& entry : rotation.entries) entries.push_back(entry.name);
    rotations.push_back({{"name", rotation.name},
                         {"title", rotation.title},
                         {"family", rotation.family},
                         {"entries", entries},
                         {"singular", rotation.singular}});
  }
  result["rotations"] = rotations;
  result["joints"] = Json::array();
  for (const joints::Joint& joint : joints::registry()) {
    result["joints"].push_back({{"name", joint.name}, {"title", joint.title}, {"equations", joint.equations.size()}});
  }
  result["couplings"] = Json::array();
  for (const couplings::Coupling& coupling : couplings::registry())
    result["couplings"].push_back({{"name", coupling.name}, {"title", coupling.title}});
  result["forces"] = Json::array();
  for (const forces::Kind& kind : forces::registry()) {
    Json keys = Json::array();
    for (const forces::Key& key : kind.keys) keys.push_back(key.name);
    result["forces"].push_back({{"name", kind.name}, {"title", kind.title}, {"keys", keys}});
  }
  result["solvers"] = solvers;
  result["targets"] = targets;
  result["formulations"] = formulations;
  return result;
}

int execute(const CommonOptions& common) {
  const Json all = registries();
  if (common.json) {
    print_document(all);
    return 0;
  }
  for (const auto& [key, entries] : all.items()) {
    if (!entries.is_array()) continue;
    fmt::print("{}:\n", key);
    if (entries.empty()) fmt::print("  none yet\n");
    for (const Json& entry : entries) {
      const std::string title =
          entry.contains("title")
              ? entry["title"].get<std::string>()
              : fmt::format("order {}, {}{}", entry["order"].get<int>(),
                            entry["adaptive"].get<bool>() ? "chooses its steps" : "needs --step",
                            entry["implicit"].get<bool>() ? ", implicit" : "") +
                    (entry["constrained"].get<bool>() ? ", for models with constraints, which it keeps itself" : "");
      fmt::print("  {:<16} {}\n", entry["name"].get<std::string>(), title);
    }
  }
  return 0;
}

}  // namespace

Execute declare(Arguments&) { return execute; }

}  // namespace eomgen::cli::list_command

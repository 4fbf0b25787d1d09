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

constexpr auto entry = [](const auto& item) { return EOMGEN_MEMBERS(item, name, title); };

/// Names of the parts of an entry.
template <class List>
Json names(const List& list) {
  return list_of(list, [](const auto& part) -> Json { return part.name; });
}

Json coordinate_systems() {
  Json result = list_of(coordinates::registry(), [](const coordinates::CoordinateSystem& system) -> Json {
    return {
        {"name", system.name}, {"title", system.title}, {"slots", names(system.slots)}, {"singular", system.singular}};
  });
  // Defined by the model itself, so not in that registry.
  result.push_back({{"name", "custom"},
                    {"title", "coordinates that a model defines, by x(q) or by q(x)"},
                    {"slots", Json::array()},
                    {"singular", ""}});
  return result;
}

Json solver(const eom::MethodInfo& method) {
  const auto requires_feature = [&](eom::Feature feature) { return method.needs.required.has(feature); };
  Json result = EOMGEN_MEMBERS(method, name, order, dense_order, adaptive);
  result["implicit"] = run::uses_jacobian(method);
  result["series"] = requires_feature(eom::Feature::series);
  result["variational"] = requires_feature(eom::Feature::momenta);
  result["constrained"] = requires_feature(eom::Feature::constraints);
  return result;
}

Json targets() {
  Json result = list_of(emit::targets(), entry);
  for (const pipeline::Archive& archive : pipeline::archives()) result.push_back(entry(archive));
  // The document uses the display form instead of a program, so it is not in that registry.
  result.push_back({{"name", analysis::latex_document_target},
                    {"title", "a LaTeX document: both approaches side by side, constraint forces"}});
  return result;
}

Json registries() {
  const auto rotation = [](const rotations::Rotation& r) -> Json {
    return {{"name", r.name},
            {"title", r.title},
            {"family", r.family},
            {"entries", names(r.entries)},
            {"singular", r.singular}};
  };
  const auto joint = [](const joints::Joint& j) -> Json {
    return {{"name", j.name}, {"title", j.title}, {"equations", j.equations.size()}};
  };
  const auto force = [](const forces::Kind& kind) -> Json {
    return {{"name", kind.name}, {"title", kind.title}, {"keys", names(kind.keys)}};
  };
  return {{"format", 1},
          {"coordinates", coordinate_systems()},
          {"rotations", list_of(rotations::registry(), rotation)},
          {"joints", list_of(joints::registry(), joint)},
          {"couplings", list_of(couplings::registry(), entry)},
          {"forces", list_of(forces::registry(), force)},
          {"solvers", list_of(eom::methods(), solver)},
          {"targets", targets()},
          {"formulations", list_of(derive::formulations(), entry)}};
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

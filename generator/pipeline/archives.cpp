// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/archives.hpp"

#include "lists.hpp"
#include "pipeline/fmu_package.hpp"

namespace eomgen::pipeline {
namespace {

constexpr const char* of_fmu[] = {"run", "start", "jac", "jac_u"};
constexpr int versions_of_fmi[] = {3, 2};

constexpr Archive registry[] = {
    {"fmu", "Functional Mock-up Unit (FMI): model exchange and co-simulation, with sources and binary", of_fmu,
     versions_of_fmi, make_fmu},
};

}  // namespace

std::span<const Archive> archives() { return registry; }

const Archive* find_archive(const std::string& name) { return find_named(registry, name); }

std::vector<std::string> target_names() {
  std::vector<std::string> names = emit::target_names();
  for (const Archive& archive : registry) names.emplace_back(archive.name);
  return names;
}

}  // namespace eomgen::pipeline

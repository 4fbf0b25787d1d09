// SPDX-License-Identifier: GPL-3.0-or-later
// For any bytes the reader returns a model that satisfies its invariants, or throws one Error with a position.
#include <cstdint>
#include <cstdlib>
#include <string>

#include "model/model.hpp"

namespace {

using namespace eomgen::model;

void require(bool condition) {
  if (!condition) std::abort();
}

void check_promises(const Model& model) {
  for (std::size_t k = 0; k < model.arena.nodes.size(); ++k) {
    for (const NodeId child : model.arena.nodes[k].args) require(child == no_node || child < k);
  }
  require(!model.coordinates.empty());
  require(!model.scenes.empty() && model.scenes[0].name == "default");
  require(!model.places.empty() && model.places[0].name == "origin");
  for (const Place& place : model.places) require(model.arena[place.position].vector);
  for (const Particle& particle : model.particles) require(!model.arena[particle.mass].vector);
  for (const Constraint& constraint : model.constraints) {
    require(!constraint.psi.empty() && constraint.psi.size() <= 6);  // a joint may have six
    for (const NodeId psi : constraint.psi) require(!model.arena[psi].vector);
  }
  for (const auto& warning : model.warnings) require(!eomgen::format_warning(warning).empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    check_promises(read_model_text(std::string(reinterpret_cast<const char*>(data), size), "fuzz.toml"));
  } catch (const eomgen::Error& error) {
    require(!error.message().empty() && !error.remedy().empty() && error.exit_code() == 2);
    require(std::string(error.what()).starts_with("fuzz.toml:"));
  }
  return 0;
}

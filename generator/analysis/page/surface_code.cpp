// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/page/surface_code.hpp"

#include <numeric>

#include "emit/targets.hpp"
#include "program/from_dag.hpp"

namespace eomgen::analysis {

SurfaceCode surface_code(const pipeline::Simulation& simulation, const Drawing& drawing) {
  const std::vector<DrawnSurface>& surfaces = drawing.parts().surfaces;
  if (surfaces.empty()) return {};
  pipeline::DerivedModel& derived = *simulation.derived;
  const model::Model& model = derived.model;
  const symbolic::Dag& dag = *derived.mechanics.dag;
  program::Program program;
  program.formulation = simulation.program.formulation;
  program.approach = simulation.program.approach;
  program.free.resize(model.coordinates.size());
  std::iota(program.free.begin(), program.free.end(), 0u);
  for (std::uint32_t i = 0; i < model.states.size(); ++i) program.states.push_back(mechanics::state_symbol(model, i));
  for (std::size_t k = 0; k < surfaces.size(); ++k) {
    program::FunctionExpressions wanted;
    wanted.name = "surface_" + std::to_string(k + 1);
    std::vector<symbolic::Ref> entries = surfaces[k].psi;
    entries.insert(entries.end(), surfaces[k].position.begin(), surfaces[k].position.end());
    wanted.results = {{"surface", entries}};
    program.functions.push_back(
        program::schedule(program::flatten(program::from_dag(dag, wanted, program.free, program.states), false),
                          wanted.name, {{"surface", entries.size()}}));
  }
  emit::EmissionContext context =
      pipeline::emission_context(derived, simulation.program, simulation.scene, simulation.certificate);
  context.tests.clear();
  context.start.assign(program.state_count(), 0);
  context.id += "_surfaces";
  const emit::EmittedFile file = emit::emit(program, context, "javascript").front();
  return {file.text, file.name.substr(0, file.name.size() - 3)};
}

}  // namespace eomgen::analysis

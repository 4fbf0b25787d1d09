// SPDX-License-Identifier: GPL-3.0-or-later
// Tables that resolving a scene takes from the equations without its numbers: functions of time, functions that jump,
// the mass matrix. In: equations and a scene of the model. Out: tables, which are kept for further runs of the scene.
#pragma once

#include <eom/hybrid/problem.hpp>
#include <list>
#include <optional>
#include <vector>

#include "model/model.hpp"
#include "run/expression_tables.hpp"

namespace eomgen::run {

/// The tables of one scene.
struct SceneTable {
  eom::hybrid::TimeFunctions time;
  eom::hybrid::JumpFunctions jumps;
  /// M, then A. Variables: those of run_variables, then the parameters.
  eom::expressions::Code mass_and_rows;
};

/// The latest tables. A thread at a time may use them.
class SceneTables {
 public:
  /// The tables of these equations. inputs: their expressions in the scene; none: a table. is_scenes_own: no input is
  /// replaced, so that the tables hold for each run of the scene.
  const SceneTable& of(const system::EquationSystem& system, const model::Scene& scene,
                       const std::vector<std::optional<symbolic::Ref>>& inputs, bool is_scenes_own);

 private:
  static constexpr std::size_t most = 4;
  struct Entry {
    const model::Scene* scene;  // null: of no further run
    std::vector<symbolic::Ref> expressions;
    SceneTable table;
  };
  std::list<Entry> entries_;  // the latest first
};

}  // namespace eomgen::run

// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/derivative_systems.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace eomgen::program {

bool holds_branches(const Request& request) {
  return std::find(request.with.begin(), request.with.end(), "events") != request.with.end();
}

std::vector<std::unique_ptr<AbiFunctions>> with_residual(const std::vector<system::EquationSystem>& systems,
                                                         const Request& request) {
  std::vector<std::unique_ptr<AbiFunctions>> result;
  if (!request.residual || !systems.front().contacts.empty()) return result;
  const std::optional<system::Residual> residual = request.residual();
  if (!residual) return result;
  std::vector<std::pair<system::Approach, system::Form>> known;
  const auto add = [&](system::EquationSystem system, Ties ties) {
    result.push_back(std::make_unique<AbiFunctions>(std::move(system), request.fix, ties, holds_branches(request)));
  };
  for (const system::EquationSystem& system : systems) {
    const bool articulated = system.formulation == "articulated";
    if (system.formulation != "recursive" && !articulated) continue;
    system::EquationSystem copy = system;
    copy.residual = residual;
    if (articulated && system.solution && system.active.empty()) {
      add(copy, Ties::ascending);
      if (!residual->qddot.empty() && residual->qddot != system.solution->qddot) {
        copy.solution->qddot = residual->qddot;
        copy.solution->pivots = residual->pivots;
        add(copy, Ties::ascending);
      }
    }
    const std::pair<system::Approach, system::Form> form{system.approach, system.form};
    if (std::find(known.begin(), known.end(), form) != known.end()) continue;
    known.push_back(form);
    copy.solution.reset();
    for (auto* solved : {&copy.residual->qddot_by_q, &copy.residual->qddot_by_qdot, &copy.residual->M_inverse})
      solved->clear();
    copy.residual->slopes.reset();
    copy.residual->pivots.clear();
    if (!residual->M.empty()) copy.M = residual->M, copy.f = residual->f;
    add(copy, Ties::ascending);
    add(copy, Ties::descending);
  }
  return result;
}

std::unique_ptr<AbiFunctions> with_forces(const std::vector<system::EquationSystem>& systems, const Request& request) {
  if (!request.forces || !systems.front().contacts.empty()) return nullptr;
  const auto solved = std::find_if(systems.begin(), systems.end(), [](const system::EquationSystem& system) {
    return system.formulation == "articulated" && system.solution && system.active.empty();
  });
  if (solved == systems.end()) return nullptr;
  system::EquationSystem copy = *solved;
  copy.solution->forces = request.forces();
  if (!copy.solution->forces) return nullptr;
  return std::make_unique<AbiFunctions>(std::move(copy), request.fix, Ties::ascending, holds_branches(request));
}

}  // namespace eomgen::program

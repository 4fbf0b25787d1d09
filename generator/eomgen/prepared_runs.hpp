// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by the calls of one model that integrate: its equations, the code of its runs, and scenes in
// numbers. A second run of an unchanged model therefore costs its integration. Not installed.
#pragma once

#include <list>
#include <memory>
#include <optional>

#include "eomgen/call.hpp"
#include "pipeline/bound_run.hpp"
#include "pipeline/graph_trimmer.hpp"

namespace eomgen {

/// Deletes under the lock: the objects of computer algebra in T share their parts with others.
struct LockedDelete {
  /// Takes the lock and deletes the object.
  template <class T>
  void operator()(T* object) const {
    const std::scoped_lock lock(library_mutex());
    delete object;
  }
};

/// The code of a run and the numbers of its scene. The three parts may be shared with other runs.
struct PreparedRun {
  std::shared_ptr<pipeline::DerivedModel> derived;
  std::shared_ptr<const pipeline::Compilation> compilation;
  std::shared_ptr<const pipeline::RunPlan> plan;

  /// The run itself. To be called under the lock; the run may then be integrated without it.
  std::shared_ptr<pipeline::BoundRun> bind(run::Scene scene, bool estimate) const;
};

/// The latest results of the stages before an integration. All functions are called under the lock.
class PreparedRuns {
 public:
  /// `model`: the model of all runs.
  explicit PreparedRuns(std::shared_ptr<const model::Model> model) : model_(std::move(model)) {}
  /// with_constraints: the code has the functions about constraints, if the model has any.
  PreparedRun prepare(pipeline::SimulationRequest request, bool with_constraints = false);
  /// The scene of a run with further values and other options, where those are given.
  run::Scene scene(const PreparedRun& run, const run::Overrides& replaced);

 private:
  static constexpr std::size_t most_derivations = 2, most_compilations = 4, most_plans = 8;

  struct Derivation {
    pipeline::ApproachChoice approach;
    pipeline::FormChoice form;
    std::shared_ptr<pipeline::DerivedModel> derived;
    std::optional<pipeline::GraphTrimmer> graph = {};  // none: the graph has been extended since
  };
  struct Plan {
    const pipeline::DerivedModel* of;
    std::string scene;
    run::Overrides overrides;
    bool charts;
    std::vector<std::string> with;
    std::shared_ptr<const pipeline::RunPlan> plan;
  };
  struct Compiled {
    const pipeline::DerivedModel* of;
    program::Request functions;
    bool exchanges_charts;
    std::uint64_t seed;
    std::shared_ptr<const pipeline::Compilation> compilation;
  };

  Derivation& derive(const pipeline::SimulationRequest& request);
  void trim_graph(Derivation& derivation);
  std::shared_ptr<const pipeline::RunPlan> plan(Derivation& derivation, const pipeline::SimulationRequest& request);
  std::shared_ptr<const pipeline::Compilation> compile(Derivation& derivation, const pipeline::RunPlan& plan,
                                                       const pipeline::SimulationRequest& request);

  // The latest first.
  std::shared_ptr<const model::Model> model_;
  std::list<Derivation> derivations_;
  std::list<Compiled> compilations_;
  std::list<Plan> plans_;
};

}  // namespace eomgen

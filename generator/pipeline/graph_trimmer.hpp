// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pipeline/simulate.hpp"

namespace eomgen::pipeline {

/// Every run adds the values of its parameters to the graph of the model, and the graph never shrinks. The results of a
/// run do not refer to them. The graph is therefore reset from time to time, so that the memory of a sweep does not
/// grow with its runs.
class GraphTrimmer {
 public:
  /// If charts may change, second charts stay in the graph, and it is not reset.
  explicit GraphTrimmer(const Simulation& first)
      : GraphTrimmer(*first.derived->mechanics.dag, first.charts != nullptr) {}
  GraphTrimmer(symbolic::Dag& graph, bool charts_may_change)
      : graph_(graph), was_(graph_), most_(2 * graph_.size() + room), kept_(charts_may_change) {}
  /// Resets a large graph; to be called between runs.
  void trim() {
    if (!kept_ && graph_.size() > most_) graph_ = was_;
  }

 private:
  static constexpr std::size_t room = 4096;  // so that copies of a small graph are rare
  symbolic::Dag& graph_;
  symbolic::Dag was_;
  std::size_t most_;
  bool kept_;
};

}  // namespace eomgen::pipeline

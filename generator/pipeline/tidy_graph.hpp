// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "pipeline/simulate.hpp"

namespace eomgen::pipeline {

/// Every run puts the values of its parameters into the graph of the model, where nothing is ever taken out. Nothing
/// that a run leaves refers to them: now and then the graph becomes what it was, so that the memory of a sweep does not
/// grow with its runs.
class TidyGraph {
 public:
  /// Where charts may be exchanged second ones stay in the graph, and it is left alone.
  explicit TidyGraph(const Simulation& first)
      : graph_(*first.derived->mechanics.dag),
        was_(graph_),
        most_(2 * graph_.size() + room),
        kept_(first.charts != nullptr) {}
  /// Between runs.
  void tidy() {
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

// SPDX-License-Identifier: GPL-3.0-or-later
// The model as a page runs it: the optimised program in JavaScript, restricted to what the page calls, and what a start
// and a change of a parameter need. Or why the page can only replay the run.
#pragma once

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "analysis/drawing/parts.hpp"
#include "pipeline/simulate.hpp"

namespace eomgen::analysis {

struct LiveState {
  std::string name, unit;
};
struct LiveParameter {
  std::string name, unit, note;
  double value = 0;
  bool positive = false;
  bool moved = false;  // by the reader; what depends on others follows these
};
struct LiveEvent {
  std::string name;
  bool stops = false;
  const char* direction = "";
};

/// What the page needs beside the script. A state is counted with the coordinates first, then their rates.
struct LiveStart {
  std::size_t coordinates = 0;                              // free ones
  std::vector<LiveState> states;                            // twice as many
  std::vector<double> lower, upper;                         // of the coordinates; infinite where there is no bound
  std::vector<std::size_t> given;                           // states that the scene gives
  std::vector<LiveParameter> parameters;                    // all
  std::vector<std::pair<std::size_t, std::size_t>> starts;  // parameters that are the start of a coordinate
  std::size_t inputs = 0;
  std::vector<LiveEvent> events;
  std::size_t constraints = 0, event_functions = 0, sizes = 0;
};

struct LiveModel {
  std::string
      script;        // of the target javascript, ending in an expression statement free of side effects; empty: replay
  std::string name;  // what the script calls the model
  std::string reason;  // a sentence: why it is replayed
  LiveStart start;
};

/// `outputs`: names in the order of the array that the page draws and plots from; `set`: parameters and starts that
/// the command line made numbers.
LiveModel live_model(const pipeline::Simulation& simulation, const Drawing& drawing,
                     const std::vector<std::string>& outputs, const std::set<std::string>& set);

}  // namespace eomgen::analysis

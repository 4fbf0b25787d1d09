// SPDX-License-Identifier: GPL-3.0-or-later
// The model as a page runs it: the optimised program in JavaScript, restricted to what the page calls, and what a start
// and a change of a parameter need. Or why the page can only replay the run.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "cli/json.hpp"
#include "cli/report/drawing.hpp"
#include "pipeline/simulate.hpp"

namespace eomgen::cli {

struct LiveModel {
  std::string
      script;        // of the target javascript, ending in an expression statement free of side effects; empty: replay
  std::string name;  // what the script calls the model
  std::string reason;  // a sentence: why it is replayed
  Json start;          // names, given starts, parameters, events, tolerances
};

/// `outputs`: names in the order of the array that the page draws and plots from; `set`: parameters that the command
/// line made numbers.
LiveModel live_model(const pipeline::Simulation& simulation, const Drawing& drawing,
                     const std::vector<std::string>& outputs, const std::set<std::string>& set);

}  // namespace eomgen::cli

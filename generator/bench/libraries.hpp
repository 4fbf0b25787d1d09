// SPDX-License-Identifier: GPL-3.0-or-later
// Solvers of other installed libraries on the same right-hand side: small C functions of templates/bench, compiled on
// demand.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bench/bench.hpp"

namespace eomgen::bench {

/// One library: the source to compile, and the solvers in it.
struct Library {
  struct Solver {
    const char* name;      // in the table
    const char* function;  // of templates/bench
  };
  const char* name;
  const char *file, *text;  // of templates/bench
  const char* package;      // of Debian
  std::vector<std::string> link;
  std::vector<Solver> solvers;
};
const std::vector<Library>& libraries();

struct FoundLibraries {
  std::vector<ExternalSolver> external_solvers;
  std::vector<std::pair<std::string, std::string>> left_out;  // name, reason
};

/// The solvers that can integrate the scene. `request` has to outlive the result; a run is stopped after `seconds`.
FoundLibraries find_libraries(const run::RunRequest& request, const std::vector<double>& start, double seconds);

}  // namespace eomgen::bench

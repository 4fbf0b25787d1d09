// SPDX-License-Identifier: GPL-3.0-or-later
// Solvers of other libraries on the same right-hand side, where they are installed: small C functions of
// templates/bench, compiled when they are asked for.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/bench.hpp"

namespace eomgen::bench {

/// One library: what is compiled, and the solvers that the result has.
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

struct LibrariesFound {
  std::vector<Other> others;
  std::vector<std::pair<std::string, std::string>> left_out;  // name, why
};

/// The solvers that fit the scene. `request` is to outlive what is returned; a run that takes more than `seconds` is
/// stopped.
LibrariesFound find_libraries(const run::RunRequest& request, const std::vector<double>& start, double seconds);

}  // namespace eomgen::bench

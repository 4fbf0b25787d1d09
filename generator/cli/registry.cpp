// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "cli/commands/commands.hpp"

namespace eomgen::cli {

std::span<const Command> commands() {
  static constexpr std::array entries{
      Command{"new", "write a commented starter model", declare_new},
      Command{"import", "a robot file (URDF) as a model file", declare_import},
      Command{"list", "coordinates, formulations, solvers and targets that there are", declare_list},
      Command{"check", "read a model, classify its constraints and forces, check its units", declare_check},
      Command{"derive", "the equations of motion for reading", declare_derive},
      Command{"verify", "every derivation against an independent oracle", declare_verify},
      Command{"emit", "C and C++ sources, an FMU, or a LaTeX document", declare_emit},
      Command{"run", "derive, emit, compile and integrate a scene", declare_run},
      Command{"equilibria", "equilibria and steady motions, and whether they are stable", declare_equilibria},
      Command{"linearize", "the equations linearised at a state, and their eigenvalues", declare_linearize},
      Command{"bench", "true error against run time, every eligible solver", declare_bench},
      Command{"stress", "stiff and extreme variations: what each solver makes of them", declare_stress},
      Command{"inverse", "the forces that prescribed motions need", declare_inverse},
      Command{"sweep", "many runs over a grid of parameters, in parallel, resumable", declare_sweep},
      Command{"merge", "the tables of a sweep's shards into one", declare_merge},
      Command{"report", "one self-contained page: equations, verification, a run, plots, an animation", declare_report},
      Command{"docs", "the pages of the documentation, or one of their sections", declare_docs},
      Command{"manual", "the pages of the manual, for man", declare_manual},
      Command{"completion", "words that a shell completes, for bash, zsh and fish", declare_completion},
  };
  return entries;
}

}  // namespace eomgen::cli

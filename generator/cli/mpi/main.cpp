// SPDX-License-Identifier: GPL-3.0-or-later
// eomgen-mpi: the command sweep by as many processes as mpirun starts. The first one does all that can fail for
// everybody before the others begin; what fails later ends all of them, and the same command goes on from the rows that
// are there.
#include <algorithm>
#include <string_view>

#include "cli/mpi/team.hpp"
#include "cli/program.hpp"

int main(int argc, char** argv) {
  eomgen::cli::MpiTeam team(argc, argv);
  if (!team.leads() && !team.await_go()) return 0;
  const auto commands = eomgen::cli::commands();
  const auto sweep = std::find_if(commands.begin(), commands.end(),
                                  [](const auto& command) { return std::string_view(command.name) == "sweep"; });
  const int code = eomgen::cli::run_program({argv, static_cast<std::size_t>(argc)}, "eomgen-mpi", {sweep, 1}, &team);
  team.leave(code);
  return team.leads() ? code : 0;
}

// SPDX-License-Identifier: GPL-3.0-or-later
// eomgen-mpi: the command sweep with the processes that mpirun starts. The leader does everything that can fail in
// general before the workers start. A later failure ends all processes; the same command then continues from the
// existing rows.
#include <algorithm>
#include <string_view>

#include "cli/mpi/process_group.hpp"
#include "cli/program.hpp"

int main(int argc, char** argv) {
  eomgen::cli::MpiProcessGroup group(argc, argv);
  if (!group.is_leader() && !group.await_start()) return 0;
  const auto commands = eomgen::cli::commands();
  const auto sweep = std::find_if(commands.begin(), commands.end(),
                                  [](const auto& command) { return std::string_view(command.name) == "sweep"; });
  const int code = eomgen::cli::run_program({argv, static_cast<std::size_t>(argc)}, "eomgen-mpi", {sweep, 1}, &group);
  group.leave(code);
  return group.is_leader() ? code : 0;
}

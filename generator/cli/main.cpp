// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/program.hpp"

int main(int argc, char** argv) {
  return eomgen::cli::run_program({argv, static_cast<std::size_t>(argc)}, "eomgen", eomgen::cli::commands(), nullptr);
}

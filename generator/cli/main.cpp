// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <map>
#include <new>

#include "cli/command.hpp"
#include "cli/usage.hpp"

namespace {

using eomgen::cli::Command;
using eomgen::cli::Common;

constexpr int exit_internal = 4;

int report(const eomgen::Error& error) {
  fmt::print(stderr, "{}", error.what());
  return error.exit_code();
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"eomgen: equations of motion of mechanical systems, from a text model", "eomgen"};
  app.set_version_flag("--version", EOMGEN_VERSION);
  app.require_subcommand(1);
  Common common;
  std::map<const CLI::App*, std::function<int(const Common&)>> actions;
  std::vector<std::string> names;
  for (const Command& command : eomgen::cli::commands()) {
    CLI::App* sub = app.add_subcommand(command.name, command.summary);
    sub->add_flag("--json", common.json, "one JSON document instead of readable output");
    sub->add_option("--seed", common.seed, "fixes every random choice")
        ->check(eomgen::cli::whole_number(0, 999'999'999'999'999))
        ->capture_default_str();
    actions[sub] = command.declare(*sub);
    names.emplace_back(command.name);
  }
  eomgen::cli::require_command({argv, static_cast<std::size_t>(argc)}, names);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return report(eomgen::cli::usage_error(error, app));
  }
  const int code = actions.at(app.get_subcommands().front())(common);
  // A full disk or a closed pipe loses results; that is a failure, not a silence.
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    fmt::print(stderr, "error: standard output could not be written\n");
    return exit_internal;
  }
  return code;
} catch (const eomgen::Error& error) {
  return report(error);
} catch (const std::bad_alloc&) {
  fmt::print(stderr, "error: out of memory\n  remedy: make the model smaller\n");
  return exit_internal;
} catch (const std::exception& error) {
  fmt::print(stderr, "error: internal: {}\n  remedy: please report this, with the model\n", error.what());
  return exit_internal;
}

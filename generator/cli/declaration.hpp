// SPDX-License-Identifier: GPL-3.0-or-later
// Commands with their options. Parses the command line, and provides the data of manual pages and shell completions.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"

namespace eomgen::cli {

/// Documentation of an option or a positional argument.
struct DeclaredOption {
  std::vector<std::string> flags;  // "-o", "--out"; empty for a positional argument
  std::string argument;            // "MODEL" for a positional argument; value type of an option ("TEXT"); "" for a flag
  std::string help, default_value;          // preset: the default value; may be empty
  bool takes_list = false;                  // several values separated by commas
  std::vector<std::string> allowed_values;  // possible values; empty: any
};

struct DeclaredCommand {
  std::string name, summary;
  std::vector<DeclaredOption> options;  // in the order of the help, with --help

  std::vector<std::string> flags() const;
};

class Declaration {
 public:
  Declaration(const char* name, std::span<const Command> commands);
  ~Declaration();
  Declaration(const Declaration&) = delete;
  Declaration& operator=(const Declaration&) = delete;

  CommonOptions common;

  std::vector<DeclaredCommand> commands() const;
  std::vector<std::string> names() const;
  /// Parses the command line. If help or version is requested, prints it and returns the exit code. Throws
  /// Error{stage "usage"} with a remedy.
  std::optional<int> read(std::span<char* const> words);
  /// Executes the command that read() found and returns its exit code.
  int execute() const;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace eomgen::cli

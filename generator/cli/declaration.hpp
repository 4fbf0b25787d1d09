// SPDX-License-Identifier: GPL-3.0-or-later
// The commands with their options: what reads the command line, and what pages of the manual and completions are
// written from.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"

namespace eomgen::cli {

/// An option or an argument, as those who read about it see it.
struct DeclaredOption {
  std::vector<std::string> flags;  // "-o", "--out"; none of an argument
  std::string argument;            // "MODEL" of an argument; the kind of value of an option ("TEXT"), "" of a flag
  std::string help, preset;        // preset: what holds without it; "" where it says nothing
  bool takes_list = false;         // several words with commas
  std::vector<std::string> words;  // what the value may be; empty: anything
};

struct DeclaredCommand {
  std::string name, summary;
  std::vector<DeclaredOption> options;  // in the order of its help, --help among them

  std::vector<std::string> flags() const;
};

class Declaration {
 public:
  Declaration(const char* name, std::span<const Command> commands);
  ~Declaration();
  Declaration(const Declaration&) = delete;
  Declaration& operator=(const Declaration&) = delete;

  Common common;

  std::vector<DeclaredCommand> commands() const;
  std::vector<std::string> names() const;
  /// Reads the words of the command line. The exit code where help or the version was asked for, which is then printed.
  /// Throws Error {stage "usage"} with a remedy.
  std::optional<int> read(std::span<char* const> words);
  /// What the command does that was read.
  int execute() const;

 private:
  struct Parser;
  std::unique_ptr<Parser> parser_;
};

}  // namespace eomgen::cli

// SPDX-License-Identifier: GPL-3.0-or-later
// Declaration of command-line options. Only arguments.cpp and the program include CLI11, whose templates would add
// seconds of compilation to the file of every command.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace eomgen::cli {

/// Validates a value as typed. Returns the error, or an empty string.
using ValueCheck = std::function<std::string(const std::string&)>;

/// Validators of numbers. All of them reject infinities and NaN.
ValueCheck finite_number();
ValueCheck positive_number();
ValueCheck nonnegative_number();
ValueCheck whole_number(unsigned long long least, unsigned long long most);

/// Suggested values of options, for shell completion.
using SuggestedValues = std::map<const CLI::Option*, std::vector<std::string>>;

class Option {
 public:
  Option(CLI::Option* option, SuggestedValues& words) : option_(option), words_(words) {}
  Option required() const;
  Option check(ValueCheck complaint) const;
  /// Shows the default value in the help.
  Option show_default() const;
  /// Allows repetition, with one value each time.
  Option repeated() const;
  /// Sets the values for shell completion. Does not validate: the command reports other values.
  Option suggest_values(std::vector<std::string> words) const;

 private:
  CLI::Option* option_;
  SuggestedValues& words_;
};

class Arguments {
 public:
  Arguments(CLI::App& app, SuggestedValues& words) : app_(app), words_(words) {}

  /// Flags without hyphens declare a positional argument. arguments.cpp lists the types of targets.
  template <typename T>
  Option add_option(const std::string& flags, T& target, const std::string& help);
  Option add_flag(const std::string& flags, bool& target, const std::string& help);

  /// Adds an option for an output file or folder, the same in all commands. An empty path is an error.
  Option add_output_path(const std::string& flags, std::string& target, const std::string& help);
  /// Adds a list option: it may be repeated, takes one word each time, and splits it at `delimiter`. A CLI11 list would
  /// also take MODEL.
  Option add_list(const std::string& flag, std::vector<std::string>& target, const std::string& help,
                  char delimiter = ',');

 private:
  CLI::App& app_;
  SuggestedValues& words_;
};

}  // namespace eomgen::cli

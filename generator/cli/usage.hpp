// SPDX-License-Identifier: GPL-3.0-or-later
// The command line as the user typed it: what is asked of numbers, and errors of usage with a remedy.
#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <vector>

#include "error.hpp"
#include "model/names.hpp"

namespace eomgen::cli {

using model::choice_of;

/// Validators of numbers; infinite and "nan" are refused by each.
CLI::Validator finite_number();
CLI::Validator positive_number();
CLI::Validator number_not_negative();
CLI::Validator whole_number(unsigned long long least, unsigned long long most);

/// An option that names a file or folder for results: one meaning of it in every command. An empty name is refused.
CLI::Option* add_place(CLI::App& app, const std::string& flags, std::string& target, const std::string& help);

/// An option that may be repeated and takes one word each time, which `delimiter` may part. CLI11 would let it swallow
/// MODEL.
CLI::Option* add_list(CLI::App& app, const std::string& flag, std::vector<std::string>& target, const std::string& help,
                      char delimiter = ',');

/// Throws Error where the first word is no command: with the nearest one, or with what can be done with a model.
void require_command(std::span<char* const> words, const std::vector<std::string>& commands);

/// `eomgen help` and `eomgen help COMMAND` as --help has them.
std::vector<std::string> with_help(std::span<char* const> words);

/// The page of `eomgen --help`: three examples, then the commands, and where the documentation is.
class HelpPage : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override;
};

/// What CLI11 found wrong, in our words.
Error usage_error(const CLI::ParseError& error, const CLI::App& app);

}  // namespace eomgen::cli

// SPDX-License-Identifier: GPL-3.0-or-later
// What a command reads from the command line. CLI11, which reads it, is included by arguments.cpp and by the program
// alone: its templates would cost every command's file some seconds of compilation.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace eomgen::cli {

/// What is wrong with a value as typed; empty where nothing is.
using Check = std::function<std::string(const std::string&)>;

/// Checks of numbers; infinite and "nan" are refused by each.
Check finite_number();
Check positive_number();
Check number_not_negative();
Check whole_number(unsigned long long least, unsigned long long most);

/// The words that the value of an option may be, where a registry has them: of each option that says so.
using Words = std::map<const CLI::Option*, std::vector<std::string>>;

class Option {
 public:
  Option(CLI::Option* option, Words& words) : option_(option), words_(words) {}
  Option required() const;
  Option check(Check complaint) const;
  /// Its help shows what holds without it.
  Option show_preset() const;
  /// May be repeated, and takes one word each time.
  Option repeated() const;
  /// What is completed behind it. Whoever reads the value says what is wrong with others.
  Option one_of(std::vector<std::string> words) const;

 private:
  CLI::Option* option_;
  Words& words_;
};

class Arguments {
 public:
  Arguments(CLI::App& app, Words& words) : app_(app), words_(words) {}

  /// A name without hyphens is an argument by its place.
  Option add_option(const std::string& flags, std::string& target, const std::string& help);
  Option add_option(const std::string& flags, double& target, const std::string& help);
  Option add_option(const std::string& flags, int& target, const std::string& help);
  Option add_option(const std::string& flags, std::uint64_t& target, const std::string& help);
  Option add_option(const std::string& flags, std::optional<std::string>& target, const std::string& help);
  Option add_option(const std::string& flags, std::optional<double>& target, const std::string& help);
  Option add_option(const std::string& flags, std::vector<std::string>& target, const std::string& help);
  Option add_flag(const std::string& flags, bool& target, const std::string& help);

  /// An option that names a file or folder for results: one meaning of it in every command. An empty name is refused.
  Option add_place(const std::string& flags, std::string& target, const std::string& help);
  /// An option that may be repeated and takes one word each time, which `delimiter` may part. CLI11 would let it
  /// swallow MODEL.
  Option add_list(const std::string& flag, std::vector<std::string>& target, const std::string& help,
                  char delimiter = ',');

 private:
  CLI::App& app_;
  Words& words_;
};

}  // namespace eomgen::cli

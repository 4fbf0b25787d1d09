// SPDX-License-Identifier: GPL-3.0-or-later
// The error type of the whole program: stage, place in the user's file, message and remedy.
#pragma once

#include <cstdint>
#include <exception>
#include <string>

namespace eomgen {

/// A place in a user's file. Line and column count from 1; 0 means unknown. `text` is the whole source line.
struct SourceLocation {
  std::string file;
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::uint32_t length = 1;
  std::string text;
};

/// The kind of a failure. It determines the exit code (docs/commands.md).
enum class ErrorKind {
  input,      ///< exit 2: the model file or the command line is wrong
  check,      ///< exit 1: a check failed
  numerical,  ///< exit 3: a run failed numerically
  tool,       ///< exit 4: a required tool is missing or failed
};

class Error : public std::exception {
 public:
  Error(std::string stage, SourceLocation where, std::string what, std::string remedy,
        ErrorKind fault = ErrorKind::input);

  /// "file:line:col: error: ...", the source line, a caret under the place, and the remedy.
  const char* what() const noexcept override { return report_.c_str(); }

  const std::string& stage() const noexcept { return stage_; }
  const SourceLocation& where() const noexcept { return where_; }
  const std::string& message() const noexcept { return message_; }
  const std::string& remedy() const noexcept { return remedy_; }
  ErrorKind fault() const noexcept { return fault_; }
  int exit_code() const noexcept;

 private:
  std::string stage_;
  SourceLocation where_;
  std::string message_;
  std::string remedy_;
  ErrorKind fault_;
  std::string report_;
};

/// A warning. format_warning uses the layout of Error::what; the program continues.
struct Warning {
  SourceLocation where;
  std::string message;
  std::string remedy;
};
std::string format_warning(const Warning& warning);

}  // namespace eomgen

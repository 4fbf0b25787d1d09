// SPDX-License-Identifier: GPL-3.0-or-later
// A child process in a test. In: arguments, working folder, changes of the environment, a time limit. Out: its output
// and exit status. A child that exceeds its limit is killed.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace eomgen::test {

struct ChildCommand {
  std::vector<std::string> arguments;  // the program first; searched in PATH unless it is a path
  std::string folder = ".";
  std::map<std::string, std::optional<std::string>> environment{};  // changes; nothing: removed
  double limit = 30;                                                // seconds; ten times as many under the sanitizers
};

struct ChildResult {
  int status = -1;  // exit code, or 128 + signal
  bool in_time = true;
  double seconds = 0;
  long peak_kilobytes = 0;  // peak memory of itself or of its largest child
  std::string out, err;
};

class Child {
 public:
  /// Starts the process. Throws std::runtime_error if that fails.
  explicit Child(const ChildCommand& command);
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child();

  void signal(int number) const;
  /// Reads both streams to the end and waits for the process.
  ChildResult finish();

 private:
  void read_until(std::chrono::steady_clock::time_point end, ChildResult& result);

  pid_t process_ = -1;
  int out_ = -1, err_ = -1;
  double limit_;
  std::chrono::steady_clock::time_point start_;
};

inline ChildResult run_child(const ChildCommand& command) { return Child(command).finish(); }

}  // namespace eomgen::test

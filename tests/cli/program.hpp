// SPDX-License-Identifier: GPL-3.0-or-later
// Runs the program under test as a user does, in a temporary folder.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/process.hpp"

namespace eomgen::test {

using Json = nlohmann::ordered_json;
using Words = std::vector<std::string>;

/// Temporary folder, removed by the destructor.
class Folder {
 public:
  Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder();

  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  void write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;  // throws std::runtime_error if it does not exist
  bool has(const std::string& name) const;
  std::vector<std::string> names() const;  // sorted

 private:
  std::string path_;
};

/// Command with the environment of tests: one cache folder for all tests, and the shipped models.
ChildCommand command(const Folder& folder, const Words& words);
Words with(Words words, const Words& more);
ChildResult eomgen(const Folder& folder, const Words& words);
/// The same, with a doctest failure that shows the output if the exit status differs from `status`.
ChildResult expect(int status, const Folder& folder, const Words& words);
/// Runs `words` with --json. Requires exit status `status` and a document that satisfies docs/schema/WORDS[0].
Json document(const Folder& folder, Words words, int status = 0);

/// Model of a particle under gravity on a rod of length L in x and y, with a multiplier.
std::string pendulum_text(const std::string& scene);
/// x'' = -(k/m) x from x = 1, for 1 s: cos(sqrt(k/m) t).
std::string oscillator_text();
/// x'' = k x^2 from x = 1: diverges in finite time.
std::string diverging_text();
/// Falls towards x = 0, where its inertia vanishes. One step of length 1 of Euler's method ends there exactly.
std::string singular_text();

struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
  std::string outcome;  // of the trailing line
  double at(std::size_t row, const std::string& column) const;
};
/// Parses a CSV file, with a doctest failure if it violates the documented format.
Table read_table(const std::string& text);

std::vector<std::string> shipped_models();  // names, sorted
bool contains(const std::string& text, const std::string& part);
/// With its first `what` replaced; a doctest failure if there is none.
std::string replaced(std::string text, const std::string& what, const std::string& with);

}  // namespace eomgen::test

// SPDX-License-Identifier: GPL-3.0-or-later
// The program under test, called as a user calls it, in a folder of its own.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/process.hpp"

namespace eomgen::test {

using Json = nlohmann::ordered_json;
using Words = std::vector<std::string>;

/// A folder under the system's temporary one; gone when this is.
class Folder {
 public:
  Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder();

  const std::string& path() const { return path_; }
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  void write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;  // throws std::runtime_error if it is not there
  bool has(const std::string& name) const;
  std::vector<std::string> names() const;  // sorted

 private:
  std::string path_;
};

/// What calls get beside their words: compiled code is cached in one folder for all tests, models are the shipped ones.
ChildCommand command(const Folder& folder, const Words& words);
Words with(Words words, const Words& more);
ChildResult eomgen(const Folder& folder, const Words& words);
/// The same where success is expected: a failure is a doctest failure that shows what was printed.
ChildResult expect(int status, const Folder& folder, const Words& words);
/// `words` with --json, which must end with `status` and print a document that fits docs/schema/WORDS[0].
Json document(const Folder& folder, Words words, int status = 0);

/// A particle under gravity on a rod of length L, by x and y: the constraint stays.
std::string pendulum_text(const std::string& scene);
/// x'' = -(k/m) x from x = 1, for 1 s: cos(sqrt(k/m) t).
std::string oscillator_text();
/// x'' = k x^2 from x = 1: infinite at a finite time.
std::string diverging_text();
/// Falls towards x = 0, where its inertia vanishes; Euler's step of length 1 from the start ends there exactly.
std::string singular_text();

struct Table {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
  std::string outcome;  // of the trailing line
  double at(std::size_t row, const std::string& column) const;
};
/// A CSV file that holds to the contract; a doctest failure where it does not.
Table read_table(const std::string& text);

std::vector<std::string> shipped_models();  // names, sorted
bool contains(const std::string& text, const std::string& part);

}  // namespace eomgen::test

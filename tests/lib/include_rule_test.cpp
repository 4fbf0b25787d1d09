// The runtime includes the standard library and itself, and Eigen for projection and constraints. Every header is MIT.
#include <doctest/doctest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "support/folders.hpp"

namespace {

/// `header`: the name of the file that includes; `folder`: that of its folder.
bool allowed(const std::string& included, const std::string& header, const std::string& folder) {
  if (included.starts_with("\"eom/")) return true;
  if (included.starts_with("<Eigen/"))
    return folder == "contacts" ||  // matrices of responses, complementarity problems
           header == "projection.hpp" || header == "singularity_detector.hpp" || header == "rounding.hpp" ||
           header == "momentum_jump_definition.hpp";  // least-norm steps and momenta for singular M
  // Only POSIX can create a file exclusively and without following links; the standard library cannot.
  const std::set<std::string> posix{"<fcntl.h>", "<stdlib.h>", "<sys/stat.h>", "<unistd.h>"};
  if (posix.contains(included)) return header == "atomic_file.hpp";
  if (!included.starts_with("<")) return false;
  for (const char c : included.substr(1, included.size() - 2))
    if (std::islower(static_cast<unsigned char>(c)) == 0 && c != '_')
      return false;  // <vector>, but not <ginac/ginac.h>
  return true;
}

}  // namespace

TEST_CASE(
    "runtime headers: own headers and the standard library only, Eigen for linear systems, POSIX in what writes "
    "files, MIT, no globals") {
  int headers = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(eomgen::test::source_folder() + "/lib/eom")) {
    if (!entry.is_regular_file()) continue;
    const std::string name = entry.path().filename().string();
    CAPTURE(name);
    CHECK(entry.path().extension() == ".hpp");
    std::ifstream file(entry.path());
    std::string line;
    std::getline(file, line);
    CHECK(line == "// SPDX-License-Identifier: MIT");
    int lines = 1;
    bool guarded = false;
    for (; std::getline(file, line); ++lines) {
      guarded = guarded || line == "#pragma once";
      if (!line.starts_with("#include ")) continue;
      const std::string included = line.substr(9, line.find_first_of(">\"", 10) - 8);
      CAPTURE(included);
      CHECK(allowed(included, name, entry.path().parent_path().filename().string()));
    }
    CHECK(guarded);
    CHECK(lines < 400);
    ++headers;
  }
  CHECK(headers > 10);
}

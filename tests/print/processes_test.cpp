// SPDX-License-Identifier: GPL-3.0-or-later
// Every process prints the same bytes, with address randomisation and different GiNaC serial numbers.
#include <doctest/doctest.h>

#include <cstdio>
#include <filesystem>
#include <set>
#include <string>

#include "support/folders.hpp"

namespace {

// Two processes find what depends on addresses or serial numbers, over all models; every few models take two more.
constexpr int models_per_group = 8;

std::string output_of(const std::string& command) {
  std::string result;
  FILE* pipe = popen(command.c_str(), "r");
  REQUIRE(pipe != nullptr);
  char buffer[4096];
  for (std::size_t n = 0; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) result.append(buffer, n);
  CHECK(pclose(pipe) == 0);
  return result;
}

}  // namespace

TEST_CASE("every shipped model prints equal bytes in fresh processes") {
  int models = 0;
  std::set<std::filesystem::path> paths;  // sorted
  for (const auto& entry : std::filesystem::directory_iterator(eomgen::test::source_folder() + "/models")) {
    if (entry.path().extension() == ".toml") paths.insert(entry.path());
  }
  for (const std::filesystem::path& path : paths) {
    CAPTURE(path.filename().string());
    const std::string command = std::string(PRINT_EVERYTHING) + " '" + path.string() + "' ";
    const std::string first = output_of(command + "0");
    CHECK(first.size() > 500);
    CHECK(output_of(command + "4242") == first);
    if (models++ % models_per_group != 0) continue;
    for (const char* burnt : {"1", "17"}) CHECK(output_of(command + burnt) == first);
  }
  CHECK(models > 10);
}

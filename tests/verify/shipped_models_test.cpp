// SPDX-License-Identifier: GPL-3.0-or-later
// Every model in models/: all formulations, both approaches, against the oracle.
#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "support/folders.hpp"
#include "verify/certificate.hpp"

using namespace eomgen;
namespace fs = std::filesystem;

namespace {

std::vector<fs::path> shipped_models() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(test::source_folder()) / "models"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

TEST_CASE("certificate: every shipped model passes at 20 states in 50 digits, with 45 digits of agreement") {
  const std::vector<fs::path> files = shipped_models();
  REQUIRE(!files.empty());
  for (const fs::path& file : files) {
    INFO(file.filename().string());
    const model::Model model = model::read_model(file.string());
    mechanics::Mechanics mechanics = mechanics::build_mechanics(model);
    const auto start = std::chrono::steady_clock::now();
    const verify::Certificate c = verify::verify(mechanics, {50, 20, 1});
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    MESSAGE(file.stem().string(), ", ", seconds.count(), " s, ", c.rejections(), " rejected, ", c.summary());
    CHECK(c.pass);
    CHECK(c.points == 20);
    for (const verify::Comparison& row : c.comparisons) {
      CAPTURE(row.a);
      CAPTURE(row.b);
      CAPTURE(row.max_relative_difference);
      CHECK(row.digits_agreed >= 45);
    }
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Files that a model names: each reason why one is not read has its kind.
#include "model/data_file.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>

using namespace eomgen::model;

TEST_CASE("a data file is read from the model's folder, and every other path has the kind of its problem") {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / fmt::format("eomgen_data_{}", ::getpid());
  fs::create_directories(folder / "model/data");
  std::ofstream(folder / "secret.csv") << "t,F\n";
  std::ofstream(folder / "model/data/four.csv") << "1234";
  std::ofstream(folder / "model/data/five.csv") << "12345";
  fs::create_symlink(folder / "secret.csv", folder / "model/link.csv");
  fs::create_symlink(folder / "model/data", folder / "model/inner");
  const std::string model = (folder / "model").string();
  const auto problem = [&](const std::string& path, const std::string& from) -> std::optional<DataFileProblem> {
    try {
      read_data_file(from, path, 4);
      return std::nullopt;
    } catch (const DataFileError& error) {
      CHECK_FALSE(error.message().empty());
      CHECK_FALSE(error.remedy().empty());
      CHECK(std::string(error.what()) == error.message());
      return error.problem();
    }
  };
  CHECK(read_data_file(model, "data/four.csv", 4) == "1234");
  CHECK(read_data_file(model, "inner/four.csv", 4) == "1234");
  CHECK(problem("data/five.csv", model) == DataFileProblem::too_large);
  CHECK(problem("data/four.csv", "") == DataFileProblem::no_folder);
  for (const std::string& path :
       {std::string(), std::string("../secret.csv"), (folder / "secret.csv").string(), std::string("link.csv"),
        std::string("data/../../secret.csv"), std::string("data\\four.csv"), std::string("data/four\n.csv")}) {
    CAPTURE(path);
    CHECK(problem(path, model) == DataFileProblem::outside);
  }
  CHECK(problem("data", model) == DataFileProblem::missing);
  CHECK(problem("none.csv", model) == DataFileProblem::missing);
  CHECK(problem("four.csv", (folder / "none").string()) == DataFileProblem::missing);
  fs::remove_all(folder);
}

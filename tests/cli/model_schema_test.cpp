// SPDX-License-Identifier: GPL-3.0-or-later
// docs/schema/editor/model.schema.json: accepts every shipped model, and has the keys that the reader has.
#include <doctest/doctest.h>
#include <toml++/toml.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "program.hpp"
#include "support/folders.hpp"
#include "support/schema.hpp"

using namespace eomgen::test;

namespace {

constexpr const char* schema = "editor/model";

nlohmann::json as_json(const std::string& toml_text) {
  std::ostringstream out;
  out << toml::json_formatter(toml::parse(toml_text));
  return nlohmann::json::parse(out.str());
}

std::string file_text(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// Keys of a table with a wrong key, as the reader lists them.
std::set<std::string> keys_of_reader(const std::string& model) {
  const Folder folder;
  folder.write("model.toml", model);
  const std::string report = expect(2, folder, {"check", "model.toml"}).err;
  const std::string words = "its keys are ";
  const std::size_t at = report.find(words);
  if (at == std::string::npos) {
    FAIL_CHECK(report);
    return {};
  }
  std::set<std::string> keys;
  std::istringstream list(report.substr(at + words.size(), report.find('\n', at) - at - words.size()));
  for (std::string key; list >> key;) keys.insert(key.substr(0, key.find(',')));
  return keys;
}

std::set<std::string> keys_of(const nlohmann::json& table) {
  std::set<std::string> keys;
  for (const auto& [key, value] : table["properties"].items()) keys.insert(key);
  return keys;
}

}  // namespace

TEST_CASE("the schema of model files accepts every shipped model and the starter") {
  const std::filesystem::path root = source_folder();
  std::vector<std::filesystem::path> files{root / "templates" / "starter.toml"};
  for (const auto& entry : std::filesystem::directory_iterator(root / "models"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  CHECK(files.size() > 80);
  for (const std::filesystem::path& file : files) {
    CAPTURE(file.filename().string());
    support::check_schema(as_json(file_text(file)), schema);
  }
}

TEST_CASE("the schema of model files refuses unknown keys and values of another kind") {
  for (const char* wrong :
       {"format = 2", "title = \"no format\"", "format = 1\n[[partical]]\nname = \"P\"",
        "format = 1\n[[body]]\nnam = \"B\"", "format = 1\n[[event]]\nname = \"e\"\nwhen = \"x\"\ndirection = \"left\"",
        "format = 1\n[scene.default]\nt = 3"})
    CHECK_FALSE(support::schema_errors(as_json(wrong), schema).empty());
}

TEST_CASE("the schema of model files has exactly the keys of the reader") {
  const nlohmann::json document = nlohmann::json::parse(
      file_text(std::filesystem::path(source_folder()) / "docs" / "schema" / "editor" / "model.schema.json"));
  CHECK(keys_of(document) == keys_of_reader("format = 1\nunknown_key = 1\n"));
  for (const char* list :
       {"particle", "body", "frame", "point", "chain", "force", "constraint", "joint", "state", "event", "sample"}) {
    CAPTURE(list);
    const std::string model = "format = 1\n[[" + std::string(list) + "]]\nname = \"A\"\nunknown_key = 1\n";
    CHECK(keys_of(document["properties"][list]["items"]) == keys_of_reader(model));
  }
  for (const char* named : {"parameters", "functions", "inputs", "coordinates", "discrete"}) {
    CAPTURE(named);
    const std::string model = "format = 1\n[" + std::string(named) + "]\na = { unknown_key = 1 }\n";
    CHECK(keys_of(document["properties"][named]["additionalProperties"]["anyOf"][1]) == keys_of_reader(model));
  }
  CHECK(keys_of(document["properties"]["energy"]) == keys_of_reader("format = 1\n[energy]\nunknown_key = 1\n"));
  const std::string scene =
      "format = 1\n[parameters]\nm = \"1 kg\"\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = [\"x\", 0, 0]\n"
      "[coordinates]\nx = \"m\"\n[scene.default]\nt = [0, 1]\nunknown_key = 1\n";
  CHECK(keys_of(document["properties"]["scene"]["additionalProperties"]) == keys_of_reader(scene));
}

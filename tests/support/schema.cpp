#include "support/schema.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "support/folders.hpp"

namespace support {
namespace {

using valijson::adapters::NlohmannJsonAdapter;
namespace fs = std::filesystem;

const fs::path folder = fs::path(eomgen::test::source_folder()) / "docs" / "schema";
constexpr const char* ending = ".schema.json";

nlohmann::json read_schema(const std::string& schema_name) {
  std::ifstream file(folder / (schema_name + ending));
  if (!file) throw std::runtime_error("docs/schema holds no " + schema_name + ending);
  return nlohmann::json::parse(file);
}

}  // namespace

std::vector<std::string> schema_errors(const nlohmann::json& document, const std::string& schema_name) {
  const nlohmann::json rules = read_schema(schema_name);
  valijson::Schema schema;
  valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(NlohmannJsonAdapter(rules), schema);

  valijson::ValidationResults results;
  valijson::Validator(valijson::Validator::kStrongTypes).validate(schema, NlohmannJsonAdapter(document), &results);
  std::vector<std::string> errors;
  for (valijson::ValidationResults::Error error; results.popError(error);) {
    std::string place;
    for (const std::string& part : error.context) place += part;
    errors.push_back(place + ": " + error.description);
  }
  return errors;
}

std::vector<std::string> schema_names() {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    if (file.ends_with(ending)) names.push_back(file.substr(0, file.size() - std::string_view(ending).size()));
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace support

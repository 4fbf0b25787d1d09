// In: a JSON document that a command printed, and the command's name. Out: violations of docs/schema/NAME.schema.json.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace support {

/// One line for each violation of the schema, "<root>[outcome]: what"; empty if the document is valid.
/// Throws std::runtime_error if the schema does not exist or is invalid.
std::vector<std::string> schema_errors(const nlohmann::json& document, const std::string& schema_name);

/// The names of the schemas: one for each file of docs/schema/, sorted.
std::vector<std::string> schema_names();

/// Fails the test with the lines of schema_errors and the document, if there are any.
void check_schema(const nlohmann::json& document, const std::string& schema_name);

}  // namespace support

// In: a JSON document that a command printed, and the command's name. Out: where it breaks
// docs/schema/NAME.schema.json.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace support {

/// One line for each place that breaks the schema, "<root>[outcome]: what"; empty if the document is right.
/// Throws std::runtime_error if there is no such schema or it is itself no schema.
std::vector<std::string> schema_errors(const nlohmann::json& document, const std::string& schema_name);

/// The names that schema_errors knows: one for each file of docs/schema/, sorted.
std::vector<std::string> schema_names();

/// A doctest failure, with the lines of schema_errors and the document, if there is any.
void check_schema(const nlohmann::json& document, const std::string& schema_name);

}  // namespace support

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "support/schema.hpp"

namespace support {

void check_schema(const nlohmann::json& document, const std::string& schema_name) {
  const std::vector<std::string> errors = schema_errors(document, schema_name);
  if (errors.empty()) return;
  std::string report = "the document breaks docs/schema/" + schema_name + ".schema.json\n";
  for (const std::string& error : errors) report += "  " + error + "\n";
  report += document.dump(2);
  FAIL_CHECK(report);
}

}  // namespace support

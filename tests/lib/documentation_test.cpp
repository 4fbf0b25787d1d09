// docs/runtime.md contains the compiled and tested example byte for byte, and names every method and outcome.
#include <doctest/doctest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "eom/ode.hpp"
#include "support/folders.hpp"

namespace {

std::string document_text(const std::string& path) {
  std::ifstream file(eomgen::test::source_folder() + "/" + path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("docs/runtime.md: its example is examples/runtime/pendulum.cpp") {
  const std::string code = document_text("examples/runtime/pendulum.cpp");
  REQUIRE(!code.empty());
  CHECK(document_text("docs/runtime.md").find("```cpp\n" + code + "```\n") != std::string::npos);
}

TEST_CASE("docs/runtime.md: the table of requirements agrees with the methods") {
  const std::string text = document_text("docs/runtime.md");
  const std::string section = text.substr(text.find("| method | requires |"));
  for (const eom::MethodInfo& method : eom::methods()) {
    CAPTURE(std::string(method.name));
    const std::size_t at = section.find("`" + std::string(method.name) + "`");
    REQUIRE(at != std::string::npos);
    std::istringstream row(section.substr(at, section.find('\n', at) - at));
    std::string methods, required, used, refused, expected[3];
    for (std::string* cell : {&methods, &required, &used, &refused}) std::getline(row, *cell, '|');
    const auto add = [](std::string& cell, eom::Feature feature) {
      cell += (cell.empty() ? " " : ", ") + std::string(eom::name(feature));
    };
    for (const eom::Feature feature : eom::all_features) {
      if (method.needs.required.has(feature)) add(expected[0], feature);
      if (method.needs.used.has(feature)) add(expected[1], feature);
    }
    for (const eom::Refusal& refusal : method.needs.refuses)
      if (refusal.feature != eom::Feature::charts) add(expected[2], refusal.feature);
    for (std::string& cell : expected) cell += " ";
    CHECK(required == expected[0]);
    CHECK(used == expected[1]);
    CHECK(refused == expected[2]);
  }
}

TEST_CASE("docs/runtime.md: every method and every outcome is in its tables") {
  const std::string text = document_text("docs/runtime.md");
  for (const eom::MethodInfo& method : eom::methods()) {
    CAPTURE(std::string(method.name));
    CHECK(text.find("| `" + std::string(method.name) + "` | " + std::to_string(method.order)) != std::string::npos);
  }
  for (int k = 0; k <= static_cast<int>(eom::Outcome::not_finite); ++k) {
    const std::string name = eom::name(static_cast<eom::Outcome>(k));
    CAPTURE(name);
    CHECK(text.find("`" + name + "`") != std::string::npos);
  }
}

// docs/runtime.md shows the example that the tests compile and run, byte for byte, and names every method and outcome.
#include <doctest/doctest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "eom/ode.hpp"
#include "support/folders.hpp"

namespace {

std::string text_of(const std::string& path) {
  std::ifstream file(eomgen::test::source_folder() + "/" + path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("docs/runtime.md: its example is examples/runtime/pendulum.cpp") {
  const std::string code = text_of("examples/runtime/pendulum.cpp");
  REQUIRE(!code.empty());
  CHECK(text_of("docs/runtime.md").find("```cpp\n" + code + "```\n") != std::string::npos);
}

TEST_CASE("docs/runtime.md: every method and every outcome is in its tables") {
  const std::string text = text_of("docs/runtime.md");
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

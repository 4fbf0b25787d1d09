// SPDX-License-Identifier: GPL-3.0-or-later
// docs: the pages of docs/ from the program alone.
#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "program.hpp"
#include "support/folders.hpp"

using namespace eomgen::test;

namespace {

std::string page_text(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

}  // namespace

TEST_CASE("docs: every page of docs/ is listed, and shown byte for byte") {
  const Folder folder;
  const Json list = document(folder, {"docs"});
  std::size_t count = 0;
  const std::filesystem::path root = std::filesystem::path(source_folder()) / "docs";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root))
    count += entry.path().extension() == ".md" ? 1 : 0;
  CHECK(list["pages"].size() == count);
  for (const Json& page : list["pages"]) {
    const std::string topic = page["topic"];
    CAPTURE(topic);
    CHECK(expect(0, folder, {"docs", topic}).out == page_text(root / (topic + ".md")));
  }
}

TEST_CASE("docs: a heading shows its section, whatever its case, and code is no heading") {
  const Folder folder;
  const Json found = document(folder, {"docs", "return-CODES"});
  REQUIRE(found["texts"].size() == 1);
  CHECK(found["texts"][0]["topic"] == "abi");
  const std::string text = found["texts"][0]["text"];
  CHECK(text.starts_with("## Return codes\n"));
  CHECK(contains(text, "singular mass matrix"));
  CHECK_FALSE(contains(text, "## Kinks"));
  CHECK(document(folder, {"docs", "sweep parameters"})["texts"][0]["topic"] == "how-to/sweep-parameters");
}

TEST_CASE("docs: an unknown topic is refused with a similar one") {
  const Folder folder;
  const ChildResult refused = expect(2, folder, {"docs", "return codess"});
  CHECK(contains(refused.err, "no page and no section"));
  CHECK(contains(refused.err, "Return codes"));
}

// Consistency of documents and comments with the source tree: links, files, the model in the README, packages and
// commands.
#include <doctest/doctest.h>

#include <filesystem>
#include <regex>
#include <string>

#include "architecture/sources.hpp"
#include "support/folders.hpp"

using namespace architecture;
namespace fs = std::filesystem;

namespace {

const fs::path root = eomgen::test::source_folder();

std::vector<fs::path> documents() {
  std::vector<fs::path> files = files_below(root / "docs", {".md"});
  files.push_back(root / "README.md");
  return files;
}

}  // namespace

TEST_CASE("every link within the repository has a target") {
  static const std::regex link(R"(\]\(([^)\s#]+)(#[^)]*)?\))");
  for (const fs::path& document : documents()) {
    const std::string text = read_text(document);
    for (std::sregex_iterator at(text.begin(), text.end(), link), end; at != end; ++at) {
      const std::string target = (*at)[1];
      if (target.find("://") != std::string::npos) continue;
      INFO(fs::relative(document, root).generic_string() << " links " << target);
      CHECK(fs::exists(document.parent_path() / target));
    }
  }
}

TEST_CASE("numbered sections of a page count from 1") {
  static const std::regex number(R"(\n## (\d+)\. )");
  std::size_t numbered = 0;
  for (const fs::path& document : documents()) {
    const std::string text = read_text(document);
    int last = 0;
    for (std::sregex_iterator at(text.begin(), text.end(), number), end; at != end; ++at, ++numbered) {
      INFO(fs::relative(document, root).generic_string() << " has section " << (*at)[1]);
      CHECK(std::stoi((*at)[1]) == ++last);
    }
  }
  CHECK(numbered >= 20);
}

TEST_CASE("every file named in a comment exists") {
  std::vector<fs::path> sources;
  std::string tree;  // the paths, one per line
  for (const char* folder : {"bench", "cmake", "docs", "examples", "generator", "lib", "templates", "tests"}) {
    for (const fs::path& file : files_below(root / folder)) {
      tree += "/" + fs::relative(file, root).generic_string() + "\n";
      if (file.extension() == ".cpp" || file.extension() == ".hpp") sources.push_back(file);
    }
  }
  static const std::regex comment("//.*"), name(R"(\b[\w/-]+\.(cpp|hpp|inc|md)\b)");
  std::size_t seen = 0;
  for (const fs::path& source : sources) {
    const std::string text = read_text(source);
    for (std::sregex_iterator line(text.begin(), text.end(), comment), end; line != end; ++line) {
      const std::string words = line->str();
      for (std::sregex_iterator at(words.begin(), words.end(), name); at != end; ++at, ++seen) {
        const std::string file = "/" + at->str();
        INFO(fs::relative(source, root).generic_string() << ": " << words);
        CHECK((file.find("NAME") != std::string::npos || tree.find(file + "\n") != std::string::npos ||
               tree.find(file + ".mustache\n") != std::string::npos));
      }
    }
  }
  CHECK(seen > 100);
}

TEST_CASE("the README shows the shipped model verbatim") {
  const std::string model = read_text(root / "models" / "P7_moving_sphere.toml");
  CHECK(read_text(root / "README.md").find("```toml\n" + model + "```\n") != std::string::npos);
}

TEST_CASE("docs/commands.md describes every command that has a schema, and every schema is linked") {
  const std::string text = read_text(root / "docs" / "commands.md");
  for (const fs::path& schema : files_below(root / "docs" / "schema", {".json"})) {
    if (schema.parent_path().filename() == "editor") continue;  // of files, not of a command's results
    const std::string file = schema.filename().string();
    CAPTURE(file);
    CHECK(text.find("(schema/" + file + ")") != std::string::npos);
    CHECK(text.find("## " + file.substr(0, file.find('.')) + "\n") != std::string::npos);
  }
}

TEST_CASE("scripts/setup installs the packages that docs/architecture.md lists") {
  const std::string setup = read_text(root / "scripts" / "setup");
  const std::string text = read_text(root / "docs" / "architecture.md");
  const std::size_t table = text.find("| package (Debian)");
  REQUIRE(table != std::string::npos);
  static const std::regex first_cell(R"(\n\| ([^|]+) \|)");
  const std::string rows = text.substr(table);
  std::size_t seen = 0;
  for (std::sregex_iterator at(rows.begin(), rows.end(), first_cell), end; at != end; ++at) {
    const std::string cell = (*at)[1];
    static const std::regex name("[^, ]+");
    for (std::sregex_iterator word(cell.begin(), cell.end(), name); word != end; ++word, ++seen) {
      CAPTURE(word->str());
      CHECK(std::regex_search(
          setup, std::regex("[ (]" + std::regex_replace(word->str(), std::regex(R"(\+)"), "\\+") + "[ )\n]")));
    }
  }
  CHECK(seen > 15);
}

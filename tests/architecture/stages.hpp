// In: the CMakeLists.txt of the generator's folders and the include lines of its files. Out: the allowed and the actual
// dependencies (docs/architecture.md, "the dependency rule").
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace architecture {

/// One call of eomgen_stage().
struct Stage {
  std::string name;
  std::string folder;  // of generator/
  std::vector<std::string> sources, needs, links;
};

/// Every argument list of `command(...)` in a CMake text without comments, split at blanks.
std::vector<std::vector<std::string>> cmake_calls(const std::string& text, const std::string& command);

/// The stages that one folder's CMakeLists.txt declares.
std::vector<Stage> parse_stages(const std::string& folder, const std::string& cmake_text);

/// An include line: the path, and whether it is in quotes.
struct Include {
  std::string path;
  bool quoted;
  int line;
};
std::vector<Include> parse_includes(const std::string& text);

/// Names of stages and external targets that `stage` reaches through NEEDS and LINKS, including itself.
std::set<std::string> reachable(const std::string& stage, const std::map<std::string, Stage>& stages);

std::string read_text(const std::filesystem::path& file);

/// Regular files below `folder`, sorted; only those with one of the endings, if any are given.
std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder,
                                               const std::set<std::string>& endings = {});

}  // namespace architecture

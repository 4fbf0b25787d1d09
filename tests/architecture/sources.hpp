// Files of the source tree and their include lines.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace architecture {

/// An include line: the path, and whether it is in quotes.
struct Include {
  std::string path;
  bool quoted;
  int line;
};
std::vector<Include> parse_includes(const std::string& text);

std::string read_text(const std::filesystem::path& file);

/// Regular files below `folder`, sorted; only those with one of the endings, if any are given.
std::vector<std::filesystem::path> files_below(const std::filesystem::path& folder,
                                               const std::set<std::string>& endings = {});

}  // namespace architecture

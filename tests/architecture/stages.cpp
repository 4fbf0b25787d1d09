#include "architecture/stages.hpp"

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace architecture {
namespace fs = std::filesystem;

std::string read_text(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<fs::path> files_below(const fs::path& folder, const std::set<std::string>& endings) {
  std::vector<fs::path> files;
  if (!fs::exists(folder)) return files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && (endings.empty() || endings.count(entry.path().extension().string()) == 1))
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::vector<std::string>> cmake_calls(const std::string& text, const std::string& command) {
  const std::string plain = std::regex_replace(text, std::regex("#[^\n]*"), "");
  const std::regex call(command + R"(\s*\(([^()]*)\))");
  std::vector<std::vector<std::string>> calls;
  for (std::sregex_iterator at(plain.begin(), plain.end(), call), end; at != end; ++at) {
    std::istringstream words((*at)[1].str());
    std::vector<std::string> arguments;
    for (std::string word; words >> word;) arguments.push_back(word);
    calls.push_back(arguments);
  }
  return calls;
}

std::vector<Stage> parse_stages(const std::string& folder, const std::string& cmake_text) {
  std::vector<Stage> stages;
  for (const std::vector<std::string>& arguments : cmake_calls(cmake_text, "eomgen_stage")) {
    if (arguments.empty()) throw std::runtime_error("eomgen_stage without a name in " + folder);
    Stage stage{arguments.front(), folder, {}, {}, {}};
    std::vector<std::string>* list = nullptr;
    for (auto word = arguments.begin() + 1; word != arguments.end(); ++word) {
      if (*word == "SOURCES")
        list = &stage.sources;
      else if (*word == "NEEDS")
        list = &stage.needs;
      else if (*word == "LINKS")
        list = &stage.links;
      else if (*word == "OWN_HEADERS" || *word == "UNOPTIMISED")
        continue;  // a compiler option, not a dependency
      else if (list == nullptr)
        throw std::runtime_error("eomgen_stage: what is " + *word + " in " + folder);
      else
        list->push_back(*word);
    }
    stages.push_back(stage);
  }
  return stages;
}

std::vector<Include> parse_includes(const std::string& text) {
  static const std::regex directive(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
  std::vector<Include> includes;
  std::istringstream lines(text);
  std::smatch match;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (std::regex_search(line, match, directive)) includes.push_back({match[2], match[1] == "\"", number});
  }
  return includes;
}

std::set<std::string> reachable(const std::string& stage, const std::map<std::string, Stage>& stages) {
  std::set<std::string> seen;
  std::vector<std::string> next{stage};
  while (!next.empty()) {
    const std::string name = next.back();
    next.pop_back();
    if (!seen.insert(name).second) continue;
    const auto found = stages.find(name);
    if (found == stages.end()) continue;
    next.insert(next.end(), found->second.needs.begin(), found->second.needs.end());
    for (const std::string& link : found->second.links) {
      // A stage may also be linked by its target's name.
      const bool is_stage = link.starts_with("eomgen_") && stages.count(link.substr(7)) == 1;
      next.push_back(is_stage ? link.substr(7) : link);
    }
  }
  return seen;
}

}  // namespace architecture

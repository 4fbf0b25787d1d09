// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/locate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <vector>

namespace eomgen::cli {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> model_folders() {
  std::vector<fs::path> folders;
  std::error_code ignored;  // an unreadable working directory only leaves fewer folders to look in
  if (const char* from_environment = std::getenv("EOMGEN_MODELS")) folders.emplace_back(from_environment);
  for (fs::path here = fs::current_path(ignored); !here.empty(); here = here.parent_path()) {
    folders.push_back(here / "models");
    if (here == here.root_path()) break;
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  if (!program.empty()) folders.push_back(program.parent_path().parent_path() / "share" / "eomgen" / "models");
  return folders;
}

std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitution});
    }
  }
  return row[b.size()];
}

std::string nearest(const std::string& name, const std::vector<fs::path>& folders) {
  std::string best;
  std::size_t least = name.size() / 2 + 1;
  for (const fs::path& folder : folders) {
    std::error_code error;
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    for (const std::string& candidate : names) {
      const bool begins = candidate.starts_with(name + "_");
      const std::size_t d = begins ? 0 : distance(name, candidate);
      if (d < least || (d == 0 && best.empty())) {
        least = d;
        best = candidate;
      }
    }
  }
  return best;
}

}  // namespace

std::string locate_model(const std::string& name) {
  std::error_code error;
  if (fs::exists(name, error)) return name;
  const std::vector<fs::path> folders = model_folders();
  if (name.find('/') == std::string::npos) {
    for (const fs::path& folder : folders) {
      for (const std::string& file : {name, name + ".toml"}) {
        if (fs::is_regular_file(folder / file, error)) return (folder / file).string();
      }
    }
  }
  const std::string hint = nearest(name, folders);
  throw Error("cli", Where{name, 0, 0, 1, ""}, "there is no such model file, nor a model of that name in models/",
              hint.empty() ? "eomgen new NAME writes a starter model" : fmt::format("did you mean {}?", hint));
}

model::Model load_model(const std::string& name) {
  model::Model model = model::read_model(locate_model(name));
  for (const Warning& warning : model.warnings) fmt::print(stderr, "{}", format_warning(warning));
  return model;
}

}  // namespace eomgen::cli

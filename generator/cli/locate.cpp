// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/locate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <vector>

#include "cli/output.hpp"
#include "model/names.hpp"

namespace eomgen::cli {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> model_folders() {
  std::vector<fs::path> folders;
  std::error_code ignored;  // an unreadable working directory only reduces the search path
  if (const char* from_environment = std::getenv("EOMGEN_MODELS")) folders.emplace_back(from_environment);
  for (fs::path here = fs::current_path(ignored); !here.empty(); here = here.parent_path()) {
    folders.push_back(here / "models");
    if (here == here.root_path()) break;
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  if (!program.empty()) folders.push_back(program.parent_path().parent_path() / "share" / "eomgen" / "models");
  return folders;
}

std::vector<std::string> models_in(const std::vector<fs::path>& folders) {
  std::vector<std::string> names;
  for (const fs::path& folder : folders) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// A file in the same folder whose name differs in a letter or two; empty if there is none.
std::string nearest_file(const fs::path& path) {
  std::vector<std::string> names;
  std::error_code none;
  for (const fs::directory_entry& entry :
       fs::directory_iterator(path.has_parent_path() ? path.parent_path() : fs::path("."), none)) {
    if (entry.path().extension() == ".toml" && entry.is_regular_file(none))
      names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  const std::string typed = path.filename().string();
  const auto found = [&](const std::string& name) {
    return name.empty() ? std::optional<std::string>() : model::nearest(name, names);
  };
  auto meant = found(typed);
  if (!meant && !path.has_extension()) meant = found(typed + ".toml");
  return meant ? (path.parent_path() / *meant).string() : "";
}

/// The closest model, as it would be typed; empty if there is none.
std::string nearest(const std::string& typed, const std::vector<fs::path>& folders) {
  const fs::path path(typed);
  if (const std::string file = nearest_file(path); !file.empty()) return file;
  const std::string name = path.extension() == ".toml" ? path.stem().string() : path.filename().string();
  const std::vector<std::string> names = models_in(path.has_parent_path() ? std::vector{path.parent_path()} : folders);
  std::string meant = model::nearest(name, names).value_or("");
  for (const std::string& candidate : names) {
    if (!name.empty() && candidate.starts_with(name + "_")) {  // P7 for P7_moving_sphere
      meant = candidate;
      break;
    }
  }
  return meant.empty() || !path.has_parent_path() ? meant : (path.parent_path() / (meant + ".toml")).string();
}

}  // namespace

std::string locate_model(const std::string& name) {
  std::error_code error;
  for (const std::string& file : {name, name + ".toml"}) {
    if (fs::exists(file, error) && !fs::is_directory(file, error)) return file;
  }
  const std::vector<fs::path> folders = model_folders();
  const fs::path typed(name);  // large/NAME is one of theirs, too
  if (typed.is_relative() && std::find(typed.begin(), typed.end(), "..") == typed.end()) {
    for (const fs::path& folder : folders) {
      for (const std::string& file : {name, name + ".toml"}) {
        if (fs::is_regular_file(folder / file, error)) return (folder / file).string();
      }
    }
  }
  if (fs::is_directory(name, error)) return name;  // the reader reports the error
  const std::string hint = nearest(name, folders);
  throw Error("cli", SourceLocation{name, 0, 0, 1, ""},
              "there is no such model file, nor a model of that name in models/",
              hint.empty() ? "eomgen new NAME writes a starter model" : fmt::format("did you mean {}?", hint));
}

std::string documentation_path(const std::string& page) {
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  for (fs::path folder = program.parent_path(); folder != folder.parent_path(); folder = folder.parent_path()) {
    if (const fs::path installed = folder / "share" / "doc" / "eomgen" / page; fs::is_regular_file(installed, none))
      return installed.string();
    if (const fs::path source = folder / "docs" / page; fs::is_regular_file(source, none)) return source.string();
  }
  return "docs/" + page;
}

void print_warnings(const model::Model& model) {
  for (const Warning& warning : model.warnings) print_message(format_warning(warning));
}

std::shared_ptr<const model::Model> load_model(const std::string& name, double* seconds) {
  const auto start = std::chrono::steady_clock::now();
  auto model = std::make_shared<const model::Model>(model::read_model(locate_model(name)));
  print_warnings(*model);
  if (seconds != nullptr) *seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return model;
}

}  // namespace eomgen::cli

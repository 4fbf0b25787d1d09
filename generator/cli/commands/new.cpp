// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cctype>
#include <filesystem>

#include "cli/commands/commands.hpp"
#include "cli/output.hpp"
#include "cli/starter_text.hpp"

namespace eomgen::cli::new_command {
namespace {

struct Options {
  std::string name;
};

void require_name(const std::string& name) {
  const auto fine = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
  const bool valid = !name.empty() && name.size() <= 64 && std::isalpha(static_cast<unsigned char>(name.front())) &&
                     std::all_of(name.begin(), name.end(), fine);
  if (valid) return;
  throw Error("new", {}, "a model's name has letters, digits, _ and -, at most 64, and starts with a letter",
              "eomgen new my_pendulum");
}

int execute(const Options& options, const CommonOptions& common) {
  require_name(options.name);
  const std::string file = options.name + ".toml";
  std::error_code none;
  if (std::filesystem::exists(std::filesystem::symlink_status(file, none))) {
    throw Error("new", SourceLocation{file, 0, 0, 1, ""}, "this file exists already",
                "choose another name, or remove the file");
  }
  std::string text = starter_text;
  for (std::size_t at; (at = text.find("NAME.")) != std::string::npos;) text.replace(at, 4, options.name);
  write_text(file, text);
  if (common.json) {
    print_document(Json{{"format", 1}, {"file", file}});
  } else {
    fmt::print("wrote {}\n", file);
  }
  return 0;
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<Options>();
  app.add_option("NAME", options->name, "name of the model; NAME.toml is written here").required();
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::new_command

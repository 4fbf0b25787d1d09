// SPDX-License-Identifier: GPL-3.0-or-later
// Command manual: manual pages generated from the declared options, as roff with the macros of man(7).
#include <fmt/format.h>

#include <algorithm>

#include "cli/commands/commands.hpp"
#include "cli/declared_text.hpp"
#include "cli/output.hpp"
#include "cli/report_skeletons/manual_page.hpp"
#include "cli/usage.hpp"
#include "model/names.hpp"

namespace eomgen::cli::manual_command {
namespace {

struct Options {
  std::string command, folder;
};

/// Escapes text for man(7): keeps hyphens of options, prevents requests and escapes.
std::string roff(const std::string& text) {
  std::string result = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (const char c : text) {
    if (c == '\\' || c == '-') result += '\\';
    result += c == '\\' ? 'e' : c == '\n' ? ' ' : c;
  }
  return result;
}

int execute(const Options& options, const CommonOptions& common) {
  const Declaration declared("eomgen", commands());
  std::vector<std::string> chosen{options.command};  // "": the page of the whole program
  const std::vector<std::string> names = declared.names();
  if (options.command.empty() && !options.folder.empty()) chosen.insert(chosen.end(), names.begin(), names.end());
  std::vector<emit::EmittedFile> pages;
  for (const std::string& name : chosen)
    pages.push_back({name.empty() ? "eomgen.1" : "eomgen-" + name + ".1",
                     render_declared(report::manual_page, declared, roff, name)});
  if (!options.command.empty() && std::find(names.begin(), names.end(), options.command) == names.end()) {
    throw Error("usage", {}, fmt::format("there is no command {}", model::quote(options.command)),
                suggest_choice(options.command, names));
  }
  if (options.folder.empty()) {
    print_result(common.json, {{"format", 1}, {"page", pages.front().name}, {"roff", pages.front().text}},
                 pages.front().text);
    return 0;
  }
  require_folder(options.folder);
  const std::vector<std::string> files = write_results(options.folder, pages, "");
  if (common.json) {
    print_document(Json{{"format", 1}, {"files", files}});
  } else {
    for (const std::string& file : files) fmt::print("wrote {}\n", file);
  }
  return 0;
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<Options>();
  app.add_option("COMMAND", options->command, "a command; without it the page of the whole program");
  app.add_output_path("-o,--out", options->folder, "a folder for the pages, all of them without COMMAND");
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::manual_command

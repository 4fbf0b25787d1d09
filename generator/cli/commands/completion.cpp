// SPDX-License-Identifier: GPL-3.0-or-later
// Command completion: shell completion of commands, options, and option values from registries.
#include <fmt/format.h>

#include "cli/commands/commands.hpp"
#include "cli/declared_text.hpp"
#include "cli/output.hpp"
#include "cli/report_skeletons/completion_bash.hpp"
#include "cli/report_skeletons/completion_fish.hpp"
#include "cli/report_skeletons/completion_zsh.hpp"
#include "cli/usage.hpp"
#include "model/names.hpp"

namespace eomgen::cli::completion_command {
namespace {

/// Escapes an apostrophe for single quotes.
std::string quoted(std::string text, std::string_view apostrophe) {
  for (std::size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += apostrophe.size())
    text.replace(at, 1, apostrophe);
  return text;
}

/// Escapes a description for [..] of _arguments, in single quotes.
std::string for_zsh(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c;
  }
  return quoted(result, "'\\''");
}

std::string for_fish(const std::string& text) { return quoted(text, "\\'"); }
std::string for_bash(const std::string& text) { return text; }

struct Shell {
  const char *name, *script;
  std::string (*escape)(const std::string&);
};
constexpr Shell shells[] = {{"bash", report::completion_bash, for_bash},
                            {"zsh", report::completion_zsh, for_zsh},
                            {"fish", report::completion_fish, for_fish}};

int execute(const std::string& name, const CommonOptions& common) {
  std::vector<std::string> known;
  for (const Shell& shell : shells) {
    known.emplace_back(shell.name);
    if (name != shell.name) continue;
    const std::string script = render_declared(shell.script, Declaration("eomgen", commands()), shell.escape);
    if (common.json) {
      print_document(Json{{"format", 1}, {"shell", name}, {"script", script}});
    } else {
      fmt::print("{}", script);
    }
    return 0;
  }
  throw Error("usage", {}, fmt::format("there is no completion for {}", model::quote(name)),
              suggest_choice(name, known));
}

}  // namespace

Execute declare(Arguments& app) {
  auto name = std::make_shared<std::string>();
  app.add_option("SHELL", *name, "bash, zsh or fish").required();
  return [name](const CommonOptions& common) { return execute(*name, common); };
}

}  // namespace eomgen::cli::completion_command

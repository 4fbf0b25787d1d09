// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/usage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "cli/locate.hpp"

namespace eomgen::cli {
namespace {

/// Names of commands in other programs.
// clang-format off
constexpr std::pair<const char*, const char*> other_words[] = {
    {"simulate", "run"}, {"sim", "run"}, {"integrate", "run"}, {"solve", "run"}, {"plot", "run"}, {"init", "new"},
    {"create", "new"}, {"start", "new"}, {"generate", "emit"}, {"codegen", "emit"}, {"compile", "emit"},
    {"export", "emit"}, {"latex", "emit"}, {"equations", "derive"}, {"eom", "derive"}, {"show", "derive"},
    {"print", "derive"}, {"validate", "check"}, {"lint", "check"}, {"info", "check"}, {"test", "verify"},
    {"prove", "verify"}, {"benchmark", "bench"}, {"scan", "sweep"}, {"grid", "sweep"}, {"eigenvalues", "linearize"},
    {"linearise", "linearize"}, {"stability", "equilibria"}, {"equilibrium", "equilibria"}, {"html", "report"},
    {"models", "list"}, {"ls", "list"}, {"solvers", "list"}};
// clang-format on

}  // namespace

void require_command(std::span<char* const> words, const std::vector<std::string>& commands) {
  if (words.size() < 2 || words[1][0] == '-') return;
  const std::string word = words[1];
  if (std::find(commands.begin(), commands.end(), word) != commands.end()) return;
  std::error_code none;
  if (word.ends_with(".toml") || std::filesystem::is_regular_file(word, none)) {
    throw Error("usage", {}, fmt::format("a command is missing before {}", model::quote(word)),
                fmt::format("eomgen check {0} describes the model, eomgen derive {0} shows its equations, eomgen "
                            "run {0} integrates it",
                            word));
  }
  std::string hint = suggest_choice(word, commands);
  for (const auto& [other, meant] : other_words) {
    if (word == other) hint = fmt::format("did you mean '{}'? {}", meant, hint);
  }
  throw Error("usage", {}, fmt::format("there is no command {}", model::quote(word)), hint);
}

std::vector<std::string> expand_help(std::span<char* const> words) {
  std::vector<std::string> result(words.begin(), words.end());
  if (result.size() < 2 || result[1] != "help") return result;
  result.erase(result.begin() + 1);
  if (result.size() > 2) result.resize(2);
  result.emplace_back("--help");
  return result;
}

}  // namespace eomgen::cli

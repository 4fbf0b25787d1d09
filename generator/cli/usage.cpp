// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/usage.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "cli/locate.hpp"
#include "model/names.hpp"

namespace eomgen::cli {
namespace {

template <typename Accept>
CLI::Validator number(const char* what, Accept accept) {
  return {[what, accept](std::string& text) {
            double value = 0;
            const bool fine = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && accept(value);
            return fine ? std::string() : fmt::format("{} is not {}", model::quote(text), what);
          },
          ""};
}

/// What others call it.
constexpr std::pair<const char*, const char*> other_words[] = {{"simulate", "run"},
                                                               {"sim", "run"},
                                                               {"integrate", "run"},
                                                               {"solve", "run"},
                                                               {"plot", "run"},
                                                               {"init", "new"},
                                                               {"create", "new"},
                                                               {"start", "new"},
                                                               {"generate", "emit"},
                                                               {"codegen", "emit"},
                                                               {"compile", "emit"},
                                                               {"export", "emit"},
                                                               {"latex", "emit"},
                                                               {"equations", "derive"},
                                                               {"eom", "derive"},
                                                               {"show", "derive"},
                                                               {"print", "derive"},
                                                               {"validate", "check"},
                                                               {"lint", "check"},
                                                               {"info", "check"},
                                                               {"test", "verify"},
                                                               {"prove", "verify"},
                                                               {"benchmark", "bench"},
                                                               {"scan", "sweep"},
                                                               {"grid", "sweep"},
                                                               {"eigenvalues", "linearize"},
                                                               {"linearise", "linearize"},
                                                               {"stability", "equilibria"},
                                                               {"equilibrium", "equilibria"},
                                                               {"html", "report"},
                                                               {"models", "list"},
                                                               {"ls", "list"},
                                                               {"solvers", "list"}};

// The command whose options were being read; the program itself before there is one.
const CLI::App& where(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? app : *parsed.front();
}

std::vector<std::string> flags_of(const CLI::App& app) {
  std::vector<std::string> flags;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) flags.push_back("--" + name);
    for (const std::string& name : option->get_snames()) flags.push_back("-" + name);
  }
  return flags;
}

Error unexpected(const CLI::App& app) {
  const std::string help =
      fmt::format("{} --help lists what there is", app.get_parent() == nullptr ? "eomgen" : "eomgen " + app.get_name());
  std::vector<std::string> extra = app.remaining();
  const auto option =
      std::find_if(extra.begin(), extra.end(), [](const std::string& word) { return word.starts_with("-"); });
  if (option == extra.end()) {
    return Error("usage", {},
                 fmt::format("{} is one word too many", extra.empty() ? "there" : model::quote(extra.back())), help);
  }
  const std::string name = option->substr(0, option->find('='));
  // Letters are near to every other letter: one stands for a longer name that begins with it.
  const bool letter = name.size() == 2;
  std::string hint = letter ? "" : model::did_you_mean(name, flags_of(app));
  const auto begins = [&](const std::string& flag) {
    return flag == name || (letter && flag.size() > 2 && flag[2] == name[1]);
  };
  for (const std::string& flag : flags_of(app)) {
    if (hint.empty() && begins(flag)) hint = fmt::format("did you mean '{}'?", flag);
  }
  if (app.get_parent() != nullptr) {
    for (const std::string& flag : flags_of(*app.get_parent())) {
      if (hint.empty() && begins(flag)) hint = fmt::format("did you mean 'eomgen {}'?", flag);
    }
  }
  return Error("usage", {}, fmt::format("there is no option {}", model::quote(name)),
               hint.empty() ? help : hint + " " + help);
}

}  // namespace

CLI::Validator finite_number() {
  return number("a number", [](double) { return true; });
}
CLI::Validator positive_number() {
  return number("a number greater than 0", [](double value) { return value > 0; });
}
CLI::Validator number_not_negative() {
  return number("a number, 0 or greater", [](double value) { return value >= 0; });
}

CLI::Validator whole_number(unsigned long long least, unsigned long long most) {
  return {[least, most](std::string& text) {
            const bool digits =
                !text.empty() && text.size() <= 19 && text.find_first_not_of("0123456789") == std::string::npos;
            const unsigned long long value = digits ? std::stoull(text) : 0;
            if (digits && value >= least && value <= most) return std::string();
            return fmt::format("{} is not a whole number from {} to {}", model::quote(text), least, most);
          },
          ""};
}

CLI::Option* add_place(CLI::App& app, const std::string& flags, std::string& target, const std::string& help) {
  const auto named = [](const std::string& path) {
    return path.empty() ? std::string("'' names no file; - is standard output") : std::string();
  };
  return app.add_option(flags, target, help)->check(CLI::Validator(named, ""));
}

CLI::Option* add_list(CLI::App& app, const std::string& flag, std::vector<std::string>& target, const std::string& help,
                      char delimiter) {
  return app.add_option(flag, target, help)->delimiter(delimiter)->allow_extra_args(false);
}

void require_command(std::span<char* const> words, const std::vector<std::string>& commands) {
  if (words.size() < 2 || words[1][0] == '-') return;
  const std::string word = words[1];
  if (std::find(commands.begin(), commands.end(), word) != commands.end()) return;
  std::error_code none;
  if (word.ends_with(".toml") || std::filesystem::is_regular_file(word, none)) {
    throw Error("usage", {}, fmt::format("a command is missing before {}", model::quote(word)),
                fmt::format("eomgen check {0} says what the model is, eomgen derive {0} shows its equations, eomgen "
                            "run {0} integrates it",
                            word));
  }
  std::string hint = choice_of(word, commands);
  for (const auto& [other, meant] : other_words) {
    if (word == other) hint = fmt::format("did you mean '{}'? {}", meant, hint);
  }
  throw Error("usage", {}, fmt::format("there is no command {}", model::quote(word)), hint);
}

std::vector<std::string> with_help(std::span<char* const> words) {
  std::vector<std::string> result(words.begin(), words.end());
  if (result.size() < 2 || result[1] != "help") return result;
  result.erase(result.begin() + 1);
  if (result.size() > 2) result.resize(2);
  result.emplace_back("--help");
  return result;
}

std::string HelpPage::make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const {
  const std::string page = CLI::Formatter::make_help(app, std::move(name), mode);
  if (app->get_parent() != nullptr) return page + fmt::format("\nMore: {}\n", documentation("commands.md"));
  constexpr const char* examples =
      "Examples:\n"
      "  eomgen new pendulum                               a commented model to start from: pendulum.toml\n"
      "  eomgen derive pendulum.toml                       its equations of motion\n"
      "  eomgen run pendulum.toml --out pendulum.csv       its motion, as a table\n\n";
  return examples + page +
         fmt::format("\nDocumentation: {}; the format of models: {}\n", documentation("commands.md"),
                     documentation("model-format.md"));
}

Error usage_error(const CLI::ParseError& error, const CLI::App& app) {
  const CLI::App& command = where(app);
  const std::string name = command.get_parent() == nullptr ? "eomgen" : "eomgen " + command.get_name();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) return unexpected(command);
  std::string what = error.what();
  if (what == "A subcommand is required") what = "a command is missing";
  return Error("usage", {}, what, name + " --help tells how it is used");
}

}  // namespace eomgen::cli

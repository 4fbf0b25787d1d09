// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/declaration.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include "cli/locate.hpp"
#include "cli/usage.hpp"
#include "cli/version.hpp"
#include "model/names.hpp"

namespace eomgen::cli {
namespace {

// The command whose options are parsed; the program itself if there is none yet.
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
                 fmt::format("unexpected argument{}", extra.empty() ? "" : " " + model::quote(extra.back())), help);
  }
  const std::string name = option->substr(0, option->find('='));
  // A single letter is close to every other one. It only matches a longer name that begins with it.
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

/// Text of `eomgen --help`: three examples, the commands, the path of the documentation.
class HelpPage : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    const std::string page = CLI::Formatter::make_help(app, std::move(name), mode);
    if (app->get_parent() != nullptr) return page + fmt::format("\nMore: {}\n", documentation_path("commands.md"));
    constexpr const char* examples =
        "Examples:\n"
        "  eomgen new pendulum                               a commented model to start from: pendulum.toml\n"
        "  eomgen derive pendulum.toml                       its equations of motion\n"
        "  eomgen run pendulum.toml --out pendulum.csv       its motion, as a table\n\n";
    return examples + page +
           fmt::format("\nDocumentation: {}; the format of models: {}\n", documentation_path("commands.md"),
                       documentation_path("model-format.md"));
  }
};

/// Converts an error of CLI11 to Error.
Error usage_error(const CLI::ParseError& error, const CLI::App& app) {
  const CLI::App& command = where(app);
  const std::string name = command.get_parent() == nullptr ? "eomgen" : "eomgen " + command.get_name();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) return unexpected(command);
  std::string what = error.what();
  if (what == "A subcommand is required") what = "a command is missing";
  return Error("usage", {}, what, name + " --help shows how it is used");
}

}  // namespace

struct Declaration::Parser {
  Parser(const char* name) : app("eomgen: equations of motion of mechanical systems, from a text model", name) {}

  CLI::App app;
  std::map<const CLI::App*, std::function<int(const CommonOptions&)>> actions;
  SuggestedValues words;
};

std::vector<std::string> DeclaredCommand::flags() const {
  std::vector<std::string> result;
  for (const DeclaredOption& option : options) result.insert(result.end(), option.flags.begin(), option.flags.end());
  return result;
}

Declaration::Declaration(const char* name, std::span<const Command> commands)
    : parser_(std::make_unique<Parser>(name)) {
  CLI::App& app = parser_->app;
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  app.formatter(std::make_shared<HelpPage>());
  for (const Command& command : commands) {
    CLI::App* sub = app.add_subcommand(command.name, command.summary);
    Arguments arguments(*sub, parser_->words);
    arguments.add_flag("--json", common.json, "one JSON document instead of readable output");
    arguments.add_option("--seed", common.seed, "fixes every random choice")
        .check(whole_number(0, 999'999'999'999'999))
        .show_default();
    parser_->actions[sub] = command.declare(arguments);
  }
}

Declaration::~Declaration() = default;

std::vector<std::string> Declaration::names() const {
  std::vector<std::string> result;
  for (const CLI::App* sub : parser_->app.get_subcommands({})) result.push_back(sub->get_name());
  return result;
}

std::vector<DeclaredCommand> Declaration::commands() const {
  std::vector<DeclaredCommand> result;
  for (const CLI::App* sub : parser_->app.get_subcommands({})) {
    DeclaredCommand command{sub->get_name(), sub->get_description(), {}};
    for (const CLI::Option* option : sub->get_options()) {
      DeclaredOption one;
      for (const std::string& name : option->get_snames()) one.flags.push_back("-" + name);
      for (const std::string& name : option->get_lnames()) one.flags.push_back("--" + name);
      if (option->get_positional()) {
        one.argument = option->get_name();
      } else if (option->get_items_expected_max() > 0) {
        one.argument = option->get_type_name();
      }
      one.help = option->get_description();
      one.default_value = option->get_default_str();
      one.takes_list = option->get_delimiter() != '\0';
      if (const auto words = parser_->words.find(option); words != parser_->words.end())
        one.allowed_values = words->second;
      command.options.push_back(std::move(one));
    }
    result.push_back(std::move(command));
  }
  return result;
}

std::optional<int> Declaration::read(std::span<char* const> typed) {
  std::vector<std::string> words = expand_help(typed);
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  require_command(pointers, names());
  try {
    parser_->app.parse(static_cast<int>(pointers.size()), pointers.data());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return parser_->app.exit(error);  // --help, --version
    throw usage_error(error, parser_->app);
  }
  return std::nullopt;
}

int Declaration::execute() const { return parser_->actions.at(parser_->app.get_subcommands().front())(common); }

}  // namespace eomgen::cli

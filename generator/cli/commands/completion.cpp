// SPDX-License-Identifier: GPL-3.0-or-later
// Command completion: shell completion of commands, options, and option values from registries.
#include <fmt/format.h>

#include "cli/commands/commands.hpp"
#include "cli/declaration.hpp"
#include "cli/output.hpp"
#include "cli/usage.hpp"
#include "model/names.hpp"

namespace eomgen::cli::completion_command {
namespace {

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

// Completes the values of an option if they are known (in a list, after the last comma), options after `-`, and
// otherwise models, tables and folders.
std::string bash(const Declaration& declared) {
  std::string flags, words;
  for (const DeclaredCommand& sub : declared.commands()) {
    const std::string name = sub.name;
    flags += fmt::format("    {}) flags=\"{}\" ;;\n", name, joined(sub.flags()));
    for (const DeclaredOption& option : sub.options) {
      for (const std::string& flag : option.allowed_values.empty() ? std::vector<std::string>{} : option.flags)
        words += fmt::format("    \"{} {}\") words=\"{}\" ;;\n", name, flag, joined(option.allowed_values));
    }
  }
  return fmt::format(
      R"bash(# Completions of eomgen for bash; source it, or put it into a folder of bash-completion.
_eomgen() {{
  local word="${{COMP_WORDS[COMP_CWORD]}}" before="${{COMP_WORDS[COMP_CWORD-1]}}" command="${{COMP_WORDS[1]}}"
  local flags="" words="" typed
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "{} help --help --version" -- "$word")
    return
  fi
  case $command in
{}    help) words="{}" ;;
    completion) words="bash zsh fish" ;;
    manual) words="{}" ;;
  esac
  case "$command $before" in
{}  esac
  if [[ $word == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$flags" -- "$word")
  elif [[ -n $words ]]; then
    typed="${{word##*,}}"
    mapfile -t COMPREPLY < <(compgen -P "${{word%"$typed"}}" -W "$words" -- "$typed")
  else
    mapfile -t COMPREPLY < <(compgen -f -X '!*.@(toml|csv|npz)' -- "$word"; compgen -d -- "$word")
  fi
}}
shopt -s extglob
complete -o filenames -F _eomgen eomgen
)bash",
      joined(declared.names()), flags, joined(declared.names()), joined(declared.names()), words);
}

/// Escapes text for single quotes of zsh and fish.
std::string quoted(std::string text, const char* apostrophe) {
  for (std::size_t at = 0; (at = text.find('\'', at)) != std::string::npos; at += std::string_view(apostrophe).size())
    text.replace(at, 1, apostrophe);
  return "'" + text + "'";
}

/// Escapes a description for [..] of _arguments.
std::string in_brackets(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

std::string zsh(const Declaration& declared) {
  std::string commands, cases;
  for (const DeclaredCommand& sub : declared.commands()) {
    commands += "    " + quoted(sub.name + ":" + in_brackets(sub.summary), "'\\''") + "\n";
    cases += fmt::format("    {})\n      _arguments", sub.name);
    for (const DeclaredOption& option : sub.options) {
      for (const std::string& flag : option.flags) {
        std::string value;
        if (option.takes_list && !option.allowed_values.empty()) {
          value = fmt::format(":value:_values -s , value {}", joined(option.allowed_values));
        } else if (!option.allowed_values.empty()) {
          value = fmt::format(":value:({})", joined(option.allowed_values));
        } else if (!option.argument.empty()) {
          value = ":value:_files";
        }
        cases += " \\\n        " + quoted(fmt::format("*{}[{}]{}", flag, in_brackets(option.help), value), "'\\''");
      }
    }
    cases += " \\\n        '*:file:_files' ;;\n";
  }
  return fmt::format(
      "#compdef eomgen\n# What zsh completes after eomgen; put into a folder of $fpath as _eomgen.\n_eomgen() {{\n"
      "  local -a commands=(\n{}  )\n  if ((CURRENT == 2)); then\n    _describe command commands\n    return\n  fi\n"
      "  local command=$words[2]\n  shift words\n  ((CURRENT--))\n  case $command in\n{}  esac\n}}\n_eomgen \"$@\"\n",
      commands, cases);
}

std::string fish(const Declaration& declared) {
  std::string text = "# Completions of eomgen for fish; put it into a folder of $fish_complete_path as eomgen.fish.\n";
  for (const DeclaredCommand& sub : declared.commands()) {
    text += fmt::format("complete -c eomgen -n __fish_use_subcommand -f -a {} -d {}\n", sub.name,
                        quoted(sub.summary, "\\'"));
  }
  for (const DeclaredCommand& sub : declared.commands()) {
    for (const DeclaredOption& option : sub.options) {
      if (option.flags.empty()) continue;
      text += fmt::format("complete -c eomgen -n '__fish_seen_subcommand_from {}'", sub.name);
      for (const std::string& flag : option.flags)
        text += flag.starts_with("--") ? " -l " + flag.substr(2) : " -s " + flag.substr(1);
      if (!option.allowed_values.empty()) {
        text += fmt::format(" -x -a '{}'", joined(option.allowed_values));
      } else if (!option.argument.empty()) {
        text += " -r";
      }
      text += fmt::format(" -d {}\n", quoted(option.help, "\\'"));
    }
  }
  return text;
}

struct Shell {
  const char* name;
  std::string (*script)(const Declaration&);
};
constexpr Shell shells[] = {{"bash", bash}, {"zsh", zsh}, {"fish", fish}};

int execute(const std::string& name, const CommonOptions& common) {
  std::vector<std::string> known;
  for (const Shell& shell : shells) {
    known.emplace_back(shell.name);
    if (name != shell.name) continue;
    const std::string script = shell.script(Declaration("eomgen", commands()));
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

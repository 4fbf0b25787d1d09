// SPDX-License-Identifier: GPL-3.0-or-later
// Command manual: manual pages generated from the declared options, as roff with the macros of man(7).
#include <fmt/format.h>

#include "cli/commands/commands.hpp"
#include "cli/declaration.hpp"
#include "cli/output.hpp"
#include "cli/usage.hpp"
#include "model/names.hpp"

namespace eomgen::cli::manual_command {
namespace {

struct Options {
  std::string command, folder;
};

/// Escapes text for man(7): keeps hyphens of options, prevents requests and escapes.
std::string roff(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else if (c == '\n') {
      result += ' ';
    } else if ((c == '.' || c == '\'') && result.empty()) {
      result += "\\&";
      result += c;
    } else {
      result += c;
    }
  }
  return result;
}

std::string head(const std::string& page, const std::string& summary) {
  std::string upper = page;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return fmt::format(".TH {} 1 \"\" \"{}\" \"User Commands\"\n.SH NAME\n{} \\- {}\n", roff(upper), EOMGEN_VERSION,
                     roff(page), roff(summary));
}

std::string tail() {
  std::string text = ".SH EXIT STATUS\n";
  constexpr std::pair<int, const char*> codes[] = {
      {0, "done; also when an event that is to stop a run ends it"},
      {1, "a check came out negative"},
      {2, "bad input or usage, or a place that cannot be written to"},
      {3, "a run failed numerically, or a command was interrupted; what was computed is kept and marked"},
      {4, "a tool that is needed is missing or failed, or a disk or a pipe failed half-way"}};
  for (const auto& [code, meaning] : codes) text += fmt::format(".TP\n.B {}\n{}\n", code, roff(meaning));
  text += ".SH ENVIRONMENT\n";
  constexpr std::pair<const char*, const char*> variables[] = {
      {"EOMGEN_MODELS", "a folder of models that are found by name"},
      {"EOMGEN_CC", "the C compiler of what is integrated; else CC, cc or gcc"},
      {"EOMGEN_CACHE_DIR", "the folder of compiled code and certificates; else eomgen in the user's cache folder"}};
  for (const auto& [name, meaning] : variables) text += fmt::format(".TP\n.B {}\n{}\n", name, roff(meaning));
  return text;
}

std::string option_text(const DeclaredOption& option) {
  std::string flags;
  for (const std::string& flag : option.flags)
    flags += fmt::format("{}\\fB{}\\fR", flags.empty() ? "" : ", ", roff(flag));
  if (option.flags.empty()) flags = fmt::format("\\fI{}\\fR", roff(option.argument));
  if (!option.flags.empty() && !option.argument.empty()) flags += fmt::format(" \\fI{}\\fR", roff(option.argument));
  std::string text = fmt::format(".TP\n{}\n{}\n", flags, roff(option.help));
  if (!option.default_value.empty()) text += fmt::format("(without it: {})\n", roff(option.default_value));
  return text;
}

std::string page_of(const DeclaredCommand& command, const std::string& documentation_path) {
  const std::string page = "eomgen-" + command.name;
  std::string arguments, options;
  for (const DeclaredOption& option : command.options) {
    if (option.flags.empty()) arguments += fmt::format(" \\fI{}\\fR", roff(option.argument));
    options += option_text(option);
  }
  return head(page, command.summary) +
         fmt::format(".SH SYNOPSIS\n\\fBeomgen {}\\fR{} [\\fIoptions\\fR]\n.SH OPTIONS\n{}", roff(command.name),
                     arguments, options) +
         tail() +
         fmt::format(".SH SEE ALSO\n.BR eomgen (1)\n.PP\nThe whole documentation: {}\n", roff(documentation_path));
}

std::string page_of_all(const Declaration& declared, const std::string& documentation_path) {
  std::string text = head("eomgen", "equations of motion of mechanical systems, from a text model");
  text += ".SH SYNOPSIS\n\\fBeomgen\\fR \\fICOMMAND\\fR \\fIMODEL\\fR [\\fIoptions\\fR]\n.SH DESCRIPTION\n";
  text +=
      "A short text file describes a mechanical system. eomgen derives its equations of motion, holds them against an "
      "independent oracle, shows them, writes C and C++, integrates, and reports how large the error is.\n.PP\nMODEL "
      "is "
      "a "
      "path, or the name of a model in a folder of models.\n.SH COMMANDS\n";
  std::string also;
  for (const DeclaredCommand& sub : declared.commands()) {
    text += fmt::format(".TP\n.B {}\n{}\n", roff(sub.name), roff(sub.summary));
    also += fmt::format("{}.BR eomgen\\-{} (1)", also.empty() ? "" : ",\n", roff(sub.name));
  }
  return text + tail() +
         fmt::format(".SH SEE ALSO\n{}\n.PP\nThe whole documentation: {}\n", also, roff(documentation_path));
}

int execute(const Options& options, const CommonOptions& common) {
  const Declaration declared("eomgen", commands());
  const std::string where =
      "commands.md and model-format.md among the installed documents; eomgen --help prints their location";
  std::vector<emit::EmittedFile> pages;
  if (options.command.empty()) pages.push_back({"eomgen.1", page_of_all(declared, where)});
  bool found = options.command.empty();
  for (const DeclaredCommand& sub : declared.commands()) {
    if (!options.command.empty() && sub.name != options.command) continue;
    found = true;
    if (!options.command.empty() || !options.folder.empty())
      pages.push_back({"eomgen-" + sub.name + ".1", page_of(sub, where)});
  }
  if (!found) {
    throw Error("usage", {}, fmt::format("there is no command {}", model::quote(options.command)),
                suggest_choice(options.command, declared.names()));
  }
  if (options.folder.empty()) {
    if (common.json) {
      print_document(Json{{"format", 1}, {"page", pages.front().name}, {"roff", pages.front().text}});
    } else {
      fmt::print("{}", pages.front().text);
    }
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

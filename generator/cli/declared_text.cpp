// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/declared_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <kainjow/mustache.hpp>
#include <stdexcept>

#include "emit/template_data.hpp"

namespace eomgen::cli {
namespace {

using kainjow::mustache::data;

std::string joined(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, " ")); }

data described(const DeclaredOption& option) {
  data flags{data::type::list};
  for (const std::string& flag : option.flags) {
    const bool is_long = flag.starts_with("--");
    flags << emit::template_object({{"flag", flag},
                                    {"more", &flag != &option.flags.back() ? "true" : ""},
                                    {is_long ? "long" : "short", flag.substr(is_long ? 2 : 1)}});
  }
  data result = emit::template_object({{"argument", option.argument},
                                       {"help", option.help},
                                       {"default", option.default_value},
                                       {"values", joined(option.allowed_values)},
                                       {"takes_list", option.takes_list ? "true" : ""},
                                       {"has_flags", option.flags.empty() ? "" : "true"}});
  result.set("flags", flags);
  return result;
}

data described(const DeclaredCommand& command) {
  std::string upper = command.name;
  std::transform(upper.begin(), upper.end(), upper.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  data options{data::type::list};
  for (const DeclaredOption& option : command.options) options << described(option);
  data result = emit::template_object({{"name", command.name},
                                       {"upper_name", upper},
                                       {"summary", command.summary},
                                       {"all_flags", joined(command.flags())}});
  result.set("options", options);
  return result;
}

}  // namespace

std::string render_declared(const char* text_template, const Declaration& declared,
                            const std::function<std::string(const std::string&)>& escape, const std::string& selected) {
  data all = emit::template_object({{"version", EOMGEN_VERSION}, {"names", joined(declared.names())}}),
       list{data::type::list};
  const std::vector<DeclaredCommand> commands = declared.commands();
  for (const DeclaredCommand& command : commands) {
    data entry = described(command);
    if (command.name == selected) all.set("selected", entry);
    if (&command != &commands.back()) entry.set("comma", true);
    list << entry;
  }
  all.set("commands", list);
  kainjow::mustache::mustache text{std::string(text_template)};
  if (!text.is_valid()) throw std::logic_error(text.error_message());
  text.set_custom_escape(escape);
  // A section that is left out leaves an empty line.
  std::string result = text.render(all);
  const auto both = [](char a, char b) { return a == '\n' && b == '\n'; };
  result.erase(std::unique(result.begin(), result.end(), both), result.end());
  return result;
}

}  // namespace eomgen::cli

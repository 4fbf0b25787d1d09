// SPDX-License-Identifier: GPL-3.0-or-later
// Names of one file, declared in its anonymous namespace. With EOMGEN_UNITY the files of a target are compiled as one,
// so that two of them may not declare the same name, except for overloads and equal aliases.
#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "architecture/sources.hpp"
#include "support/folders.hpp"

namespace fs = std::filesystem;

namespace {

/// A declared name, and what another file may not declare beside it: the same parameter types, another alias, anything.
struct LocalName {
  std::string name, signature;
};

/// The code without comments, texts and lines of the preprocessor.
std::string without_texts(const std::string& code) {
  std::string result;
  for (std::size_t i = 0; i < code.size();) {
    const auto skip_behind = [&](const std::string& end) {
      const std::size_t at = code.find(end, i);
      i = at == std::string::npos ? code.size() : at + end.size();
    };
    const bool begins_line = i == 0 || code[i - 1] == '\n';
    const bool is_digit_separator =
        code[i] == '\'' && i > 0 && std::isalnum(static_cast<unsigned char>(code[i - 1])) != 0;
    if (code.compare(i, 2, "//") == 0 || (begins_line && code[i] == '#')) {
      i = std::min(code.find('\n', i), code.size());
    } else if (code.compare(i, 2, "R\"") == 0) {
      const std::size_t open = code.find('(', i);
      skip_behind(")" + code.substr(i + 2, open - i - 2) + "\"");
    } else if ((code[i] == '"' || code[i] == '\'') && !is_digit_separator) {
      const char quote = code[i];
      for (++i; i < code.size() && code[i] != quote; ++i) i += code[i] == '\\' ? 1 : 0;
      ++i;
    } else {
      result += code[i++];
    }
  }
  return result;
}

/// The text behind `begin` up to the brace that closes it.
std::string in_braces(const std::string& text, std::size_t begin) {
  int depth = 1;
  std::size_t end = begin;
  for (; end < text.size() && depth > 0; ++end) depth += text[end] == '{' ? 1 : text[end] == '}' ? -1 : 0;
  return text.substr(begin, end - begin - 1);
}

/// The statements of a namespace, without the bodies of functions and types.
std::vector<std::string> statements(const std::string& text) {
  std::vector<std::string> result{""};
  int depth = 0;
  for (const char c : text) {
    if (c == '{') ++depth;
    if (depth == 0 && c != ';') result.back() += c;
    if (c == '}') --depth;
    if (depth == 0 && (c == ';' || c == '}')) result.emplace_back();
  }
  return result;
}

std::string without_blanks(std::string text) {
  std::erase_if(text, [](unsigned char c) { return std::isspace(c) != 0; });
  return text;
}

/// The types of parameters, without their names and default values.
std::string types_of(const std::string& parameters) {
  std::vector<std::string> list{""};
  int depth = 0;
  for (const char c : parameters) {
    depth += c == '<' || c == '(' ? 1 : c == '>' || c == ')' ? -1 : 0;
    if (c == ',' && depth == 0)
      list.emplace_back();
    else
      list.back() += c;
  }
  std::string types;
  for (std::string& parameter : list) {
    parameter = parameter.substr(0, parameter.find('='));
    types += without_blanks(std::regex_replace(parameter, std::regex(R"(([&*>\s])\w+\s*$)"), "$1")) + ",";
  }
  return types;
}

std::optional<LocalName> local_name(const std::string& statement) {
  std::smatch found;
  if (std::regex_search(statement, found, std::regex(R"(^\s*using (\w+)\s*=([\s\S]*)$)")))
    return LocalName{found[1], "using " + without_blanks(found[2])};
  if (std::regex_search(statement, std::regex(R"(^\s*(using|namespace|extern|static_assert)\b)"))) return std::nullopt;
  if (std::regex_search(
          statement, found,
          std::regex(
              R"(^\s*(?:template\s*<[\s\S]*>\s*)?(?:struct|class|enum class|enum|union)\s+(\w+)(?:\s+final)?\s*(:|$))")))
    return LocalName{found[1], ""};
  const std::string head = statement.substr(0, statement.find('='));
  if (std::regex_search(head, found, std::regex(R"((\w+)\s*\()"))) {
    const auto begin = static_cast<std::size_t>(found.position(0) + found.length(0));
    int depth = 1;
    std::size_t end = begin;
    for (; end < statement.size() && depth > 0; ++end)
      depth += statement[end] == '(' ? 1 : statement[end] == ')' ? -1 : 0;
    return LocalName{found[1], "(" + types_of(statement.substr(begin, end - begin - 1))};
  }
  if (std::regex_search(head, found, std::regex(R"((\w+)\s*(\[[^\]]*\]\s*)*$)"))) return LocalName{found[1], ""};
  return std::nullopt;
}

std::vector<LocalName> local_names(const fs::path& file) {
  std::ostringstream content;
  content << std::ifstream(file).rdbuf();
  const std::string text = without_texts(content.str()), opening = "\nnamespace {\n";
  std::vector<LocalName> names;
  for (std::size_t at = text.find(opening); at != std::string::npos; at = text.find(opening, at + 1)) {
    for (const std::string& statement : statements(in_braces(text, at + opening.size()))) {
      if (const std::optional<LocalName> name = local_name(statement)) names.push_back(*name);
    }
  }
  return names;
}

bool may_stand_together(const LocalName& a, const LocalName& b) {
  if (a.signature.empty() || b.signature.empty() || a.signature[0] != b.signature[0]) return false;
  return a.signature[0] == '(' ? a.signature != b.signature : a.signature == b.signature;
}

}  // namespace

TEST_CASE("local names: two files of a folder declare no name twice") {
  const fs::path root = eomgen::test::source_folder();
  std::size_t seen = 0;
  for (const char* top : {"generator", "tests"}) {
    for (const fs::directory_entry& folder : fs::directory_iterator(root / top)) {
      if (!folder.is_directory()) continue;
      std::map<std::string, std::vector<std::pair<LocalName, std::string>>> before;
      for (const fs::path& file : architecture::files_below(folder.path(), {".cpp"})) {
        const std::string here = fs::relative(file, root).generic_string();
        if (here.starts_with("generator/cli/commands/")) continue;  // each is a namespace of its own
        for (const LocalName& name : local_names(file)) {
          ++seen;
          for (const auto& [other, there] : before[name.name]) {
            if (there == here || may_stand_together(name, other)) continue;
            FAIL_CHECK(here << " and " << there << " both declare '" << name.name
                            << "' in their anonymous namespace: give one of them another name, or share it");
          }
          before[name.name].emplace_back(name, here);
        }
      }
    }
  }
  CHECK(seen > 2000);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/documentation.hpp"

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace eomgen::cli {
namespace {

/// For comparison: lower case, words separated by one blank, without the marks of Markdown.
std::string plain(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '`' || c == '*') continue;
    const bool blank = c == ' ' || c == '-' || c == '_';
    if (blank && (result.empty() || result.back() == ' ')) continue;
    result += blank ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  while (!result.empty() && result.back() == ' ') result.pop_back();
  return result;
}

struct Heading {
  std::size_t begin, level;
  std::string text;
};

/// Headings outside of code.
std::vector<Heading> headings(const std::string& text) {
  std::vector<Heading> result;
  bool code = false;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    if (line.find_first_not_of(' ') != std::string::npos && line.substr(line.find_first_not_of(' ')).starts_with("```"))
      code = !code;
    const std::size_t level = line.find_first_not_of('#');
    if (!code && level != std::string::npos && level > 0 && level <= 6 && line[level] == ' ')
      result.push_back({at, level, line.substr(level + 1)});
    at = end + 1;
  }
  return result;
}

std::string base_name(const std::string& topic) { return topic.substr(topic.rfind('/') + 1); }

}  // namespace

std::string topic_of(const DocumentationPage& page) {
  const std::string file = page.file;
  return file.substr(0, file.rfind('.'));
}

std::string title_of(const DocumentationPage& page) {
  const std::vector<Heading> all = headings(page.text);
  return all.empty() ? topic_of(page) : all.front().text;
}

std::vector<DocumentationText> find_documentation(const std::string& topic) {
  const std::string wanted = plain(topic);
  for (const bool with_folder : {true, false}) {
    for (const DocumentationPage& page : documentation_pages()) {
      const std::string name = topic_of(page);
      if (plain(with_folder ? name : base_name(name)) == wanted) return {{name, title_of(page), page.text}};
    }
  }
  std::vector<DocumentationText> result;
  for (const DocumentationPage& page : documentation_pages()) {
    const std::string text = page.text;
    const std::vector<Heading> all = headings(text);
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (plain(all[k].text) != wanted) continue;
      std::size_t end = text.size();
      for (std::size_t next = k + 1; next < all.size(); ++next) {
        if (all[next].level > all[k].level) continue;
        end = all[next].begin;
        break;
      }
      result.push_back({topic_of(page), all[k].text, text.substr(all[k].begin, end - all[k].begin)});
    }
  }
  return result;
}

std::vector<std::string> documentation_topics() {
  std::vector<std::string> result;
  for (const DocumentationPage& page : documentation_pages()) {
    result.push_back(topic_of(page));
    for (const Heading& heading : headings(page.text)) result.push_back(heading.text);
  }
  return result;
}

}  // namespace eomgen::cli

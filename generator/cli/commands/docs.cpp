// SPDX-License-Identifier: GPL-3.0-or-later
// Command docs: the pages of the documentation, or one of their sections.
#include <fmt/format.h>

#include <algorithm>

#include "cli/commands/commands.hpp"
#include "cli/documentation.hpp"
#include "cli/output.hpp"
#include "error.hpp"
#include "model/names.hpp"

namespace eomgen::cli::docs_command {
namespace {

struct Options {
  std::string topic;
};

int show_list(const CommonOptions& common) {
  Json pages = Json::array();
  std::size_t width = 0;
  for (const DocumentationPage& page : documentation_pages()) {
    pages.push_back({{"topic", topic_of(page)}, {"title", title_of(page)}});
    width = std::max(width, topic_of(page).size());
  }
  if (common.json) {
    print_document({{"format", 1}, {"pages", pages}, {"texts", Json::array()}});
    return 0;
  }
  for (const DocumentationPage& page : documentation_pages())
    fmt::print("{:<{}}  {}\n", topic_of(page), width, title_of(page));
  fmt::print("\neomgen docs TOPIC shows one of these pages, or every section with this heading.\n");
  return 0;
}

int execute(const Options& options, const CommonOptions& common) {
  if (options.topic.empty()) return show_list(common);
  const std::vector<DocumentationText> found = find_documentation(options.topic);
  if (found.empty()) {
    throw Error("docs", {}, fmt::format("the documentation has no page and no section {}", model::quote(options.topic)),
                model::suggest_choice(options.topic, documentation_topics()));
  }
  Json texts = Json::array();
  for (const DocumentationText& text : found) {
    texts.push_back({{"topic", text.topic}, {"heading", text.heading}, {"text", text.text}});
    if (!common.json) fmt::print("{}{}", found.size() > 1 ? fmt::format("[{}]\n\n", text.topic) : "", text.text);
  }
  if (common.json) print_document({{"format", 1}, {"pages", Json::array()}, {"texts", texts}});
  return 0;
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<Options>();
  app.add_option("TOPIC", options->topic,
                 "a page, such as abi, or the heading of a section; without it the list of pages");
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::docs_command

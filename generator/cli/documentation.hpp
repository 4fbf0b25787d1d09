// SPDX-License-Identifier: GPL-3.0-or-later
// The pages of docs/ in the program, and the search for a topic in them.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace eomgen::cli {

struct DocumentationPage {
  const char *file, *text;  // "how-to/read-the-estimate.md", Markdown
};

/// In the order of their names.
std::span<const DocumentationPage> documentation_pages();

/// "how-to/read-the-estimate"
std::string topic_of(const DocumentationPage& page);
/// The heading of a page.
std::string title_of(const DocumentationPage& page);

/// A page, or a section of one.
struct DocumentationText {
  std::string topic, heading, text;  // topic of the page
};

/// The page of this name, with or without its folder; otherwise every section with this heading. Upper and lower case
/// are equal, and so are blanks, hyphens and underscores. Empty: there is none.
std::vector<DocumentationText> find_documentation(const std::string& topic);

/// Topics of all pages and all headings, for suggestions.
std::vector<std::string> documentation_topics();

}  // namespace eomgen::cli

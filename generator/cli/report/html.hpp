// SPDX-License-Identifier: GPL-3.0-or-later
// Pieces of a page. What is text is escaped here; formulas and plots come as markup of our own printers.
#pragma once

#include <string>
#include <vector>

namespace eomgen::cli {

class Html {
 public:
  void heading(int level, const std::string& text);
  void paragraph(const std::string& text, const std::string& style = "");
  void formula(const std::string& mathml);
  void preformatted(const std::string& summary, const std::string& text);  // folded
  void markup(const std::string& trusted) { text_ += trusted + "\n"; }
  /// Cells are escaped; those of `numbers` are set as figures.
  void table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows,
             const std::vector<std::size_t>& numbers = {});
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

struct PageParts {
  std::string title;  // escaped here
  std::string body;
  std::string motion;  // JSON for the script; empty: the page has none
  // JavaScript of the target javascript, or empty, and the name of the constant that it defines: the model, and the
  // equations of what is drawn of constraints.
  std::string model, name;
  std::string surfaces, surfaces_name;
};

/// The whole page: the skeleton of templates/report with its style and scripts.
std::string page(const PageParts& parts);

}  // namespace eomgen::cli

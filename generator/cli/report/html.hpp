// SPDX-License-Identifier: GPL-3.0-or-later
// HTML of a page. Text is escaped here; formulas and plots are markup from the program's own printers.
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
  /// Cells are escaped. `numbers`: indices of numeric columns.
  void table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows,
             const std::vector<std::size_t>& numbers = {});
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

struct PageParts {
  std::string title;  // escaped here
  std::string body;
  std::string motion;  // JSON for the script; empty: no motion
  // JavaScript of the model and of the constraint surfaces, with the name of the constant that each defines; may be
  // empty.
  std::string model, name;
  std::string surfaces, surfaces_name;
  bool has_contacts = false;  // whether the model in JavaScript has any
};

/// Returns the whole page: the skeleton of templates/report with its style and scripts.
std::string render_page(const PageParts& parts);

}  // namespace eomgen::cli

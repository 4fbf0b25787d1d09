// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/latex_writer.hpp"

#include <cctype>
#include <iterator>

namespace eomgen::print {
namespace {

using reading::Formula;

constexpr std::size_t page_width = 78;    // visible characters
constexpr std::size_t max_lines = 24;     // maximum of formulas other than equations
constexpr std::size_t longest_word = 24;  // longer words may be broken

constexpr const char* begin = R"(\documentclass[10pt,a4paper,fleqn]{article}
\usepackage{amsmath}
)";
constexpr const char* preamble = R"(\usepackage{longtable}
\usepackage[margin=18mm]{geometry}
\setlength{\parindent}{0pt}
\setlength{\parskip}{4pt plus 1pt}
\setlength{\mathindent}{1em}
\setlength{\LTleft}{0pt}
\setlength{\LTpre}{2pt}
\setlength{\LTpost}{2pt}
\setlength{\emergencystretch}{3em}
\allowdisplaybreaks
\raggedbottom
\begin{document}
\setlength{\abovedisplayskip}{5pt plus 2pt}
\setlength{\belowdisplayskip}{5pt plus 2pt}
\setlength{\abovedisplayshortskip}{3pt plus 2pt}
\setlength{\belowdisplayshortskip}{5pt plus 2pt}
)";

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }
bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0u) == 0x80u; }  // continuation byte of UTF-8

}  // namespace

std::string escape_user_text(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (is_blank(text[i])) {
      result += ' ';
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < text.size() && !is_blank(text[end])) ++end;
    const bool broken = end - i > longest_word;
    while (i < end) {
      std::size_t next = i + 1;
      while (next < end && continues(text[next])) ++next;
      result += escape_latex(text.substr(i, next - i));
      if (broken && next < end) result += "\\hspace{0pt}";
      i = next;
    }
  }
  return result;
}

std::string unit_in_latex(const std::string& unit) {
  if (unit.empty()) return "";
  std::string result = "$\\mathrm{";
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const char c = unit[i];
    if (c == '^') {
      std::size_t end = i + 1;
      while (end < unit.size() && (std::isdigit(static_cast<unsigned char>(unit[end])) != 0 || unit[end] == '-')) ++end;
      result += "^{" + unit.substr(i + 1, end - i - 1) + "}";
      i = end - 1;
    } else if (c == '*' || c == ' ') {
      result += "\\,";
    } else if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '/' || c == '(' || c == ')') {
      result += c;
    }
  }
  return result + "}$";
}

std::string enumeration(const std::vector<std::string>& parts) {
  std::string result;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) result += i + 1 == parts.size() ? " and " : ", ";
    result += parts[i];
  }
  return result;
}

LatexWriter::LatexWriter(const Notation& notation)
    : notation_(notation), wide_(latex_style(page_width)), unbroken_(latex_style(std::string::npos)) {}

void LatexWriter::title(const std::string& text) {
  text_ += "\\begin{center}\n\\LARGE " + escape_user_text(text) + "\n\\end{center}\n";
}

std::vector<std::string> LatexWriter::broken_lines(const Formula& formula, std::size_t width) const {
  static const std::string opening = "\\begin{aligned}[t]\n", closing = "\n\\end{aligned}", between = " \\\\\n";
  std::string text = print(formula, notation_, *latex_style(width));
  if (!text.starts_with(opening)) return {"& " + text};
  text = text.substr(opening.size(), text.size() - opening.size() - closing.size());
  std::vector<std::string> result;
  for (std::size_t at = 0, end = 0; end != std::string::npos; at = end + between.size()) {
    end = text.find(between, at);
    result.push_back(text.substr(at, end == std::string::npos ? end : end - at));
  }
  return result;
}

void LatexWriter::display(const std::vector<Formula>& formulas) {
  std::vector<std::string> all;
  for (const Formula& f : formulas) {
    std::vector<std::string> more = broken_lines(f, page_width);
    // TeX keeps a whole display in memory, which overflows at some hundred lines.
    if (!all.empty() && all.size() + more.size() > max_lines) {
      aligned(all);
      all.clear();
    }
    std::move(more.begin(), more.end(), std::back_inserter(all));
  }
  if (!all.empty()) aligned(all);
}

void LatexWriter::aligned(const std::vector<std::string>& all) {
  if (text_.ends_with("\n\n")) text_.pop_back();  // the display belongs to the paragraph
  text_ += "\\begin{align*}\n";
  for (std::size_t i = 0; i < all.size(); ++i) text_ += all[i] + (i + 1 < all.size() ? " \\\\\n" : "\n");
  text_ += "\\end{align*}\n";
}

void LatexWriter::numbered_display(const std::string& label, const Formula& formula) {
  constexpr std::size_t room = 8;  // space for the equation number
  std::vector<std::string> all = broken_lines(formula, page_width - room);
  all.back() += " \\tag*{" + label + "}";
  aligned(all);
}

std::string LatexWriter::table_cell(const Formula& formula, std::size_t width) const {
  return "$\\displaystyle " + print(formula, notation_, *latex_style(width)) + "$";
}

std::string LatexWriter::reason_too_long(const Formula& formula) const {
  const std::size_t count = broken_lines(formula, page_width).size();
  return count <= max_lines ? "" : "takes " + std::to_string(count) + " lines";
}

bool LatexWriter::fits_on_a_line(const Formula& formula) const {
  return wide_->fits(print(formula, notation_, *unbroken_));
}

std::string LatexWriter::finish() { return std::string(begin) + packages_ + preamble + text_ + "\\end{document}\n"; }

}  // namespace eomgen::print

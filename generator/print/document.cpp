// SPDX-License-Identifier: GPL-3.0-or-later
// A LaTeX document of one model: article, amsmath, longtable; nothing beyond texlive-latex-recommended.
#include <algorithm>
#include <cctype>

#include "model/names.hpp"
#include "print/formulas.hpp"
#include "print/render.hpp"

namespace eomgen::print {
namespace {

using mechanics::Mechanics;
using reading::Formula;
using reading::ReadingForm;

constexpr std::size_t column_width = 57, page_width = 125;  // printed characters
constexpr std::ptrdiff_t longest_cell = 30;  // lines, of a cell that still fits on a page beside others

constexpr const char* preamble = R"(\documentclass[10pt,a4paper,landscape]{article}
\usepackage{amsmath}
\usepackage{longtable}
\usepackage[margin=15mm]{geometry}
\setlength{\parindent}{0pt}
\setlength{\parskip}{4pt}
\setlength{\LTleft}{0pt}
\setlength{\LTpre}{0pt}
\setlength{\LTpost}{0pt}
\allowdisplaybreaks
\raggedbottom
\begin{document}
)";

// kg*m^2/s^2 -> \mathrm{kg}\,\mathrm{m}^{2}/\mathrm{s}^{2}
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

class Document {
 public:
  explicit Document(const Mechanics& m)
      : m_(m), model_(*m.model), notation_(m), wide_(latex_style(page_width)), narrow_(latex_style(column_width)) {}

  std::string write(const ReadingForm& one, const ReadingForm& two) {
    text_ = preamble;
    const std::string amsmath = "\\usepackage{amsmath}\n";
    if (uses_amssymb()) text_.insert(text_.find(amsmath) + amsmath.size(), "\\usepackage{amssymb}\n");
    const std::string title = model_.title.empty() ? model_.id : model_.title;
    text_ += "\\section*{" + escape_latex(title) + "}\n";
    if (!model_.notes.empty()) text_ += escape_latex(model_.notes) + "\n\n";
    parameters();
    constraints(one);
    energies(one, two);
    equations(one, two);
    reactions(one);
    contacts();
    text_ += "\\end{document}\n";
    return std::move(text_);
  }

 private:
  bool uses_amssymb() const {
    const auto in = [](const auto& list) { return std::any_of(list.begin(), list.end(), [](const auto& named) { return model::needs_amssymb(named.tex); }); };
    return in(model_.parameters) || in(model_.inputs) || in(model_.functions) || in(model_.coordinates);
  }
  std::string wide(const Formula& f) const { return print(f, notation_, *wide_); }
  std::string narrow(const Formula& f) const { return print(f, notation_, *narrow_); }
  std::string symbol(symbolic::SymbolKind kind, std::size_t index) const {
    return wide(reading::symbol({kind, static_cast<std::uint32_t>(index), 0}));
  }
  void heading(const char* title) { text_ += std::string("\n\\subsection*{") + title + "}\n"; }
  /// A formula of several lines may be continued on the next page.
  void display(const Formula& f) {
    static const std::string begin = "\\begin{aligned}[t]\n", end = "\n\\end{aligned}";
    const std::string text = wide(f);
    if (!text.starts_with(begin)) {
      text_ += "\\[\n" + text + "\n\\]\n";
    } else {
      text_ += "\\begin{align*}\n" + text.substr(begin.size(), text.size() - begin.size() - end.size()) + "\n\\end{align*}\n";
    }
  }

  std::string value(model::NodeId node) const {
    const std::optional<Formula> written = reading::as_written(model_, node);
    return written ? "$" + wide(*written) + "$" : "";
  }

  void parameters() {
    if (!model_.parameters.empty()) {
      heading("Parameters");
      text_ += "\\begin{longtable}{@{}llll@{}}\n";
      for (std::size_t i = 0; i < model_.parameters.size(); ++i) {
        const model::Parameter& p = model_.parameters[i];
        text_ += "$" + symbol(symbolic::SymbolKind::parameter, i) + "$ & " + value(p.value) + " & " +
                 unit_in_latex(p.unit.text) + " & " + escape_latex(p.note) + " \\\\\n";
      }
      text_ += "\\end{longtable}\n";
    }
    heading("Coordinates");
    text_ += "\\begin{longtable}{@{}lll@{}}\n";
    for (std::uint32_t i = 0; i < model_.coordinates.size(); ++i) {
      const model::Coordinate& q = model_.coordinates[i];
      std::string range;
      if (q.lower != model::no_node) range += value(q.lower) + " $<$ ";
      if (q.lower != model::no_node || q.upper != model::no_node) range += "$" + symbol(symbolic::SymbolKind::coordinate, i) + "$";
      if (q.upper != model::no_node) range += " $<$ " + value(q.upper);
      text_ += "$" + symbol(symbolic::SymbolKind::coordinate, i) + "$ & " + unit_in_latex(q.unit.text) + " & " + range + " \\\\\n";
    }
    text_ += "\\end{longtable}\n";
  }

  void constraints(const ReadingForm& form) {
    std::vector<Statement> statements;
    add_constraints(m_, form, statements);
    if (statements.empty()) return;
    heading("Constraints and functions of time");
    std::string before;
    for (const Statement& s : statements) {
      const std::string title = s.role == "function of time" ? s.role : s.name + ", " + s.role;
      if (title != before) text_ += escape_latex(title) + ":\n";
      before = title;
      display(s.formula);
    }
  }

  void energies(const ReadingForm& one, const ReadingForm& two) {
    std::vector<Statement> statements;
    add_energies(m_, one, statements);
    const auto fixes = [](const reading::ReadConstraint& c) { return c.fixes.has_value(); };
    if (std::any_of(two.constraints.begin(), two.constraints.end(), fixes)) add_energies(m_, two, statements);
    if (statements.empty()) return;
    heading("Energies");
    for (const Statement& s : statements) display(s.formula);
  }

  std::string cell(const std::vector<Statement>& statements, const char* key, const std::string& coordinate) const {
    for (const Statement& s : statements) {
      if (s.key == key && s.coordinate == coordinate) return "$\\displaystyle " + narrow(s.formula) + "$";
    }
    return "---";
  }

  /// A row of the table cannot be continued on the next page.
  bool is_long(const std::vector<Statement>& statements) const {
    return std::any_of(statements.begin(), statements.end(), [this](const Statement& s) {
      const std::string text = s.key == "equations" || s.key == "explicit" ? narrow(s.formula) : "";
      return std::count(text.begin(), text.end(), '\n') > longest_cell;
    });
  }
  void listed(const char* title, const std::vector<Statement>& statements) {
    text_ += std::string("\n\\subsubsection*{") + title + "}\n";
    for (const char* key : {"equations", "explicit"}) {
      if (std::string(key) == "explicit") text_ += "\\emph{The same, written out}\n";
      for (const Statement& s : statements) {
        if (s.key == key) display(s.formula);
      }
    }
  }

  void equations(const ReadingForm& one, const ReadingForm& two) {
    std::vector<Statement> left, right;
    add_equations(m_, one, left);
    add_equations(m_, two, right);
    heading("Lagrange's equations");
    if (is_long(left) || is_long(right)) {
      listed("Approach I: all coordinates, constraints imposed afterwards", left);
      listed("Approach II: constraints imposed first", right);
      return;
    }
    text_ += "\\begin{longtable}{@{}p{0.06\\linewidth}p{0.45\\linewidth}p{0.45\\linewidth}@{}}\n"
             " & \\textbf{Approach I}: all coordinates, constraints imposed afterwards"
             " & \\textbf{Approach II}: constraints imposed first \\\\[4pt]\n\\endhead\n";
    for (const char* key : {"equations", "explicit"}) {
      for (const Statement& s : left) {
        if (s.key != key) continue;
        const auto index = std::find_if(model_.coordinates.begin(), model_.coordinates.end(),
                                        [&](const model::Coordinate& q) { return q.name == s.coordinate; });
        text_ += "$" + symbol(symbolic::SymbolKind::coordinate, static_cast<std::size_t>(index - model_.coordinates.begin())) +
                 "$ & " + cell(left, key, s.coordinate) + " & " + cell(right, key, s.coordinate) + " \\\\[8pt]\n";
      }
      if (std::string(key) == "equations") text_ += " & \\multicolumn{2}{l}{\\emph{the same, written out}} \\\\[4pt]\n";
    }
    text_ += "\\end{longtable}\n";
  }

  void reactions(const ReadingForm& form) {
    std::vector<Statement> statements;
    add_reactions(form, statements);
    add_constraint_forces(m_, form, statements);
    if (statements.empty()) return;
    heading("Constraint forces");
    text_ += "The force of a constraint $\\psi = 0$ on the system is its multiplier times $\\partial\\psi/\\partial\\mathbf{r}$.\n";
    const bool velocities = std::any_of(form.constraints.begin(), form.constraints.end(),
                                        [](const reading::ReadConstraint& c) { return !c.holonomic; });
    if (velocities) text_ += "Of a constraint on velocities it is the multiplier times the coefficients of the velocities.\n";
    for (const Statement& s : statements) display(s.formula);
  }

  void contacts() {
    std::vector<Statement> statements;
    add_contacts(m_, statements);
    if (statements.empty()) return;
    heading("Contacts");
    std::string before;
    for (const Statement& s : statements) {
      const std::string title = s.name + ", " + s.role;
      if (title != before) text_ += escape_latex(title) + ":\n";
      before = title;
      display(s.formula);
    }
  }

  const Mechanics& m_;
  const model::Model& model_;
  Notation notation_;
  std::unique_ptr<Style> wide_, narrow_;
  std::string text_;
};

}  // namespace

std::string latex_document(const Mechanics& mechanics, const ReadingForm& one, const ReadingForm& two) {
  return Document(mechanics).write(one, two);
}

}  // namespace eomgen::print

// SPDX-License-Identifier: GPL-3.0-or-later
// Lagrange's equations by both approaches, and how they decouple.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "print/article_parts.hpp"
#include "print/named_lengths.hpp"

namespace eomgen::print {

namespace {

constexpr std::size_t half_width = 33, whole_width = 66;  // visible characters of a cell
constexpr std::size_t tallest_beside = 5;                 // maximum lines of a cell beside another one
constexpr std::size_t tallest_row = 30;                   // lines on a page: a row cannot span two pages

/// Whether a sum contains multipliers or friction.
bool has_forces_of_constraints(const reading::Sum& sum) {
  bool found = false;
  reading::for_each_atom(sum, [&](const reading::Atom& atom) {
    found = found || (atom.op == reading::Op::symbol &&
                      (atom.symbol.kind == SymbolKind::multiplier || atom.symbol.kind == SymbolKind::friction));
  });
  return found;
}

/// The equation of one coordinate by both approaches.
struct Row {
  std::uint32_t coordinate = 0;
  std::optional<Formula> one, two;
};

class Equations {
 public:
  explicit Equations(Article& a) : a_(a), m_(a.m), out_(a.out) {}

  void write() {
    std::vector<reading::PartialDerivatives> first;
    write_lagrange_law(a_);
    const bool derivatives = !a_.omits("energy_derivatives");
    if (a_.approaches_differ()) {
      if (derivatives) {
        out_.subsection("Approach I: all coordinates, constraints imposed afterwards");
        write_partial_derivatives(a_, a_.one, first);
        out_.subsection("Approach II: constraints that fix a coordinate are built in");
        write_partial_derivatives(a_, a_.two, first);
      }
      out_.subsection("The equations by both approaches");
      imposed();
    } else {
      if (derivatives) {
        out_.subsection("Partial derivatives");
        write_partial_derivatives(a_, a_.one, first);
      }
      out_.subsection("The equations");
      if (!m_.constraints.empty())
        out_.paragraph("No constraint fixes a coordinate, so Approach I and Approach II are one.");
    }
    const std::vector<Row> rows = rows_of("equations");
    show(rows);
    std::vector<Row> explicit_rows = rows_of("explicit");
    std::erase_if(explicit_rows, [&](const Row& row) { return repeats(row, rows); });
    if (!explicit_rows.empty()) out_.paragraph("The same, written out:");
    show(explicit_rows);
    parts(a_.one);
    if (a_.approaches_differ()) parts(a_.two);
    states();
    resets();
    decoupling();
  }

 private:
  /// Lists what approach II imposes on the equations.
  void imposed() {
    std::vector<std::string> names;
    for (const mechanics::FixedCoordinate& fixed : m_.fixed) names.push_back(a_.coordinate_math(fixed.coordinate));
    std::string text = "Where both approaches give the same equation it stands once.";
    if (!names.empty())
      text += " Those of Approach I have " + enumeration(names) + " with " + (names.size() == 1 ? "its" : "their") +
              " rates and accelerations imposed.";
    out_.paragraph(text);
  }

  std::vector<Row> rows_of(const char* key) const {
    std::vector<Statement> left, right;
    add_equations(m_, a_.one, left);
    add_equations(m_, a_.two, right);
    name_lengths(m_, left, &a_.letters);
    name_lengths(m_, right, &a_.letters);
    std::vector<Row> rows;
    const auto place = [&](const Statement& s) -> Row& {
      const auto index = std::find_if(a_.model.coordinates.begin(), a_.model.coordinates.end(),
                                      [&](const model::Coordinate& q) { return q.name == s.coordinate; });
      const auto coordinate = static_cast<std::uint32_t>(index - a_.model.coordinates.begin());
      const auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& r) { return r.coordinate == coordinate; });
      if (row != rows.end()) return *row;
      rows.push_back({coordinate, {}, {}});
      return rows.back();
    };
    for (const Statement& s : left) {
      if (s.key == key) place(s).one = s.formula;
    }
    for (const Statement& s : right) {
      if (s.key == key) place(s).two = s.formula;
    }
    return rows;
  }

  /// Definitions of letters in equations that are not written out; shown once if both approaches share them.
  void parts(const reading::DisplayForm& form) {
    std::vector<Statement> all;
    add_equations(m_, form, all);
    for (const Statement& s : all) {
      if (!s.left_out.empty() && s.key != "parts")
        a_.left_out.push_back(
            {std::string(s.key) + (form.approach == system::Approach::two ? ", II" : ", I"), s.left_out});
    }
    std::erase_if(all, [](const Statement& s) { return s.key != "parts"; });
    std::vector<Formula> formulas = a_.formulas(all);
    std::erase_if(formulas, [this](const Formula& f) { return !parts_.insert(out_.math(f)).second; });
    if (formulas.empty()) return;
    out_.paragraph(form.approach == system::Approach::two ? "Here, by Approach II," : "Here, by Approach I,");
    out_.display(formulas);
  }

  void states() {
    std::vector<Statement> all;
    add_states(m_, all);
    if (all.empty()) return;
    out_.paragraph(all.size() == 1 ? "A state of first order belongs to the motion:"
                                   : "States of first order belong to the motion:");
    out_.display(a_.formulas(all));
  }

  void resets() {
    std::vector<Statement> all;
    add_resets(m_, all);
    for (std::size_t first = 0; first < all.size();) {
      std::size_t end = first;
      while (end < all.size() && all[end].name == all[first].name && all[end].role == all[first].role) ++end;
      const std::vector<Statement> group(all.begin() + static_cast<std::ptrdiff_t>(first),
                                         all.begin() + static_cast<std::ptrdiff_t>(end));
      out_.paragraph(fmt::format("At the {} {} the values on the left follow from those before it:", group[0].role,
                                 escape_user_text(group[0].name)));
      out_.display(a_.formulas(group));
      first = end;
    }
  }

  bool same(const std::optional<Formula>& a, const std::optional<Formula>& b) const {
    return a.has_value() == b.has_value() && (!a || out_.math(*a) == out_.math(*b));
  }
  bool merged(const Row& row) const { return !a_.approaches_differ() || same(row.one, row.two); }
  bool repeats(const Row& row, const std::vector<Row>& rows) const {
    return std::any_of(rows.begin(), rows.end(), [&](const Row& r) {
      return r.coordinate == row.coordinate && same(r.one, row.one) && same(r.two, row.two);
    });
  }

  void show(const std::vector<Row>& rows) {
    if (rows.empty()) return;
    const auto tall = [&](const std::optional<Formula>& f) {
      return f && out_.broken_lines(*f, whole_width).size() > tallest_row;
    };
    if (!a_.approaches_differ() ||
        std::any_of(rows.begin(), rows.end(), [&](const Row& r) { return tall(r.one) || tall(r.two); })) {
      for (const Row& row : rows) listed(row);
      return;
    }
    out_.raw(
        "\\begin{longtable}{@{}p{0.07\\linewidth}p{0.41\\linewidth}p{0.41\\linewidth}r@{}}\n"
        " & \\textbf{Approach I} & \\textbf{Approach II} & \\\\[6pt]\n\\endhead\n");
    for (const Row& row : rows) tabulated(row);
    out_.raw("\\end{longtable}\n");
  }

  std::string number(const Row& row) {
    std::string label = out_.next_number();
    numbers_.try_emplace(row.coordinate, label);
    return label;
  }

  void listed(const Row& row) {
    if (merged(row)) {
      if (row.one) out_.numbered_display(number(row), *row.one);
      return;
    }
    if (row.one) {
      out_.paragraph("Of " + a_.coordinate_math(row.coordinate) + " by Approach I:");
      out_.numbered_display(number(row), *row.one);
    }
    if (!row.two) return;
    out_.paragraph("Of " + a_.coordinate_math(row.coordinate) + " by Approach II:");
    out_.numbered_display(number(row), *row.two);
  }

  void tabulated(const Row& row) {
    const std::string name = a_.coordinate_math(row.coordinate);
    const auto spanning = [&](const std::string& label, const Formula& f) {
      out_.raw(label + " & \\multicolumn{2}{p{0.84\\linewidth}}{" + out_.table_cell(f, whole_width) + "} & " +
               number(row) + " \\\\[6pt]\n");
    };
    if (merged(row)) {
      if (row.one) spanning(name, *row.one);
      return;
    }
    const auto short_enough = [&](const std::optional<Formula>& f) {
      return !f || out_.broken_lines(*f, half_width).size() <= tallest_beside;
    };
    if (short_enough(row.one) && short_enough(row.two)) {
      const auto cell = [&](const std::optional<Formula>& f) {
        return f ? out_.table_cell(*f, half_width) : std::string("---");
      };
      out_.raw(name + " & " + cell(row.one) + " & " + cell(row.two) + " & " + number(row) + " \\\\[6pt]\n");
      return;
    }
    if (row.one) spanning(name + ", I", *row.one);
    if (row.two) spanning(name + ", II", *row.two);
  }

  std::string numbers(const std::vector<const Equation*>& equations) const {
    std::vector<std::string> result;
    for (const Equation* e : equations) {
      const auto found = numbers_.find(e->coordinate);
      if (found != numbers_.end()) result.push_back(found->second);
    }
    return enumeration(result);
  }

  void decoupling() {
    if (a_.one.is_unexpanded || a_.one.constraints.empty()) return;
    std::vector<const Equation*> pure, coupled, of_forces;
    bool friction = false;
    for (const Equation& e : a_.one.equations) {
      const bool has_friction = has_forces_of_constraints(e.force);
      if (!e.of_motion)
        of_forces.push_back(&e);
      else
        (has_friction || !e.multipliers.empty() ? coupled : pure).push_back(&e);
      friction = friction || (e.of_motion && has_friction);
    }
    out_.subsection("What decouples");
    const auto s = [](const std::vector<const Equation*>& list) { return list.size() == 1; };
    if (!of_forces.empty())
      out_.paragraph("By Approach I " + numbers(of_forces) +
                     (s(of_forces) ? " gives the constraint force, once the motion is known."
                                   : " give the constraint forces, once the motion is known."));
    if (coupled.empty()) {
      if (!pure.empty()) {
        out_.paragraph(
            numbers(pure) + (s(pure) ? " has" : " have") + " no constraint force in " +
            (s(pure) ? "it: it is the equation" : "them: they are the equations") + " of motion. " +
            (of_forces.empty() ? "" : "Approach II gives " + std::string(s(pure) ? "it" : "them") + " alone."));
      }
      return;
    }
    if (!pure.empty())
      out_.paragraph(numbers(pure) + (s(pure) ? " has" : " have") + " no constraint force in " +
                     (s(pure) ? "it." : "them."));
    if (friction) {
      out_.paragraph("Friction depends on the constraint forces, so " + numbers(coupled) +
                     (s(coupled) ? " does" : " do") +
                     " not decouple: motion and constraint forces are found together, with the law of friction below.");
      return;
    }
    out_.paragraph("The multipliers of constraints that fix no coordinate stay in " + numbers(coupled) +
                   ": these do not decouple. Multipliers and accelerations are found together, from these equations "
                   "and the time derivatives of the constraints.");
    for (const reading::DisplayConstraint& c : a_.two.constraints) {
      if (!c.fixes || m_.is_eliminated(c.fixes->coordinate)) continue;
      out_.paragraph("By Approach II \\textbf{" + escape_user_text(c.label) + "} takes " +
                     a_.coordinate_math(c.fixes->coordinate) + " out, and its multiplier with it.");
    }
  }

  Article& a_;
  const mechanics::Mechanics& m_;
  LatexWriter& out_;
  std::set<std::string> parts_;                   // parts that are already defined
  std::map<std::uint32_t, std::string> numbers_;  // number of the first equation of each coordinate
};

}  // namespace

void write_equations(Article& a) {
  a.out.section("Lagrange's equations");
  Equations(a).write();
}

}  // namespace eomgen::print

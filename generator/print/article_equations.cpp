// SPDX-License-Identifier: GPL-3.0-or-later
// From the energies to the equations by both approaches, and what the constraints exert.
#include <algorithm>
#include <map>

#include "print/article_parts.hpp"
#include "reading/partials.hpp"

namespace eomgen::print {

using reading::arrange;
using reading::Equation;
using reading::Form;
using reading::Formula;
using reading::Layout;
using reading::mark;
using reading::Partials;
using reading::ReadingForm;
using symbolic::SymbolKind;

namespace {

constexpr std::size_t half_width = 33, whole_width = 66;  // printed characters of a cell
constexpr std::size_t tallest_beside = 5;                 // lines of a cell that has another one beside it
constexpr std::size_t tallest_row = 30;  // lines that still fit on a page: a row cannot be continued on the next

Formula symbol_of(std::uint32_t coordinate, std::uint8_t order) {
  return reading::symbol({SymbolKind::coordinate, coordinate, order});
}

/// Multipliers or friction in a sum.
bool has_forces_of_constraints(const reading::Sum& sum) {
  bool found = false;
  reading::for_each_atom(sum, [&](const reading::Atom& atom) {
    found = found || (atom.op == reading::Op::symbol &&
                      (atom.symbol.kind == SymbolKind::multiplier || atom.symbol.kind == SymbolKind::friction));
  });
  return found;
}

/// One coordinate's equation by both approaches.
struct Row {
  std::uint32_t coordinate = 0;
  std::optional<Formula> one, two;
};

class Equations {
 public:
  explicit Equations(Article& a) : a_(a), m_(a.m), out_(a.out) {}

  void write() {
    law();
    if (a_.builds_in()) {
      out_.subsection("Approach I: all coordinates, constraints imposed afterwards");
      steps(a_.one);
      out_.subsection("Approach II: constraints that fix a coordinate are built in");
      steps(a_.two);
      out_.subsection("The equations by both approaches");
      imposed();
    } else {
      out_.subsection("Partial derivatives");
      steps(a_.one);
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
    decoupling();
  }

 private:
  void law() {
    const Letters letters(a_.model, false);
    const Formula q = mark("q"), rate = dotted(q);
    std::vector<Formula> left{reading::wrap(Form::rate, {reading::wrap(Form::partial, {mark(letters.T), rate})}),
                              reading::negative(reading::wrap(Form::partial, {mark(letters.T), q})),
                              reading::wrap(Form::partial, {mark(letters.U), q})};
    const bool constrained = !a_.one.constraints.empty();
    out_.paragraph(std::string("Of every coordinate $q$, with its generalised force $Q_q$ beyond the potential") +
                   (constrained ? " and the forces of the constraints on the right side," : ","));
    out_.raw("\\[\n" + plain(reading::sum(std::move(left))) + " = Q_q" +
             (constrained ? " + \\sum_k " + multiplier() + " f_{k q}" : "") + "\n\\]\n");
    if (!constrained) return;
    const bool holonomic =
        std::any_of(a_.one.constraints.begin(), a_.one.constraints.end(), [](const auto& c) { return c.holonomic; });
    const bool velocities =
        std::any_of(a_.one.constraints.begin(), a_.one.constraints.end(), [](const auto& c) { return !c.holonomic; });
    std::string text = "Here $f_{kq}$ is ";
    if (holonomic)
      text += "$\\partial\\" + std::string(letters.psi == "psi" ? "psi" : "Psi") +
              "_k/\\partial q$ of a holonomic constraint";
    if (velocities)
      text += std::string(holonomic ? ", and " : "") + "the factor of $\\dot{q}$ in a constraint on velocities";
    out_.paragraph(text + ".");
  }
  std::string plain(const Formula& f) const {
    const std::string text = out_.math(f);
    return text.substr(1, text.size() - 2);
  }
  std::string multiplier() const { return std::string("\\") + free_letter(a_.model, "lambda", "mu") + "_{k}"; }
  static Formula dotted(Formula f) {
    Formula result = reading::wrap(Form::dot, {std::move(f)});
    result.order = 1;
    return result;
  }

  static bool equal(const Partials& a, const Partials& b) {
    return a.coordinate == b.coordinate && a.left_out.empty() && b.left_out.empty() && a.momentum == b.momentum &&
           a.rate == b.rate && a.kinetic == b.kinetic && a.potential == b.potential && a.force == b.force;
  }

  /// dT/dqdot, its rate, dT/dq, dU/dq, Q of each coordinate.
  void steps(const ReadingForm& form) {
    if (form.by_parts) {
      out_.paragraph("The partial derivatives are too large to be written out (" + words(form.why_by_parts) + ").");
      return;
    }
    const bool two = form.approach == system::Approach::two;
    const Letters letters(a_.model, two);
    std::vector<std::string> unchanged;
    std::vector<Partials> all = reading::partial_derivatives(m_, form);
    if (two) {
      const auto as_before = [&](const Partials& p) {
        return std::any_of(first_.begin(), first_.end(), [&](const Partials& f) { return equal(f, p); });
      };
      for (const Partials& p : all) {
        if (as_before(p)) unchanged.push_back(a_.name_of(p.coordinate));
      }
      std::erase_if(all, as_before);
    } else {
      first_ = all;
    }
    out_.paragraph(two ? all.empty() ? "The derivatives are those of Approach I."
                                     : "Of the energies with constraints built in:"
                       : "Of the energies above:");
    if (!unchanged.empty() && !all.empty())
      out_.paragraph("Those by " + enumeration(unchanged) + " are as before. The others are");
    for (const Partials& p : all) {
      if (!p.left_out.empty()) {
        a_.left_out.push_back(
            {std::string("partial derivatives by ") + a_.model.coordinates[p.coordinate].name, p.left_out});
        continue;
      }
      std::vector<Formula> shown;
      const auto partial = [&](const std::string& letter, std::uint8_t order) {
        return reading::wrap(Form::partial, {mark(letter), symbol_of(p.coordinate, order)});
      };
      const auto add = [&](std::vector<Formula> formulas) {  // on one line where there is room
        Formula together = reading::wrap(Form::list, formulas);
        if (formulas.size() > 1 && out_.fits_on_a_line(together))
          shown.push_back(std::move(together));
        else
          shown.insert(shown.end(), formulas.begin(), formulas.end());
      };
      std::vector<Formula> momentum{reading::relation({partial(letters.T, 1), arrange(p.momentum)})};
      if (!p.rate.is_zero())
        momentum.push_back(
            reading::relation({reading::wrap(Form::rate, {partial(letters.T, 1)}), arrange(p.rate, Layout::terms)}));
      add(std::move(momentum));
      add({reading::relation({partial(letters.T, 0), arrange(p.kinetic)}),
           reading::relation({partial(letters.U, 0), arrange(p.potential)}),
           reading::relation({mark("Q", {symbol_of(p.coordinate, 0)}), arrange(p.force, Layout::terms)})});
      std::string why;
      for (const Formula& f : shown) why = why.empty() ? out_.too_long(f) : why;
      if (why.empty())
        out_.display(shown);
      else
        a_.left_out.push_back(
            {std::string("partial derivatives by ") + a_.model.coordinates[p.coordinate].name, "one of them " + why});
    }
  }

  /// What the equations below have been given.
  void imposed() {
    std::vector<std::string> names;
    for (const mechanics::FixedCoordinate& fixed : m_.fixed) names.push_back(a_.name_of(fixed.coordinate));
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

  bool same(const std::optional<Formula>& a, const std::optional<Formula>& b) const {
    return a.has_value() == b.has_value() && (!a || out_.math(*a) == out_.math(*b));
  }
  bool merged(const Row& row) const { return !a_.builds_in() || same(row.one, row.two); }
  bool repeats(const Row& row, const std::vector<Row>& rows) const {
    return std::any_of(rows.begin(), rows.end(), [&](const Row& r) {
      return r.coordinate == row.coordinate && same(r.one, row.one) && same(r.two, row.two);
    });
  }

  void show(const std::vector<Row>& rows) {
    if (rows.empty()) return;
    const auto tall = [&](const std::optional<Formula>& f) {
      return f && out_.lines(*f, whole_width).size() > tallest_row;
    };
    if (!a_.builds_in() ||
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
      if (row.one) out_.numbered(number(row), *row.one);
      return;
    }
    if (row.one) {
      out_.paragraph("Of " + a_.name_of(row.coordinate) + " by Approach I:");
      out_.numbered(number(row), *row.one);
    }
    if (!row.two) return;
    out_.paragraph("Of " + a_.name_of(row.coordinate) + " by Approach II:");
    out_.numbered(number(row), *row.two);
  }

  void tabulated(const Row& row) {
    const std::string name = a_.name_of(row.coordinate);
    const auto spanning = [&](const std::string& label, const Formula& f) {
      out_.raw(label + " & \\multicolumn{2}{p{0.84\\linewidth}}{" + out_.cell(f, whole_width) + "} & " + number(row) +
               " \\\\[6pt]\n");
    };
    if (merged(row)) {
      if (row.one) spanning(name, *row.one);
      return;
    }
    const auto short_enough = [&](const std::optional<Formula>& f) {
      return !f || out_.lines(*f, half_width).size() <= tallest_beside;
    };
    if (short_enough(row.one) && short_enough(row.two)) {
      const auto cell = [&](const std::optional<Formula>& f) {
        return f ? out_.cell(*f, half_width) : std::string("---");
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
    if (a_.one.by_parts || a_.one.constraints.empty()) return;
    std::vector<const Equation*> pure, coupled, of_forces;
    bool friction = false;
    for (const Equation& e : a_.one.equations) {
      const bool rubs = has_forces_of_constraints(e.force);
      if (!e.of_motion)
        of_forces.push_back(&e);
      else
        (rubs || !e.multipliers.empty() ? coupled : pure).push_back(&e);
      friction = friction || (e.of_motion && rubs);
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
    for (const reading::ReadConstraint& c : a_.two.constraints) {
      if (!c.fixes || m_.is_eliminated(c.fixes->coordinate)) continue;
      out_.paragraph("By Approach II \\textbf{" + words(c.label) + "} takes " + a_.name_of(c.fixes->coordinate) +
                     " out, and its multiplier with it.");
    }
  }

  Article& a_;
  const mechanics::Mechanics& m_;
  LatexText& out_;
  std::vector<Partials> first_;                   // of Approach I
  std::map<std::uint32_t, std::string> numbers_;  // of the first equation of each coordinate
};

}  // namespace

void write_energies(Article& a) {
  a.out.section("Energies");
  const auto show = [&](const ReadingForm& form) {
    std::vector<Statement> all;
    if (!form.by_parts) add_angular_velocities(form, all);
    add_energies(a.m, form, all);
    a.out.display(a.formulas(all));
    if (!form.no_spins.empty()) a.left_out.push_back({"angular velocities", form.no_spins});
  };
  const bool spins = !a.one.spins.empty();
  if (spins)
    a.out.paragraph(
        "The components $\\omega$ are those of the angular velocities, along the axes about which the moments of "
        "inertia are taken.");
  show(a.one);
  if (!a.builds_in()) return;
  a.out.paragraph("With the constraints built in these are");
  show(a.two);
}

void write_equations(Article& a) {
  a.out.section("Lagrange's equations");
  Equations(a).write();
}

void write_constraint_forces(Article& a) {
  std::vector<Statement> all;
  add_reactions(a.one, all);
  add_constraint_forces(a.m, a.one, all);
  if (all.empty()) return;
  a.out.section("Constraint forces");
  a.out.display(a.formulas(all));
}

void write_contacts(Article& a) {
  std::vector<Statement> all;
  add_contacts(a.m, all);
  if (all.empty()) return;
  const bool rubs =
      std::any_of(a.m.contacts.begin(), a.m.contacts.end(), [](const auto& c) { return c.dimensions() > 0; });
  const bool opens = std::any_of(a.m.contacts.begin(), a.m.contacts.end(), [](const auto& c) { return c.unilateral; });
  a.out.section(rubs && opens ? "Contacts and friction" : rubs ? "Friction" : "Contacts that can be left");
  std::string name;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Statement& s = all[i];
    if (!s.left_out.empty()) {
      a.left_out.push_back({s.name + ", " + s.role, s.left_out});
      continue;
    }
    if (s.name != name) {
      if (!name.empty()) a.out.raw("\\end{longtable}\n");
      a.out.paragraph("\\textbf{" + words(s.name) + "}:");
      a.out.raw("\\begin{longtable}{@{}p{0.18\\linewidth}p{0.76\\linewidth}@{}}\n");
      name = s.name;
    }
    const bool again = i > 0 && all[i - 1].name == s.name && all[i - 1].role == s.role;
    a.out.raw((again ? "" : words(s.role)) + " & " + a.out.cell(s.formula, 58) + " \\\\[4pt]\n");
  }
  if (!name.empty()) a.out.raw("\\end{longtable}\n");
}

}  // namespace eomgen::print

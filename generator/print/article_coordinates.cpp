// SPDX-License-Identifier: GPL-3.0-or-later
// Coordinates, functions of time, constraints and their multipliers.
#include <algorithm>

#include "print/article_parts.hpp"

namespace eomgen::print {

namespace {

constexpr const char* joint_letters =
    "Of a joint, a is its axis in the first body, a1 and a2 are directions across it, b is its axis in the second "
    "body; b2, g1, g2 and g3 are fixed in the second body, and at the start what a2 and the axes f1, f2 and f3 of the "
    "first body are.";

class Coordinates {
 public:
  explicit Coordinates(Article& a) : a_(a), m_(a.m), model_(a.model), out_(a.out) {
    add_constraints(m_, a.one, statements_);
  }

  void write() {
    table();
    basis();
    functions();
    for (const reading::DisplayConstraint& c : a_.one.constraints) constraint(c);
    for (std::uint32_t k = 0; k < m_.constraints.size(); ++k) {
      if (m_.is_independent(k)) continue;
      const bool identity = m_.constraints[k].redundancy == mechanics::Redundancy::identity;
      out_.paragraph(bold(m_.constraints[k].label) +
                     (identity ? " holds identically" : " follows from the other constraints") +
                     ": it has no multiplier.");
    }
    integrals();
    legend();
  }

 private:
  void legend() {
    const std::vector<MultiplierDescription> all = multiplier_descriptions(m_);
    if (all.empty()) return;
    out_.paragraph("The multipliers are");
    out_.raw("\\begin{longtable}{@{}lp{0.8\\linewidth}@{}}\n");
    for (const MultiplierDescription& meaning : all) {
      out_.raw(out_.math(reading::symbol({SymbolKind::multiplier, meaning.constraint, 0})) + " & " +
               escape_user_text(meaning.text) + " \\\\\n");
    }
    out_.raw("\\end{longtable}\n");
    if (!model_.joints.empty()) out_.paragraph(joint_letters);
  }

  std::string role(std::uint32_t i) const {
    const auto of = [i](const reading::DisplayConstraint& c) { return c.fixes && c.fixes->coordinate == i; };
    const auto first = std::find_if(a_.one.constraints.begin(), a_.one.constraints.end(), of);
    if (first != a_.one.constraints.end()) return "fixed by " + bold(first->label);
    const auto second = std::find_if(a_.two.constraints.begin(), a_.two.constraints.end(), of);
    return second != a_.two.constraints.end()
               ? "given by the others through " + bold(second->label) + ", in Approach II"
               : "";
  }

  void table() {
    out_.raw(
        "\\begin{longtable}{@{}lllp{0.5\\linewidth}@{}}\n\\emph{coordinate} & \\emph{unit} & \\emph{range} & "
        "\\\\\n\\endhead\n");
    for (std::uint32_t i = 0; i < model_.coordinates.size(); ++i) {
      const model::Coordinate& q = model_.coordinates[i];
      const auto bound = [&](model::NodeId node) {
        const std::optional<Formula> written =
            node == model::no_node ? std::nullopt : reading::as_written(model_, node);
        return written ? out_.math(*written) : std::string();
      };
      const std::string lower = bound(q.lower), upper = bound(q.upper);
      std::string range = lower.empty() && upper.empty() ? "" : a_.coordinate_math(i);
      if (!lower.empty()) range = lower + " $<$ " + range;
      if (!upper.empty()) range += " $<$ " + upper;
      out_.raw(a_.coordinate_math(i) + " & " + unit_in_latex(q.unit.text) + " & " + range + " & " + role(i) +
               " \\\\\n");
    }
    out_.raw("\\end{longtable}\n");
  }

  /// For one particle in curvilinear coordinates, eq. (2.107).
  void basis() {
    if (m_.masses.size() != 1 || !model_.bodies.empty()) return;
    const model::Place& place = model_.places[m_.masses.front().place];
    if (!place.chart || place.chart->system == "cartesian") return;
    std::vector<Statement> all;
    add_geometry(m_, {"basis"}, all);
    std::erase_if(all, [](const Statement& s) { return s.left_out.empty() && s.role != "covariant"; });
    const std::vector<Formula> shown = a_.formulas(all);
    if (shown.empty()) return;
    out_.paragraph("The covariant basis vectors $\\mathbf{a}_q = \\partial\\mathbf{r}/\\partial q$ are");
    out_.display(shown);
  }

  void functions() {
    std::vector<Formula> shown;
    for (const Statement& s : statements_) {
      if (s.role == "function of time") shown.push_back(s.formula);
    }
    if (shown.empty()) return;
    out_.paragraph(shown.size() == 1 ? "A function of time is given:" : "Functions of time are given:");
    out_.display(shown);
  }

  static std::string reason(const std::string& sentence) {
    static const std::string form = escape_user_text("omega ^ d omega");
    std::string text = escape_user_text(sentence);
    if (const std::size_t at = text.find(form); at != std::string::npos)
      text.replace(at, form.size(), "$\\omega \\wedge d\\omega$");
    return text;
  }

  std::string kind(const reading::DisplayConstraint& read) const {
    const mechanics::Constraint& c = m_.constraints[read.constraint];
    const mechanics::ConstraintClassification& found = m_.classification[read.constraint];
    const bool moves = !m_.dag->is_zero(c.rate);
    std::string text;
    if (c.holonomic()) {
      text = std::string("holonomic and ") +
             (moves ? "rheonomic (it depends on the time)" : "scleronomic (it does not depend on the time)");
    } else {
      text = found.integrable == mechanics::Integrability::yes ? "on velocities, and integrable"
             : found.integrable == mechanics::Integrability::no
                 ? "nonholonomic: on velocities, and not integrable"
                 : "on velocities; it is not known whether it is integrable";
      if (!found.reason.empty()) text += " (" + reason(found.reason) + ")";
      if (moves) text += "; rheonomic (a part of it is free of velocities)";
    }
    if (c.unilateral) text += "; unilateral: it pushes and does not pull";
    if (read.fixes) text += "; it fixes " + a_.coordinate_math(read.fixes->coordinate);
    return text;
  }

  static bool is_derivative(const std::string& role) { return role.starts_with("its ") && role != "its integral"; }

  void constraint(const reading::DisplayConstraint& c) {
    out_.paragraph("The constraint " + bold(c.label) + " is " + kind(c) + ":");
    std::vector<Statement> group;
    std::string role;
    const auto flush = [&] {
      if (group.empty()) return;
      const bool derived = role.starts_with("its ");
      if (is_derivative(role) && a_.omits("constraint_derivatives")) return group.clear();
      const std::vector<Formula> shown = a_.formulas(group);
      if (derived && !shown.empty()) out_.paragraph("I" + role.substr(1) + ":");
      out_.display(shown);
      group.clear();
    };
    for (const Statement& s : statements_) {
      if (s.name != c.label || s.role == "function of time") continue;
      if (s.role != role) flush();
      role = s.role;
      group.push_back(s);
    }
    flush();
  }

  /// For constraints that are integrable only together.
  void integrals() {
    for (const mechanics::ConstraintIntegral& integral : m_.integrals) {
      if (integral.constraints.size() < 2) continue;
      std::vector<std::string> names;
      for (const std::uint32_t k : integral.constraints) names.push_back(bold(m_.constraints[k].label));
      out_.paragraph("The integral of " + bold(integral.label) + " is one of " + enumeration(names) + " together.");
    }
  }

  Article& a_;
  const Mechanics& m_;
  const model::Model& model_;
  LatexWriter& out_;
  std::vector<Statement> statements_;
};

}  // namespace

void write_coordinates(Article& a) {
  a.out.section(a.one.constraints.empty() ? "Coordinates" : "Coordinates and constraints");
  Coordinates(a).write();
}

}  // namespace eomgen::print

// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/article.hpp"

#include <algorithm>

#include "model/names.hpp"
#include "print/article_parts.hpp"

namespace eomgen::print {

using mechanics::Mechanics;
using reading::Formula;
using symbolic::SymbolKind;

bool Article::builds_in() const {
  const auto fixes = [](const reading::ReadConstraint& c) { return c.fixes.has_value(); };
  return std::any_of(two.constraints.begin(), two.constraints.end(), fixes);
}

std::string Article::name_of(std::uint32_t coordinate, std::uint8_t order) const {
  return out.math(reading::symbol({SymbolKind::coordinate, coordinate, order}));
}

std::vector<Formula> Article::formulas(const std::vector<Statement>& statements) {
  std::vector<Formula> result;
  for (const Statement& s : statements) {
    if (s.left_out.empty())
      result.push_back(s.formula);
    else
      left_out.push_back({s.name + (s.role.empty() ? "" : ", " + s.role), s.left_out});
  }
  return result;
}

namespace {

constexpr const char* joint_letters =
    "Of a joint, a is its axis in the first body, a1 and a2 are directions across it, b is its axis in the second "
    "body; b2, g1, g2 and g3 are fixed in the second body, and at the start what a2 and the axes f1, f2 and f3 of the "
    "first body are.";
constexpr std::size_t longest_position = 12;  // terms
constexpr std::size_t longest_value = 30;     // printed characters on a line of a table

bool uses_amssymb(const model::Model& model) {
  const auto in = [](const auto& list) {
    return std::any_of(list.begin(), list.end(), [](const auto& named) { return model::needs_amssymb(named.tex); });
  };
  return in(model.parameters) || in(model.inputs) || in(model.functions) || in(model.coordinates);
}

std::string number_word(std::size_t n, const char* one, const char* many) {
  static constexpr std::array<const char*, 10> small{"no",   "one", "two",   "three", "four",
                                                     "five", "six", "seven", "eight", "nine"};
  return (n < small.size() ? small[n] : std::to_string(n)) + " " + (n == 1 ? one : many);
}

std::string bold(const std::string& name) { return "\\textbf{" + words(name) + "}"; }

class System {
 public:
  explicit System(Article& a) : a_(a), m_(a.m), model_(a.model), out_(a.out) {}

  void write() {
    counts();
    for (const mechanics::PointMass& mass : m_.masses) describe(mass);
    if (model_.energy.kinetic != model::no_node)
      out_.paragraph("The kinetic energy is given as an expression of coordinates and rates.");
    parameters();
    inputs();
    forces();
  }

 private:
  void counts() {
    const std::size_t bodies = model_.bodies.size(), particles = m_.masses.size() - bodies;
    std::vector<std::string> parts;
    if (particles > 0) parts.push_back(number_word(particles, "particle", "particles"));
    if (bodies > 0) parts.push_back(number_word(bodies, "rigid body", "rigid bodies"));
    std::size_t constraints = 0;
    for (std::uint32_t k = 0; k < m_.constraints.size(); ++k) constraints += m_.holds(k) ? 1 : 0;
    const long freedom = m_.freedom();
    std::string text = parts.empty() ? "The system is described"
                                     : "The system consists of " + enumeration(parts) + ". It is described";
    text += " by " + number_word(model_.coordinates.size(), "coordinate", "coordinates") + " and subject to " +
            number_word(constraints, "constraint equation", "constraint equations");
    text += freedom > 0 ? ", which leaves " + number_word(static_cast<std::size_t>(freedom), "degree of freedom.",
                                                          "degrees of freedom.")
                        : ", which prescribes all of its motion.";
    out_.paragraph(text);
  }

  std::string value(model::NodeId node) const {
    const std::optional<Formula> written = node == model::no_node ? std::nullopt : reading::as_written(model_, node);
    return written ? out_.math(*written) : "";
  }

  std::string entries(const std::vector<model::NodeId>& list) const {
    std::vector<std::string> result;
    for (const model::NodeId entry : list) {
      const std::string written = value(entry);
      if (!written.empty()) result.push_back(written);
    }
    return enumeration(result);
  }

  void describe(const mechanics::PointMass& mass) {
    const auto body = std::find_if(model_.bodies.begin(), model_.bodies.end(),
                                   [&](const model::Body& b) { return b.place == mass.place; });
    const bool is_body = body != model_.bodies.end();
    const model::Place& place = model_.places[mass.place];
    std::string text = bold(mass.name) + (is_body ? ": a rigid body" : ": a particle");
    if (const auto m = read_short(mass.mass)) text += " of mass " + out_.math(reading::arrange(*m));
    if (place.chart) {
      std::vector<model::NodeId> slots(place.chart->entries.begin(), place.chart->entries.end());
      const std::string of = entries(slots),
                        from = place.from == 0 ? "" : " from " + bold(model_.places[place.from].name);
      if (!of.empty())
        text += (is_body ? ", its centre of mass in " : ", in ") +
                (place.chart->system == "cartesian" ? "Cartesian" : words(place.chart->system)) + " coordinates " + of +
                from;
    }
    if (is_body) {
      const model::Frame& frame = model_.frames[body->frame];
      const std::string angles = entries(frame.entries);
      if (!angles.empty())
        text += "; its axes are turned by " + rotation(frame) + " " + angles +
                (frame.parent == 0 ? "" : " against those of " + bold(model_.frames[frame.parent].name));
      text += inertia(*body);
    }
    out_.paragraph(text + ".");
    position(mass);
  }

  std::string rotation(const model::Frame& frame) const {
    std::string name = frame.rotation;
    std::replace(name.begin(), name.end(), '_', ' ');
    const bool digits = !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
    if (!digits) return words(name);
    std::string dashed;
    for (const char c : name) dashed += (dashed.empty() ? "" : "-") + std::string(1, c);
    return dashed + " Euler angles";
  }

  std::string inertia(const model::Body& body) const {
    std::vector<std::string> diagonal;
    for (std::size_t i = 0; i < 3; ++i) {
      diagonal.push_back(value(body.inertia[i][i]));
      for (std::size_t k = 0; k < 3; ++k) {
        if (i != k && body.inertia[i][k] != model::no_node && !is_zero(body.inertia[i][k])) return "";
      }
      if (diagonal.back().empty()) return "";
    }
    return "; its moments of inertia about its own axes are " + enumeration(diagonal);
  }
  bool is_zero(model::NodeId node) const {
    const std::optional<Formula> f = reading::as_written(model_, node);
    return f && reading::is_zero(*f);
  }

  std::optional<reading::Sum> read_short(symbolic::Ref expression) const {
    try {
      reading::Sum sum = reading::read(m_, expression);
      if (sum.size() <= longest_position) return sum;
    } catch (const work::OverBudget&) {  // a position that is too long to be read says nothing here
    }
    return std::nullopt;
  }

  void position(const mechanics::PointMass& mass) {
    reading::Components r;
    std::vector<Formula> axes;
    std::size_t terms = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto component = read_short(mass.position[k]);
      if (!component) return;
      r[k] = *component;
      terms += component->size();
      axes.push_back(reading::mark("E", {reading::number(static_cast<long>(k + 1))}));
    }
    if (terms == 0 || terms > longest_position) return;
    std::vector<Formula> index;
    if (m_.masses.size() > 1) index.push_back(reading::number(static_cast<long>(mass.place)));
    out_.display({reading::relation({reading::mark("r", std::move(index)), combination(r, axes)})});
  }

  void parameters() {
    if (model_.parameters.empty()) return;
    const bool notes = std::any_of(model_.parameters.begin(), model_.parameters.end(),
                                   [](const model::Parameter& p) { return !p.note.empty(); });
    std::vector<std::string> values;
    bool all_short = true;
    for (const model::Parameter& p : model_.parameters) {
      const std::optional<Formula> written =
          p.value == model::no_node ? std::nullopt : reading::as_written(model_, p.value);
      const bool is_short = !written || out_.lines(*written, longest_value).size() == 1;
      values.push_back(!written ? "" : is_short ? out_.math(*written) : out_.cell(*written, longest_value));
      all_short = all_short && is_short;
    }
    out_.raw(std::string("\\begin{longtable}{@{}l") + (all_short ? "l" : "p{0.42\\linewidth}") + "l" +
             (notes ? "p{0.3\\linewidth}" : "") + "@{}}\n" + "\\emph{parameter} & \\emph{value} & \\emph{unit}" +
             (notes ? " & " : "") + " \\\\\n\\endhead\n");
    for (std::uint32_t i = 0; i < model_.parameters.size(); ++i) {
      const model::Parameter& p = model_.parameters[i];
      out_.raw(out_.math(reading::symbol({SymbolKind::parameter, i, 0})) + " & " + values[i] + " & " +
               unit_in_latex(p.unit.text) + (notes ? " & " + words(p.note) : "") + " \\\\[2pt]\n");
    }
    out_.raw("\\end{longtable}\n");
  }

  void inputs() {
    std::vector<std::string> names;
    for (std::uint32_t i = 0; i < model_.inputs.size(); ++i) {
      const std::string unit = unit_in_latex(model_.inputs[i].unit.text);
      names.push_back(out_.math(reading::symbol({SymbolKind::input, i, 0})) + (unit.empty() ? "" : " (" + unit + ")"));
    }
    if (!names.empty()) out_.paragraph("Inputs, given from outside: " + enumeration(names) + ".");
  }

  void forces() {
    if (a_.findings == nullptr || model_.forces.empty()) return;
    out_.paragraph("The forces that act, beside those of the constraints:");
    for (std::size_t i = 0; i < model_.forces.size(); ++i) force(i);
  }

  void force(std::size_t i) {
    const ForceFinding& found = a_.findings->forces[i];
    std::string text = bold(model_.forces[i].name) + ": ";
    std::vector<Formula> shown;
    const char* letter = model_.forces.size() > 1 ? "U" : nullptr;
    if (found.conservative == "yes")
      text += found.many_valued ? "conservative where its potential is not followed around its singular points"
                                : "conservative";
    else
      text += found.conservative == "no" ? "not conservative" : "not known to be conservative";
    if (!found.reason.empty()) text += " (" + words(found.reason) + ")";
    if (found.conservative == "yes" && found.potential) {
      if (const auto U = read_short(*found.potential)) {
        std::vector<Formula> index;
        if (letter != nullptr) index.push_back(reading::number(static_cast<long>(i + 1)));
        const Letters letters(model_, false);
        shown.push_back(reading::relation({reading::mark(letters.U, std::move(index)), reading::arrange(*U)}));
      }
    } else {
      for (std::uint32_t q = 0; q < model_.coordinates.size(); ++q) {
        const auto Q = read_short(m_.force_components[i][q]);
        if (!Q || Q->is_zero()) continue;
        shown.push_back(reading::relation(
            {reading::mark("Q", {reading::symbol({SymbolKind::coordinate, q, 0})}), reading::arrange(*Q)}));
      }
    }
    out_.paragraph(text + (shown.empty() ? "." : ","));
    out_.display(shown);
  }

  Article& a_;
  const Mechanics& m_;
  const model::Model& model_;
  LatexText& out_;
};

class Coordinates {
 public:
  explicit Coordinates(Article& a) : a_(a), m_(a.m), model_(a.model), out_(a.out) {
    add_constraints(m_, a.one, statements_);
  }

  void write() {
    table();
    basis();
    functions();
    for (const reading::ReadConstraint& c : a_.one.constraints) constraint(c);
    for (std::uint32_t k = 0; k < m_.constraints.size(); ++k) {
      if (m_.holds(k)) continue;
      const bool identity = m_.constraints[k].need == mechanics::Need::identity;
      out_.paragraph(bold(m_.constraints[k].label) +
                     (identity ? " holds identically" : " follows from the other constraints") +
                     ": it has no multiplier.");
    }
    integrals();
    legend();
  }

 private:
  void legend() {
    const std::vector<MultiplierMeaning> all = multiplier_meanings(m_);
    if (all.empty()) return;
    out_.paragraph("The multipliers are");
    out_.raw("\\begin{longtable}{@{}lp{0.8\\linewidth}@{}}\n");
    for (const MultiplierMeaning& meaning : all) {
      out_.raw(out_.math(reading::symbol({SymbolKind::multiplier, meaning.constraint, 0})) + " & " +
               words(meaning.text) + " \\\\\n");
    }
    out_.raw("\\end{longtable}\n");
    if (!model_.joints.empty()) out_.paragraph(joint_letters);
  }

  std::string role(std::uint32_t i) const {
    const auto of = [i](const reading::ReadConstraint& c) { return c.fixes && c.fixes->coordinate == i; };
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
      std::string range = lower.empty() && upper.empty() ? "" : a_.name_of(i);
      if (!lower.empty()) range = lower + " $<$ " + range;
      if (!upper.empty()) range += " $<$ " + upper;
      out_.raw(a_.name_of(i) + " & " + unit_in_latex(q.unit.text) + " & " + range + " & " + role(i) + " \\\\\n");
    }
    out_.raw("\\end{longtable}\n");
  }

  /// Of one particle in curvilinear coordinates, as (2.107) has it.
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
    static const std::string form = words("omega ^ d omega");
    std::string text = words(sentence);
    if (const std::size_t at = text.find(form); at != std::string::npos)
      text.replace(at, form.size(), "$\\omega \\wedge d\\omega$");
    return text;
  }

  std::string kind(const reading::ReadConstraint& read) const {
    const mechanics::Constraint& c = m_.constraints[read.constraint];
    const mechanics::Classification& found = m_.classification[read.constraint];
    const bool moves = !m_.dag->is_zero(c.rate);
    std::string text;
    if (c.holonomic()) {
      text = std::string("holonomic and ") +
             (moves ? "rheonomic (it depends on the time)" : "scleronomic (it does not depend on the time)");
    } else {
      text = found.integrable == mechanics::Integrable::yes ? "on velocities, and integrable"
             : found.integrable == mechanics::Integrable::no
                 ? "nonholonomic: on velocities, and not integrable"
                 : "on velocities; it is not known whether it is integrable";
      if (!found.reason.empty()) text += " (" + reason(found.reason) + ")";
      if (moves) text += "; rheonomic (a part of it is free of velocities)";
    }
    if (c.unilateral) text += "; unilateral: it pushes and does not pull";
    if (read.fixes) text += "; it fixes " + a_.name_of(read.fixes->coordinate);
    return text;
  }

  void constraint(const reading::ReadConstraint& c) {
    out_.paragraph("The constraint " + bold(c.label) + " is " + kind(c) + ":");
    std::vector<Statement> group;
    std::string role;
    const auto flush = [&] {
      if (group.empty()) return;
      const bool derived = role.starts_with("its ");
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

  /// Of constraints that are integrable together only.
  void integrals() {
    for (const mechanics::Integral& integral : m_.integrals) {
      if (integral.of.size() < 2) continue;
      std::vector<std::string> names;
      for (const std::uint32_t k : integral.of) names.push_back(bold(m_.constraints[k].label));
      out_.paragraph("The integral of " + bold(integral.label) + " is one of " + enumeration(names) + " together.");
    }
  }

  Article& a_;
  const Mechanics& m_;
  const model::Model& model_;
  LatexText& out_;
  std::vector<Statement> statements_;
};

}  // namespace

void write_system(Article& a) {
  a.out.section("System");
  System(a).write();
}

void write_coordinates(Article& a) {
  a.out.section(a.one.constraints.empty() ? "Coordinates" : "Coordinates and constraints");
  Coordinates(a).write();
}

std::string latex_document(const Mechanics& m, const reading::ReadingForm& one, const reading::ReadingForm& two,
                           const std::optional<Findings>& findings) {
  const Notation notation(m);
  LatexText out(notation);
  const model::Model& model = *m.model;
  Article article{m, model, one, two, findings ? &*findings : nullptr, out};
  if (findings) article.left_out = findings->left_out;
  out.title(model.title.empty() ? model.id : model.title);
  if (!model.notes.empty()) out.paragraph(words(model.notes));
  write_system(article);
  write_coordinates(article);
  write_energies(article);
  write_equations(article);
  write_constraint_forces(article);
  write_contacts(article);
  if (findings) {
    write_conserved(article);
    write_routh(article);
    write_steady(article);
  }
  write_singular(article);
  write_certificate(article);
  return out.finish(uses_amssymb(model));
}

}  // namespace eomgen::print

// SPDX-License-Identifier: GPL-3.0-or-later
// Bases, metrics, line elements, Christoffel symbols and singular sets as formulas; zeros are omitted.
#include <algorithm>

#include "print/formulas.hpp"

namespace eomgen::print {
namespace {

using reading::Components;
using reading::Geometry;
using reading::SymbolKind;

Formula coordinate_letter(std::uint32_t i) { return reading::symbol({SymbolKind::coordinate, i, 0}); }

// qdot_i -> dq_i
Formula with_differentials(const Formula& f) {
  if (f.kind == FormulaKind::symbol && f.symbol.kind == SymbolKind::coordinate && f.symbol.order == 1) {
    return reading::make_formula(FormulaKind::differential, {coordinate_letter(f.symbol.index)});
  }
  Formula result = f;
  for (Formula& arg : result.args) arg = with_differentials(arg);
  return result;
}

class Tables {
 public:
  Tables(const Geometry& geometry, std::string letter, std::vector<Statement>& out)
      : g_(geometry), n_(geometry.coordinates.size()), letter_(std::move(letter)), out_(out) {}

  void basis() {
    std::vector<Formula> fixed, unit;
    for (int k = 1; k <= 3; ++k) fixed.push_back(mark("E", {reading::number(k)}));
    for (const std::optional<std::uint32_t>& name : g_.unit_names) {
      unit.push_back(name ? mark("e", {coordinate_letter(*name)}) : mark("e"));
    }
    const auto add = [&](const char* role, const Formula& left, const std::vector<Components>& in_fixed,
                         const std::vector<Components>& in_unit, std::size_t i) {
      std::vector<Formula> sides{left};
      if (!in_unit.empty()) sides.push_back(combination(in_unit[i], unit));
      sides.push_back(combination(in_fixed[i], fixed));
      out_.push_back({"basis", g_.name, "", role, reading::relation(std::move(sides))});
    };
    for (std::size_t i = 0; i < n_; ++i) add("covariant", mark("a", {q(i)}), g_.covariant, g_.covariant_unit, i);
    if (g_.inverse.empty()) return;
    for (std::size_t i = 0; i < n_; ++i) {
      add("contravariant", mark("a", {}, {q(i)}), g_.contravariant, g_.contravariant_unit, i);
    }
  }

  void metric() {
    const std::string scalar = letter_ == "a" ? "metric a" : letter_;
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t k = i; k < n_; ++k)
        entry("metric", mark(scalar, {q(i), q(k)}), g_.metric[i * n_ + k], "covariant");
    }
    for (std::size_t i = 0; i < n_ && !g_.inverse.empty(); ++i) {
      for (std::size_t k = i; k < n_; ++k)
        entry("metric", mark(scalar, {}, {q(i), q(k)}), g_.inverse[i * n_ + k], "contravariant");
    }
    if (g_.inverse.empty()) return;
    out_.push_back({"metric", g_.name, "", "determinant",
                    reading::relation({mark("det " + letter_), reading::factored(g_.determinant)})});
  }

  void line_element() {
    out_.push_back({"line_element", g_.name, "", "",
                    reading::relation({mark("ds^2"), with_differentials(arrange(g_.line_element))})});
  }

  void christoffel() {
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = i; j < n_; ++j) {
        for (std::size_t k = 0; k < n_; ++k) {
          entry("christoffel", mark("[]", {q(i), q(j), q(k)}), g_.first[(i * n_ + j) * n_ + k], "first kind");
        }
      }
    }
    for (std::size_t k = 0; k < n_ && !g_.second.empty(); ++k) {
      for (std::size_t i = 0; i < n_; ++i) {
        for (std::size_t j = i; j < n_; ++j) {
          entry("christoffel", mark("Gamma", {q(i), q(j)}, {q(k)}), g_.second[(i * n_ + j) * n_ + k], "second kind");
        }
      }
    }
  }

 private:
  Formula q(std::size_t i) const { return coordinate_letter(g_.coordinates[i]); }
  void entry(const char* key, Formula left, const Sum& right, const char* role) {
    if (right.is_zero()) return;
    out_.push_back(
        {key, g_.name, "", role,
         reading::relation(
             {std::move(left),
              arrange(right, right.size() > 6 ? Layout::terms : Layout::grouped)})});  // brackets must fit on a line
  }

  const Geometry& g_;
  std::size_t n_;
  std::string letter_;
  std::vector<Statement>& out_;
};

void tabulate(Tables tables, const std::string& key) {
  if (key == "basis") tables.basis();
  if (key == "metric") tables.metric();
  if (key == "line_element") tables.line_element();
  if (key == "christoffel") tables.christoffel();
}

}  // namespace

Formula combination(const Components& components, const std::vector<Formula>& vectors) {
  std::vector<Formula> terms;
  for (std::size_t k = 0; k < 3; ++k) {
    if (components[k].is_zero()) continue;
    const bool minus = reading::has_negative_leading_term(components[k]);
    Formula term = reading::product({arrange(minus ? -components[k] : components[k]), vectors[k]});
    terms.push_back(minus ? reading::negative(std::move(term)) : std::move(term));
  }
  return reading::sum(std::move(terms));
}

void add_geometry(const Mechanics& m, const std::vector<std::string>& keys, std::vector<Statement>& out) {
  std::vector<reading::LeftOut> unseen;
  const std::vector<Geometry> particles = reading::geometry(m, &unseen);
  // The configuration manifold of one free particle is its space; every other system has a metric of its own.
  const bool whole = m.masses.size() != 1 || particles.empty() || !m.fixed.empty();
  const bool needed =
      whole && std::any_of(keys.begin(), keys.end(), [](const std::string& key) { return key != "basis"; });
  const std::optional<Geometry> system = needed ? reading::configuration_space(m, &unseen) : std::nullopt;
  for (reading::LeftOut& l : unseen) out.push_back(left_out(keys.front(), std::move(l.what), "", std::move(l.why)));
  for (const std::string& key : keys) {
    for (const Geometry& g : particles) tabulate(Tables(g, "a", out), key);
    if (!system || key == "basis") continue;
    const std::size_t first = out.size();
    tabulate(Tables(*system, "M", out), key);
    for (std::size_t i = first; i < out.size(); ++i) out[i].name = "configuration manifold";
  }
}

void add_singular(const Mechanics& m, std::vector<Statement>& out) {
  std::vector<reading::LeftOut> unseen;
  for (const reading::SingularSet& set : reading::singular_sets(m, &unseen)) {
    Formula formula = reading::relation({arrange(set.factor), reading::number(0)});
    if (!set.solutions.empty()) formula = reading::make_formula(FormulaKind::list, set.solutions);
    out.push_back({"singular", "", "", set.approach, std::move(formula)});
  }
  for (reading::LeftOut& l : unseen) out.push_back(left_out("singular", std::move(l.what), "", std::move(l.why)));
}

}  // namespace eomgen::print

// SPDX-License-Identifier: GPL-3.0-or-later
// The Frenet triad of a curve as formulas, eqs. (2.130), (2.131).
#include <algorithm>

#include "print/formulas.hpp"
#include "reading/frenet.hpp"

namespace eomgen::print {
namespace {

using reading::Components;
using reading::FrenetVector;

// The common denominator of all components, such as sqrt(1 + alpha^2).
reading::Monomial common_denominator(const Components& v) {
  std::optional<reading::Monomial> common;
  for (const Sum& component : v) {
    if (component.is_zero()) continue;
    const reading::Monomial present = reading::content(component).monomial;
    reading::Monomial both;
    for (const reading::Factor& f : common.value_or(present)) {
      for (const reading::Factor& g : present) {
        if (reading::compare(*f.atom, *g.atom) != 0 || !cln::minusp(f.exponent) || !cln::minusp(g.exponent)) continue;
        both.push_back({f.atom, f.exponent < g.exponent ? g.exponent : f.exponent});
      }
    }
    common = std::move(both);
  }
  return common.value_or(reading::Monomial{});
}

Formula in_terms_of(Components v, const std::vector<Formula>& vectors) {
  const auto terms = std::count_if(v.begin(), v.end(), [](const Sum& x) { return !x.is_zero(); });
  const reading::Monomial under = reading::inverse(common_denominator(v));
  if (terms < 2 || under.empty()) return combination(v, vectors);
  const Sum denominator = reading::multiply(under, {});
  for (Sum& component : v) {
    if (!component.is_zero()) component = reading::divide(component, {1, reading::inverse(under)});
  }
  return reading::fraction(combination(v, vectors), arrange(denominator));
}

// A sum as a quotient by the common denominator of its terms.
Formula as_quotient(const Sum& x) {
  const reading::Monomial under = reading::inverse(common_denominator({x, Sum(), Sum()}));
  if (x.size() < 2 || under.empty()) return arrange(x);
  const Sum denominator = reading::multiply(under, {});
  return reading::fraction(arrange(reading::divide(x, {1, reading::inverse(under)})), arrange(denominator));
}

bool same(const Components& a, const Components& b) { return a[0] == b[0] && a[1] == b[1] && a[2] == b[2]; }

}  // namespace

void add_frenet(const mechanics::Mechanics& m, bool asked, std::vector<Statement>& out) {
  if (!asked && !reading::curve_obstacle(m).empty()) return;
  reading::Frenet f;
  try {
    f = reading::frenet(m);
  } catch (const work::BudgetExceeded& over) {
    out.push_back(left_out("frenet", m.masses[0].name, "", over.what()));
    return;
  } catch (const Error&) {  // two constraints with the same gradients, which only
                            // the construction of the curve detects
    if (asked) throw;
    return;
  }
  std::vector<Formula> fixed, unit;
  for (int k = 1; k <= 3; ++k) fixed.push_back(mark("E", {reading::number(k)}));
  for (const std::uint32_t i : f.unit_names)
    unit.push_back(mark("e", {reading::symbol({reading::SymbolKind::coordinate, i, 0})}));
  const auto add = [&](const char* role, Formula formula) {
    out.push_back({"frenet", f.name, "", role, std::move(formula)});
  };
  const auto vector = [&](const char* role, const char* letter, const FrenetVector& v) {
    std::vector<Formula> sides{mark("e", {mark(letter)})};
    if (v.unit && !same(*v.unit, v.fixed)) sides.push_back(in_terms_of(*v.unit, unit));
    sides.push_back(in_terms_of(v.fixed, fixed));
    add(role, reading::relation(std::move(sides)));
  };
  vector("tangent", "t", f.tangent);
  if (f.normal) vector("normal", "n", *f.normal);
  if (f.binormal) vector("binormal", "b", *f.binormal);
  add("curvature", reading::relation({mark("kappa"), as_quotient(f.curvature)}));
  if (f.torsion) add("torsion", reading::relation({mark("tau"), as_quotient(*f.torsion)}));
  if (f.along) {
    const Formula q = reading::symbol({reading::SymbolKind::coordinate, *f.along, 0});
    add("arc length",
        reading::relation(
            {reading::make_formula(reading::FormulaKind::differential, {mark("s")}),
             reading::product({arrange(f.speed), reading::make_formula(reading::FormulaKind::differential, {q})})}));
  }
}

}  // namespace eomgen::print

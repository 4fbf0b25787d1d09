// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/constrained_roots.hpp"

#include <cln/rational.h>

#include <algorithm>

#include "reading/reading.hpp"
#include "reading/trig.hpp"

namespace eomgen::reading {
namespace {

const Rational half = Rational(1) / 2;

/// Whether only parameters and the time occur.
bool is_given(const Sum& sum) {
  bool given = true;
  for_each_atom(sum, [&given](const Atom& atom) {
    given = given && (atom.op != Op::symbol || atom.symbol.kind == SymbolKind::parameter ||
                      atom.symbol.kind == SymbolKind::time);
  });
  return given;
}

bool is_power_of_sum(const Factor& factor) {
  return factor.atom->op == Op::add && !(is_integer(factor.exponent) && cln::plusp(factor.exponent));
}

/// base = value where the constraint holds: psi is a multiple of base and a given sum.
std::optional<Sum> value_of(const Sum& base, const Sum& psi) {
  for (const auto& [monomial, coefficient] : base.terms()) {
    if (is_given(Sum(monomial, 1))) continue;
    const auto same = psi.terms().find(monomial);
    if (same == psi.terms().end()) return std::nullopt;
    const Sum value = base - (coefficient / same->second) * psi;
    return is_given(value) && value.size() < base.size() ? std::optional(value) : std::nullopt;
  }
  return std::nullopt;
}

/// sqrt(base) = value where the constraint holds: psi is a multiple of the root and a given sum.
std::optional<Sum> root_of(const AtomPtr& base, const Sum& psi) {
  const Monomial root{{base, half}};
  const auto term = psi.terms().find(root);
  if (term == psi.terms().end()) return std::nullopt;
  const Sum value = Sum(root, 1) - cln::recip(term->second) * psi;
  return is_given(value) && value.size() < base->args[0].size() ? std::optional(value) : std::nullopt;
}

/// base^exponent; nothing if no constraint gives it.
std::optional<Sum> given_power(const Factor& factor, const std::vector<Sum>& psi) {
  for (const Sum& each : psi) {
    if (const std::optional<Sum> root = root_of(factor.atom, each)) return power(*root, 2 * factor.exponent);
    if (const std::optional<Sum> value = value_of(factor.atom->args[0], each)) return power(*value, factor.exponent);
  }
  return std::nullopt;
}

}  // namespace

Sum ConstrainedRoots::operator()(const Sum& sum) const {
  const bool has_powers = std::any_of(sum.terms().begin(), sum.terms().end(), [](const auto& term) {
    return std::any_of(term.first.begin(), term.first.end(), is_power_of_sum);
  });
  if (!has_powers) return sum;
  if (!psi_) psi_ = find_();
  Sum result;
  bool changed = false;
  for (const auto& [monomial, coefficient] : sum.terms()) {
    Monomial kept;
    Sum given = 1;
    for (const Factor& factor : monomial) {
      const std::optional<Sum> value = is_power_of_sum(factor) ? given_power(factor, *psi_) : std::nullopt;
      if (value) {
        given = given * *value;
        changed = true;
      } else {
        kept.push_back(factor);
      }
    }
    result += given * Sum(std::move(kept), coefficient);
  }
  return changed ? simplify(result) : sum;
}

ConstrainedRoots constrained_roots(const mechanics::Mechanics& m) {
  return ConstrainedRoots([&m] {
    std::vector<Sum> psi;
    for (std::uint32_t k = 0; k < m.constraints.size(); ++k) {
      if (!m.constraints[k].holonomic() || !m.is_independent(k) || m.constraints[k].unilateral) continue;
      try {
        psi.push_back(display_sum(m, m.constraints[k].psi));
      } catch (const work::BudgetExceeded&) {  // other constraints still give their roots
      }
    }
    return psi;
  });
}

}  // namespace eomgen::reading

// SPDX-License-Identifier: GPL-3.0-or-later
// [[constraint]]s whose coefficients are combinations of others at every sample point: they are redundant or
// contradictory. Those that the user could omit are rejected. Equations that cannot be omitted, as of rolling, get no
// multiplier.
#include <cln/integer.h>
#include <cln/integer_io.h>
#include <cln/rational.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <sstream>

#include "mechanics/pfaffian.hpp"
#include "mechanics/small.hpp"
#include "mechanics/stages.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::mechanics {
namespace {

using cln::cl_R;

constexpr long largest_denominator = 12;  // of a coefficient in a message

/// Values of the rows at a point: coefficients of the velocities, then b.
using Rows = std::vector<std::vector<cl_R>>;

struct Combination {
  std::vector<cl_R> coefficients;  // of the rows before it
  bool same_rate = false;          // b is the same combination
  bool same_value = true;          // psi of holonomic constraints is not the same combination and a constant
};

/// Independent rows at one point, orthonormalised without their b, in order.
class Span {
 public:
  /// Whether a row lies in the span of the added rows.
  bool contains(const std::vector<cl_R>& row) const { return largest(rest(row)) <= small(25); }
  void add(const std::vector<cl_R>& row) {
    std::vector<cl_R> left = rest(rest(row));
    cl_R square = 0;
    for (std::size_t i = 0; i + 1 < left.size(); ++i) square = square + left[i] * left[i];
    const cl_R length = cln::sqrt(square);
    if (cln::zerop(length)) return;
    for (cl_R& x : left) x = x / length;
    basis_.push_back(std::move(left));
  }

 private:
  std::vector<cl_R> rest(std::vector<cl_R> row) const {
    for (const std::vector<cl_R>& e : basis_) {
      cl_R part = 0;
      for (std::size_t i = 0; i + 1 < row.size(); ++i) part = part + row[i] * e[i];
      if (cln::zerop(part)) continue;
      for (std::size_t i = 0; i < row.size(); ++i) row[i] = row[i] - part * e[i];
    }
    return row;
  }
  static cl_R largest(const std::vector<cl_R>& row) {
    cl_R size = 0;
    for (std::size_t i = 0; i + 1 < row.size(); ++i) size = cln::max(size, cln::abs(row[i]));
    return size;
  }

  std::vector<std::vector<cl_R>> basis_;
};

/// Row k of `rows` as a combination of the independent rows before it, if it is one.
std::optional<Combination> combination(const Rows& rows, const std::vector<std::size_t>& independent, std::size_t k) {
  const std::size_t n = rows[k].size() - 1, count = independent.size();
  const auto dot = [&](std::size_t a, std::size_t b) {
    cl_R sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum = sum + rows[a][i] * rows[b][i];
    return sum;
  };
  std::vector<std::vector<cl_R>> gram(count, std::vector<cl_R>(count));
  std::vector<cl_R> right;
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = 0; b < count; ++b) gram[a][b] = dot(independent[a], independent[b]);
    right.push_back(dot(independent[a], k));
  }
  Combination result;
  if (!solve_small(gram, right, result.coefficients)) return std::nullopt;
  std::vector<cl_R> rest = rows[k];
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t i = 0; i <= n; ++i) rest[i] = rest[i] - result.coefficients[a] * rows[independent[a]][i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (cln::abs(rest[i]) > small(25)) return std::nullopt;
  }
  result.same_rate = cln::abs(rest[n]) < small(25);
  return result;
}

/// Whether the rows of a combination are as many as their nonzero columns: then every row is trivially a combination of
/// them.
bool spans_all(const Rows& rows, const std::vector<std::size_t>& independent, const Combination& of, std::size_t k) {
  std::vector<std::size_t> parts{k};
  for (std::size_t a = 0; a < independent.size(); ++a) {
    if (cln::abs(of.coefficients[a]) >= small(25)) parts.push_back(independent[a]);
  }
  std::size_t columns = 0;
  for (std::size_t i = 0; i + 1 < rows[k].size(); ++i) {
    columns +=
        std::any_of(parts.begin(), parts.end(), [&](std::size_t row) { return cln::abs(rows[row][i]) > small(25); })
            ? 1
            : 0;
  }
  return columns > 0 && parts.size() > columns;
}

/// "2 a - b/3"; empty if a coefficient is not a simple number.
std::string named(const Mechanics& m, const std::vector<std::uint32_t>& constraints,
                  const std::vector<std::size_t>& independent, const Combination& at, const Combination& elsewhere) {
  std::string text;
  for (std::size_t a = 0; a < independent.size(); ++a) {
    const cl_R& c = at.coefficients[a];
    if (cln::abs(c) < small(25)) continue;
    std::optional<symbolic::Rational> simple;
    for (long denominator = 1; denominator <= largest_denominator && !simple; ++denominator) {
      const cln::cl_I numerator = cln::round1(c * denominator);
      if (cln::abs(c * denominator - numerator) < small(25)) simple = symbolic::Rational(numerator) / denominator;
    }
    if (!simple || cln::abs(c - elsewhere.coefficients[a]) > small(25)) return "";
    const symbolic::Rational size = cln::abs(*simple);
    std::ostringstream term;
    if (cln::numerator(size) != 1) term << cln::numerator(size) << " ";
    term << m.constraints[constraints[independent[a]]].label;
    if (cln::denominator(size) != 1) term << "/" << cln::denominator(size);
    const bool minus = cln::minusp(*simple);
    text += (text.empty() ? (minus ? "-" : "") : (minus ? " - " : " + ")) + term.str();
  }
  return text;
}

std::string listed(const Mechanics& m, const std::vector<std::uint32_t>& constraints,
                   const std::vector<std::size_t>& independent, const Combination& at) {
  std::string text;
  for (std::size_t a = 0; a < independent.size(); ++a) {
    if (cln::abs(at.coefficients[a]) < small(25)) continue;
    text += (text.empty() ? "'" : ", '") + m.constraints[constraints[independent[a]]].label + "'";
  }
  return text;
}

/// Whether psi of constraint k is the same combination of the others: if they are closed, so is k. True if one of them
/// cannot open, or if there are no values.
bool are_closed_together(const Mechanics& m, OneFormSpace& space, const std::vector<std::uint32_t>& constraints,
                         const std::vector<std::size_t>& independent, std::size_t k, const Combination& at) {
  std::vector<Ref> psi{space.impose_and_expand(m.constraints[constraints[k]].psi)};
  std::vector<cl_R> coefficients;
  for (std::size_t a = 0; a < independent.size(); ++a) {
    if (cln::abs(at.coefficients[a]) < small(25)) continue;
    const Constraint& other = m.constraints[constraints[independent[a]]];
    if (!other.unilateral) return true;
    psi.push_back(space.impose_and_expand(other.psi));
    coefficients.push_back(at.coefficients[a]);
  }
  for (std::size_t point = 0; point < space.points(); ++point) {
    try {
      const std::vector<cl_R> values = space.values(psi, point);
      cl_R rest = values[0], size = cln::abs(values[0]);
      for (std::size_t a = 0; a < coefficients.size(); ++a) {
        rest = rest - coefficients[a] * values[a + 1];
        size = size + cln::abs(coefficients[a] * values[a + 1]);
      }
      return cln::abs(rest) <= small(20) * size;
    } catch (const std::domain_error&) {
      continue;
    }
  }
  return true;
}

/// Whether holonomic constraint k is a fixed combination of the others and a constant that is not 0 for the values of
/// the parameters: no position satisfies them all. False if no sample point gives them values.
bool is_contradiction(const Mechanics& m, OneFormSpace& space, const std::vector<std::uint32_t>& constraints,
                      const std::vector<std::size_t>& independent, std::size_t k, const Combination& here,
                      const Combination& there) {
  const Constraint& constraint = m.constraints[constraints[k]];
  if (!constraint.holonomic() || named(m, constraints, independent, here, there).empty()) return false;
  std::vector<Ref> psi{space.impose_and_expand(constraint.psi)};
  std::vector<cl_R> coefficients{cl_R(1)};
  for (std::size_t a = 0; a < independent.size(); ++a) {
    if (cln::abs(here.coefficients[a]) < small(25)) continue;
    const Constraint& other = m.constraints[constraints[independent[a]]];
    if (!other.holonomic() || other.unilateral) return false;
    psi.push_back(space.impose_and_expand(other.psi));
    coefficients.push_back(-here.coefficients[a]);
  }
  constexpr int digits = 40;
  bool has_values = false;
  for (std::size_t point = 0; point < space.points(); ++point) {
    const std::function<cl_R(const symbolic::Symbol&)> value = [&](const symbolic::Symbol& symbol) {
      if (symbol.kind != symbolic::SymbolKind::parameter) return space.value(symbol, point);
      return symbolic::evaluate(*m.dag, {m.parameter_value[symbol.index]}, value, digits)[0];
    };
    try {
      const std::vector<cl_R> values = symbolic::evaluate(*m.dag, psi, value, digits);
      cl_R rest = 0, size = 0;
      for (std::size_t a = 0; a < psi.size(); ++a) {
        rest = rest + coefficients[a] * values[a];
        size = size + cln::abs(coefficients[a] * values[a]);
      }
      if (cln::abs(rest) <= small(12) * size) return false;
      has_values = true;
    } catch (const std::domain_error&) {
      continue;
    }
  }
  return has_values;
}

Error refusal(const Mechanics& m, const std::vector<std::uint32_t>& constraints, std::size_t k,
              const std::vector<std::size_t>& independent, const Combination& here, const Combination& there) {
  const Constraint& constraint = m.constraints[constraints[k]];
  const std::string others = listed(m, constraints, independent, here),
                    formula = named(m, constraints, independent, here, there);
  const SourceLocation where = m.model->where(m.model->arena[constraint.model_expression].span);
  std::string what = "constraint '" + constraint.label + "' ";
  if (!here.same_value) {
    what += "contradicts " + others + ": " + constraint.label + " = " + formula + " and a constant that is not 0";
    return Error("mechanics", where, what, "remove one of them: no position satisfies them all");
  }
  if (here.same_rate && formula.empty() && !others.empty() && constraint.holonomic()) {
    // The gradients alone do not tell whether the constraint holds where the others do.
    what += "has a gradient that follows from those of " + others +
            ", with coefficients that depend on the state: it follows from them, or contradicts them";
    return Error("mechanics", where, what,
                 "remove it: nothing would determine how the force is shared, or no position satisfies them all");
  }
  if (here.same_rate) {
    what += others.empty() ? "follows from the constraints that fix its coordinates"
                           : "follows from " + others +
                                 (formula.empty() ? ", with coefficients that depend on the state"
                                                  : ": " + constraint.label + " = " + formula);
    return Error("mechanics", where, what, "remove it: nothing would determine how the force is shared");
  }
  what += others.empty()
              ? "contradicts the constraints that fix its coordinates"
              : "contradicts " + others +
                    (formula.empty() ? "" : ": its velocities are those of " + formula + ", the rest is not");
  return Error("mechanics", where, what, "remove one of them: no motion satisfies them all");
}

/// The error for a constraint if all of its equations are redundant.
using Refusals = std::map<std::string, Error>;

Refusals drop_repeated(Mechanics& m) {
  std::vector<std::uint32_t> constraints;  // holonomic constraints first, so that errors name the others
  for (const bool holonomic : {true, false}) {
    for (const std::uint32_t k : m.active) {
      if (m.constraints[k].holonomic() == holonomic && !model_constraint(m, m.constraints[k]).joint)
        constraints.push_back(k);
    }
  }
  if (constraints.empty()) return {};
  OneFormSpace space(m, OneFormSpace::SampleSet::unrestricted);
  std::vector<Ref> entries;
  for (const std::uint32_t k : constraints) {
    const OneForm form = space.one_form(m.constraints[k]);
    entries.insert(entries.end(), form.begin(), form.end());
  }
  const std::size_t width = space.variables().size();
  std::vector<Rows> at;
  for (std::size_t point = 0; point < space.points() && at.size() < 2; ++point) {
    try {
      const std::vector<cl_R> values = space.values(entries, point);
      at.emplace_back();
      for (std::size_t k = 0; k < constraints.size(); ++k) {
        const auto first = values.begin() + static_cast<std::ptrdiff_t>(k * width);
        at.back().emplace_back(first, first + static_cast<std::ptrdiff_t>(width));
      }
    } catch (const std::domain_error&) {
      continue;  // outside the domain of a function: another point
    }
  }
  if (at.size() < 2) return {};  // no values: checked at the start of a run
  std::vector<std::size_t> independent;
  std::array<Span, 2> spans;
  Refusals refusals;
  const auto leavable = [&](std::size_t k) { return m.constraints[constraints[k]].unilateral; };
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    if (leavable(k)) continue;
    if (spans[0].contains(at[0][k]) && spans[1].contains(at[1][k])) {
      std::optional<Combination> here = combination(at[0], independent, k);
      const std::optional<Combination> there = combination(at[1], independent, k);
      if (here && there && !spans_all(at[0], independent, *here, k)) {
        here->same_value = !here->same_rate || !is_contradiction(m, space, constraints, independent, k, *here, *there);
        Constraint& constraint = m.constraints[constraints[k]];
        Error why = refusal(m, constraints, k, independent, *here, *there);
        if (!here->same_rate || !here->same_value || !may_be_redundant(m, constraint)) throw why;
        refusals.emplace(constraint.name, std::move(why));
        constraint.redundancy = Redundancy::redundant;
        std::erase(m.active, constraints[k]);
        continue;
      }
    }
    independent.push_back(k);
    for (std::size_t point = 0; point < spans.size(); ++point) spans[point].add(at[point][k]);
  }
  for (std::size_t k = 0; k < constraints.size(); ++k) {
    if (!leavable(k)) continue;
    const std::optional<Combination> here = combination(at[0], independent, k),
                                     there = combination(at[1], independent, k);
    // Opposite walls constrain the same velocities but are not closed together.
    const bool dependent = here && there;
    if (dependent && are_closed_together(m, space, constraints, independent, k, *here))
      throw refusal(m, constraints, k, independent, *here, *there);
    if (!dependent) independent.push_back(k);
  }
  return refusals;
}

}  // namespace

void drop_repeated_equations(Mechanics& m) {
  const Refusals refusals = drop_repeated(m);
  for (const model::Constraint& whole : m.model->constraints) {
    if (whole.joint || whole.unit) continue;
    const auto needed = [&](const Constraint& c) {
      return c.name == whole.name && c.redundancy == Redundancy::independent;
    };
    if (std::any_of(m.constraints.begin(), m.constraints.end(), needed)) continue;
    const auto why = refusals.find(whole.name);
    if (why != refusals.end()) throw why->second;
    throw Error("mechanics", m.model->where(whole.span),
                "constraint '" + whole.name + "' follows from the constraints before it", "remove it");
  }
}

}  // namespace eomgen::mechanics

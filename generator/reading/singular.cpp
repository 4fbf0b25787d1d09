// SPDX-License-Identifier: GPL-3.0-or-later
// Sets where the inertia matrix of an approach is singular, factor by factor of its determinant, and where a potential
// or force divides by zero.
#include <cln/integer.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <vector>

#include "reading/lagrangian.hpp"
#include "reading/no_value.hpp"
#include "reading/rational_function.hpp"
#include "reading/small_matrix.hpp"
#include "reading/sum.hpp"
#include "reading/trig.hpp"
#include "rotations/rotation.hpp"
#include "symbolic/arithmetic.hpp"
#include "symbolic/sample.hpp"
#include "work.hpp"

namespace eomgen::reading {
namespace {

// Values of a canonical sum in binary64, at many points. In: a Sum. Out: its value; NaN where a function is not
// defined.

constexpr std::size_t factors_a_unit = 8;  // of `work::consume_budget`

double evaluated_power(double base, int exponent) {
  double result = 1;
  for (int k = std::abs(exponent); k > 0; k /= 2, base *= base) {
    if (k % 2 != 0) result *= base;
  }
  return exponent < 0 ? 1 / result : result;
}

/// Evaluates each atom once, arguments first. The sum must outlive the evaluator.
class Evaluator {
 public:
  explicit Evaluator(const Sum& sum) : whole_(flat(sum)) {}

  /// The symbols, with their indices into `at`.
  const std::map<Symbol, std::size_t>& symbols() const { return symbols_; }

  /// `at`: a value for each symbol, at its index. Counts its operations: throws BudgetExceeded.
  double operator()(const std::vector<double>& at) {
    work::consume_budget(size_ / factors_a_unit + 1);
    for (Item& item : items_) item.value = item.op == Op::symbol ? at[item.symbol] : function(item);
    return value(whole_);
  }

 private:
  struct Power {
    std::size_t item;
    int whole;        // the exponent if it is a small integer; else 0
    double exponent;  // else
  };
  struct Term {
    double coefficient;
    std::vector<Power> powers;
  };
  using Flat = std::vector<Term>;
  struct Item {
    Op op;
    std::size_t symbol = 0;
    std::vector<Flat> args;
    double value = 0;
  };
  struct Before {
    bool operator()(const Atom* a, const Atom* b) const { return compare(*a, *b) < 0; }
  };

  Flat flat(const Sum& sum) {
    constexpr int largest_whole = 64;
    Flat result;
    for (const auto& [monomial, coefficient] : sum.terms()) {
      Term term{cln::double_approx(coefficient), {}};
      for (const Factor& factor : monomial) {
        const bool whole = is_integer(factor.exponent) && cln::abs(factor.exponent) <= largest_whole;
        term.powers.push_back({place(*factor.atom), whole ? cln::cl_I_to_int(cln::numerator(factor.exponent)) : 0,
                               whole ? 0 : cln::double_approx(factor.exponent)});
      }
      size_ += 1 + term.powers.size();
      result.push_back(std::move(term));
    }
    return result;
  }

  std::size_t place(const Atom& atom) {
    if (const auto known = places_.find(&atom); known != places_.end()) return known->second;
    Item item{atom.op, 0, {}, 0};
    if (atom.op == Op::symbol) {
      const auto same = symbols_.find(atom.symbol);
      item.symbol = same != symbols_.end() ? same->second : symbols_.size();
      symbols_.emplace(atom.symbol, item.symbol);
    }
    for (const Sum& argument : atom.args) item.args.push_back(flat(argument));
    items_.push_back(std::move(item));
    return places_[&atom] = items_.size() - 1;
  }

  double value(const Flat& sum) const {
    double result = 0;
    for (const Term& term : sum) {
      double product = term.coefficient;
      for (const Power& p : term.powers)
        product *=
            p.whole != 0 ? evaluated_power(items_[p.item].value, p.whole) : std::pow(items_[p.item].value, p.exponent);
      result += product;
    }
    return result;
  }

  double function(const Item& item) const {
    const auto arg = [&](std::size_t i) { return value(item.args[i]); };
    switch (item.op) {
      case Op::pi: return symbolic::Binary64Arithmetic::pi();
      case Op::add: return arg(0);  // a sum under a power
      default: return symbolic::value_of(item.op, 0, arg, symbolic::Binary64Arithmetic{});
    }
  }

  std::map<const Atom*, std::size_t, Before> places_;
  std::map<Symbol, std::size_t> symbols_;
  std::vector<Item> items_;
  std::size_t size_ = 0;  // number of factors and terms
  Flat whole_;            // declared after the members that its initialiser fills
};

// Larger determinants are not expanded; the charts of the particles are examined instead.
constexpr std::size_t largest_determinant = 4;

bool varies(const Symbol& symbol) {
  return symbol.kind == SymbolKind::coordinate || symbol.kind == SymbolKind::function ||
         symbol.kind == SymbolKind::time;
}
bool varies(const Atom& atom) { return atom.op == Op::symbol && varies(atom.symbol); }
bool varies(const Sum& sum) {
  bool result = false;
  for_each_atom(sum, [&](const Atom& atom) { result = result || varies(atom); });
  return result;
}

// cos(alpha) of a parameter: coordinates may also be singular at a parameter value.
bool turns(const Sum& factor) {
  if (factor.size() != 1 || factor.terms().begin()->first.size() != 1) return false;
  const Op op = factor.terms().begin()->first[0].atom->op;
  return op == Op::sin || op == Op::cos;
}

// The zeros of f for a few f with well-known zeros.
std::vector<Formula> solutions(const Sum& factor) {
  if (factor.size() != 1) return {};
  const Monomial& monomial = factor.terms().begin()->first;
  if (monomial.size() != 1) return {};
  const Atom& atom = *monomial[0].atom;
  const auto at = [](const Formula& left, Formula right) { return relation({left, std::move(right)}); };
  Formula pi;
  pi.kind = FormulaKind::pi;
  if (atom.op == Op::sin) return {at(arrange(atom.args[0]), number(0)), at(arrange(atom.args[0]), pi)};
  if (atom.op == Op::cos) {
    const Formula half = fraction(pi, number(2));
    return {at(arrange(atom.args[0]), half), at(arrange(atom.args[0]), negative(half))};
  }
  return {};
}

bool is_always_positive(const Sum& factor) {
  // A sum of terms without a sign change, of which one does not vanish: m1 + m2 sin(x)^2.
  if (turns(factor)) return false;
  bool constant_part = false;
  for (const auto& [monomial, coefficient] : factor.terms()) {
    if (cln::minusp(coefficient)) return false;
    bool fixed = true;
    for (const Factor& f : monomial) {
      const bool even = is_integer(f.exponent) && cln::evenp(cln::numerator(f.exponent));
      const bool moves = varies(Sum(f.atom));
      if (moves && !even) return false;
      fixed = fixed && !moves;
    }
    constant_part = constant_part || fixed;
  }
  return constant_part;
}

class Sets {
 public:
  void add(const std::string& approach, const Sum& factor) {
    if (!varies(factor) && !turns(factor)) return;
    for (SingularSet& set : found_) {
      if (!(set.factor == factor)) continue;
      if (set.approach != approach) set.approach = "both";
      return;
    }
    found_.push_back({approach, factor, solutions(factor)});
  }
  void add_factors(const std::string& approach, const Sum& product) {
    const Factorisation parts = factorise(product);
    for (const Factor& factor : parts.content.monomial) {
      if (!cln::plusp(factor.exponent)) continue;
      add(approach, factor.atom->op == Op::add ? factor.atom->args[0] : Sum(factor.atom));
    }
    for (const auto& [factor, exponent] : parts.factors) add(approach, factor);
  }
  // x^-1, (x^2 + y^2)^(-3/2): the equations are singular at x = 0, x^2 + y^2 = 0.
  void add_denominators(const std::string& approach, const Sum& sum) {
    for (const auto& [monomial, coefficient] : sum.terms()) {
      for (const Factor& factor : monomial) {
        if (!cln::minusp(factor.exponent)) continue;
        const Sum base = factor.atom->op == Op::add ? factor.atom->args[0] : Sum(factor.atom);
        if (!is_always_positive(base)) add(approach, base);
      }
    }
  }
  /// A rotation by half a turn, of which the entries have no finite values: p = pi, 1/(l.l) = 0.
  void add_half_turn(const Sum& squares) {
    const Sum inverse = power(squares, -1);
    Formula pi;
    pi.kind = FormulaKind::pi;
    found_.push_back({"both", inverse, {relation({mark("p"), pi}), relation({arrange(inverse), number(0)})}});
  }
  std::vector<SingularSet> take() { return std::move(found_); }

 private:
  std::vector<SingularSet> found_;
};

/// Whether searches for a zero from many starts end far from one. Then a factor of a nonnegative determinant has no
/// zeros. Parameters count as positive, like masses, inertias and lengths.
bool stays_away_from_zero(const Sum& factor) {
  constexpr int starts = 40, shrinkings = 40;
  constexpr double near = 1e-5;  // of the largest value found
  Evaluator value(factor);
  std::vector<double> at(value.symbols().size());
  std::vector<std::size_t> moving;
  for (const auto& [symbol, place] : value.symbols()) {
    if (varies(symbol)) moving.push_back(place);
  }
  if (moving.empty()) return false;
  double largest = 0, least = HUGE_VAL;
  for (int start = 1; start <= starts; ++start) {
    const auto point = static_cast<std::uint64_t>(start);
    for (const auto& [symbol, place] : value.symbols()) {
      const double sample = symbolic::sample_double(symbol, point);
      at[place] = varies(symbol) ? 6 * (sample - 0.7) : 3 * sample;
    }
    double here = value(at);
    if (!std::isfinite(here)) continue;
    const bool negative = here < 0;
    largest = std::max(largest, std::abs(here));
    double step = 1;
    for (int turn = 0; turn < shrinkings;) {
      bool better = false;
      for (const std::size_t s : moving) {
        for (const double by : {step, -step}) {
          const double before = at[s];
          at[s] = before + by;
          const double there = value(at);
          if ((there < 0) != negative) return false;
          largest = std::max(largest, std::isfinite(there) ? std::abs(there) : 0);
          if (std::abs(there) < std::abs(here))
            here = there, better = true;
          else
            at[s] = before;
        }
      }
      if (!better) step /= 2, ++turn;
    }
    least = std::min(least, std::abs(here));
  }
  return std::isfinite(least) && least > near * largest;
}

// For masses and bodies the determinant is never negative. A kinetic energy given by the file may have any sign.
void add_determinant(const Mechanics& m, GinacBridge& bridge, const std::string& approach, const Sum& kinetic,
                     const std::vector<std::uint32_t>& which, Sets& sets) {
  const bool of_masses = m.dag->is_zero(m.kinetic_given);
  Sets candidates;
  candidates.add_factors(approach, simplify(determinant(mass_matrix(bridge, kinetic, which), which.size())));
  for (const SingularSet& set : candidates.take()) {
    if (!is_always_positive(set.factor) && !(of_masses && stays_away_from_zero(set.factor)))
      sets.add(approach, set.factor);
  }
}

// If the determinant is too large to expand: the angles of bodies are singular where their basis has no dual. If the
// first or the last angle is eliminated, the basis of the other two is never singular.
void add_rotations(const Mechanics& mechanics, GinacBridge& bridge, const std::map<Symbol, Sum>& values, Sets& sets) {
  Mechanics m = mechanics;  // shares the Dag; lowering may add nodes to it
  for (const model::Body& body : m.model->bodies) {
    const model::Frame& frame = m.model->frames[body.frame];
    const rotations::Rotation* rotation = rotations::find(frame.rotation);
    if (rotation != nullptr && rotation->singularity.empty() && !rotation->singular.empty()) {
      Sum squares;
      for (const model::NodeId entry : frame.entries) {
        const Sum l = bridge.sum(mechanics::lower_scalar(m, entry));
        squares += l * l;
      }
      sets.add_half_turn(squares);
    }
    if (frame.singularity == model::no_node) continue;
    const auto gone = [&](std::size_t k) {
      const model::Node& entry = m.model->arena[frame.entries[k]];
      return entry.op != model::Op::coordinate || m.is_eliminated(entry.index);
    };
    const auto given = [&](std::size_t k) { return m.model->arena[frame.entries[k]].op != model::Op::coordinate; };
    const Sum regular = bridge.sum(mechanics::lower_scalar(m, frame.singularity));
    if (m.q.size() > largest_determinant && !given(0) && !given(2)) sets.add_factors("I", regular);
    if (m.free.size() > largest_determinant && !gone(0) && !gone(2))
      sets.add_factors("II", bridge.substitute(regular, values));
  }
}

void add_geometry(const Mechanics& m, GinacBridge& bridge, const std::map<Symbol, Sum>& values, Sets& sets) {
  if (m.q.size() <= largest_determinant) return;
  // Each particle's chart is singular where its metric is; the whole inertia matrix may be singular there.
  for (const Geometry& g : geometry(m)) {
    sets.add_factors("I", g.determinant);
    bool stays = false;
    for (const std::uint32_t i : g.coordinates) stays = stays || !m.is_eliminated(i);
    if (stays && m.free.size() > largest_determinant) sets.add_factors("II", bridge.substitute(g.determinant, values));
  }
}

}  // namespace

std::vector<SingularSet> singular_sets(const Mechanics& m, std::vector<LeftOut>* left_out) try {
  GinacBridge bridge(m);
  Sets sets;
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < m.q.size(); ++i) all.push_back(i);
  const auto within_budget = [&](const char* what, auto&& look) {
    try {
      const work::Budget budget(item_budget);
      look();
    } catch (const work::BudgetExceeded& over) {  // a run detects these places by its pivots
      if (left_out != nullptr) left_out->push_back({what, over.what()});
    }
  };
  std::map<Symbol, Sum> values;
  within_budget("what constraints impose", [&] { values = imposed_values(m, bridge); });
  if (m.free.size() <= largest_determinant) {
    within_budget("the determinant of the inertia matrix", [&] {
      const Sum kinetic = kinetic_energy(m, bridge);
      if (all.size() <= largest_determinant) add_determinant(m, bridge, "I", kinetic, all, sets);
      add_determinant(m, bridge, "II", bridge.substitute(kinetic, values), m.free, sets);
    });
  }
  within_budget("the denominators of the potential", [&] {
    const Sum potential = bridge.sum(m.potential);
    sets.add_denominators("I", potential);
    sets.add_denominators("II", bridge.substitute(potential, values));
  });
  within_budget("the metrics of the charts", [&] { add_geometry(m, bridge, values, sets); });
  within_budget("the angles of the bodies", [&] { add_rotations(m, bridge, values, sets); });
  return sets.take();
} catch (const std::domain_error&) {
  throw no_value_error(m);
}

}  // namespace eomgen::reading

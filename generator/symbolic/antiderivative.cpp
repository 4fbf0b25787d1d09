// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/antiderivative.hpp"

#include <algorithm>
#include <cmath>

#include "symbolic/calculus.hpp"
#include "symbolic/evaluate.hpp"
#include "symbolic/polynomial.hpp"
#include "symbolic/sample.hpp"
#include "symbolic/zero_proof.hpp"

namespace eomgen::symbolic {
namespace {

constexpr std::size_t term_budget = 200, most_parts = 40;
constexpr int deepest = 8;  // of integrations by parts and of halved angles

class Integrator {
 public:
  Integrator(Dag& dag, Symbol x, LogarithmDomain logarithms)
      : dag_(dag), x_(x), d_(partial_derivative(dag, x)), logarithms_(logarithms) {}

  std::optional<Ref> sum(Ref e, int depth) {
    if (depth > deepest) return std::nullopt;
    Ref result = dag_.zero();
    for (const Ref part : terms_of(dag_, expand_or_keep(dag_, e, term_budget))) {
      const std::optional<Ref> integral = term(part, depth);
      if (!integral) return by_substitution(e);  // for example u'/u with several terms in u'
      result = dag_.add(result, *integral);
    }
    return result;
  }

 private:
  std::optional<Ref> term(Ref e, int depth) {
    Ref constant = dag_.one(), rest = dag_.one();
    for (const auto& [base, exponent] : factors_of(dag_, e)) {
      Ref& side = depends_on(dag_, base, x_) ? rest : constant;
      side = dag_.mul(side, dag_.power(base, exponent));
    }
    std::optional<Ref> integral = by_substitution(rest);
    if (!integral) integral = arc_tangent(rest);
    if (!integral) integral = damped_wave(rest);
    if (!integral) integral = with_half_angles(rest, depth);
    if (!integral) integral = by_parts(rest, depth);
    if (!integral) return std::nullopt;
    return dag_.mul(constant, *integral);
  }

  /// The subexpressions of g that are candidates for u.
  std::vector<Ref> parts(Ref g) {
    std::vector<Ref> result{dag_.symbol(x_)};
    const auto add = [&](Ref r) {
      if (depends_on(dag_, r, x_) && std::find(result.begin(), result.end(), r) == result.end()) result.push_back(r);
    };
    for (const Ref r : dag_.reachable({g})) {
      const Node node = dag_[r];
      if (node.op == Op::sin || node.op == Op::cos || node.op == Op::tan) {
        add(dag_.call(Op::sin, node.args[0]));
        add(dag_.call(Op::cos, node.args[0]));
        add(dag_.call(Op::tan, node.args[0]));
      } else if (node.op == Op::sinh || node.op == Op::cosh) {
        add(dag_.call(Op::sinh, node.args[0]));
        add(dag_.call(Op::cosh, node.args[0]));
      } else if (node.op == Op::sqrt || node.op == Op::power) {
        add(node.args[0]);
      } else if (node.op == Op::div) {
        add(node.args[1]);
      }
      if (node.op != Op::mul && node.op != Op::symbol) add(r);
    }
    if (result.size() > most_parts) result.resize(most_parts);
    return result;
  }

  /// g = c u^n u': the exponent is found numerically, then proven.
  std::optional<Ref> by_substitution(Ref g) {
    for (const Ref u : parts(g)) {
      const Ref du = d_(u);
      if (dag_.is_zero(du)) continue;
      const Ref h = dag_.div(g, du);
      const Ref dh = d_(h);
      const std::vector<double> value =
          evaluate(dag_, {h, dh, u, du}, [](const Symbol& s) { return sample_double(s, 0); });
      const double guess = value[1] * value[2] / (value[0] * value[3]);
      const double doubled = std::round(2 * guess);
      if (!std::isfinite(guess) || std::abs(doubled - 2 * guess) > 1e-9 || std::abs(doubled) > 24) continue;
      const auto halves = static_cast<long>(doubled);
      const Ref c = dag_.div(h, half_power(u, halves));
      if (!is_proven_zero(dag_, d_(c))) continue;
      const std::optional<Ref> factor = eliminate_symbol(dag_, c, x_);
      if (!factor) continue;
      if (halves == -2) return dag_.mul(*factor, logarithm(u));
      const Ref n_plus_1 = dag_.constant(Rational(halves + 2) / 2);
      return dag_.mul(*factor, dag_.div(half_power(u, halves + 2), n_plus_1));
    }
    return std::nullopt;
  }

  Ref logarithm(Ref u) {
    if (logarithms_ == LogarithmDomain::positive || dag_.is_positive(u)) return dag_.call(Op::log, u);
    return dag_.div(dag_.call(Op::log, dag_.power(u, 2)), dag_.integer(2));
  }

  Ref half_power(Ref u, long halves) {
    if (halves % 2 == 0) return dag_.power(u, halves / 2);
    return dag_.power(dag_.call(Op::sqrt, u), halves);
  }

  /// 1/(x^2 + r^2) and 1/(r^2 + x^2): atan(x/r)/r.
  std::optional<Ref> arc_tangent(Ref g) {
    const Node node = dag_[g];
    if (node.op != Op::div || depends_on(dag_, node.args[0], x_) || dag_[node.args[1]].op != Op::add)
      return std::nullopt;
    const Node below = dag_[node.args[1]];
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
      const Ref square = below.args[1 - side];
      if (below.args[side] != dag_.power(dag_.symbol(x_), 2) || depends_on(dag_, square, x_)) continue;
      const Ref root = dag_[square].op == Op::power && dag_[square].payload == 2 ? dag_[square].args[0]
                                                                                 : dag_.call(Op::sqrt, square);
      return dag_.mul(node.args[0], dag_.div(dag_.call(Op::atan, dag_.div(dag_.symbol(x_), root)), root));
    }
    return std::nullopt;
  }

  /// exp(a) sin(b) and exp(a) cos(b) with a and b linear in x.
  std::optional<Ref> damped_wave(Ref g) {
    const auto factors = factors_of(dag_, g);
    if (factors.size() != 2 || factors[0].second != 1 || factors[1].second != 1) return std::nullopt;
    Ref e = factors[0].first, wave = factors[1].first;
    if (dag_[e].op != Op::exp) std::swap(e, wave);
    const Op op = dag_[wave].op;
    if (dag_[e].op != Op::exp || (op != Op::sin && op != Op::cos)) return std::nullopt;
    const Ref angle = dag_[wave].args[0], a = d_(dag_[e].args[0]), b = d_(angle);
    if (depends_on(dag_, a, x_) || depends_on(dag_, b, x_)) return std::nullopt;
    const Ref sine = dag_.call(Op::sin, angle), cosine = dag_.call(Op::cos, angle);
    const Ref sum = op == Op::sin ? dag_.sub(dag_.mul(a, sine), dag_.mul(b, cosine))
                                  : dag_.add(dag_.mul(a, cosine), dag_.mul(b, sine));
    return dag_.div(dag_.mul(e, sum), dag_.add(dag_.power(a, 2), dag_.power(b, 2)));
  }

  /// sin^2 u = (1 - cos 2u)/2, cos^2 u = (1 + cos 2u)/2.
  std::optional<Ref> with_half_angles(Ref g, int depth) {
    Ref rest = dag_.one();
    bool any = false;
    for (const auto& [base, exponent] : factors_of(dag_, g)) {
      const Op op = dag_[base].op;
      if (exponent < 2 || any || (op != Op::sin && op != Op::cos)) {
        rest = dag_.mul(rest, dag_.power(base, exponent));
        continue;
      }
      any = true;
      const Ref cosine = dag_.call(Op::cos, dag_.mul(dag_.integer(2), dag_[base].args[0]));
      const Ref twice = op == Op::sin ? dag_.sub(dag_.one(), cosine) : dag_.add(dag_.one(), cosine);
      rest = dag_.mul(rest, dag_.mul(dag_.power(base, exponent - 2), dag_.div(twice, dag_.integer(2))));
    }
    return any ? sum(rest, depth + 1) : std::nullopt;
  }

  /// x^n T = (x^n S)' - n x^(n-1) S with S' = T.
  std::optional<Ref> by_parts(Ref g, int depth) {
    const Ref x = dag_.symbol(x_);
    Ref rest = dag_.one();
    long n = 0;
    for (const auto& [base, exponent] : factors_of(dag_, g)) {
      if (base == x)
        n = exponent;
      else
        rest = dag_.mul(rest, dag_.power(base, exponent));
    }
    if (n < 1 || rest == dag_.one()) return std::nullopt;
    const std::optional<Ref> S = by_substitution(rest);
    if (!S) return std::nullopt;
    const std::optional<Ref> remaining = sum(dag_.mul(dag_.integer(n), dag_.mul(dag_.power(x, n - 1), *S)), depth + 1);
    if (!remaining) return std::nullopt;
    return dag_.sub(dag_.mul(dag_.power(x, n), *S), *remaining);
  }

  Dag& dag_;
  Symbol x_;
  Derivation d_;
  LogarithmDomain logarithms_;
};

}  // namespace

bool depends_on(const Dag& dag, Ref expression, Symbol x) {
  const std::vector<Symbol> symbols = dag.symbols({expression});
  return std::find(symbols.begin(), symbols.end(), x) != symbols.end();
}

namespace {

/// The multiple of 1/24 to which the expression is proven to be equal.
std::optional<Ref> plain_number(Dag& dag, Ref expression) {
  constexpr double parts = 24, most = 1000;
  const double scaled = parts * evaluate(dag, {expression}, [](const Symbol& s) { return sample_double(s, 0); })[0];
  if (!(std::abs(scaled) < most) || std::abs(scaled - std::round(scaled)) > 1e-9) return std::nullopt;
  const Ref number = dag.constant(Rational(std::lround(scaled)) / Rational(static_cast<long>(parts)));
  if (!is_proven_zero(dag, dag.sub(expression, number))) return std::nullopt;
  return number;
}

}  // namespace

std::optional<Ref> eliminate_symbol(Dag& dag, Ref expression, Symbol x) {
  if (!depends_on(dag, expression, x)) return expression;
  const Ref shorter = expand_or_keep(dag, expression, term_budget);
  if (!depends_on(dag, shorter, x)) return shorter;
  if (const std::optional<Ref> number = plain_number(dag, expression)) return number;
  for (const long at : {0, 1, 2}) {
    const Ref value = Substitution(dag, {{x, dag.integer(at)}})(shorter);
    try {
      evaluate(
          dag, {value}, [](const Symbol& s) -> cln::cl_R { return sample(s, 0); }, 30);
      return expand_or_keep(dag, value, term_budget);
    } catch (const std::exception&) {
      continue;  // for example a removable singularity
    }
  }
  return std::nullopt;
}

std::vector<std::pair<Ref, long>> factors_of(Dag& dag, Ref term) {
  std::vector<std::pair<Ref, long>> result, open{{term, 1}};
  while (!open.empty()) {
    const auto [r, exponent] = open.back();
    open.pop_back();
    const Node node = dag[r];
    if (node.op == Op::neg) {
      open.insert(open.end(), {{dag.integer(-1), exponent}, {node.args[0], exponent}});
    } else if (node.op == Op::mul) {
      open.insert(open.end(), {{node.args[0], exponent}, {node.args[1], exponent}});
    } else if (node.op == Op::div) {
      open.insert(open.end(), {{node.args[0], exponent}, {node.args[1], -exponent}});
    } else if (node.op == Op::power) {
      open.emplace_back(node.args[0], exponent * node.payload);
    } else {
      const auto known =
          std::find_if(result.begin(), result.end(), [&, base = r](const auto& f) { return f.first == base; });
      if (known == result.end())
        result.emplace_back(r, exponent);
      else
        known->second += exponent;
    }
  }
  std::erase_if(result, [](const auto& f) { return f.second == 0; });
  return result;
}

std::vector<Ref> terms_of(Dag& dag, Ref sum) {
  std::vector<Ref> result;
  std::vector<std::pair<Ref, bool>> open{{sum, false}};
  const auto distribute = [&](Ref r, bool minus) -> bool {  // (a + b)/c and c (a + b), as the expander leaves them
    const Node node = dag[r];
    if (node.op != Op::mul && node.op != Op::div) return false;
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
      if (node.op == Op::div && side == 1) break;
      const Node inner = dag[node.args[side]];
      if (inner.op != Op::add && inner.op != Op::sub && inner.op != Op::neg) continue;
      const Ref other = node.args[1 - side];
      const auto part = [&](Ref a) { return node.op == Op::div ? dag.div(a, other) : dag.mul(a, other); };
      open.emplace_back(part(inner.args[0]), minus != (inner.op == Op::neg));
      if (inner.op != Op::neg) open.emplace_back(part(inner.args[1]), minus != (inner.op == Op::sub));
      return true;
    }
    return false;
  };
  while (!open.empty()) {
    const auto [r, minus] = open.back();
    open.pop_back();
    const Node node = dag[r];
    if (node.op == Op::add || node.op == Op::sub) {
      open.emplace_back(node.args[0], minus);
      open.emplace_back(node.args[1], minus != (node.op == Op::sub));
    } else if (node.op == Op::neg) {
      open.emplace_back(node.args[0], !minus);
    } else if (!distribute(r, minus) && !dag.is_zero(r)) {
      result.push_back(minus ? dag.neg(r) : r);
    }
  }
  std::reverse(result.begin(), result.end());
  return result;
}

std::optional<Ref> antiderivative(Dag& dag, Ref e, Symbol x, LogarithmDomain logarithms) {
  const std::optional<Ref> found = Integrator(dag, x, logarithms).sum(e, 0);
  if (!found || !is_proven_zero(dag, dag.sub(partial_derivative(dag, x)(*found), e))) return std::nullopt;
  return found;
}

}  // namespace eomgen::symbolic

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/integrating_factor.hpp"

#include <cln/integer.h>
#include <cln/rational.h>

#include <algorithm>

#include "symbolic/antiderivative.hpp"

namespace eomgen::mechanics {
namespace {

using cln::cl_R;

constexpr std::size_t most_bases = 14, most_factors = 3, points_used = 2;
constexpr long finest_exponent = 2;  // exponents are multiples of 1/2

class IntegralSearch {
 public:
  IntegralSearch(OneFormSpace& space, OneForm form)
      : space_(space), dag_(space.dag()), form_(std::move(form)), x_(space.variables()) {}

  std::optional<Ref> run() {
    if (const std::optional<Ref> psi = with_factor(dag_.one())) return psi;
    for (std::size_t k = 0; k < x_.size(); ++k) {
      const std::optional<Ref> factor = of_one_variable(k);
      if (factor) keep_better(with_factor(*factor));
    }
    if (!best_ || complexity(*best_) > 0) keep_better(by_powers());
    return best_;
  }

 private:
  /// The number of functions that narrow the domain or hide a simpler form.
  std::size_t complexity(Ref psi) const {
    std::size_t count = 0;
    for (const Ref r : dag_.reachable({psi})) {
      const Op op = dag_[r].op;
      count += op == Op::log || op == Op::sqrt || op == Op::pow ? 100 : op == Op::exp || op == Op::div ? 1 : 0;
    }
    return count;
  }

  void keep_better(std::optional<Ref> psi) {
    if (psi && (!best_ || complexity(*psi) < complexity(*best_))) best_ = psi;
  }

  Ref d(Ref f, std::size_t i) { return space_.derivative(f, i); }

  /// psi of a closed form, integrated one variable after another, in both orders.
  std::optional<Ref> with_factor(Ref factor) {
    OneForm form;
    for (const Ref c : form_) form.push_back(space_.simpler(dag_.mul(factor, c)));
    for (std::size_t i = 0; i < form.size(); ++i) {
      for (std::size_t j = i + 1; j < form.size(); ++j) {
        if (space_.vanishing(dag_.sub(d(form[j], i), d(form[i], j))) != ZeroTestResult::proven) return std::nullopt;
      }
    }
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < form.size(); ++i) order.push_back(i);
    for (int turn = 0; turn < 2; ++turn) {
      if (const std::optional<Ref> psi = primitive(form, order)) return psi;
      std::reverse(order.begin(), order.end());
    }
    return std::nullopt;
  }

  std::optional<Ref> primitive(const OneForm& form, const std::vector<std::size_t>& order) {
    Ref psi = dag_.zero();
    for (std::size_t step = 0; step < order.size(); ++step) {
      const std::size_t i = order[step];
      std::optional<Ref> rest = space_.simpler(dag_.sub(form[i], d(psi, i)));
      if (space_.vanishing(*rest) == ZeroTestResult::proven) continue;
      for (std::size_t before = 0; before < step && rest; ++before)
        rest = symbolic::eliminate_symbol(dag_, *rest, x_[order[before]]);
      if (rest) rest = symbolic::antiderivative(dag_, *rest, x_[i]);
      if (!rest) return std::nullopt;
      psi = dag_.add(psi, *rest);
    }
    for (std::size_t i = 0; i < form.size(); ++i) {
      if (space_.vanishing(dag_.sub(form[i], d(psi, i))) != ZeroTestResult::proven) return std::nullopt;
    }
    return psi;
  }

  /// With d(mu omega) = 0 and mu = mu(x_k): mu'/mu = -(da_j/dx_k - da_k/dx_j)/a_j for every j.
  std::optional<Ref> of_one_variable(std::size_t k) {
    for (std::size_t j = 0; j < form_.size(); ++j) {
      if (j == k || dag_.is_zero(form_[j])) continue;
      std::optional<Ref> h = space_.simpler(dag_.div(dag_.sub(d(form_[k], j), d(form_[j], k)), form_[j]));
      for (std::size_t i = 0; i < form_.size() && h; ++i) {
        if (i == k) continue;
        if (space_.vanishing(d(*h, i)) != ZeroTestResult::proven) return std::nullopt;
        h = symbolic::eliminate_symbol(dag_, *h, x_[i]);
      }
      if (h) h = symbolic::antiderivative(dag_, *h, x_[k]);
      if (!h) return std::nullopt;
      return exponential(*h);
    }
    return std::nullopt;
  }

  /// exp of a sum; terms c log u become u^c.
  Ref exponential(Ref sum) {
    Ref product = dag_.one(), rest = dag_.zero();
    for (const Ref term : symbolic::terms_of(dag_, sum)) {
      Ref u = dag_.zero(), c = dag_.one();
      for (const auto& [base, exponent] : symbolic::factors_of(dag_, term)) {
        if (dag_[base].op == Op::log && exponent == 1)
          u = dag_[base].args[0];
        else
          c = dag_.mul(c, dag_.power(base, exponent));
      }
      if (!dag_.is_zero(u) && dag_.is_constant(c))
        product = dag_.mul(product, power_of(u, dag_.value(c)));
      else
        rest = dag_.add(rest, term);
    }
    return dag_.is_zero(rest) ? product : dag_.mul(product, dag_.call(Op::exp, rest));
  }

  Ref power_of(Ref u, const symbolic::Rational& exponent) { return dag_.pow(u, dag_.constant(exponent)); }

  std::vector<Ref> bases() {
    std::vector<Ref> result;
    const auto add = [&](Ref r) {
      if (dag_.symbols({r}).empty() || std::find(result.begin(), result.end(), r) != result.end()) return;
      const std::vector<Symbol> symbols = dag_.symbols({r});
      if (std::any_of(symbols.begin(), symbols.end(), [](const Symbol& s) { return s.kind != SymbolKind::parameter; }))
        result.push_back(r);
    };
    for (std::size_t i = 0; i < x_.size(); ++i) {
      if (!dag_.is_zero(form_[i])) add(dag_.symbol(x_[i]));
    }
    for (const Ref c : form_) {
      for (const auto& factor : symbolic::factors_of(dag_, c)) add(factor.first);
      add(c);
    }
    for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
      for (std::size_t j = i + 1; j + 1 < x_.size(); ++j) {
        if (dag_.is_zero(form_[i]) || dag_.is_zero(form_[j])) continue;
        add(dag_.add(dag_.power(dag_.symbol(x_[i]), 2), dag_.power(dag_.symbol(x_[j]), 2)));
      }
    }
    if (result.size() > most_bases) result.resize(most_bases);
    return result;
  }

  /// d omega + d(log mu) ^ omega = 0 with log mu = sum alpha_b log u_b is linear in alpha: solved numerically for a few
  /// bases at a time, then proven.
  std::optional<Ref> by_powers() {
    const std::vector<Ref> u = bases();
    std::vector<Ref> entries;  // per pair: d omega, then d(log u_b) ^ omega
    for (std::size_t i = 0; i < form_.size(); ++i) {
      for (std::size_t j = i + 1; j < form_.size(); ++j) {
        entries.push_back(dag_.sub(d(form_[j], i), d(form_[i], j)));
        for (const Ref base : u) {
          const Ref wedge = dag_.sub(dag_.mul(d(base, i), form_[j]), dag_.mul(d(base, j), form_[i]));
          entries.push_back(dag_.div(wedge, base));
        }
      }
    }
    std::vector<std::vector<cl_R>> equations;
    for (std::size_t point = 0; point < std::min(points_used, space_.points()); ++point) {
      try {
        const std::vector<cl_R> value = space_.values(entries, point);
        const auto width = static_cast<std::ptrdiff_t>(1 + u.size());
        for (auto row = value.begin(); row != value.end(); row += width) equations.emplace_back(row, row + width);
      } catch (const std::domain_error&) {
        return std::nullopt;
      }
    }
    std::vector<std::size_t> chosen;
    return subsets(u, equations, chosen, 0);
  }

  // In order of size: factors with the fewest bases first.
  std::optional<Ref> subsets(const std::vector<Ref>& u, const std::vector<std::vector<cl_R>>& equations,
                             std::vector<std::size_t>& chosen, std::size_t depth) {
    for (std::size_t size = 1; depth == 0 && size <= most_factors; ++size) {
      if (const std::optional<Ref> psi = subsets(u, equations, chosen, size)) return psi;
    }
    if (depth == 0) return std::nullopt;
    if (chosen.size() == depth) return tried(u, equations, chosen);
    for (std::size_t next = chosen.empty() ? 0 : chosen.back() + 1; next < u.size(); ++next) {
      chosen.push_back(next);
      const std::optional<Ref> psi = subsets(u, equations, chosen, depth);
      chosen.pop_back();
      if (psi) return psi;
    }
    return std::nullopt;
  }

  std::optional<Ref> tried(const std::vector<Ref>& u, const std::vector<std::vector<cl_R>>& equations,
                           const std::vector<std::size_t>& chosen) {
    const std::size_t n = chosen.size();
    std::vector<std::vector<cl_R>> normal(n, std::vector<cl_R>(n, cl_R(0)));
    std::vector<cl_R> right(n, cl_R(0)), alpha;
    for (const std::vector<cl_R>& e : equations) {
      for (std::size_t a = 0; a < n; ++a) {
        right[a] = right[a] - e[1 + chosen[a]] * e[0];
        for (std::size_t b = 0; b < n; ++b) normal[a][b] = normal[a][b] + e[1 + chosen[a]] * e[1 + chosen[b]];
      }
    }
    if (!solve_small(normal, right, alpha)) return std::nullopt;
    const cl_R small = cln::cl_R(cln::expt(symbolic::Rational(1) / 10, 15));
    Ref factor = dag_.one();
    for (std::size_t a = 0; a < n; ++a) {
      const cln::cl_I multiple = cln::round1(alpha[a] * finest_exponent);
      if (cln::zerop(multiple) || cln::abs(alpha[a] * finest_exponent - multiple) > small) return std::nullopt;
      factor = dag_.mul(factor, power_of(u[chosen[a]], symbolic::Rational(multiple) / finest_exponent));
    }
    for (const std::vector<cl_R>& e : equations) {
      cl_R rest = e[0];
      for (std::size_t a = 0; a < n; ++a) rest = rest + alpha[a] * e[1 + chosen[a]];
      if (cln::abs(rest) > small) return std::nullopt;
    }
    return with_factor(factor);
  }

  OneFormSpace& space_;
  Dag& dag_;
  OneForm form_;
  const std::vector<Symbol>& x_;
  std::optional<Ref> best_;
};

}  // namespace

std::optional<Ref> find_integral(OneFormSpace& space, const OneForm& form) { return IntegralSearch(space, form).run(); }

}  // namespace eomgen::mechanics

// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/quasi_coordinates.hpp"

#include <algorithm>
#include <map>
#include <unordered_map>

#include "numeric/elimination.hpp"

namespace eomgen::derive {
namespace {

using symbolic::Node;
using symbolic::Op;
using symbolic::Symbol;
using symbolic::SymbolKind;

// Indices of the symbols for theta: beyond those that other stages use while an expression is built.
constexpr std::uint32_t first_index = 1u << 20;

using Row = std::vector<Rational>;

bool is_zero(const Row& row) {
  return std::all_of(row.begin(), row.end(), [](const Rational& c) { return cln::zerop(c); });
}

/// row . q + rest; if `linear` is false, any other dependence on q.
struct Form {
  bool linear = true;
  Row row;
  Ref rest;
};

class Rewriter {
 public:
  Rewriter(Dag& dag, const std::vector<std::uint32_t>& of) : dag_(dag), n_(of.size()) {
    for (std::size_t i = 0; i < n_; ++i) place_[of[i]] = i;
  }

  /// Collects the maximal linear forms in the nodes of `roots`.
  void collect(const std::vector<Ref>& roots) {
    for (const Ref r : dag_.reachable(roots)) {
      const Form& form = forms_.emplace(r.id, read(r)).first->second;
      if (form.linear) continue;
      const Node node = dag_[r];
      for (std::uint8_t i = 0; i < node.arity; ++i) note(node.args[i]);
    }
    for (const Ref r : roots) note(r);
  }
  const std::vector<Row>& rows() const { return rows_; }
  const std::vector<Ref>& users() const { return users_; }

  /// The expression in theta; requires collected forms.
  Ref rewrite(Ref root, const std::vector<Symbol>& theta) {
    for (const Ref r : dag_.reachable({root})) result_[r.id] = rewritten(r, theta);
    return use(root, theta);
  }

 private:
  Form read(Ref r) {
    const Node node = dag_[r];
    Form form{true, Row(n_, 0), r};
    if (node.op == Op::symbol) {
      const Symbol symbol = dag_.symbol_of(r);
      const auto found = place_.find(symbol.index);
      if (symbol.kind != SymbolKind::coordinate || symbol.order != 0 || found == place_.end()) return form;
      form.row[found->second] = 1;
      form.rest = dag_.zero();
      return form;
    }
    std::vector<const Form*> args;
    bool moving = false;
    for (std::uint8_t i = 0; i < node.arity; ++i) {
      args.push_back(&forms_.at(node.args[i].id));
      moving = moving || !args.back()->linear || !is_zero(args.back()->row);
    }
    if (!moving) return form;
    const bool all_linear = std::all_of(args.begin(), args.end(), [](const Form* f) { return f->linear; });
    form.linear = all_linear && combine(node, args, form);
    return form;
  }

  bool combine(const Node& node, const std::vector<const Form*>& args, Form& form) {
    const auto scaled = [&](const Form& f, const Rational& factor) {
      for (std::size_t i = 0; i < n_; ++i) form.row[i] = f.row[i] * factor;
      form.rest = dag_.mul(dag_.constant(factor), f.rest);
      return true;
    };
    switch (node.op) {
      case Op::add:
      case Op::sub:
        for (std::size_t i = 0; i < n_; ++i) {
          form.row[i] = node.op == Op::add ? args[0]->row[i] + args[1]->row[i] : args[0]->row[i] - args[1]->row[i];
        }
        form.rest =
            node.op == Op::add ? dag_.add(args[0]->rest, args[1]->rest) : dag_.sub(args[0]->rest, args[1]->rest);
        return true;
      case Op::neg: return scaled(*args[0], -1);
      case Op::mul:
        if (dag_.is_constant(node.args[0])) return scaled(*args[1], dag_.value(node.args[0]));
        if (dag_.is_constant(node.args[1])) return scaled(*args[0], dag_.value(node.args[1]));
        return false;
      case Op::div: return dag_.is_constant(node.args[1]) && scaled(*args[0], cln::recip(dag_.value(node.args[1])));
      default: return false;
    }
  }

  void note(Ref r) {
    const Form& form = forms_.at(r.id);
    if (!form.linear || is_zero(form.row)) return;
    const std::size_t found = place_of(form.row);
    const bool bare = dag_.is_zero(form.rest);
    if (found == rows_.size()) {
      by_first_[first_of(form.row)].push_back(found);
      rows_.push_back(form.row);
      users_.push_back(bare ? r : sum_of(form.row));
    } else if (bare) {
      users_[found] = r;
    }
  }

  static std::size_t first_of(const Row& row) {
    const auto first = std::find_if(row.begin(), row.end(), [](const Rational& x) { return !cln::zerop(x); });
    return static_cast<std::size_t>(first - row.begin());
  }
  /// The index among the rows; the number of rows if it is none of them.
  std::size_t place_of(const Row& row) const {
    const auto same = by_first_.find(first_of(row));
    if (same == by_first_.end()) return rows_.size();
    const auto found =
        std::find_if(same->second.begin(), same->second.end(), [&](std::size_t i) { return rows_[i] == row; });
    return found == same->second.end() ? rows_.size() : *found;
  }

  Ref sum_of(const Row& row) {
    Ref sum = dag_.zero();
    for (const auto& [index, i] : place_) {
      sum = dag_.add(sum, dag_.mul(dag_.constant(row[i]), dag_.symbol({SymbolKind::coordinate, index, 0})));
    }
    return sum;
  }

  Ref use(Ref r, const std::vector<Symbol>& theta) {
    const Form& form = forms_.at(r.id);
    if (!form.linear || is_zero(form.row)) return result_.at(r.id);
    return dag_.add(dag_.symbol(theta[place_of(form.row)]), form.rest);
  }

  Ref rewritten(Ref r, const std::vector<Symbol>& theta) {
    const Form& form = forms_.at(r.id);
    if (form.linear) return r;  // maximal forms are replaced where they are used
    const Node node = dag_[r];
    std::array<Ref, 4> args{};
    for (std::uint8_t i = 0; i < node.arity; ++i) args[i] = use(node.args[i], theta);
    return symbolic::with_operands(dag_, node, args);
  }

  Dag& dag_;
  std::size_t n_;
  std::map<std::uint32_t, std::size_t> place_;
  std::unordered_map<std::uint32_t, Form> forms_;
  std::unordered_map<std::uint32_t, Ref> result_;
  std::vector<Row> rows_;
  std::map<std::size_t, std::vector<std::size_t>> by_first_;  // rows by their first nonzero entry
  std::vector<Ref> users_;
};

/// The exact inverse of a square matrix; empty if it is singular.
std::optional<std::vector<Rational>> inverse(const std::vector<Rational>& a, std::size_t n) {
  numeric::Matrix<Rational> matrix(n, n), unit(n, n);
  matrix.a = a;
  for (std::size_t i = 0; i < n; ++i) unit(i, i) = 1;
  const numeric::Elimination<Rational> factors(std::move(matrix), 0, numeric::Pivoting::complete);
  if (factors.rank() < n) return std::nullopt;
  return factors.solve(unit).a;
}

QuasiCoordinates coordinates_themselves(Dag& dag, const std::vector<std::uint32_t>& of) {
  QuasiCoordinates result;
  for (const std::uint32_t i : of) {
    result.theta.push_back({SymbolKind::coordinate, i, 0});
    result.rate.push_back({SymbolKind::coordinate, i, 1});
    result.value.push_back(dag.symbol(result.theta.back()));
    result.value_rate.push_back(dag.symbol(result.rate.back()));
  }
  return result;
}

}  // namespace

symbolic::Substitution QuasiCoordinates::back(Dag& dag) const {
  std::map<Symbol, Ref> values;
  for (std::size_t a = 0; a < theta.size(); ++a) {
    values[theta[a]] = value[a];
    values[rate[a]] = value_rate[a];
  }
  return {dag, std::move(values)};
}

symbolic::Derivation QuasiCoordinates::bias(Dag& dag) const {
  std::map<Symbol, Ref> seeds{{{SymbolKind::time, 0, 0}, dag.one()}};
  for (std::size_t a = 0; a < theta.size(); ++a) seeds[theta[a]] = dag.symbol(rate[a]);
  return {dag, std::move(seeds)};
}

QuasiCoordinates quasi_coordinates(Dag& dag, const std::vector<std::uint32_t>& of, std::vector<Vec3>& positions) {
  const std::size_t n = of.size();
  std::vector<Ref> roots;
  for (const Vec3& r : positions) roots.insert(roots.end(), r.begin(), r.end());
  Rewriter rewriter(dag, of);
  rewriter.collect(roots);
  QuasiCoordinates same = coordinates_themselves(dag, of);
  if (rewriter.rows().size() != n) return same;
  QuasiCoordinates result;
  bool identity = true;
  std::vector<std::size_t> order(n);  // forms by their last coordinate, so that S is triangular if possible
  for (std::size_t a = 0; a < n; ++a) order[a] = a;
  const auto last = [&](std::size_t a) {
    std::size_t i = n;
    while (i-- > 0 && cln::zerop(rewriter.rows()[a][i])) {
    }
    return i;
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return last(a) < last(b); });
  symbolic::Derivation ddt = same.bias(dag);
  std::vector<Symbol> by_form(n);
  for (std::size_t a = 0; a < n; ++a) {
    const auto& row = rewriter.rows()[order[a]];
    result.S.insert(result.S.end(), row.begin(), row.end());
    for (std::size_t i = 0; i < n; ++i) identity = identity && row[i] == (i == a ? 1 : 0);
    const auto index = first_index + static_cast<std::uint32_t>(a);
    result.theta.push_back({SymbolKind::auxiliary, index, 0});
    result.rate.push_back({SymbolKind::auxiliary, index, 1});
    result.value.push_back(rewriter.users()[order[a]]);
    result.value_rate.push_back(ddt(result.value.back()));
    by_form[order[a]] = result.theta.back();
  }
  if (identity) return same;
  const auto inverted = inverse(result.S, n);
  if (!inverted) return same;
  result.S_inverse = *inverted;
  for (Vec3& r : positions) {
    for (Ref& component : r) component = rewriter.rewrite(component, by_form);
  }
  return result;
}

}  // namespace eomgen::derive

// SPDX-License-Identifier: GPL-3.0-or-later
#include "mechanics/direction.hpp"

#include <algorithm>

#include "symbolic/polynomial.hpp"

namespace eomgen::mechanics {
namespace {

constexpr std::size_t term_budget = 60, most_nodes = 64;

bool depends_on_coordinates(const Dag& dag, Ref r) {
  const auto symbols = dag.symbols({r});
  return std::any_of(symbols.begin(), symbols.end(),
                     [](const symbolic::Symbol& s) { return s.kind == SymbolKind::coordinate; });
}

/// Factors of a product; for a sum, the factors common to all its terms.
std::vector<Ref> factors(const Dag& dag, Ref r) {
  const symbolic::Node& node = dag[r];
  const auto of = [&dag](Ref x) { return factors(dag, x); };
  switch (node.op) {
    case Op::neg: return of(node.args[0]);
    case Op::div: return of(node.args[0]);
    case Op::power: {
      std::vector<Ref> result;
      for (const Ref f : of(node.args[0])) result.insert(result.end(), static_cast<std::size_t>(node.payload), f);
      return result;
    }
    case Op::mul: {
      std::vector<Ref> result = of(node.args[0]), more = of(node.args[1]);
      result.insert(result.end(), more.begin(), more.end());
      return result;
    }
    case Op::add:
    case Op::sub: {
      std::vector<Ref> a = of(node.args[0]), b = of(node.args[1]), both;
      std::sort(a.begin(), a.end());
      std::sort(b.begin(), b.end());
      std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
      both.push_back(r);  // the sum itself, if the other components have it too
      return both;
    }
    default: return {r};
  }
}

/// r without one of its factors.
Ref without(Dag& dag, Ref r, Ref factor) {
  if (r == factor) return dag.one();
  const symbolic::Node node = dag[r];
  const auto has = [&](Ref x) {
    const std::vector<Ref> all = factors(dag, x);
    return std::find(all.begin(), all.end(), factor) != all.end();
  };
  const auto strip = [&](Ref x) { return without(dag, x, factor); };
  switch (node.op) {
    case Op::neg: return dag.neg(strip(node.args[0]));
    case Op::div: return dag.div(strip(node.args[0]), node.args[1]);
    case Op::power: return dag.mul(strip(node.args[0]), dag.power(node.args[0], node.payload - 1));
    case Op::mul:
      return has(node.args[0]) ? dag.mul(strip(node.args[0]), node.args[1])
                               : dag.mul(node.args[0], strip(node.args[1]));
    case Op::add: return dag.add(strip(node.args[0]), strip(node.args[1]));
    default: return dag.sub(strip(node.args[0]), strip(node.args[1]));
  }
}

/// For motion along one line: the derivative with respect to a coordinate, if it is constant and the vector is a
/// multiple of it.
std::optional<Vec3> line(Lowering& lower, Dag& dag, std::size_t coordinates, const Vec3& along) {
  for (std::uint32_t k = 0; k < coordinates; ++k) {
    Vec3 slope = lower.gradient(along, k);
    if (symbolic::is_zero(dag, slope)) continue;
    symbolic::Expander expander(dag, term_budget);
    for (Ref& x : slope) x = expander.expand_or_keep(x);
    if (std::any_of(slope.begin(), slope.end(), [&](Ref x) { return depends_on_coordinates(dag, x); }))
      return std::nullopt;
    const Vec3 across = lower.cross(along, slope);
    if (std::all_of(across.begin(), across.end(), [&](Ref x) { return dag.is_zero(expander.expand_or_keep(x)); }))
      return slope;
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Vec3> direction(Lowering& lower, Dag& dag, std::size_t coordinates, const Vec3& along) {
  if (dag.reachable({along[0], along[1], along[2]}).size() > most_nodes) return std::nullopt;
  if (auto found = line(lower, dag, coordinates, along)) return found;
  std::optional<std::vector<Ref>> common;
  for (const Ref x : along) {
    if (dag.is_zero(x)) continue;
    std::vector<Ref> all = factors(dag, x), both;
    std::sort(all.begin(), all.end());
    if (common) std::set_intersection(common->begin(), common->end(), all.begin(), all.end(), std::back_inserter(both));
    common = common ? both : all;
  }
  Vec3 rest = along;
  bool changed = false;
  for (const Ref factor : common.value_or(std::vector<Ref>{})) {
    if (!depends_on_coordinates(dag, factor) || dag.is_positive(factor)) continue;
    // A sum may be listed as a factor besides those of its terms: each is used once, while all components still have
    // it.
    const auto has = [&](Ref x) {
      if (dag.is_zero(x)) return true;
      const std::vector<Ref> all = factors(dag, x);
      return std::find(all.begin(), all.end(), factor) != all.end();
    };
    if (!std::all_of(rest.begin(), rest.end(), has)) continue;
    for (Ref& x : rest) x = dag.is_zero(x) ? x : without(dag, x, factor);
    changed = true;
  }
  return changed ? std::optional(rest) : std::nullopt;
}

}  // namespace eomgen::mechanics

// SPDX-License-Identifier: GPL-3.0-or-later
// position = { custom = [q1, q2, q3], x = [..] } and/or q = [..]: coordinates that the user defines by x(q), by q(x) in
// x1, x2, x3, or by both. The result is x(q), checked numerically to be the inverse of q(x).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/read_positions.hpp"
#include "model/samples.hpp"
#include "model/syntax.hpp"

namespace eomgen::model {

using Id = std::uint32_t;

namespace {

// Inversion of coordinates given as functions of x1, x2, x3. In: q_k = f_k(x1, x2, x3). Out: x(q), eq. (1.16).

constexpr std::array<const char*, 3> cartesian_names{"x1", "x2", "x3"};

constexpr std::size_t largest_pool = 60000;  // of nodes; beyond, nobody wants the result

// Solves for the unknowns. All trees are in one pool; children have smaller ids than their parents.
class Solver {
 public:
  Solver(const std::array<Syntax, 3>& f, const std::array<std::string, 3>& names) {
    for (std::size_t k = 0; k < 3; ++k) {
      span_ = f[k].whole;
      const Id shift = static_cast<Id>(pool_.size());
      for (SyntaxNode node : f[k].nodes) {
        for (Id& child : node.children) child += shift;
        pool_.push_back(std::move(node));
      }
      equations_.push_back({f[k].root + shift, name(names[k])});
    }
  }

  std::optional<std::array<Syntax, 3>> solve() {
    if (!eliminate(equations_, {0, 1, 2})) return std::nullopt;
    std::array<Syntax, 3> result;
    for (std::size_t k = 0; k < 3; ++k) result[k] = extracted(solution_[k]);
    return result;
  }

 private:
  struct Equation {
    Id left, right;  // the right-hand side contains no remaining unknown
  };
  struct Linear {
    Id constant, factor;
  };

  Id add(SyntaxNode node) {
    node.span = span_;
    pool_.push_back(std::move(node));
    return static_cast<Id>(pool_.size() - 1);
  }
  Id name(const std::string& text) {
    SyntaxNode node;
    node.kind = SyntaxKind::name;
    node.parts = {text};
    return add(std::move(node));
  }
  Id number(const Rational& value) {
    SyntaxNode node;
    node.value = value;
    return add(std::move(node));
  }
  Id call(const std::string& function, Id argument) {
    SyntaxNode node;
    node.kind = SyntaxKind::call;
    node.parts = {function};
    node.children = {argument};
    return add(std::move(node));
  }
  bool is_number(Id id) const { return pool_[id].kind == SyntaxKind::number && !pool_[id].unit; }
  bool is(Id id, int value) const { return is_number(id) && pool_[id].value == value; }

  // a op b with constants folded and 0 and 1 simplified, so that cancellation is detected.
  Id make(SyntaxKind kind, Id a, Id b) {
    if (is_number(a) && is_number(b) && kind != SyntaxKind::power && !(kind == SyntaxKind::divide && is(b, 0))) {
      const Rational &x = pool_[a].value, &y = pool_[b].value;
      return number(kind == SyntaxKind::add        ? x + y
                    : kind == SyntaxKind::subtract ? x - y
                    : kind == SyntaxKind::multiply ? x * y
                                                   : x / y);
    }
    if (kind == SyntaxKind::add && is(a, 0)) return b;
    if ((kind == SyntaxKind::add || kind == SyntaxKind::subtract) && is(b, 0)) return a;
    if (kind == SyntaxKind::multiply && (is(a, 0) || is(b, 1))) return a;
    if (kind == SyntaxKind::multiply && (is(b, 0) || is(a, 1))) return b;
    if (kind == SyntaxKind::divide && (is(b, 1) || is(a, 0))) return a;
    SyntaxNode node;
    node.kind = kind;
    node.children = {a, b};
    return add(std::move(node));
  }

  // Marks the nodes that contain x_k.
  std::vector<bool> holders(std::size_t unknown) const {
    std::vector<bool> holds(pool_.size());
    for (std::size_t id = 0; id < pool_.size(); ++id) {
      const SyntaxNode& node = pool_[id];
      holds[id] = node.kind == SyntaxKind::name
                      ? node.parts.size() == 1 && node.parts[0] == cartesian_names[unknown]
                      : std::any_of(node.children.begin(), node.children.end(), [&](Id child) { return holds[child]; });
    }
    return holds;
  }

  // The expression as constant + factor * unknown, if its structure shows that it is linear.
  std::optional<Linear> linear(Id id, const std::vector<bool>& holds) {
    if (id >= holds.size() || !holds[id]) return Linear{id, number(0)};
    const SyntaxNode node = pool_[id];
    if (node.kind == SyntaxKind::name) return Linear{number(0), number(1)};
    const auto part = [&](std::size_t k) { return linear(node.children[k], holds); };
    const auto free = [&](std::size_t k) { return !holds[node.children[k]]; };
    switch (node.kind) {
      case SyntaxKind::negate: {
        const auto a = part(0);
        if (!a) return std::nullopt;
        return Linear{make(SyntaxKind::subtract, number(0), a->constant),
                      make(SyntaxKind::subtract, number(0), a->factor)};
      }
      case SyntaxKind::add:
      case SyntaxKind::subtract: {
        const auto a = part(0), b = part(1);
        if (!a || !b) return std::nullopt;
        return Linear{make(node.kind, a->constant, b->constant), make(node.kind, a->factor, b->factor)};
      }
      case SyntaxKind::multiply:
      case SyntaxKind::divide: {
        const std::size_t other = free(1) ? 1 : 0;
        if (!free(other) || (other == 0 && node.kind == SyntaxKind::divide)) return std::nullopt;
        const auto a = part(1 - other);
        if (!a) return std::nullopt;
        const Id by = node.children[other];
        return Linear{make(node.kind, a->constant, by), make(node.kind, a->factor, by)};
      }
      default: return std::nullopt;
    }
  }

  // The unknown from left = right: directly if it is linear, otherwise by repeatedly inverting the outermost operation.
  std::optional<Id> isolate(Id left, Id right, const std::vector<bool>& holds) {
    while (pool_.size() < largest_pool) {
      if (const auto line = linear(left, holds)) {
        if (is(line->factor, 0)) return std::nullopt;  // it cancels
        return make(SyntaxKind::divide, make(SyntaxKind::subtract, right, line->constant), line->factor);
      }
      const auto next = undone(left, right, holds);
      if (!next) return std::nullopt;
      left = next->left;
      right = next->right;
    }
    return std::nullopt;
  }

  std::optional<Equation> undone(Id left, Id right, const std::vector<bool>& holds) {
    const SyntaxNode node = pool_[left];
    if (node.kind == SyntaxKind::negate)
      return Equation{node.children[0], make(SyntaxKind::subtract, number(0), right)};
    if (node.kind == SyntaxKind::call) return inverse_function(node, right);
    if (node.children.size() != 2) return std::nullopt;
    const Id a = node.children[0], b = node.children[1];
    if (holds[a] && holds[b]) return std::nullopt;
    switch (node.kind) {
      case SyntaxKind::add: return Equation{holds[a] ? a : b, make(SyntaxKind::subtract, right, holds[a] ? b : a)};
      case SyntaxKind::subtract:
        if (holds[a]) return Equation{a, make(SyntaxKind::add, right, b)};
        return Equation{b, make(SyntaxKind::subtract, a, right)};
      case SyntaxKind::multiply: return Equation{holds[a] ? a : b, make(SyntaxKind::divide, right, holds[a] ? b : a)};
      case SyntaxKind::divide:
        if (holds[a]) return Equation{a, make(SyntaxKind::multiply, right, b)};
        return Equation{b, make(SyntaxKind::divide, a, right)};
      case SyntaxKind::power:
        if (holds[b]) return Equation{b, make(SyntaxKind::divide, call("log", right), call("log", a))};
        if (!is_number(b) || pool_[b].value * 2 != 1) return std::nullopt;
        return Equation{a, make(SyntaxKind::power, right, number(2))};
      default: return std::nullopt;
    }
  }

  std::optional<Equation> inverse_function(const SyntaxNode& node, Id y) {
    if (node.children.size() != 1) return std::nullopt;
    const Id x = node.children[0];
    const std::string& f = node.parts[0];
    for (const auto& [function, inverse] :
         {std::pair{"exp", "log"}, {"log", "exp"}, {"asin", "sin"}, {"acos", "cos"}, {"atan", "tan"}}) {
      if (f == function) return Equation{x, call(inverse, y)};
    }
    const Id one = number(1), two = number(2), square = make(SyntaxKind::power, y, two);
    if (f == "sqrt") return Equation{x, square};
    if (f == "sinh")
      return Equation{x, call("log", make(SyntaxKind::add, y, call("sqrt", make(SyntaxKind::add, square, one))))};
    if (f == "tanh") {
      const Id ratio = make(SyntaxKind::divide, make(SyntaxKind::add, one, y), make(SyntaxKind::subtract, one, y));
      return Equation{x, make(SyntaxKind::divide, call("log", ratio), two)};
    }
    return std::nullopt;
  }

  // A copy of the tree with the unknown replaced.
  Id substituted(Id root, const std::vector<bool>& holds, Id by) {
    std::map<Id, Id> known;
    const auto copy = [&](const auto& self, Id id) -> Id {
      if (id >= holds.size() || !holds[id]) return id;
      if (pool_[id].kind == SyntaxKind::name) return by;
      if (const auto found = known.find(id); found != known.end()) return found->second;
      SyntaxNode node = pool_[id];
      for (Id& child : node.children) child = self(self, child);
      return known[id] = add(std::move(node));
    };
    return copy(copy, root);
  }

  // Equations with few unknowns come first. The expression of an unknown is completed once the others are known.
  bool eliminate(const std::vector<Equation>& equations, const std::vector<std::size_t>& unknowns) {
    if (unknowns.empty()) return true;
    std::map<std::size_t, std::vector<bool>> holds;
    for (const std::size_t k : unknowns) holds[k] = holders(k);
    const auto count = [&](const Equation& e) {
      return std::count_if(unknowns.begin(), unknowns.end(), [&](std::size_t k) { return holds[k][e.left]; });
    };
    std::vector<std::size_t> order(equations.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return count(equations[a]) < count(equations[b]); });
    for (const std::size_t e : order) {
      for (const std::size_t k : unknowns) {
        if (!holds[k][equations[e].left]) continue;
        const auto found = isolate(equations[e].left, equations[e].right, holds[k]);
        if (!found || pool_.size() > largest_pool) continue;
        std::vector<Equation> rest;
        for (std::size_t other = 0; other < equations.size(); ++other) {
          if (other != e)
            rest.push_back({substituted(equations[other].left, holds[k], *found), equations[other].right});
        }
        std::vector<std::size_t> left;
        std::copy_if(unknowns.begin(), unknowns.end(), std::back_inserter(left), [&](std::size_t u) { return u != k; });
        if (!eliminate(rest, left)) continue;
        Id value = *found;
        for (const std::size_t u : left) value = substituted(value, holders(u), solution_[u]);
        solution_[k] = value;
        return true;
      }
    }
    return false;
  }

  // The part of the pool that belongs to one tree.
  Syntax extracted(Id root) const {
    Syntax result;
    std::map<Id, Id> moved;
    const auto copy = [&](const auto& self, Id id) -> Id {
      if (const auto found = moved.find(id); found != moved.end()) return found->second;
      SyntaxNode node = pool_[id];
      for (Id& child : node.children) child = self(self, child);
      result.nodes.push_back(std::move(node));
      return moved[id] = static_cast<Id>(result.nodes.size() - 1);
    };
    result.root = copy(copy, root);
    result.whole = pool_[root].span;
    return result;
  }

  std::vector<SyntaxNode> pool_;
  std::vector<Equation> equations_;
  std::array<Id, 3> solution_{};
  Span span_;
};

/// x1, x2, x3 as expressions of `names`. The unknowns are isolated one after the other; only functions with a unique
/// inverse are inverted (no even powers, no sin). Nothing if no order of elimination succeeds. The caller checks the
/// result numerically.
std::optional<std::array<Syntax, 3>> invert(const std::array<Syntax, 3>& f, const std::array<std::string, 3>& names) {
  if (std::any_of(f.begin(), f.end(), [](const Syntax& s) { return s.unit.has_value(); })) return std::nullopt;
  return Solver(f, names).solve();
}

constexpr const char* custom_form = "write custom = [\"q1\", \"q2\", \"q3\"], x = [\"..\", \"..\", \"..\"]";
constexpr const char* give_x = "give x = [\"..\", \"..\", \"..\"] in terms of the coordinates too; it is then checked";

}  // namespace

PositionsReader::ExpandedPosition PositionsReader::custom_position(const Value& table, const Entry& entry) {
  require_kind(Value::Kind::array, entry.value, "'custom'", custom_form);
  if (entry.value.items.size() != 3) {
    source_.fail(entry.value.span, fmt::format("'custom' has {} entries", entry.value.items.size()), custom_form);
  }
  const Value *x = table.find("x"), *q = table.find("q");
  if (x == nullptr && q == nullptr) {
    source_.fail(entry.span, "custom coordinates are named here but not defined",
                 "add x = [..] in terms of them, or q = [..] in terms of x1, x2, x3");
  }
  for (const Value* list : {x, q}) {
    if (list == nullptr) continue;
    require_kind(Value::Kind::array, *list, list == x ? "'x'" : "'q'", custom_form);
    if (list->items.size() != 3) {
      source_.fail(list->span, fmt::format("'{}' has {} entries", list == x ? 'x' : 'q', list->items.size()),
                   "give three expressions");
    }
  }
  ExpandedPosition expanded;
  expanded.chart.system = "custom";
  for (std::size_t k = 0; k < 3; ++k) {
    const Value& item = entry.value.items[k];
    if (!item.is(Value::Kind::text) || !is_identifier(item.text)) {
      source_.fail(item.span, "an entry of custom is the name of a coordinate", custom_form);
    }
    expanded.chart.entries[k] =
        resolver_.value(item, {"an entry of the position", on_motion, Shape::scalar, std::nullopt, ""}).node;
  }
  const Context context{"the position", on_motion, Shape::scalar, dimension_of("m"), ""};
  if (x != nullptr) {
    for (std::size_t k = 0; k < 3; ++k) expanded.x[k] = resolver_.value(x->items[k], context);
  } else {
    expanded.x = solved_position(entry.value, *q, context);
  }
  if (q != nullptr) check_inverse(expanded, *q, x != nullptr);
  return expanded;
}

// Solves q(x), given alone, for x1, x2, x3.
std::array<TypedNode, 3> PositionsReader::solved_position(const Value& names, const Value& q, const Context& context) {
  std::array<Syntax, 3> f;
  std::array<std::string, 3> of;
  for (std::size_t k = 0; k < 3; ++k) {
    const Value& item =
        require_kind(Value::Kind::text, q.items[k], "an entry of q", "write an expression of x1, x2, x3 in quotes");
    f[k] = parse_quantity(source_text(source_, item));
    of[k] = names.items[k].text;
    for (const char* cartesian : cartesian_names) {
      if (of[k] != cartesian) continue;
      source_.fail(names.items[k].span, fmt::format("'{}' is a Cartesian coordinate in q = [..]", of[k]),
                   "give the coordinate another name, or give x = [..]");
    }
    const Symbol* symbol = scope_.find(of[k]);
    if (symbol != nullptr && symbol->kind == SymbolKind::coordinate) continue;
    source_.fail(names.items[k].span, fmt::format("'{}' is no coordinate, and q(x) defines three of them", of[k]),
                 give_x);
  }
  const auto solution = invert(f, of);
  if (!solution) {
    source_.fail(q.span, "q(x) cannot be solved for x1, x2, x3: no unknown can be isolated with a single value",
                 give_x);
  }
  std::array<TypedNode, 3> x;
  for (std::size_t k = 0; k < 3; ++k) x[k] = resolver_.tree((*solution)[k], context);
  return x;
}

// Checks q(x(q)) = q at sample points.
void PositionsReader::check_inverse(const ExpandedPosition& expanded, const Value& q, bool both) {
  constexpr int tries = 200, enough = 8;
  constexpr double tolerance = 1e-8;  // for values around 1 and a few roots and quotients
  std::map<std::string, TypedNode> local;
  for (std::size_t k = 0; k < 3; ++k) local[cartesian_names[k]] = expanded.x[k];
  std::array<NodeId, 3> back{};
  for (std::size_t k = 0; k < 3; ++k) {
    const Context context{"an entry of q", on_time, Shape::scalar, std::nullopt,
                          "q is made of x1, x2, x3, parameters and functions of time"};
    back[k] = resolver_.value_with_names(q.items[k], local, context).node;
  }
  Samples samples(model_);
  int seen = 0;
  for (int k = 0; k < tries && seen < enough; ++k) {
    samples.next();
    bool finite = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const double was = samples.value(expanded.chart.entries[i]), is = samples.value(back[i]);
      finite = finite && std::isfinite(was) && std::isfinite(is);
      if (!finite || std::abs(is - was) <= tolerance * (1 + std::abs(was))) continue;
      source_.fail(
          q.items[i].span,
          fmt::format("q(x) and x(q) are not inverse: where this coordinate is {:.4g}, they give {:.4g}", was, is),
          both ? "correct one of them, or state in [coordinates] the range where they are inverse"
               : "state in [coordinates] a range where q(x) has one solution, or give x = [..] too");
    }
    if (finite) ++seen;
  }
  if (seen < enough) {
    source_.fail(q.span, "q(x) and x(q) could not be compared: they have values at too few points",
                 "state ranges in [coordinates] where both have values, or give x = [..] alone");
  }
}

}  // namespace eomgen::model

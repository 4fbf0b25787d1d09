// SPDX-License-Identifier: GPL-3.0-or-later
// Names: leaves, derivatives by name, and NAME.part.
#include <fmt/format.h>

#include <algorithm>

#include "model/resolver.hpp"

namespace eomgen::model {
namespace {

std::string joined(const std::vector<std::string>& parts) { return fmt::format("{}", fmt::join(parts, ".")); }

}  // namespace

TypedNode Resolver::node(const Syntax& syntax, std::uint32_t id) {
  const SyntaxNode& node = syntax.nodes[id];
  const auto child = [&](std::size_t k) { return this->node(syntax, node.children[k]); };
  switch (node.kind) {
    case SyntaxKind::number: return number_node(node);
    case SyntaxKind::name: return name(node);
    case SyntaxKind::call: return call(syntax, node);
    case SyntaxKind::negate: return negate(child(0), node.span);
    case SyntaxKind::add:
    case SyntaxKind::subtract: {
      const TypedNode a = child(0);
      return add(node.kind, a, child(1), node.span);
    }
    case SyntaxKind::multiply: {
      const TypedNode a = child(0);
      return multiply(a, child(1), node.span);
    }
    case SyntaxKind::divide: {
      const TypedNode a = child(0);
      return divide(a, child(1), node.span);
    }
    case SyntaxKind::power: {
      const TypedNode a = child(0);
      return power(a, child(1), node.span);
    }
    default: source_.fail(node.span, "a comparison is used where a value is required", "write if(a < b, x, y)");
  }
}

TypedNode Resolver::name(const SyntaxNode& node) {
  if (node.parts.size() == 1 && node.primes == 0) return plain_name(node);
  Symbol* symbol = scope_.find(node.parts[0]);
  if (symbol == nullptr && node.parts[0] == "reaction" && node.primes == 0) return reaction(node);
  if (symbol == nullptr) unknown_name(node);
  symbol->used = true;
  if (symbol->frame > 0 && node.parts.size() == 2) {
    const std::string& part = node.parts[1];
    const bool axis = part.size() == 2 && part[0] == 'e' && part[1] >= '1' && part[1] <= '3';
    if (axis || part == "omega" || symbol->kind == SymbolKind::frame || rotation_entry(symbol->frame, part, node.span))
      return frame_part(node, *symbol);
  }
  if (symbol->kind != SymbolKind::place) {
    source_.fail(node.span, fmt::format("'{}' is {} and has no parts", symbol->name, kind_name(symbol->kind)),
                 "NAME.part reaches into particles and points: P.e_theta, P.a_r, P.g_r");
  }
  if (node.parts.size() > 2 || node.primes > 0) {
    source_.fail(node.span, fmt::format("{} has no part of this form", quote(symbol->name)),
                 "a particle has P.e_q, P.a_q and P.g_q for its coordinates q");
  }
  return basis_vector(node, *symbol);
}

// B.e1 of a body or frame, with one or two primes for the axes after one or two of its Euler angles; B.omega.
TypedNode Resolver::frame_part(const SyntaxNode& node, const Symbol& symbol) {
  const std::string& part = node.parts[1];
  const std::string written = joined(node.parts) + std::string(node.primes, '\'');
  const bool axis = part.size() == 2 && part[0] == 'e' && part[1] >= '1' && part[1] <= '3';
  TypedNode result;
  if (part == "omega" && node.primes == 0) {
    result = angular_velocity(symbol.frame, node.span);
  } else if (axis) {
    const std::size_t k = static_cast<std::size_t>(part[1] - '1');
    result = own_axis(symbol.frame, k, node.span);
    const std::size_t stages = model_.frames[symbol.frame].stages.size();
    if (node.primes >= stages) {
      source_.fail(node.span, fmt::format("'{}' has no axis '{}'", symbol.name, written),
                   stages > 1
                       ? "one prime stands for the axes after the first of its angles, two for those after the second"
                       : "primes are for intermediate axes of Euler angles");
    }
    if (node.primes > 0) result = this->axis(symbol.frame, node.primes - 1, k, node.span);
  } else if (const std::optional<std::size_t> entry = rotation_entry(symbol.frame, part, node.span)) {
    result = dual_vector(symbol.frame, *entry, node.span);
  } else {
    source_.fail(node.span, fmt::format("'{}' has no part {}", symbol.name, quote(part)),
                 "its parts are e1, e2, e3, omega, and g_q for the coordinates q of its rotation");
  }
  require_allowed(result.dependencies, node.span, fmt::format("'{}'", written));
  return result;
}

std::optional<std::size_t> Resolver::rotation_entry(std::uint32_t frame, const std::string& part, Span span) {
  const Symbol* coordinate = part.starts_with("g_") ? scope_.find(part.substr(2)) : nullptr;
  if (coordinate == nullptr || coordinate->kind != SymbolKind::coordinate) return std::nullopt;
  symbol(scope_.axes(frame), span);  // its entries may be declared later
  const std::vector<NodeId>& entries = model_.frames[frame].entries;
  if (entries.size() < 3) return std::nullopt;
  std::optional<std::size_t> result;
  for (std::size_t k = 0; k < entries.size(); ++k) {
    const Node& entry = model_.arena[entries[k]];
    if (entry.op != Op::coordinate || entry.order != 0) return std::nullopt;
    if (entry.index == coordinate->index) result = k;
  }
  return result;
}

// reaction.NAME or reaction.NAME.k, named like the outputs.
TypedNode Resolver::reaction(const SyntaxNode& node) {
  const std::string written = joined(node.parts);
  const Symbol* symbol = node.parts.size() <= 3 ? scope_.find(node.parts[1]) : nullptr;
  if (symbol == nullptr || symbol->kind != SymbolKind::constraint) {
    const std::string hint = did_you_mean(node.parts[1], scope_.names(SymbolKind::constraint));
    source_.fail(node.span, fmt::format("{} is no constraint force", quote(written)),
                 hint.empty() ? "write reaction.NAME with the name of a constraint" : hint);
  }
  require_allowed(on_reaction, node.span, fmt::format("'{}'", written));
  const std::size_t count = model_.constraints[symbol->index].reaction_count();
  const std::string part = node.parts.size() == 3 ? node.parts[2] : "";
  const std::size_t k =
      part.size() == 1 && part[0] > '0' && part[0] <= '9' ? static_cast<std::size_t>(part[0] - '0') : 0;
  if (count > 1 ? k < 1 || k > count : !part.empty()) {
    source_.fail(node.span,
                 fmt::format("{} is no constraint force: '{}' has {} equation{}", quote(written), symbol->name, count,
                             count > 1 ? "s" : ""),
                 count > 1 ? fmt::format("write reaction.{0}.1 to reaction.{0}.{1}", symbol->name, count)
                           : fmt::format("write reaction.{}", symbol->name));
  }
  TypedNode result = make(Op::reaction, false, {}, node.span);
  model_.arena.nodes[result.node].index = symbol->index;
  model_.arena.nodes[result.node].order = static_cast<std::uint8_t>(k > 0 ? k - 1 : 0);
  result.dependencies = on_reaction;
  return result;
}

TypedNode Resolver::basis_vector(const SyntaxNode& node, Symbol& symbol) {
  const std::string& part = node.parts[1];
  const Symbol* coordinate_symbol = part.size() > 2 && part[1] == '_' ? scope_.find(part.substr(2)) : nullptr;
  const bool basis = coordinate_symbol != nullptr && coordinate_symbol->kind == SymbolKind::coordinate &&
                     (part[0] == 'e' || part[0] == 'a' || part[0] == 'g');
  std::vector<std::string> known;
  const TypedNode position = this->symbol(symbol, node.span);
  for (const auto& [index, order] : coordinates_of(position.node)) {
    if (order == 0) known.push_back(model_.coordinates[index].name);
  }
  if (!basis || std::find(known.begin(), known.end(), coordinate_symbol->name) == known.end()) {
    std::vector<std::string> parts;
    for (const std::string& name : known) parts.insert(parts.end(), {"e_" + name, "a_" + name, "g_" + name});
    const std::string hint = did_you_mean(part, parts);
    source_.fail(node.span, fmt::format("'{}' has no part {}", symbol.name, quote(part)),
                 !hint.empty()   ? hint
                 : known.empty() ? fmt::format("the position of '{}' depends on no coordinate", symbol.name)
                                 : fmt::format("its parts are e_q, a_q and g_q for q = {}", fmt::join(known, ", ")));
  }
  if (part[0] == 'g') {
    const auto& chart = model_.places[symbol.index].chart;
    bool slot = chart.has_value();
    for (std::size_t k = 0; slot && k < (chart->planar ? 2u : 3u); ++k)
      slot = model_.arena[chart->entries[k]].op == Op::coordinate;
    if (!slot) {
      source_.fail(node.span,
                   fmt::format("'{}' needs a position whose entries are all coordinates", joined(node.parts)),
                   "the contravariant basis exists for a full set of coordinates; use a_q or e_q");
    }
  }
  require_allowed(position.dependencies, node.span, fmt::format("'{}'", joined(node.parts)));
  const TypedNode leaf = coordinate(coordinate_symbol->index, 0, node.span);
  const Op op = part[0] == 'e' ? Op::unit_basis : part[0] == 'a' ? Op::covariant_basis : Op::contravariant_basis;
  TypedNode result = make(op, true, {leaf}, node.span);
  model_.arena.nodes[result.node].index = symbol.index;
  result.dependencies = position.dependencies;
  result.depth = position.depth + 2;
  if (op == Op::unit_basis) {
    result.literal = result.is_pure_number = true;
  } else if (leaf.dimension && position.dimension) {
    const Dimension covariant = quotient(*position.dimension, *leaf.dimension);
    result.dimension = op == Op::covariant_basis ? covariant : raised(covariant, -1);
  }
  return result;
}

TypedNode Resolver::plain_name(const SyntaxNode& node) {
  const std::string& name = node.parts[0];
  if (local_ != nullptr) {
    if (const auto found = local_->find(name); found != local_->end()) return found->second;
  }
  if (name == "pi") {
    TypedNode result = make(Op::pi, false, {}, node.span);
    result.literal = result.is_pure_number = true;  // a pure number like 2
    return result;
  }
  if (name == "t") {
    require_allowed(on_time, node.span, "'t'");
    TypedNode result = make(Op::time, false, {}, node.span);
    result.dependencies = on_time;
    result.is_bare_time = true;
    result.dimension = dimension_of("s");
    return result;
  }
  if (name == "origin" || name == "ground") {
    if (name == "ground") {
      source_.fail(node.span, "'ground' stands only where a contact or a joint asks for a body",
                   "write origin for the fixed origin");
    }
    return place(0, node.span);
  }
  if (name.size() == 2 && name[0] == 'E' && name[1] >= '1' && name[1] <= '3') {
    TypedNode result = make(Op::fixed_basis, true, {}, node.span);
    model_.arena.nodes[result.node].index = static_cast<std::uint32_t>(name[1] - '1');
    result.literal = result.is_pure_number = true;
    return result;
  }
  if (Symbol* symbol = scope_.find(name)) return leaf(*symbol, 0, node.span);
  const Derivative derivative = split_derivative(name);
  Symbol* base = derivative.order > 0 ? scope_.find(derivative.base) : nullptr;
  if (base == nullptr) unknown_name(node);
  if (base->kind != SymbolKind::coordinate && base->kind != SymbolKind::function) {
    source_.fail(node.span, fmt::format("'{}' is {}: there is no '{}'", base->name, kind_name(base->kind), name),
                 "_dot and _ddot exist for coordinates and functions of time; otherwise write ddt(...)");
  }
  return leaf(*base, derivative.order, node.span);
}

TypedNode Resolver::leaf(Symbol& symbol, std::uint8_t order, Span span) {
  symbol.used = true;
  if (symbol.kind == SymbolKind::constraint || symbol.kind == SymbolKind::force || symbol.kind == SymbolKind::event ||
      symbol.kind == SymbolKind::sample || symbol.kind == SymbolKind::frame) {
    source_.fail(span, fmt::format("'{}' is {}, not a value", symbol.name, kind_name(symbol.kind)),
                 "name a parameter, coordinate, state, function, input, definition, particle or point");
  }
  if (symbol.kind == SymbolKind::coordinate) {
    TypedNode result = coordinate(symbol.index, order, span);
    const std::string name = symbol.name + (order == 0 ? "" : order == 1 ? "_dot" : "_ddot");
    require_allowed(result.dependencies, span, fmt::format("'{}'", name));
    return result;
  }
  if (symbol.kind == SymbolKind::state) {
    const TypedNode result = state(symbol.index, span);
    require_allowed(result.dependencies, span, fmt::format("'{}'", symbol.name));
    return result;
  }
  if (symbol.kind == SymbolKind::place) {
    const TypedNode result = place(symbol.index, span);
    require_allowed(result.dependencies, span, fmt::format("'{}'", symbol.name));
    return result;
  }
  const TypedNode known = this->symbol(symbol, span);
  const Op op = symbol.kind == SymbolKind::parameter  ? Op::parameter
                : symbol.kind == SymbolKind::function ? Op::function
                : symbol.kind == SymbolKind::input    ? Op::input
                                                      : Op::definition;
  TypedNode result = make(op, known.vector, {}, span);
  model_.arena.nodes[result.node].index = symbol.index;
  model_.arena.nodes[result.node].order = order;
  result.dimension = known.dimension;
  result.has_uncertain_dimension = known.has_uncertain_dimension;
  result.dependencies = known.dependencies;
  result.depth = known.depth + 1;
  result.exponents = known.exponents;
  if (op == Op::parameter) result.constant = known.constant;
  if (op == Op::function) result.dependencies |= on_time;
  if (op == Op::input) result.dependencies = on_input;
  if (order > 0 && result.dimension) result.dimension = quotient(*result.dimension, raised(dimension_of("s"), order));
  require_allowed(result.dependencies, span, fmt::format("'{}'", symbol.name));
  return result;
}

void Resolver::unknown_name(const SyntaxNode& node) {
  const std::string name = node.parts[0];
  std::vector<std::string> candidates = scope_.names();
  for (const char* word : {"pi", "origin", "E1", "E2", "E3"}) candidates.emplace_back(word);
  const Derivative derivative = split_derivative(name);
  std::string hint;
  if (derivative.order > 0) {
    if (const auto meant = nearest(derivative.base, candidates)) {
      hint = fmt::format("did you mean '{}{}'?", *meant, name.substr(derivative.base.size()));
    }
  }
  if (hint.empty()) hint = did_you_mean(name, candidates);
  if (hint.empty() && is_reserved(name)) hint = fmt::format("'{}' is a function: write {}(...)", name, name);
  if (hint.empty()) {
    hint =
        "declare it: a coordinate in [coordinates] or in position = { cartesian = [..] }, a constant in [parameters], "
        "a value in [definitions]";
  }
  source_.fail(node.span, fmt::format("the name {} is not declared", quote(name)), hint);
}

}  // namespace eomgen::model

// SPDX-License-Identifier: GPL-3.0-or-later
// Values, contexts, and the nodes that the reader creates directly.
#include "model/resolver.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/lone_parameter.hpp"

namespace eomgen::model {
namespace {

// Sets a member for the duration of one call, and restores it even if the call throws.
template <class T>
class Hold {
 public:
  Hold(T& member, T value) : member_(member), before_(member) { member_ = value; }
  ~Hold() { member_ = before_; }
  Hold(const Hold&) = delete;
  Hold& operator=(const Hold&) = delete;

 private:
  T& member_;
  T before_;
};

std::string facts_text(Dependencies dependencies) {
  std::vector<std::string> words;
  if (dependencies & on_time) words.emplace_back("time");
  if (dependencies & on_input) words.emplace_back("inputs");
  if (dependencies & on_coordinate) words.emplace_back("coordinates");
  if (dependencies & on_velocity) words.emplace_back("velocities");
  if (dependencies & on_first_order) words.emplace_back("states of first order");
  if (dependencies & on_state_rate) words.emplace_back("rates of states");
  if (dependencies & on_acceleration) words.emplace_back("accelerations");
  if (dependencies & on_reaction) words.emplace_back("constraint forces");
  return fmt::format("{}", fmt::join(words, ", "));
}

// The value of a parameter that is declared as name = value or as name = { value = .., .. }.
const Value& declared_value(const Symbol& parameter) {
  const Value& declared = parameter.entry->value;
  const Value* value = declared.is(Value::Kind::table) ? declared.find("value") : nullptr;
  return value != nullptr ? *value : declared;
}

}  // namespace

TypedNode Resolver::value(const Value& value, const Context& context) {
  static const std::map<std::string, TypedNode> nothing;
  return value_with_names(value, nothing, context);
}

TypedNode Resolver::value_with_names(const Value& value, const std::map<std::string, TypedNode>& local,
                                     const Context& context) {
  const Hold<const Context*> hold_context(context_, &context);
  const Hold<const std::map<std::string, TypedNode>*> hold_local(local_, &local);
  switch (value.kind) {
    case Value::Kind::integer:
    case Value::Kind::real: {
      const ExactNumber exact = parse_exact_number(value.text);
      if (!exact.problem.empty()) {
        source_.fail(value.span, fmt::format("{} cannot be {}: {}", quote(value.text), context.what, exact.problem),
                     "write a finite number");
      }
      return check_context(number(exact.value, value.span), value.span, context);
    }
    case Value::Kind::text: return syntax(parse_quantity(source_text(source_, value)), context);
    case Value::Kind::array: {
      if (context.shape == Shape::scalar || value.items.size() != 3) {
        source_.fail(value.span,
                     context.shape == Shape::scalar
                         ? fmt::format("{} is a scalar, not an array", context.what)
                         : fmt::format("a vector has three components, not {}", value.items.size()),
                     "a scalar is a number or \"expression\"; a vector is \"expression\" or [x, y, z]");
      }
      Context component = context;
      component.shape = Shape::scalar;
      component.what = "a component of " + context.what;
      std::array<TypedNode, 3> parts;
      for (std::size_t k = 0; k < 3; ++k) parts[k] = this->value_with_names(value.items[k], local, component);
      return check_context(array_of(parts, value.span), value.span, context);
    }
    default:
      source_.fail(value.span, fmt::format("{} cannot be {}", context.what, kind_name(value.kind)),
                   "write a number, \"expression\" or \"expression unit\"");
  }
}

TypedNode Resolver::condition(const Value& value, const Context& context) {
  if (!value.is(Value::Kind::text))
    source_.fail(value.span, fmt::format("{} is no comparison", context.what), "write a comparison: \"a < b\"");
  Syntax syntax = parse_comparison(source_text(source_, value));
  const auto add = [&syntax](SyntaxNode node) {
    node.span = syntax.whole;
    syntax.nodes.push_back(std::move(node));
    return static_cast<std::uint32_t>(syntax.nodes.size() - 1);
  };
  SyntaxNode one, none, choice;
  one.value = 1;
  choice.kind = SyntaxKind::call;
  choice.parts = {"if"};
  choice.children = {syntax.root, add(one), add(none)};
  syntax.root = add(choice);
  return this->syntax(syntax, context);
}

TypedNode Resolver::text(std::string_view text, const std::map<std::string, TypedNode>& local, Span span,
                         const Context& context) {
  const Hold<const std::map<std::string, TypedNode>*> hold_local(local_, &local);
  return syntax(parse_expression(SourceText{text, &source_, nullptr, 0, span}), context);
}

TypedNode Resolver::syntax(const Syntax& syntax, const Context& context) {
  const Hold<const Context*> hold_context(context_, &context);
  TypedNode result = node(syntax, syntax.root);
  if (syntax.unit) result = apply_unit(result, *syntax.unit, syntax.unit_span);
  return check_context(result, syntax.whole, context);
}

TypedNode Resolver::check_context(TypedNode typed, Span span, const Context& context) {
  const bool zero = typed.literal && !typed.vector && typed.constant && cln::zerop(*typed.constant);
  if (zero && context.shape == Shape::vector) {
    typed = make(Op::zero_vector, true, {}, span);
    typed.literal = typed.is_pure_number = true;
    return typed;
  }
  if (context.shape == Shape::vector && !typed.vector) {
    source_.fail(span, fmt::format("{} is a vector, and this is a scalar", context.what),
                 "multiply by a direction such as E1 or P.e_theta, or write [x, y, z]");
  }
  if (context.shape == Shape::scalar && typed.vector) {
    source_.fail(span, fmt::format("{} is a scalar, and this is a vector", context.what),
                 "take dot(a, b), norm(a), or a component dot(a, E1)");
  }
  if (context.dimension && typed.dimension) {
    if (!same(*context.dimension, *typed.dimension)) {
      report_wrong_dimension(typed, span, fmt::format("{} must be in {}", context.what, text_of(*context.dimension)),
                             typed.has_uncertain_dimension);
    } else if (const auto parameter = parameter_along_axis(model_, typed.node)) {
      parameters_that_fit_.insert(*parameter);
    }
  }
  return typed;
}

const Symbol* Resolver::declared_parameter(std::optional<std::uint32_t> parameter) {
  if (!parameter) return nullptr;
  for (const Symbol* symbol : scope_.all(SymbolKind::parameter)) {
    const bool same = symbol->state == Symbol::State::resolved && symbol->index == *parameter;
    if (same && symbol->entry != nullptr) return symbol;
  }
  return nullptr;
}

void Resolver::refuse_value(const TypedNode& value, Span span, const std::string& what, const std::string& problem,
                            std::string remedy) {
  const Symbol* parameter = declared_parameter(lone_parameter(model_, value.node));
  if (parameter == nullptr) source_.fail(span, fmt::format("{} {}", what, problem), std::move(remedy));
  source_.fail(declared_value(*parameter).span,
               fmt::format("{}, the parameter '{}', {}", what, parameter->name, problem), std::move(remedy));
}

void Resolver::require_positive_mass(const TypedNode& mass, Span span, const std::string& what) {
  if (!mass.constant || cln::plusp(*mass.constant)) return;
  refuse_value(mass, span, fmt::format("the mass of {}", what), "is not positive", "a mass is greater than 0");
}

void Resolver::report_wrong_dimension(const TypedNode& value, Span span, const std::string& requirement, bool loose) {
  const std::string unit = text_of(*value.dimension);
  const Symbol* parameter =
      units_stated_ && !loose ? declared_parameter(parameter_along_axis(model_, value.node)) : nullptr;
  if (parameter == nullptr)
    return report_mismatch(span, fmt::format("{}, and this is in {}", requirement, unit), loose);
  // A unit that suits another use is right, and the name at this one is wrong.
  if (parameters_that_fit_.contains(parameter->index)) {
    source_.fail(span, fmt::format("the units clash: {}, and this is in {}", requirement, unit),
                 fmt::format("use another name here, or correct the unit of '{}' in line {}", parameter->name,
                             source_.where(parameter->span).line));
  }
  source_.fail(declared_value(*parameter).span,
               fmt::format("the units clash: {}, and the parameter '{}' is in {}", requirement, parameter->name, unit),
               fmt::format("correct the unit of '{}', or use another name in line {}", parameter->name,
                           source_.where(span).line));
}

void Resolver::report_mismatch(Span span, std::string what, bool loose) {
  if (!units_stated_) return;
  if (loose) {
    warn(span, std::move(what), "a bare number in it may carry the missing unit; state it, as in \"0.3[N/m]*x\"");
    return;
  }
  source_.fail(span, "the units clash: " + what, "check the formula and the units of the names in it");
}

void Resolver::warn(Span span, std::string message, std::string remedy) {
  constexpr std::size_t most = 100;
  SourceLocation where = source_.where(span);
  // A scene that inherits from another one reads its inputs again.
  const bool is_known = std::any_of(model_.warnings.begin(), model_.warnings.end(), [&](const Warning& w) {
    return w.where.line == where.line && w.where.column == where.column && w.message == message;
  });
  if (is_known || model_.warnings.size() >= most) return;
  model_.warnings.push_back(Warning{std::move(where), std::move(message), std::move(remedy)});
}

void Resolver::require_allowed(Dependencies dependencies, Span span, std::string_view what) {
  const auto excess = static_cast<Dependencies>(dependencies & static_cast<Dependencies>(~context_->allowed));
  if (excess == 0) return;
  std::string remedy = context_->remedy;
  if (remedy.empty()) {
    auto named = static_cast<Dependencies>(context_->allowed & static_cast<Dependencies>(~on_state_rate));
    if (model_.states.empty()) named = static_cast<Dependencies>(named & static_cast<Dependencies>(~on_first_order));
    remedy = named == 0 ? "use numbers and parameters only"
                        : fmt::format("use numbers, parameters and {} only", facts_text(named));
  }
  source_.fail(span, fmt::format("{} depends on {}, which {} cannot", what, facts_text(excess), context_->what),
               remedy);
}

const TypedNode& Resolver::symbol(Symbol& symbol, Span asked) {
  if (symbol.state == Symbol::State::resolved) return symbol.typed;
  if (symbol.state == Symbol::State::resolving) {
    const auto first = std::find(open_.begin(), open_.end(), symbol.name);
    std::vector<std::string> ring(first, open_.end());
    ring.push_back(symbol.name);
    if (ring.size() > 8) ring.erase(ring.begin() + 4, ring.end() - 3);
    source_.fail(asked, fmt::format("'{}' is defined by itself: {}", symbol.name, fmt::join(ring, " -> ")),
                 "break the circle: one of these names has to be given without the others");
  }
  constexpr std::size_t deepest = 200;
  if (open_.size() >= deepest) {
    source_.fail(asked, fmt::format("names refer to one another more than {} deep", deepest),
                 "state the names that are used first before the others, or use fewer steps");
  }
  symbol.state = Symbol::State::resolving;
  open_.push_back(symbol.name);
  {
    const Hold<const Context*> hold_context(context_, nullptr);
    const Hold<const std::map<std::string, TypedNode>*> hold_local(local_, nullptr);
    symbol.typed = definer_(symbol);
  }
  open_.pop_back();
  symbol.state = Symbol::State::resolved;
  return symbol.typed;
}

NodeId Resolver::push(Node node) {
  if (model_.arena.nodes.size() >= max_nodes) {
    source_.fail(node.span, fmt::format("the model has more than {} operations", max_nodes),
                 "a model of this size cannot be handled");
  }
  model_.arena.nodes.push_back(std::move(node));
  return static_cast<NodeId>(model_.arena.nodes.size() - 1);
}

TypedNode Resolver::make(Op op, bool vector, std::initializer_list<TypedNode> children, Span span) {
  Node node;
  node.op = op;
  node.vector = vector;
  node.span = span;
  TypedNode result;
  result.vector = vector;
  std::size_t k = 0;
  for (const TypedNode& child : children) {
    node.args[k++] = child.node;
    result.dependencies |= child.dependencies;
    result.depth = std::max(result.depth, child.depth + 1);
    result.exponents = std::max(result.exponents, child.exponents);
    result.has_uncertain_dimension = result.has_uncertain_dimension || child.has_uncertain_dimension;
  }
  if (result.depth > max_depth) {
    source_.fail(span,
                 fmt::format("the expression, with all that it refers to, is nested more than {} deep", max_depth),
                 "use fewer nested definitions");
  }
  result.node = push(std::move(node));
  return result;
}

TypedNode Resolver::coordinate(std::uint32_t index, std::uint8_t order, Span span) {
  TypedNode result = make(Op::coordinate, false, {}, span);
  model_.arena.nodes[result.node].index = index;
  model_.arena.nodes[result.node].order = order;
  result.dependencies = order == 0 ? on_coordinate : order == 1 ? on_velocity : on_acceleration;
  result.dimension = model_.coordinates[index].unit.dimension;
  if (result.dimension) result.dimension = quotient(*result.dimension, raised(dimension_of("s"), order));
  return result;
}

TypedNode Resolver::state(std::uint32_t index, Span span) {
  TypedNode result = make(Op::state, false, {}, span);
  model_.arena.nodes[result.node].index = index;
  result.dependencies = on_first_order;
  result.dimension = model_.states[index].unit.dimension;
  return result;
}

TypedNode Resolver::array_of(const std::array<TypedNode, 3>& components, Span span) {
  TypedNode result = make(Op::array, true, {components[0], components[1], components[2]}, span);
  TypedNode sum = components[0];
  for (std::size_t k = 1; k < 3; ++k) require_same_dimension(sum, sum, components[k], span, "components of one vector");
  result.dimension = sum.dimension;
  result.has_uncertain_dimension = sum.has_uncertain_dimension;
  result.literal = sum.literal;
  result.is_pure_number = sum.literal && sum.is_pure_number;
  return result;
}

TypedNode Resolver::extension(Span span) {
  TypedNode result = make(Op::extension, false, {}, span);
  result.dimension = dimension_of("m");
  return result;
}

TypedNode Resolver::inertia(std::uint32_t body, const TypedNode& vector, Span span) {
  TypedNode result = make(Op::inertia, false, {vector}, span);
  model_.arena.nodes[result.node].index = body;
  return result;
}

TypedNode Resolver::slip(Span span) {
  TypedNode result = make(Op::slip, false, {}, span);
  result.dependencies = on_velocity;
  return result;
}

TypedNode Resolver::sum_of(const TypedNode& a, const TypedNode& b, Span span) {
  return add(SyntaxKind::add, a, b, span);
}

TypedNode Resolver::component(const TypedNode& vector, std::uint32_t axis, Span span) {
  TypedNode direction = make(Op::fixed_basis, true, {}, span);
  model_.arena.nodes[direction.node].index = axis;
  TypedNode result = make(Op::dot, false, {vector, direction}, span);
  result.dimension = vector.dimension;
  return result;
}

TypedNode Resolver::place(std::uint32_t index, Span span) {
  TypedNode result = make(Op::place, true, {}, span);
  model_.arena.nodes[result.node].index = index;
  if (index == 0) return result;  // the origin: zero is compatible with every dimension
  const TypedNode& position = symbol(*scope_.find(model_.places[index].name), span);
  result.dependencies = position.dependencies;
  result.depth = position.depth + 1;
  result.dimension = position.dimension;
  result.has_uncertain_dimension = position.has_uncertain_dimension;
  return result;
}

bool Resolver::uses_parameters(NodeId root) const {
  std::vector<NodeId> stack{root};
  while (!stack.empty()) {
    const NodeId id = stack.back();
    stack.pop_back();
    if (id == no_node) continue;
    if (model_.arena[id].op == Op::parameter || model_.arena[id].op == Op::definition) return true;
    for (const NodeId child : model_.arena[id].args) stack.push_back(child);
  }
  return false;
}

Resolver::Constants Resolver::constants_in(NodeId root) const {
  Constants found;
  std::set<NodeId> seen;
  std::vector<NodeId> stack{root};
  while (!stack.empty()) {
    const NodeId id = stack.back();
    stack.pop_back();
    if (id == no_node || !seen.insert(id).second) continue;
    const Node& node = model_.arena[id];
    if (node.op == Op::number && cln::denominator(node.value) != 1 && cln::abs(node.value) > 1)
      found.numbers.insert(cln::abs(node.value));
    if (node.op == Op::parameter) {
      found.parameters.insert(node.index);
      stack.push_back(model_.parameters[node.index].value);
    }
    if (node.op == Op::definition) stack.push_back(model_.definitions[node.index].expression);
    for (const NodeId child : node.args) stack.push_back(child);
  }
  return found;
}

const CoordinateSet& Resolver::coordinates_of(NodeId reference) {
  const auto known = coordinates_of_.find(reference);
  if (known != coordinates_of_.end()) return known->second;
  return coordinates_of_.emplace(reference, coordinates_in(reference)).first->second;
}

// Expressions are trees except for the places and definitions to which they refer, which are cached.
CoordinateSet Resolver::coordinates_in(NodeId root) {
  CoordinateSet found;
  const auto insert = [&](std::pair<std::uint32_t, std::uint8_t> coordinate, std::uint8_t shift) {
    for (int k = coordinate.second; k <= std::min(2, coordinate.second + shift); ++k) {
      found.insert({coordinate.first, static_cast<std::uint8_t>(k)});
    }
  };
  std::vector<std::pair<NodeId, std::uint8_t>> stack{{root, 0}};
  while (!stack.empty()) {
    const auto [id, shift] = stack.back();
    stack.pop_back();
    if (id == no_node) continue;
    const Node node = model_.arena[id];
    std::uint8_t inner = shift;
    NodeId reference = no_node;
    switch (node.op) {
      case Op::coordinate: insert({node.index, node.order}, shift); break;
      case Op::total_derivative: inner = 1; break;
      case Op::definition: reference = model_.definitions[node.index].expression; break;
      case Op::angular_velocity:
        for (const NodeId e : model_.frames[node.index].stages.back().e) {
          for (const auto& coordinate : coordinates_of(e)) insert(coordinate, static_cast<std::uint8_t>(shift + 1));
        }
        break;
      case Op::axis: reference = model_.frames[node.index].stages[node.order / 3].e[node.order % 3]; break;
      case Op::place_velocity:
      case Op::place_acceleration: inner = node.op == Op::place_velocity ? 1 : 2; [[fallthrough]];
      case Op::place:
      case Op::unit_basis:
      case Op::covariant_basis:
      case Op::contravariant_basis: reference = model_.places[node.index].position; break;
      default: break;
    }
    inner = static_cast<std::uint8_t>(
        std::min(2, node.op == Op::total_derivative ? shift + inner : std::max(shift, inner)));
    if (reference != no_node) {
      for (const auto& coordinate : coordinates_of(reference)) insert(coordinate, inner);
    }
    for (const NodeId child : node.args) stack.push_back({child, inner});
  }
  return found;
}

}  // namespace eomgen::model

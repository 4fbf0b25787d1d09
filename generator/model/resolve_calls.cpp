// SPDX-License-Identifier: GPL-3.0-or-later
// Function calls: scalar functions, if, derivatives, and functions of vectors and places.
#include <cln/rational.h>
#include <fmt/format.h>

#include "model/resolver.hpp"

namespace eomgen::model {
namespace {

constexpr std::size_t max_integrals = 1000;  // with the states of the model

}  // namespace

void Resolver::arity(const SyntaxNode& node, std::size_t least, std::size_t most) {
  const std::size_t count = node.children.size();
  if (count >= least && count <= most) return;
  const std::string wanted = least == most ? std::to_string(least) : fmt::format("{} to {}", least, most);
  source_.fail(node.span,
               fmt::format("{}() takes {} argument{}, not {}", node.parts[0], wanted, wanted == "1" ? "" : "s", count),
               "see docs/model-format.md for the functions");
}

TypedNode Resolver::call(const Syntax& syntax, const SyntaxNode& node) {
  const std::string& name = node.parts[0];
  if (const FunctionSignature* function = find_function(name)) return scalar_call(syntax, node, *function);
  if (name == "if") return conditional(syntax, node);
  if (name == "ddt") return time_derivative(syntax, node);
  if (name == "diff") return partial_derivative(syntax, node);
  if (name == "dot" || name == "cross" || name == "norm" || name == "unit") return vector_call(syntax, node);
  if (name == "position" || name == "velocity" || name == "acceleration") return place_call(syntax, node);
  if (name == "integral") return integral(syntax, node);
  if (name == "omega") return omega_call(syntax, node);
  if (name == "initial") return initial(syntax, node);
  const std::string hint = did_you_mean(name, function_names());
  const bool value = scope_.find(name) != nullptr;
  source_.fail(node.span, fmt::format("there is no function {}", quote(name)),
               value ? fmt::format("'{}' is a name: write {}*(...) for a product", name, name)
               : hint.empty()
                   ? "the functions are sin cos tan asin acos atan atan2 sinh cosh tanh exp log sqrt abs "
                     "sign min max, if, ddt, diff, integral, dot, cross, norm, unit, position, velocity, acceleration"
                   : hint);
}

TypedNode Resolver::scalar_call(const Syntax& syntax, const SyntaxNode& node, const FunctionSignature& function) {
  arity(node, function.min_arguments, function.max_arguments);
  std::vector<TypedNode> arguments;
  for (const std::uint32_t child : node.children) {
    arguments.push_back(this->node(syntax, child));
    if (arguments.back().vector) {
      source_.fail(syntax.nodes[child].span, fmt::format("{}() takes scalars, and this is a vector", function.name),
                   "take norm(a) or a component dot(a, E1)");
    }
  }
  const bool same_kind = function.fn == Fn::min || function.fn == Fn::max || function.fn == Fn::atan2;
  const bool keeps = function.fn == Fn::abs || function.fn == Fn::min || function.fn == Fn::max;
  TypedNode result = arguments[0];
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    const TypedNode& a = arguments[k];
    if (!same_kind && !keeps && function.fn != Fn::sqrt && function.fn != Fn::sign && a.dimension &&
        !is_one(*a.dimension)) {
      report_wrong_dimension(a, syntax.nodes[node.children[k]].span,
                             fmt::format("{}() takes a pure number", function.name),
                             a.has_uncertain_dimension || a.is_bare_time);
    }
    if (function.fn == Fn::sin || function.fn == Fn::cos || function.fn == Fn::tan)
      warn_of_degrees(a.node, function.name);
    if (k == 0 && arguments.size() > 1) continue;
    // min and max of several arguments become nested pairs.
    TypedNode next =
        arguments.size() == 1 ? make(Op::call, false, {a}, node.span) : make(Op::call, false, {result, a}, node.span);
    model_.arena.nodes[next.node].fn = function.fn;
    if (same_kind) require_same_dimension(next, result, a, node.span, fmt::format("{}()", function.name));
    result = next;
  }
  const TypedNode& first = arguments[0];
  if (!same_kind) {
    result.dimension = Dimension{};
    result.has_uncertain_dimension = result.is_bare_time = false;
    if (function.fn == Fn::abs || function.fn == Fn::sqrt) {
      result.has_uncertain_dimension = first.has_uncertain_dimension;
      result.dimension = first.dimension;
      if (function.fn == Fn::sqrt && first.dimension) result.dimension = raised(*first.dimension, Rational(1) / 2);
      result.literal = first.literal;
      result.is_pure_number = first.is_pure_number && function.fn == Fn::abs;
      result.is_bare_time = first.is_bare_time;
    }
  } else if (function.fn == Fn::atan2) {
    result.dimension = Dimension{};
    result.has_uncertain_dimension = result.literal = result.is_bare_time = false;
  }
  return result;
}

void Resolver::warn_of_degrees(NodeId argument, std::string_view function) {
  const Rational one_turn = Rational(cln::cl_I(63)) / 10;  // the least decimal above 2 pi
  const Node& node = model_.arena[argument];
  if (node.op == Op::add || node.op == Op::subtract || node.op == Op::negate) {
    for (const NodeId child : node.args) {
      if (child != no_node) warn_of_degrees(child, function);
    }
  }
  if (node.op != Op::parameter || !parameters_in_angles_.insert(node.index).second) return;
  for (const Symbol* symbol : scope_.all(SymbolKind::parameter)) {
    if (symbol->state != Symbol::State::resolved || symbol->index != node.index) continue;
    const TypedNode& value = symbol->typed;
    if (value.dimension || !value.constant || cln::abs(*value.constant) < one_turn) return;
    const std::string& written = model_.parameters[node.index].written;
    warn(
        symbol->entry->value.span,
        fmt::format("the parameter '{}' is {} without a unit, and {}() takes radians", symbol->name, written, function),
        fmt::format("write {0} = \"{1} deg\" if degrees are meant, or {0} = \"{1} rad\"", symbol->name, written));
    return;
  }
}

TypedNode Resolver::conditional(const Syntax& syntax, const SyntaxNode& node) {
  arity(node, 3, 3);
  const SyntaxNode& test = syntax.nodes[node.children[0]];
  const bool comparison = test.kind == SyntaxKind::less || test.kind == SyntaxKind::less_equal ||
                          test.kind == SyntaxKind::greater || test.kind == SyntaxKind::greater_equal;
  if (!comparison) source_.fail(test.span, "a comparison is required here", "write a < b, as in if(a < b, x, y)");
  TypedNode a = this->node(syntax, test.children[0]);
  TypedNode b = this->node(syntax, test.children[1]);
  TypedNode x = this->node(syntax, node.children[1]);
  TypedNode y = this->node(syntax, node.children[2]);
  if (a.vector || b.vector) source_.fail(test.span, "vectors cannot be compared", "compare norm(a) or components");
  if (x.vector != y.vector)
    source_.fail(node.span, "one branch of if() is a vector and the other is not", "make both vectors or both scalars");
  TypedNode compared;
  require_same_dimension(compared, a, b, test.span, "the comparison");
  // a > b is b < a; a <= b is not (b < a)
  if (test.kind == SyntaxKind::greater || test.kind == SyntaxKind::less_equal) std::swap(a, b);
  const bool swapped = test.kind == SyntaxKind::less_equal || test.kind == SyntaxKind::greater_equal;
  TypedNode result = make(Op::conditional, x.vector, {a, b, swapped ? y : x, swapped ? x : y}, node.span);
  result.has_uncertain_dimension = false;
  require_same_dimension(result, x, y, node.span, "the branches of if()");
  return result;
}

TypedNode Resolver::time_derivative(const Syntax& syntax, const SyntaxNode& node) {
  arity(node, 1, 1);
  const TypedNode inner = this->node(syntax, node.children[0]);
  if (inner.dependencies & on_state_rate) {
    source_.fail(node.span, "second time derivatives of states of first order are not supported",
                 "take ddt of the states only");
  }
  if (inner.dependencies & on_input) {
    source_.fail(node.span, "an input has no time derivative", "declare the derivative as an input of its own");
  }
  if (inner.dependencies & on_acceleration) {
    source_.fail(node.span, "third time derivatives of coordinates are not supported",
                 "take ddt of positions and velocities only");
  }
  TypedNode result = make(Op::total_derivative, inner.vector, {inner}, node.span);
  if (inner.dependencies & on_coordinate) result.dependencies |= on_velocity;
  if (inner.dependencies & on_velocity) result.dependencies |= on_acceleration;
  if (inner.dependencies & on_first_order) result.dependencies |= on_force_variables;
  if (inner.dimension) result.dimension = quotient(*inner.dimension, dimension_of("s"));
  require_allowed(result.dependencies, node.span, "ddt() here");
  return result;
}

TypedNode Resolver::partial_derivative(const Syntax& syntax, const SyntaxNode& node) {
  arity(node, 2, 2);
  const TypedNode inner = this->node(syntax, node.children[0]);
  const SyntaxNode& by = syntax.nodes[node.children[1]];
  const TypedNode variable = this->node(syntax, node.children[1]);
  const Op op = model_.arena[variable.node].op;
  if (by.kind != SyntaxKind::name || (op != Op::coordinate && op != Op::function && op != Op::parameter &&
                                      op != Op::time && op != Op::input && op != Op::state)) {
    source_.fail(by.span, "diff() takes a derivative with respect to a name",
                 "write diff(e, x) with a coordinate, a velocity, a state, a function, a parameter, an input or t");
  }
  if ((op == Op::parameter || op == Op::function) && holds_integral(inner.node)) {
    source_.fail(node.span, "diff() of an integral by what its integrand may depend on is not supported",
                 "write the derivative of the integrand inside: integral(diff(e, p))");
  }
  if (inner.dependencies & on_acceleration) {
    source_.fail(node.span,
                 "diff() would hold the accelerations fixed, though the equations of motion make them depend on this",
                 "take derivatives of formulas without accelerations; eomgen linearize gives those of the equations of "
                 "motion");
  }
  TypedNode result = make(Op::partial_derivative, inner.vector, {inner, variable}, node.span);
  result.has_uncertain_dimension = inner.has_uncertain_dimension;
  if (inner.dimension && variable.dimension) result.dimension = quotient(*inner.dimension, *variable.dimension);
  return result;
}

// The initial value of a coordinate: a parameter that every run sets from its own initial state.
TypedNode Resolver::initial(const Syntax& syntax, const SyntaxNode& node) {
  arity(node, 1, 1);
  const SyntaxNode& of = syntax.nodes[node.children[0]];
  Symbol* const found = of.kind == SyntaxKind::name && of.parts.size() == 1 ? scope_.find(of.parts[0]) : nullptr;
  if (found == nullptr || found->kind != SymbolKind::coordinate) {
    source_.fail(of.span, "initial() takes a coordinate",
                 "write initial(q) with the name of a coordinate of the model");
  }
  symbol(*found, of.span);
  const std::uint32_t coordinate = found->index;
  require_allowed(on_time, node.span, "initial()");
  std::uint32_t index = 0;
  while (index < model_.parameters.size() && model_.parameters[index].initial_value_of != coordinate) ++index;
  if (index == model_.parameters.size()) {
    Parameter start;
    start.initial_value_of = coordinate;
    start.name =
        "initial_" + model_.coordinates[coordinate].name;  // made unlike any other name at the end (reader.cpp)
    start.value = number(0, node.span).node;
    start.used = true;
    start.span = node.span;
    model_.parameters.push_back(std::move(start));
  }
  TypedNode result = make(Op::parameter, false, {}, node.span);
  result.dependencies |= on_time;
  result.dimension = model_.coordinates[coordinate].unit.dimension;
  model_.arena.nodes[result.node].index = index;
  return result;
}

TypedNode Resolver::integral(const Syntax& syntax, const SyntaxNode& node) {
  arity(node, 1, 1);
  const TypedNode inner = this->node(syntax, node.children[0]);
  if (inner.vector) {
    source_.fail(syntax.nodes[node.children[0]].span, "integral() takes a scalar, and this is a vector",
                 "integrate its components one by one");
  }
  std::optional<Dimension> dimension;
  if (inner.dimension) dimension = product(*inner.dimension, dimension_of("s"));
  State integral;
  integral.rate = inner.node;
  integral.unit = unit_of(dimension);
  integral.span = node.span;
  const auto index = static_cast<std::uint32_t>(model_.states.size());
  const Dependencies motion = inner.dependencies & static_cast<Dependencies>(~on_time);
  if (motion != 0) {
    // Of coordinates, rates, inputs or states: a state of first order, whose rate is the integrand.
    if (motion & (on_acceleration | on_reaction | on_state_rate)) {
      source_.fail(syntax.nodes[node.children[0]].span,
                   "integral() is of time, coordinates, velocities, inputs and states, and this depends on "
                   "accelerations, constraint forces or rates of states",
                   "integrate a velocity in place of an acceleration; the integral of ddt(z) is z");
    }
    require_allowed(on_first_order, node.span, "an integral of coordinates, velocities, inputs or states");
    if (model_.states.size() >= max_integrals) {
      source_.fail(node.span, fmt::format("the model has more than {} integrals and states", max_integrals),
                   "a model of this size cannot be handled");
    }
    model_.states.push_back(std::move(integral));
    TypedNode result = state(index, node.span);
    result.dimension = dimension;
    return result;
  }
  TypedNode result = make(Op::integral, false, {inner}, node.span);
  result.dependencies |= on_time;
  result.dimension = dimension;
  require_allowed(result.dependencies, node.span, "integral()");
  model_.arena.nodes[result.node].index = index;
  integral.integral = true;
  model_.states.push_back(std::move(integral));
  return result;
}

// Looks into definitions, but not into functions of time, which diff() holds fixed.
bool Resolver::holds_integral(NodeId root) const {
  std::vector<NodeId> stack{root};
  std::set<NodeId> seen;
  while (!stack.empty()) {
    const NodeId id = stack.back();
    stack.pop_back();
    if (id == no_node || !seen.insert(id).second) continue;
    const Node& node = model_.arena[id];
    if (node.op == Op::integral) return true;
    if (node.op == Op::axis) stack.push_back(model_.frames[node.index].stages[node.order / 3].e[node.order % 3]);
    if (node.op == Op::angular_velocity) {
      for (const NodeId e : model_.frames[node.index].stages.back().e) stack.push_back(e);
    }
    if (node.op == Op::definition) stack.push_back(model_.definitions[node.index].expression);
    stack.insert(stack.end(), node.args.begin(), node.args.end());
  }
  return false;
}

TypedNode Resolver::vector_call(const Syntax& syntax, const SyntaxNode& node) {
  const std::string& name = node.parts[0];
  const bool two = name == "dot" || name == "cross";
  arity(node, two ? 2 : 1, two ? 2 : 1);
  std::vector<TypedNode> arguments;
  for (const std::uint32_t child : node.children) {
    arguments.push_back(this->node(syntax, child));
    if (!arguments.back().vector) {
      source_.fail(syntax.nodes[child].span, fmt::format("{}() takes vectors, and this is a scalar", name),
                   "a vector is made of E1, E2, E3, P.e_q, or the name of a particle");
    }
  }
  const TypedNode& a = arguments[0];
  if (!two) {
    TypedNode result = make(name == "norm" ? Op::norm : Op::unit, name == "unit", {a}, node.span);
    result.literal = name == "unit" || a.literal;
    result.is_pure_number = name == "unit" || a.is_pure_number;
    result.dimension = name == "norm" ? a.dimension : std::nullopt;
    result.has_uncertain_dimension = name == "norm" && a.has_uncertain_dimension;
    return result;
  }
  const TypedNode& b = arguments[1];
  TypedNode result = make(name == "dot" ? Op::dot : Op::cross, name == "cross", {a, b}, node.span);
  combine(result, a, b, false);
  return result;
}

TypedNode Resolver::omega_call(const Syntax& syntax, const SyntaxNode& node) {
  arity(node, 1, 1);
  const SyntaxNode& argument = syntax.nodes[node.children[0]];
  Symbol* symbol = argument.kind == SyntaxKind::name && argument.parts.size() == 1 && argument.primes == 0
                       ? scope_.find(argument.parts[0])
                       : nullptr;
  if (argument.kind == SyntaxKind::name && symbol == nullptr) unknown_name(argument);
  if (symbol == nullptr || symbol->frame == 0) {
    source_.fail(argument.span, "omega() takes the name of a body or frame",
                 "write omega(B) with a [[body]] or [[frame]]");
  }
  symbol->used = true;
  const TypedNode result = angular_velocity(symbol->frame, node.span);
  require_allowed(result.dependencies, node.span, "omega()");
  return result;
}

TypedNode Resolver::place_call(const Syntax& syntax, const SyntaxNode& node) {
  arity(node, 1, 1);
  const std::string& name = node.parts[0];
  const SyntaxNode& argument = syntax.nodes[node.children[0]];
  Symbol* symbol =
      argument.kind == SyntaxKind::name && argument.parts.size() == 1 ? scope_.find(argument.parts[0]) : nullptr;
  const bool origin = argument.kind == SyntaxKind::name && argument.parts[0] == "origin";
  if (argument.kind == SyntaxKind::name && symbol == nullptr && !origin) unknown_name(argument);
  if (!origin && (symbol == nullptr || symbol->kind != SymbolKind::place)) {
    source_.fail(argument.span, fmt::format("{}() takes the name of a particle or point", name),
                 "write ddt(...) for the derivative of a vector expression");
  }
  if (symbol != nullptr) symbol->used = true;
  TypedNode result = place(origin ? 0 : symbol->index, node.span);
  Node& made = model_.arena.nodes[result.node];
  if (name == "velocity") made.op = Op::place_velocity;
  if (name == "acceleration") made.op = Op::place_acceleration;
  if (name != "position" && (result.dependencies & on_coordinate)) result.dependencies |= on_velocity;
  if (name == "acceleration" && (result.dependencies & on_coordinate)) result.dependencies |= on_acceleration;
  if (name != "position" && result.dimension) {
    result.dimension = quotient(*result.dimension, dimension_of(name == "velocity" ? "s" : "s^2"));
  }
  require_allowed(result.dependencies, node.span, fmt::format("{}()", name));
  return result;
}

}  // namespace eomgen::model

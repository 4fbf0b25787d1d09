// SPDX-License-Identifier: GPL-3.0-or-later
// Semantic analysis of expressions: names become indices, scalars and vectors are distinguished, dimensions are
// checked. In: Syntax and the Scope of declared names. Out: nodes in Model::arena.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "model/scope.hpp"
#include "model/syntax.hpp"

namespace eomgen::model {

inline constexpr std::size_t max_nodes = 200000;  // of one model
inline constexpr int max_depth = 2000;            // of an expression with all that it refers to

/// A set of variables on which an expression depends or may depend.
using Facts = std::uint8_t;
inline constexpr Facts on_time = 1, on_input = 2, on_coordinate = 4, on_velocity = 8, on_acceleration = 16,
                       on_reaction = 32;
inline constexpr Facts on_motion = on_time | on_coordinate;
inline constexpr Facts on_anything = 31;

/// Coordinates and the order of their derivatives.
using CoordinateSet = std::set<std::pair<std::uint32_t, std::uint8_t>>;

enum class Shape { scalar, vector, either };

/// The context of an expression, and the requirements on it.
struct Context {
  std::string what;  // "the mass of 'P'"
  Facts allowed = on_anything;
  Shape shape = Shape::scalar;
  std::optional<Dimension> dimension;  // required
  std::string remedy;                  // for a forbidden dependency
};

class Resolver {
 public:
  /// Reads the declaration of a symbol on demand (implemented by the reader).
  using Definer = std::function<Typed(Symbol&)>;

  Resolver(const Source& source, Model& model, Scope& scope, Definer definer)
      : source_(source), model_(model), scope_(scope), definer_(std::move(definer)) {}

  /// Resolves a TOML value (number, expression, expression with unit, array of three) as the context requires.
  Typed value(const Value& value, const Context& context);
  /// Resolves an internal expression (for example of a coordinate system) with names of its own.
  Typed text(std::string_view text, const std::map<std::string, Typed>& local, Span span, const Context& context);
  /// Resolves an expression composed by the reader; its names are those of the model.
  Typed tree(const Syntax& syntax, const Context& context) { return this->syntax(syntax, context); }
  /// Resolves a TOML value with additional names (`extension`).
  Typed value_with(const Value& value, const std::map<std::string, Typed>& local, const Context& context);
  /// Resolves a declared name and everything on which it depends, unless that is done.
  const Typed& symbol(Symbol& symbol, Span asked);

  // Nodes created directly by the reader.
  Typed coordinate(std::uint32_t index, std::uint8_t order, Span span);
  Typed number(const Rational& value, Span span);
  Typed array_of(const std::array<Typed, 3>& components, Span span);
  Typed sum_of(const Typed& a, const Typed& b, Span span);
  Typed component(const Typed& vector, std::uint32_t axis, Span span);
  Typed place(std::uint32_t index, Span span);
  /// e_(axis+1) of a frame after a stage of its rotation; for frame 0: E_(axis+1).
  Typed axis(std::uint32_t frame, std::size_t stage, std::size_t axis, Span span);
  Typed own_axis(std::uint32_t frame, std::size_t axis, Span span);  // after the last stage
  Typed angular_velocity(std::uint32_t frame, Span span);
  /// For a vector with constant components along the axes of one frame: the same sum of E1, E2, E3; otherwise no_node.
  Typed in_axes(const Typed& vector, std::uint32_t frame);
  Typed unit_of_vector(const Typed& vector, Span span);
  Typed rate(const Typed& scalar, Span span);  // ddt
  Typed product_of(const Typed& a, const Typed& b, Span span) { return multiply(a, b, span); }
  Typed extension(Span span);
  Typed inertia(std::uint32_t body, const Typed& vector, Span span);  // v . J v
  Typed slip(Span span);
  /// The value times a unit. A value that already has the unit's dimension is unchanged if the unit has no factor.
  Typed with_unit(const Typed& typed, const MeasuredUnit& unit, Span span);

  /// Checks shape, dimension and dependence of a finished expression against the context.
  Typed meet(Typed typed, Span span, const Context& context);
  /// Coordinates (index, order) on which an expression depends, also through definitions and places.
  CoordinateSet coordinates_in(NodeId node);
  /// The same with a cache, for the expressions of places and definitions.
  const CoordinateSet& coordinates_of(NodeId reference);

  /// Whether the expression contains parameters, or definitions, which may contain some.
  bool uses_parameters(NodeId node) const;

  /// Whether the model states any unit. Without units no dimension is checked.
  void units_stated(bool stated) { units_stated_ = stated; }
  bool units_stated() const { return units_stated_; }
  void warn(Span span, std::string message, std::string remedy);

 private:
  Typed syntax(const Syntax& syntax, const Context& context);
  Typed node(const Syntax& syntax, std::uint32_t id);
  Typed number_node(const SyntaxNode& node);
  Typed apply_unit(Typed typed, const MeasuredUnit& unit, Span span);

  Typed negate(const Typed& a, Span span);
  Typed add(SyntaxKind kind, Typed a, Typed b, Span span);
  Typed multiply(const Typed& a, const Typed& b, Span span);
  Typed divide(const Typed& a, const Typed& b, Span span);
  Typed power(const Typed& a, const Typed& b, Span span);

  Typed name(const SyntaxNode& node);
  Typed plain_name(const SyntaxNode& node);
  Typed reaction(const SyntaxNode& node);
  Typed omega_call(const Syntax& syntax, const SyntaxNode& node);
  Typed frame_part(const SyntaxNode& node, const Symbol& symbol);
  Typed basis_vector(const SyntaxNode& node, Symbol& symbol);
  Typed leaf(Symbol& symbol, std::uint8_t order, Span span);
  [[noreturn]] void unknown_name(const SyntaxNode& node);

  Typed call(const Syntax& syntax, const SyntaxNode& node);
  Typed scalar_call(const Syntax& syntax, const SyntaxNode& node, const FunctionName& function);
  Typed conditional(const Syntax& syntax, const SyntaxNode& node);
  Typed time_derivative(const Syntax& syntax, const SyntaxNode& node);
  Typed partial_derivative(const Syntax& syntax, const SyntaxNode& node);
  Typed integral(const Syntax& syntax, const SyntaxNode& node);
  Typed initial(const Syntax& syntax, const SyntaxNode& node);
  bool holds_integral(NodeId root) const;
  Typed vector_call(const Syntax& syntax, const SyntaxNode& node);
  Typed place_call(const Syntax& syntax, const SyntaxNode& node);

  NodeId push(Node node);
  Typed make(Op op, bool vector, std::initializer_list<Typed> children, Span span);
  /// Sets the dimension of a sum. Known dimensions must be equal.
  void combine(Typed& result, const Typed& a, const Typed& b, bool quotient_of);
  void agree(Typed& result, const Typed& a, const Typed& b, Span span, std::string_view relation);
  void clash(Span span, std::string what, bool loose);
  void allow(Facts facts, Span span, std::string_view what);
  void check_size(Typed& typed, Span span);
  void arity(const SyntaxNode& node, std::size_t least, std::size_t most);

  const Source& source_;
  Model& model_;
  Scope& scope_;
  Definer definer_;
  bool units_stated_ = true;
  const Context* context_ = nullptr;
  const std::map<std::string, Typed>* local_ = nullptr;
  std::map<NodeId, CoordinateSet> coordinates_of_;  // of places and definitions
  std::vector<std::string> open_;                   // names being resolved, for detecting cycles
};

}  // namespace eomgen::model

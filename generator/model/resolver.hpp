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
using Dependencies = std::uint8_t;
inline constexpr Dependencies on_time = 1, on_input = 2, on_coordinate = 4, on_velocity = 8, on_acceleration = 16,
                              on_reaction = 32;
inline constexpr Dependencies on_first_order = 64;  // on states of first order
inline constexpr Dependencies on_state_rate = 128;  // on their rates, by ddt()
inline constexpr Dependencies on_motion = on_time | on_coordinate;
/// The variables of a force. The rate of a state may depend on all but on_state_rate.
inline constexpr Dependencies on_force_variables =
    on_time | on_input | on_coordinate | on_velocity | on_first_order | on_state_rate;
inline constexpr Dependencies on_anything = on_force_variables | on_acceleration;

/// Coordinates and the order of their derivatives.
using CoordinateSet = std::set<std::pair<std::uint32_t, std::uint8_t>>;

enum class Shape { scalar, vector, either };

/// The context of an expression, and the requirements on it.
struct Context {
  std::string what;  // "the mass of 'P'"
  Dependencies allowed = on_anything;
  Shape shape = Shape::scalar;
  std::optional<Dimension> dimension;  // required
  std::string remedy;                  // for a forbidden dependency
};

class Resolver {
 public:
  /// Reads the declaration of a symbol on demand (implemented by the reader).
  using Definer = std::function<TypedNode(Symbol&)>;

  Resolver(const Source& source, Model& model, Scope& scope, Definer definer)
      : source_(source), model_(model), scope_(scope), definer_(std::move(definer)) {}

  /// Resolves a TOML value (number, expression, expression with unit, array of three) as the context requires.
  TypedNode value(const Value& value, const Context& context);
  /// Resolves a comparison, as in "a < b": 1 where it holds, else 0. The context's dimension is not used.
  TypedNode condition(const Value& value, const Context& context);
  /// Resolves an internal expression (for example of a coordinate system) with names of its own.
  TypedNode text(std::string_view text, const std::map<std::string, TypedNode>& local, Span span,
                 const Context& context);
  /// Resolves an expression composed by the reader; its names are those of the model.
  TypedNode tree(const Syntax& syntax, const Context& context) { return this->syntax(syntax, context); }
  /// Resolves a TOML value with additional names (`extension`).
  TypedNode value_with_names(const Value& value, const std::map<std::string, TypedNode>& local, const Context& context);
  /// Resolves a declared name and everything on which it depends, unless that is done.
  const TypedNode& symbol(Symbol& symbol, Span asked);

  // Nodes created directly by the reader.
  TypedNode coordinate(std::uint32_t index, std::uint8_t order, Span span);
  TypedNode state(std::uint32_t index, Span span);  // of first order
  TypedNode number(const Rational& value, Span span);
  TypedNode array_of(const std::array<TypedNode, 3>& components, Span span);
  TypedNode sum_of(const TypedNode& a, const TypedNode& b, Span span);
  TypedNode component(const TypedNode& vector, std::uint32_t axis, Span span);
  TypedNode place(std::uint32_t index, Span span);
  /// e_(axis+1) of a frame after a stage of its rotation; for frame 0: E_(axis+1).
  TypedNode axis(std::uint32_t frame, std::size_t stage, std::size_t axis, Span span);
  TypedNode own_axis(std::uint32_t frame, std::size_t axis, Span span);  // after the last stage
  TypedNode angular_velocity(std::uint32_t frame, Span span);
  /// The vector dual to an entry of the rotation: g^q . w is its rate, with w relative to the parent.
  TypedNode dual_vector(std::uint32_t frame, std::size_t entry, Span span);
  /// For a vector with constant components along the axes of one frame: the same sum of E1, E2, E3; otherwise no_node.
  TypedNode in_axes(const TypedNode& vector, std::uint32_t frame);
  TypedNode unit_of_vector(const TypedNode& vector, Span span);
  TypedNode rate(const TypedNode& scalar, Span span);  // ddt
  TypedNode product_of(const TypedNode& a, const TypedNode& b, Span span) { return multiply(a, b, span); }
  TypedNode extension(Span span);
  TypedNode inertia(std::uint32_t body, const TypedNode& vector, Span span);  // v . J v
  TypedNode slip(Span span);
  /// The value times a unit. A value that already has the unit's dimension is unchanged if the unit has no factor.
  TypedNode with_unit(const TypedNode& typed, const MeasuredUnit& unit, Span span);

  /// Checks shape, dimension and dependence of a finished expression against the context.
  TypedNode check_context(TypedNode typed, Span span, const Context& context);
  /// Coordinates (index, order) on which an expression depends, also through definitions and places.
  CoordinateSet coordinates_in(NodeId node);
  /// The same with a cache, for the expressions of places and definitions.
  const CoordinateSet& coordinates_of(NodeId reference);

  /// Whether the expression contains parameters, or definitions, which may contain some.
  bool uses_parameters(NodeId node) const;

  /// Whether the model states any unit. Without units no dimension is checked.
  void set_units_stated(bool stated) { units_stated_ = stated; }
  bool units_stated() const { return units_stated_; }
  void warn(Span span, std::string message, std::string remedy);
  /// Throws Error if a mass is a number that is not positive. `what`: the name of the particle or body, in quotes.
  void require_positive_mass(const TypedNode& mass, Span span, const std::string& what);
  /// Throws Error for a value that stands at `span`: at the parameter that it is, where it is one.
  /// `what`, `problem`: "the period of 'S'", "is not positive".
  [[noreturn]] void refuse_value(const TypedNode& value, Span span, const std::string& what, const std::string& problem,
                                 std::string remedy);
  struct Constants {
    std::set<std::uint32_t> parameters;
    std::set<Rational> numbers;  // above 1 and no integers, such as 9.81; of values of the parameters too
  };
  /// Constants that an expression contains, also through definitions.
  Constants constants_in(NodeId node) const;

 private:
  /// The declaration of the parameter that an expression consists of; nullptr if it is none.
  const Symbol* declared_parameter(std::optional<std::uint32_t> parameter);
  /// Warns of parameters above one turn without a unit in the argument of a trigonometric function.
  void warn_of_degrees(NodeId argument, std::string_view function);
  TypedNode syntax(const Syntax& syntax, const Context& context);
  TypedNode node(const Syntax& syntax, std::uint32_t id);
  TypedNode number_node(const SyntaxNode& node);
  TypedNode apply_unit(TypedNode typed, const MeasuredUnit& unit, Span span);

  TypedNode negate(const TypedNode& a, Span span);
  TypedNode add(SyntaxKind kind, TypedNode a, TypedNode b, Span span);
  TypedNode multiply(const TypedNode& a, const TypedNode& b, Span span);
  TypedNode divide(const TypedNode& a, const TypedNode& b, Span span);
  TypedNode power(const TypedNode& a, const TypedNode& b, Span span);

  TypedNode name(const SyntaxNode& node);
  TypedNode plain_name(const SyntaxNode& node);
  TypedNode reaction(const SyntaxNode& node);
  TypedNode omega_call(const Syntax& syntax, const SyntaxNode& node);
  TypedNode frame_part(const SyntaxNode& node, const Symbol& symbol);
  /// The entry of the rotation that g_q names, if all entries are coordinates.
  std::optional<std::size_t> rotation_entry(std::uint32_t frame, const std::string& part, Span span);
  TypedNode basis_vector(const SyntaxNode& node, Symbol& symbol);
  TypedNode leaf(Symbol& symbol, std::uint8_t order, Span span);
  [[noreturn]] void unknown_name(const SyntaxNode& node);

  TypedNode call(const Syntax& syntax, const SyntaxNode& node);
  TypedNode scalar_call(const Syntax& syntax, const SyntaxNode& node, const FunctionSignature& function);
  TypedNode conditional(const Syntax& syntax, const SyntaxNode& node);
  TypedNode time_derivative(const Syntax& syntax, const SyntaxNode& node);
  TypedNode partial_derivative(const Syntax& syntax, const SyntaxNode& node);
  TypedNode integral(const Syntax& syntax, const SyntaxNode& node);
  TypedNode initial(const Syntax& syntax, const SyntaxNode& node);
  bool holds_integral(NodeId root) const;
  TypedNode vector_call(const Syntax& syntax, const SyntaxNode& node);
  TypedNode place_call(const Syntax& syntax, const SyntaxNode& node);

  NodeId push(Node node);
  TypedNode make(Op op, bool vector, std::initializer_list<TypedNode> children, Span span);
  /// Sets the dimension of a sum. Known dimensions must be equal.
  void combine(TypedNode& result, const TypedNode& a, const TypedNode& b, bool quotient_of);
  void require_same_dimension(TypedNode& result, const TypedNode& a, const TypedNode& b, Span span,
                              std::string_view relation);
  void report_mismatch(Span span, std::string what, bool loose);
  /// Reports a value of the wrong dimension. `requirement`: "the mass of 'P' must be in kg".
  void report_wrong_dimension(const TypedNode& value, Span span, const std::string& requirement, bool loose);
  void require_allowed(Dependencies dependencies, Span span, std::string_view what);
  void check_size(TypedNode& typed, Span span);
  void arity(const SyntaxNode& node, std::size_t least, std::size_t most);

  const Source& source_;
  Model& model_;
  Scope& scope_;
  Definer definer_;
  bool units_stated_ = true;
  const Context* context_ = nullptr;
  const std::map<std::string, TypedNode>* local_ = nullptr;
  std::map<NodeId, CoordinateSet> coordinates_of_;  // of places and definitions
  std::set<std::uint32_t> parameters_in_angles_;    // whose unit was checked
  std::set<std::uint32_t> parameters_that_fit_;     // whose unit is the one that some use requires
  std::vector<std::string> open_;                   // names being resolved, for detecting cycles
};

}  // namespace eomgen::model

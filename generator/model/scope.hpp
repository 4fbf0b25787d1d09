// SPDX-License-Identifier: GPL-3.0-or-later
// The symbol table of a model: every declared name, its kind, and its value once it is resolved.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "model/document.hpp"
#include "model/model.hpp"
#include "model/names.hpp"

namespace eomgen::model {

inline constexpr std::size_t max_names = 5000;

/// An expression of the arena with its type, dimension and dependencies.
struct TypedNode {
  NodeId node = no_node;
  bool vector = false;
  bool literal = false;                  // made of number literals and unit vectors: compatible with every dimension
  bool is_pure_number = false;           // a literal that is a pure number: 2, 1/12, E1
  bool is_bare_time = false;             // made of t and number literals: in sin(2*t) the 2 has the unit 1/s
  bool has_uncertain_dimension = false;  // dimension uncertain due to a bare number (0.3*x): mismatches are warnings
  std::optional<Dimension> dimension;    // nothing: unknown
  std::uint8_t dependencies = 0;         // the variables on which it depends
  int depth = 1;                         // including everything to which it refers
  double exponents = 1;                  // product of nested constant exponents
  std::optional<Rational> constant;      // of numbers and parameters that are numbers
};

enum class SymbolKind {
  parameter,
  function,
  input,
  coordinate,
  state,
  definition,
  place,
  frame,
  constraint,
  force,
  event,
  sample
};
const char* kind_name(SymbolKind kind);

struct Symbol {
  enum class State { unresolved, resolving, resolved };
  SymbolKind kind = SymbolKind::parameter;
  std::string name;
  Span span;
  std::uint32_t frame = 0;  // of a place that is a body: its axes
  std::uint32_t index = 0;  // in the list of the model; set when done for parameters, functions and definitions
  State state = State::unresolved;
  bool used = false;
  TypedNode typed;               // when done: value of a parameter, position of a place, ...
  const Entry* entry = nullptr;  // where it is declared
};

class Scope {
 public:
  explicit Scope(const Source& source) : source_(source) {}
  /// Throws Error if the name is illegal or taken.
  Symbol& declare(SymbolKind kind, const std::string& name, Span span, const Entry* entry = nullptr);
  Symbol* find(std::string_view name);
  std::vector<std::string> names() const;
  std::vector<std::string> names(SymbolKind kind) const;
  /// Declares the axes of a body or frame (index into Model::frames). They share its name and are resolved separately.
  void declare_axes(const std::string& name, Span span);
  Symbol& axes(std::uint32_t frame) { return axes_[frame]; }
  /// All symbols of one kind in the order of declaration.
  std::vector<Symbol*> all(SymbolKind kind);

 private:
  const Source& source_;
  std::map<std::string, Symbol, std::less<>> symbols_;
  std::vector<std::string> order_;
  std::deque<Symbol> axes_{1};  // [0]: E1 E2 E3
};

}  // namespace eomgen::model

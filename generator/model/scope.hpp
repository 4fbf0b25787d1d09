// SPDX-License-Identifier: GPL-3.0-or-later
// The one scope of a model: every declared name, what it is, and what is known of it so far.
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

/// An expression of the arena with all that is known of it.
struct Typed {
  NodeId node = no_node;
  bool vector = false;
  bool literal = false;                // of written numbers and unit vectors: no dimension, fits every one
  bool pure = false;                   // a literal that hardly carries a unit: 2, 1/12, E1
  bool bare_time = false;              // of t and written numbers: in sin(2*t) the 2 carries 1/s
  bool loose = false;                  // the dimension is known up to a bare number (0.3*x): mismatches are warnings
  std::optional<Dimension> dimension;  // nothing: unknown
  std::uint8_t facts = 0;              // what it depends on
  int depth = 1;                       // with all that it refers to
  double exponents = 1;                // product of nested constant exponents
  std::optional<Rational> constant;    // of numbers and parameters that are numbers
};

enum class SymbolKind { parameter, function, input, coordinate, definition, place, frame, constraint, force, event };
const char* kind_name(SymbolKind kind);

struct Symbol {
  enum class State { fresh, open, done };
  SymbolKind kind = SymbolKind::parameter;
  std::string name;
  Span span;
  std::uint32_t frame = 0;  // of a place that is a body: its axes
  std::uint32_t index = 0;  // in the list of the model; parameters, functions and definitions get theirs when done
  State state = State::fresh;
  bool used = false;
  Typed typed;                   // when done: value of a parameter, position of a place, ...
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
  /// The axes of a body or frame, index into Model::frames: known by the name of that, and resolved on their own.
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

// SPDX-License-Identifier: GPL-3.0-or-later
// Expressions of a model file after parsing, name resolution and type checking: trees of exact numbers, names as
// indices into the Model, and operations. The reader produces them; mechanics and verify interpret them independently.
#pragma once

#include <cln/rational.h>

#include <array>
#include <cstdint>
#include <vector>

namespace eomgen::model {

/// A range of bytes in the model file; line and column count from 1.
struct Span {
  std::uint32_t line = 0;
  std::uint32_t column = 0;
  std::uint32_t length = 0;
};

using Rational = cln::cl_RA;

enum class Op : std::uint8_t {
  // scalar leaves
  number,      // value
  pi,          //
  time,        // t
  parameter,   // index into Model::parameters
  function,    // index into Model::functions, order = 0, 1, 2 (d, d_dot, d_ddot)
  input,       // index into Model::inputs
  coordinate,  // index into Model::coordinates, order = 0, 1, 2
  definition,  // index into Model::definitions; scalar or vector
  extension,   // extension of the spring to whose energy the expression belongs
  integral,    // index into Model::states; args[0] is the integrand
  state,       // of first order: index into Model::states
  reaction,    // reaction.NAME in an event: index into Model::constraints, order = equation (joint: component), from 0
  slip,        // slip speed of the contact to whose coefficient of friction the expression belongs
  inertia,     // v . J v of a vector v = args[0] and Model::bodies[index]; only in descriptions of forces
  // scalar or vector by Node::vector (multiply: one side may be a vector; divide: vector by scalar)
  add,
  subtract,
  negate,
  multiply,
  divide,
  total_derivative,    // ddt(e)
  partial_derivative,  // diff(e, x); args[1] is a leaf: coordinate of any order, function, parameter, time or input
  conditional,         // if(args[0] < args[1], args[2], args[3]); a <= b is stored as if(b < a, y, x)
  // scalars
  power,  // args[0] ^ args[1]
  call,   // fn(args)
  dot,
  norm,
  // vectors
  zero_vector,
  fixed_basis,          // E_(index+1)
  array,                // [x, y, z]: components along E1, E2, E3
  place,                // position of Model::places[index]
  place_velocity,       // velocity(P)
  place_acceleration,   // acceleration(P)
  axis,                 // B.e1, B.e1', ..: index into Model::frames, order = 3 * stage + axis
  angular_velocity,     // omega(B): index into Model::frames
  unit_basis,           // P.e_q: index = place, order unused, args[0] = the coordinate leaf
  covariant_basis,      // P.a_q
  contravariant_basis,  // P.g_q
  cross,
  unit,
};

enum class Fn : std::uint8_t {
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  atan2,
  sinh,
  cosh,
  tanh,
  exp,
  log,
  sqrt,
  abs,
  sign,
  min,
  max,
};

using NodeId = std::uint32_t;
inline constexpr NodeId no_node = 0xffffffffu;

struct Node {
  Op op = Op::number;
  bool vector = false;
  std::uint8_t order = 0;
  Fn fn = Fn::sin;
  std::uint32_t index = 0;
  std::array<NodeId, 4> args{no_node, no_node, no_node, no_node};
  Rational value = 0;
  Span span;
};

/// All expressions of one model live in one arena; a NodeId is an index. Children have smaller ids than parents.
struct Arena {
  std::vector<Node> nodes;
  const Node& operator[](NodeId id) const { return nodes[id]; }
};

}  // namespace eomgen::model

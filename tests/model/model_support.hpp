// SPDX-License-Identifier: GPL-3.0-or-later
// Small models around one expression, and an evaluator of constant trees that is independent of the Dag.
#pragma once

#include <cln/integer.h>
#include <cln/rational.h>
#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "model/model.hpp"
#include "support/particles.hpp"

namespace eomgen::model {

inline Model read(const std::string& text) { return read_model_text(text, "model.toml"); }

/// A model with one particle and the given [parameters].
inline Model with_parameters(const std::string& parameters) {
  return read("format = 1\n[parameters]\n" + parameters +
              "\n[[particle]]\nname = \"P0\"\nmass = 1\nposition = { cartesian = [\"x0\", \"y0\"] }\n");
}

/// A free particle P in spherical coordinates R, phi, theta with parameters m, g, L, k, followed by `more`.
inline std::string particle(const std::string& more) {
  return R"(format = 1
[parameters]
m = "1 kg"
g = "9.81 m/s^2"
L = "1 m"
k = "30 N/m"
)" + test::particle_in_space +
         more;
}

/// The message of the error for a text; "accepted" if there is none.
inline std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const Error& error) {
    return error.message();
  }
  return "accepted";
}

/// The exact value of a constant expression of numbers, parameters and + - * / ^.
inline Rational exact(const Model& model, NodeId id) {
  const Node& node = model.arena[id];
  const auto arg = [&](std::size_t k) { return exact(model, node.args[k]); };
  switch (node.op) {
    case Op::number: return node.value;
    case Op::parameter: return exact(model, model.parameters[node.index].value);
    case Op::add: return arg(0) + arg(1);
    case Op::subtract: return arg(0) - arg(1);
    case Op::negate: return -arg(0);
    case Op::multiply: return arg(0) * arg(1);
    case Op::divide: return arg(0) / arg(1);
    case Op::power: return cln::expt(arg(0), cln::numerator(arg(1)));
    default: FAIL("not a constant"); return 0;
  }
}

/// The same with pi, in binary64.
inline double approximate(const Model& model, NodeId id) {
  const Node& node = model.arena[id];
  const auto arg = [&](std::size_t k) { return approximate(model, node.args[k]); };
  switch (node.op) {
    case Op::number: return cln::double_approx(node.value);
    case Op::pi: return std::acos(-1.0);
    case Op::add: return arg(0) + arg(1);
    case Op::negate: return -arg(0);
    case Op::multiply: return arg(0) * arg(1);
    case Op::divide: return arg(0) / arg(1);
    default: FAIL("not a constant"); return 0;
  }
}

inline Rational value_of(const std::string& expression) {
  const Model model = with_parameters("p = \"" + expression + "\"");
  return exact(model, model.parameters[0].value);
}

inline Rational ratio(long numerator, long denominator) {
  return Rational(cln::cl_I(numerator)) / cln::cl_I(denominator);
}

}  // namespace eomgen::model

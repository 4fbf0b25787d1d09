// SPDX-License-Identifier: GPL-3.0-or-later
// Lowers the model's expression trees to Dag nodes, including kinematics (velocities, bases).
#pragma once

#include <cln/real.h>

#include <unordered_map>

#include "mechanics/mechanics.hpp"

namespace eomgen::mechanics {

using symbolic::Scalar;

/// The operation of symbolic/functions.hpp for a function of the model language.
symbolic::Op op_of(model::Fn fn);

/// Builds model expressions on the Dag of `mechanics`. Memoised: shared subexpressions of the model stay shared.
class Lowering {
 public:
  explicit Lowering(Mechanics& mechanics);

  Ref scalar(model::NodeId id);
  Vec3 vector(model::NodeId id);
  Vec3 position(std::uint32_t place);
  Vec3 axis(std::uint32_t frame, std::size_t stage, std::size_t k);
  /// The angular velocity of the axes after a stage, along these axes; `rates_before`: that of the axes before the
  /// stage, along those (at first: of the frame's parent).
  std::array<Ref, 3> rates(std::uint32_t frame, std::size_t stage);
  std::array<Ref, 3> rates_before(std::uint32_t frame, std::size_t stage);
  std::array<Ref, 3> own_rates(std::uint32_t frame);
  Vec3 angular_velocity(std::uint32_t frame);  // w = n1dot g1 + n2dot g2 + n3dot g3, eq. (5.59)

  /// Sets the value of Op::extension while a spring's energy is lowered.
  void set_extension(Ref extension);
  /// Sets the value of Op::slip, the slip speed, while coefficients of friction are lowered.
  void set_slip(Ref speed);

  Ref dot(const Vec3& a, const Vec3& b) { return symbolic::dot(dag_, a, b); }
  Vec3 subtract(const Vec3& a, const Vec3& b) { return symbolic::subtract(dag_, a, b); }
  Vec3 scale(Ref factor, const Vec3& a) { return symbolic::scale(dag_, factor, a); }
  Vec3 add(const Vec3& a, const Vec3& b) { return symbolic::add(dag_, a, b); }
  Vec3 cross(const Vec3& a, const Vec3& b) { return symbolic::cross(dag_, a, b); }
  Ref norm(const Vec3& a);
  Vec3 gradient(const Vec3& a, std::uint32_t coordinate);  // d a/d q

  /// d/dt. Throws Error at `at` if the result needs a third derivative of a coordinate or the rate of an input.
  Ref ddt(Ref expression, const model::Span& at);
  Vec3 ddt(const Vec3& expression, const model::Span& at);
  /// d/dt at fixed coordinates and velocities.
  Ref explicit_rate(Ref expression);

 private:
  struct Value {
    bool vector = false;
    Ref scalar;
    Vec3 components{};
  };
  const Value& value(model::NodeId id);
  Value lower(const model::Node& node);
  Value lower_leaf(const model::Node& node);
  Ref inertia(std::uint32_t body, const Vec3& v);
  Ref multiplier(const model::Node& node);
  Ref rolling_reaction(const model::Node& node);
  Ref joint_force(const model::Node& node);
  Value lower_arithmetic(const model::Node& node);
  Value lower_vector(const model::Node& node);
  Value lower_derivative(const model::Node& node);
  /// In mechanics::parameter_digits digits. Parameters may share others, so that each is evaluated once.
  cln::cl_R parameter_value(std::uint32_t parameter);
  Value basis(const model::Node& node);
  model::NodeId chart_vector(std::uint32_t place, std::uint32_t coordinate);
  Vec3 contravariant(std::uint32_t place, std::uint32_t coordinate, const model::Span& span);
  static Value of(Ref scalar) { return {false, scalar, {}}; }
  static Value of(const Vec3& vector) { return {true, {}, vector}; }

  Mechanics& m_;
  Dag& dag_;
  symbolic::Derivation ddt_;
  symbolic::Derivation explicit_rate_;
  std::unordered_map<model::NodeId, Value> memo_;
  std::unordered_map<std::uint32_t, cln::cl_R> parameter_values_;
  Ref extension_, slip_;
  int depth_ = 0;
};

}  // namespace eomgen::mechanics

// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/force_law.hpp"

namespace eomgen::verify::forces {
namespace {

// By Newton and Euler: a force on B at its point, the opposite force on A at the same point, and moments.
void add_bushing(const model::Force& force, VirtualWork& w) {
  const std::uint32_t A = argument(force, "A")->index, B = argument(force, "B")->index;
  const model::NodeId rA = argument_expression(force, "rA"), rB = argument_expression(force, "rB");
  const auto number = [&](const char* key, std::size_t k) {
    return w.now.scalar(argument_expression(force, key + std::to_string(k + 1)));
  };
  const Vector d = w.now.vector(rB) - w.now.vector(rA);
  const Vector turns = w.now.angular_velocity(B) - w.now.angular_velocity(A);
  const Vector slides = w.velocity(rB) - w.velocity(rA) - cross(w.now.angular_velocity(A), d);  // relative to A
  Vector push, moment;
  std::array<Vector, 3> a, b;
  for (std::size_t k = 0; k < 3; ++k) a[k] = w.now.axis(A, k), b[k] = w.now.axis(B, k);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    push = push - (number("stiffness", i) * dot(d, a[i]) + number("coefficient", i) * dot(slides, a[i])) * a[i];
    const Jet sine = (dot(b[j], a[k]) - dot(b[k], a[j])) / 2;
    moment = moment - (number("rotational_stiffness", i) * sine / 2) * (cross(b[j], a[k]) - cross(b[k], a[j]));
    moment = moment - (number("rotational_coefficient", i) * dot(turns, a[i])) * a[i];
  }
  w.apply_force(push, w.by_q.vector(rB));
  w.apply_force(Jet(-1) * push, w.by_q.vector(rA));
  w.apply_moment(Jet(-1) * cross(d, push), A);
  w.apply_moment(moment, B);
  w.apply_moment(Jet(-1) * moment, A);
}

void bushing_potential(const model::Force& force, Potentials& U) {
  const std::uint32_t A = argument(force, "A")->index, B = argument(force, "B")->index;
  const Vector d = U.at.vector(argument_expression(force, "rB")) - U.at.vector(argument_expression(force, "rA"));
  Vector skew;  // twice sin(p) n
  for (std::size_t k = 0; k < 3; ++k) skew = skew + cross(U.at.axis(A, k), U.at.axis(B, k));
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector a = U.at.axis(A, i);
    const std::string k = std::to_string(i + 1);
    const Jet x = dot(d, a), sine = dot(skew, a) / 2;
    U.add(U.at.scalar(argument_expression(force, "stiffness" + k)) * x * x / 2);
    U.add(U.at.scalar(argument_expression(force, "rotational_stiffness" + k)) * sine * sine / 2);
  }
}

}  // namespace

ForceLaw bushing() { return {add_bushing, bushing_potential}; }

}  // namespace eomgen::verify::forces

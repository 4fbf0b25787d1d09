// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/forces/virtual_work.hpp"

#include <cln/real.h>

namespace eomgen::verify {
namespace {

Real size(const Vector& v) { return cln::abs(v[0].real()) + cln::abs(v[1].real()) + cln::abs(v[2].real()); }

}  // namespace

Vector VirtualWork::rate(const Vector& r) const { return slope(r, now.with_time_slope().level(), 0); }

// The coordinates that any of the jets depends on.
std::set<std::size_t> VirtualWork::directions(const std::vector<const Jet*>& jets) const {
  std::set<std::size_t> result;
  for (const Jet* jet : jets)
    for (const std::size_t i : jet->directions(by_q.level())) result.insert(i);
  return result;
}

void VirtualWork::apply_force(const Vector& force, const Vector& r) {
  for (const std::size_t i : directions({&r[0], &r[1], &r[2]})) {
    const Vector tangent = slope(r, by_q.level(), i);
    sums_[i].add(-dot(force, tangent).real(), size(force) * size(tangent));
  }
}

void VirtualWork::apply_moment(const Vector& moment, std::uint32_t frame) {
  if (frame == 0) return;
  std::array<Vector, 3> axes;
  std::vector<const Jet*> components;
  for (std::size_t k = 0; k < 3; ++k) axes[k] = by_q.axis(frame, k);
  for (const Vector& axis : axes)
    for (const Jet& component : axis) components.push_back(&component);
  for (const std::size_t i : directions(components)) {
    const Vector rotation = now.virtual_rotation(frame, i);
    sums_[i].add(-dot(moment, rotation).real(), size(moment) * size(rotation));
  }
}

void VirtualWork::apply_generalized_force(const Jet& force, const Jet& x) {
  for (const std::size_t i : x.directions(by_q.level())) sums_[i].add(-(force * x.slope(by_q.level(), i)).real());
}

void VirtualWork::apply_attraction(const Jet& strength, const Vector& d, const Vector& d_by_q) {
  const Jet distance = norm(d, precision);
  apply_force((-strength / (distance * distance * distance)) * d, d_by_q);
}

void VirtualWork::apply_elastic_force(const Jet& stiffness, const Jet& extension) {
  const Jet K = stiffness.value(by_q.level());
  const Jet e = extension.value(by_q.level());
  apply_generalized_force(-(K * e), extension);
  apply_generalized_force(e * e / -2, stiffness);
}

void VirtualWork::apply_elastic_force(const Jet& stiffness, const Vector& d) {
  const Jet K = stiffness.value(by_q.level());
  for (const Jet& component : d) apply_generalized_force(-(K * component.value(by_q.level())), component);
  apply_generalized_force(dot(d, d).value(by_q.level()) / -2, stiffness);
}

}  // namespace eomgen::verify

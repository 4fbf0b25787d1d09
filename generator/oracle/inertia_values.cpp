// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/inertia_values.hpp"

#include <algorithm>

#include "oracle/applied_forces.hpp"
#include "oracle/frame_values.hpp"

namespace eomgen::verify {
namespace {

Real dot(const Components& a, const Components& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Components real_parts(const Vector& v) { return {v[0].real(), v[1].real(), v[2].real()}; }

using AxisMotions = std::array<PlaceMotion, 3>;

/// e_1, e_2, e_3 like positions.
AxisMotions axis_motions(Interpreter& at, std::uint32_t frame, std::size_t coordinates) {
  Interpreter& later = at.with_time_slope();
  Interpreter& twice = later.with_time_slope();
  Interpreter& by_q = at.with_coordinate_slopes(false);
  AxisMotions motions;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vector rate = slope(twice.axis(frame, k), twice.level(), 0), e = by_q.axis(frame, k);
    motions[k] = {real_parts(at.axis(frame, k)), real_parts(rate), real_parts(slope(rate, later.level(), 0)), {}};
    for (std::size_t i = 0; i < coordinates; ++i) motions[k].tangent.push_back(real_parts(slope(e, by_q.level(), i)));
  }
  return motions;
}

/// The second moments S of an inertia tensor.
std::array<std::array<Real, 3>, 3> second_moments(const std::array<std::array<Real, 3>, 3>& I) {
  std::array<std::array<Real, 3>, 3> S;
  const Real half_trace = (I[0][0] + I[1][1] + I[2][2]) / 2;
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = 0; l < 3; ++l) S[k][l] = k == l ? Real(half_trace - I[k][k]) : Real(-I[k][l]);
  return S;
}

const model::Body* body_at(const model::Model& model, std::uint32_t place) {
  const auto found = std::find_if(model.bodies.begin(), model.bodies.end(),
                                  [place](const model::Body& body) { return body.place == place; });
  return found == model.bodies.end() ? nullptr : &*found;
}

Components gravity_of(const model::Model& model, Interpreter& at) {
  Components sum;
  for (const model::Force& force : model.forces) {
    if (force.acceleration() == model::no_node) continue;
    const Components g = real_parts(at.vector(force.acceleration()));
    for (std::size_t c = 0; c < 3; ++c) sum[c] = sum[c] + g[c];
  }
  return sum;
}

/// Sizes of accelerations, whose terms may cancel: of a body that turns about its own place.
Real acceleration_scale(const PlaceMotion& motion, const Real& turning) {
  return largest_of(motion.acceleration) +
         (largest_of(motion.position) * turning + largest_of(motion.velocity)) * turning;
}

}  // namespace

std::vector<InertialWork> inertial_works(const Oracle& oracle, const State& state) {
  const model::Model& model = oracle.model();
  Interpreter at = oracle.interpreter(state);
  const std::size_t n = state.q.size();
  const Components gravity = gravity_of(model, at);
  std::vector<InertialWork> result;
  for (const Mass& mass : list_masses(model)) {
    const PlaceMotion place = place_motion(at, mass.place, n);
    Components a;
    for (std::size_t c = 0; c < 3; ++c) a[c] = place.acceleration[c] - gravity[c];
    const model::Body* body = body_at(model, mass.place);
    const Real of_mass = at.scalar(mass.mass).real();
    const auto add = [&](const Real& parameter, const auto& work, const auto& scale) {
      InertialWork one{parameter, {}, {}};
      for (std::size_t i = 0; i < n; ++i) one.work.push_back(work(i)), one.scale.push_back(scale(i));
      result.push_back(std::move(one));
    };
    const auto size = [&place](std::size_t i) { return largest_of(place.tangent[i]); };
    AxisMotions e;
    Real turning = 0, angular = 0;
    if (body != nullptr) {
      e = axis_motions(at, body->frame, n);
      for (const PlaceMotion& axis : e) {
        turning = cln::max(turning, largest_of(axis.velocity));
        angular = cln::max(angular, largest_of(axis.acceleration));
      }
      angular = angular + turning * turning;
      const auto turned = [&e](std::size_t i) {
        Real most = 0;
        for (const PlaceMotion& axis : e) most = cln::max(most, largest_of(axis.tangent[i]));
        return most;
      };
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t l = k; l < 3; ++l) {
          std::array<std::array<Real, 3>, 3> unit{};
          unit[k][l] = unit[l][k] = 1;
          const auto S = second_moments(unit);
          add(
              at.scalar(body->inertia[k][l]).real(),
              [&](std::size_t i) {
                Real sum = 0;
                for (std::size_t r = 0; r < 3; ++r)
                  for (std::size_t s = 0; s < 3; ++s)
                    if (!cln::zerop(S[r][s])) sum = sum + S[r][s] * dot(e[r].tangent[i], e[s].acceleration);
                return sum;
              },
              [&](std::size_t i) { return Real(turned(i) * angular); });
        }
      }
      const Real most = acceleration_scale(place, turning) + largest_of(gravity);
      for (std::size_t k = 0; k < 3; ++k) {
        add(
            Real(0),
            [&](std::size_t i) { return Real(dot(place.tangent[i], e[k].acceleration) + dot(e[k].tangent[i], a)); },
            [&](std::size_t i) { return Real(size(i) * angular + turned(i) * most); });
      }
    }
    const Real most = acceleration_scale(place, turning) + largest_of(gravity);
    add(
        of_mass, [&](std::size_t i) { return dot(place.tangent[i], a); },
        [&](std::size_t i) { return Real(size(i) * most); });
  }
  return result;
}

Momentum momentum(const Oracle& oracle, const State& state) {
  const model::Model& model = oracle.model();
  Interpreter at = oracle.interpreter(state);
  const std::size_t n = state.q.size();
  struct Moving {
    Real mass;
    PlaceMotion place;
    const model::Body* body;
  };
  std::vector<Moving> all;
  Momentum result;
  Real total = 0;
  for (const Mass& mass : list_masses(model)) {
    all.push_back({at.scalar(mass.mass).real(), place_motion(at, mass.place, n), body_at(model, mass.place)});
    const Moving& one = all.back();
    total = total + one.mass;
    result.length = cln::max(result.length, largest_of(one.place.position));
    for (std::size_t c = 0; c < 3; ++c) result.centre[c] = result.centre[c] + one.mass * one.place.position[c];
  }
  result.tangents.resize(n);
  result.scale.resize(n);
  if (all.empty()) return result;
  for (Real& component : result.centre) component = component / total;
  const auto add = [&](std::array<Real, 6>& sum, std::array<Real, 6>& scale, const Components& angular,
                       const Components& linear, const Real& angular_size) {
    for (std::size_t c = 0; c < 3; ++c) {
      sum[c] = sum[c] + angular[c];
      sum[3 + c] = sum[3 + c] + linear[c];
      scale[c] = scale[c] + cln::abs(angular[c]) + angular_size;
      scale[3 + c] = scale[3 + c] + largest_of(linear);  // a component of a turned axis may be 0 but for rounding
    }
  };
  for (const Moving& one : all) {
    Components arm;
    for (std::size_t c = 0; c < 3; ++c) arm[c] = one.place.position[c] - result.centre[c];
    const auto of_place = [&](const Components& v, std::array<Real, 6>& sum, std::array<Real, 6>& scale) {
      Components p;
      for (std::size_t c = 0; c < 3; ++c) p[c] = one.mass * v[c];
      add(sum, scale, cross_product(arm, p), p, largest_of(p) * result.length);
    };
    of_place(one.place.velocity, result.whole, result.whole_scale);
    for (std::size_t i = 0; i < n; ++i) of_place(one.place.tangent[i], result.tangents[i], result.scale[i]);
    if (one.body == nullptr) continue;
    std::array<std::array<Real, 3>, 3> inertia;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; l < 3; ++l) inertia[k][l] = at.scalar(one.body->inertia[k][l]).real();
    const auto S = second_moments(inertia);
    const AxisMotions e = axis_motions(at, one.body->frame, n);
    // sum S_kl e_k x e'_l
    const auto of_axes = [&](const std::array<Components, 3>& rates, std::array<Real, 6>& sum,
                             std::array<Real, 6>& scale) {
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t l = 0; l < 3; ++l) {
          if (cln::zerop(S[k][l])) continue;
          Components angular = cross_product(e[k].position, rates[l]);
          for (Real& component : angular) component = S[k][l] * component;
          add(sum, scale, angular, Components{}, largest_of(angular));
        }
      }
    };
    of_axes({e[0].velocity, e[1].velocity, e[2].velocity}, result.whole, result.whole_scale);
    for (std::size_t i = 0; i < n; ++i)
      of_axes({e[0].tangent[i], e[1].tangent[i], e[2].tangent[i]}, result.tangents[i], result.scale[i]);
  }
  return result;
}

}  // namespace eomgen::verify

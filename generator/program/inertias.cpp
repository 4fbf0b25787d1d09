// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/inertias.hpp"

#include "symbolic/vectors.hpp"

namespace eomgen::program {

InertiaFunctions::InertiaFunctions(Dag& dag, std::vector<system::Frame> frames, system::Inertias inertias,
                                   const std::vector<std::uint32_t>& free,
                                   const std::map<std::uint32_t, symbolic::Rational>& fix)
    : dag_(dag), frames_(std::move(frames)), inertias_(std::move(inertias)), free_(free) {
  if (fix.empty()) return;
  std::map<symbolic::Symbol, Ref> values;
  for (const auto& [index, value] : fix) values[{SymbolKind::parameter, index, 0}] = dag_.constant(value);
  symbolic::Substitution fixed(dag_, std::move(values));
  const auto all = [&fixed](auto& list) {
    for (Ref& r : list) r = fixed(r);
  };
  for (system::Frame& frame : frames_) all(frame.position), all(frame.rotation), all(frame.velocity), all(frame.bias);
  for (system::Inertia& one : inertias_.of) {
    one.mass = fixed(one.mass);
    if (one.body) all(one.body->tensor), all(one.body->spin), all(one.body->bias);
  }
  if (!inertias_.of.empty()) all(inertias_.gravity);
}

/// The derivative by the rate of a free coordinate.
InertiaFunctions::Vec3 InertiaFunctions::slope(const Vec3& of, std::size_t coordinate) const {
  symbolic::Derivation d = symbolic::partial_derivative(dag_, {SymbolKind::coordinate, free_[coordinate], 1});
  return {d(of[0]), d(of[1]), d(of[2])};
}

InertiaFunctions::Vec3 InertiaFunctions::linear(const system::Inertia& of, std::size_t coordinate) const {
  const auto& v = frames_[of.frame].velocity;
  return slope({v[0], v[1], v[2]}, coordinate);
}

InertiaFunctions::Vec3 InertiaFunctions::along_axes(const system::Frame& frame, const Vec3& v) const {
  Vec3 result;
  for (std::size_t k = 0; k < 3; ++k)
    result[k] = symbolic::dot(dag_, v, {frame.rotation[3 * k], frame.rotation[3 * k + 1], frame.rotation[3 * k + 2]});
  return result;
}

InertiaFunctions::Vec3 InertiaFunctions::along_fixed(const system::Frame& frame, const Vec3& v) const {
  Vec3 result;
  for (std::size_t c = 0; c < 3; ++c)
    result[c] = symbolic::dot(dag_, v, {frame.rotation[c], frame.rotation[3 + c], frame.rotation[6 + c]});
  return result;
}

InertiaFunctions::Vec3 InertiaFunctions::times(const system::BodyInertia& body, const Vec3& v) const {
  const auto& J = body.tensor;
  return {symbolic::dot(dag_, {J[0], J[1], J[2]}, v), symbolic::dot(dag_, {J[1], J[3], J[4]}, v),
          symbolic::dot(dag_, {J[2], J[4], J[5]}, v)};
}

FunctionExpressions InertiaFunctions::regressor() const {
  FunctionExpressions function = empty_function("regressor");
  std::vector<Ref>&Y = function.results[0].entries, &values = function.results[1].entries;
  const std::size_t n = free_.size();
  std::vector<Ref> v;
  for (std::uint32_t i = 0; i < n; ++i) v.push_back(dag_.symbol({SymbolKind::vector, i, 0}));
  const auto sum = [&](Ref a, Ref b) { return dag_.add(a, b); };
  for (const system::Inertia& one : inertias_.of) {
    const system::Frame& frame = frames_[one.frame];
    std::vector<Vec3> by_place, by_axes;
    Vec3 a = symbolic::subtract(dag_, {frame.bias[0], frame.bias[1], frame.bias[2]}, inertias_.gravity);
    for (std::size_t i = 0; i < n; ++i) {
      by_place.push_back(linear(one, i));
      a = symbolic::add(dag_, a, symbolic::scale(dag_, v[i], by_place.back()));
    }
    if (!one.body) {
      for (const Vec3& j : by_place) Y.push_back(symbolic::dot(dag_, j, a));
      values.push_back(one.mass);
      continue;
    }
    // Components along the axes of the body from here on.
    const Vec3& w = one.body->spin;
    Vec3 alpha = one.body->bias;
    a = along_axes(frame, a);
    for (std::size_t i = 0; i < n; ++i) {
      by_place[i] = along_axes(frame, by_place[i]);
      by_axes.push_back(slope(w, i));
      alpha = symbolic::add(dag_, alpha, symbolic::scale(dag_, v[i], by_axes.back()));
    }
    const auto product = [&](Ref x, Ref y) { return dag_.mul(x, y); };
    // I = e_i e_k + e_k e_i for i != k, e_i e_i otherwise: the work of I alpha + w x I w.
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = i; k < 3; ++k) {
        for (const Vec3& j : by_axes) {
          const Vec3 turned = symbolic::cross(dag_, j, w);
          Ref work = sum(product(j[i], alpha[k]), product(turned[i], w[k]));
          if (i != k) work = sum(work, sum(product(j[k], alpha[i]), product(turned[k], w[i])));
          Y.push_back(work);
        }
      }
    }
    const Ref square = symbolic::dot(dag_, w, w);
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3 unit = symbolic::zero_vector(dag_);
      unit[k] = dag_.one();
      Vec3 force = symbolic::add(dag_, symbolic::cross(dag_, alpha, unit), symbolic::scale(dag_, w[k], w));
      force[k] = dag_.sub(force[k], square);
      for (std::size_t i = 0; i < n; ++i)
        Y.push_back(sum(symbolic::dot(dag_, by_place[i], force), symbolic::cross(dag_, a, by_axes[i])[k]));
    }
    for (const Vec3& j : by_place) Y.push_back(symbolic::dot(dag_, j, a));
    values.insert(values.end(), one.body->tensor.begin(), one.body->tensor.end());
    values.insert(values.end(), 3, dag_.zero());  // bodies have their place at the centre of mass
    values.push_back(one.mass);
  }
  return function;
}

FunctionExpressions InertiaFunctions::momentum() const {
  FunctionExpressions function = empty_function("momentum");
  if (inertias_.of.empty()) return function;
  Ref mass = dag_.zero();
  Vec3 centre = symbolic::zero_vector(dag_);
  for (const system::Inertia& one : inertias_.of) {
    mass = dag_.add(mass, one.mass);
    centre = symbolic::add(dag_, centre, symbolic::scale(dag_, one.mass, frames_[one.frame].position));
  }
  for (Ref& component : centre) component = dag_.div(component, mass);
  /// Angular, then linear momentum of velocities that are functions of an Inertia.
  const auto momentum_of = [&](const auto& velocity, const auto& spin) {
    Vec3 angular = symbolic::zero_vector(dag_), linear = angular;
    for (const system::Inertia& one : inertias_.of) {
      const system::Frame& frame = frames_[one.frame];
      const Vec3 p = symbolic::scale(dag_, one.mass, velocity(one)),
                 arm = symbolic::subtract(dag_, frame.position, centre);
      linear = symbolic::add(dag_, linear, p);
      angular = symbolic::add(dag_, angular, symbolic::cross(dag_, arm, p));
      if (one.body) angular = symbolic::add(dag_, angular, along_fixed(frame, times(*one.body, spin(*one.body))));
    }
    return std::array<Ref, 6>{angular[0], angular[1], angular[2], linear[0], linear[1], linear[2]};
  };
  std::map<symbolic::Symbol, Ref> none;
  for (const std::uint32_t i : free_) none[{SymbolKind::coordinate, i, 1}] = dag_.zero();
  symbolic::Substitution at_rest(dag_, std::move(none));
  const auto prescribed = [&](const Vec3& v) { return Vec3{at_rest(v[0]), at_rest(v[1]), at_rest(v[2])}; };
  std::array<Ref, 6> whole = momentum_of(
      [&](const system::Inertia& one) {
        const auto& v = frames_[one.frame].velocity;
        return prescribed({v[0], v[1], v[2]});
      },
      [&](const system::BodyInertia& body) { return prescribed(body.spin); });
  for (std::size_t i = 0; i < free_.size(); ++i) {
    const std::array<Ref, 6> column = momentum_of([&](const system::Inertia& one) { return linear(one, i); },
                                                  [&](const system::BodyInertia& body) { return slope(body.spin, i); });
    const Ref rate = dag_.symbol({SymbolKind::coordinate, free_[i], 1});
    for (std::size_t c = 0; c < 6; ++c) whole[c] = dag_.add(whole[c], dag_.mul(column[c], rate));
    function.results[0].entries.insert(function.results[0].entries.end(), column.begin(), column.end());
  }
  function.results[1].entries.assign(whole.begin(), whole.end());
  function.results[2].entries.assign(centre.begin(), centre.end());
  return function;
}

}  // namespace eomgen::program

// SPDX-License-Identifier: GPL-3.0-or-later
#include "derive/trees/body_motion.hpp"

namespace eomgen::derive {
namespace {

/// Euler angles: three steps about one axis each, with the rates of the three coordinates alone. The axis of the middle
/// step differs from the others.
struct EulerAngles {
  std::array<std::size_t, 3> axis;
  std::size_t third;  // neither of the first nor of the middle step
  std::array<std::size_t, 3> freedom;
  Ref c, s;  // image of the first axis under the middle step: c along it, s along the third
  bool symmetric() const { return axis[2] == axis[0]; }
  Ref divisor() const { return symmetric() ? s : c; }
};

std::optional<EulerAngles> euler_angles(Dag& dag, const BodyLink& link) {
  const std::vector<RotationStep>& steps = link.rotation.steps;
  if (steps.size() != 3 || link.angles.size() != 3) return std::nullopt;
  EulerAngles angles;
  for (std::size_t k = 0; k < 3; ++k) {
    angles.axis[k] = axis_of(dag, steps[k].R);
    if (angles.axis[k] == 3 || !is_zero(dag, steps[k].w_bias)) return std::nullopt;
    const Ref rate = steps[k].w[angles.axis[k]];
    if (dag[rate].op != symbolic::Op::symbol) return std::nullopt;
  }
  if (angles.axis[0] == angles.axis[1] || angles.axis[1] == angles.axis[2]) return std::nullopt;
  // Each rate is that of one coordinate, identified by the direction of its freedom.
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3 s = symbolic::zero_vector(dag);
    s[angles.axis[k]] = dag.one();
    for (std::size_t later = k + 1; later < 3; ++later) s = times(dag, steps[later].R, s);
    std::size_t which = 3;
    for (std::size_t f = 0; f < 3; ++f) which = link.angles[f].angular == s ? f : which;
    if (which == 3) return std::nullopt;
    angles.freedom[k] = which;
  }
  angles.third = 3 - angles.axis[0] - angles.axis[1];
  angles.c = steps[1].R[angles.axis[0]][angles.axis[0]];
  angles.s = steps[1].R[angles.third][angles.axis[0]];
  return angles;
}

Ref volume(Dag& dag, const BodyLink& link) {
  return dot(dag, link.angles[0].angular, cross(dag, link.angles[1].angular, link.angles[2].angular));
}

/// The vector normal to the rotation axes of the other two coordinates.
Vec3 normal(Dag& dag, const BodyLink& link, std::size_t f) {
  return cross(dag, link.angles[(f + 1) % 3].angular, link.angles[(f + 2) % 3].angular);
}

/// Solves for the rates of Euler angles one after another, from the last step back to the first.
std::array<Ref, 3> angle_rates(Dag& dag, const BodyLink& link, const EulerAngles& angles, Vec3 parent, Vec3 w,
                               Vec3 own) {
  const std::vector<RotationStep>& steps = link.rotation.steps;
  // Along the axes before the last step: the difference of the own acceleration and the parent's part.
  for (std::size_t k = 0; k < 2; ++k) {
    w = times(dag, steps[k].R, w);
    parent = symbolic::add(dag, times(dag, steps[k].R, parent), cross(dag, w, steps[k].w));
    w = symbolic::add(dag, w, steps[k].w);
  }
  own = symbolic::subtract(dag, own, cross(dag, times(dag, steps[2].R, w), steps[2].w));
  Vec3 across = own;  // without the rotation about the last axis
  across[angles.axis[2]] = dag.zero();
  const Vec3 left = symbolic::subtract(dag, times(dag, transposed(steps[2].R), across), parent);
  const Ref first = dag.div(left[angles.symmetric() ? angles.third : angles.axis[0]], angles.divisor());
  const Ref along = dag.mul(first, angles.symmetric() ? angles.c : angles.s);  // of the first, about the last axis
  const std::size_t last = angles.axis[2];
  std::array<Ref, 3> result;
  result[angles.freedom[0]] = first;
  result[angles.freedom[1]] = left[angles.axis[1]];
  result[angles.freedom[2]] = dag.sub(dag.sub(own[last], parent[last]), along);
  return result;
}

/// Twice the dual basis along the link's axes: e_dot = dual . w for parameters of unit length.
std::array<Vec3, 4> twice_dual(Dag& dag, const BodyLink& link) {
  const Vec3 e{link.parameters[1], link.parameters[2], link.parameters[3]};
  std::array<Vec3, 4> result;
  result[0] = symbolic::scale(dag, dag.integer(-1), e);
  const Mat3 X = cross_matrix(dag, e);
  for (std::size_t k = 0; k < 3; ++k) {
    result[k + 1] = X[k];
    result[k + 1][k] = link.parameters[0];
  }
  return result;
}

/// e_ddot = dual . alpha - |e_dot|^2 e, which preserves the length.
void parameter_rates(Dag& dag, const BodyLink& link, const Vec3& alpha, std::vector<Ref>& result) {
  const std::array<Vec3, 4> dual = twice_dual(dag, link);
  const Vec3 half = symbolic::scale(dag, dag.constant(symbolic::Rational(1) / 2), alpha);
  Ref squares = dag.zero();
  for (std::size_t f = 4; f < 8; ++f) squares = dag.add(squares, dag.mul(link.parameters[f], link.parameters[f]));
  for (std::size_t f = 0; f < 4; ++f) {
    result[link.angles[f].index] = dag.sub(dot(dag, dual[f], half), dag.mul(squares, link.parameters[f]));
  }
}

/// J alpha + w x J w of a symmetric J.
Vec3 bias_moment(Dag& dag, const Mat3& J, const LinkMotion& motion, const BiasAcceleration& bias) {
  Vec3 result;
  const Vec3& w = motion.w;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const auto term = [&](Ref inertia, Ref rates) { result[i] = dag.add(result[i], dag.mul(inertia, rates)); };
    result[i] = dag.add(dag.mul(J[i][i], bias.alpha[i]), dag.mul(dag.sub(J[k][k], J[j][j]), dag.mul(w[j], w[k])));
    term(J[j][k], dag.sub(dag.mul(w[j], w[j]), dag.mul(w[k], w[k])));
    term(J[i][k], bias.U[j][i]);
    term(dag.neg(J[i][j]), bias.U[k][i]);
  }
  return result;
}

}  // namespace

std::size_t unit_axis(const Dag& dag, const Vec3& v) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (dag.is_one(v[k]) && dag.is_zero(v[(k + 1) % 3]) && dag.is_zero(v[(k + 2) % 3])) return k;
  }
  return 3;
}

std::vector<LinkMotion> link_motions(Dag& dag, const BodyTree& tree) {
  const Vec3 none = symbolic::zero_vector(dag);
  std::vector<LinkMotion> result;
  for (const BodyLink& link : tree.links) {
    LinkMotion motion{none, none, zero_matrix(dag), none};
    const LinkMotion parent = link.parent < 0 ? motion : result[static_cast<std::size_t>(link.parent)];
    if (link.relative) {
      motion.w = parent.w;
      for (const RotationStep& step : link.rotation.steps) {
        motion.w = times(dag, step.R, motion.w);
        motion.bias = symbolic::add(dag, times(dag, step.R, motion.bias),
                                    symbolic::add(dag, cross(dag, motion.w, step.w), step.w_bias));
        motion.w = symbolic::add(dag, motion.w, step.w);
      }
    }
    std::array<std::array<Ref, 3>, 3> ww;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) ww[i][k] = dag.mul(motion.w[i], motion.w[k]);
    }
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) motion.W[i][k] = ww[i][k];
      motion.W[i][i] = dag.neg(dag.add(ww[(i + 1) % 3][(i + 1) % 3], ww[(i + 2) % 3][(i + 2) % 3]));
    }
    const Vec3 twice = symbolic::scale(dag, dag.integer(2), cross(dag, parent.w, link.offset_rate));
    motion.slide_bias = symbolic::add(dag, twice, link.offset_bias);
    result.push_back(motion);
  }
  return result;
}

std::vector<BiasAcceleration> bias_accelerations(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
                                                 GivenAccelerations given) {
  const Vec3 none = symbolic::zero_vector(dag);
  std::vector<BiasAcceleration> result;
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const BodyLink& link = tree.links[l];
    BiasAcceleration bias{none, symbolic::scale(dag, dag.integer(-1), tree.gravity), motion[l].W, dag.zero()};
    if (link.parent >= 0) {
      const BiasAcceleration& parent = result[static_cast<std::size_t>(link.parent)];
      bias.a = symbolic::add(dag, parent.a, times(dag, parent.U, link.offset));
      if (link.is_carried_by_parent()) bias.alpha = link.rotation.to_own_axes(dag, parent.alpha);
    }
    bias.a = link.rotation.to_own_axes(dag, symbolic::add(dag, bias.a, motion[l].slide_bias));
    if (link.free) bias.a = none;
    if (link.is_carried_by_parent()) bias.alpha = symbolic::add(dag, bias.alpha, motion[l].bias);
    if (given == GivenAccelerations::without_own && link.freedoms.size() == 1) {
      const Freedom& freedom = link.freedoms[0];
      const bool turns = is_zero(dag, freedom.linear), slides = is_zero(dag, freedom.angular);
      const std::size_t k = unit_axis(dag, turns ? freedom.angular : freedom.linear);
      if (k < 3 && turns != slides) {
        Ref& own = turns ? bias.alpha[k] : bias.a[k];
        bias.joint = dag.neg(own);
        own = dag.zero();
      }
    }
    bias.U = add(dag, bias.U, cross_matrix(dag, bias.alpha));
    result.push_back(bias);
  }
  return result;
}

std::pair<Vec3, Vec3> needed_forces(Dag& dag, const BodyLink& link, const LinkMotion& motion,
                                    const BiasAcceleration& bias) {
  const Vec3 moment = bias_moment(dag, link.inertia, motion, bias);
  return {symbolic::add(dag, moment, cross(dag, link.moment, bias.a)),
          symbolic::add(dag, symbolic::scale(dag, link.mass, bias.a), times(dag, bias.U, link.moment))};
}

Vec3 force_on_origin(Dag& dag, const BodyLink& link, const std::vector<Ref>& Q) {
  return link.rotation.to_own_axes(dag,
                                   {Q[link.freedoms[3].index], Q[link.freedoms[4].index], Q[link.freedoms[5].index]});
}

Vec3 joint_moment(Dag& dag, const BodyLink& link, const std::vector<Ref>& Q) {
  Vec3 moment = symbolic::zero_vector(dag);
  std::vector<Ref> own;
  bool idle = true;
  for (const Freedom& f : link.angles) {
    own.push_back(Q[f.index]);
    idle = idle && dag.is_zero(own.back());
  }
  if (idle) return moment;
  if (!link.parameters.empty()) {
    const std::array<Vec3, 4> dual = twice_dual(dag, link);
    for (std::size_t f = 0; f < 4; ++f) moment = symbolic::add(dag, moment, symbolic::scale(dag, own[f], dual[f]));
    return symbolic::scale(dag, dag.constant(symbolic::Rational(1) / 2), moment);
  }
  if (const std::optional<EulerAngles> angles = euler_angles(dag, link)) {
    const Ref first = own[angles->freedom[0]], last = own[angles->freedom[2]];
    moment[angles->axis[1]] = own[angles->freedom[1]];
    moment[angles->axis[2]] = last;
    const Ref rest =
        dag.div(dag.sub(first, dag.mul(angles->symmetric() ? angles->c : angles->s, last)), angles->divisor());
    moment[angles->symmetric() ? angles->third : angles->axis[0]] = rest;
    return times(dag, link.rotation.steps[2].R, moment);
  }
  for (std::size_t f = 0; f < 3; ++f) {
    moment = symbolic::add(dag, moment, symbolic::scale(dag, dag.div(own[f], volume(dag, link)), normal(dag, link, f)));
  }
  return moment;
}

std::vector<Ref> coordinate_accelerations(Dag& dag, const BodyTree& tree, const std::vector<LinkMotion>& motion,
                                          const std::vector<Ref>& u, std::vector<symbolic::Pivot>& pivots) {
  const Vec3 none = symbolic::zero_vector(dag);
  std::vector<Vec3> alpha;
  std::vector<Ref> result = u;
  for (std::size_t l = 0; l < tree.links.size(); ++l) {
    const BodyLink& link = tree.links[l];
    const bool ground = link.parent < 0;
    const Vec3 parent = ground ? none : alpha[static_cast<std::size_t>(link.parent)];
    if (!link.absolute) {
      Vec3 sum = link.relative ? symbolic::add(dag, link.rotation.to_own_axes(dag, parent), motion[l].bias) : none;
      for (const Freedom& f : link.freedoms) sum = symbolic::add(dag, sum, symbolic::scale(dag, u[f.index], f.angular));
      alpha.push_back(sum);
      continue;
    }
    if (link.free) {
      const Vec3 own{u[link.freedoms[3].index], u[link.freedoms[4].index], u[link.freedoms[5].index]};
      const Vec3 a = symbolic::add(dag, link.rotation.to_parent(dag, own), tree.gravity);
      for (std::size_t k = 0; k < 3; ++k) result[link.freedoms[3 + k].index] = a[k];
    }
    alpha.push_back({u[link.freedoms[0].index], u[link.freedoms[1].index], u[link.freedoms[2].index]});
    if (const std::optional<EulerAngles> angles = euler_angles(dag, link)) {
      const Vec3 w = ground ? none : motion[static_cast<std::size_t>(link.parent)].w;
      const std::array<Ref, 3> rates = angle_rates(dag, link, *angles, parent, w, alpha.back());
      for (std::size_t f = 0; f < 3; ++f) result[link.angles[f].index] = rates[f];
      pivots.push_back({angles->divisor(), dag.one()});
      continue;
    }
    const Vec3 left = symbolic::subtract(dag, alpha.back(),
                                         symbolic::add(dag, link.rotation.to_own_axes(dag, parent), motion[l].bias));
    if (!link.parameters.empty()) {
      parameter_rates(dag, link, left, result);
      continue;
    }
    for (std::size_t f = 0; f < 3; ++f)
      result[link.angles[f].index] = dag.div(dot(dag, normal(dag, link, f), left), volume(dag, link));
    pivots.push_back({volume(dag, link), dag.zero()});
  }
  return result;
}

}  // namespace eomgen::derive

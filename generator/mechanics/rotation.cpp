// SPDX-License-Identifier: GPL-3.0-or-later
// Rotating axes and bodies: angular velocities from the rates of angles and parameters, stage by stage.
#include "mechanics/stages.hpp"

namespace eomgen::mechanics {

Vec3 Lowering::axis(std::uint32_t frame, std::size_t stage, std::size_t k) {
  if (frame > 0) return vector(m_.model->frames[frame].stages[stage].e[k]);
  Vec3 e{dag_.zero(), dag_.zero(), dag_.zero()};
  e[k] = dag_.one();
  return e;
}

std::array<Ref, 3> Lowering::own_rates(std::uint32_t frame) {
  if (frame == 0) return {dag_.zero(), dag_.zero(), dag_.zero()};
  return rates(frame, m_.model->frames[frame].stages.size() - 1);
}

std::array<Ref, 3> Lowering::rates_before(std::uint32_t frame, std::size_t stage) {
  return stage == 0 ? own_rates(m_.model->frames[frame].parent) : rates(frame, stage - 1);
}

// w_k = sum_j R_kj v_j + the stage's own: recursion over the tree of frames, without differentiation.
std::array<Ref, 3> Lowering::rates(std::uint32_t frame, std::size_t stage) {
  const model::RotationStage& step = m_.model->frames[frame].stages[stage];
  const std::array<Ref, 3> before = rates_before(frame, stage);
  std::array<Ref, 3> result;
  for (std::size_t k = 0; k < 3; ++k) {
    result[k] = scalar(step.w[k]);
    for (std::size_t j = 0; j < 3; ++j) result[k] = dag_.add(result[k], dag_.mul(scalar(step.R[k][j]), before[j]));
  }
  return result;
}

Vec3 Lowering::angular_velocity(std::uint32_t frame) {
  if (frame == 0) return {dag_.zero(), dag_.zero(), dag_.zero()};
  const model::Frame& turning = m_.model->frames[frame];
  Vec3 sum = angular_velocity(turning.parent);
  for (std::size_t s = 0; s < turning.stages.size(); ++s) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (turning.stages[s].w[k] != model::no_node)
        sum = add(sum, scale(scalar(turning.stages[s].w[k]), axis(frame, s, k)));
    }
  }
  return sum;
}

namespace {

/// The rotation axis of the last stage, if it is one of the axes and J is symmetric about it.
std::optional<std::size_t> axis_of_symmetry(const Dag& dag, const model::RotationStage& last,
                                            const std::array<std::array<Ref, 3>, 3>& J) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const bool about = last.R[i][j] == model::no_node && last.R[i][k] == model::no_node &&
                       last.w[j] == model::no_node && last.w[k] == model::no_node;
    const bool diagonal = dag.is_zero(J[0][1]) && dag.is_zero(J[0][2]) && dag.is_zero(J[1][2]);
    if (about && diagonal && J[j][j] == J[k][k]) return i;
  }
  return std::nullopt;
}

}  // namespace

// T = (m/2) v.v + w.Jw/2, eq. (6.65).
void add_bodies(Mechanics& m, Lowering& lower) {
  Dag& dag = *m.dag;
  for (std::uint32_t f = 0; f < m.model->frames.size(); ++f) m.angular_velocity.push_back(lower.own_rates(f));
  for (const model::Body& body : m.model->bodies) {
    BodyRotation spin;
    spin.frame = body.frame;
    spin.name = m.model->frames[body.frame].name;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) spin.J[i][k] = lower.scalar(body.inertia[i][k]);
    }
    const model::Frame& frame = m.model->frames[body.frame];
    const std::size_t last = frame.stages.size() - 1;
    if (const auto axis = axis_of_symmetry(dag, frame.stages[last], spin.J)) {
      spin.axes_angular_velocity = spin.w = lower.rates_before(body.frame, last);
      spin.w[*axis] = dag.add(spin.w[*axis], lower.scalar(frame.stages[last].w[*axis]));
      for (std::size_t k = 0; k < 3; ++k) {
        spin.axes[k] = last > 0 ? lower.axis(body.frame, last - 1, k)
                                : lower.axis(frame.parent,
                                             frame.parent > 0 ? m.model->frames[frame.parent].stages.size() - 1 : 0, k);
      }
    } else {
      spin.w = spin.axes_angular_velocity = m.angular_velocity[body.frame];
      for (std::size_t k = 0; k < 3; ++k) spin.axes[k] = lower.axis(body.frame, last, k);
    }
    Ref twice = dag.zero();
    const Vec3 H = angular_momentum(dag, spin);
    for (std::size_t k = 0; k < 3; ++k) twice = dag.add(twice, dag.mul(spin.w[k], H[k]));
    m.kinetic = dag.add(m.kinetic, dag.div(twice, dag.integer(2)));
    m.body_rotations.push_back(std::move(spin));
  }
}

std::array<Ref, 3> inertia_times(Dag& dag, const BodyRotation& spin, const std::array<Ref, 3>& v) {
  std::array<Ref, 3> result{dag.zero(), dag.zero(), dag.zero()};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) result[i] = dag.add(result[i], dag.mul(spin.J[i][k], v[k]));
  }
  return result;
}

std::array<Ref, 3> angular_momentum(Dag& dag, const BodyRotation& spin) { return inertia_times(dag, spin, spin.w); }

}  // namespace eomgen::mechanics

// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/abi_differences.hpp"

#include <algorithm>
#include <map>

#include "oracle/applied_forces.hpp"
#include "oracle/frame_values.hpp"
#include "oracle/inertia_values.hpp"

namespace eomgen::verify {
namespace {

/// `v`: accelerations of the free coordinates. `state` has those of the others.
double regressor_difference(const AbiResults& values, const AbiResults& sizes, const std::vector<std::uint32_t>& free,
                            const Oracle& oracle, State state, const std::vector<Real>& v) {
  for (std::size_t i = 0; i < free.size(); ++i) state.qddot[free[i]] = v[i];
  double largest = 0;
  std::size_t column = 0;
  for (const InertialWork& expected : inertial_works(oracle, state)) {
    largest = std::max(largest, relative_difference(values[1].at(column) - expected.parameter,
                                                    sizes[1].at(column) + cln::abs(expected.parameter)));
    for (std::size_t i = 0; i < free.size(); ++i) {
      const std::size_t at = i + free.size() * column;
      largest = std::max(largest, relative_difference(values[0].at(at) - expected.work[free[i]],
                                                      sizes[0].at(at) + expected.scale[free[i]]));
    }
    ++column;
  }
  return largest;
}

double momentum_difference(const AbiResults& values, const AbiResults& sizes, const std::vector<std::uint32_t>& free,
                           const Oracle& oracle, const State& state) {
  if (values[2].empty()) return 0;
  const Momentum expected = momentum(oracle, state);
  double largest = 0;
  for (std::size_t c = 0; c < 3; ++c)
    largest =
        std::max(largest, relative_difference(values[2].at(c) - expected.centre[c], sizes[2].at(c) + expected.length));
  for (std::size_t c = 0; c < 6; ++c) {
    largest = std::max(
        largest, relative_difference(values[1].at(c) - expected.whole[c], sizes[1].at(c) + expected.whole_scale[c]));
    for (std::size_t i = 0; i < free.size(); ++i)
      largest = std::max(largest, relative_difference(values[0].at(c + 6 * i) - expected.tangents[free[i]][c],
                                                      sizes[0].at(c + 6 * i) + expected.scale[free[i]][c]));
  }
  return largest;
}

}  // namespace

std::optional<double> inertia_difference(const std::string& function, const AbiResults& values, const AbiResults& sizes,
                                         const std::vector<std::uint32_t>& free, const Oracle& oracle,
                                         const State& state, const std::vector<Real>& v) {
  if (function == "regressor") return regressor_difference(values, sizes, free, oracle, state, v);
  if (function == "momentum") return momentum_difference(values, sizes, free, oracle, state);
  return std::nullopt;
}

double energy_difference(const AbiResults& values, const AbiResults& sizes, const EnergyValues& expected) {
  return std::max(relative_difference(values[0].at(0) - expected.kinetic, sizes[0].at(0) + expected.scale),
                  relative_difference(values[0].at(1) - expected.potential, sizes[0].at(1) + expected.scale));
}

double gradient_difference(const AbiResults& values, const AbiResults& sizes, const std::vector<Real>& direction,
                           const CentralDifference& slope, const Real& lost) {
  double largest = 0;
  for (std::size_t energy = 0; energy < 2; ++energy) {
    const std::vector<Real>&gradient = values[1 + energy], &size_of = sizes[1 + energy];
    Real sum = 0, size = sizes[0].at(energy) * lost + slope.errors[0].at(energy);
    for (std::size_t j = 0; j < gradient.size(); ++j) {
      sum = sum + gradient[j] * direction[j];
      size = size + size_of[j] * cln::abs(direction[j]);
    }
    largest = std::max(largest, relative_difference(sum - slope.values[0].at(energy), size));
  }
  return largest;
}

namespace {

constexpr std::size_t twist = 6, pose = 12;
enum FramePart { poses, jacobians, accelerations };

class FrameComparison {
 public:
  FrameComparison(const AbiResults& values, const AbiResults& sizes, const std::vector<std::uint32_t>& free,
                  const Oracle& oracle, const State& state)
      : values_(values),
        sizes_(sizes),
        free_(free),
        model_(oracle.model()),
        state_(state),
        at_(oracle.interpreter(state)) {}

  std::array<FrameDifference, 3> operator()() {
    find_scales();
    for (std::uint32_t p = 1; p < model_.places.size(); ++p) compare(p);
    return result_;
  }

 private:
  /// The largest numbers of the model: the oracle's terms of this size may cancel to nothing, as for a point at rest on
  /// a body that turns about it.
  struct Scales {
    Real value = 0, velocity = 0, acceleration = 0;
    std::vector<Real> tangent;  // per coordinate

    void add(const Real& size, const Components& rate, const Components& second, const std::vector<Components>& by_q) {
      value = cln::max(value, size);
      velocity = cln::max(velocity, largest_of(rate));
      acceleration = cln::max(acceleration, largest_of(second));
      tangent.resize(by_q.size(), Real(0));
      for (std::size_t i = 0; i < by_q.size(); ++i) tangent[i] = cln::max(tangent[i], largest_of(by_q[i]));
    }
  };
  void find_scales() {
    for (std::uint32_t p = 1; p < model_.places.size(); ++p) {
      const PlaceMotion& motion = place(p);
      linear_.add(largest_of(motion.position), motion.velocity, motion.acceleration, motion.tangent);
    }
    for (std::uint32_t f = 0; f < model_.frames.size(); ++f)
      angular_.add(Real(1), axes(f).velocity, axes(f).acceleration, axes(f).rotation);
  }

  void note(FramePart part, const Real& difference, const Real& size) {
    result_[part].largest = std::max(result_[part].largest, relative_difference(difference, size));
  }

  const PlaceMotion& place(std::uint32_t index) {
    const auto found = places_.find(index);
    return found != places_.end() ? found->second
                                  : places_.emplace(index, place_motion(at_, index, state_.q.size())).first->second;
  }
  const AxesMotion& axes(std::uint32_t index) {
    const auto found = axes_.find(index);
    return found != axes_.end() ? found->second
                                : axes_.emplace(index, axes_motion(at_, index, state_.q.size())).first->second;
  }

  /// How far axis k of a frame is from that of the place.
  Real axes_difference(std::uint32_t place, std::uint32_t frame) {
    Real largest = 0;
    for (std::size_t k = 0; k < 9; ++k)
      largest = cln::max(largest, cln::abs(values_[0].at(pose * (place - 1) + 3 + k) - axes(frame).e[k / 3][k % 3]));
    return largest;
  }

  /// The axes of a place. For a point they are the nearest ones.
  std::uint32_t axes_of(std::uint32_t place) {
    const auto is_here = [place](const auto& element) { return element.place == place; };
    const auto body = std::find_if(model_.bodies.begin(), model_.bodies.end(), is_here);
    if (body != model_.bodies.end()) return body->frame;
    if (std::any_of(model_.particles.begin(), model_.particles.end(), is_here)) return 0;
    // Bodies with the same axes (one slides along the other) differ by what is fixed in them.
    const Real same = cln::cl_RA(1) / 100000000;
    const Real least = axes_difference(place, 0);
    const model::Body* carrier = nullptr;
    Real nearest = least;
    double least_motion = 0;
    for (const model::Body& one : model_.bodies) {
      const Real difference = axes_difference(place, one.frame);
      if (difference >= least || (carrier != nullptr && difference > nearest + same)) continue;
      const double motion = motion_within(place, one);
      if (carrier != nullptr && difference >= nearest - same && motion >= least_motion) continue;
      nearest = difference, least_motion = motion;
      carrier = &one;
    }
    if (carrier == nullptr) return 0;
    result_[jacobians].largest = std::max(result_[jacobians].largest, least_motion);
    return carrier->frame;
  }

  /// How far dr/dq_i - dr_B/dq_i is from w_i x (r - r_B), relative to the sizes of their terms: 0 for a point that is
  /// fixed in the body.
  double motion_within(std::uint32_t p, const model::Body& body) {
    const PlaceMotion &point = place(p), &centre = place(body.place);
    Components arm;
    for (std::size_t c = 0; c < 3; ++c) arm[c] = point.position[c] - centre.position[c];
    double largest = 0;
    for (const std::uint32_t i : free_) {
      const Components& turn = axes(body.frame).rotation[i];
      const Components expected = cross_product(turn, arm);
      const Real size = linear_.tangent[i] + angular_.tangent[i] * linear_.value;
      for (std::size_t c = 0; c < 3; ++c)
        largest =
            std::max(largest, relative_difference(point.tangent[i][c] - centre.tangent[i][c] - expected[c], size));
    }
    return largest;
  }

  void compare(std::uint32_t p) {
    const std::size_t f = p - 1, n = free_.size();
    const std::uint32_t frame = axes_of(p);
    const PlaceMotion& moved = place(p);
    const AxesMotion& turned = axes(frame);
    for (std::size_t k = 0; k < pose; ++k) {
      const Real& value = k < 3 ? moved.position[k] : turned.e[k / 3 - 1][k % 3];
      note(poses, values_[0].at(pose * f + k) - value, sizes_[0].at(pose * f + k) + (k < 3 ? linear_ : angular_).value);
    }
    for (std::size_t c = 0; c < twist; ++c) {
      const auto part = [c](const Components& linear, const Components& angular) -> const Real& {
        return c < 3 ? linear[c] : angular[c - 3];
      };
      const Real& expected = part(moved.acceleration, turned.acceleration);
      const Scales& scale = c < 3 ? linear_ : angular_;
      const Real centripetal = (scale.value * angular_.velocity + scale.velocity) * angular_.velocity;
      Residual acceleration;
      acceleration.add(values_[2].at(twist * f + c) - expected,
                       sizes_[2].at(twist * f + c) + scale.acceleration + centripetal);
      for (std::size_t i = 0; i < n; ++i) {
        const Components &tangent = moved.tangent[free_[i]], &turn = turned.rotation[free_[i]];
        const std::size_t at = twist * (n * f + i) + c;
        const Real size = sizes_[1].at(at) + scale.tangent[free_[i]];
        const Real& qddot = state_.qddot[free_[i]];
        note(jacobians, values_[1].at(at) - part(tangent, turn), size);
        acceleration.add(values_[1].at(at) * qddot, size * cln::abs(qddot));
      }
      note(accelerations, acceleration.value, acceleration.scale);
    }
  }

  const AbiResults &values_, &sizes_;
  const std::vector<std::uint32_t>& free_;
  const model::Model& model_;
  const State& state_;
  Interpreter at_;
  Scales linear_, angular_;
  std::map<std::uint32_t, PlaceMotion> places_;
  std::map<std::uint32_t, AxesMotion> axes_;
  std::array<FrameDifference, 3> result_{{{"poses of frames"}, {"Jacobians of frames"}, {"accelerations of frames"}}};
};

}  // namespace

std::array<FrameDifference, 3> frame_differences(const AbiResults& values, const AbiResults& sizes,
                                                 const std::vector<std::uint32_t>& free, const Oracle& oracle,
                                                 const State& state) {
  return FrameComparison(values, sizes, free, oracle, state)();
}

}  // namespace eomgen::verify

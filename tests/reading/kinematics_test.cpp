// SPDX-License-Identifier: GPL-3.0-or-later
// The displayed kinematics against the oracle, which differentiates no formula, in 50 digits.
#include "reading/kinematics.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "oracle/interpreter.hpp"
#include "reading/by_name.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen;
using namespace eomgen::test;
using reading::Axes;
using reading::Components;
using reading::Kinematics;
using reading::KinematicTensor;
using reading::KinematicVector;
using reading::Quantity;
using verify::Jet;
using verify::Real;

namespace {

constexpr int kinematic_digits = 50;
const Real kinematic_tolerance = cln::expt_pos(cln::cl_RA(1) / 10, 40);  // ten digits are left for cancellation

using RealTriple = std::array<Real, 3>;

RealTriple real(const verify::Vector& v) { return {v[0].real(), v[1].real(), v[2].real()}; }

bool near(const RealTriple& a, const RealTriple& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (cln::abs(a[k] - b[k]) > kinematic_tolerance) return false;
  }
  return true;
}

/// One model at one state with unequal numbers.
class AtState {
 public:
  explicit AtState(System& system)
      : s_(system), oracle_(system.model, environment(), verify::Precision(kinematic_digits)) {}

  Real value(const Sum& sum) {
    const symbolic::Ref root = reading::to_dag(*s_.mechanics.dag, sum);
    return symbolic::evaluate(
        *s_.mechanics.dag, {root}, [this](const symbolic::Symbol& s) { return number(s); }, kinematic_digits)[0];
  }
  RealTriple vector(const Components& c, const Axes& axes) {
    RealTriple result{0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      const RealTriple e = axis(axes, k);
      const Real x = value(c[k]);
      for (std::size_t i = 0; i < 3; ++i) result[i] = result[i] + x * e[i];
    }
    return result;
  }
  RealTriple axis(const Axes& axes, std::size_t k) {
    const model::Frame& frame = s_.model.frames[axes.frame];
    switch (axes.kind) {
      case Axes::Kind::fixed: return {k == 0 ? 1 : 0, k == 1 ? 1 : 0, k == 2 ? 1 : 0};
      case Axes::Kind::own: return real(oracle_.axis(axes.frame, k));
      case Axes::Kind::before_last_rotation:
        if (frame.stages.size() == 1)
          return axis({frame.parent == 0 ? Axes::Kind::fixed : Axes::Kind::own, frame.parent, {}}, k);
        return real(oracle_.vector(frame.stages[frame.stages.size() - 2].e[k]));
      case Axes::Kind::chart: break;
    }
    return {0, 0, 0};
  }
  RealTriple expected(const KinematicVector& v) {
    verify::Interpreter &later = oracle_.with_time_slope(), &much_later = later.with_time_slope();
    const auto slope = [](const verify::Vector& x, unsigned level) {
      return verify::Vector{x[0].slope(level, 0), x[1].slope(level, 0), x[2].slope(level, 0)};
    };
    switch (v.quantity) {
      case Quantity::axis: {
        const auto kind = v.number < 3 ? Axes::Kind::own : Axes::Kind::before_last_rotation;
        return axis({kind, v.index, {}}, v.number % 3);
      }
      case Quantity::position: return real(oracle_.place(v.index));
      case Quantity::velocity: return real(slope(later.place(v.index), later.level()));
      case Quantity::acceleration:
        return real(slope(slope(much_later.place(v.index), much_later.level()), later.level()));
      case Quantity::angular_velocity: return real(oracle_.angular_velocity(v.index));
      case Quantity::angular_acceleration: return real(slope(later.angular_velocity(v.index), later.level()));
      case Quantity::tangent: return real(oracle_.virtual_rotation(v.index, v.number));
      case Quantity::angular_momentum: {
        const RealTriple w = real(oracle_.angular_velocity(v.index));
        const std::array<RealTriple, 3> J = inertia(v.index);
        RealTriple H{0, 0, 0};
        for (std::size_t i = 0; i < 3; ++i) {
          for (std::size_t k = 0; k < 3; ++k) H[i] = H[i] + J[i][k] * w[k];
        }
        return H;
      }
      default: return real(oracle_.vector(s_.model.definitions[v.index].expression));
    }
  }
  /// J along E1, E2, E3.
  std::array<RealTriple, 3> inertia(std::uint32_t frame) {
    std::array<RealTriple, 3> J{};
    for (const model::Body& body : s_.model.bodies) {
      if (body.frame != frame) continue;
      for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b) {
          const RealTriple ea = real(oracle_.axis(frame, a)), eb = real(oracle_.axis(frame, b));
          const Real entry = oracle_.scalar(body.inertia[a][b]).real();
          for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t k = 0; k < 3; ++k) J[i][k] = J[i][k] + entry * ea[i] * eb[k];
          }
        }
      }
    }
    return J;
  }

 private:
  static Real number(const symbolic::Symbol& s) {
    const bool has_orders = s.kind == symbolic::SymbolKind::coordinate || s.kind == symbolic::SymbolKind::function;
    const cln::cl_RA x = has_orders ? cln::cl_RA(7 + 5 * s.index + 3 * s.order) / (11 + s.index)
                                    : cln::cl_RA(13 + 4 * s.index) / (9 + s.index);
    return cln::cl_float(x, cln::float_format(static_cast<std::uintptr_t>(kinematic_digits)));
  }
  verify::Environment environment() const {
    verify::Environment result;
    for (std::uint32_t i = 0; i < s_.model.coordinates.size(); ++i) {
      result.coordinates.emplace_back();
      for (std::uint8_t order = 0; order < 3; ++order)
        result.coordinates.back().emplace_back(number({symbolic::SymbolKind::coordinate, i, order}));
    }
    constexpr std::uint8_t highest_order = 6;
    for (std::uint32_t i = 0; i < s_.model.functions.size(); ++i) {
      result.functions.emplace_back();
      for (std::uint8_t order = 0; order <= highest_order; ++order)
        result.functions.back().emplace_back(number({symbolic::SymbolKind::function, i, order}));
    }
    result.t = number({symbolic::SymbolKind::time, 0, 0});
    for (std::uint32_t i = 0; i < s_.model.inputs.size(); ++i)
      result.inputs.emplace_back(number({symbolic::SymbolKind::input, i, 0}));
    for (std::uint32_t i = 0; i < s_.model.parameters.size(); ++i)
      result.parameters.emplace_back(number({symbolic::SymbolKind::parameter, i, 0}));
    return result;
  }

  System& s_;
  verify::Interpreter oracle_;
};

const KinematicVector& find(const Kinematics& of, Quantity quantity, Axes::Kind axes, std::uint32_t number = 0) {
  for (const KinematicVector& v : of.vectors) {
    if (v.quantity == quantity && v.axes.kind == axes && v.number == number) return v;
  }
  throw std::logic_error("not shown");
}

}  // namespace

TEST_CASE("kinematics: every vector and tensor has the oracle's value") {
  for (const char* name : {"R14_sliding_cylinder", "R6_sliding_disk", "R9_payload_arm", "R15_pin_joint",
                           "R1_free_body_euler_parameters", "S5_double_pendulum_cartesian"}) {
    CAPTURE(name);
    System s(model::read_model(shipped(name)));
    AtState at(s);
    std::size_t vectors = 0;
    for (const Kinematics& of : reading::kinematics(s.mechanics)) {
      CAPTURE(of.name);
      for (const KinematicVector& v : of.vectors) {
        CAPTURE(reading::name(v.quantity));
        if (!v.skip_reason.empty() || v.axes.kind == Axes::Kind::chart) continue;
        const RealTriple shown = at.vector(v.components, v.axes);
        ++vectors;
        if (v.quantity != Quantity::dual) {
          CHECK(near(shown, at.expected(v)));
          continue;
        }
        for (const KinematicVector& g : of.vectors) {  // g^i . g_k
          if (g.quantity != Quantity::tangent || g.axes.kind != Axes::Kind::fixed) continue;
          const bool is_entry = std::any_of(of.vectors.begin(), of.vectors.end(), [&](const KinematicVector& other) {
            return other.quantity == Quantity::dual && other.number == g.number;
          });
          if (!is_entry) continue;
          const RealTriple e = at.expected(g);
          const Real product = shown[0] * e[0] + shown[1] * e[1] + shown[2] * e[2];
          CHECK(cln::abs(product - (g.number == v.number ? 1 : 0)) < kinematic_tolerance);
        }
      }
      for (const KinematicTensor& t : of.tensors) {
        if (t.is_euler_tensor || t.about != 0 || !t.skip_reason.empty()) continue;
        const std::array<RealTriple, 3> J = at.inertia(t.frame);
        for (std::size_t k = 0; k < 3; ++k) {
          RealTriple row{0, 0, 0};  // row k along the fixed axes
          for (std::size_t a = 0; a < 3; ++a) {
            for (std::size_t b = 0; b < 3; ++b) {
              const RealTriple ea = at.axis(t.axes, a), eb = at.axis(t.axes, b);
              for (std::size_t i = 0; i < 3; ++i) row[i] = row[i] + ea[k] * at.value(t.entries[a][b]) * eb[i];
            }
          }
          CHECK(near(row, J[k]));
        }
      }
    }
    CHECK(vectors > 5);
  }
}

TEST_CASE("kinematics: spherical coordinates give the components of textbooks") {
  System s(model::read_model(shipped("G1_spherical")));
  const auto v = [&](const char* name) { return s.symbol(name); };
  const std::vector<Kinematics> all = reading::kinematics(s.mechanics);
  REQUIRE_FALSE(all.empty());
  const Components& velocity = find(all[0], Quantity::velocity, Axes::Kind::chart).components;
  CHECK(same(velocity[1], v("R") * v("phi_dot")));
  CHECK(same(velocity[2], v("R") * sin(v("phi")) * v("theta_dot")));
  const Components& a = find(all[0], Quantity::acceleration, Axes::Kind::chart).components;
  CHECK(same(a[0], v("R_ddot") - v("R") * square(v("phi_dot")) - v("R") * square(sin(v("phi")) * v("theta_dot"))));
  CHECK(same(a[1], v("R") * v("phi_ddot") + Sum(2) * v("R_dot") * v("phi_dot") -
                       v("R") * sin(v("phi")) * cos(v("phi")) * square(v("theta_dot"))));
}

TEST_CASE("kinematics: Euler and dual Euler bases of the 3-2-3 angles are (5.86) and (5.87)") {
  System s(model::read_model(shipped("R14_sliding_cylinder")));
  const Sum psi = s.symbol("psi"), theta = s.symbol("theta");
  const auto index = [&](const char* name) {
    for (std::uint32_t i = 0; i < s.model.coordinates.size(); ++i) {
      if (s.model.coordinates[i].name == name) return i;
    }
    return std::uint32_t{0};
  };
  const Kinematics rod = reading::kinematics(s.mechanics).front();
  const Components& g1 = find(rod, Quantity::tangent, Axes::Kind::own, index("phi")).components;
  CHECK(same(g1[0], -sin(theta) * cos(psi)));
  CHECK(same(g1[1], sin(theta) * sin(psi)));
  CHECK(same(g1[2], cos(theta)));
  const Components& dual3 = find(rod, Quantity::dual, Axes::Kind::own, index("psi")).components;
  CHECK(same(dual3[0], over(cos(psi) * cos(theta), sin(theta))));
  CHECK(same(dual3[1], -over(sin(psi) * cos(theta), sin(theta))));
  CHECK(dual3[2] == Sum(1));
  REQUIRE(rod.tensors.size() == 3);
  // E = tr(J)/2 1 - J
  const KinematicTensor& euler = rod.tensors[1];
  CHECK(euler.is_euler_tensor);
  CHECK(same(euler.entries[0][0], half(s.symbol("Ja"))));
  CHECK(same(euler.entries[1][1], s.symbol("Jt") - half(s.symbol("Ja"))));
}

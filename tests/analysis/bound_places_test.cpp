// SPDX-License-Identifier: GPL-3.0-or-later
// What is drawn of constraints and forces: rods, surfaces, points about which bodies turn, the plane below what
// bounces; and that forces are what moves the masses.
#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/drawing/forces.hpp"
#include "derive/routes/lagrange.hpp"
#include "run/scene.hpp"
#include "support/folders.hpp"
#include "symbolic/evaluate.hpp"

using namespace eomgen;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

namespace {

constexpr double rounding = 1e-12;  // relative, of the values that a start has

struct AtStart {
  explicit AtStart(model::Model given)
      : model(std::move(given)),
        m(mechanics::build_mechanics(model)),
        drawing(m),
        forces(m, drawing),
        system(derive::lagrange(m, system::Approach::two)) {
    scene = run::resolve_scene(m, system, m.model->scene("default"), {});
    forces.add_outputs(system);
  }

  /// With accelerations and multipliers where the equations are solved.
  std::vector<double> values(const std::vector<Ref>& expressions) const {
    return symbolic::evaluate(*m.dag, expressions, [&](const Symbol& s) -> double {
      switch (s.kind) {
        case SymbolKind::time: return scene.t0;
        case SymbolKind::parameter: return scene.parameters[s.index];
        case SymbolKind::coordinate:
          if (s.order == 0) return scene.q[s.index];
          if (s.order == 1) return scene.qdot[s.index];
          for (std::size_t i = 0; i < system.free.size(); ++i) {
            if (system.free[i] == s.index) return solved[static_cast<Eigen::Index>(i)];
          }
          return std::nan("");
        case SymbolKind::multiplier:
          for (std::size_t k = 0; k < system.active.size(); ++k) {
            if (system.active[k] == s.index) return solved[static_cast<Eigen::Index>(system.free.size() + k)];
          }
          return std::nan("");
        default: return std::nan("");
      }
    });
  }
  void solve() {
    const auto n = static_cast<Eigen::Index>(system.free.size()), k = static_cast<Eigen::Index>(system.active.size());
    const std::vector<double> M = values(system.M), f = values(system.f), A = values(system.A),
                              g = values(system.gamma);
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(n + k, n + k);
    Eigen::VectorXd right(n + k);
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) all(i, j) = M[static_cast<std::size_t>(i * n + j)];
      right[i] = f[static_cast<std::size_t>(i)];
    }
    for (Eigen::Index i = 0; i < k; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        all(n + i, j) = A[static_cast<std::size_t>(i * n + j)];
        all(j, n + i) = -all(n + i, j);
      }
      right[n + i] = -g[static_cast<std::size_t>(i)];
    }
    solved = all.fullPivLu().solve(right);
  }
  Eigen::Vector3d vector(std::size_t at) const {
    const std::vector<double> v =
        values({drawing.expressions()[at], drawing.expressions()[at + 1], drawing.expressions()[at + 2]});
    return Eigen::Vector3d(v.data());
  }

  model::Model model;
  mechanics::Mechanics m;
  analysis::Drawing drawing;
  analysis::DrawnForces forces;
  system::EquationSystem system;
  run::Scene scene;
  Eigen::VectorXd solved;
};

AtStart shipped(const std::string& name) {
  return AtStart(model::read_model(test::source_folder() + "/models/" + name + ".toml"));
}

std::vector<std::pair<long, long>> rods(const std::string& name) {
  std::vector<std::pair<long, long>> result;
  const AtStart found = shipped(name);
  for (const analysis::DrawnRod& rod : found.drawing.parts().rods) result.emplace_back(rod.a, rod.b);
  return result;
}

}  // namespace

TEST_CASE("drawing: rods are where coordinates or a constraint hold two masses at a distance, and nowhere else") {
  using Pairs = std::vector<std::pair<long, long>>;
  CHECK(rods("S5_double_pendulum_cartesian") == Pairs{{-1, 0}, {0, 1}});
  CHECK(rods("S6_chain_6") == Pairs{{-1, 0}, {0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}});
  CHECK(rods("iftomm_pendulum") == Pairs{{-1, 0}});
  for (const char* none :
       {"S5_double_pendulum", "bouncing_ball", "P5_rough_sphere", "elastic_pendulum", "P13_saddle_field"}) {
    CAPTURE(std::string(none));
    CHECK(rods(none).empty());  // the first has coordinates that lines are drawn along
  }
}

TEST_CASE("drawing: a body whose position turns with it has a joint where it does") {
  const AtStart found = shipped("n_four_bar_2");
  std::vector<Eigen::Vector3d> wanted{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {1, 1, 0}};
  REQUIRE(found.drawing.parts().joints.size() == wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k)
    CHECK((found.vector(found.drawing.parts().joints[k].at) - wanted[k]).norm() < rounding);
  CHECK(shipped("R6_rolling_disk").drawing.parts().joints.empty());  // its contact is fixed in nothing
}

TEST_CASE("drawing: a particle that constraints bind has their surface or curve, unless a rod says it all") {
  const auto surfaces = [](const std::string& name) { return shipped(name).drawing.parts().surfaces; };
  const auto sphere = surfaces("P7_moving_sphere");
  REQUIRE(sphere.size() == 1);
  CHECK(sphere[0].coordinates.size() == 3);
  CHECK(sphere[0].psi.size() == 1);
  CHECK(sphere[0].moves);
  CHECK_FALSE(sphere[0].touched);
  const auto helix = surfaces("P8_smooth_helix");
  REQUIRE(helix.size() == 1);
  CHECK(helix[0].psi.size() == 2);
  CHECK_FALSE(helix[0].moves);
  CHECK(surfaces("P5_rough_sphere")[0].touched);
  CHECK(surfaces("bouncing_ball")[0].coordinates.size() == 2);
  CHECK(surfaces("P3_moving_plane")[0].moves);
  CHECK(surfaces("S3_rough_line").size() == 2);
  for (const char* none : {"P1_spherical_pendulum", "S5_double_pendulum_cartesian", "G1_spherical", "R8_pendulum_body"})
    CHECK(surfaces(none).empty());
}

TEST_CASE("drawing: the plane of a contact is below what has not come down to it") {
  const AtStart found = shipped("bouncing_sphere");
  const analysis::DrawnContact& floor = found.drawing.parts().contacts.at(0);
  CHECK((found.vector(floor.at) - Eigen::Vector3d(0, 0, 1)).norm() < rounding);
  CHECK(found.vector(floor.foot).norm() < rounding);
}

// Applied, of constraints, at contacts: together m a of all masses, as the equations of motion have it.
TEST_CASE("drawing: the forces that are drawn move the masses as they move") {
  for (const char* name : {"P7_moving_sphere", "P8_smooth_helix", "P9_paraboloid", "P3_moving_plane",
                           "elastic_pendulum", "S5_double_pendulum", "S5_double_pendulum_cartesian", "S6_chain_2",
                           "R6_rolling_disk", "R4_turntable", "R3_sphere_on_incline", "P13_force_fields"}) {
    const std::string model = name;
    CAPTURE(model);
    AtStart start = shipped(name);
    start.solve();
    symbolic::Dag& dag = *start.m.dag;
    symbolic::Derivation ddt = symbolic::total_time(dag, start.m.q.size(), start.model.functions.size());
    symbolic::Substitution imposed = mechanics::impose(start.m), written = mechanics::write_out(start.m);
    Eigen::Vector3d wanted = Eigen::Vector3d::Zero(), sum = wanted;
    double size = 0;
    for (const mechanics::PointMass& mass : start.m.masses) {
      std::vector<Ref> a{mass.mass};
      for (std::size_t k = 0; k < 3; ++k) a.push_back(written(imposed(ddt(mass.velocity[k]))));
      const std::vector<double> v = start.values(a);
      wanted += v[0] * Eigen::Vector3d(v[1], v[2], v[3]);
    }
    const std::size_t places = start.drawing.outputs().size();
    for (const analysis::DrawnForce& force : start.forces.list()) {
      if (force.at >= places) continue;  // of a spring on the ground
      std::vector<Ref> value;
      for (std::size_t k = 0; k < 3; ++k)
        value.push_back(system::find(start.system.outputs, start.forces.outputs()[force.value - places + k])->value);
      const std::vector<double> v = start.values(value);
      sum += Eigen::Vector3d(v.data());
      size += Eigen::Vector3d(v.data()).norm();
    }
    CHECK(size > 0);
    CHECK((sum - wanted).norm() <= 1e3 * rounding * size);
  }
}

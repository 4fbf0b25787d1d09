// SPDX-License-Identifier: GPL-3.0-or-later
// Drawn parts of constraints: rods, surfaces, fixed points of bodies, planes of contacts.
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "initial_state.hpp"

using namespace eomgen;
using test::InitialState;
using test::shipped;

namespace {

constexpr double surface_rounding = 1e-12;  // relative, for values at the start

std::vector<std::pair<long, long>> rods(const std::string& name) {
  std::vector<std::pair<long, long>> result;
  const InitialState found = shipped(name);
  for (const analysis::DrawnRod& rod : found.drawing.parts().rods) result.emplace_back(rod.a, rod.b);
  return result;
}

}  // namespace

TEST_CASE("drawing: rods connect exactly those masses whose distance is fixed by coordinates or a constraint") {
  using Pairs = std::vector<std::pair<long, long>>;
  CHECK(rods("S5_double_pendulum_cartesian") == Pairs{{-1, 0}, {0, 1}});
  CHECK(rods("S6_chain_6") == Pairs{{-1, 0}, {0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}});
  CHECK(rods("iftomm_pendulum") == Pairs{{-1, 0}});
  for (const char* none :
       {"S5_double_pendulum", "bouncing_ball", "P5_rough_sphere", "elastic_pendulum", "P13_saddle_field"}) {
    CAPTURE(std::string(none));
    CHECK(rods(none).empty());  // the first has coordinates with lines
  }
}

TEST_CASE("drawing: all rods of a long chain are found") {
  mechanics::Mechanics m = mechanics::build_mechanics(model::read_model_text(
      "format = 1\n[[chain]]\nname = \"link\"\nn = 40\nmass = \"1 kg\"\nlength = \"1 m\"\n[[force]]\ngravity = "
      "\"-9.81[m/s^2]*E2\"\n",
      "chain.toml"));
  const analysis::Drawing drawing(m);
  CHECK(drawing.parts().rods.size() == 40);
  CHECK_FALSE(drawing.parts().rods_incomplete);
}

TEST_CASE("drawing: a body that rotates about a fixed point has a joint there") {
  const InitialState found = shipped("n_four_bar_2");
  std::vector<Eigen::Vector3d> wanted{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {1, 1, 0}};
  REQUIRE(found.drawing.parts().joints.size() == wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k)
    CHECK((found.vector(found.drawing.parts().joints[k].at) - wanted[k]).norm() < surface_rounding);
  CHECK(shipped("R6_rolling_disk").drawing.parts().joints.empty());  // its point of contact is not fixed in any body
}

TEST_CASE("drawing: a constrained particle has a surface or curve, unless a rod represents the constraint") {
  const auto surfaces = [](const std::string& name) { return shipped(name).drawing.parts().surfaces; };
  const auto sphere = surfaces("P7_moving_sphere");
  REQUIRE(sphere.size() == 1);
  CHECK(sphere[0].coordinates.size() == 3);
  CHECK(sphere[0].psi.size() == 1);
  CHECK(sphere[0].is_moving);
  CHECK_FALSE(sphere[0].has_contact);
  const auto helix = surfaces("P8_smooth_helix");
  REQUIRE(helix.size() == 1);
  CHECK(helix[0].psi.size() == 2);
  CHECK_FALSE(helix[0].is_moving);
  CHECK(surfaces("P5_rough_sphere")[0].has_contact);
  CHECK(surfaces("bouncing_ball")[0].coordinates.size() == 2);
  CHECK(surfaces("P3_moving_plane")[0].is_moving);
  CHECK(surfaces("S3_rough_line").size() == 2);
  for (const char* none : {"P1_spherical_pendulum", "S5_double_pendulum_cartesian", "G1_spherical", "R8_pendulum_body"})
    CHECK(surfaces(none).empty());
}

TEST_CASE("drawing: a surface moves with its reference place, and centres of bodies have surfaces too") {
  const auto surfaces = [](const std::string& text) {
    return InitialState(
               model::read_model_text("format = 1\n[parameters]\nm = \"1 kg\"\nL = \"2 m\"\n" + text, "m.toml"))
        .drawing.parts()
        .surfaces;
  };
  const std::string cart = "[[particle]]\nname = \"cart\"\nmass = \"m\"\nposition = \"X*E1\"\n";
  const std::string bead = "[[particle]]\nname = \"bead\"\nmass = \"m\"\n";
  const std::string moving = "[scene.default]\ninitial = { X_dot = 1 }\n";
  // A bead in a sliding bowl.
  const auto bowl = surfaces("[coordinates]\nX = \"m\"\n" + cart + bead +
                             "position = { cartesian = [\"x\", \"y\", \"z\"], from = \"cart\" }\n[[constraint]]\nname "
                             "= \"bowl\"\nholonomic = \"z - (x^2 + y^2)/L\"\n" +
                             moving);
  REQUIRE(bowl.size() == 1);
  CHECK(bowl[0].coordinates.size() == 3);
  CHECK(bowl[0].others == std::vector<std::uint32_t>{0});
  CHECK(bowl[0].is_moving);
  CHECK_FALSE(bowl[0].changes_shape);
  // On a sliding wedge, relative to the origin: psi depends on its coordinate.
  const auto wedge = surfaces(
      "[coordinates]\nX = \"m\"\n" + cart + bead +
      "position = { cartesian = [\"x\", \"y\"] }\n[[constraint]]\nname = \"wedge\"\nholonomic = \"y + (x - X)/2\"\n" +
      moving);
  REQUIRE(wedge.size() == 1);
  CHECK(wedge[0].place == 1);
  CHECK(wedge[0].changes_shape);
  // A rod to the cart is a rod. A thread over the origin to the cart is no surface of the bead.
  CHECK(surfaces(
            "[coordinates]\nX = \"m\"\n" + cart + bead +
            "position = { cartesian = [\"x\", \"y\"], from = \"cart\" }\n[[constraint]]\nname = \"rod\"\nholonomic = "
            "\"x^2 + y^2 - L^2\"\n[scene.default]\ninitial = { x = 2 }\n")
            .empty());
  CHECK(
      surfaces("[coordinates]\nX = \"m\"\n" + cart + bead +
               "position = { cartesian = [\"x\", \"y\"] }\n[[constraint]]\nname = \"thread\"\nholonomic = \"sqrt(x^2 + "
               "y^2) + X - L\"\n[scene.default]\ninitial = { x = 1, X = 1 }\n")
          .empty());
  // The centre of a body on a plane.
  const auto body = surfaces(
      "[[body]]\nname = \"B\"\nmass = \"m\"\ninertia = { sphere = \"L\" }\nposition = { cartesian = [\"x\", "
      "\"y\", "
      "\"z\"] }\nrotation = { euler = \"321\", angles = [\"a\", \"b\", \"c\"] }\n[[constraint]]\nname = "
      "\"plane\"\nholonomic = \"z + "
      "x\"\n[scene.default]\ninitial = { y_dot = 1 }\n");
  REQUIRE(body.size() == 1);
  CHECK(body[0].coordinates.size() == 3);
  CHECK(body[0].others.empty());
}

TEST_CASE("drawing: the plane of an open contact is below the body") {
  const InitialState found = shipped("bouncing_sphere");
  const analysis::DrawnContact& floor = found.drawing.parts().contacts.at(0);
  CHECK((found.vector(floor.at) - Eigen::Vector3d(0, 0, 1)).norm() < surface_rounding);
  CHECK(found.vector(floor.foot).norm() < surface_rounding);
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Charts that can be exchanged, and uses of angles that prevent it.
#include "model/charts.hpp"

#include <doctest/doctest.h>

#include "model/mentions.hpp"

using namespace eomgen;

namespace {

std::string head(const std::string& position = "") {
  return "format = 1\n[parameters]\ng = 9.81\nk = 2\n[[body]]\nname = \"B\"\nmass = 1\ninertia = { principal = [1, 2, "
         "3] }\n" +
         position + "rotation = { euler = \"323\", angles = [\"phi\", \"theta\", \"psi\"] }\n";
}
const std::string end = "[scene.default]\nt = [0, 1]\n";
const std::string spherical = "position = { spherical = [\"R\", \"alpha\", \"beta\"] }\n";

std::string chart_refusal(const std::string& text, std::size_t which = 0) {
  return model::charts(model::read_model_text(text, "m.toml")).at(which).refusal;
}

}  // namespace

TEST_CASE("charts: angles used nowhere else, or only in initial values, can be exchanged") {
  CHECK(chart_refusal(head() +
                      "[[force]]\ngravity = \"-g*E3\"\n[[force]]\nmoment = \"k*B.e1\"\non = \"B\"\n[definitions]\nw = "
                      "\"dot(omega(B), B.e3)\"\n" +
                      end + "initial = { theta = 1, \"B.omega\" = [1, 2, 3] }\noutputs = [\"w\"]\n")
            .empty());
}

TEST_CASE("charts: a constraint, a force, a definition or an event that uses an angle prevents the exchange") {
  const auto check = [](const std::string& more, const std::string& sentence) {
    CAPTURE(more);
    CHECK(chart_refusal(head() + more + end) == sentence);
  };
  check("[[constraint]]\nname = \"level\"\nholonomic = \"psi\"\n",
        "the coordinate 'psi' is named by constraint 'level'");
  check("[[force]]\nname = \"drive\"\ngeneralized = { theta = \"k\" }\n", "the coordinate 'theta' is named by 'drive'");
  check("[[force]]\nname = \"spring\"\ntorsion = { angle = \"phi\", stiffness = \"k\" }\n",
        "the coordinate 'phi' is named by 'spring'");
  check("[definitions]\nrate = \"psi_dot + 1\"\n", "the coordinate 'psi' is named by definition 'rate'");
  check("[energy]\npotential = \"k*cos(theta)\"\n", "the coordinate 'theta' is named by the energies");
  check("[[event]]\nname = \"up\"\nwhen = \"theta - 1\"\n", "the coordinate 'theta' is named by event 'up'");
  check("[[force]]\nname = \"push\"\nmoment = \"k*B.e2'\"\non = \"B\"\n",
        "'B.e2'', an intermediate axis of the rotation, is named by 'push'");
  check("[[particle]]\nname = \"P\"\nmass = 1\nposition = { cylindrical = [\"r\", \"phi\"] }\n",
        "the coordinate 'phi' is named by the position of 'P'");
  check("[[frame]]\nname = \"F\"\nrotation = { axis = \"E3\", angle = \"psi\" }\n",
        "the coordinate 'psi' is named by the rotation of 'F'");
}

TEST_CASE("charts: angles that are not coordinates, contacts and rotating axes prevent the exchange") {
  std::string text = head();
  text.replace(text.find("\"psi\""), 5, "\"k*t\"");
  CHECK(chart_refusal(text + end) ==
        "an angle is an expression or the same as another: only coordinates can be exchanged");
  CHECK(chart_refusal(head("position = { cartesian = [\"x\", \"y\", \"z\"] }\n") +
                      "[[constraint]]\nname = \"floor\"\nholonomic = \"z\"\nholds = \"unilateral\"\n" + end) ==
        "constraint 'floor' has friction or can be left");
  CHECK(
      chart_refusal(
          head() +
              "[[particle]]\nname = \"P\"\nmass = 1\nposition = { spherical = [\"R\", \"a\", \"b\"], axes = \"B\" }\n" +
              end,
          1) == "its axes turn");
}

TEST_CASE("charts: a body has independent charts of its rotation and its position") {
  const model::Model model = model::read_model_text(
      head(spherical) + "[[constraint]]\nname = \"arm\"\nholonomic = \"R - k\"\n" + end, "m.toml");
  const std::vector<model::ChartPair> charts = model::charts(model);
  REQUIRE(charts.size() == 2);
  CHECK(charts[0].of == "B");
  CHECK(charts[1].of == "B.position");
  CHECK(charts[0].refusal.empty());
  CHECK(charts[1].refusal.empty());  // the constraint uses R only
  CHECK(charts[0].second == "321");
  CHECK(charts[1].second == "spherical about E1");
  const model::Model both = model::in_second_charts(model, charts, 3);
  CHECK(both.frames[1].rotation == "321");
  CHECK(both.places[1].position != model.places[1].position);
  CHECK(both.coordinates.size() == model.coordinates.size());
}

// SPDX-License-Identifier: GPL-3.0-or-later
// A quadruped of twelve pins, written like an imported robot: full inertias as numbers, on the ground and free.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <memory>
#include <string>

#include "model/model.hpp"
#include "pipeline/pipeline.hpp"
#include "program/build.hpp"

using namespace eomgen;

namespace {

std::string body(const std::string& name, const std::string& origin, int side, const std::string& rotation,
                 const std::string& parent) {
  return fmt::format(
      "[[body]]\nname = \"{0}\"\nmass = \"0.148 kg\"\n"
      "inertia = [[\"0.00041 kg*m^2\", \"0.00002 kg*m^2\", \"0.00001 kg*m^2\"], [\"0.00002 kg*m^2\", \"0.00043 "
      "kg*m^2\", "
      "\"{2}0.00005 kg*m^2\"], [\"0.00001 kg*m^2\", \"{2}0.00005 kg*m^2\", \"0.00003 kg*m^2\"]]\n"
      "position = \"{1} + 0.002[m]*{0}.e1 {3} 0.019[m]*{0}.e2 - 0.079[m]*{0}.e3\"\n{4}rotation = {5}\n",
      name, origin, side < 0 ? "-" : "", side < 0 ? "-" : "+",
      parent.empty() ? "" : fmt::format("relative_to = \"{}\"\n", parent), rotation);
}

/// Hips about e1, then thigh and shank about e2.
std::string quadruped(bool floating) {
  std::string text = "format = 1\n[parameters]\ng = \"9.81 m/s^2\"\n", base = "E", origin = "origin", bodies;
  if (floating) {
    text +=
        "[coordinates]\nx = \"m\"\ny = \"m\"\nz = \"m\"\n[[point]]\nname = \"middle\"\nposition = { cartesian = "
        "[\"x\", "
        "\"y\", \"z\"] }\n[[body]]\nname = \"base\"\nmass = \"1.16 kg\"\ninertia = { principal = [\"0.006 kg*m^2\", "
        "\"0.019 kg*m^2\", \"0.025 kg*m^2\"] }\nposition = \"middle\"\nrotation = { euler = \"321\", angles = "
        "[\"yaw\", \"pitch\", \"roll\"] }\n";
    base = "base.e";
    origin = "middle";
  }
  int leg = 0;
  for (const auto& [front, side] : {std::pair{1, 1}, std::pair{1, -1}, std::pair{-1, 1}, std::pair{-1, -1}}) {
    const std::string n = std::to_string(++leg), out = side < 0 ? "-" : "+", parent = floating ? "base" : "";
    const std::string hip = fmt::format("hip{}_at", n), thigh = fmt::format("thigh{}_at", n),
                      shank = fmt::format("shank{}_at", n);
    bodies += fmt::format(
        "[[point]]\nname = \"{}\"\nposition = \"{} {} 0.19[m]*{}1 {} 0.087[m]*{}2\"\n"
        "[[point]]\nname = \"{}\"\nposition = \"{} {} 0.014[m]*hip{}.e2\"\n"
        "[[point]]\nname = \"{}\"\nposition = \"{} {} 0.037[m]*thigh{}.e2 - 0.16[m]*thigh{}.e3\"\n",
        hip, origin, front < 0 ? "-" : "+", base, out, base, thigh, hip, out, n, shank, thigh, out, n, n);
    bodies += body("hip" + n, hip, side, fmt::format("{{ axis = \"{}1\", angle = \"a{}\" }}", base, n), parent);
    bodies += body("thigh" + n, thigh, side, fmt::format("{{ axis = \"hip{0}.e2\", angle = \"b{0}\" }}", n), "hip" + n);
    bodies +=
        body("shank" + n, shank, side, fmt::format("{{ axis = \"thigh{0}.e2\", angle = \"c{0}\" }}", n), "thigh" + n);
  }
  return text + bodies + "[[force]]\ngravity = \"-g*E3\"\n";
}

}  // namespace

// Without regrouped inertias, without shared axes of thigh and shank, and with the base solved along world axes, these
// were 3509 and 1156 operations. Today they are 2444 and 510; the bounds leave 2 % to ties in the optimiser.
TEST_CASE("a quadruped needs no more operations than its customised recursion") {
  for (const auto& [floating, most] : {std::pair{true, std::size_t{2490}}, std::pair{false, std::size_t{520}}}) {
    CAPTURE(floating);
    const auto model = std::make_shared<const model::Model>(model::read_model_text(quadruped(floating), "quadruped"));
    const auto derived = pipeline::derive_model(model, pipeline::ApproachChoice::automatic);
    const program::Program program = pipeline::make_program(*derived, {});
    CHECK(program.functions.front().operations.flops() <= most);
    CHECK(pipeline::certify(*derived, program, {50, 5, 1, nullptr}).pass);
  }
}

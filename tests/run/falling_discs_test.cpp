// SPDX-License-Identifier: GPL-3.0-or-later
// Discs that fall into a box and come to rest on one another, with friction. One rests in a corner without a load on
// the wall, where rounding decides whether its friction is within the limit of a force of 0.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <array>
#include <string>
#include <utility>

#include "support/run_text.hpp"

using namespace eomgen;

namespace {

using Places = std::array<std::pair<double, double>, 8>;

std::string discs(const Places& places) {
  std::string text = "[parameters]\nm = 1\nR = 0.05\nW = 0.35\ng = 9.81\nmu = 0.3\n", names, initial;
  for (std::size_t i = 0; i < places.size(); ++i) {
    text += fmt::format(
        "[[body]]\nname = \"D{0}\"\nmass = \"m\"\ninertia = \"m*R^2/2\"\nposition = {{ cartesian = [\"x{0}\", \"0\", "
        "\"z{0}\"] }}\nrotation = {{ axis = \"E2\", angle = \"q{0}\" }}\n",
        i);
    for (const auto& [name, on] : {std::pair{"floor", "\"ground\""},
                                   {"left", "{ point = \"-W/2*E1\", normal = \"E1\" }"},
                                   {"right", "{ point = \"W/2*E1\", normal = \"-E1\" }"}})
      text += fmt::format(
          "[[contact]]\nname = \"{0}{1}\"\nbody = \"D{1}\"\nshape = {{ sphere = \"R\" }}\non = {2}\nfriction = {{ "
          "static "
          "= \"mu\", dynamic = \"mu\" }}\n",
          name, i, on);
    names += fmt::format("{}\"D{}\"", i > 0 ? ", " : "", i);
    initial += fmt::format("{}x{} = {}, z{} = {}", i > 0 ? ", " : "", i, places[i].first, i, places[i].second);
  }
  return text + fmt::format(
                    "[[contact]]\nname = \"pair\"\nspheres = [{}]\nradius = \"R\"\nfriction = {{ static = "
                    "\"mu\", dynamic = \"mu\" }}\n[impacts]\nlaw = \"moreau\"\n[[force]]\ngravity = "
                    "\"-g*E3\"\n[scene.default]\nt = [0, 1]\ninitial = {{ {} }}\n",
                    names, initial);
}

}  // namespace

TEST_CASE("falling discs: those that rest without a load end no run") {
  const Places first{{{-0.067741, 0.075885},
                      {0.059899, 0.077078},
                      {-0.059986, 0.196311},
                      {0.052763, 0.211749},
                      {-0.067313, 0.329687},
                      {0.072413, 0.334405},
                      {-0.055771, 0.464527},
                      {0.065281, 0.458012}}};
  const test::FinishedRun run = test::run_text("falling_discs", discs(first));
  CHECK(run.simulation.result.outcome == eom::Outcome::done);
  CHECK(run.simulation.result.power_balance < 1e-9);
}

// SPDX-License-Identifier: GPL-3.0-or-later
// The command stress: its document, its exit codes, and a few shipped models through the quick variations.
#include <doctest/doctest.h>

#include "program.hpp"

using namespace eomgen::test;

TEST_CASE("stress: no shipped model of these loses its way without a word") {
  const Folder folder;
  for (const char* model : {"elastic_pendulum", "P2_planar_pendulum", "cart_pendulum", "R1_free_body_euler_parameters"}) {
    CAPTURE(std::string(model));
    const Json found = document(folder, {"stress", model, "--quick", "--steps", "5000", "--seconds", "1e6", "--t-end", "1"});
    CHECK(found["verdict"] == "pass");
    CHECK(found["silent"] == 0);
    CHECK(found["kept"].get<int>() > 10);
    for (const Json& row : found["rows"]) CHECK_FALSE(row["verdict"] == "silent");
    const Json& audit = found["denominator_audit"];
    CHECK(audit["states"].get<int>() > 20);
    CHECK(audit["digits_lost"]["value"].get<double>() >= 0);
    CHECK(audit["mass_condition"]["value"].get<double>() >= 1);
    if (std::string(model) != "elastic_pendulum") continue;
    // r'' = .. - k (r - L)/m, theta'' = (..)/r: that and nothing else; near r = 0 the mass matrix diag(m, m r^2) is that of a point.
    CHECK(audit["denominators"].size() == 2);
    for (const Json& d : audit["denominators"]) CHECK(d["zero"] == d["expression"].get<std::string>() + " = 0");
    CHECK(audit["mass_condition"]["case"] == "r at 0 + 1e-09");
    CHECK(audit["mass_condition"]["value"].get<double>() == doctest::Approx(1e18));
    CHECK(audit["scaled_mass_condition"]["value"].get<double>() == doctest::Approx(1));
    CHECK(audit["digits_lost"]["value"].get<double>() > 3);  // a stiff spring that is hardly stretched
  }
}

TEST_CASE("stress: wrong input is refused before anything is run") {
  const Folder folder;
  CHECK(contains(expect(2, folder, {"stress", "P2_planar_pendulum", "--solver", "dopri"}).err, "did you mean"));
  CHECK(contains(expect(2, folder, {"stress", "P2_planar_pendulum", "--set", "nothing=1"}).err, "nothing"));
}

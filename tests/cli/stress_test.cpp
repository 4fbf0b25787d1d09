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
  }
}

TEST_CASE("stress: wrong input is refused before anything is run") {
  const Folder folder;
  CHECK(contains(expect(2, folder, {"stress", "P2_planar_pendulum", "--solver", "dopri"}).err, "did you mean"));
  CHECK(contains(expect(2, folder, {"stress", "P2_planar_pendulum", "--set", "nothing=1"}).err, "nothing"));
}

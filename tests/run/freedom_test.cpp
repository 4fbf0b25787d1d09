// SPDX-License-Identifier: GPL-3.0-or-later
// Models without degrees of freedom are rejected, with the constraint that removes the last one.
#include <doctest/doctest.h>

#include "support/folders.hpp"
#include "support/simulation.hpp"

using namespace eomgen;

namespace {

std::string planar(const std::string& second) {
  return "format = 1\n[parameters]\nm = 1\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = { cartesian = [\"x\", "
         "\"y\"] }\n"
         "[[constraint]]\nname = \"a\"\nholonomic = \"x^2 + y^2 - 4\"\n"
         "[[constraint]]\nname = \"b\"\nholonomic = \"" +
         second + "\"\n[scene.default]\ninitial = { x = 1.2, y = 1.6 }\n";
}

void check_refused(const std::string& text, const char* message) {
  const std::string path = test::build_folder() + "/freedom.toml";
  test::write_text(path, text);
  try {
    pipeline::derive_model(test::model_at(path), pipeline::ApproachChoice::automatic);
    FAIL("accepted");
  } catch (const Error& error) {
    CHECK(error.message() == message);
    CHECK(error.where().line >= 11);  // the last constraint
    CHECK(error.exit_code() == 2);
  }
}

}  // namespace

TEST_CASE("freedom: as many constraints as coordinates leave nothing to integrate") {
  check_refused(
      planar("x*y - 1.92"),
      "there are as many constraints as coordinates: nothing is left to move, unless constraints repeat one another");
}

TEST_CASE("freedom: coordinates that are all prescribed leave nothing to integrate") {
  std::string text = planar("y - 1.6");
  text.replace(text.find("x^2 + y^2 - 4"), 13, "x - 1.2");
  check_refused(text, "the constraints fix every coordinate: nothing is left to move");
}

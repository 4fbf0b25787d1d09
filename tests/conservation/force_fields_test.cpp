// SPDX-License-Identifier: GPL-3.0-or-later
// Forces with and without a potential, against results derived by hand.
#include <doctest/doctest.h>

#include "conservation/conservative.hpp"

using namespace eomgen;

namespace {

struct One {
  model::Model model;
  mechanics::Mechanics m;
  conservation::ForceClassification found;
  One(const std::string& position, const std::string& force)
      : model(model::read_model_text("format = 1\n[parameters]\nm = 1\nk = 2\nL = 0.5\n[inputs]\nu = "
                                     "{}\n[[particle]]\nname = \"P\"\nmass = \"m\"\nposition = " +
                                         position + "\n[[force]]\n" + force,
                                     "field")),
        m(mechanics::build_mechanics(model)),
        found(conservation::classify_forces(m)[0]) {}
};

const std::string cartesian = "{ cartesian = [\"x\", \"y\"] }", polar = "{ cylindrical = [\"r\", \"theta\"] }";
std::string field(const std::string& force) { return "on = \"P\"\nforce = \"" + force + "\"\n"; }

}  // namespace

TEST_CASE("fields: forces with velocities and inputs have no potential") {
  CHECK(One(cartesian, field("-k*velocity(P)")).found.reason == "it depends on velocities");
  CHECK(One(cartesian, field("u*E1")).found.reason == "it depends on an input");
  CHECK(One(cartesian, field("u*E1")).found.conservative == conservation::ConservativeVerdict::no);
}

TEST_CASE("fields: dry friction has no potential, though no component of it is an applied force") {
  for (const char* law : {"static = 0.3, dynamic = 0.2", "dynamic = 0.2, law = \"smooth\", width = 0.01"}) {
    const One dry(cartesian, "dry = { coordinate = \"x\", normal = \"m\", " + std::string(law) + " }\n");
    CHECK(dry.found.conservative == conservation::ConservativeVerdict::no);
    CHECK(dry.found.reason == "it is friction");
    CHECK_FALSE(dry.found.potential.has_value());
  }
}

TEST_CASE("fields: a force along a circle does work on each turn, the same generalised force of an angle does not") {
  const One along(polar, field("k*P.e_theta"));  // curl k/r
  CHECK(along.found.conservative == conservation::ConservativeVerdict::no);
  CHECK_FALSE(along.found.many_valued);
  const One on_a_hoop("{ cylindrical = [\"L\", \"theta\"] }", field("k*cross(E3, unit(P))"));
  CHECK(on_a_hoop.found.conservative == conservation::ConservativeVerdict::no);
  CHECK(on_a_hoop.found.many_valued);
  const One moment(polar, "generalized = { theta = \"k\" }\n");
  CHECK(moment.found.conservative == conservation::ConservativeVerdict::yes);
  REQUIRE(moment.found.potential.has_value());
}

TEST_CASE("fields: a potential that exists without a closed form is reported; one that may not exist is unknown") {
  const One gauss("\"x*E1\"\n[coordinates]\nx = {}", field("exp(-x^2)*E1"));
  CHECK(gauss.found.conservative == conservation::ConservativeVerdict::yes);
  CHECK_FALSE(gauss.found.potential.has_value());
  CHECK(gauss.found.reason == "its potential was not found in closed form");
  const One kinked(cartesian, field("abs(x)*y*E1 + x*abs(x)/2*E2"));
  CHECK(kinked.found.conservative == conservation::ConservativeVerdict::unknown);
}

TEST_CASE("fields: a time-dependent field has a potential at each instant, and the energy changes") {
  const One moving(cartesian, field("-k*sin(t)*x*E1"));
  CHECK(moving.found.conservative == conservation::ConservativeVerdict::yes);
  CHECK(moving.found.reason == "it depends on time, so that it changes the energy all the same");
}

TEST_CASE("fields: a field with circulation about a point off the origin is many-valued") {
  const One off(cartesian, field("k*((x - L)*E2 - y*E1)/((x - L)^2 + y^2)"));
  CHECK(off.found.conservative == conservation::ConservativeVerdict::no);
  CHECK(off.found.many_valued);
  // A pair of opposite vortices: circles around one of them show it.
  const One pair(cartesian, field("k*((x - 1)*E2 - y*E1)/((x - 1)^2 + y^2) - k*((x + 1)*E2 - y*E1)/((x + 1)^2 + y^2)"));
  CHECK(pair.found.conservative != conservation::ConservativeVerdict::yes);
}

TEST_CASE("fields: a source has a logarithmic potential, which is single-valued") {
  const One source(cartesian, field("k*P/dot(P, P)"));
  CHECK(source.found.conservative == conservation::ConservativeVerdict::yes);
  CHECK(source.found.potential.has_value());
}

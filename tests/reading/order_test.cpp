// SPDX-License-Identifier: GPL-3.0-or-later
// The order of everything is our own: GiNaC's serial numbers, hashes and addresses have no effect.
#include <doctest/doctest.h>
#include <ginac/ginac.h>

#include <memory>

#include "reading/by_name.hpp"
#include "reading/ginac_bridge.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

// All results of a derivation, term by term in canonical order, as an expression of a fresh Dag.
std::size_t nodes_of(const reading::DisplayForm& form) {
  symbolic::Dag dag;
  std::size_t signature = 0;
  for (const reading::Equation& equation : form.equations) {
    for (const Sum& sum : {equation.momentum, equation.slope, equation.expanded, equation.force}) {
      signature = signature * 1000003 + reading::to_dag(dag, sum).id;
    }
  }
  return signature * 31 + dag.size();
}

}  // namespace

TEST_CASE("order: random serial numbers and heap addresses change nothing") {
  for (const char* name : {"P7_moving_sphere", "S5_spherical_double_pendulum", "P14_kepler_cartesian"}) {
    System s(model::read_model(shipped(name)));
    const std::size_t before = nodes_of(reading::derive_display_form(s.mechanics, system::Approach::one));
    std::vector<std::unique_ptr<char[]>> moved;
    for (unsigned round = 1; round <= 5; ++round) {
      for (unsigned i = 0; i < 37 * round; ++i) {
        GiNaC::symbol burnt;
        moved.push_back(std::make_unique<char[]>(24 + 16 * (i % 13)));
        if (i % 3 == 0) moved.back().reset();
      }
      System again(model::read_model(shipped(name)));
      CHECK(nodes_of(reading::derive_display_form(again.mechanics, system::Approach::one)) == before);
    }
  }
}

TEST_CASE("order: kinds first, then declaration") {
  System s(model::read_model(shipped("P7_moving_sphere")));
  const auto before = [&](const char* a, const char* b) {
    const Sum x = s.symbol(a), y = s.symbol(b);
    return reading::compare(*x.terms().begin()->first[0].atom, *y.terms().begin()->first[0].atom) < 0;
  };
  CHECK(before("m", "g"));  // parameters as declared
  CHECK(before("g", "d"));  // parameters, functions of time
  CHECK(before("d", "R"));  // functions of time, coordinates
  CHECK(before("R", "phi"));
  CHECK(before("theta", "d_dot"));  // positions, rates
  CHECK(before("d_dot", "R_dot"));
  CHECK(before("theta_dot", "R_ddot"));
  const Sum phi = s.symbol("phi"), theta_dot = s.symbol("theta_dot");
  CHECK(reading::compare(*sin(phi).terms().begin()->first[0].atom, *theta_dot.terms().begin()->first[0].atom) < 0);
}

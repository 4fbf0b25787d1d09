// SPDX-License-Identifier: GPL-3.0-or-later
// Derivatives of outputs and constraint forces against difference quotients.
#include <doctest/doctest.h>

#include <algorithm>

#include "program/abi_functions.hpp"
#include "program/systems.hpp"
#include "program/values.hpp"
#include "support/tolerances.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

using Numbers = std::vector<cln::cl_R>;
using Arguments = program::Arguments<cln::cl_R>;

constexpr int jacobian_digits = 60;

const program::Function& function(const program::Program& program, const std::string& name) {
  const auto found = std::find_if(program.functions.begin(), program.functions.end(),
                                  [&name](const program::Function& f) { return f.name == name; });
  REQUIRE(found != program.functions.end());
  return *found;
}

Numbers first(const program::Function& of, const Arguments& at) {
  return program::interpret(of, at, jacobian_digits).results[0];
}

/// Columns by difference quotients of a function, one for each of `count` entries of an argument.
Numbers differences(const program::Function& of, const Arguments& at, Numbers Arguments::*part, std::size_t count) {
  const cln::cl_R step = cln::expt(cln::cl_RA(10), -15);
  Numbers columns;
  for (std::size_t j = 0; j < count; ++j) {
    Arguments above = at, below = at;
    (above.*part)[j] = (above.*part)[j] + step;
    (below.*part)[j] = (below.*part)[j] - step;
    const Numbers high = first(of, above), low = first(of, below);
    for (std::size_t i = 0; i < high.size(); ++i) columns.push_back((high[i] - low[i]) / (2 * step));
  }
  return columns;
}

}  // namespace

TEST_CASE("value jacobians: they are slopes of outputs and constraint forces") {
  for (const auto& system : {double_pendulum(), cart_pendulum(), spherical_pendulum(), massless_coordinate()}) {
    const std::size_t states = 2 * system.free.size();
    CAPTURE(system.free.size());
    const auto at = arguments_at<cln::cl_R>(system, 1);
    for (const bool optimise : {false, true}) {
      CAPTURE(optimise);
      const program::Program built = build(
          system,
          {"reactions_jac", "reactions_jac_p", "reactions_jac_u", "outputs_jac", "outputs_jac_p", "outputs_jac_u"},
          optimise, true);
      for (const std::string of : {"outputs", "reactions"}) {
        CAPTURE(of);
        const program::Function& values = function(built, of);
        const std::size_t rows = values.results[0].entries.size();
        const auto columns = [&](const std::string& name) {
          return rows == 0 ? 0 : function(built, name).results[0].entries.size() / rows;
        };
        CHECK(columns(of + "_jac") == (rows == 0 ? 0 : states));
        for (const auto& [suffix, part] :
             {std::pair{"_jac", &Arguments::x}, {"_jac_p", &Arguments::p}, {"_jac_u", &Arguments::u}}) {
          CHECK(difference(first(function(built, of + suffix), at),
                           differences(values, at, part, columns(of + suffix))) < tolerances::difference_quotient);
        }
        auto later = at, before = at;
        const cln::cl_R step = cln::expt(cln::cl_RA(10), -15);
        later.t = later.t + step, before.t = before.t - step;
        Numbers slope = first(values, later);
        const Numbers low = first(values, before);
        for (std::size_t i = 0; i < slope.size(); ++i) slope[i] = (slope[i] - low[i]) / (2 * step);
        CHECK(difference(program::interpret(function(built, of + "_jac"), at, jacobian_digits).results[1], slope) <
              tolerances::difference_quotient);
      }
    }
  }
}

TEST_CASE("value jacobians: rows and columns have the same entries") {
  for (const auto& system : {double_pendulum(), cart_pendulum(), spherical_pendulum(), massless_coordinate()}) {
    program::AbiFunctions functions(system, {});
    std::vector<std::string> outputs;
    for (const auto& output : system.outputs) outputs.push_back(output.name);
    constexpr std::size_t parameters = 3;
    for (const char* name :
         {"outputs_jac", "outputs_jac_p", "reactions_jac", "reactions_jac_p", "momenta_jac", "momenta_jac_p"}) {
      CAPTURE(name);
      const auto entries = [&](program::Sweep sweep) {
        return expressions_at(*functions.system().dag,
                              functions.value_jacobian(name, outputs, parameters, sweep).results[0].entries, 1);
      };
      CHECK(difference(entries(program::Sweep::columns), entries(program::Sweep::rows)) < tolerances::same_value);
    }
  }
}

TEST_CASE("value jacobians: those of constraint forces need one factorisation, and come with the forces") {
  const auto system = spherical_pendulum();
  const program::Program built = build(system, {"reactions_jac"});
  CHECK(built.functions[1].name == "reactions");
  CHECK(built.functions[2].name == "reactions_jac");
  const program::Program with_momenta = build(system, {"momenta_jac"});
  CHECK(with_momenta.functions[1].name == "momenta");
  CHECK(with_momenta.functions[2].name == "momenta_jac");
  const program::Program with_jac = build(system, {"jac", "reactions_jac"});
  CHECK(function(with_jac, "reactions_jac").operations.div <= function(with_jac, "jac").operations.div + 1);
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Grouping of sines and cosines that are computed together.
#include <doctest/doctest.h>

#include "program/abi_functions.hpp"
#include "program/from_dag.hpp"
#include "program/systems.hpp"
#include "program/values.hpp"
#include "support/tolerances.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

program::Function written(const SystemBuilder& k, const std::vector<Scalar>& results) {
  program::FunctionExpressions wanted{"outputs", {{"y", {}}}, {}, {}};
  for (const Scalar& result : results) wanted.results[0].entries.push_back(result.ref);
  const program::PolynomialGraph graph = program::from_dag(*k.dag, wanted, {0, 1, 2});
  return program::schedule(program::flatten(graph, false), "outputs", {{"y", results.size()}});
}

std::vector<std::size_t> sizes(const program::Function& function) {
  std::vector<std::size_t> result;
  for (const auto& instruction : function.code) {
    if (instruction.pack == 0) continue;
    result.resize(std::max<std::size_t>(result.size(), instruction.pack));
    result[instruction.pack - 1] = std::max<std::size_t>(result[instruction.pack - 1], instruction.lane + 1);
  }
  return result;
}

/// Packs are contiguous and ordered. Lanes are numbered without gaps. Every angle is computed before its pack begins.
void well_formed(const program::Function& function) {
  std::uint32_t pack = 0, lane = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < function.code.size(); ++i) {
    const auto& instruction = function.code[i];
    if (instruction.pack == 0) continue;
    CHECK((instruction.op == Op::sin || instruction.op == Op::cos));
    if (instruction.pack != pack) {
      CHECK(instruction.pack == pack + 1);
      CHECK(instruction.lane == 0);
      first = i;
    } else {
      CHECK(function.code[i - 1].pack == pack);
      CHECK((instruction.lane == lane || instruction.lane == lane + 1));
      CHECK((instruction.lane == lane) == (instruction.operands[0] == function.code[i - 1].operands[0]));
    }
    pack = instruction.pack;
    lane = instruction.lane;
    CHECK((instruction.operands[0].slot != program::Slot::value || instruction.operands[0].index < first));
  }
}

}  // namespace

TEST_CASE("packs: all angles of state and time form one pack, whatever their sines are used for") {
  const SystemBuilder k;
  const auto function = written(k, {k.sin(k.q(0)) * k.cos(k.q(1) - k.q(0)), k.sin(k.p(0) * k.t()) / k.cos(k.q(0))});
  well_formed(function);
  CHECK(sizes(function) == std::vector<std::size_t>{3});
}

TEST_CASE("packs: angles that depend on sines form further packs") {
  const SystemBuilder k;
  const Scalar inner = k.sin(k.q(0)), other = k.cos(k.q(1));
  const auto function = written(k, {k.sin(inner + k.q(2)) + k.cos(other), k.sin(k.cos(inner) * k.q(1))});
  well_formed(function);
  CHECK(sizes(function) == std::vector<std::size_t>{2, 3});  // sin(cos(inner) q1) alone is last, without a pack
  std::size_t alone = 0;
  for (const auto& instruction : function.code) alone += instruction.op == Op::sin && instruction.pack == 0 ? 1 : 0;
  CHECK(alone == 1);
}

TEST_CASE("packs: a single angle uses the C library") {
  const SystemBuilder k;
  CHECK(sizes(written(k, {k.sin(k.q(0))})).empty());
  CHECK(sizes(written(k, {k.sin(k.q(0)) + k.q(1), k.cos(k.q(0))})).empty());
}

TEST_CASE("packs: the chain's right-hand side has its sines and cosines in one pack, and the same values") {
  const auto system = chain(6);
  const auto built = build(system, {"jac"});
  for (const auto& function : built.functions) {
    if (function.name == "prepare") continue;
    well_formed(function);
    CHECK(sizes(function) == std::vector<std::size_t>{6});
  }
}

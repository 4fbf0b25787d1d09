// SPDX-License-Identifier: GPL-3.0-or-later
// Machine code in memory against emitted C through the compiler: the same bits.
#include "jit/machine_code.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>

#include "emit/examples.hpp"
#include "jit/lanes.hpp"
#include "jit/random_programs.hpp"

using namespace eomgen;
using namespace test_systems;

namespace {

emit::CompiledModel compiled(const Example& e) {
  const auto files = emit::emit(e.program, e.context);
  return emit::compile_and_load(file_named(files, ".c"), file_named(files, ".h"), emit::mangled_id(e.context.id));
}

jit::MachineCode machine_code(const Example& e) {
  std::vector<double> inputs;
  for (const emit::Quantity& input : e.context.inputs) inputs.push_back(input.value);
  return {e.program, inputs};
}

bool same_bits(double a, double b) {
  // Which of several NaN a processor gives depends on the order of its operands, which is the compiler's.
  if (std::isnan(a) && std::isnan(b)) return true;
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// Result arrays of one call, and its code.
struct Called {
  int code = 0;
  std::array<std::vector<double>, 3> arrays;
};

Called call(const abi::CompiledFunctions& functions, const std::string& name, abi::CallArguments given,
            std::size_t room, bool without_second) {
  Called result;
  for (std::size_t r = 0; r < 3; ++r) {
    result.arrays[r].assign(room, 1.25);
    given.results[r] = r == 1 && without_second ? nullptr : result.arrays[r].data();
  }
  result.code = functions.call(name, given);
  return result;
}

std::size_t entries_of(const program::Program& program) {
  std::size_t most = 1;
  for (const program::Function& function : program.functions) {
    for (const auto& result : function.results) most = std::max(most, result.entries.size());
  }
  return most + 1;
}

/// Four states at once against each of them alone: the same bits, and another code if one of them has one.
void compare_lanes(const Example& e, const jit::MachineCode& direct, const std::vector<double>& x,
                   const abi::CallArguments& given) {
  if (!jit::has_lanes()) return;
  std::vector<double> inputs;
  for (const emit::Quantity& input : e.context.inputs) inputs.push_back(input.value);
  const std::size_t states = e.program.state_count();
  const auto four = [](const double* values, std::size_t count) {
    std::vector<double> list;
    for (std::size_t k = 0; k < count; ++k) list.insert(list.end(), jit::lane_width, values[k]);
    return list;
  };
  const std::vector<double> p = four(given.p, e.context.parameters.size()),
                            w = four(given.w, e.program.prepared_count()),
                            u = given.u != nullptr ? four(given.u, inputs.size()) : four(inputs.data(), inputs.size());
  std::vector<double> t(jit::lane_width), moved(4 * states), dx(4 * states), alone(states);
  for (const program::Function& function : e.program.functions) {
    if (function.name != "rhs" && function.name != "rhs_prepared") continue;
    const jit::LaneCode lanes(e.program, function, inputs);
    int worst = 0;
    for (std::size_t s = 0; s < 4; ++s) {
      t[s] = given.t + 0.1 * static_cast<double>(s);
      for (std::size_t k = 0; k < states; ++k) moved[4 * k + s] = x[k] * (1 + 0.2 * static_cast<double>(s));
    }
    const int together = lanes({t.data(), moved.data(), p.data(), w.data(), u.data(), dx.data()});
    std::vector<double> own(states);
    for (std::size_t s = 0; s < 4; ++s) {
      CAPTURE(s);
      for (std::size_t k = 0; k < states; ++k) own[k] = moved[4 * k + s];
      abi::CallArguments one = given;
      one.t = t[s], one.x = own.data(), one.mode = nullptr;
      one.results[0] = alone.data();
      const int code = direct.call(function.name, one);
      worst = std::max(worst, code);
      for (std::size_t k = 0; together == 0 && k < states; ++k) REQUIRE(same_bits(dx[4 * k + s], alone[k]));
    }
    REQUIRE((together == 0) == (worst == 0));
  }
}

/// Calls every function at random arguments in random modes. Returns the number of calls with code 0. `may_leave_out`:
/// some calls leave the inputs out. A compiler may compute functions of default inputs beforehand, and round them once.
int compare(const Example& e, std::uint64_t seed, int points, bool may_leave_out = false) {
  const emit::CompiledModel c = compiled(e);
  const jit::MachineCode direct = machine_code(e);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const std::array<double, 8> special{0.0, -0.0, 1.0, 65536.0, 70000.0, -3e5, infinity, std::nan("")};
  const std::size_t states = e.program.state_count(), room = entries_of(e.program);
  int done = 0;
  for (int point = 0; point < points; ++point) {
    const auto values = [&](std::size_t count) {
      std::vector<double> list(count);
      for (double& value : list) value = normal(random);
      if (point % 5 == 4 && count > 0) list[random() % count] = special.at(random() % special.size());
      return list;
    };
    const std::vector<double> x = values(states), p = values(e.context.parameters.size()),
                              u = values(e.context.inputs.size());
    std::vector<double> w(e.program.prepared_count() + 1, 0.0), w_direct = w;
    if (c.model.prepare != nullptr) {
      CHECK(c.model.prepare(p.data(), w.data()) == direct.prepare(p.data(), w_direct.data()));
      for (std::size_t i = 0; i < w.size(); ++i) CHECK(same_bits(w[i], w_direct[i]));
    }
    const eom::ModeLayout layout = e.program.mode_layout();
    std::vector<int> mode(layout.size());
    for (std::size_t k = 0; k < mode.size(); ++k)
      mode[k] = k < layout.contacts ? static_cast<int>(random() % 6) : static_cast<int>(random() % 3) - 1;
    abi::CallArguments given;
    given.t = normal(random);
    given.x = x.data();
    given.p = p.data();
    given.w = w.data();
    given.u = may_leave_out && point % 3 == 0 ? nullptr : u.data();
    given.mode = point % 2 == 0 ? nullptr : mode.data();
    compare_lanes(e, direct, x, given);
    for (const abi::Function& function : abi::functions()) {
      CHECK(c.model.has(function.name) == direct.has(function.name));
      if (!c.model.has(function.name) || function.name == "prepare") continue;
      CAPTURE(function.name);
      CAPTURE(point);
      const bool without_second = function.name == "jac" && point % 2 == 1;
      const Called a = call(c.model, function.name, given, room, without_second);
      const Called b = call(direct, function.name, given, room, without_second);
      REQUIRE(a.code == b.code);
      done += a.code == 0 ? 1 : 0;
      for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t i = 0; i < room; ++i) {
          CAPTURE(i);
          CAPTURE(b.arrays[r][i] - a.arrays[r][i]);
          REQUIRE(same_bits(a.arrays[r][i], b.arrays[r][i]));
        }
      }
    }
  }
  return done;
}

}  // namespace

TEST_CASE("machine code has the bits of compiled C: pendulums, constraints, forces and Jacobians") {
  if (!jit::refusal().empty()) return;
  for (const Example& e : examples()) {
    CAPTURE(e.context.id);
    CHECK(compare(e, 1, 60, true) > 100);
  }
}

TEST_CASE("machine code has the bits of compiled C for every operation, operand, mode and test") {
  if (!jit::refusal().empty()) return;
  int done = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    CAPTURE(seed);
    done += compare(random_example(seed, 300), seed, 200);
  }
  CHECK(done > 500);
}

TEST_CASE("machine code has the bits of compiled C where the C is cut into parts") {
  if (!jit::refusal().empty()) return;
  CHECK(compare(random_example(77, 4000), 3, 40) > 20);
}

TEST_CASE("machine code: a result array may be an argument array") {
  if (!jit::refusal().empty()) return;
  for (const Example& e : examples()) {
    CAPTURE(e.context.id);
    const jit::MachineCode code = machine_code(e);
    const emit::TestVector& at = e.context.tests.front();
    std::vector<double> x = at.x, dx(x.size());
    CHECK(code.rhs(at.t, x.data(), at.p.data(), nullptr, 0, dx.data()) == 0);
    CHECK(code.rhs(at.t, x.data(), at.p.data(), nullptr, 0, x.data()) == 0);
    CHECK(x == dx);
  }
}

TEST_CASE("machine code is generated in a time that grows with the number of operations, 2 microseconds each") {
  if (!jit::refusal().empty()) return;
  const Example e = random_example(5, 10000);
  double best = 1e9;
  for (int repetition = 0; repetition < 3; ++repetition) {
    const auto start = std::chrono::steady_clock::now();
    const jit::MachineCode code = machine_code(e);
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    CHECK(code.bytes() > 10000);
  }
  MESSAGE("seconds for 10 000 operations: ", best);
  CHECK(best < 0.5);  // mostly 0.01; a slow machine under load must not fail, a quadratic time would
}

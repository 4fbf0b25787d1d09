// SPDX-License-Identifier: GPL-3.0-or-later
// The target javascript computes the same values as the C code of the same program.
#include <doctest/doctest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "emit/shared_library/process.hpp"
#include "emit/write_files.hpp"
#include "support/simulation.hpp"
#include "support/temporary_folder.hpp"

using namespace eomgen;
using namespace eomgen::test;

namespace {

using Json = nlohmann::ordered_json;

constexpr double allowed = 1e-12;  // of the largest entry of an array

/// Of every function the values that the compiled C has at the points of the self test.
Json values_of_c(const abi::CompiledFunctions& c, const program::Program& program,
                 const emit::EmissionContext& context) {
  Json calls = Json::array();
  for (const emit::TestVector& at : context.tests) {
    for (const program::Function& function : program.functions) {
      std::vector<std::vector<double>> y;
      for (const program::Result& result : function.results) {
        if (!result.is_test()) y.emplace_back(result.entries.size());
      }
      y.resize(3);
      double *const a = y[0].data(), *const b = y[1].data(), *const d = y[2].data();
      const int* const mode = at.mode.empty() ? nullptr : at.mode.data();
      const double *const x = at.x.data(), *const p = at.p.data(), *const u = at.u.empty() ? nullptr : at.u.data();
      int code = -1;
      if (function.name == "rhs") code = c.rhs(at.t, x, p, u, mode, a);
      if (function.name == "jac") code = c.jac(at.t, x, p, u, mode, a, b);
      if (function.name == "mass") code = c.mass(at.t, x, p, a, b);
      if (function.name == "constraints") code = c.constraints(at.t, x, p, a, b, d);
      if (function.name == "outputs") code = c.outputs(at.t, x, p, u, mode, a);
      if (function.name == "events") code = c.events(at.t, x, p, u, mode, a);
      if (code < 0) continue;
      calls.push_back({{"name", function.name},
                       {"t", at.t},
                       {"x", at.x},
                       {"p", at.p},
                       {"u", at.u},
                       {"mode", at.mode},
                       {"code", code},
                       {"y", y}});
    }
  }
  return calls;
}

// Prints for each model how far off it is: the largest difference over the largest entry of an array; 1 where codes
// differ.
const char* const comparison = R"("use strict";
const fs = require("fs");
for (const {file, calls} of JSON.parse(fs.readFileSync("calls.json"))) {
  const m = require("./" + file);
  let off = m.selftest() === 0 ? 0 : 2;
  for (const c of calls) {
    const y = c.y.map((array) => new Float64Array(array.length)), u = c.u.length > 0 ? c.u : null;
    const of_state = c.name === "mass" || c.name === "constraints";
    const code = of_state ? m[c.name](c.t, c.x, c.p, ...y) : m[c.name](c.t, c.x, c.p, u, c.mode.length > 0 ? c.mode : null, ...y);
    if (code !== c.code) off = 1;
    if (code !== 0) continue;
    c.y.forEach((array, r) => {
      const largest = Math.max(1e-300, ...array.map(Math.abs));
      array.forEach((value, i) => { if (!(Math.abs(value - y[r][i]) <= off * largest)) off = Math.abs(value - y[r][i]) / largest || 1; });
    });
  }
  console.log(file, off);
}
)";

}  // namespace

TEST_CASE(
    "javascript: every function gives what the C of the same program gives, of points, bodies, loops, kinks, contacts "
    "and chains") {
  if (emit::run_process({"node", "--version"}).status != 0) {
    MESSAGE("skipped: there is no node");
    return;
  }
  const TemporaryFolder folder;
  Json all = Json::array();
  std::vector<emit::EmittedFile> files{{"compare.js", comparison}};
  for (const char* name :
       {"P2_planar_pendulum", "P4_moving_cone", "P7_moving_sphere", "P14_kepler_spherical",
        "S5_double_pendulum_cartesian", "S6_chain_6", "R1_free_body_euler_parameters", "R6_rolling_disk",
        "R6_rough_disk", "R10_lagrange_top", "R15_ball_joint", "R18_rodrigues", "bilinear_oscillator", "cart_pendulum",
        "knife_edge", "six_bar_spatial", "n_four_bar_2", "stick_slip_belt"}) {
    CAPTURE(name);
    const auto derived = pipeline::derive_model(test::model_at(model_path(name)), pipeline::ApproachChoice::automatic);
    program::Request request;
    request.with = {"jac", "mass", "constraints", "events"};
    request.outputs = {"energy", "kinetic"};
    const program::Program program = pipeline::make_program(*derived, request);
    const run::Scene scene =
        run::resolve_scene(derived->mechanics, derived->candidates.front(), derived->model.scene("default"), {});
    const emit::EmissionContext context = pipeline::emission_context(*derived, program, scene, {});
    const pipeline::CompiledCode code = pipeline::compile(program, context);
    files.push_back(emit::emit(program, context, "javascript").front());
    all.push_back({{"file", files.back().name}, {"calls", values_of_c(code.functions(), program, context)}});
    CHECK(all.back()["calls"].size() >= 6);
  }
  files.push_back({"calls.json", all.dump()});
  emit::write_files(folder.path, files);
  const emit::ProcessResult finished = emit::run_process({"sh", "-c", "cd '" + folder.path + "' && node compare.js"});
  CAPTURE(finished.output);
  REQUIRE(finished.status == 0);
  std::istringstream lines(finished.output);
  std::string file;
  double off = 0;
  std::size_t count = 0;
  for (; lines >> file >> off; ++count) CHECK_MESSAGE(off <= allowed, file);
  CHECK(count == all.size());
}

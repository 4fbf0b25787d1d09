// SPDX-License-Identifier: GPL-3.0-or-later
// run --tier: with and without a C compiler.
#include <doctest/doctest.h>

#include "program.hpp"

using namespace eomgen::test;

namespace {

/// Whether this build has machine code in memory; without, it is refused by name.
bool has_machine_code(const Folder& folder) {
  const ChildResult result = eomgen::test::eomgen(folder, {"run", "P2_planar_pendulum", "--tier", "jit"});
  if (result.status == 0) return true;
  CHECK(result.status == 4);
  CHECK(contains(result.err, "there is no machine code in memory: "));
  CHECK(contains(result.err, "--tier compiled"));
  return false;
}

}  // namespace

TEST_CASE("--tier jit: a run needs no program beside eomgen, and its table has the bytes of compiled code") {
  const Folder folder;
  if (!has_machine_code(folder)) return;
  for (const char* model : {"P2_planar_pendulum", "R3_rough_incline", "quarter_car"}) {
    ChildCommand call = command(folder, {"run", model, "--tier", "jit", "--out", "jit.csv", "--json"});
    call.environment["PATH"] = "/nonexistent";
    call.environment["EOMGEN_CACHE_DIR"] = folder / "cache";
    const ChildResult result = run_child(call);
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
    const Json run = Json::parse(result.out);
    CHECK(run["tier"] == "jit");
    CHECK(run["compiled"] == "never");
    const Json compiled = document(folder, {"run", model, "--tier", "compiled", "--out", "compiled.csv"});
    CHECK(compiled["tier"] == "compiled");
    CHECK(compiled["tier_reason"] == "asked for");
    CHECK(folder.read("jit.csv") == folder.read("compiled.csv"));
    CHECK(run["final"] == compiled["final"]);
  }
}

TEST_CASE("without --tier a run needs no compiler, and many fixed steps take it where it pays") {
  const Folder folder;
  if (!has_machine_code(folder)) return;
  ChildCommand call = command(folder, {"run", "P2_planar_pendulum", "--json"});
  call.environment["EOMGEN_CC"] = "/nonexistent";
  call.environment["EOMGEN_CACHE_DIR"] = folder / "cache";
  const ChildResult result = run_child(call);
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  CHECK(Json::parse(result.out)["tier"] == "jit");
  call.arguments.insert(call.arguments.end(), {"--step", "1e-10", "--max-steps", "1000"});
  const ChildResult long_run = run_child(call);
  CAPTURE(long_run.err);
  CHECK(long_run.status == 3);
  const Json document = Json::parse(long_run.out);
  CHECK(document["tier"] == "jit");
  CHECK(contains(document["tier_reason"], "the C compiler `/nonexistent` does not run"));
  call.arguments.insert(call.arguments.end(), {"--tier", "compiled"});
  const ChildResult compiled = run_child(call);
  CHECK(compiled.status == 4);
  CHECK(contains(compiled.err, "the C compiler `/nonexistent` does not run"));
}

TEST_CASE("--tier: an unknown name is refused with the known ones") {
  const Folder folder;
  const ChildResult result = expect(2, folder, {"run", "P2_planar_pendulum", "--tier", "fast"});
  CHECK(contains(result.err, "there is no tier 'fast'"));
  CHECK(contains(result.err, "jit"));
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Batch evaluation of shipped models in every mode of their contacts and kinks. tests/emit/batch_harness.c compares
// each state of a batch with a separate evaluation.
#include <doctest/doctest.h>

#include "program.hpp"

using namespace eomgen::test;

TEST_CASE(
    "batch: states have the same bits and codes as in separate evaluations, in all modes, with inputs, next to "
    "singular states") {
  const Folder folder;
  struct Case {
    const char *model, *modes;
  };
  std::string width = "2";
  Words flags;
#if defined(__x86_64__) && defined(__GNUC__)
  if (__builtin_cpu_supports("avx512f"))
    flags = {"-mavx512f"}, width = "8";
  else if (__builtin_cpu_supports("avx2"))
    flags = {"-mavx2", "-DEOM_BATCH_LANES=4"}, width = "4";
#endif
  for (const Case& c : {Case{"P8_rough_helix", "{1}, {2}, {3}, {4}, {5}"}, Case{"stick_slip_belt", "{1}, {2}"},
                        Case{"bilinear_oscillator", "{1}, {-1}"}, Case{"bouncing_ball", "{1}, {3}"},
                        Case{"cart_pendulum", "{0}"}, Case{"S5_spherical_double_pendulum", "{0}"},
                        Case{"R1_free_body_euler_parameters", "{0}"}, Case{"P14_kepler_spherical", "{0}"}}) {
    const std::string name = c.model;
    CAPTURE(name);
    expect(0, folder, {"emit", name, "-o", ".", "--target", "batch", "--with", "events", "--output", "energy"});
    const std::string header = folder.read(name + "_batch.h");
    Words words{"gcc",
                "-std=gnu11",
                "-O1",
                "-ffp-contract=off",
                "-Wall",
                "-Wextra",
                "-Wpedantic",
                "-Wshadow",
                "-Wconversion",
                "-Werror",
                "-o",
                name,
                "-I.",
                "-DNAME=" + name,
                "-DHEADER=\"" + name + "_batch.h\"",
                "-DWIDTH=" + width,
                "-DMODES=" + std::string(c.modes)};
    words.insert(words.end(), flags.begin(), flags.end());
    for (const auto& [function, define] : {std::pair{"_prepare_batch(", "-DPREPARED"},
                                           {"_outputs_batch(", "-DOUTPUTS"},
                                           {"_events_batch(", "-DEVENTS"}}) {
      if (contains(header, name + function)) words.emplace_back(define);
    }
    words.insert(words.end(), {EOMGEN_TEST_HARNESS, name + ".c", name + "_batch.c", "-lm"});
    const ChildResult compiled = run_child({words, folder.path()});
    CAPTURE(compiled.err);
    REQUIRE(compiled.status == 0);
    const ChildResult found = run_child({{folder / name}, folder.path()});
    CAPTURE(found.out);
    CHECK(found.status == 0);  // otherwise the line of the harness that failed
  }
}

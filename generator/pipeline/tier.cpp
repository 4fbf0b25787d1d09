// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/tier.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "emit/shared_library/build.hpp"
#include "error.hpp"
#include "jit/machine_code.hpp"
#include "model/names.hpp"

namespace eomgen::pipeline {
namespace {

// The compiler takes as long as this many evaluations of the code are faster for it. Measured in docs/benchmarks.md:
// 0.35 ms an instruction for the compiler, 0.04 ns an instruction and evaluation saved.
constexpr double evaluations_that_pay = 1e7;
constexpr double evaluations_per_step = 4;  // of rk4, the method of fixed steps

std::size_t instructions(const program::Program& program) {
  std::size_t count = 0;
  for (const program::Function& function : program.functions) count += function.code.size();
  return count;
}

}  // namespace

std::vector<std::string> tier_names() { return {"auto", "jit", "compiled"}; }

std::string name(Tier tier) { return tier_names()[static_cast<std::size_t>(tier)]; }

Tier parse_tier(const std::string& text) {
  const std::vector<std::string> names = tier_names();
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end())
    throw Error("cli", {}, fmt::format("there is no tier {}", model::quote(text)), model::suggest_choice(text, names));
  return static_cast<Tier>(found - names.begin());
}

TierChoice choose_tier(Tier asked, const program::Program& program, double steps) {
  const std::string refusal = jit::refusal();
  if (asked == Tier::jit && !refusal.empty()) {
    throw Error("run", {}, "there is no machine code in memory: " + refusal, "--tier compiled uses the C compiler",
                ErrorKind::tool);
  }
  if (asked != Tier::automatic) return {asked, "asked for", true};
  if (!refusal.empty()) return {Tier::compiled, "no machine code in memory: " + refusal, false};
  const program::Function& rhs = program.functions.front();
  const double work = steps * evaluations_per_step * static_cast<double>(rhs.code.size());
  const double cost = evaluations_that_pay * static_cast<double>(instructions(program));
  if (work > cost) {
    const std::string no_compiler = emit::compiler_refusal();
    if (!no_compiler.empty())
      return {Tier::jit, fmt::format("{:.0f} steps, for which compiled code is faster, but {}", steps, no_compiler),
              false};
    return {Tier::compiled, fmt::format("{:.0f} steps: the compiler takes less time than its code saves", steps),
            false};
  }
  return {Tier::jit, "no compiler needed", false};
}

}  // namespace eomgen::pipeline

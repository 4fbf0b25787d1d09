// SPDX-License-Identifier: GPL-3.0-or-later
#include "eomgen/rhs_lanes.hpp"

#include <mutex>

#include "eomgen/call.hpp"
#include "eomgen/prepared_runs.hpp"

namespace eomgen {
namespace {

std::vector<double> in_lanes(const double* values, std::size_t count) {
  std::vector<double> result;
  result.reserve(jit::lane_width * count);
  for (std::size_t k = 0; k < count; ++k) result.insert(result.end(), jit::lane_width, values[k]);
  return result;
}

}  // namespace

const jit::LaneCode* RhsLanes::find(const PreparedRun& run, bool prepared) const {
  if (!is_made_.load(std::memory_order_acquire)) {
    // Code of a compiler may have been asked for where no memory may become executable.
    if (!jit::has_lanes() || run.compilation->code.tier() != pipeline::Tier::jit) return nullptr;
    const std::unique_lock lock(library_mutex(), std::try_to_lock);
    if (!lock) return nullptr;
    if (!is_made_.load(std::memory_order_relaxed)) {
      const program::Program& program = run.compilation->program;
      for (const program::Function& function : program.functions) {
        if (function.name == "rhs")
          codes_.rhs = std::make_unique<jit::LaneCode>(program, function, std::vector<double>());
        if (function.name == "rhs_prepared")
          codes_.rhs_prepared = std::make_unique<jit::LaneCode>(program, function, std::vector<double>());
      }
      is_made_.store(true, std::memory_order_release);
    }
  }
  const jit::LaneCode* const code = prepared ? codes_.rhs_prepared.get() : codes_.rhs.get();
  return code != nullptr && code->is_faster() ? code : nullptr;
}

LaneBatch::LaneBatch(const jit::LaneCode& code, std::size_t states, const double* p, std::size_t p_count,
                     const double* w, std::size_t w_count, const double* u, std::size_t u_count)
    : code_(code),
      states_(states),
      x_(most_groups * jit::lane_width * states),
      p_(in_lanes(p, p_count)),
      w_(in_lanes(w, w != nullptr ? w_count : 0)),
      u_(in_lanes(u, u_count)),
      dx_(jit::lane_width * states) {}

std::uint32_t LaneBatch::evaluate(std::size_t groups, const double* t, const double* x, double* dx) {
  constexpr std::size_t width = jit::lane_width;
  const std::size_t group_size = width * states_;
  for (std::size_t g = 0; g < groups; ++g) {
    const double* const from = x + g * group_size;
    double* const to = x_.data() + g * group_size;
    for (std::size_t k = 0; k < states_; ++k) {
      for (std::size_t s = 0; s < width; ++s) to[width * k + s] = from[states_ * s + k];
    }
  }
  std::uint32_t failed = 0;
  for (std::size_t g = 0; g < groups; ++g) {
    const double* const own = x_.data() + g * group_size;
    if (code_({t + g * width, own, p_.data(), w_.data(), u_.data(), dx_.data()}) != 0) {
      failed |= std::uint32_t{1} << g;
      continue;
    }
    double* const to = dx + g * group_size;
    for (std::size_t s = 0; s < width; ++s) {
      for (std::size_t k = 0; k < states_; ++k) to[states_ * s + k] = dx_[width * k + s];
    }
  }
  return failed;
}

}  // namespace eomgen

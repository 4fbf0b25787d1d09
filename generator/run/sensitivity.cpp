// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/sensitivity.hpp"

#include <fmt/format.h>

#include <eom/error_estimate.hpp>
#include <eom/ode.hpp>

#include "run/derivative_run.hpp"
#include "run/lost_rank.hpp"
#include "run/variational.hpp"

namespace eomgen::run {
Sensitivities integrate_sensitivities(const RunRequest& request, const RunResult& motion,
                                      const std::vector<Direction>& directions, bool estimate) {
  require_derivatives(request, motion);
  Sensitivities result;
  result.solver = derivative_solver(motion.solver);
  const eom::Options options = derivative_options(request, result.solver);
  VariationalRun run(request, motion, result.solver, directions);
  const eom::Result end = run(options);
  result.outcome = end.outcome;
  result.t = motion.t;
  result.statistics = end.statistics;
  if (end.outcome != eom::Outcome::done) {
    require_bounded(request, motion, end.outcome, end.t);
    return result;
  }
  const std::size_t n = request.state_names.size(), all = directions.size();
  for (std::size_t d = 0; d < all; ++d) {
    result.list.push_back({directions[d].name, {}, 0, {}, 0});
    Sensitivity& s = result.list.back();
    for (std::size_t i = 0; i < n; ++i) s.value.push_back(end.x[(d + 1) * n + i] / directions[d].scale);
    s.of_time = end.x[(all + 1) * n + d] / directions[d].scale;
  }
  const EndComparison comparison(request, motion, end.x);
  if (!estimate && comparison.agrees({})) return result;
  const eom::ErrorEstimate error = eom::estimate_error(get_method(result.solver).order, request.scene.t0, end, options,
                                                       [&run](const eom::Options& tighter) { return run(tighter); });
  comparison.require(error.x);
  if (!estimate) return result;
  for (std::size_t d = 0; d < all; ++d) {
    Sensitivity& s = result.list[d];
    for (std::size_t i = 0; i < n; ++i) s.error.push_back(error.x[(d + 1) * n + i] / directions[d].scale);
    s.error_of_time = error.x[(all + 1) * n + d] / directions[d].scale;
  }
  if (error.outcome != eom::Outcome::done)
    result.estimate_note =
        fmt::format("a tighter run ended with '{}'; the estimate is not to be trusted", eom::name(error.outcome));
  return result;
}

}  // namespace eomgen::run

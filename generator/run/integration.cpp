// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/integration.hpp"

#include <algorithm>
#include <cmath>

namespace eomgen::run {

Integration::Integration(const RunRequest& request, std::string solver)
    : request_(request),
      code_(request.code),
      solver_(std::move(solver)),
      n_(request.code.free.size()),
      energy_(index_of(request.code.output_names, "energy")),
      u_(std::max<std::size_t>(1, request.scene.inputs.size())),
      y_(request.code.output_names.size()),
      rows_(request),
      projection_(n_, rows_.size(), rows_.on_positions()) {
  // Before the first piece starts: just inside it, so that a table gives its value right of t0.
  side_ = std::nextafter(request.scene.t0, request.scene.t1);
  // A code of prepare is told by rhs, which is asked then.
  if (code_.prepare != nullptr) w_.resize(code_.prepared);
  if (code_.prepare != nullptr && code_.prepare(request.scene.parameters.data(), w_.data()) != 0) w_.clear();
  if (request.watch_power) power_ = index_of(request.code.output_names, "power");
}

std::vector<double> Integration::initial_state() const {
  std::vector<double> x;
  for (const std::uint32_t i : code_.free) x.push_back(request_.scene.q[i]);
  for (const std::uint32_t i : code_.free) x.push_back(request_.scene.qdot[i]);
  x.insert(x.end(), code_.integrals, 0.0);
  if (request_.watch_power) x.push_back(0);  // the work done since the start
  return x;
}

const double* Integration::inputs(double t) const {
  for (std::size_t i = 0; i < request_.scene.inputs.size(); ++i) u_[i] = request_.scene.inputs[i](t, side_);
  return u_.data();
}

int Integration::rhs(double t, const double* x, double* dx) {
  const double* u = inputs(t);
  const double* p = request_.scene.parameters.data();
  const int code = w_.empty() ? code_.rhs(t, x, p, u, 0, dx) : code_.rhs_prepared(t, x, p, w_.data(), u, 0, dx);
  if (code != 0 || !request_.watch_power) return code;
  const int watched = code_.outputs(t, x, request_.scene.parameters.data(), u, 0, y_.data());
  dx[2 * n_ + code_.integrals] = y_[power_];
  return watched;
}

int Integration::outputs(double t, const double* x, std::span<double> y) const {
  return code_.outputs(t, x, request_.scene.parameters.data(), inputs(t), 0, y.data());
}

int Integration::project(double t, double* x) {
  const double* p = request_.scene.parameters.data();
  outputs(t, x, y_);
  const double before = y_[energy_];
  const eom::ProjectionResult moved = projection_(
      t, x,
      [&](double at, const double* state, double* psi, double* A, double* b) {
        return rows_(at, state, inputs(at), psi, A, b);
      },
      [&](double at, const double* state, double* M, double* h) { return code_.mass(at, state, p, M, h); });
  if (moved.code != 0) return moved.code;
  outputs(t, x, y_);
  position_correction = std::max(position_correction, moved.position_correction);
  velocity_correction = std::max(velocity_correction, moved.velocity_correction);
  work += y_[energy_] - before;
  return 0;
}

eom::Result Integration::run(const eom::Options& options, const Observer& observer) {
  position_correction = velocity_correction = work = 0;
  std::vector<double> restarts;
  for (const Signal& signal : request_.scene.inputs) {
    for (const double t : signal.jumps()) {
      if (t > request_.scene.t0 && t < request_.scene.t1) restarts.push_back(t);
    }
  }
  std::sort(restarts.begin(), restarts.end());
  restarts.erase(std::unique(restarts.begin(), restarts.end()), restarts.end());
  restarts.push_back(request_.scene.t1);

  eom::Options piece = options;
  piece.quadratures = request_.watch_power ? 1 : 0;
  eom::Result total;
  total.x = initial_state();
  total.t = request_.scene.t0;
  rows_.start(total.t, total.x.data(), inputs(total.t));
  const auto f = [this](double t, const double* x, double* dx) { return rhs(t, x, dx); };
  const auto watch = [&](const eom::StepView& step) { return !observer || observer(step); };
  const auto after = [this](double t, double* x) { return rows_.size() == 0 ? 0 : project(t, x); };
  for (const double end : restarts) {
    side_ = (total.t + end) / 2;
    const eom::Result part = eom::integrate(solver_, f, total.t, total.x, end, piece, watch, after);
    total.outcome = part.outcome;
    total.detail = part.detail;
    total.t = part.t;
    total.x = part.x;
    total.statistics.steps += part.statistics.steps;
    total.statistics.rejected += part.statistics.rejected;
    total.statistics.rhs_evaluations += part.statistics.rhs_evaluations;
    total.statistics.dense_fallbacks += part.statistics.dense_fallbacks;
    if (part.outcome != eom::Outcome::done) break;
  }
  return total;
}

}  // namespace eomgen::run

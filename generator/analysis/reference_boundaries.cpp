// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/reference_boundaries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/hybrid/samples.hpp>
#include <utility>

#include "bench/bench.hpp"
#include "error.hpp"
#include "lists.hpp"
#include "numeric/elimination.hpp"
#include "numeric/numbers.hpp"
#include "symbolic/calculus.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::analysis {

using cln::cl_F;
using cln::cl_R;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

ImpulseInDigits::ImpulseInDigits(const system::EquationSystem& system, const std::vector<double>& parameters)
    : system_(system), parameters_(parameters) {
  symbolic::Dag& dag = *system.dag;
  const Ref lagrangian = dag.sub(system.kinetic, system.potential);
  for (const std::uint32_t q : system.free)
    momenta_.push_back(symbolic::partial_derivative(dag, {SymbolKind::coordinate, q, 1})(lagrangian));
}

std::vector<cl_R> ImpulseInDigits::values(const std::vector<Ref>& roots, const cl_R& t, const std::vector<double>& u,
                                          const std::vector<cl_F>& x, int digits) const {
  const std::size_t n = system_.free.size();
  const auto at = [&](const Symbol& symbol) -> cl_R {
    switch (symbol.kind) {
      case SymbolKind::time: return t;
      case SymbolKind::parameter: return numeric::exact(parameters_[symbol.index]);
      case SymbolKind::input: return numeric::exact(u[symbol.index]);
      case SymbolKind::branch: return 0;
      case SymbolKind::coordinate: {
        const auto place = std::find(system_.free.begin(), system_.free.end(), symbol.index) - system_.free.begin();
        return x.at(static_cast<std::size_t>(place) + (symbol.order == 1 ? n : 0));
      }
      case SymbolKind::state:
      case SymbolKind::integral:
        for (std::size_t i = 0; i < system_.states.size(); ++i) {
          if (system_.states[i].symbol == symbol) return x.at(system_.layout().first_order_begin() + i);
        }
        break;
      default: break;
    }
    throw Error("bench", {}, "an impulse depends on a quantity that has no value in many digits",
                "shorten the run (--t-end) to before it", ErrorKind::numerical);
  };
  return symbolic::evaluate(*system_.dag, roots, at, digits);
}

void ImpulseInDigits::apply(const Kink& kink, std::vector<cl_F>& x, int digits) const {
  std::vector<cl_R> impulse = values(momenta_, numeric::exact(kink.before), kink.u_before, x, digits);
  const std::vector<cl_R> behind = values(momenta_, numeric::exact(kink.behind), kink.u_behind, x, digits);
  for (std::size_t i = 0; i < impulse.size(); ++i) impulse[i] = impulse[i] - behind[i];
  change(impulse, numeric::exact(kink.behind), kink.u_behind, x, digits);
}

void ImpulseInDigits::make_consistent(const cl_R& t, const std::vector<double>& u, std::vector<cl_F>& x,
                                      int digits) const {
  if (!system_.active.empty()) change(std::vector<cl_R>(system_.free.size(), 0), t, u, x, digits);
}

void ImpulseInDigits::change(const std::vector<cl_R>& impulse, const cl_R& t, const std::vector<double>& u,
                             std::vector<cl_F>& x, int digits) const {
  const std::size_t n = system_.free.size(), m = system_.active.size();
  const std::vector<cl_R> M = values(system_.M, t, u, x, digits), A = values(system_.A, t, u, x, digits),
                          b = values(system_.b, t, u, x, digits);
  // (M  -A^T) (qdot+ - qdot-)   (impulse       )
  // (A   0  ) (   Lambda     ) = (-b+ - A qdot- )
  numeric::Matrix<cl_R> K(n + m, n + m), right(n + m, 1);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) K(i, j) = M[i * n + j];
    right(i, 0) = impulse[i];
  }
  for (std::size_t k = 0; k < m; ++k) {
    right(n + k, 0) = -b[k];
    for (std::size_t j = 0; j < n; ++j) {
      K(n + k, j) = A[k * n + j];
      K(j, n + k) = -A[k * n + j];
      right(n + k, 0) = right(n + k, 0) - A[k * n + j] * x[n + j];
    }
  }
  const numeric::Elimination<cl_R> factors(std::move(K), 0);
  if (factors.rank() < n + m) {
    throw Error("bench", {}, "an impulse is not determined: the constraints depend on one another there",
                "shorten the run (--t-end) to before it", ErrorKind::numerical);
  }
  const numeric::Matrix<cl_R> change = factors.solve(right);
  for (std::size_t i = 0; i < n; ++i) x[n + i] = x[n + i] + cln::cl_float(change(i, 0), cln::float_format(x[n + i]));
}

ResetsInDigits::ResetsInDigits(const program::Program& program, const system::EquationSystem& system,
                               const ImpulseInDigits& impulses, const run::RunRequest& request)
    : system_(system), impulses_(impulses), request_(request) {
  for (const program::Function& function : program.functions) {
    if (function.name == "events") events_ = &function;
    if (function.name == "resets") resets_ = &function;
  }
}

cl_F ResetsInDigits::event_value(std::size_t event, const Point& at) const { return values(*events_, at)[event]; }

void ResetsInDigits::apply_event(std::size_t event, Point& at) const {
  apply(request_.events[event].reset, request_.events[event].name, at);
}

void ResetsInDigits::apply_sample(std::size_t sample, std::int64_t k, Point& at) const {
  const eom::hybrid::Sample& taken = request_.samples[sample];
  for (const eom::hybrid::Noise& noise : taken.noise)
    at.x[noise.component] =
        cln::cl_float(numeric::exact(eom::hybrid::random_number(noise, k)), cln::float_format(at.t));
  apply(taken.reset, taken.name, at);
}

std::vector<cl_F> ResetsInDigits::values(const program::Function& function, const Point& at) const {
  program::Arguments<cl_R> arguments;
  arguments.t = at.t;
  arguments.x.assign(at.x.begin(), at.x.end());
  for (const double p : request_.scene.parameters) arguments.p.push_back(numeric::exact(p));
  for (const double u : at.u) arguments.u.push_back(numeric::exact(u));
  std::vector<cl_F> result;
  const program::Values<cl_R> found = program::interpret(function, arguments, at.digits);
  for (const cl_R& value : found.results[0]) result.push_back(cln::cl_float(value, cln::float_format(at.t)));
  return result;
}

void ResetsInDigits::apply(const eom::hybrid::Reset& reset, const std::string& name, Point& at) const {
  if (reset.set.empty()) return;
  const std::vector<cl_F> r = values(*resets_, at);
  if (reset.condition && cln::zerop(r[*reset.condition])) return;
  const std::size_t n = system_.free.size();
  bool moves = false;
  for (const eom::hybrid::Reset::Entry& entry : reset.set) {
    if (entry.component < n && !system_.active.empty())
      throw Error("bench", {}, fmt::format("'{}' moves coordinates that are subject to constraints", name),
                  "eomgen run gives an error_estimate");
    moves = moves || entry.component < system_.layout().first_order_begin();
    at.x[entry.component] = r[entry.value];
  }
  if (moves) impulses_.make_consistent(at.t, at.u, at.x, at.digits);
}

namespace {

constexpr double trial_agreement = 1e-5;  // of the ends of the reference and of the run that it follows

}  // namespace

void refuse_reference(const std::string& what, const std::string& remedy) {
  throw Error("bench", {}, "there is no reference for this scene: " + what, remedy);
}

ReferenceBoundaries::ReferenceBoundaries(const program::Program& program, const system::EquationSystem& system,
                                         const run::RunRequest& request, ReferenceTrial trial)
    : trial_(std::move(trial)),
      impulse_(system, request.scene.parameters),
      resets_(program, system, impulse_, request),
      request_(request) {}

bool ReferenceBoundaries::has_impulse(double t) const {
  return std::find(trial_.impulses.begin(), trial_.impulses.end(), t) != trial_.impulses.end();
}

std::vector<reference::InputSegment> ReferenceBoundaries::segments(double begin,
                                                                   const std::vector<eom::hybrid::Segment>& kinks) {
  add_boundary(begin, false);
  double from = begin;
  for (const auto& [end, next, step] : kinks) {
    const std::vector<double> u = inputs_at((from + end) / 2);
    while (next_ < trial_.changes.size() && trial_.changes[next_].t < end) {
      const StateChange& change = trial_.changes[next_];
      if (change.kind == StateChange::Kind::sample || change.t <= from) refuse_order(change);
      add_segment({change.t, u, change.t, change.index});
      from = change.t;
      add_boundary(change.t, true);
    }
    add_segment({end, u, next});
    if (next < request_.scene.t1 || next != end) add_boundary(next, has_impulse(next));
    from = next;
  }
  for (; next_ < trial_.changes.size();) refuse_order(trial_.changes[next_]);
  return segments_;
}

void ReferenceBoundaries::change(std::size_t boundary, const cln::cl_F& t, std::vector<cln::cl_F>& x,
                                 int digits) const {
  if (boundary > 0) {
    const ImpulseInDigits::Kink& kink = kinks_[boundary - 1];
    if (has_impulse(std::min(kink.behind, request_.scene.t1))) impulse_.apply(kink, x, digits);
  }
  if (boundary >= changes_.size() || changes_[boundary].empty()) return;
  const std::vector<double>& u =
      boundary < segments_.size() ? segments_[boundary].u : segments_.back().u;  // of the segment that follows
  ResetsInDigits::Point at{t, u, std::move(x), digits};
  for (const StateChange& made : changes_[boundary]) {
    if (made.kind == StateChange::Kind::event)
      resets_.apply_event(made.index, at);
    else
      resets_.apply_sample(made.index, made.k, at);
  }
  x = std::move(at.x);
}

cln::cl_F ReferenceBoundaries::event_value(std::size_t segment, const cln::cl_F& t, const std::vector<cln::cl_F>& x,
                                           int digits) const {
  return resets_.event_value(segments_[segment].event.value(), {t, segments_[segment].u, x, digits});
}

void ReferenceBoundaries::require_same_end(const reference::Solution& reference) const {
  if (trial_.changes.empty()) return;
  const std::vector<double> scales = bench::component_scales(reference);
  for (std::size_t i = 0; i < scales.size(); ++i) {
    if (!(std::abs(trial_.x[i] - reference.x.back()[i]) <= trial_agreement * scales[i]))
      throw Error("bench", {},
                  fmt::format("the reference ends at {} = {}, and the run that it follows at {}: its events are "
                              "others, or the motion is chaotic",
                              request_.state_names[i], reference.x.back()[i], trial_.x[i]),
                  "shorten the run (--t-end)", ErrorKind::numerical);
  }
}

void ReferenceBoundaries::add_boundary(double t, bool caused) {
  changes_.emplace_back();
  for (; next_ < trial_.changes.size() && trial_.changes[next_].t == t; ++next_) {
    const StateChange& change = trial_.changes[next_];
    caused = caused || change.kind == StateChange::Kind::sample;
    if (!caused) refuse_order(change);
    changes_.back().push_back(change);
  }
}

void ReferenceBoundaries::add_segment(reference::InputSegment segment) {
  if (!kinks_.empty()) kinks_.back().u_behind = segment.u;
  kinks_.push_back({segment.until, segment.next, segment.u, segment.u});
  segments_.push_back(std::move(segment));
}

void ReferenceBoundaries::refuse_order(const StateChange& change) const {
  const std::string& name = change.kind == StateChange::Kind::event ? request_.events[change.index].name
                                                                    : request_.samples[change.index].name;
  refuse_reference(
      fmt::format("'{}' at t = {} is too close to the end or to another change of the state", name, change.t),
      "eomgen run gives an error_estimate");
}

std::vector<double> ReferenceBoundaries::inputs_at(double t) const {
  return mapped(request_.scene.inputs, [&](const run::Signal& signal) { return signal(t, t); });
}

}  // namespace eomgen::analysis

// SPDX-License-Identifier: MIT
// Many runs of one right-hand side at once. In: derivatives of many states, the start of each member. Out: the end of
// each member, bitwise equal to that of integrate(), for any number of lanes and threads.
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "eom/ensemble/block.hpp"
#include "eom/ensemble/events.hpp"
#include "eom/ensemble/explicit_lanes.hpp"
#include "eom/ensemble/rosenbrock_lanes.hpp"
#include "eom/ensemble/series_lanes.hpp"
#include "eom/ensemble/threads.hpp"
#include "eom/ode.hpp"
#include "eom/registry.hpp"

namespace eom {
namespace ensemble {

inline void check(const EnsembleOptions& options, std::size_t states) {
  if (states == 0 || options.quadratures >= states)
    throw std::invalid_argument("eom::integrate_ensemble: no component of the state is left for the control of steps");
  if (!(options.rtol >= 0) || !(options.atol >= 0) || (!(options.fixed_step > 0) && options.rtol + options.atol == 0) ||
      !(options.max_step > 0) || !(options.initial_step >= 0) || !(options.fixed_step >= 0))
    throw std::invalid_argument(
        "eom::integrate_ensemble: tolerances and steps must not be negative, nor both tolerances 0");
}

/// Integrates in lanes if the method of this name supports them; else returns false. make_watch() -> Unwatched,
/// EventMonitor.
template <class Rhs, class Start, class Done, class MakeWatch>
bool integrate_in_lanes(std::string_view method, Rhs& rhs, std::size_t members, std::size_t states,
                        std::size_t parameters, const EnsembleOptions& options, Start& start, Done& done,
                        const MakeWatch& make_watch) {
  using Watch = decltype(make_watch());
  const auto by = [&]<class T>(T*) {
    if constexpr (requires { typename LanesOf<T, Rhs, Watch::dense>::type; }) {
      using Chosen = LanesOf<T, Rhs, Watch::dense>;
      if (method != T::name || !Chosen::supports(options)) return false;
      if (!eom::detail::is_adaptive<T>() && !(options.fixed_step > 0))
        throw std::invalid_argument("eom::integrate_ensemble: " + std::string(method) +
                                    " needs EnsembleOptions::fixed_step");
      run_in_threads(options.threads, members, [&](const auto& next) {
        Watch watch = make_watch();
        Block<typename Chosen::type, decltype(next), Start, Done, Watch>(rhs, states, parameters, options, next, start,
                                                                         done, watch)
            .run();
      });
      return true;
    }
    return false;
  };
  return eom::detail::any_method(by);
}

/// Whether this method integrates members of such a right-hand side side by side.
template <class Rhs>
bool has_lanes(std::string_view method, const EnsembleOptions& options) {
  return eom::detail::any_method([&]<class T>(T*) {
    if constexpr (requires { typename LanesOf<T, Rhs, false>::type; })
      return method == T::name && LanesOf<T, Rhs, false>::supports(options);
    return false;
  });
}

/// Integrates one member after the other in each thread, by any method, if lanes are not supported.
template <class Rhs, class Start, class Done>
void integrate_one_by_one(std::string_view method, Rhs& rhs, std::size_t members, std::size_t states,
                          std::size_t parameters, const EnsembleOptions& options, Start& start, Done& done) {
  run_in_threads(options.threads, members, [&](const auto& next) {
    const Options same = options_of(options);
    std::vector<double> x(states), p(parameters);
    for (std::size_t member = 0; next(member);) {
      if (options.interrupt != nullptr && options.interrupt->load(std::memory_order_relaxed)) return;
      EnsembleStart at{0, 0, x, p};
      start(member, at);
      auto one = rhs.member_rhs(member, p.data());
      const Result end = integrate(method, system_of(one), at.t0, x, at.t1, same);
      done(EnsembleEnd{member, end.outcome, end.t, end.x, p, end.statistics});
    }
  });
}

}  // namespace ensemble

/// Integrates `members` runs. rhs: as EnsembleRhs; start(member, EnsembleStart&) writes x, p, t0, t1; done(const
/// EnsembleEnd&) receives each end, in no particular order. `threads` threads call all three at once. Explicit
/// Runge-Kutta methods integrate many members side by side. So does `rodas` if rhs has jacobian()
/// (rosenbrock_lanes.hpp), and `taylor` if it has taylor() (series_lanes.hpp). Other methods integrate them one by one
/// in each thread if rhs.member_rhs(member, p) returns the right-hand side of one member. Throws std::invalid_argument
/// for any other method, and for invalid options.
template <class Rhs, class Start, class Done>
void integrate_ensemble(std::string_view method, Rhs&& rhs, std::size_t members, std::size_t states,
                        std::size_t parameters, const EnsembleOptions& options, Start&& start, Done&& done) {
  ensemble::check(options, states);
  if (ensemble::integrate_in_lanes(method, rhs, members, states, parameters, options, start, done,
                                   [] { return ensemble::Unwatched{}; }))
    return;
  if constexpr (requires(const double* p) { rhs.member_rhs(std::size_t{}, p); })
    return ensemble::integrate_one_by_one(method, rhs, members, states, parameters, options, start, done);
  throw std::invalid_argument("eom::integrate_ensemble: " + std::string(method) +
                              " cannot integrate members of this right-hand side side by side, and one by one it needs "
                              "member_rhs()");
}

/// The same with events, for methods that integrate members side by side. The result of rhs.member_rhs(member, p) also
/// has events(t, x, values) -> code, with as many values as there are `functions`. The callback (member, const
/// EventPoint&) receives each crossing, from several threads at once. A breaking one ends the member as
/// stopped_by_event.
template <class Rhs, class OnCrossing, class Start, class Done>
void integrate_ensemble_events(std::string_view method, Rhs&& rhs, std::size_t members, std::size_t states,
                               std::size_t parameters, const EnsembleOptions& options,
                               std::span<const EventFunction> functions, OnCrossing&& on_crossing, Start&& start,
                               Done&& done) {
  ensemble::check(options, states);
  const auto member_rhs = [&rhs](std::size_t member, const double* p) { return rhs.member_rhs(member, p); };
  const auto watch = [&] {
    return ensemble::EventMonitor(method, member_rhs, functions, on_crossing, options, ensemble::slots_of(options));
  };
  if (!ensemble::integrate_in_lanes(method, rhs, members, states, parameters, options, start, done, watch))
    throw std::invalid_argument("eom::integrate_ensemble_events: " + std::string(method) +
                                " cannot integrate members of this right-hand side side by side");
}

}  // namespace eom

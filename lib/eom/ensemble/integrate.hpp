// SPDX-License-Identifier: MIT
// Many runs of one right-hand side at once. In: derivatives of many states, where each member starts. Out: where each
// ends, with the bits that integrate() gives it alone, whatever the number of lanes and threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "eom/ensemble/block.hpp"
#include "eom/registry.hpp"

namespace eom {
namespace ensemble {

/// Members from one counter; what one of the threads throws is thrown here when all have ended.
template <class T, class Rhs, class Start, class Done>
void by_threads(Rhs& rhs, std::size_t members, std::size_t states, std::size_t parameters,
                const EnsembleOptions& options, Start& start, Done& done) {
  std::atomic<std::size_t> counter{0};
  std::exception_ptr thrown;
  std::mutex lock;
  const auto work = [&] {
    try {
      const auto next = [&](std::size_t& member) {
        return (member = counter.fetch_add(1, std::memory_order_relaxed)) < members;
      };
      Block<T, Rhs, decltype(next), Start, Done>(rhs, states, parameters, options, next, start, done).run();
    } catch (...) {
      const std::lock_guard<std::mutex> guard(lock);
      if (!thrown) thrown = std::current_exception();
      counter = members;
    }
  };
  const std::size_t asked = options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  const std::size_t threads = std::max<std::size_t>(1, std::min(asked, members));
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < threads; ++i) others.emplace_back(work);
  work();
  for (std::thread& thread : others) thread.join();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace ensemble

/// Integrates `members` runs by an explicit Runge-Kutta method. rhs: as EnsembleRhs; start(member, EnsembleStart&)
/// writes x, p, t0, t1; done(const EnsembleEnd&) sees each end, in no particular order. All three are called from
/// `threads` threads at once. Throws std::invalid_argument for a method that is none of them, and for options that make
/// no sense.
template <class Rhs, class Start, class Done>
void integrate_ensemble(std::string_view method, Rhs&& rhs, std::size_t members, std::size_t states,
                        std::size_t parameters, const EnsembleOptions& options, Start&& start, Done&& done) {
  const bool fixed = options.fixed_step > 0;
  if (states == 0 || options.quadratures >= states)
    throw std::invalid_argument(
        "eom::integrate_ensemble: there is no component of the state that steps could be chosen by");
  if (!(options.rtol >= 0) || !(options.atol >= 0) || (!fixed && options.rtol + options.atol == 0) ||
      !(options.max_step > 0) || !(options.initial_step >= 0) || !(options.fixed_step >= 0))
    throw std::invalid_argument(
        "eom::integrate_ensemble: tolerances and steps must not be negative, nor both tolerances 0");
  const auto run = [&]<class T>(T*) {
    if constexpr (explicit_rk::Tableau<T>) {
      if (method != T::name) return false;
      if (T::error.empty() && !fixed)
        throw std::invalid_argument("eom::integrate_ensemble: " + std::string(method) +
                                    " needs EnsembleOptions::fixed_step");
      ensemble::by_threads<T>(rhs, members, states, parameters, options, start, done);
      return true;
    }
    return false;
  };
  const bool known = [&]<class... T>(std::tuple<T...>*) {
    return (run(static_cast<T*>(nullptr)) || ...);
  }(static_cast<Registry*>(nullptr));
  if (!known)
    throw std::invalid_argument("eom::integrate_ensemble: " + std::string(method) +
                                " is no explicit Runge-Kutta method");
}

}  // namespace eom

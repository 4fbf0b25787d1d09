// SPDX-License-Identifier: MIT
// Distribution of members to threads by a shared counter. In: the number of members, the work of each thread. An
// exception of a thread is rethrown in the caller after all threads have ended.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace eom::ensemble {

/// Runs work(next) in each of `threads` threads (0: one per processor). next(member&) -> bool returns the next member.
template <class Work>
void run_in_threads(std::size_t threads, std::size_t members, const Work& work) {
  std::atomic<std::size_t> counter{0};
  std::exception_ptr thrown;
  std::mutex lock;
  const auto run = [&] {
    try {
      const auto next = [&](std::size_t& member) {
        return (member = counter.fetch_add(1, std::memory_order_relaxed)) < members;
      };
      work(next);
    } catch (...) {
      const std::lock_guard<std::mutex> guard(lock);
      if (!thrown) thrown = std::current_exception();
      counter = members;
    }
  };
  const std::size_t asked = threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
  const std::size_t count = std::max<std::size_t>(1, std::min(asked, members));
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < count; ++i) others.emplace_back(run);
  run();
  for (std::thread& thread : others) thread.join();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace eom::ensemble

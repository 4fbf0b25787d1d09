// SPDX-License-Identifier: GPL-3.0-or-later
// Group of processes, possibly on several hosts, that computes one sweep. The leader distributes runs in blocks; it
// computes runs only if it is alone. Each worker stores its rows in a file of its own. All processes together write the
// table.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace eomgen::cli {

/// A range of consecutive runs of the table.
struct RunRange {
  std::uint64_t first = 0, count = 0;
};

class ProcessGroup {
 public:
  virtual ~ProcessGroup() = default;
  virtual std::size_t rank() const = 0;
  virtual std::size_t size() const = 0;
  bool is_leader() const { return rank() == 0; }
  std::size_t workers() const { return size() > 1 ? size() - 1 : 1; }

  /// Leader: lets the workers start, after all checks have passed. `run`: the run they prepare with; nullopt: no work.
  virtual void start_workers(std::optional<std::uint64_t> run) = 0;
  /// Workers: the argument of start_workers().
  virtual std::optional<std::uint64_t> first_run() const = 0;
  /// Calls `work` in one process of each host, then in the others, which find the compiled code in the cache.
  virtual void run_once_per_host(const std::function<void()>& work) = 0;

  /// Leader: answers requests of workers until `open` is exhausted or `stop` is set. Blocks have at least `least` runs.
  virtual void distribute(std::vector<RunRange> open, std::uint64_t least, const std::atomic<bool>& stop) = 0;
  /// Worker: requests the next block; nullopt if there is none.
  virtual std::optional<RunRange> next_block() = 0;

  /// Sum over all processes.
  virtual std::uint64_t sum(std::uint64_t of_this_one) = 0;

  struct TableSegment {
    RunRange where;
    std::uint64_t bytes = 0;
  };
  /// Writes the pieces of all processes in the order of the table to the leader's `path`, from offset `begin`. Returns
  /// the same result in all processes: "" or the error.
  virtual std::string write(const std::string& path, std::uint64_t begin, const std::vector<TableSegment>& pieces,
                            const std::function<std::string(std::size_t piece)>& text) = 0;
  /// Waits for all processes. Afterwards they are independent.
  virtual void release() = 0;
};

}  // namespace eomgen::cli

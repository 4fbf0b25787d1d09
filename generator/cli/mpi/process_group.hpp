// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <mpi.h>

#include "cli/sweep/process_group.hpp"

namespace eomgen::cli {

/// All processes of MPI_COMM_WORLD. A waiting process sleeps between polls, so there may be more processes than cores.
class MpiProcessGroup : public ProcessGroup {
 public:
  MpiProcessGroup(int& argc, char**& argv);
  ~MpiProcessGroup() override;
  MpiProcessGroup(const MpiProcessGroup&) = delete;
  MpiProcessGroup& operator=(const MpiProcessGroup&) = delete;

  /// Workers: waits for the leader and returns whether there will be work.
  bool await_start();
  /// Ends this process with an exit code. Aborts all processes if others still depend on this one.
  void leave(int code);

  std::size_t rank() const override { return static_cast<std::size_t>(rank_); }
  std::size_t size() const override { return static_cast<std::size_t>(size_); }
  void start_workers(std::optional<std::uint64_t> run) override;
  std::optional<std::uint64_t> first_run() const override;
  void run_once_per_host(const std::function<void()>& work) override;
  void distribute(std::vector<RunRange> open, std::uint64_t least, const std::atomic<bool>& stop) override;
  std::optional<RunRange> next_block() override;
  std::uint64_t sum(std::uint64_t of_this_one) override;
  std::string write(const std::string& path, std::uint64_t begin, const std::vector<TableSegment>& pieces,
                    const std::function<std::string(std::size_t)>& text) override;
  void release() override;

 private:
  enum class Phase : std::uint64_t { waiting, stop, nothing, work };
  void broadcast(Phase phase, std::uint64_t run);
  std::vector<std::uint64_t> offsets(std::uint64_t begin, const std::vector<TableSegment>& pieces);
  std::string agreed(const std::string& why);

  int rank_ = 0, size_ = 1;
  MPI_Comm machine_ = MPI_COMM_NULL;
  Phase phase_ = Phase::waiting;
  std::uint64_t run_ = 0;
  bool released_ = false;
};

}  // namespace eomgen::cli

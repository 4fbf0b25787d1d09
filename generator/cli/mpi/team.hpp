// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <mpi.h>

#include "cli/sweep/team.hpp"

namespace eomgen::cli {

/// All processes of MPI_COMM_WORLD. A waiting process sleeps between polls, so there may be more processes than cores.
class MpiTeam : public Team {
 public:
  MpiTeam(int& argc, char**& argv);
  ~MpiTeam() override;
  MpiTeam(const MpiTeam&) = delete;
  MpiTeam& operator=(const MpiTeam&) = delete;

  /// Workers: waits for the leader and returns whether there will be work.
  bool await_go();
  /// Ends this process with an exit code. Aborts all processes if others still depend on this one.
  void leave(int code);

  std::size_t rank() const override { return static_cast<std::size_t>(rank_); }
  std::size_t size() const override { return static_cast<std::size_t>(size_); }
  void go(std::optional<std::uint64_t> run) override;
  std::optional<std::uint64_t> gone() const override;
  void one_by_machine(const std::function<void()>& work) override;
  void hand_out(std::vector<Stretch> open, std::uint64_t least, const std::atomic<bool>& stop) override;
  std::optional<Stretch> next() override;
  std::uint64_t sum(std::uint64_t of_this_one) override;
  std::string write(const std::string& path, std::uint64_t begin, const std::vector<Piece>& pieces,
                    const std::function<std::string(std::size_t)>& text) override;
  void part() override;

 private:
  enum class Phase : std::uint64_t { waiting, stop, nothing, work };
  void tell(Phase phase, std::uint64_t run);
  std::vector<std::uint64_t> offsets(std::uint64_t begin, const std::vector<Piece>& pieces);
  std::string agreed(const std::string& why);

  int rank_ = 0, size_ = 1;
  MPI_Comm machine_ = MPI_COMM_NULL;
  Phase phase_ = Phase::waiting;
  std::uint64_t run_ = 0;
  bool parted_ = false;
};

}  // namespace eomgen::cli

// SPDX-License-Identifier: GPL-3.0-or-later
// A sweep: determines its runs, computes the missing ones, and writes a row for each. In: options. Out: the table.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/interrupt.hpp"
#include "cli/sweep/checkpoint_file.hpp"
#include "cli/sweep/options.hpp"
#include "cli/sweep/points.hpp"
#include "cli/sweep/row_text.hpp"
#include "cli/sweep/statistics.hpp"
#include "cli/sweep/team.hpp"
#include "pipeline/ensemble.hpp"
#include "pipeline/simulate.hpp"

namespace eomgen::cli {

class Sweep {
 public:
  /// Throws Error for inconsistent options.
  Sweep(const SweepOptions& options, const Common& common, const model::Model& model);

  /// Computes the missing runs, together with the other processes if there are any. Returns whether the table is
  /// complete.
  bool run() { return team_ != nullptr ? run_by_team() : run_alone(); }

  /// Number of runs of this shard.
  std::size_t runs() const { return shard_.size(points_.size()); }
  std::size_t resumed() const { return resumed_; }
  /// Path of the file that contains the rows.
  const std::string& place() const { return checkpoint_.place(); }
  struct Counts {
    std::size_t done = 0, failed = 0;
  };
  /// Valid after run(). In a group of processes the first one has the counts of all.
  const Counts& counts() const { return counts_; }
  /// Statistics of the existing rows. In a group of processes: of all rows, or empty if the table is incomplete.
  std::vector<analysis::ColumnStatistics> statistics() const;
  /// Statistics of the basins of attraction, over the same rows; nullopt if the table is incomplete.
  std::optional<analysis::Basins> basins() const;

 private:
  void each_row(const std::function<void(std::string_view row)>& take) const;
  bool run_alone();
  bool run_by_team();
  void make_open_runs();
  void write_by_team();
  std::vector<Stretch> open_runs() const;
  /// Compiles the code and determines the columns from the first open run that can start, otherwise from any run that
  /// can. Returns that run, or nullopt on interruption.
  std::optional<std::size_t> prepare(const std::vector<Stretch>& open);
  bool simulate_first(std::size_t run, bool integrate);
  std::size_t first_that_begins(const std::vector<Stretch>& open);
  /// Adds the row of the run that prepare() returned and removes the run from `open`.
  void take_first(std::size_t run, std::vector<Stretch>& open);
  bool is_open(const std::vector<Stretch>& open, std::size_t run) const;
  std::vector<std::size_t> runs_of(const std::vector<Stretch>& stretches) const;
  void compute(const std::vector<std::size_t>& runs, std::size_t threads);
  void make_here(const std::vector<Stretch>& stretches, std::size_t threads);
  void compute_here(const std::vector<std::size_t>& runs);
  void count();

  run::Overrides at(std::size_t run) const;
  std::string made(std::size_t run) const;

  const SweepOptions& options_;
  std::uint64_t seed_;
  std::string points_hash_;  // of the file of --points
  analysis::Points points_;
  analysis::Shard shard_;
  std::string file_;
  CheckpointFile checkpoint_;
  std::size_t resumed_;
  Counts counts_;
  Team* team_;
  RowText text_;
  std::string solver_;  // of the ensemble
  std::optional<Interrupt> interrupt_;
  std::optional<pipeline::Simulation> first_;
  std::optional<pipeline::Ensemble> ensemble_;
};

}  // namespace eomgen::cli

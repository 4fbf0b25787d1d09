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
#include "cli/sweep/process_group.hpp"
#include "cli/sweep/row_formatter.hpp"
#include "cli/sweep/statistics.hpp"
#include "pipeline/ensemble.hpp"
#include "pipeline/simulate.hpp"

namespace eomgen::cli {

class Sweep {
 public:
  /// Throws Error for inconsistent options.
  Sweep(const SweepOptions& options, const CommonOptions& common, const model::Model& model);

  /// Computes the missing runs, together with the other processes if there are any. Returns whether the table is
  /// complete.
  bool run() { return group_ != nullptr ? run_in_group() : run_alone(); }

  /// Number of runs of this shard.
  std::size_t runs() const { return shard_.size(points_.size()); }
  std::size_t resumed() const { return resumed_; }
  /// Path of the file that contains the rows.
  const std::string& path() const { return checkpoint_.path(); }
  struct Counts {
    std::size_t done = 0, failed = 0;
  };
  /// Valid after run(). In a group of processes the first one has the counts of all.
  const Counts& counts() const { return counts_; }
  /// Statistics of the existing rows. In a group of processes: of all rows, or empty if the table is incomplete.
  std::vector<analysis::ColumnStatistics> statistics() const;
  /// Statistics of the basins of attraction, over the same rows; nullopt if the table is incomplete.
  std::optional<analysis::BasinStatistics> basins() const;

 private:
  void for_each_row(const std::function<void(std::string_view row)>& take) const;
  bool run_alone();
  bool run_in_group();
  void make_open_runs();
  void write_table_in_group();
  std::vector<RunRange> open_runs() const;
  /// Compiles the code and determines the columns from the first open run that can start, otherwise from any run that
  /// can. Returns that run, or nullopt on interruption.
  std::optional<std::size_t> prepare(const std::vector<RunRange>& open);
  bool simulate_first(std::size_t run, bool integrate);
  std::size_t first_that_begins(const std::vector<RunRange>& open);
  /// Adds the row of the run that prepare() returned and removes the run from `open`.
  void take_first(std::size_t run, std::vector<RunRange>& open);
  bool is_open(const std::vector<RunRange>& open, std::size_t run) const;
  std::vector<std::size_t> runs_of(const std::vector<RunRange>& stretches) const;
  void compute(const std::vector<std::size_t>& runs, std::size_t threads);
  void make_here(const std::vector<RunRange>& stretches, std::size_t threads);
  void compute_here(const std::vector<std::size_t>& runs);
  void count();

  run::Overrides overrides_of_run(std::size_t run) const;
  std::string compute_row(std::size_t run) const;

  const SweepOptions& options_;
  run::Overrides overrides_;  // of every run, besides its point
  eom::EstimateCost estimate_cost_;
  std::uint64_t seed_;
  std::string points_hash_;  // of the file of --points
  analysis::SweepPoints points_;
  analysis::Shard shard_;
  std::string file_;
  CheckpointFile checkpoint_;
  std::size_t resumed_;
  Counts counts_;
  ProcessGroup* group_;
  RowFormatter text_;
  std::string solver_;  // of the ensemble
  std::optional<InterruptGuard> interrupt_;
  std::optional<pipeline::Simulation> first_;
  std::optional<pipeline::Ensemble> ensemble_;
};

}  // namespace eomgen::cli

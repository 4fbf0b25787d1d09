// SPDX-License-Identifier: GPL-3.0-or-later
// A sweep: which runs there are, which of them are open, how each becomes a row of the table. In: what was asked. Out: the table.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/command.hpp"
#include "cli/interrupt.hpp"
#include "cli/simulate.hpp"
#include "cli/sweep/ensemble.hpp"
#include "cli/sweep/ledger.hpp"
#include "cli/sweep/options.hpp"
#include "cli/sweep/points.hpp"
#include "cli/sweep/statistics.hpp"

namespace eomgen::cli {

class Sweep {
 public:
  /// Throws Error for what makes no sense.
  Sweep(const SweepOptions& options, const Common& common, const model::Model& model);

  /// Makes the runs that are open. Whether all are there now.
  bool run();

  std::size_t runs() const { return shard_.size(points_.size()); }
  std::size_t resumed() const { return resumed_; }
  /// Where the rows are.
  const std::string& place() const { return ledger_.place(); }
  struct Counts {
    std::size_t done = 0, failed = 0;
  };
  Counts counts() const;
  std::vector<ColumnStatistics> statistics() const;

 private:
  std::vector<std::size_t> open_runs() const;
  /// Code, columns, and the row of one of the open runs, which is not open any more. False where an interruption came first.
  bool prepare(std::vector<std::size_t>& open);
  bool simulate_first(std::size_t run, bool integrate);
  std::size_t first_that_begins(const std::vector<std::size_t>& open);
  void compute(const std::vector<std::size_t>& runs);

  run::Overrides at(std::size_t run) const;
  void columns(const run::Scene& scene);
  std::string beginning(std::size_t run) const;
  std::string refusal(std::size_t run, const std::string& why) const;
  std::string row(std::size_t run, const run::RunResult& result) const;
  std::string made(std::size_t run) const;

  const SweepOptions& options_;
  std::uint64_t seed_;
  Points points_;
  Shard shard_;
  std::string file_;
  Ledger ledger_;
  std::size_t resumed_;
  std::vector<std::string> names_;
  std::string solver_;  // of an ensemble
  std::optional<Interrupt> interrupt_;
  std::optional<Simulation> first_;
  std::optional<Ensemble> ensemble_;
};

}  // namespace eomgen::cli

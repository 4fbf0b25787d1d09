// SPDX-License-Identifier: GPL-3.0-or-later
// A sweep by several processes: the leader takes over existing rows, prepares and distributes the runs. The workers
// compute rows. All processes write the table.
#include <eom/output/atomic_file.hpp>
#include <system_error>

#include "cli/output.hpp"
#include "cli/sweep/sweep.hpp"

namespace eomgen::cli {
namespace {

constexpr std::uint64_t least_of_ensemble = 256;  // runs per block and thread, so that SIMD lanes are mostly full
constexpr std::size_t rows_of_request = 1 << 16;  // written in one request

}  // namespace

bool Sweep::run_in_group() {
  const std::size_t threads = options_.jobs > 0 ? options_.jobs : 1;
  if (group_->is_leader()) {
    checkpoint_.require_file();
    if (!options_.ensemble && options_.jobs > 1)
      throw Error("sweep", {}, "--jobs are threads of an ensemble here, and there is none",
                  "start more processes, or add --ensemble");
    std::vector<RunRange> open = open_runs();
    std::optional<std::size_t> first;
    if (!open.empty()) {
      first = prepare(open);
      if (!first) return false;  // interrupted: leaving notifies the workers
      take_first(*first, open);
      if (options_.ensemble && !open.empty()) ensemble_.emplace(*first_);
    }
    group_->start_workers(first);
    if (first) {
      group_->run_once_per_host([] {});
      if (group_->size() == 1)
        make_here(open, threads);
      else
        group_->distribute(open, options_.ensemble ? least_of_ensemble * threads : 1, InterruptGuard::flag());
    }
  } else if (const std::optional<std::uint64_t> first = group_->first_run()) {
    group_->run_once_per_host([&] {
      simulate_first(*first, false);
      if (options_.ensemble) ensemble_.emplace(*first_);
    });
    while (const std::optional<RunRange> block = group_->next_block()) make_here({*block}, threads);
  }
  checkpoint_.sort();
  const bool all = group_->sum(checkpoint_.rows().size()) == runs();
  count();
  counts_ = {static_cast<std::size_t>(group_->sum(counts_.done)),
             static_cast<std::size_t>(group_->sum(counts_.failed))};
  if (all) write_table_in_group();
  group_->release();
  return all;
}

void Sweep::make_here(const std::vector<RunRange>& stretches, std::size_t threads) {
  const std::vector<std::size_t> runs = runs_of(stretches);
  if (options_.ensemble)
    compute(runs, threads);
  else
    compute_here(runs);
}

void Sweep::write_table_in_group() {
  if (group_->sum(checkpoint_.open() ? 1 : 0) == 0) return;  // the table is complete
  const Rows& rows = checkpoint_.rows();
  struct Part {
    std::size_t first, last;
  };
  std::vector<Part> parts;
  std::vector<ProcessGroup::TableSegment> pieces;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool follows =
        i > 0 && rows.run(i) == rows.run(i - 1) + shard_.count && i - parts.back().first < rows_of_request;
    if (!follows) {
      parts.push_back({i, i});
      pieces.push_back({{rows.run(i), 0}, 0});
    }
    parts.back().last = i + 1;
    ++pieces.back().where.count;
    pieces.back().bytes += rows.length(i) + 1;
  }
  const auto text = [&](std::size_t piece) {
    std::string lines;
    rows.for_each(parts[piece].first, parts[piece].last,
                  [&lines](std::size_t, std::string_view line) { lines.append(line) += '\n'; });
    return lines;
  };
  std::optional<eom::AtomicFile> table;
  const std::string beginning = checkpoint_.file_header();
  const auto lost = [&table](const std::string& why) {
    if (table) table->discard();
    throw Error("sweep", {}, why,
                "see to space on that disk and to your rights there; the same command goes on from what is there",
                ErrorKind::tool);
  };
  try {
    if (group_->is_leader()) {
      table.emplace(file_);
      table->write(beginning);
    }
    const std::string why = group_->write(table ? table->partial() : "", beginning.size(), pieces, text);
    if (table && !why.empty()) lost(why);  // the others wait below until this one aborts them
    if (table) table->finish();
  } catch (const std::system_error& error) {
    lost(error.what());
  }
  group_->sum(0);  // the table is renamed before any worker continues
  checkpoint_.remove_partial_files();
}

}  // namespace eomgen::cli

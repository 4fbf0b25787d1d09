// SPDX-License-Identifier: GPL-3.0-or-later
// A sweep by several processes: the leader takes over existing rows, prepares and distributes the runs. The workers
// compute rows. All processes write the table.
#include <eom/output/whole_file.hpp>
#include <system_error>

#include "cli/output.hpp"
#include "cli/sweep/sweep.hpp"

namespace eomgen::cli {
namespace {

constexpr std::uint64_t least_of_ensemble = 256;  // runs per block and thread, so that SIMD lanes are mostly full
constexpr std::size_t most_rows = 1 << 16;        // written in one request

}  // namespace

bool Sweep::run_by_team() {
  const std::size_t threads = options_.jobs > 0 ? options_.jobs : 1;
  if (team_->leads()) {
    checkpoint_.require_file();
    if (!options_.ensemble && options_.jobs > 1)
      throw Error("sweep", {}, "--jobs are threads of an ensemble here, and there is none",
                  "start more processes, or add --ensemble");
    std::vector<Stretch> open = open_runs();
    std::optional<std::size_t> first;
    if (!open.empty()) {
      first = prepare(open);
      if (!first) return false;  // interrupted: leaving notifies the workers
      take_first(*first, open);
      if (options_.ensemble && !open.empty()) ensemble_.emplace(*first_);
    }
    team_->go(first);
    if (first) {
      team_->one_by_machine([] {});
      if (team_->size() == 1)
        make_here(open, threads);
      else
        team_->hand_out(open, options_.ensemble ? least_of_ensemble * threads : 1, Interrupt::flag());
    }
  } else if (const std::optional<std::uint64_t> first = team_->gone()) {
    team_->one_by_machine([&] {
      simulate_first(*first, false);
      if (options_.ensemble) ensemble_.emplace(*first_);
    });
    while (const std::optional<Stretch> block = team_->next()) make_here({*block}, threads);
  }
  checkpoint_.sort();
  const bool all = team_->sum(checkpoint_.rows().size()) == runs();
  count();
  counts_ = {team_->sum(counts_.done), team_->sum(counts_.failed)};
  if (all) write_by_team();
  team_->part();
  return all;
}

void Sweep::make_here(const std::vector<Stretch>& stretches, std::size_t threads) {
  const std::vector<std::size_t> runs = runs_of(stretches);
  if (options_.ensemble)
    compute(runs, threads);
  else
    compute_here(runs);
}

void Sweep::write_by_team() {
  if (team_->sum(checkpoint_.open() ? 1 : 0) == 0) return;  // the table is complete
  const Rows& rows = checkpoint_.rows();
  struct Part {
    std::size_t first, last;
  };
  std::vector<Part> parts;
  std::vector<Team::Piece> pieces;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool follows = i > 0 && rows.run(i) == rows.run(i - 1) + shard_.count && i - parts.back().first < most_rows;
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
    rows.each(parts[piece].first, parts[piece].last,
              [&lines](std::size_t, std::string_view line) { lines.append(line) += '\n'; });
    return lines;
  };
  std::optional<eom::WholeFile> table;
  const std::string beginning = checkpoint_.beginning();
  const auto lost = [&table](const std::string& why) {
    if (table) table->discard();
    throw Error("sweep", {}, why,
                "see to space on that disk and to your rights there; the same command goes on from what is there",
                ErrorKind::tool);
  };
  try {
    if (team_->leads()) {
      table.emplace(file_);
      table->write(beginning);
    }
    const std::string why = team_->write(table ? table->partial() : "", beginning.size(), pieces, text);
    if (table && !why.empty()) lost(why);  // the others wait below until this one aborts them
    if (table) table->finish();
  } catch (const std::system_error& error) {
    lost(error.what());
  }
  team_->sum(0);  // the table is renamed before any worker continues
  checkpoint_.finish_elsewhere();
}

}  // namespace eomgen::cli

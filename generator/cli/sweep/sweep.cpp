// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/sweep/sweep.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <eom/outcome.hpp>
#include <thread>

#include "cli/assignments.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/sweep/npz.hpp"
#include "cli/sweep/workers.hpp"
#include "cli/usage.hpp"
#include "model/names.hpp"
#include "pipeline/estimate_cost.hpp"
#include "pipeline/graph_trimmer.hpp"
#include "pipeline/start_checker.hpp"
#include "run/eligibility.hpp"

namespace eomgen::cli {
namespace {

constexpr std::size_t most_runs = 10'000'000;  // limit of a process; each run takes about 40 bytes of memory

analysis::Shard shard_of(const SweepOptions& options, const analysis::SweepPoints& points, std::size_t processes) {
  const analysis::Shard shard = options.shard ? parse_shard(*options.shard) : analysis::Shard{};
  if (shard.size(points.size()) == 0) {
    throw Error("sweep", {},
                fmt::format("shard {}/{} has no runs: there are {} in all", shard.number, shard.count, points.size()),
                "take fewer shards");
  }
  const std::size_t most = most_runs * processes;
  if (shard.size(points.size()) > most) {
    throw Error("sweep", {},
                fmt::format("a call makes no more than {} points, and these are {}", most, shard.size(points.size())),
                "take fewer, or parts of them by --shard, each in a call of its own");
  }
  return shard;
}

/// Checks the options of --basins: equilibria depend on parameters, so only initial values may vary.
void require_basins(const analysis::SweepPoints& points, const SweepOptions& options, const model::Model& model) {
  if (!options.basins) return;
  for (const std::string& name : points.names()) {
    if (run::is_start_value(model, name)) continue;
    throw Error("sweep", {}, fmt::format("--basins asks which equilibrium is reached, and these move with '{}'", name),
                "vary starts alone, with --set for parameters, one sweep for each of their values");
  }
}

void require_names(const analysis::SweepPoints& points, const SweepOptions& options, const model::Model& model) {
  const std::map<std::string, Quantity> set = parse_assignments("sweep", "--set", options.set);
  for (const std::string& name : points.names()) {
    std::vector<std::string> known = run::state_columns(model);
    for (const model::Parameter& p : model.parameters) known.push_back(p.name);
    for (const model::Input& input : model.inputs) known.push_back(input.name);
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw Error("sweep", {}, fmt::format("there is no parameter, input, coordinate or state '{}'", name),
                  suggest_choice(name, known));
    }
    if (set.contains(name)) {
      throw Error("sweep", {}, fmt::format("'{}' is varied, and has a value by --set", name), "leave one of them out");
    }
  }
  require_basins(points, options, model);
}

std::string key_of_table(const SweepOptions& options, const model::Model& model, std::uint64_t seed,
                         const std::string& points_hash, const analysis::Shard& shard,
                         const analysis::SweepPoints& points) {
  return sweep_key(options, model, seed, points_hash) + (options.shard ? shard_header(shard, points.size()) : "");
}

void require_side_by_side(const pipeline::Simulation& first) {
  const std::string why = pipeline::ensemble_obstacle(first);
  if (why.empty()) return;
  throw Error("sweep", {}, "the runs of this scene cannot be made side by side: " + why, "leave --ensemble out");
}

std::size_t threads_of(const SweepOptions& options) {
  return options.jobs > 0 ? options.jobs : std::max(1u, std::thread::hardware_concurrency());
}

}  // namespace

Sweep::Sweep(const SweepOptions& options, const CommonOptions& common, const model::Model& model)
    : options_(options),
      overrides_(overrides_of("sweep", options, model)),
      estimate_cost_(pipeline::parse_estimate_cost(options.estimate, options.no_error_estimate || options.ensemble)),
      seed_(common.seed),
      points_(points_of(options, common.seed, points_hash_)),
      shard_(shard_of(options, points_, common.group != nullptr ? common.group->workers() : 1)),
      file_(options.out.empty() ? model.id + "_sweep.csv" : options.out),
      checkpoint_(
          (require_names(points_, options, model),
           require_writable_targets({{"--out", file_, is_npz(file_) ? ".npz" : ".csv"}}, model.file, common.json),
           file_),
          key_of_table(options, model, common.seed, points_hash_, shard_, points_),
          [this](std::size_t run, std::string_view line) {
            return run < points_.size() && shard_.contains(run) &&
                   line.starts_with(RowFormatter::format_point(run, points_.names(), points_.point(run)) + ",");
          },
          common.group == nullptr || common.group->is_leader() ? CheckpointFile::Role::whole
                                                               : CheckpointFile::Role::member),
      resumed_(checkpoint_.rows().size()),
      group_(common.group) {
  if (is_npz(file_) && (options.shard || group_ != nullptr)) {
    throw Error("sweep", {},
                fmt::format("{} is written by one process that makes the whole sweep", model::quote(file_)),
                "write tables as .csv with --shard (1/1 for all), and join them by eomgen merge TABLES -o " + file_);
  }
  if (common.group == nullptr || common.group->is_leader())
    check_units("sweep", model, points_.names(), points_.units());
  if (options.ensemble) solver_ = pipeline::ensemble_solver(model.scene(options.scene), overrides_);
}

bool Sweep::run_alone() {
  make_open_runs();
  checkpoint_.sort();
  count();
  if (checkpoint_.rows().size() < runs()) {
    checkpoint_.interrupt();
    return false;
  }
  checkpoint_.finish();
  return true;
}

void Sweep::make_open_runs() {
  std::vector<RunRange> open = open_runs();
  if (open.empty()) return;
  const std::optional<std::size_t> first = prepare(open);
  if (!first) return;
  take_first(*first, open);
  if (first_->result.outcome != eom::Outcome::interrupted) compute(runs_of(open), threads_of(options_));
}

std::vector<RunRange> Sweep::open_runs() const {
  std::vector<RunRange> open;
  std::size_t next = 0;  // first run of the shard that is not accounted for
  for (std::size_t i = 0; i <= checkpoint_.rows().size(); ++i) {
    const std::size_t there = i < checkpoint_.rows().size() ? shard_.place(checkpoint_.rows().run(i)) : runs();
    if (there > next) open.push_back({next, there - next});
    next = there + 1;
  }
  return open;
}

std::vector<std::size_t> Sweep::runs_of(const std::vector<RunRange>& stretches) const {
  std::vector<std::size_t> result;
  for (const RunRange& stretch : stretches) {
    for (std::size_t i = 0; i < stretch.count; ++i) result.push_back(shard_.run(stretch.first + i));
  }
  return result;
}

void Sweep::count() {
  counts_ = {};
  const std::size_t fields = points_.names().size() + 1;
  checkpoint_.rows().for_each(0, checkpoint_.rows().size(), [&](std::size_t, std::string_view line) {
    for (std::size_t k = 0; k < fields; ++k) line.remove_prefix(line.find(',') + 1);
    ++(is_successful(line.substr(0, line.find(','))) ? counts_.done : counts_.failed);
  });
}

std::vector<analysis::ColumnStatistics> Sweep::statistics() const {
  if (group_ != nullptr && counts_.done + counts_.failed < runs()) return {};
  return statistics_of_table(checkpoint_.header(), counts_.done + counts_.failed,
                             [this](const auto& take) { for_each_row(take); });
}

std::optional<analysis::BasinStatistics> Sweep::basins() const {
  if (counts_.done + counts_.failed < runs()) return std::nullopt;
  analysis::SteadyRequest request;
  request.model = load_model(options_.model);
  request.scene = options_.scene;
  request.overrides = overrides_;
  request.seed = seed_;
  analysis::BasinStatistics basins(analysis::steady_motions(request), *options_.basins);
  classify_runs(basins, checkpoint_.header(), [this](const auto& take) { for_each_row(take); });
  return basins;
}

/// In a group of processes the rows are read from the table, because other processes have rows too.
void Sweep::for_each_row(const std::function<void(std::string_view row)>& take) const {
  if (group_ == nullptr)
    return checkpoint_.rows().for_each(0, checkpoint_.rows().size(),
                                       [&take](std::size_t, std::string_view line) { take(line); });
  const OpenFile table(::open(checkpoint_.path().c_str(), O_RDONLY | O_CLOEXEC));
  std::size_t number = 0;
  for_each_line(table, [&](std::string_view line, std::uint64_t) {
    if (++number > 2) take(line);
    return true;
  });
}

run::Overrides Sweep::overrides_of_run(std::size_t run) const {
  run::Overrides o = overrides_;
  o.allow_empty_span = true;
  if (options_.ensemble) o.solver = solver_;
  o.values.merge(points_.point(run));
  return o;
}

bool Sweep::simulate_first(std::size_t run, bool integrate) {
  pipeline::SimulationRequest request;
  request.model = load_model(options_.model);
  request.scene = options_.scene;
  request.estimate = !options_.no_error_estimate && !options_.ensemble;
  request.estimate_cost = estimate_cost_;
  request.integrate = integrate;
  request.seed = seed_;
  request.ready = [this] { interrupt_.emplace(); };
  request.interrupt = &InterruptGuard::flag();
  request.overrides = overrides_of_run(run);
  try {
    first_.emplace(pipeline::simulate(request));
  } catch (const Error& error) {
    if (InterruptGuard::flag()) return false;
    throw;
  }
  if (options_.ensemble) require_side_by_side(*first_);
  text_ = RowFormatter(points_.names(), first_->derived->model, first_->scene);
  checkpoint_.set_header(text_.header());
  return true;
}

/// The first open run that can start. If there is none, any other run that can; it determines the columns.
std::size_t Sweep::first_that_begins(const std::vector<RunRange>& open) {
  pipeline::StartChecker starts(load_model(options_.model), options_.scene);
  std::size_t tries = 0;
  for (const RunRange& stretch : open) {
    for (std::size_t i = 0; i < stretch.count && tries < most_runs; ++i, ++tries) {
      const std::size_t run = shard_.run(stretch.first + i);
      if (starts.can_start(overrides_of_run(run))) return run;
    }
  }
  for (std::size_t run = 0; run < points_.size() && tries < most_runs; ++run, ++tries) {
    if (!is_open(open, run) && starts.can_start(overrides_of_run(run))) return run;
  }
  throw Error("sweep", {}, fmt::format("no run of the grid can begin: {}", starts.refusal()->message()),
              "change the grid or the scene: " + starts.refusal()->remedy());
}

std::optional<std::size_t> Sweep::prepare(const std::vector<RunRange>& open) {
  std::size_t run = shard_.run(open.front().first);
  try {
    if (simulate_first(run, true)) return run;
    return std::nullopt;
  } catch (const Error& error) {
    if (error.stage() != "scene") throw;
  }
  run = first_that_begins(open);
  if (simulate_first(run, is_open(open, run))) return run;
  return std::nullopt;
}

bool Sweep::is_open(const std::vector<RunRange>& open, std::size_t run) const {
  if (!shard_.contains(run)) return false;
  const std::size_t place = shard_.place(run);
  const auto after = std::upper_bound(open.begin(), open.end(), place,
                                      [](std::size_t p, const RunRange& stretch) { return p < stretch.first; });
  return after != open.begin() && place - std::prev(after)->first < std::prev(after)->count;
}

void Sweep::take_first(std::size_t run, std::vector<RunRange>& open) {
  if (!is_open(open, run) || first_->result.outcome == eom::Outcome::interrupted) return;
  checkpoint_.add(run, text_.format_row(run, points_.point(run), first_->result));
  const std::size_t place = shard_.place(run);
  const auto holds = std::find_if(open.begin(), open.end(),
                                  [place](const RunRange& stretch) { return place - stretch.first < stretch.count; });
  const RunRange behind{place + 1, holds->first + holds->count - place - 1};
  holds->count = place - holds->first;
  const auto next = holds->count == 0 ? open.erase(holds) : std::next(holds);
  if (behind.count > 0) open.insert(next, behind);
}

std::string Sweep::compute_row(std::size_t run) const {
  try {
    const run::RunResult result =
        pipeline::rerun(*first_, overrides_of_run(run), !options_.no_error_estimate, estimate_cost_);
    return InterruptGuard::flag() ? std::string() : text_.format_row(run, points_.point(run), result);
  } catch (const Error& error) {
    if (error.stage() != "scene") throw;
    return text_.format_refused(run, points_.point(run), error.message());
  }
}

void Sweep::compute(const std::vector<std::size_t>& runs, std::size_t threads) {
  if (options_.ensemble) {
    if (!ensemble_) ensemble_.emplace(*first_);
    ensemble_->run({runs, threads, [this](std::size_t run) { return overrides_of_run(run); },
                    [this](std::size_t run, const run::RunResult& result) {
                      checkpoint_.add(run, text_.format_row(run, points_.point(run), result));
                    },
                    [this](std::size_t run, const std::string& why) {
                      checkpoint_.add(run, text_.format_refused(run, points_.point(run), why));
                    },
                    &InterruptGuard::flag()});
    return;
  }
  pipeline::GraphTrimmer graph(*first_);
  const auto line = [&](std::size_t run) {
    graph.trim();
    return compute_row(run);
  };
  run_in_processes(
      runs, threads, line, [this](std::size_t run, const std::string& text) { checkpoint_.add(run, text); },
      InterruptGuard::flag());
}

/// Computes runs in this process, because MPI processes must not fork.
void Sweep::compute_here(const std::vector<std::size_t>& runs) {
  pipeline::GraphTrimmer graph(*first_);
  for (const std::size_t run : runs) {
    graph.trim();
    const std::string line = compute_row(run);
    if (line.empty()) return;
    checkpoint_.add(run, line);
  }
}

}  // namespace eomgen::cli

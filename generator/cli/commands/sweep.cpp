// SPDX-License-Identifier: GPL-3.0-or-later
// Many runs of one scene over a grid of parameters: compiled once, run by several processes, and gone on with after an interruption.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "cli/commands/commands.hpp"
#include "cli/decimal.hpp"
#include "cli/interrupt.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/simulate.hpp"
#include "cli/sweep/ensemble.hpp"
#include "cli/sweep/ledger.hpp"
#include "cli/sweep/points.hpp"
#include "cli/sweep/statistics.hpp"
#include "cli/sweep/workers.hpp"
#include "cli/usage.hpp"
#include "model/content_hash.hpp"

namespace eomgen::cli {
namespace {

struct Options {
  std::string model, scene = "default", out;
  std::vector<std::string> grid, sample, set, outputs;
  std::optional<double> rtol, atol, step, t_end;
  std::optional<std::string> solver;
  std::size_t jobs = 0, samples = 0;
  std::string design = "random", shard;
  bool no_error_estimate = false, ensemble = false, statistics = false;
};

constexpr const char* refused = "refused";  // in place of an outcome, where a run could not begin

run::Overrides overrides_of(const Options& options) {
  run::Overrides o;
  o.parameters = parse_assignments("sweep", options.set);
  o.rtol = options.rtol;
  o.atol = options.atol;
  o.step = options.step;
  o.t_end = options.t_end;
  o.at_start = true;
  o.solver = options.solver;
  o.outputs = options.outputs;
  return o;
}

/// What makes two sweeps the same: the model's bytes and all that was asked.
std::string key_of(const Options& options, const model::Model& model, std::uint64_t seed) {
  std::string text = model.content_hash + '\n' + options.scene + '\n' + (options.no_error_estimate || options.ensemble ? "plain" : "estimate");
  for (const auto* list : {&options.grid, &options.set, &options.outputs}) {
    text += '\n';
    for (const std::string& entry : *list) text += entry + '\x1f';
  }
  for (const auto& value : {options.rtol, options.atol, options.step, options.t_end}) text += '\n' + (value ? shortest(*value) : "");
  if (options.ensemble) text += "\nensemble";
  if (!options.sample.empty()) {
    text += fmt::format("\n{} {} {}", options.samples, options.design, seed);
    for (const std::string& entry : options.sample) text += '\x1f' + entry;
  }
  return model.id + " " + model::content_hash(text + '\n' + options.solver.value_or("")).substr(0, 16);
}

// A comma, a quotation mark or a line break inside of a field would be read as the end of it.
std::string field(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.17g}", unsigned_zero(value)) : std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf"; }

std::optional<Sampling> samples_of(const Options& options, std::uint64_t seed) {
  if (options.sample.empty() && options.samples == 0) return std::nullopt;
  return Sampling(options.sample, options.samples, options.design, seed);
}

class Sweep {
 public:
  Sweep(const Options& options, const Common& common, const model::Model& model)
      : options_(options), seed_(common.seed), points_(options.grid, samples_of(options, common.seed)),
        shard_(options.shard.empty() ? Shard{} : parse_shard(options.shard)), file_(options.out.empty() ? model.id + "_sweep.csv" : options.out),
        ledger_((require_places({{"--out", file_, ".csv"}}, model.file, common.json), file_), key_of(options, model, common.seed) + shard_note(shard_, points_.size())), resumed_(ledger_.rows().size()) {
    if (shard_.number > points_.size()) {
      throw Error("sweep", {}, fmt::format("shard {}/{} has no runs: there are {} in all", shard_.number, shard_.count, points_.size()), "take fewer shards");
    }
    if (options.ensemble) solver_ = ensemble_solver(model.scene(options.scene), overrides_of(options));
    const std::map<std::string, symbolic::Rational> set = overrides_of(options).parameters;
    for (const std::string& name : points_.names()) {
      const auto named = [&](const model::Parameter& p) { return p.name == name; };
      if (std::none_of(model.parameters.begin(), model.parameters.end(), named)) {
        std::vector<std::string> known;
        for (const model::Parameter& p : model.parameters) known.push_back(p.name);
        throw Error("sweep", {}, fmt::format("there is no parameter '{}'", name), choice_of(name, known));
      }
      if (set.contains(name)) {
        throw Error("sweep", {}, fmt::format("'{}' has a grid and a value by --set", name), "leave one of them out");
      }
    }
  }

  /// Whether all runs are there.
  bool run() {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      runs_ += shard_.has(i) ? 1 : 0;
      if (shard_.has(i) && !ledger_.rows().contains(i)) open.push_back(i);
    }
    if (!open.empty()) compute(open);
    if (ledger_.rows().size() < runs_) {
      ledger_.interrupt();
      return false;
    }
    ledger_.finish();
    return true;
  }

  nlohmann::ordered_json document(const model::Model& model) const {
    nlohmann::ordered_json found = {{"format", 1}, {"model", model.id}, {"scene", options_.scene}, {"runs", runs_}, {"done", ended(true)},
                                    {"failed", ended(false)}, {"resumed", resumed_}, {"file", ledger_.place()}};
    if (!options_.shard.empty()) found["shard"] = options_.shard;
    if (options_.statistics) found["statistics"] = to_json(statistics());
    return found;
  }

  std::vector<ColumnStatistics> statistics() const {
    std::vector<const std::string*> rows;
    for (const auto& [run, line] : ledger_.rows()) rows.push_back(&line);
    return statistics_of_table(ledger_.header(), rows);
  }

 private:
  std::size_t ended(bool well) const {
    const std::size_t at = points_.names().size() + 1;
    std::size_t count = 0;
    for (const auto& [run, line] : ledger_.rows()) {
      std::size_t begin = 0;
      for (std::size_t k = 0; k < at; ++k) begin = line.find(',', begin) + 1;
      const std::string outcome = line.substr(begin, line.find(',', begin) - begin);
      count += (outcome == eom::name(eom::Outcome::done) || outcome == eom::name(eom::Outcome::stopped_by_event)) == well;
    }
    return count;
  }

  run::Overrides at(std::size_t index) const {
    run::Overrides o = overrides_of(options_);
    if (options_.ensemble) o.solver = solver_;
    o.parameters.merge(points_.point(index));
    return o;
  }

  void compute(std::vector<std::size_t> open) {
    SimulationRequest request;
    request.model = options_.model;
    request.scene = options_.scene;
    request.estimate = !options_.no_error_estimate && !options_.ensemble;
    request.seed = seed_;
    std::optional<Interrupt> interrupt;
    request.ready = [&interrupt] { interrupt.emplace(); };
    request.interrupt = &Interrupt::flag();
    std::vector<std::pair<std::size_t, std::string>> refusals;
    std::optional<Simulation> first;
    const auto begins = [&](std::size_t run) {  // the first run that can begin compiles the code for all
      request.overrides = at(run);
      try {
        first = simulate(request);
      } catch (const Error& error) {
        if (Interrupt::flag()) return true;
        if (error.stage() != "scene") throw;
        refusals.emplace_back(run, error.message());
      }
      return first.has_value();
    };
    while (!open.empty() && !begins(open.front())) open.erase(open.begin());
    // Where none of these can, another one tells the columns.
    const std::size_t refused_here = refusals.size();
    for (std::size_t run = 0; open.empty() && run < points_.size() && !first && !Interrupt::flag(); ++run) {
      const bool tried = std::any_of(refusals.begin(), refusals.begin() + static_cast<std::ptrdiff_t>(refused_here), [run](const auto& r) { return r.first == run; });
      if (!tried) begins(run);
    }
    if (Interrupt::flag() && !first) return;
    if (!first) throw Error("sweep", {}, fmt::format("no run of the grid can begin: {}", refusals.front().second), "change the grid or the scene");
    refusals.resize(refused_here);
    if (options_.ensemble) require_plain(*first);
    columns(first->scene);
    if (ledger_.rows().empty()) resumed_ = 0;
    for (const auto& [run, why] : refusals) ledger_.add(run, refusal(run, why));
    if (open.empty() || first->result.outcome == eom::Outcome::interrupted) return;
    ledger_.add(open.front(), row(open.front(), first->result));
    open.erase(open.begin());
    const auto line = [&](std::size_t run) {
      try {
        const run::RunResult result = run_again(*first, at(run), request.estimate);
        return Interrupt::flag() ? std::string() : row(run, result);
      } catch (const Error& error) {
        if (error.stage() != "scene") throw;
        return refusal(run, error.message());
      }
    };
    if (options_.ensemble) {
      const std::size_t threads = options_.jobs > 0 ? options_.jobs : std::max(1u, std::thread::hardware_concurrency());
      run_ensemble(*first, {open, threads, [this](std::size_t run) { return at(run); },
                            [this](std::size_t run, const run::RunResult& result) { ledger_.add(run, row(run, result)); },
                            [this](std::size_t run, const std::string& why) { ledger_.add(run, refusal(run, why)); }, &Interrupt::flag()});
      return;
    }
    const std::size_t jobs = options_.jobs > 0 ? options_.jobs : std::max(1u, std::thread::hardware_concurrency());
    by_processes(open, jobs, line, [this](std::size_t run, const std::string& text) { ledger_.add(run, text); }, Interrupt::flag());
  }

  void columns(const run::Scene& scene) {
    names_ = scene.outputs;
    std::string header = "run";
    for (const std::string& name : points_.names()) header += "," + name;
    header += ",outcome,t,steps,rhs_evaluations";
    const model::Model model = model::read_model(locate_model(options_.model));
    std::vector<std::string> all;
    for (const model::Coordinate& c : model.coordinates) {
      all.push_back(c.name);
      all.push_back(c.name + "_dot");
    }
    if (std::find(names_.begin(), names_.end(), "energy") == names_.end()) all.emplace_back("energy");
    names_.insert(names_.begin(), all.begin(), all.end());
    for (const std::string& name : names_) header += "," + name;
    ledger_.set_header(header + ",error_estimate,detail");
  }

  std::string beginning(std::size_t run) const {
    std::string text = std::to_string(run);
    const std::map<std::string, symbolic::Rational> point = points_.point(run);
    for (const std::string& name : points_.names()) text += "," + number(cln::double_approx(point.at(name)));
    return text;
  }
  std::string refusal(std::size_t run, const std::string& why) const {
    return beginning(run) + "," + refused + ",,," + std::string(names_.size() + 1, ',') + "," + field(why);
  }
  std::string row(std::size_t run, const run::RunResult& result) const {
    std::string text = beginning(run) + fmt::format(",{},{},{},{}", eom::name(result.outcome), number(result.t), result.statistics.steps, result.statistics.rhs_evaluations);
    for (const std::string& name : names_) {
      const auto found = std::find_if(result.final.begin(), result.final.end(), [&](const auto& entry) { return entry.first == name; });
      text += "," + (found == result.final.end() ? "" : number(found->second));
    }
    const auto& estimate = result.error_estimate;
    return text + "," + (estimate.empty() ? "" : number(estimate.back().second)) + "," + field(result.detail);
  }

  const Options& options_;
  std::uint64_t seed_;
  Points points_;
  Shard shard_;
  std::string file_;
  Ledger ledger_;
  std::size_t resumed_, runs_ = 0;
  std::vector<std::string> names_;
  std::string solver_;  // of an ensemble
};

int execute(const Options& options, const Common& common) {
  const model::Model model = model::read_model(locate_model(options.model));
  Sweep sweep(options, common, model);
  const bool whole = sweep.run();
  const nlohmann::ordered_json found = sweep.document(model);
  if (common.json) {
    print_document(found);
  } else {
    std::string text = fmt::format("model  {}, scene {}\nruns   {}: {} done, {} failed", model.id, options.scene, found["runs"].get<std::size_t>(),
                                   found["done"].get<std::size_t>(), found["failed"].get<std::size_t>());
    if (found["resumed"] != 0) text += fmt::format(" ({} of them were there)", found["resumed"].get<std::size_t>());
    text += fmt::format("\nwrote  {}\n", found["file"].get<std::string>());
    if (options.statistics) text += "\n" + to_text(sweep.statistics());
    print_readable(text, is_standard_output(options.out));
  }
  if (!whole) tell("interrupted: the same command goes on from the rows that are there\n");
  return whole && found["failed"] == 0 ? 0 : 3;
}

}  // namespace

Execute declare_sweep(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/")->required();
  add_list(app, "--grid", options->grid, "PARAMETER=FROM:TO:COUNT, PARAMETER=FROM:TO:log:COUNT or PARAMETER=a,b,c; may be repeated", '\0');
  add_list(app, "--sample", options->sample, "PARAMETER=FROM:TO, PARAMETER=FROM:TO:log or PARAMETER=MEAN:DEVIATION:normal; may be repeated", '\0');
  app.add_option("--samples", options->samples, "how many, at every point of the grid")->check(whole_number(1, 1'000'000));
  app.add_option("--design", options->design, "of samples: random, latin (hypercube) or sobol; all follow from --seed")->capture_default_str();
  app.add_option("--shard", options->shard, "NUMBER/COUNT: only these runs; eomgen merge joins the tables");
  app.add_flag("--statistics", options->statistics, "mean, deviation, extremes and quantiles of every column");
  app.add_option("--scene", options->scene, "a scene of the model")->capture_default_str();
  app.add_option("--solver", options->solver, "a solver that eomgen list shows, or auto");
  app.add_option("--rtol", options->rtol, "relative tolerance")->check(number_not_negative());
  app.add_option("--atol", options->atol, "absolute tolerance")->check(number_not_negative());
  app.add_option("--step", options->step, "a fixed step, without error control")->check(positive_number());
  add_list(app, "--set", options->set, "PARAMETER=VALUE in SI units; may be repeated");
  app.add_option("--t-end", options->t_end, "the end of the runs")->check(finite_number());
  add_place(app, "-o,--out", options->out, "the table, a CSV file; without it MODEL_sweep.csv in this folder");
  add_list(app, "--output", options->outputs, "columns beside the coordinates, in place of the scene's; all for all");
  app.add_option("--jobs", options->jobs, "processes, or threads of an ensemble; without it one for each processor")->check(whole_number(1, 1024));
  app.add_flag("--no-error-estimate", options->no_error_estimate, "leave the second runs out");
  app.add_flag("--ensemble", options->ensemble, "many runs side by side in the lanes of vector registers, without error estimates");
  return [options](const Common& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli

// SPDX-License-Identifier: GPL-3.0-or-later
// Command sweep: many runs of one scene over a grid of parameters. Compiles once, runs in several processes, and
// continues after an interruption.
#include "cli/sweep/sweep.hpp"

#include <fmt/format.h>

#include <memory>

#include "cli/commands/commands.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"

namespace eomgen::cli::sweep_command {
namespace {

Json document(const SweepOptions& options, const model::Model& model, const Sweep& sweep) {
  const Sweep::Counts counts = sweep.counts();
  Json found = {{"format", 1},         {"model", model.id},       {"scene", options.scene},     {"runs", sweep.runs()},
                {"done", counts.done}, {"failed", counts.failed}, {"resumed", sweep.resumed()}, {"file", sweep.path()}};
  if (options.shard) found["shard"] = *options.shard;
  return found;
}

int execute(const SweepOptions& options, const CommonOptions& common) {
  const model::Model model = model::read_model(locate_model(options.model));
  Sweep sweep(options, common, model);
  const bool whole = sweep.run();
  if (common.group != nullptr && !common.group->is_leader()) return 0;  // the leader reports
  Json found = document(options, model, sweep);
  const std::optional<analysis::BasinStatistics> basins = options.basins ? sweep.basins() : std::nullopt;
  if (common.json) {
    if (options.statistics) found["statistics"] = to_json(sweep.statistics());
    if (basins) found["basins"] = to_json(*basins);
    print_document(found);
  } else {
    std::string text = fmt::format("model  {}, scene {}\nruns   {}: {} done, {} failed", model.id, options.scene,
                                   found["runs"].get<std::size_t>(), found["done"].get<std::size_t>(),
                                   found["failed"].get<std::size_t>());
    if (found["resumed"] != 0) text += fmt::format(" ({} of them were there)", found["resumed"].get<std::size_t>());
    text += fmt::format("\nwrote  {}\n", found["file"].get<std::string>());
    if (options.statistics) text += "\n" + to_text(sweep.statistics());
    if (basins) text += "\n" + to_text(*basins);
    print_readable(text, is_standard_output(options.out));
  }
  if (!whole) print_message("interrupted: the same command goes on from the rows that are there\n");
  return whole && found["failed"] == 0 ? 0 : 3;
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<SweepOptions>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/").required();
  app.add_list("--grid", options->grid,
               "PARAMETER=FROM:TO:COUNT, PARAMETER=FROM:TO:log:COUNT or PARAMETER=a,b,c; may be repeated", '\0');
  app.add_list("--sample", options->sample,
               "PARAMETER=FROM:TO, PARAMETER=FROM:TO:log or PARAMETER=MEAN:DEVIATION:normal; may be repeated", '\0');
  app.add_option("--samples", options->samples, "how many, at every point of the grid")
      .check(whole_number(1, analysis::max_points));
  app.add_option("--design", options->design,
                 "of samples: random, latin (hypercube) or sobol; without it random. All follow from --seed");
  app.add_option("--points", options->points,
                 "a CSV file: a line that names parameters, then lines of their values; each is a point, or goes with "
                 "every point of the grid");
  app.add_option("--shard", options->shard, "NUMBER/COUNT: only these runs; eomgen merge joins the tables");
  app.add_flag("--statistics", options->statistics, "mean, deviation, extremes and quantiles of every column");
  app.add_option("--basins", options->basins,
                 "how many runs ended at which equilibrium: so near in each coordinate and rate, in SI units")
      .check(positive_number());
  add_scene(app, *options);
  add_solver(app, *options);
  add_fixed_step(app, *options);
  add_values(app, *options);
  app.add_option("--t-end", options->t_end, "the end of the runs").check(finite_number());
  app.add_output_path("-o,--out", options->out,
                      "the table: F.csv, or F.npz for arrays of columns; without it MODEL_sweep.csv in this folder");
  add_outputs(app, *options);
  app.add_option("--jobs", options->jobs, "processes, or threads of an ensemble; without it one for each processor")
      .check(whole_number(1, 1024));
  add_estimate(app, options->estimate, options->no_error_estimate);
  app.add_flag("--ensemble", options->ensemble,
               "many runs side by side in the lanes of vector registers, without error estimates");
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::sweep_command

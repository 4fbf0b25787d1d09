// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/inverse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "cli/commands/commands.hpp"
#include "cli/interrupt.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/shared_options.hpp"
#include "cli/table_size.hpp"
#include "pipeline/limits.hpp"

namespace eomgen::cli::inverse_command {
namespace {

struct Options : SceneOptions {
  std::string model, out;
  std::vector<std::string> constraints;
  std::uint64_t max_steps = 0;
  bool yes = false;
};

/// Writes the table to the file and records its extremes.
class Table {
 public:
  Table(const std::string& file, std::vector<std::string> columns) : columns_(std::move(columns)) {
    range_.resize(columns_.size(), {HUGE_VAL, -HUGE_VAL});
    csv_.emplace(file, columns_);
  }
  void row(double t, std::span<const double> values) {
    csv_->row(t, values);
    for (std::size_t i = 0; i < values.size(); ++i) {
      range_[i].first = std::min(range_[i].first, values[i]);
      range_[i].second = std::max(range_[i].second, values[i]);
    }
    ++rows_;
  }
  void finish(eom::Outcome outcome) { csv_->finish(outcome); }
  const std::pair<double, double>& range(std::size_t column) const { return range_[column]; }
  std::size_t rows() const { return rows_; }

 private:
  std::vector<std::string> columns_;
  std::vector<std::pair<double, double>> range_;
  std::optional<TableFile> csv_;
  std::size_t rows_ = 0;
};

Json to_json(const analysis::InverseDynamicsResult& answer, const Table& table, const std::string& file,
             const model::Model& model, const std::string& scene) {
  Json columns = Json::array({"t"}), extremes = Json::object();
  for (const std::string& name : answer.columns) columns.push_back(name);
  for (std::size_t i = 0; i < answer.columns.size(); ++i) {
    const std::string& name = answer.columns[i];
    if (std::find(answer.forces.begin(), answer.forces.end(), name) == answer.forces.end()) continue;
    extremes[name] = {{"min", table.range(i).first}, {"max", table.range(i).second}};
  }
  return {{"format", 1},
          {"model", model.id},
          {"scene", scene},
          {"columns", columns},
          {"file", file},
          {"rows", table.rows()},
          {"forces", extremes},
          {"outcome", eom::name(answer.outcome)},
          {"detail", answer.detail},
          {"certificate", answer.certificate}};
}

std::string readable(const Json& found) {
  std::string out =
      fmt::format("model        {}, scene {}\n", found["model"].get<std::string>(), found["scene"].get<std::string>());
  out += fmt::format("certificate  {}\n", found["certificate"].get<std::string>());
  out += fmt::format("outcome      {}{}{}\n\n", found["outcome"].get<std::string>(), found["detail"] == "" ? "" : ": ",
                     found["detail"].get<std::string>());
  out += fmt::format("  {:<28} {:>24} {:>24}\n", "force", "least", "greatest");
  for (const auto& [name, range] : found["forces"].items()) {
    const auto shown = [](const Json& x) { return x.is_null() ? std::string("-") : shortest(x.get<double>()); };
    out += fmt::format("  {:<28} {:>24} {:>24}\n", name, shown(range["min"]), shown(range["max"]));
  }
  return out +
         fmt::format("\nwrote {} ({} rows)\n", found["file"].get<std::string>(), found["rows"].get<std::size_t>());
}

int execute(const Options& options, const CommonOptions& common) {
  analysis::InverseRequest request;
  request.constraints = options.constraints;
  request.max_steps =
      static_cast<std::size_t>(std::min<std::uint64_t>(options.max_steps, std::numeric_limits<std::size_t>::max()));
  const InterruptGuard interrupt;
  request.interrupt = &InterruptGuard::flag();
  request.take(scene_request("inverse", options.model, options, common.seed));
  const model::Model& model = *request.model;
  request.overrides.allow_empty_span = true;
  const std::string file = options.out.empty() ? model.id + "_inverse.csv" : options.out;
  require_writable_targets({{"--out", file, ".csv"}}, model.file, common.json);
  std::optional<Table> table;
  request.begin = [&](const run::Scene& scene, const std::vector<std::string>& columns) {
    require_size(scene.t0, scene.t1, pipeline::row_interval(scene), columns.size(), options.yes);
    table.emplace(file, columns);
  };
  request.row = [&](double t, std::span<const double> values) { table->row(t, values); };
  const analysis::InverseDynamicsResult answer = analysis::inverse_dynamics(request);
  table->finish(answer.outcome);
  const Json found = to_json(answer, *table, file, model, options.scene);
  print_result(common.json, found, readable(found), is_standard_output(file));
  return answer.outcome == eom::Outcome::done || answer.outcome == eom::Outcome::stopped_by_event ? 0 : 3;
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/").required();
  add_scene(app, *options);
  app.add_list("--constraint", options->constraints,
               "constraints whose forces are asked for; without it those that prescribe a coordinate");
  add_values(app, *options);
  app.add_option("--t-end", options->t_end, "the end of the motion").check(finite_number());
  app.add_option("--every", options->every, "interval of the rows").check(positive_number());
  app.add_option("--rtol", options->rtol, "relative tolerance where something is free to move")
      .check(nonnegative_number());
  app.add_option("--atol", options->atol, "absolute tolerance where something is free to move")
      .check(nonnegative_number());
  app.add_option("--max-steps", options->max_steps, "the most steps, where something is free to move")
      .check(whole_number(limits::run_steps.least, limits::run_steps.most));
  app.add_output_path("-o,--out", options->out, "the table, a CSV file; without it MODEL_inverse.csv in this folder");
  app.add_flag("--yes", options->yes, "writes a table however large it is");
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::inverse_command

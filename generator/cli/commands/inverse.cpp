// SPDX-License-Identifier: GPL-3.0-or-later
// The forces that prescribed motions need, over time: evaluated where every coordinate is prescribed, along a run where
// some are free.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/ode.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "cli/commands/commands.hpp"
#include "cli/decimal.hpp"
#include "cli/interrupt.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/simulate.hpp"
#include "cli/table_size.hpp"
#include "cli/usage.hpp"
#include "derive/conserved.hpp"
#include "derive/lagrange.hpp"
#include "derive/prescribed_forces.hpp"
#include "model/names.hpp"
#include "run/jumps.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::cli {
namespace {

using json = nlohmann::ordered_json;

struct Options {
  std::string model, scene = "default", out;
  std::vector<std::string> constraints, set;
  std::optional<double> t_end, every, rtol, atol;
  std::size_t max_steps = 0;
  bool yes = false;
};

/// What the forces are asked of: constraints by label; those that read q = f(t) if none are named.
std::vector<std::string> chosen_constraints(const mechanics::Mechanics& m, const std::vector<std::string>& names) {
  if (names.empty()) {
    std::vector<std::string> labels = derive::prescribing_constraints(m);
    if (!labels.empty()) return labels;
    throw Error("inverse", Where{m.model->file, 0, 0, 1, ""}, "no constraint of this model prescribes a motion",
                "add one that reads coordinate = function of time, such as [[constraint]] name = \"drive\", holonomic "
                "= \"R - f\", "
                "or name others with --constraint");
  }
  std::vector<std::string> labels, known;
  for (const mechanics::Constraint& c : m.constraints) known.push_back(c.label);
  for (const std::string& name : names) {
    const std::size_t before = labels.size();
    for (const mechanics::Constraint& c : m.constraints) {
      if (c.label == name || c.name == name) labels.push_back(c.label);
    }
    if (labels.size() == before) {
      throw Error("inverse", {}, fmt::format("there is no constraint {}", model::quote(name)), choice_of(name, known));
    }
  }
  return labels;
}

/// The table: to the file, and its extremes.
class Table {
 public:
  Table(const std::string& file, std::vector<std::string> columns) : columns_(std::move(columns)) {
    range_.resize(columns_.size(), {HUGE_VAL, -HUGE_VAL});
    csv_.emplace(file, columns_);
  }
  void row(double t, const std::vector<double>& values) {
    csv_->row(t, values);
    for (std::size_t i = 0; i < values.size(); ++i) {
      range_[i].first = std::min(range_[i].first, values[i]);
      range_[i].second = std::max(range_[i].second, values[i]);
    }
    ++rows_;
  }
  void finish(eom::Outcome outcome) { csv_->finish(outcome); }
  const std::vector<std::string>& columns() const { return columns_; }
  const std::pair<double, double>& range(std::size_t column) const { return range_[column]; }
  std::size_t rows() const { return rows_; }

 private:
  std::vector<std::string> columns_;
  std::vector<std::pair<double, double>> range_;
  std::optional<TableFile> csv_;
  std::size_t rows_ = 0;
};

struct Answer {
  std::optional<Table> table;
  std::vector<std::string> forces;  // those of `table` that were asked for
  eom::Outcome outcome = eom::Outcome::done;
  std::string detail, certificate, file;
};

std::vector<std::string> columns_of(const model::Model& model, const std::vector<std::string>& forces,
                                    const run::Scene& scene) {
  std::vector<std::string> columns;
  const auto add = [&](const std::string& name) {
    if (std::find(columns.begin(), columns.end(), name) == columns.end()) columns.push_back(name);
  };
  for (const model::Coordinate& c : model.coordinates) {
    add(c.name);
    add(c.name + "_dot");
  }
  for (const std::string& name : forces) add(name);
  for (const std::string& name : scene.outputs) add(name);
  return columns;
}

std::vector<std::string> force_columns(mechanics::Mechanics& m, system::EquationSystem& system,
                                       const std::vector<std::string>& labels) {
  std::vector<std::string> names = derive::add_prescribed_forces(m, system, labels);
  for (const std::string& label : labels) names.push_back("reaction." + label);
  return names;
}

/// Every coordinate is prescribed: nothing is integrated.
class Prescribed {
 public:
  Prescribed(const model::Model& model, mechanics::Mechanics mechanics) : model_(model), m_(std::move(mechanics)) {}

  void answer(const Options& options, const run::Overrides& overrides, std::uint64_t seed, Answer& result) {
    verify::Subjects subjects;
    subjects.systems = verify::all_routes(m_);
    const verify::Certificate certificate = verify::certify(m_, subjects, {50, emission_points, seed, {}});
    require_pass(certificate, model_);
    result.certificate = certificate.summary();
    system_ = derive::lagrange(m_, system::Approach::one);
    result.forces = force_columns(m_, system_, chosen_constraints(m_, options.constraints));
    scene_ = run::resolve_scene(m_, system_, model_.scene(options.scene), overrides);
    const double every = row_interval(scene_);
    const std::vector<std::string> columns = columns_of(model_, result.forces, scene_);
    require_size(scene_.t0, scene_.t1, every, columns.size(), options.yes);
    result.table.emplace(result.file, columns);
    t_ = scene_.t0;
    for (const std::string& name : result.table->columns()) {
      const auto output =
          std::find_if(system_.outputs.begin(), system_.outputs.end(), [&](const auto& o) { return o.name == name; });
      // What is 0 is shown as 0, not as the rounding of terms that cancel.
      const bool nothing = derive::vanishing(*m_.dag, {output->value}) != derive::Certainty::no;
      values_.push_back(nothing ? m_.dag->zero() : output->value);
    }
    integrals_.assign(system_.integrals.size(), 0.0);
    for (std::uint64_t i = 0; result.outcome == eom::Outcome::done; ++i) {
      const double t = scene_.t0 + static_cast<double>(i) * every;
      const bool last = t >= scene_.t1 - 1e-9 * every;
      if (i > 0) advance(last ? scene_.t1 : t, result);
      if (result.outcome == eom::Outcome::done) write_row(result);
      if (last) break;
      if (Interrupt::flag() && result.outcome == eom::Outcome::done) {
        result.outcome = eom::Outcome::interrupted;
        result.detail = fmt::format("at t = {}", t_);
      }
    }
    if (result.outcome == eom::Outcome::done) tell_jumps(result);
  }

 private:
  std::vector<double> values_at(double t, const double* integrals,
                                const std::vector<symbolic::Ref>& expressions) const {
    const double side = std::nextafter(t, scene_.t1 + 1);
    return symbolic::evaluate(*m_.dag, expressions, [&](const symbolic::Symbol& s) -> double {
      switch (s.kind) {
        case symbolic::SymbolKind::time: return t;
        case symbolic::SymbolKind::parameter: return scene_.parameters[s.index];
        case symbolic::SymbolKind::input: return scene_.inputs[s.index](t, side);
        default: break;
      }
      for (std::size_t i = 0; i < system_.integrals.size(); ++i) {
        if (s.kind == symbolic::SymbolKind::integral && system_.integrals[i].integral == s.index) return integrals[i];
      }
      throw std::logic_error("a prescribed motion leaves a symbol open");
    });
  }

  /// Integrals of functions of time that have no closed form.
  void advance(double t, Answer& result) {
    const double from = std::exchange(t_, t);
    if (integrals_.empty()) return;
    std::vector<symbolic::Ref> rates;
    for (const system::IntegralState& integral : system_.integrals) rates.push_back(integral.rate);
    const auto f = [&](double at, const double* x, double* dx) {
      const std::vector<double> rate = values_at(at, x, rates);
      std::copy(rate.begin(), rate.end(), dx);
      return 0;
    };
    eom::Options tolerances;
    if (scene_.max_step > 0) tolerances.max_step = scene_.max_step;
    tolerances.rtol = scene_.rtol;
    tolerances.atol = scene_.atol;
    const eom::Result end = eom::integrate("dop853", f, from, integrals_, t, tolerances);
    integrals_ = end.x;
    result.outcome = end.outcome;
    result.detail = end.detail;
  }

  /// Where a velocity jumps the forces are an impulse, which no row shows.
  void tell_jumps(Answer& result) const {
    if (!scene_.jumps || !scene_.jumps->by_time()) return;
    for (const run::Break& at : scene_.clock.breaks) {
      std::vector<double> before, after, x = integrals_;
      const double side = (at.before + at.after) / 2;
      for (const run::Signal& input : scene_.inputs)
        before.push_back(input(at.before, side)), after.push_back(input(at.after, side));
      const run::Jumps::Told told = scene_.jumps->cross({at.before, x, before.data()}, at.after, after.data(), x);
      if (told.undetermined.empty() && !told.velocities) continue;
      result.outcome = eom::Outcome::jump_undetermined;
      result.detail = !told.undetermined.empty() ? told.undetermined
                                                 : fmt::format(
                                                       "{} jumps at t = {:.15g}: the forces there are an impulse, "
                                                       "which no row shows; make it a motion that takes some time",
                                                       told.what.empty() ? "a velocity" : told.what, at.after);
      return;
    }
  }

  void write_row(Answer& result) const {
    const std::vector<double> row = values_at(t_, integrals_.data(), values_);
    result.table->row(t_, row);
    if (std::all_of(row.begin(), row.end(), [](double x) { return std::isfinite(x); })) return;
    result.outcome = eom::Outcome::not_finite;
    result.detail = fmt::format("at t = {} the motion or a force has no value", t_);
  }

  const model::Model& model_;
  mechanics::Mechanics m_;
  system::EquationSystem system_;
  run::Scene scene_;
  std::vector<symbolic::Ref> values_;
  double t_ = 0;
  std::vector<double> integrals_;
};

/// Some coordinates are free: they move as the equations of motion say.
void along_a_run(const Options& options, const run::Overrides& overrides, std::uint64_t seed, Answer& result) {
  SimulationRequest request;
  request.model = options.model;
  request.scene = options.scene;
  request.overrides = overrides;
  request.estimate = false;
  request.max_steps = options.max_steps;
  request.seed = seed;
  request.prepare = [&](Derived& derived) {
    const std::vector<std::string> labels = chosen_constraints(derived.mechanics, options.constraints);
    for (system::EquationSystem& system : derived.candidates)
      result.forces = force_columns(derived.mechanics, system, labels);
    return result.forces;
  };
  std::vector<std::size_t> index;
  request.begin = [&](const Derived& derived, const run::Scene& scene, const std::vector<std::string>& names) {
    const std::vector<std::string> columns = columns_of(derived.model, result.forces, scene);
    require_size(scene.t0, scene.t1, row_interval(scene), columns.size(), options.yes);
    result.table.emplace(result.file, columns);
    for (const std::string& column : result.table->columns()) {
      index.push_back(static_cast<std::size_t>(std::find(names.begin(), names.end(), column) - names.begin()));
    }
  };
  request.row = [&](double t, std::span<const double> y) {
    std::vector<double> row;
    for (const std::size_t i : index) row.push_back(y[i]);
    result.table->row(t, row);
  };
  request.interrupt = &Interrupt::flag();
  const Simulation simulation = simulate(request);
  result.certificate = simulation.certificate.summary();
  result.outcome = simulation.result.outcome;
  result.detail = simulation.result.detail;
}

json to_json(const Answer& answer, const model::Model& model, const std::string& scene) {
  json columns = json::array({"t"}), extremes = json::object();
  for (const std::string& name : answer.table->columns()) columns.push_back(name);
  for (std::size_t i = 0; i < answer.table->columns().size(); ++i) {
    const std::string& name = answer.table->columns()[i];
    if (std::find(answer.forces.begin(), answer.forces.end(), name) == answer.forces.end()) continue;
    extremes[name] = {{"min", answer.table->range(i).first}, {"max", answer.table->range(i).second}};
  }
  return {{"format", 1},
          {"model", model.id},
          {"scene", scene},
          {"columns", columns},
          {"file", answer.file},
          {"rows", answer.table->rows()},
          {"forces", extremes},
          {"outcome", eom::name(answer.outcome)},
          {"detail", answer.detail},
          {"certificate", answer.certificate}};
}

std::string readable(const json& found) {
  std::string out =
      fmt::format("model        {}, scene {}\n", found["model"].get<std::string>(), found["scene"].get<std::string>());
  out += fmt::format("certificate  {}\n", found["certificate"].get<std::string>());
  out += fmt::format("outcome      {}{}{}\n\n", found["outcome"].get<std::string>(), found["detail"] == "" ? "" : ": ",
                     found["detail"].get<std::string>());
  out += fmt::format("  {:<28} {:>24} {:>24}\n", "force", "least", "greatest");
  for (const auto& [name, range] : found["forces"].items()) {
    const auto shown = [](const json& x) { return x.is_null() ? std::string("-") : shortest(x.get<double>()); };
    out += fmt::format("  {:<28} {:>24} {:>24}\n", name, shown(range["min"]), shown(range["max"]));
  }
  return out +
         fmt::format("\nwrote {} ({} rows)\n", found["file"].get<std::string>(), found["rows"].get<std::size_t>());
}

int execute(const Options& options, const Common& common) {
  run::Overrides overrides;
  overrides.parameters = parse_assignments("inverse", options.set);
  overrides.t_end = options.t_end;
  overrides.at_start = true;
  overrides.every = options.every;
  overrides.rtol = options.rtol;
  overrides.atol = options.atol;
  const model::Model model = model::read_model(locate_model(options.model));
  Answer answer;
  answer.file = options.out.empty() ? model.id + "_inverse.csv" : options.out;
  const Interrupt interrupt;
  require_places({{"--out", answer.file, ".csv"}}, model.file, common.json);
  mechanics::Mechanics mechanics = mechanics::build_mechanics(model);
  if (mechanics.free.empty()) {
    tell_warnings(model);
    Prescribed(model, std::move(mechanics)).answer(options, overrides, common.seed, answer);
  } else {
    along_a_run(options, overrides, common.seed, answer);
  }
  answer.table->finish(answer.outcome);
  const json found = to_json(answer, model, options.scene);
  if (common.json) {
    print_document(found);
  } else {
    print_readable(readable(found), is_standard_output(answer.file));
  }
  return answer.outcome == eom::Outcome::done || answer.outcome == eom::Outcome::stopped_by_event ? 0 : 3;
}

}  // namespace

Execute declare_inverse(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/")->required();
  app.add_option("--scene", options->scene, "a scene of the model")->capture_default_str();
  add_list(app, "--constraint", options->constraints,
           "constraints whose forces are asked for; without it those that prescribe a coordinate");
  add_list(app, "--set", options->set, "PARAMETER=VALUE in SI units; may be repeated");
  app.add_option("--t-end", options->t_end, "the end of the motion")->check(finite_number());
  app.add_option("--every", options->every, "interval of the rows")->check(positive_number());
  app.add_option("--rtol", options->rtol, "relative tolerance where something is free to move")
      ->check(number_not_negative());
  app.add_option("--atol", options->atol, "absolute tolerance where something is free to move")
      ->check(number_not_negative());
  app.add_option("--max-steps", options->max_steps, "the most steps, where something is free to move")
      ->check(whole_number(1, 1'000'000'000'000'000));
  add_place(app, "-o,--out", options->out, "the table, a CSV file; without it MODEL_inverse.csv in this folder");
  app.add_flag("--yes", options->yes, "writes a table however large it is");
  return [options](const Common& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli

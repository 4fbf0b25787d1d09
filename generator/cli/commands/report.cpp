// SPDX-License-Identifier: GPL-3.0-or-later
// Command report: one self-contained HTML page with the model, its equations, their verification, a run, plots and an
// animation. It needs no other file and no network.
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "analysis/drawing/forces.hpp"
#include "analysis/drawing/primitives.hpp"
#include "analysis/equations.hpp"
#include "analysis/page/live_model.hpp"
#include "analysis/page/surface_code.hpp"
#include "cli/commands/commands.hpp"
#include "cli/examination.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/report/html.hpp"
#include "cli/report/recorded_motion.hpp"
#include "cli/run_report.hpp"
#include "cli/shared_options.hpp"
#include "pipeline/simulate.hpp"
#include "print/render.hpp"

namespace eomgen::cli::report_command {
namespace {

struct Options : SceneOptions {
  std::string model, out;
};

constexpr double most_rows = 400, least_rows = 120, most_values = 20000;   // in a motion
constexpr std::size_t fewest_rows = 40;                                    // least number for an animation
constexpr std::size_t longest_formula = 60000, longest_formulas = 350000;  // bytes of MathML
constexpr std::size_t largest_page = 950000, largest_motion = 900000;      // bytes; names of what is left out follow

/// Number of rows. The page interpolates with cubics, so models with many coordinates can have fewer rows.
double rows_of_a_page(const model::Model& model) {
  return std::clamp(most_values / (2 * static_cast<double>(model.coordinates.size())), least_rows, most_rows);
}

std::string text(const Json& value) {
  return value.is_null() ? "" : value.is_string() ? value.get<std::string>() : serialised(value);
}

// The animation comes first. The script adds the controls, which need it.
void add_head(Html& html, const model::Model& model, bool moving) {
  html.heading(1, model.title.empty() ? model.id : model.title);
  html.paragraph(model.id + ".toml", "quiet");
  if (!model.notes.empty()) html.paragraph(model.notes);
  if (moving) html.markup("<section id=\"stage\" aria-label=\"animation\"></section>");
}

void add_model(Html& html, const model::Model& model, const Json& found) {
  html.heading(2, "Coordinates and parameters");
  std::vector<std::vector<std::string>> coordinates, parameters, forces;
  for (const Json& c : found["coordinates"]) {
    coordinates.push_back(
        {text(c["name"]), text(c["unit"]), c["eliminated"].get<bool>() ? "fixed by a constraint" : ""});
  }
  for (const Json& p : found["parameters"]) parameters.push_back({text(p["name"]), text(p["value"]), text(p["unit"])});
  html.table({"coordinate", "unit", ""}, coordinates);
  html.paragraph(fmt::format("{} degree{} of freedom", found["dof"].get<long>(), found["dof"] == 1 ? "" : "s"));
  if (!parameters.empty()) html.table({"parameter", "value", "unit"}, parameters, {1});
  for (const Json& f : found["forces"]) {
    forces.push_back({text(f["name"]), text(f["conservative"]), text(f["potential"])});
  }
  if (!forces.empty()) html.table({"force", "conservative", "potential"}, forces);
  std::string source;
  for (const std::string& line : model.lines) source += line + "\n";
  html.preformatted("The model file", source);
}

// Keeps the page small: long formulas are skipped and left to `derive`.
class Formulas {
 public:
  /// `taken`: bytes of the page without `html`.
  Formulas(Html& html, std::size_t taken) : html_(html), taken_(taken) {}

  void add(const std::string& mathml) {
    if (mathml.size() > std::min(longest_formula, room_) ||
        taken_ + html_.text().size() + mathml.size() > largest_page) {
      ++left_out_;
      bytes_ += mathml.size();
      return;
    }
    end();
    room_ -= mathml.size();
    html_.formula(mathml);
  }
  /// Writes how many formulas were skipped since its last call.
  void end() {
    if (left_out_ > 0) {
      html_.paragraph(
          fmt::format("Left out: {} kB of {}, more than a page shows. `eomgen derive` writes {}.",
                      (bytes_ + 999) / 1000, left_out_ == 1 ? "formula" : fmt::format("{} formulas", left_out_),
                      left_out_ == 1 ? "it" : "them"),
          "quiet");
    }
    left_out_ = bytes_ = 0;
  }

 private:
  Html& html_;
  std::size_t taken_, room_ = longest_formulas, left_out_ = 0, bytes_ = 0;
};

/// `taken`: bytes of the rest of the page.
void add_equations(Html& html, const mechanics::Mechanics& m,
                   const std::vector<conservation::ConservedQuantity>& conserved, std::size_t taken) {
  const reading::DisplayForm form = analysis::displayed_form(m);
  html.heading(2, fmt::format("Lagrange's equations, approach {}", system::name(form.approach)));
  Formulas formulas(html, taken);
  const std::vector<std::pair<std::string, std::string>> sections{{"constraints", "Constraints and functions of time"},
                                                                  {"energies", "Energies"},
                                                                  {"equations", "Equations of motion"},
                                                                  {"reactions", "Constraint forces"},
                                                                  {"friction", "Contacts"},
                                                                  {"singular", "Where the equations fail"}};
  for (const auto& [key, title] : sections) {
    const std::vector<print::PrintedFormula> items = print::render(m, form, {key});
    if (items.empty()) continue;
    html.heading(3, title);
    std::string before;
    std::vector<print::PrintedFormula> derivatives;  // of constraints: folded, after the equations
    for (const print::PrintedFormula& item : items) {
      if (key == "constraints" && item.role.ends_with("time derivative") && item.left_out.empty()) {
        derivatives.push_back(item);
        continue;
      }
      if (!item.left_out.empty()) {
        html.paragraph(fmt::format("Left out, {}: {}.", item.name.empty() ? item.key : item.name, item.left_out),
                       "quiet");
        continue;
      }
      const std::string what = item.key == "explicit"   ? "written out"
                               : item.key == "singular" ? "approach " + item.role
                               : item.key == "parts"    ? item.role + (item.name.empty() ? "" : " of " + item.name)
                                                        : item.role;
      if (what != before && !what.empty()) {
        formulas.end();
        html.paragraph(what, "quiet");
      }
      before = what;
      formulas.add(item.mathml);
    }
    formulas.end();
    if (derivatives.empty()) continue;
    html.markup("<details><summary>Their time derivatives</summary>");
    for (const print::PrintedFormula& item : derivatives) {
      formulas.end();
      html.paragraph(item.name + ", " + item.role, "quiet");
      formulas.add(item.mathml);
    }
    formulas.end();
    html.markup("</details>");
  }
  if (conserved.empty()) return;
  html.heading(3, "Conserved");
  for (const conservation::ConservedQuantity& c : conserved) {
    html.paragraph(c.title, "quiet");
    formulas.add(print::render_expression(m, "", "", c.expression).mathml);
    formulas.end();
  }
}

void add_certificate(Html& html, const verify::Certificate& certificate) {
  html.heading(2, "Verification");
  html.paragraph(certificate.summary());
  std::vector<std::vector<std::string>> rows;
  for (const verify::Comparison& c : certificate.comparisons) {
    rows.push_back({c.a, c.b, fmt::format("{:.1e}", c.max_relative_difference), fmt::format("{:.0e}", c.tolerance),
                    c.shares_code ? "shares code" : "independent"});
  }
  html.markup("<details><summary>The comparisons, one by one</summary>");
  html.table({"this", "against", "largest difference", "allowed", ""}, rows, {2, 3});
  html.markup("</details>");
}

void add_run(Html& html, const pipeline::Simulation& simulation, const Json& run, const RecordedMotion& recorded,
             const std::vector<Panel>& curves, bool coarser) {
  html.heading(2, "The run: scene " + simulation.scene.name);
  html.markup("<section id=\"plots\">\n" + recorded.plots(curves) + "</section>");
  if (coarser) {
    html.paragraph(fmt::format("Coarser than of a small system, so that the page stays below 1 MB: {} rows of the run. "
                               "`eomgen run` writes as many as are asked for.",
                               recorded.size()),
                   "quiet");
  }
  html.markup("<section id=\"results\">");  // a page whose model moves puts the tables of its own runs there
  html.table({"", ""},
             {{"outcome", text(run["outcome"]) + (text(run["detail"]).empty() ? "" : ": " + text(run["detail"]))},
              {"solver", fmt::format("{} ({})", text(run["solver"]), text(run["solver_reason"]))},
              {"tolerances", fmt::format("rtol {}, atol {}", simulation.scene.rtol, simulation.scene.atol)},
              {"steps", fmt::format("{} accepted, {} rejected, {} evaluations", text(run["steps"]),
                                    text(run["rejected"]), text(run["rhs_evaluations"]))}});
  std::vector<std::vector<std::string>> rows;
  const Json& estimate = run["error_estimate"];
  for (const auto& [name, value] : run["final"].items()) {
    rows.push_back(
        {name, text(value),
         estimate.is_object() && estimate.contains(name) ? fmt::format("{:.1e}", estimate[name].get<double>()) : ""});
  }
  html.heading(3, "At the end");
  html.table({"", "value", "estimated error"}, rows, {1, 2});
  rows.clear();
  for (const auto& [name, i] : run["invariants"].items()) {
    rows.push_back(
        {name, text(i["initial"]),
         i["max_relative_drift"].is_null() ? "" : fmt::format("{:.1e}", i["max_relative_drift"].get<double>())});
  }
  if (!rows.empty()) {
    html.heading(3, "Conserved");
    html.table({"", "at the start", "largest relative drift"}, rows, {1, 2});
  }
  rows.clear();
  for (const Json& e : run["events"]) rows.push_back({text(e["t"]), text(e["kind"]), text(e["name"])});
  if (!rows.empty()) {
    html.heading(3, "Events");
    html.table({"t", "kind", "of"}, rows, {0});
  }
  html.markup("</section>");
}

int execute(const Options& options, const CommonOptions& common) {
  const std::string file = options.out.empty() ? "report.html" : options.out;
  require_writable_targets({{"--out", file, ".html"}}, locate_model(options.model), common.json);
  RecordedMotion recorded;
  pipeline::SimulationRequest request;
  request.take(scene_request("report", options.model, options, common.seed));
  request.rows = rows_of_a_page(*request.model);
  request.with = {"mass"};  // dragging a point uses the mass matrix
  std::optional<analysis::Drawing> drawing;
  std::optional<analysis::DrawnForces> forces;
  std::vector<std::string> outputs;  // outputs for drawing and plots, without the state
  std::vector<Panel> curves;
  request.prepare = [&](pipeline::DerivedModel& derived) {
    drawing.emplace(derived.mechanics);
    forces.emplace(derived.mechanics, *drawing);
    for (system::EquationSystem& candidate : derived.candidates) {
      drawing->add_outputs(candidate);
      forces->add_outputs(candidate);
    }
    outputs = drawing->outputs();
    outputs.insert(outputs.end(), forces->outputs().begin(), forces->outputs().end());
    curves = panels(
        derived.candidates.front().outputs,
        run::expand_outputs(derived.mechanics, derived.candidates.front(), derived.model.scene(options.scene).outputs));
    for (const Panel& panel : curves) {
      for (const std::string& name : panel.names) {
        if (std::find(outputs.begin(), outputs.end(), name) == outputs.end()) outputs.push_back(name);
      }
    }
    return outputs;
  };
  request.begin = [&](const pipeline::DerivedModel&, const run::Scene&, const std::vector<std::string>& names) {
    recorded.begin(names);
  };
  request.row = [&](double t, std::span<const double> y) { recorded.row(t, y); };
  const pipeline::Simulation simulation = pipeline::simulate(request);
  const model::Model& model = simulation.derived->model;
  const Json run = RunReport{simulation, true}.json();
  std::set<std::string> set;
  for (const auto& [name, value] : request.overrides.values) set.insert(name);
  const analysis::Primitives primitives = analysis::primitives(*drawing, *simulation.derived->mechanics.dag,
                                                               simulation.scene, recorded.values(drawing->outputs()));
  const analysis::LiveModel live = analysis::live_model(simulation, primitives.sizes, outputs, set);
  const analysis::SurfaceCode surfaces = analysis::surface_code(simulation, *drawing);
  const std::string title = model.title.empty() ? model.id : model.title;
  Html html, plots, rest;
  add_model(rest, model, to_json(model, analysis::examine(simulation.derived->shared)));
  add_certificate(rest, simulation.certificate);
  Json kept = Json::array();  // names of conserved quantities
  for (const auto& [name, values] : run["invariants"].items()) kept.push_back(name);
  std::string motion;
  std::size_t taken = 0;
  for (bool coarser = *request.rows < most_rows;; coarser = true) {
    Json moving = recorded.json(simulation, *drawing, primitives, *forces, live, outputs, curves);
    if (!moving.is_null()) moving["kept"] = kept;
    motion = moving.is_null() ? "" : serialised(moving);
    plots = Html();
    add_run(plots, simulation, run, recorded, curves, coarser);
    taken = render_page({title, plots.text() + rest.text(), motion, live.script, live.name, surfaces.script,
                         surfaces.name, live.has_contacts()})
                .size();
    if (taken <= largest_motion || recorded.size() <= fewest_rows) break;
    recorded.drop_every_second_row();
  }
  add_head(html, model, !motion.empty());
  add_equations(html, simulation.derived->mechanics, simulation.derived->conserved, taken);
  write_text(file, render_page({title, html.text() + plots.text() + rest.text(), motion, live.script, live.name,
                                surfaces.script, surfaces.name, live.has_contacts()}));
  const eom::Outcome outcome = simulation.result.outcome;
  print_result(common.json,
               {{"format", 1},
                {"model", model.id},
                {"scene", simulation.scene.name},
                {"outcome", eom::name(outcome)},
                {"file", file}},
               fmt::format("wrote {} (outcome of the run: {})\n", file, eom::name(outcome)), is_standard_output(file));
  return outcome == eom::Outcome::done || outcome == eom::Outcome::stopped_by_event ? 0 : 3;
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/").required();
  app.add_output_path("-o,--out", options->out, "the page; without it report.html in this folder");
  add_scene(app, *options);
  add_solver(app, *options);
  add_values(app, *options);
  app.add_option("--t-end", options->t_end, "the end of the run").check(finite_number());
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::report_command

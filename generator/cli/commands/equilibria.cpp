// SPDX-License-Identifier: GPL-3.0-or-later
// Command equilibria: equilibria and steady motions of a model with their stability.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <eom/layout.hpp>
#include <optional>

#include "analysis/steady_search.hpp"
#include "analysis/trim.hpp"
#include "cli/assignments.hpp"
#include "cli/commands/commands.hpp"
#include "cli/eigenvalues.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/shared_options.hpp"
#include "cli/stage_monitor.hpp"
#include "pipeline/limits.hpp"
#include "work.hpp"

namespace eomgen::cli::equilibria_command {
namespace {

struct Options : SceneOptions {
  std::string model;
  std::vector<std::string> hold, trim;
  std::optional<double> at;
  std::uint64_t starts = 300;
};

Json to_json(const linear::StabilityVerdict& verdict) {
  if (verdict.stability == linear::Stability::unknown) return "unknown";
  return verdict.stability == linear::Stability::stable;
}

/// Estimates from the visits of the points how many were not found.
std::string completeness(const linear::SearchResult& search) {
  const std::optional<double> probability = search.new_point_probability();
  if (!probability) return "";
  if (*probability == 0) return "; each point was reached more than once";
  return fmt::format(
      "; some points were reached once, so that a further start finds a new one with a probability of "
      "about {:.1g}: --starts makes more",
      *probability);
}

Json points_to_json(const analysis::SteadyMotions& found) {
  const std::vector<std::string>& names = found.problem.flow->names();
  return list_of(found.points, [&](const analysis::SteadyMotion& point) -> Json {
    Json values = Json::object();
    for (std::size_t i = 0; i + 1 < point.l.z.size(); ++i) values[names[i]] = display_value(point.l.z[i]);
    return {{"kind", linear::name(point.l.kind)},
            {"values", values},
            {"eigenvalues", list_of(point.l.spectrum.values, eigenvalue_json)},
            {"structural_zeros", point.l.structural_zeros},
            {"stable", to_json(point.verdict)},
            {"reason", point.verdict.reason},
            {"family", point.family_dimension},
            {"off", point.l.parameter_change}};
  });
}

Json to_json(const analysis::SteadyMotions& found, const Options& options) {
  const auto second_chart = [](const analysis::SecondChartSearch& search) {
    Json entry = EOMGEN_MEMBERS(search.chart, of, own, second);
    entry["where"] = search.where;
    entry["points"] = search.found ? points_to_json(*search.found) : Json::array();
    entry["skipped"] = search.found ? Json(nullptr) : Json(search.skip_reason);
    return entry;
  };
  return {
      {"format", 1},
      {"points", points_to_json(found)},
      {"second_charts", list_of(found.second_charts, second_chart)},
      {"open_contacts", found.problem.open_contacts},
      {"in_contact", found.in_contact},
      {"held", list_of(found.held, [](const analysis::HeldValue& h) { return EOMGEN_MEMBERS(h, name, value, why); })},
      {"held_in_vain", found.search.held_in_vain},
      {"starts", options.starts},
      {"converged", found.search.converged},
      {"new_point_probability", or_null(found.search.new_point_probability())},
      {"further_members", found.search.further_members},
      {"refused", found.search.failed_starts},
      {"singular", found.singular ? Json(found.singular.what) : Json(nullptr)},
      {"interrupted", found.search.interrupted},
      {"certificate", found.problem.certificate}};
}

std::string text(const analysis::SteadyMotion& point, const linear::Flow& flow) {
  const std::vector<std::string>& names = flow.names();
  const std::size_t n = flow.coordinates();
  std::string out = fmt::format("\n{}, {}: {}\n", linear::name(point.l.kind), linear::in_words(point.verdict.stability),
                                point.verdict.reason);
  if (point.family_dimension > 0)
    out += fmt::format("  one of a family of {} dimension{}\n", point.family_dimension,
                       point.family_dimension == 1 ? "" : "s");
  if (point.l.parameter_change > 0)
    out += fmt::format(
        "  but for roundings: parameters and inputs that differ by {:.1g} of themselves would make it one\n",
        point.l.parameter_change);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool rest = point.l.kind == linear::MotionKind::equilibrium && eom::StateLayout{n}.is_rate(i);  // all are 0
    if (!rest) out += fmt::format("  {:<24} {:>24}\n", names[i], display_value(point.l.z[i]));
  }
  out += "  eigenvalues";
  for (std::size_t i = 0; i < point.l.spectrum.values.size(); ++i) {
    const linear::Eigenvalue& e = point.l.spectrum.values[i];
    if (e.im < 0 || (e.re == 0 && e.im == 0)) continue;  // one of each conjugate pair
    out += e.im == 0 ? fmt::format("  {:.8g}", e.re) : fmt::format("  {:.8g} +- {:.8g}i", e.re, e.im);
    if (!e.is_reliable()) out += " (uncertain)";
  }
  return out + fmt::format("  and {} zeros, {} of them structural\n", point.l.spectrum.zeros, point.l.structural_zeros);
}

/// "the angles 313 of 'top' are singular".
std::string in_words(const model::ChartPair& chart) {
  const bool rotation = chart.kind == model::ChartPair::Kind::rotation;
  return fmt::format("{} {} of '{}' are singular", rotation ? "the angles" : "the coordinates", chart.own, chart.of);
}

std::string text(const analysis::SteadyMotions& found, const Options& options) {
  std::string out =
      fmt::format("{}, scene {}: {} found\n", found.problem.derived->model.id, found.problem.scene.name,
                  found.points.empty() ? "no equilibrium and no steady motion"
                                       : fmt::format("{} equilibria and steady motions", found.points.size()));
  for (const analysis::HeldValue& h : found.held) out += fmt::format("  held: {} = {} ({})\n", h.name, h.value, h.why);
  for (const analysis::SteadyMotion& point : found.points) out += text(point, *found.problem.flow);
  for (const analysis::SecondChartSearch& search : found.second_charts) {
    out += fmt::format(
        "\nleft out          {} where {}: {}\n", in_words(search.chart), search.where,
        search.found ? fmt::format("{} found there, at rest, in {}", search.found->points.size(), search.chart.second)
                     : fmt::format("not examined: {}", search.skip_reason));
    if (!search.found) continue;
    for (const analysis::SteadyMotion& point : search.found->points) out += text(point, *search.found->problem.flow);
  }
  if (!found.problem.open_contacts.empty()) {
    out += fmt::format("\ncontacts          open: {}; {} of the points found would not leave them open\n",
                       fmt::join(found.problem.open_contacts, ", "), found.in_contact);
  }
  if (found.search.further_members > 0) {
    out += fmt::format("\nfurther           {} of the starts led to further members of families, which are not shown\n",
                       found.search.further_members);
  }
  if (found.search.failed_starts > 0) {
    out += fmt::format("\nrefused           {} of the starts ended where the equations have no slope: {}\n",
                       found.search.failed_starts, found.search.reason);
  }
  if (found.singular) {
    out += fmt::format("\nnot examined      {}: motions there need other coordinates; {}\n", found.singular.what,
                       found.singular.remedy);
  }
  return out + fmt::format("\nsearch            {} starts, of which {} led to one{}\ncertificate       {}\n",
                           options.starts, found.search.converged, completeness(found.search),
                           found.problem.certificate);
}

Json to_json(const analysis::SteadyProblem& problem, const analysis::Trim& trim) {
  Json inputs = Json::object(), values = Json::object();
  const std::vector<model::Input>& all = problem.derived->model.inputs;
  for (std::size_t i = 0; i < all.size(); ++i) inputs[all[i].name] = display_value(trim.inputs[i]);
  for (std::size_t i = 0; i + 1 < trim.z.size(); ++i) values[problem.flow->names()[i]] = display_value(trim.z[i]);
  return {{"format", 1},
          {"points", Json::array()},
          {"trim",
           {{"chosen", trim.chosen},
            {"inputs", inputs},
            {"values", values},
            {"residual", trim.residual},
            {"unique", trim.unique}}},
          {"certificate", problem.certificate}};
}

std::string text(const analysis::SteadyProblem& problem, const analysis::Trim& trim) {
  std::string out = fmt::format("{}, scene {}, t = {}: inputs that hold this state\n\n", problem.derived->model.id,
                                problem.scene.name, problem.t);
  for (std::size_t i = 0; i + 1 < trim.z.size(); ++i)
    out += fmt::format("  {:<24} {:>24}\n", problem.flow->names()[i], display_value(trim.z[i]));
  out += "\ninputs\n";
  const std::vector<model::Input>& all = problem.derived->model.inputs;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool kept = std::find(trim.chosen.begin(), trim.chosen.end(), all[i].name) == trim.chosen.end();
    out += fmt::format("  {:<24} {:>24}{}\n", all[i].name, display_value(trim.inputs[i]),
                       kept ? "   as in the scene" : "");
  }
  if (!trim.unique) out += "\nunique            no: other inputs hold it too; these are the smallest changes\n";
  return out + fmt::format("\nresidual          {:.1e}, the largest acceleration that remains\ncertificate       {}\n",
                           trim.residual, problem.certificate);
}

int execute_trim(const Options& options, const CommonOptions& common) {
  if (!options.hold.empty())
    throw Error("equilibria", {}, "--trim and --hold exclude one another",
                "hold quantities with --hold, or a state with --trim");
  const std::shared_ptr<const model::Model> model = load_model(options.model);
  const analysis::SteadyProblem problem =
      analysis::steady_problem("equilibria", model, options.scene, overrides_of("equilibria", options, *model),
                               options.at, common.seed, analysis::Contacts::open);
  const analysis::Trim trim = analysis::trim_inputs(problem, options.trim);
  print_result(common.json, to_json(problem, trim), text(problem, trim));
  return 0;
}

int execute(const Options& options, const CommonOptions& common) {
  if (!options.trim.empty()) return execute_trim(options, common);
  if (options.at)
    throw Error("equilibria", {}, "--at chooses the state of --trim", "give --trim too, or leave --at out");
  analysis::SteadyRequest request;
  request.take(scene_request("equilibria", options.model, options, common.seed));
  for (const auto& [name, quantity] : parse_assignments("equilibria", "--hold", options.hold))
    request.hold[name] = quantity.value;
  request.starts = options.starts;
  request.second_charts = true;
  bool shown = false;
  if (isatty(STDERR_FILENO) != 0) {
    request.progress = [&shown](double fraction) {
      shown = true;
      print_message(fmt::format("\r{:5.1f} % of the starts ", 100 * fraction));
    };
  }
  const analysis::SteadyMotions found = analysis::steady_motions(request);
  const work::DeferInterrupt kept;
  if (shown) print_message(fmt::format("\r{:40}\r", ""));
  print_result(common.json, to_json(found, options), text(found, options));
  if (found.search.interrupted) {
    print_interrupted(nullptr);
    return exit_interrupted;
  }
  return 0;
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/").required();
  app.add_option("--scene", options->scene, "a scene: its parameters, and the start whose momenta are held")
      .show_default();
  add_values(app, *options);
  app.add_list("--hold", options->hold, "OUTPUT=VALUE in place of the conserved momenta; may be repeated");
  app.add_list("--trim", options->trim,
               "in place of the search: values of these inputs that hold the start of the scene");
  app.add_option("--at", options->at, "with --trim: the state that the scene's run has reached then")
      .check(finite_number());
  app.add_option("--starts", options->starts, "how many starts the search has")
      .check(whole_number(limits::search_starts.least, limits::search_starts.most))
      .show_default();
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::equilibria_command

// SPDX-License-Identifier: GPL-3.0-or-later
// Command linearize: linearises the equations of motion at the start of a scene, or at a later time.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "analysis/output_slopes.hpp"
#include "analysis/steady.hpp"
#include "cli/commands/commands.hpp"
#include "cli/eigenvalues.hpp"
#include "cli/locate.hpp"
#include "cli/output.hpp"
#include "cli/shared_options.hpp"
#include "lists.hpp"

namespace eomgen::cli::linearize_command {
namespace {

struct Options : SceneOptions {
  std::string model;
  std::optional<double> at;
  std::vector<std::string> outputs;
};

struct Answer {
  const analysis::SteadyProblem& problem;
  const linear::Linearisation& l;
  const analysis::OutputSlopes& outputs;

  std::vector<std::string> names(const std::vector<std::size_t>& places) const {
    return mapped(places, [&](std::size_t i) { return problem.flow->names()[i]; });
  }
  std::vector<std::string> states() const { return names(l.symmetry.chart.independent); }
  /// Those of the model. Forces and modes of contacts are internal ones.
  std::vector<std::string> inputs() const {
    std::vector<std::string> result;
    for (const model::Input& input : problem.derived->model.inputs) {
      if (input.source != model::Input::Source::contacts) result.push_back(input.name);
    }
    return result;
  }
  std::vector<std::string> ignorable() const { return names(linear::ignorable_entries(l.symmetry)); }
  /// Entries that differ from those of the state: a state that is an equilibrium or steady motion but for roundings is
  /// moved to it.
  std::vector<std::pair<std::string, double>> moved() const {
    std::vector<std::pair<std::string, double>> result;
    for (std::size_t i = 0; i + 1 < l.z.size(); ++i) {
      if (display_value(l.z[i]) != display_value(problem.z[i]))
        result.emplace_back(problem.flow->names()[i], display_value(l.z[i] - problem.z[i]));
    }
    return result;
  }
  std::size_t accidental() const { return l.spectrum.zeros - l.structural_zeros; }
  std::string what() const {
    const std::string off =
        l.parameter_change > 0
            ? fmt::format(
                  " but for roundings: parameters and inputs that differ by {:.1g} of themselves would make it one",
                  l.parameter_change)
            : "";
    switch (l.kind) {
      case linear::MotionKind::equilibrium: return "an equilibrium" + off;
      case linear::MotionKind::steady: return "a steady motion" + off + ": only ignorable coordinates change";
      case linear::MotionKind::motion: break;
    }
    return l.symmetry.autonomous ? "neither an equilibrium nor a steady motion: A(t) along the motion, at this instant"
                                 : "no steady motion, since the equations depend on t: A(t), at this instant";
  }
};

Json rows(const linear::Matrix<linear::Precise>& A) {
  Json result = Json::array();
  for (std::size_t i = 0; i < A.rows; ++i) {
    result.push_back(Json::array());
    for (std::size_t j = 0; j < A.cols; ++j) result.back().push_back(display_value(A(i, j)));
  }
  return result;
}

Json values_of(const analysis::OutputSlopes& outputs) {
  Json values = Json::object();
  for (std::size_t k = 0; k < outputs.names.size(); ++k) values[outputs.names[k]] = display_value(outputs.values[k]);
  return values;
}

constexpr const char* of_open_contact = "it belongs to a contact that is open";

Json left_out(const analysis::OutputSlopes& outputs, const std::vector<std::string>& open_outputs) {
  Json list = list_of(outputs.left_out, [](const auto& output) { return EOMGEN_MEMBERS(output, name, reason); });
  for (const std::string& name : open_outputs) list.push_back({{"name", name}, {"reason", of_open_contact}});
  return list;
}

Json to_json(const Answer& a) {
  Json point = Json::object(), moved = Json::object();
  Json modes = Json::object();
  for (const auto& [contact, mode] : a.problem.modes) modes[contact] = mode;
  for (std::size_t i = 0; i + 1 < a.l.z.size(); ++i) point[a.problem.flow->names()[i]] = display_value(a.l.z[i]);
  for (const auto& [name, distance] : a.moved()) moved[name] = distance;
  return {{"format", 1},
          {"kind", linear::name(a.l.kind)},
          {"autonomous", a.l.symmetry.autonomous},
          {"t", a.problem.t},
          {"point", point},
          {"moved", moved},
          {"states", a.states()},
          {"inputs", a.inputs()},
          {"A", rows(a.l.A)},
          {"B", rows(a.l.B)},
          {"outputs", values_of(a.outputs)},
          {"C", rows(a.outputs.C)},
          {"D", rows(a.outputs.D)},
          {"outputs_left_out", left_out(a.outputs, a.problem.without_value)},
          {"eigenvalues", list_of(a.l.spectrum.values, eigenvalue_json)},
          {"eigenvalues_hold", a.l.spectrum.is_reliable()},
          {"off", a.l.parameter_change},
          {"structural_zeros", a.l.structural_zeros},
          {"other_zeros", a.accidental()},
          {"ignorable", a.ignorable()},
          {"dependent", a.names(a.l.symmetry.chart.dependent)},
          {"open_contacts", a.problem.open_contacts},
          {"modes", modes},
          {"certificate", a.problem.certificate}};
}

std::string matrix_text(const char* title, const linear::Matrix<linear::Precise>& A,
                        const std::vector<std::string>& rows, const std::vector<std::string>& columns) {
  std::size_t width = 4;
  for (const std::string& name : rows) width = std::max(width, name.size());
  std::string out = fmt::format("\n{:<{}}", title, width + 2);
  for (const std::string& name : columns) out += fmt::format(" {:>14}", name);
  out += "\n";
  for (std::size_t i = 0; i < A.rows; ++i) {
    out += fmt::format("  {:<{}}", rows[i], width);
    for (std::size_t j = 0; j < A.cols; ++j) out += fmt::format(" {:>14.7g}", display_value(A(i, j)));
    out += "\n";
  }
  return out;
}

std::string text(const Answer& a) {
  const auto& chart = a.l.symmetry.chart;
  std::string out = fmt::format("{}, scene {}, t = {}: {}\n\n", a.problem.derived->model.id, a.problem.scene.name,
                                a.problem.t, a.what());
  for (const std::size_t i : chart.independent)
    out += fmt::format("  {:<24} {:>24}\n", a.problem.flow->names()[i], display_value(a.l.z[i]));
  for (const std::size_t i : chart.dependent) {
    out += fmt::format("  {:<24} {:>24}   follows from the constraints\n", a.problem.flow->names()[i],
                       display_value(a.l.z[i]));
  }
  for (const auto& [name, distance] : a.moved())
    out += fmt::format("moved             {} by {:.1e}, to where the balance holds\n", name, distance);
  out += matrix_text("A", a.l.A, a.states(), a.states());
  if (!a.inputs().empty()) out += matrix_text("B", a.l.B, a.states(), a.inputs());
  if (!a.outputs.names.empty()) {
    out += matrix_text("C", a.outputs.C, a.outputs.names, a.states());
    if (!a.inputs().empty()) out += matrix_text("D", a.outputs.D, a.outputs.names, a.inputs());
  }
  std::string left_out;
  for (const analysis::OutputSlopes::LeftOut& output : a.outputs.left_out)
    left_out +=
        fmt::format("left out          the output '{}' has no slope at this state: {}\n", output.name, output.reason);
  for (const std::string& name : a.problem.without_value)
    left_out += fmt::format("left out          the output '{}': {}\n", name, of_open_contact);
  if (!left_out.empty()) out += "\n" + left_out;
  out += "\neigenvalues\n";
  for (std::size_t i = 0; i < a.l.spectrum.values.size(); ++i)
    out += fmt::format("  {}\n", eigenvalue_text(a.l.spectrum, i));
  out += fmt::format("\nzeros             {} structural (there for all parameters), {} at these parameters only\n",
                     a.l.structural_zeros, a.accidental());
  if (!a.problem.open_contacts.empty())
    out += fmt::format("open contacts     {}: the equations hold while they are open\n",
                       fmt::join(a.problem.open_contacts, ", "));
  std::vector<std::string> held;
  for (const auto& [contact, mode] : a.problem.modes) {
    if (mode != "open") held.push_back(contact + " " + mode);
  }
  if (!held.empty())
    out += fmt::format("held contacts     {}: the equations hold in these modes\n", fmt::join(held, ", "));
  if (!a.ignorable().empty()) out += fmt::format("ignorable         {}\n", fmt::join(a.ignorable(), ", "));
  return out + fmt::format("certificate       {}\n", a.problem.certificate);
}

int execute(const Options& options, const CommonOptions& common) {
  const std::shared_ptr<const model::Model> model = load_model(options.model);
  const analysis::SteadyProblem problem =
      analysis::steady_problem("linearize", model, options.scene, overrides_of("linearize", options, *model),
                               options.at, common.seed, analysis::Contacts::held);
  const linear::Linearisation l = analysis::linearise_at_state(problem, common.seed);
  const analysis::OutputSlopes outputs = analysis::linearise_outputs(problem, l, options.outputs);
  const Answer answer{problem, l, outputs};
  print_result(common.json, to_json(answer), text(answer));
  return 0;
}

}  // namespace

Execute declare(Arguments& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/").required();
  add_scene(app, *options);
  app.add_option("--at", options->at, "a time: the state that the scene's run has reached then; without it the start")
      .check(finite_number());
  app.add_list("--output", options->outputs, "the outputs of C and D, in place of the scene's");
  add_values(app, *options);
  return [options](const CommonOptions& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli::linearize_command

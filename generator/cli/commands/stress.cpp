// SPDX-License-Identifier: GPL-3.0-or-later
// Every solver through stiff and extreme variations of a scene: kept, told, or silent.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/commands/commands.hpp"
#include "cli/decimal.hpp"
#include "cli/interrupt.hpp"
#include "cli/output.hpp"
#include "cli/simulate.hpp"
#include "cli/usage.hpp"
#include "run/integration.hpp"
#include "stress/audit.hpp"
#include "stress/start.hpp"

namespace eomgen::cli {
namespace {

using Json = nlohmann::ordered_json;
using stress::Row;
using stress::Verdict;

struct Options {
  std::string model, scene = "default";
  std::vector<std::string> set, solvers;
  std::optional<double> t_end;
  double seconds = 60;
  std::size_t steps = 20000;
  bool quick = false;
};

struct LeftOut {
  std::string test, reason;
};

/// Denormal numbers too, which CLN's own conversion refuses.
symbolic::Rational exactly(double value) {
  if (std::abs(value) >= std::numeric_limits<double>::min()) return cln::rational(cln::cl_DF(value));
  constexpr int shift = 200;
  return cln::rational(cln::cl_DF(std::ldexp(value, shift))) / cln::expt_pos(cln::cl_I(2), shift);
}

/// The scene of one case, made anew from the model where constants change.
class Variation {
 public:
  Variation(const Simulation& simulation, const run::Overrides& overrides, const run::Code& code)
      : simulation_(simulation), overrides_(overrides), code_(code) {}

  std::optional<run::Scene> scene(const stress::Case& test, std::string& why) const {
    Derived& derived = *simulation_.derived;
    run::Overrides overrides = overrides_;
    for (const auto& [p, factor] : test.factor) {
      overrides.parameters[derived.model.parameters[p].name] = exactly(simulation_.scene.parameters[p] * factor);
    }
    for (const auto& [p, value] :
         test.value) {  // what follows from them is computed anew, and a start that they break is refused
      if (std::isfinite(value)) overrides.parameters[derived.model.parameters[p].name] = exactly(value);
    }
    if (test.rtol) {
      overrides.rtol = *test.rtol;
      overrides.atol = *test.rtol * (simulation_.scene.rtol > 0 ? simulation_.scene.atol / simulation_.scene.rtol : 1);
    }
    run::Scene scene = run::resolve_scene(derived.mechanics, derived.candidates.front(),
                                          derived.model.scene(simulation_.scene.name), overrides);
    for (const auto& [p, value] : test.value) {
      if (!std::isfinite(value)) scene.parameters[p] = value;
    }
    const bool constrained = !derived.mechanics.active.empty();
    std::vector<std::uint32_t> kept;
    for (const auto& [i, value] : test.start) {
      scene.q[i] = value;
      kept.push_back(i);
    }
    for (const std::uint32_t i : derived.mechanics.free) {
      if (test.zeros && scene.q[i] == 0) scene.q[i] = *test.zeros;
      if (test.zeros && scene.qdot[i] == 0) scene.qdot[i] = *test.zeros;
    }
    if (constrained && !kept.empty() &&
        !stress::meet_constraints(scene, run_request(derived, scene, code_, false), kept)) {
      why = "the constraints allow no start there";
      return std::nullopt;
    }
    for (double& rate : scene.qdot) rate *= test.speed;
    scene.t1 = scene.t0 + (scene.t1 - scene.t0) * test.span / (test.speed > 1 ? test.speed : 1);
    if (constrained && test.speed != 1 && broken(scene, test.speed)) {
      why = "the constraints move, so that their velocities cannot be multiplied";
      return std::nullopt;
    }
    return scene;
  }

 private:
  bool broken(const run::Scene& scene, double speed) const {
    const run::RunRequest request = run_request(*simulation_.derived, scene, code_, false);
    run::Integration integration(request, "dop853");
    const std::vector<double> x = integration.initial_state();
    double largest = 0;
    for (const double v : x) largest = std::max(largest, std::abs(v));
    return integration.constraint_defect(scene.t0, x.data()) >
           run::start_tolerance * std::max(1.0, largest) * std::max(1.0, speed);
  }

  const Simulation& simulation_;
  const run::Overrides& overrides_;
  const run::Code& code_;
};

/// Each constraint once more under another name: what follows from others has to be found before anything is derived.
void repeat_constraints(const model::Model& given, std::vector<Row>& rows, std::vector<LeftOut>& left_out) {
  for (std::size_t c = 0; c < given.constraints.size(); ++c) {
    if (given.constraints[c].joint) continue;  // its equations may repeat others, and are left out where they do
    model::Model model = given;
    model.constraints.push_back(given.constraints[c]);
    model.constraints.back().name += "_again";
    model.constraints.back().unit = false;  // the second one is no part of a rotation
    const std::string test = fmt::format("constraint {} twice", given.constraints[c].name);
    try {
      mechanics::build_mechanics(model);
      rows.push_back({.test = test,
                      .solver = "none",
                      .verdict = Verdict::silent,
                      .outcome = "accepted",
                      .note = "a constraint that repeats another is taken for one more"});
    } catch (const Error& error) {
      left_out.push_back({test, "refused: " + error.message()});
    }
  }
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json of(const stress::Extreme& extreme) {
  if (extreme.value == stress::no_value) return nullptr;
  return {{"value", number(extreme.value)}, {"case", extreme.at}};
}

Json of(const stress::Audit& audit) {
  Json denominators = Json::array();
  for (const stress::Denominator& d : audit.denominators) {
    const bool seen = d.smallest != stress::no_value;
    denominators.push_back({{"expression", d.expression},
                            {"zero", d.zero},
                            {"test", d.test},
                            {"smallest", seen ? Json(d.smallest) : Json(nullptr)},
                            {"largest", seen ? Json(d.largest) : Json(nullptr)},
                            {"case", d.at}});
  }
  return {{"states", audit.states},
          {"denominators", denominators},
          {"mass_condition", of(audit.mass_condition)},
          {"scaled_mass_condition", of(audit.scaled_mass_condition)},
          {"pivot_cancellation", of(audit.pivot)},
          {"digits_lost", of(audit.digits_lost)},
          {"without_value", audit.without_digits}};
}

Json document(const Simulation& simulation, const std::vector<Row>& rows, const std::vector<LeftOut>& left_out,
              const stress::Audit& audit) {
  Json list = Json::array(), without = Json::array();
  std::map<Verdict, std::size_t> count;
  for (const Row& row : rows) {
    ++count[row.verdict];
    list.push_back({{"case", row.test},
                    {"solver", row.solver},
                    {"verdict", stress::name(row.verdict)},
                    {"error", number(row.error)},
                    {"estimate", number(row.estimate)},
                    {"condition", number(row.condition)},
                    {"seconds", row.seconds},
                    {"outcome", row.outcome},
                    {"note", row.note}});
  }
  for (const LeftOut& l : left_out) without.push_back({{"case", l.test}, {"reason", l.reason}});
  return {{"format", 1},
          {"model", simulation.derived->model.id},
          {"scene", simulation.scene.name},
          {"rows", list},
          {"left_out", without},
          {"kept", count[Verdict::kept]},
          {"told", count[Verdict::told]},
          {"silent", count[Verdict::silent]},
          {"denominator_audit", of(audit)},
          {"verdict", count[Verdict::silent] == 0 ? "pass" : "fail"}};
}

void print_audit(const Json& audit) {
  const auto value = [](const Json& v, const char* format) {
    return v.is_null() ? std::string("none") : fmt::format(fmt::runtime(format), v.get<double>());
  };
  fmt::print("denominator audit, {} states\n", audit["states"].get<std::size_t>());
  for (const auto& [key, what] : {std::pair{"mass_condition", "condition of the mass matrix"},
                                  {"scaled_mass_condition", "with its diagonal scaled to 1"},
                                  {"pivot_cancellation", "largest cancellation in a pivot"},
                                  {"digits_lost", "digits lost, of 16"}}) {
    const Json& extreme = audit[key];
    if (!extreme.is_null())
      fmt::print("  {:<32}{:>10}  {}\n", what, value(extreme["value"], "{:.3g}"), extreme["case"].get<std::string>());
  }
  if (!audit["denominators"].empty()) fmt::print("  {:<32}{:>10}\n", "divided by, zero where", "least");
  for (const Json& d : audit["denominators"]) {
    fmt::print("  {:<32}{:>10}  {}; {}\n", d["zero"].get<std::string>(), value(d["smallest"], "{:.2g}"),
               d["case"].get<std::string>(), d["test"].get<std::string>());
  }
  fmt::print("\n");
}

void print_readable(const Json& found, const std::vector<std::string>& solvers) {
  fmt::print("model  {}, scene {}\n\n  {:<28}", found["model"].get<std::string>(), found["scene"].get<std::string>(),
             "case");
  for (const std::string& solver : solvers) fmt::print(" {:>9}", solver);
  std::string test;
  std::size_t column = 0;
  for (const Json& row : found["rows"]) {
    if (row["case"] != test) {
      test = row["case"].get<std::string>();
      fmt::print("\n  {:<28}", test);
      column = 0;
    }
    for (; column < solvers.size() && solvers[column] != row["solver"]; ++column) fmt::print(" {:>9}", "-");
    ++column;
    fmt::print(" {:>9}", row["verdict"] == "silent" ? "SILENT" : row["verdict"].get<std::string>());
  }
  fmt::print("\n\n");
  for (const Json& l : found["left_out"])
    fmt::print("left out: {}: {}\n", l["case"].get<std::string>(), l["reason"].get<std::string>());
  print_audit(found["denominator_audit"]);
  for (const Json& row : found["rows"]) {
    if (row["verdict"] != "silent") continue;
    const auto shown = [&](const char* key) {
      return row[key].is_null() ? std::string("none") : fmt::format("{:.2e}", row[key].get<double>());
    };
    fmt::print("silent: {}, {}: error {}, estimate {}, condition {}, outcome {} {}\n", row["case"].get<std::string>(),
               row["solver"].get<std::string>(), shown("error"), shown("estimate"), shown("condition"),
               row["outcome"].get<std::string>(), row["note"].get<std::string>());
  }
  fmt::print("{}: {} kept, {} told, {} silent\n", found["verdict"].get<std::string>(), found["kept"].get<std::size_t>(),
             found["told"].get<std::size_t>(), found["silent"].get<std::size_t>());
}

std::vector<std::string> chosen_solvers(const Options& options) {
  std::vector<std::string> known{eom::Automatic::name};
  for (const eom::MethodInfo& method : eom::methods()) {
    known.emplace_back(method.name);
  }
  for (const std::string& name : options.solvers) {
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error("stress", {}, fmt::format("there is no solver '{}'", name), choice_of(name, known));
  }
  if (options.solvers.empty()) return known;
  std::erase_if(known, [&](const std::string& name) {
    return std::find(options.solvers.begin(), options.solvers.end(), name) == options.solvers.end();
  });
  return known;
}

SimulationRequest simulation_request(const Options& options, const Common& common) {
  SimulationRequest request;
  request.model = options.model;
  request.scene = options.scene;
  request.overrides.parameters = parse_assignments("stress", options.set);
  request.overrides.t_end = options.t_end;
  request.overrides.solver = "dop853";
  request.overrides.step = 0;
  request.with = {"mass"};
  request.every_solver = true;
  request.integrate = false;
  request.seed = common.seed;
  return request;
}

int execute(const Options& options, const Common& common) {
  const std::vector<std::string> solvers = chosen_solvers(options);
  const SimulationRequest wanted = simulation_request(options, common);
  const Simulation simulation = simulate(wanted);
  const Interrupt interrupt;
  const run::Code code = simulation.code.for_run();
  const Variation variation(simulation, wanted.overrides, code);
  stress::Request request;
  request.run = [&](const run::Scene& scene) { return run_request(*simulation.derived, scene, code, true); };
  request.solvers = solvers;
  request.seconds_limit = options.seconds;
  request.steps_limit = options.steps;
  request.interrupt = &Interrupt::flag();
  const bool terminal = isatty(STDERR_FILENO) != 0;
  if (terminal) request.progress = [](const std::string& what) { tell(fmt::format("\r{:60}\r{}", "", what)); };
  stress::Auditor auditor(simulation.derived->mechanics, simulation.program);
  request.seen = [&](const stress::Case& test, const run::Scene& scene, const std::vector<stress::Sample>& samples) {
    auditor.see(test.name, scene, code, samples);
  };
  std::vector<Row> rows;
  std::vector<LeftOut> left_out;
  for (const stress::Case& test : stress::cases(simulation.derived->mechanics, simulation.scene, options.quick)) {
    if (Interrupt::flag()) break;
    std::string why;
    try {
      if (const std::optional<run::Scene> scene = variation.scene(test, why)) {
        for (Row& row : stress::judge(test, *scene, request, why)) rows.push_back(std::move(row));
      }
    } catch (const Error& error) {  // a start or a value that is refused is told
      if (error.stage() != "scene") throw;
      why = "refused: " + error.message();
    }
    if (!why.empty()) left_out.push_back({test.name, why});
  }
  repeat_constraints(simulation.derived->model, rows, left_out);
  if (terminal) tell(fmt::format("\r{:60}\r", ""));
  const Json found = document(simulation, rows, left_out, auditor.audit());
  if (common.json) {
    print_document(found);
  } else {
    print_readable(found, solvers);
  }
  return Interrupt::flag() ? 3 : found["verdict"] == "pass" ? 0 : 1;
}

}  // namespace

Execute declare_stress(CLI::App& app) {
  auto options = std::make_shared<Options>();
  app.add_option("MODEL", options->model, "a model file, or the name of one in models/")->required();
  app.add_option("--scene", options->scene, "a scene of the model")->capture_default_str();
  add_list(app, "--set", options->set, "PARAMETER=VALUE in SI units; may be repeated");
  app.add_option("--t-end", options->t_end, "the end of the run")->check(finite_number());
  add_list(app, "--solver", options->solvers, "only these solvers");
  app.add_option("--steps", options->steps, "what takes more is ended, and told")
      ->check(CLI::Range(std::size_t{100}, std::size_t{1000000000}))
      ->capture_default_str();
  app.add_option("--seconds", options->seconds, "a guard: what takes longer is interrupted, and told")
      ->check(positive_number())
      ->capture_default_str();
  app.add_flag("--quick", options->quick, "a few variations of each kind");
  return [options](const Common& common) { return execute(*options, common); };
}

}  // namespace eomgen::cli

// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/scene.hpp"

#include <cln/exception.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/hybrid/jumps.hpp>
#include <eom/hybrid/samples.hpp>
#include <limits>

#include "derive/imposition.hpp"
#include "model/charts.hpp"
#include "numeric/dense.hpp"
#include "numeric/numbers.hpp"
#include "run/bind.hpp"
#include "run/monitored_functions.hpp"
#include "run/parameters.hpp"
#include "run/rim_start.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::run {
namespace {

using mechanics::Mechanics;

constexpr int digits = 40;

// Expressions of a scene are evaluated once, at its start.
class SceneEvaluator {
 public:
  SceneEvaluator(Mechanics& m, const std::vector<cln::cl_R>& parameters)
      : m_(m), parameters_(parameters), written_(derive::time_function_substitution(m)) {}

  double number(model::NodeId id, const char* what) { return number(mechanics::lower_scalar(m_, id), id, what); }
  void set_start(double t0) { t0_ = numeric::exact(t0); }
  /// Rejects a time at which a closed form of an integral divides by 0: it has no value there, and neither has the run.
  void require_integrals(double t) {
    const cln::cl_R start = t0_;
    t0_ = numeric::exact(t);
    for (std::uint32_t i = 0; i < m_.model->states.size(); ++i) {
      const model::State& state = m_.model->states[i];
      if (state.integral) number(m_.dag->symbol({SymbolKind::integral, i, 0}), state.rate, "the integral of this");
    }
    t0_ = start;
  }
  void give(std::uint32_t coordinate, std::uint8_t order, double value) {
    given_[{SymbolKind::coordinate, coordinate, order}] = numeric::exact(value);
  }

 private:
  double number(Ref expression, model::NodeId id, const char* what) {
    const Ref written = written_(expression);
    const model::Span span = m_.model->arena[id].span;
    const auto lookup = [&](const Symbol& s) -> cln::cl_R {
      if (s.kind == SymbolKind::parameter) return parameters_[s.index];
      if (s.kind == SymbolKind::time) return t0_;
      if (s.kind == SymbolKind::integral) return 0;  // integrals begin here
      if (const auto found = given_.find(s); found != given_.end()) return found->second;
      throw Error("scene", m_.model->where(span), fmt::format("{} uses a value that is not given before it", what),
                  "give the values that it uses on earlier lines of `initial`");
    };
    try {
      const double value = cln::double_approx(symbolic::evaluate(*m_.dag, {written}, lookup, digits)[0]);
      if (std::isfinite(value)) return value;
      throw std::domain_error("it is too large for binary64");
    } catch (const Error&) {
      throw;
    } catch (const std::exception& error) {
      throw Error("scene", m_.model->where(span), fmt::format("{} has no value: {}", what, error.what()),
                  "check the numbers that it is computed from");
    }
  }

  Mechanics& m_;
  const std::vector<cln::cl_R>& parameters_;
  symbolic::Substitution written_;
  cln::cl_R t0_ = 0;
  std::map<Symbol, cln::cl_R> given_;
};

std::vector<std::optional<Ref>> resolve_inputs(Mechanics& m, const model::Scene& scene, const Overrides& overrides,
                                               SceneEvaluator& value, Scene& result) {
  std::vector<std::optional<Ref>> expressions;
  symbolic::Substitution written = derive::time_function_substitution(m);
  for (std::uint32_t i = 0; i < m.model->inputs.size(); ++i) {
    if (const auto set = overrides.values.find(m.model->inputs[i].name); set != overrides.values.end()) {
      const Ref constant = m.dag->constant(set->second);
      result.inputs.emplace_back(*m.dag, constant, result.parameters);
      expressions.emplace_back(constant);
      continue;
    }
    const auto given =
        std::find_if(scene.inputs.begin(), scene.inputs.end(), [&](const auto& s) { return s.input == i; });
    const model::InputTable* table =
        given == scene.inputs.end() ? nullptr : std::get_if<model::InputTable>(&given->signal);
    if (table != nullptr) {
      std::vector<double> t, v;
      for (const model::NodeId id : table->t) t.push_back(value.number(id, "a time of an input table"));
      for (const model::NodeId id : table->value) v.push_back(value.number(id, "a value of an input table"));
      t.insert(t.end(), table->csv_times.begin(), table->csv_times.end());
      v.insert(v.end(), table->csv_values.begin(), table->csv_values.end());
      if (!std::is_sorted(t.begin(), t.end(), std::less_equal<>())) {
        throw Error("scene", m.model->where(given->span), "the times of an input table must increase",
                    "sort the table by time");
      }
      result.inputs.emplace_back(std::move(t), std::move(v), table->interpolation == model::Interpolation::linear);
      expressions.emplace_back();
      continue;
    }
    const model::NodeId id =
        given == scene.inputs.end() ? m.model->inputs[i].default_value : std::get<model::NodeId>(given->signal);
    const Ref signal = written(mechanics::lower_scalar(m, id));
    for (const Symbol& symbol : m.dag->symbols({signal})) {
      if (symbol.kind != SymbolKind::integral) continue;
      throw Error("scene", m.model->where(m.model->states[symbol.index].span),
                  "this integral has no closed form, and a signal cannot carry a state of its own",
                  "put the integral where the input is used, as integral(f) with f in [functions]");
    }
    result.inputs.emplace_back(*m.dag, signal, result.parameters);
    expressions.emplace_back(signal);
  }
  return expressions;
}

// Functions of time alone, and the jumps that they cause.
void resolve_clock(const Mechanics& m, const system::EquationSystem& system, const SceneTable& table, Scene& result) {
  for (Signal& input : result.inputs) input.set_parameters(result.parameters);
  result.clock =
      eom::hybrid::analyse_time_functions(result.time, result.parameters, input_signals(result), result.t0, result.t1);
  const eom::hybrid::Jumps found(table.jumps, system.layout(), m.model->inputs.size(), result.parameters,
                                 !result.clock.breakpoints.empty());
  if (!found.none()) result.jumps = table.jumps;
}

// The equations do not hold for a start outside its chart.
void resolve_ranges(const Mechanics& m, SceneEvaluator& value, Scene& result) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  result.lower.clear();
  result.upper.clear();
  for (const model::Coordinate& c : m.model->coordinates) {
    result.lower.push_back(c.lower == model::no_node ? -infinity : value.number(c.lower, "the lower end of a range"));
    result.upper.push_back(c.upper == model::no_node ? infinity : value.number(c.upper, "the upper end of a range"));
  }
}

void require_ranges(const Mechanics& m, const model::Scene& scene, const Scene& result) {
  for (std::size_t i = 0; i < result.q.size(); ++i) {
    if (result.q[i] > result.lower[i] && result.q[i] < result.upper[i]) continue;
    const model::Coordinate& c = m.model->coordinates[i];
    const auto given = std::find_if(scene.initial.begin(), scene.initial.end(),
                                    [&](const model::InitialValue& v) { return v.coordinate == i && v.order == 0; });
    throw Error("scene", m.model->where(given == scene.initial.end() ? scene.span : given->span),
                fmt::format("the start has {} = {}, outside its range ({}, {})", c.name, result.q[i], result.lower[i],
                            result.upper[i]),
                fmt::format("start inside the range, or give {} another one in [coordinates]", c.name));
  }
}

void require_span(const Mechanics& m, const model::Scene& scene, const Scene& result, bool at_start) {
  const auto fail = [&](const char* what, const char* remedy) {
    throw Error("scene", m.model->where(scene.span), what, remedy);
  };
  if (!(result.t1 > result.t0) && !at_start)
    fail("the end of the scene must come after its start", "t = [t0, t1] with t1 > t0");
  if (!(result.rtol >= 0 && result.atol >= 0 && result.rtol + result.atol > 0)) {
    fail("tolerances must not be negative, nor both zero", "give rtol = 1e-9 and atol = 1e-12, say");
  }
  if (result.step < 0 || result.max_step < 0 || result.every < 0)
    fail("step, max_step and every must be positive", "leave them out for the defaults");
}

// The entries of M, then those of A, at the start.
std::vector<double> mass_and_rows(const Mechanics& m, const system::EquationSystem& system, const SceneTable& table,
                                  const Scene& start) {
  std::vector<double> values(system.M.size() + system.A.size(), std::nan(""));
  std::vector<double> variables{start.t0};
  for (const std::uint32_t i : system.free) variables.push_back(start.q[i]);
  for (const std::uint32_t i : system.free) variables.push_back(start.qdot[i]);
  variables.insert(variables.end(), start.z.begin(), start.z.end());
  variables.resize(variables.size() + m.model->inputs.size(), std::nan(""));
  variables.insert(variables.end(), start.parameters.begin(), start.parameters.end());
  table.mass_and_rows.values(variables, values);
  return values;
}

// Coordinates are singular where M has no inverse. With multipliers M may be singular if the constraints compensate it:
// then it has to be regular in the directions that they leave free.
void require_regular(const Mechanics& m, const system::EquationSystem& system, const SceneTable& table,
                     const model::Scene& scene, const Scene& start) {
  constexpr double smallest_eigenvalue = 5e-15;  // of M scaled to a unit diagonal; rounding leaves 1e-16 per operation
  constexpr double smallest_row = 1e-10;         // of a constraint outside the span of the others
  const auto n = static_cast<Eigen::Index>(system.free.size());
  const std::vector<double> values = mass_and_rows(m, system, table, start);
  Eigen::MatrixXd M = Eigen::Map<const Eigen::MatrixXd>(values.data(), n, n);
  if (!M.allFinite() || n == 0) return;  // reported with the undefined value; no free coordinates
  const Eigen::VectorXd inertia = M.diagonal();
  Eigen::VectorXd scale = M.diagonal().cwiseSqrt();
  bool regular = scale.minCoeff() > 0;
  if (!system.active.empty()) {
    Eigen::MatrixXd gradients =  // in columns
        Eigen::Map<const Eigen::MatrixXd>(values.data() + n * n, n, static_cast<Eigen::Index>(system.active.size()));
    if (!gradients.allFinite()) return;
    for (double& s : scale) s = s > 0 ? s : 1;
    gradients = scale.cwiseInverse().asDiagonal() * gradients;
    gradients.colwise().normalize();
    const Eigen::MatrixXd Z = numeric::orthogonal_complement(gradients, smallest_row);
    if (Z.cols() == 0) return;  // the constraints determine the motion
    M = Z.transpose() * scale.cwiseInverse().asDiagonal() * M * scale.cwiseInverse().asDiagonal() * Z;
    regular = true;
    scale = Eigen::VectorXd::Ones(Z.cols());
  }
  if (regular) {
    M = scale.cwiseInverse().asDiagonal() * M * scale.cwiseInverse().asDiagonal();
    regular = numeric::symmetric_eigenvalues(M)[0] > smallest_eigenvalue;
  }
  if (regular) return;
  Eigen::Index least = 0;
  if (inertia.minCoeff(&least) < -smallest_eigenvalue * inertia.maxCoeff())
    throw Error("scene", m.model->where(scene.span),
                fmt::format("the inertia along '{}' is negative at the start: {:.6g}",
                            m.model->coordinates[system.free[static_cast<std::size_t>(least)]].name, inertia(least)),
                "give masses and moments of inertia of 0 or more");
  constexpr double near = 1e-6;  // of a sine or cosine: its square is lost in M
  if (const model::SingularChart chart = model::find_singular_chart(
          *m.model, [&](std::uint32_t coordinate) -> std::optional<double> { return start.q[coordinate]; }, near))
    throw Error("scene", m.model->where(scene.span), "the start is a singular configuration: " + chart.what,
                "start elsewhere, or " + chart.remedy);
  throw Error("scene", m.model->where(scene.span), "the start is a singular configuration: the coordinates fail there",
              "start elsewhere, or choose other coordinates or parameters; `check` lists the singular sets");
}

// The start of the states of first order, which may use coordinates and velocities there.
void resolve_states(const Mechanics& m, const system::EquationSystem& system, const model::Scene& scene,
                    const Overrides& overrides, SceneEvaluator& value, Scene& result) {
  for (std::uint32_t i = 0; i < result.q.size(); ++i) {
    value.give(i, 0, result.q[i]);
    value.give(i, 1, result.qdot[i]);
  }
  for (const system::FirstOrderState& entry : system.states) {
    const model::State& state = m.model->states[entry.symbol.index];
    result.z.push_back(0);
    if (state.integral) continue;
    if (const auto set = overrides.values.find(state.name); set != overrides.values.end()) {
      result.z.back() = cln::double_approx(set->second);
      continue;
    }
    const auto given = std::find_if(scene.states.begin(), scene.states.end(), [&](const model::InitialState& initial) {
      return initial.state == entry.symbol.index;
    });
    const model::NodeId start = given != scene.states.end() ? given->value : state.initial;
    if (start != model::no_node) result.z.back() = value.number(start, "the start value of a state");
  }
}

void resolve_samples(const Mechanics& m, SceneEvaluator& value, Scene& result) {
  constexpr double most_periods = 1e14;  // from t = 0: times further away differ by too few units in the last place
  double count = 0;
  for (const model::Sample& sample : m.model->samples) {
    const double every = value.number(sample.every, "the period of a sample");
    const double offset = sample.offset == model::no_node ? 0 : value.number(sample.offset, "the offset of a sample");
    const auto fail = [&](const std::string& what, const char* remedy) {
      throw Error("scene", m.model->where(m.model->arena[sample.every].span), what, remedy);
    };
    if (!(every > 0))
      fail(fmt::format("the period of '{}' is {}, not positive", sample.name, every), "choose a time greater than 0");
    const double farthest = std::max({std::abs(result.t0), std::abs(result.t1), std::abs(offset)});
    if (farthest / every > most_periods)
      fail(fmt::format("the period {} of '{}' is not resolved at times of {}", every, sample.name, farthest),
           "choose a longer period, or times and an offset nearer to 0");
    count += (result.t1 - result.t0) / every;
    if (count > eom::hybrid::most_samples)
      fail(fmt::format("samples up to '{}' would be taken more than {:.0e} times in this run", sample.name,
                       eom::hybrid::most_samples),
           "choose a longer period or a shorter run");
    result.samples.emplace_back(every, offset);
  }
}

}  // namespace

std::optional<std::uint32_t> find_state(const model::Model& model, const std::string& name) {
  for (std::uint32_t i = 0; i < model.states.size(); ++i) {
    if (!model.states[i].integral && model.states[i].name == name) return i;
  }
  return std::nullopt;
}

std::vector<std::string> state_columns(const model::Model& model) {
  std::vector<std::string> names;
  for (const model::Coordinate& c : model.coordinates) names.insert(names.end(), {c.name, c.name + "_dot"});
  for (const model::State& state : model.states) {
    if (!state.integral) names.push_back(state.name);
  }
  return names;
}

bool is_start_value(const model::Model& model, const std::string& name) {
  return find_start(model, name) || find_state(model, name);
}

std::optional<StartProblem::Key> find_start(const model::Model& model, const std::string& name) {
  for (std::uint32_t i = 0; i < model.coordinates.size(); ++i) {
    if (name == model.coordinates[i].name) return StartProblem::Key{i, 0};
    if (name == model.coordinates[i].name + "_dot") return StartProblem::Key{i, 1};
  }
  return std::nullopt;
}

Scene resolve_scene(Mechanics& m, const system::EquationSystem& system, const model::Scene& scene,
                    const Overrides& overrides) {
  SceneTables tables;
  return resolve_scene(m, system, scene, overrides, tables);
}

Scene resolve_scene(Mechanics& m, const system::EquationSystem& system, const model::Scene& scene,
                    const Overrides& overrides, SceneTables& tables) try {
  Scene result;
  result.name = scene.name;
  const std::vector<cln::cl_R> parameters = exact_parameters(m, scene, overrides, digits);
  require_masses(m, parameters, scene);
  require_friction_coefficients(m, parameters, scene);
  for (const cln::cl_R& p : parameters) result.parameters.push_back(cln::double_approx(p));
  // The start is computed with the binary64 parameters that the run will use.
  std::vector<cln::cl_R> rounded;
  for (const double p : result.parameters) rounded.push_back(numeric::exact(p));
  SceneEvaluator value(m, rounded);
  if (scene.t0 != model::no_node) result.t0 = value.number(scene.t0, "the start time");
  result.t1 = scene.t1 != model::no_node ? value.number(scene.t1, "the end time") : result.t0 + 10;
  value.set_start(result.t0);
  value.require_integrals(result.t1);
  const auto number = [&](model::NodeId id, double& target, const char* what) {
    if (id != model::no_node) target = value.number(id, what);
  };
  number(scene.rtol, result.rtol, "rtol");
  number(scene.atol, result.atol, "atol");
  number(scene.step, result.step, "step");
  number(scene.every, result.every, "every");
  result.t1 = overrides.t_end.value_or(result.t1);
  result.rtol = overrides.rtol.value_or(result.rtol);
  result.atol = overrides.atol.value_or(result.atol);
  result.step = overrides.step.value_or(result.step);
  result.max_step = overrides.max_step.value_or(result.max_step);
  result.every = overrides.every.value_or(result.every);
  result.solver = overrides.solver.value_or(scene.solver);
  const bool at_start = overrides.allow_empty_span && overrides.t_end && result.t1 == result.t0;
  if (overrides.t_end && !(result.t1 > result.t0) && !at_start) {
    throw Error(
        "scene", {},
        fmt::format("the run would end at t = {}, {} its start{}", result.t1, result.t1 < result.t0 ? "before" : "at",
                    result.t1 < result.t0 ? fmt::format(" at t = {}", result.t0) : ""),
        "give a later --t-end");
  }
  require_span(m, scene, result, at_start);
  const std::vector<std::optional<Ref>> inputs = resolve_inputs(m, scene, overrides, value, result);

  StartProblem problem{m, system, scene, result.t0, result.parameters, {}, {}, {}, {}, {}};
  const auto give = [&](const StartProblem::Key& key, double v, const model::Span& span) {
    value.give(key.first, key.second, v);
    problem.given[key] = {v, span};
  };
  for (const auto& [name, v] : overrides.values) {
    if (const auto key = find_start(*m.model, name)) give(*key, cln::double_approx(v), scene.span);
  }
  for (const model::InitialValue& initial : scene.initial) {
    const StartProblem::Key key{initial.coordinate, initial.order};
    if (!problem.given.contains(key)) give(key, value.number(initial.value, "an initial value"), initial.span);
  }
  for (const model::InitialAngularVelocity& given : scene.rotations) {
    StartProblem::AngularVelocity turn{given.frame, {}, given.span};
    for (std::size_t k = 0; k < 3; ++k) turn.value[k] = value.number(given.value[k], "an initial angular velocity");
    problem.angular_velocities.push_back(turn);
  }
  for (const model::InitialValue& guess : scene.guess) {
    problem.guess[{guess.coordinate, guess.order}] = value.number(guess.value, "a guess");
  }
  for (std::size_t i = 0; i < result.parameters.size();
       ++i) {  // initial(q): the value of q before the constraints are solved
    const auto& start_of = m.model->parameters[i].initial_value_of;
    if (!start_of) continue;
    const auto given = problem.given.find({*start_of, 0});
    const auto guess = problem.guess.find({*start_of, 0});
    result.parameters[i] = given != problem.given.end()   ? given->second.value
                           : guess != problem.guess.end() ? guess->second
                                                          : 0;
  }
  for (Signal& input : result.inputs) input.set_parameters(result.parameters);
  const bool is_scenes_own =
      std::none_of(m.model->inputs.begin(), m.model->inputs.end(),
                   [&](const model::Input& input) { return overrides.values.contains(input.name); });
  const SceneTable& table = tables.of(system, scene, inputs, is_scenes_own);
  result.time = table.time;
  problem.t0 =
      eom::hybrid::time_behind_start(result.time, result.parameters, input_signals(result), result.t0, result.t1);
  resolve_ranges(m, value, result);
  solve_start_on_rims(problem, result.lower, result.upper);
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    if (const auto& start_of = m.model->parameters[i].initial_value_of) result.parameters[i] = problem.q[*start_of];
  }
  resolve_clock(m, system, table, result);  // parameters may depend on the start
  result.q = problem.q;
  result.qdot = problem.qdot;
  for (std::size_t i = 0; i < rounded.size(); ++i) rounded[i] = numeric::exact(result.parameters[i]);
  resolve_states(m, system, scene, overrides, value, result);
  resolve_ranges(m, value, result);
  require_ranges(m, scene, result);
  result.solved_notes = problem.solved_notes;
  if (problem.given.empty() && scene.rotations.empty()) {
    result.solved_notes.insert(result.solved_notes.begin(),
                               "no initial values: all coordinates and rates start at 0" +
                                   std::string(problem.solved_notes.empty() ? "" : ", but for those that follow"));
  }
  result.open = problem.open;
  for (const model::Event& event : m.model->events) result.ends_run.push_back(event.stop);
  for (const std::uint32_t i : scene.stop) result.ends_run[i] = true;
  resolve_samples(m, value, result);
  if (!overrides.can_exchange_charts) require_regular(m, system, table, scene, result);

  std::vector<model::OutputReference> wanted = scene.outputs;
  if (!overrides.outputs.empty()) {
    wanted.clear();
    for (const std::string& name : overrides.outputs) wanted.push_back({name, {}});
  }
  result.outputs = expand_outputs(m, system, wanted);
  return result;
} catch (const cln::runtime_exception& error) {
  throw Error("scene", m.model->where(scene.span),
              fmt::format("a number of scene '{}' is beyond what floating point holds: {}", scene.name, error.what()),
              "choose parameters from which its start can be computed");
}

Scene::Scene() = default;
Scene::Scene(const Scene&) = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(const Scene&) = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

}  // namespace eomgen::run

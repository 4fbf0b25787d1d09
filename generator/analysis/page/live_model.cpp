// SPDX-License-Identifier: GPL-3.0-or-later
#include "analysis/page/live_model.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "emit/targets.hpp"
#include "lists.hpp"
#include "mechanics/imposition.hpp"
#include "numeric/numbers.hpp"
#include "pipeline/contact_outputs.hpp"
#include "pipeline/reset_places.hpp"
#include "pipeline/start_description.hpp"
#include "program/from_dag.hpp"
#include "program/restrict.hpp"

namespace eomgen::analysis {
namespace {

constexpr std::size_t most_contacts = 20;       // whose forces are solved for at every evaluation
constexpr std::size_t largest_script = 400000;  // bytes; longer code takes too long to load

class Live {
 public:
  Live(const pipeline::Simulation& simulation, const std::vector<Ref>& sizes, const std::vector<std::string>& outputs,
       const std::set<std::string>& set)
      : s_(simulation),
        derived_(*simulation.derived),
        m_(derived_.mechanics),
        dag_(*m_.dag),
        sizes_(sizes),
        outputs_(outputs),
        set_(set) {}

  LiveModel run() {
    LiveModel live;
    live.reason = obstacle();
    if (!live.reason.empty()) return live;
    program::Program program = s_.program;
    program.functions.clear();
    program.taylor.reset();
    program.chart_variants.clear();
    program.charts.clear();
    for (const program::Function& function : s_.program.functions) {
      if (function.name == "rhs" || function.name == "mass" || function.name == "constraints" ||
          function.name == "resets" || function.name == "contact_rows")
        program.functions.push_back(function);
      if (function.name == "events" && s_.program.event_count() > 0) program.functions.push_back(function);
      if (function.name == "outputs") program.functions.push_back(program::restrict_results(function, chosen()));
    }
    if (!s_.program.contacts.empty()) program.functions.push_back(contact_function());
    program.outputs = outputs_;
    program.reactions.clear();
    program.functions.push_back(setup());
    program.functions.push_back(signals());
    emit::EmissionContext context = pipeline::emission_context(derived_, s_.program, s_.scene, s_.certificate);
    context.tests.clear();
    context.start_functions = pipeline::describe_start(derived_, model_scene());
    if (!context.start_functions) {
      live.reason = "its start cannot be computed on a page";
      return live;
    }
    const emit::EmittedFile file = emit::emit(program, context, "javascript").front();
    if (file.text.size() > largest_script) {
      live.reason = fmt::format("its code of {} kB is too long for a page", file.text.size() / 1000);
      return live;
    }
    live.script = file.text;
    live.name = file.name.substr(0, file.name.size() - 3);
    live.start = start();
    return live;
  }

 private:
  /// Feature of the model that the page's integrator does not support, or "".
  std::string obstacle() const {
    if (s_.program.contact_set.contacts.size() > most_contacts)
      return fmt::format("its {} contacts would take too long", s_.program.contact_set.contacts.size());
    if (!s_.scene.jumps.functions.empty())
      return "a velocity jumps during the run, and the page does not compute impulses";
    for (const model::SceneInput& input : model_scene().inputs) {
      if (std::holds_alternative<model::InputTable>(input.signal) && !is_set_input(input.input))
        return fmt::format("the input '{}' is a table of time", derived_.model.inputs[input.input].name);
    }
    return "";
  }

  const model::Scene& model_scene() const { return derived_.model.scene(s_.scene.name); }

  /// Places of outputs among those of the program.
  std::vector<std::size_t> places_of(const std::vector<std::string>& names) const {
    return mapped(names, [&](const std::string& name) {
      return static_cast<std::size_t>(std::find(s_.program.outputs.begin(), s_.program.outputs.end(), name) -
                                      s_.program.outputs.begin());
    });
  }
  std::vector<std::size_t> chosen() const { return places_of(outputs_); }

  /// Names of the outputs from which the modes of all contacts follow.
  std::vector<std::string> names_of_contacts() const {
    std::vector<std::string> names;
    for (const run::ContactOutputs& contact : pipeline::contact_outputs(derived_.candidates.front())) {
      const std::vector<std::string> more = pipeline::output_names(contact);
      names.insert(names.end(), more.begin(), more.end());
    }
    return names;
  }
  program::Function contact_function() const {
    const auto* const outputs = find_named(s_.program.functions, "outputs");
    program::Function function = program::restrict_results(*outputs, places_of(names_of_contacts()));
    function.name = "contact_outputs";
    return function;
  }
  void add_contacts(LiveStart& start) const {
    const std::vector<run::ContactOutputs> outputs = pipeline::contact_outputs(derived_.candidates.front());
    const std::vector<std::string> names = names_of_contacts();
    const auto places = [&](const std::vector<std::string>& of) {
      return mapped(of, [&](const std::string& name) {
        return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
      });
    };
    for (std::size_t j = 0; j < s_.program.contacts.size(); ++j) {
      const run::ContactOutputs& of = outputs[j];
      LiveContact contact{
          s_.program.contacts[j].name, s_.program.contacts[j], places(of.slip), places(of.phi), {}, of.constraint, {}};
      for (const std::vector<std::string>& slopes : of.slopes) contact.slopes.push_back(places(slopes));
      if (!of.restitution.empty()) contact.restitution = places({of.restitution}).front();
      start.contacts.push_back(std::move(contact));
    }
    start.contact_outputs = names.size();
    start.contact_set = s_.program.contact_set;
    start.mode_size = s_.program.mode_layout().size();
  }

  program::Function function(const std::string& name, const std::vector<program::ResultExpressions>& results) {
    program::FunctionExpressions wanted;
    wanted.name = name;
    wanted.results = results;
    std::vector<program::ResultShape> shape;
    for (const program::ResultExpressions& result : results) shape.push_back({result.name, result.entries.size()});
    return program::schedule(program::flatten(program::from_dag(dag_, wanted, s_.program.free), false), name, shape);
  }

  /// Formula of a parameter. Parameters set by the scene or the command line are numbers with a slider on the page.
  bool is_dependent(std::size_t i) const {
    const auto& set = model_scene().parameters;
    const bool given = std::any_of(set.begin(), set.end(), [i](const auto& p) { return p.first == i; });
    return !given && !overridden(i) && !dag_.symbols({m_.parameter_value[i]}).empty();
  }
  /// Whether the command line gives an input a constant value.
  bool is_set_input(std::uint32_t i) const { return set_.contains(derived_.model.inputs[i].name); }
  bool overridden(std::size_t i) const { return set_.contains(derived_.model.parameters[i].name); }

  /// Sizes of drawn parts, and the period and offset of each sample, as functions of the parameters.
  program::Function setup() {
    std::vector<Ref> periods;
    for (const model::Sample& sample : derived_.model.samples) {
      for (const model::NodeId id : {sample.every, sample.offset})
        periods.push_back(id == model::no_node ? dag_.zero() : mechanics::lower_scalar(m_, id));
    }
    return function("setup", {{"sizes", sizes_}, {"periods", periods}});
  }

  /// Inputs of the scene over time.
  program::Function signals() {
    std::vector<Ref> u;
    symbolic::Substitution written = mechanics::time_function_substitution(m_);
    for (std::uint32_t i = 0; i < derived_.model.inputs.size(); ++i) {
      if (is_set_input(i)) {
        u.push_back(dag_.constant(numeric::exact(s_.scene.inputs[i](s_.scene.t0, s_.scene.t0))));
        continue;
      }
      model::NodeId id = derived_.model.inputs[i].default_value;
      for (const model::SceneInput& input : model_scene().inputs) {
        if (input.input == i) id = std::get<model::NodeId>(input.signal);
      }
      u.push_back(written(mechanics::lower_scalar(m_, id)));
    }
    return function("signals", {{"u_now", u}});
  }

  static std::string rate_unit(const std::string& unit) {
    return unit.empty() ? "" : unit == "1" ? "1/s" : unit + "/s";
  }

  /// The states of the layout in order, with the start that the command line sets.
  void add_states(LiveStart& start) const {
    const model::Model& model = derived_.model;
    const std::vector<std::string> names = pipeline::state_names(derived_);
    start.layout = s_.program.layout();
    for (std::size_t k = 0; k < names.size(); ++k) {
      double value = 0;
      LiveState state{names[k], ""};
      if (k < start.layout.first_order_begin()) {
        const bool is_rate = start.layout.is_rate(k);
        const std::uint32_t c = m_.free[is_rate ? k - start.layout.rates_begin() : k];
        value = (is_rate ? s_.scene.qdot : s_.scene.q)[c];
        state.unit = is_rate ? rate_unit(model.coordinates[c].unit.text) : model.coordinates[c].unit.text;
      } else {
        const std::size_t other = k - start.layout.first_order_begin();
        const model::State& of = model.states[s_.program.states[other].index];
        value = s_.scene.z[other];
        state.unit = of.unit.text;
        state.is_adjustable = !of.integral;
      }
      if (set_.contains(names[k])) start.set.emplace_back(k, value);
      start.states.push_back(std::move(state));
    }
  }

  LiveStart start() const {
    const model::Model& model = derived_.model;
    LiveStart start;
    add_states(start);
    add_contacts(start);
    for (std::size_t i = 0; i < model.parameters.size(); ++i) {
      const model::Parameter& p = model.parameters[i];
      start.parameters.push_back({p.name, p.unit.text, p.note, s_.scene.parameters[i], p.positive,
                                  !is_dependent(i) && !p.initial_value_of && model.start_time != i});
      const auto place =
          p.initial_value_of ? std::find(m_.free.begin(), m_.free.end(), *p.initial_value_of) : m_.free.end();
      if (place != m_.free.end()) start.starts.emplace_back(i, static_cast<std::size_t>(place - m_.free.begin()));
    }
    pipeline::ResetPlaces resets = pipeline::reset_places(derived_, s_.scene);
    for (std::size_t i = 0; i < model.events.size(); ++i) {
      start.events.push_back({model.events[i].name, bool(s_.scene.ends_run[i]), model::name(model.events[i].direction),
                              std::move(resets.events[i])});
    }
    start.samples = std::move(resets.samples);
    start.reset_values = s_.program.result_size("resets");
    for (const std::uint32_t c : m_.free) {
      start.lower.push_back(s_.scene.lower[c]);
      start.upper.push_back(s_.scene.upper[c]);
    }
    start.inputs = model.inputs.size();
    start.constraints = s_.program.active_constraints;
    start.event_functions = s_.program.event_count();
    start.sizes = sizes_.size();
    return start;
  }

  const pipeline::Simulation& s_;
  pipeline::DerivedModel& derived_;
  mechanics::Mechanics& m_;
  symbolic::Dag& dag_;
  const std::vector<Ref>& sizes_;
  const std::vector<std::string>& outputs_;
  const std::set<std::string>& set_;
};

}  // namespace

LiveModel live_model(const pipeline::Simulation& simulation, const std::vector<Ref>& sizes,
                     const std::vector<std::string>& outputs, const std::set<std::string>& set) {
  return Live(simulation, sizes, outputs, set).run();
}

}  // namespace eomgen::analysis

// SPDX-License-Identifier: GPL-3.0-or-later
#include "pipeline/pipeline.hpp"

#include <cln/dfloat.h>
#include <fmt/format.h>

#include <chrono>

#include "derive/formulations.hpp"
#include "derive/frames.hpp"
#include "derive/inertias.hpp"
#include "derive/trees/body_residual.hpp"
#include "derive/trees/tensions.hpp"
#include "emit/self_test.hpp"
#include "error.hpp"
#include "model/names.hpp"
#include "numeric/numbers.hpp"
#include "pipeline/certificate_cache.hpp"
#include "pipeline/reset_places.hpp"
#include "pipeline/self_test_states.hpp"
#include "print/notation.hpp"
#include "print/printer.hpp"
#include "print/render.hpp"
#include "program/abi_values.hpp"
#include "program/fingerprint.hpp"
#include "program/interpret.hpp"
#include "program/kinks.hpp"
#include "program/null_space_solver.hpp"
#include "reading/forms.hpp"

namespace eomgen::pipeline {
namespace {

class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

std::vector<system::Approach> approaches(const mechanics::Mechanics& m, ApproachChoice choice) {
  if (choice == ApproachChoice::one) return {system::Approach::one};
  // Without eliminated coordinates both approaches give the same equations.
  if (choice == ApproachChoice::two || m.fixed.empty()) return {system::Approach::two};
  return {system::Approach::two, system::Approach::one};
}

// Rejects a model whose coordinates all follow from t by elimination: it has no right-hand side. Coordinates that
// constraints determine together, and those that velocity constraints determine, are integrated.
void require_freedom(const mechanics::Mechanics& m) {
  if (!m.free.empty() && m.degrees_of_freedom() >= 0) return;
  const model::Constraint& last = m.model->constraints.back();
  if (!m.free.empty()) {
    throw Error("derive", m.model->where(last.span),
                "there are more constraints than coordinates, and they do not repeat one another",
                "remove a constraint; eomgen derive shows them");
  }
  throw Error("derive", m.model->where(last.span), "the constraints fix every coordinate: nothing is left to integrate",
              "eomgen inverse gives the motion and its forces; to integrate it, remove a constraint");
}

// Adds candidates in the requested forms.
void take_forms(DerivedModel& derived, FormChoice choice) {
  if (choice == system::Form::multipliers) return;
  std::vector<system::EquationSystem> others;
  for (const system::EquationSystem& candidate : derived.candidates) {
    if (candidate.active.empty() || candidate.quasi || candidate.solution) continue;
    for (const system::Form form : {system::Form::nullspace, system::Form::chaplygin}) {
      if (choice && *choice != form) continue;
      if (!program::is_form_applicable(candidate, form, !choice)) continue;
      others.push_back(candidate);
      others.back().form = form;
    }
  }
  if (choice && others.empty()) {
    const bool any = !derived.mechanics.active.empty();
    throw Error(
        "derive", SourceLocation{derived.model.file, 0, 0, 1, ""},
        any ? fmt::format("the constraints of this model are unilateral, are coupled in blocks that are too large "
                          "for form '{}', or have no independent columns in admissible configurations",
                          system::name(*choice))
            : fmt::format("form '{}' needs constraints that keep multipliers, and this model has none",
                          system::name(*choice)),
        any ? "leave --form out, or choose multipliers" : "leave --form out");
  }
  if (choice) derived.candidates.clear();
  for (system::EquationSystem& other : others) derived.candidates.push_back(std::move(other));
}

// The other forms, as derived: all must agree.
std::vector<program::Program> other_forms(const DerivedModel& derived, const program::Program& program,
                                          const std::map<std::uint32_t, symbolic::Rational>& fixed) {
  std::vector<program::Program> result;
  for (const system::Form form : {system::Form::multipliers, system::Form::nullspace, system::Form::chaplygin}) {
    if (form == program.form || derived.mechanics.active.empty()) continue;
    std::vector<system::EquationSystem> one{derived.candidates.front()};
    one[0].form = form;
    one[0].quasi.reset();
    one[0].solution.reset();
    if (!program::is_form_applicable(one[0], form, false)) continue;
    program::Request request;
    request.optimise = false;
    request.fix = fixed;
    result.push_back(program::build_program(one, request));
  }
  return result;
}

program::AbiArguments abi_arguments(const verify::AbiArguments& at, const std::vector<verify::Real>& default_inputs) {
  return {{at.t, at.x, at.p, at.u, {}, {}, at.mode, at.v}, default_inputs, at.order};
}

/// The same with the other functions of the ABI.
verify::ProgramForm with_functions(verify::ProgramForm form, const program::Program& program,
                                   const std::vector<verify::Real>& default_inputs) {
  form.functions = program::abi_function_names(program);
  form.formulation = program.formulation;
  form.approach = program.approach;
  form.outputs = program.outputs;
  form.default_inputs = default_inputs;
  form.call = [&program, default_inputs](const std::string& function, const verify::AbiArguments& at, int digits) {
    return program::abi_values(program, function, abi_arguments(at, default_inputs), digits);
  };
  return form;
}

verify::ProgramForm program_form(const program::Program& program, int digits,
                                 const std::vector<verify::Real>& default_inputs) {
  const program::Function& rhs = program.functions.front();
  verify::ProgramForm form{
      "optimised program",
      [&rhs, digits](const verify::Real& t, const std::vector<verify::Real>& x, const std::vector<verify::Real>& p,
                     const std::vector<verify::Real>& u, const std::vector<int>& mode) {
        const auto values = program::interpret(rhs, program::Arguments<cln::cl_R>{t, x, p, u, {}, {}, mode}, digits);
        for (std::size_t i = 1; i < values.results.size(); ++i) {
          for (const cln::cl_R& code : values.results[i]) {
            if (rhs.results[i].is_test() && cln::minusp(code)) return std::vector<verify::Real>{};
          }
        }
        return values.results.front();
      }};
  form.bounds = [&program, default_inputs](const std::string& function, const verify::AbiArguments& at) {
    return program::abi_error_bounds(program, function, abi_arguments(at, default_inputs));
  };
  return form;
}

template <class Choice>
using Choices = std::vector<std::pair<std::string, Choice>>;

Choices<ApproachChoice> approach_choices() {
  using system::Approach;
  return {{"auto", ApproachChoice::automatic},
          {system::name(Approach::one), ApproachChoice::one},
          {system::name(Approach::two), ApproachChoice::two}};
}

Choices<FormChoice> form_choices() {
  Choices<FormChoice> choices{{"auto", std::nullopt}};
  for (const system::Form form : {system::Form::multipliers, system::Form::nullspace, system::Form::chaplygin})
    choices.emplace_back(system::name(form), form);
  return choices;
}

template <class Choice>
std::vector<std::string> words(const Choices<Choice>& choices) {
  std::vector<std::string> result;
  for (const auto& [word, choice] : choices) result.push_back(word);
  return result;
}

template <class Choice>
Choice chosen(const Choices<Choice>& choices, const char* what, const std::string& text) {
  for (const auto& [word, choice] : choices) {
    if (word == text) return choice;
  }
  throw Error("cli", {}, fmt::format("there is no {} {}", what, model::quote(text)),
              model::suggest_choice(text, words(choices)));
}

}  // namespace

DerivedModel::DerivedModel(std::shared_ptr<const model::Model> read) : shared(std::move(read)), model(*shared) {}
DerivedModel::~DerivedModel() = default;

std::vector<std::string> approach_names() { return words(approach_choices()); }
ApproachChoice parse_approach(const std::string& text) { return chosen(approach_choices(), "approach", text); }

std::vector<std::string> form_names() { return words(form_choices()); }
FormChoice parse_form(const std::string& text) { return chosen(form_choices(), "form", text); }

std::unique_ptr<DerivedModel> derive_model(std::shared_ptr<const model::Model> model, ApproachChoice approach,
                                           FormChoice form) {
  const work::Stage stage("deriving the equations");
  Stopwatch watch;
  mechanics::Mechanics mechanics = mechanics::build_mechanics(std::move(model));
  auto derived = std::make_unique<DerivedModel>(mechanics.model);  // with the inputs of contacts
  derived->mechanics = std::move(mechanics);
  require_freedom(derived->mechanics);
  for (const system::Approach a : approaches(derived->mechanics, approach)) {
    for (const derive::FormulationEntry& formulation : derive::formulations()) {
      if (auto formulation_system = derive::derive_if_worthwhile(formulation, derived->mechanics, a).system)
        derived->candidates.push_back(std::move(*formulation_system));
    }
  }
  derived->conserved = conservation::conserved_quantities(derived->mechanics, derived->candidates);
  take_forms(*derived, form);
  derived->seconds.derive = watch.lap();
  return derived;
}

program::Program make_program(DerivedModel& derived, const program::Request& request) {
  const work::Stage stage("optimising the code");
  Stopwatch watch;
  program::Request complete = request;
  complete.parameters = derived.model.parameters.size();
  complete.inputs = derived.model.inputs.size();
  complete.residual = [&derived] { return derive::body_residual(derived.mechanics); };
  complete.forces = [&derived] { return derive::tree_tensions(derived.mechanics); };
  if (!complete.frames) complete.frames = [&derived] { return derive::frames(derived.mechanics); };
  if (!complete.inertias) complete.inertias = [&derived] { return derive::inertias(derived.mechanics); };
  program::Program program = program::build_program(derived.candidates, complete);
  derived.seconds.optimise += watch.lap();
  return program;
}

namespace {

void add_forms(mechanics::Mechanics& mechanics, reading::DisplayForms& forms, verify::Subjects& subjects) {
  constexpr std::size_t large = 16;  // coordinates
  for (const system::Approach approach : {system::Approach::one, system::Approach::two}) {
    // Without eliminated coordinates both approaches coincide: a large system is displayed only once.
    if (approach == system::Approach::one && mechanics.fixed.empty() && mechanics.q.size() > large) continue;
    const reading::DisplayForm& form = forms(approach, reading::Extent::equations);
    std::string name = fmt::format("display form {}", system::name(approach));
    // Too large to be written out: it is displayed in parts, and not compared.
    if (form.is_unexpanded)
      subjects.left_out.push_back({std::move(name), form.unexpanded_reason});
    else
      subjects.reading.push_back({std::move(name), reading::residuals_on_dag(form, mechanics)});
  }
}

}  // namespace

void add_display_forms(mechanics::Mechanics& mechanics, verify::Subjects& subjects) {
  reading::DisplayForms forms(mechanics);
  add_forms(mechanics, forms, subjects);
}

namespace {

/// The key of everything that a certificate depends on. Empty: the certificate is not cached.
std::string key_of(const DerivedModel& derived, const program::Program& program, const Verification& options) {
  const std::string identity = program_identity();
  if (!options.use_cache || options.compiled != nullptr || identity.empty() || derived.model.content_hash.empty())
    return "";
  std::string key = fmt::format("{}\n{}\n{} {} {} {}\n", identity, derived.model.content_hash, options.digits,
                                options.points, options.seed, options.reductions);
  for (const auto& [parameter, value] : options.fixed)
    key += fmt::format("{} = {:.17g}\n", parameter, cln::double_approx(value));
  for (const double input : options.default_inputs) key += fmt::format("{:.17g}\n", input);
  return key + program::fingerprint(program);
}

}  // namespace

verify::Certificate certify(DerivedModel& derived, const program::Program& program, const Verification& options) {
  const work::Stage stage("comparing the derivations");
  Stopwatch watch;
  const std::string key = key_of(derived, program, options);
  if (!key.empty()) {
    if (std::optional<verify::Certificate> kept = load_certificate(key)) {
      kept->options = {options.digits, options.points, options.seed, options.fixed};
      derived.seconds.verify += watch.lap();
      derived.certificate_from_cache = true;
      return std::move(*kept);
    }
  }
  verify::Subjects subjects;
  subjects.systems = verify::all_formulations(derived.mechanics, &subjects.left_out);
  reading::DisplayForms written(derived.mechanics);
  add_forms(derived.mechanics, written, subjects);
  if (options.reductions) {
    const reading::RouthForm routh = written.routh(conservation::cyclic_coordinates(derived.conserved));
    subjects.reading.push_back(
        {"Routh's reduction", reading::residuals_on_dag(routh, derived.mechanics)});  // none: left out
  }
  std::vector<verify::Real> inputs(derived.model.inputs.size(), verify::Real(cln::cl_RA(1) / 3));
  for (std::size_t i = 0; i < options.default_inputs.size(); ++i)
    inputs.at(i) = numeric::exact(options.default_inputs[i]);
  const int range = verify::required_extra_digits(derived.mechanics), digits = options.digits + range;
  subjects.programs.push_back(with_functions(program_form(program, digits, inputs), program, inputs));
  const std::vector<program::Program> forms = other_forms(derived, program, options.fixed);
  for (const program::Program& form : forms) {
    subjects.programs.push_back(program_form(form, digits, inputs));
    subjects.programs.back().name = fmt::format("form {}", system::name(form.form));
  }
  if (options.compiled != nullptr) subjects.compiled.push_back(*options.compiled);
  const verify::Certificate certificate = verify::certify(
      derived.mechanics, subjects, {options.digits, options.points, options.seed, options.fixed, range});
  derived.seconds.verify += watch.lap();
  if (certificate.interrupted && !options.partial) throw work::Interrupted{};
  if (!key.empty()) store_certificate(key, certificate);
  return certificate;
}

void require_pass(const verify::Certificate& certificate, const model::Model& model) {
  if (certificate.pass) return;
  std::string failures, agreeing;
  for (const verify::Comparison& c : certificate.comparisons) {
    if (!c.pass)
      failures +=
          fmt::format("{}{} against {}: {:.3g}", failures.empty() ? "" : "; ", c.a, c.b, c.max_relative_difference);
  }
  for (const std::string& name : certificate.agreeing_forms()) agreeing += (agreeing.empty() ? "" : ", ") + name;
  throw Error("verify", SourceLocation{model.file, 0, 0, 1, ""},
              fmt::format("the derivations of this model disagree ({}), so nothing is emitted; {}", failures,
                          agreeing.empty() ? "none agrees with d'Alembert's principle"
                                           : "d'Alembert's principle agrees with " + agreeing),
              "this is a defect of eomgen: please report it with the model; eomgen verify shows all comparisons",
              ErrorKind::check);
}

emit::EmissionContext code_context(const DerivedModel& derived, const program::Program& program,
                                   const run::Scene& scene) {
  const model::Model& model = derived.model;
  emit::EmissionContext context;
  context.id = model.id;
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    const model::Parameter& p = model.parameters[i];
    context.parameters.push_back({p.name, p.unit.text, p.note, scene.parameters[i]});
  }
  for (std::size_t i = 0; i < model.inputs.size(); ++i) {
    const model::Input& input = model.inputs[i];
    context.inputs.push_back({input.name, input.unit.text, "", scene.inputs[i](scene.t0, scene.t0)});
    if (scene.inputs[i].is_varying() || scene.inputs[i].knots().size() > 1)
      context.varying_inputs.push_back(input.name);
  }
  context.start_time = scene.t0;
  for (const std::uint32_t i : program.free) context.start.push_back(scene.q[i]);
  for (const std::uint32_t i : program.free) context.start.push_back(scene.qdot[i]);
  context.start.insert(context.start.end(), scene.z.begin(), scene.z.end());
  context.tests = test_vectors(program, context);
  return context;
}

emit::EmissionContext emission_context(DerivedModel& derived, const program::Program& program, const run::Scene& scene,
                                       const verify::Certificate& certificate) {
  const model::Model& model = derived.model;
  emit::EmissionContext context = code_context(derived, program, scene);
  context.title = model.title;
  context.content_hash = model.content_hash;
  // Without the measured differences, whose last digits depend on the word size of the machine: the bytes are the same
  // on every machine.
  context.verdict = fmt::format("{}: {} points at {} digits, {} comparisons", certificate.verdict(), certificate.points,
                                certificate.options.digits, certificate.comparisons.size());
  for (const model::Coordinate& c : model.coordinates) context.coordinates.push_back({c.name, c.unit.text, "", 0});
  // Of values that depend on parameters.
  const auto in_model_language = [&](symbolic::Ref formula, model::NodeId id) -> std::string {
    if (derived.mechanics.dag->symbols({formula}).empty()) return "";
    const auto written = reading::as_written(model, id);
    if (!written) return "";
    return print::print(*written, print::Notation(derived.mechanics), print::Format::model_language);
  };
  for (std::size_t i = 0; i < model.parameters.size(); ++i)
    context.parameters[i].expression =
        in_model_language(derived.mechanics.parameter_value[i], model.parameters[i].value);
  for (const model::Sample& sample : model.samples) {
    const auto formula = [&](model::NodeId id) {
      return id == model::no_node ? "" : in_model_language(mechanics::lower_scalar(derived.mechanics, id), id);
    };
    context.sample_formulas.push_back({formula(sample.every), formula(sample.offset)});
  }
  ResetPlaces resets = reset_places(derived, scene);
  context.frames = derive::frame_names(model);
  context.inertial = derive::inertial_parameter_names(model);
  for (std::size_t i = 0; i < model.events.size(); ++i) {
    const model::Event& event = model.events[i];
    context.events.push_back(
        {event.name, model::name(event.direction), event.stop ? "stop" : "record", std::move(resets.events[i])});
  }
  context.samples = std::move(resets.samples);
  for (const print::PrintedFormula& item : print::render_singular(derived.mechanics)) {
    if (item.left_out.empty()) context.singular.push_back(item.text);
  }
  for (const model::State& state : model.states) context.states.push_back({state.name, state.unit.text, "", 0});
  if (model.start_time) context.start_parameter = model.parameters[*model.start_time].name;
  return context;
}

}  // namespace eomgen::pipeline

// SPDX-License-Identifier: GPL-3.0-or-later
#include "bindings.hpp"
#include "calls.hpp"
#include "sweep.hpp"
#include "values.hpp"

namespace eomgen::python {
namespace {

using NumbersByName = std::map<std::string, double>;
using Names = std::vector<std::string>;
using Real = std::optional<double>;

py::object none_if_empty(const std::string& text) { return text.empty() ? py::none() : py::object(py::str(text)); }

py::dict formula(const Formula& f) {
  return py::dict(py::arg("key") = f.key, py::arg("name") = f.name, py::arg("coordinate") = f.coordinate,
                  py::arg("role") = f.role, py::arg("text") = f.text, py::arg("latex") = f.latex,
                  py::arg("mathml") = f.mathml);
}

py::list left_out(const std::vector<LeftOut>& list) {
  return list_of(list, [](const LeftOut& l) { return py::make_tuple(l.what, l.why); });
}

py::list quantities(const std::vector<ExaminedQuantity>& list) {
  return list_of(list, [](const ExaminedQuantity& q) { return py::make_tuple(q.name, q.unit, q.value); });
}

py::dict check(const Model& model, const Callbacks& callbacks) {
  const Examination found = call_library(callbacks, [&](auto& c) { return model.examine(c.control()); });
  py::dict result;
  result["coordinates"] = quantities(found.coordinate_units);
  result["eliminated"] = found.eliminated;
  result["parameters"] = quantities(found.parameters);
  result["inputs"] = quantities(found.inputs);
  result["degrees_of_freedom"] = found.degrees_of_freedom;
  result["constraints"] = list_of(found.constraints, [](const ConstraintClass& c) {
    return py::dict(py::arg("name") = c.name, py::arg("kind") = c.kind, py::arg("integrable") = c.integrable,
                    py::arg("integral") = c.integral, py::arg("redundant") = c.redundant,
                    py::arg("treatment") = c.treatment, py::arg("reason") = c.reason);
  });
  result["forces"] = list_of(found.forces, [](const ForceClass& f) {
    return py::dict(py::arg("name") = f.name, py::arg("conservative") = f.conservative,
                    py::arg("potential") = f.potential ? py::object(formula(*f.potential)) : py::none(),
                    py::arg("reason") = f.reason);
  });
  result["conserved"] = list_of(found.conserved, [](const ConservedQuantity& c) {
    return py::dict(py::arg("name") = c.name, py::arg("title") = c.title, py::arg("expression") = formula(c.expression),
                    py::arg("proven") = c.proven, py::arg("where_zero") = c.where_zero);
  });
  result["singular"] = list_of(found.singular, formula);
  result["left_out"] = left_out(found.left_out);
  return result;
}

py::dict derive(const Model& model, const std::string& approach, const std::optional<Names>& show,
                const Callbacks& callbacks) {
  EquationsOptions options{.approach = approach_named(approach)};
  if (show) options.show = *show;
  const Equations found = call_library(callbacks, [&](auto& c) { return model.equations(options, c.control()); });
  py::dict result;
  result["approach"] = found.approach;
  result["formulas"] = list_of(found.formulas, formula);
  result["left_out"] = left_out(found.left_out);
  result["multipliers"] = list_of(found.multipliers, [](const Multiplier& m) {
    return py::dict(py::arg("name") = m.name, py::arg("latex") = m.latex, py::arg("constraint") = m.constraint,
                    py::arg("meaning") = m.meaning);
  });
  result["interrupted"] = found.interrupted;
  return result;
}

py::dict derivation(const Model& model, const std::string& approach, const Callbacks& callbacks) {
  const Approach by = approach_named(approach);
  const Derivation d = call_library(callbacks, [&](auto& c) { return model.derivation(by, c.control()); });
  py::dict result;
  result["approach"] = d.approach;
  result["formulation"] = d.formulation;
  result["coordinates"] = d.coordinates;
  result["constraints"] = d.constraints;
  result["nodes"] = list_of(d.nodes, [](const Node& node) {
    py::tuple operands(node.arity);
    for (std::size_t i = 0; i < node.arity; ++i) operands[i] = node.args[i];
    return py::make_tuple(node.op, node.text, operands);
  });
  result["M"] = d.M;
  result["f"] = d.f;
  result["A"] = d.A;
  result["gamma"] = d.gamma;
  result["kinetic"] = d.kinetic;
  result["potential"] = d.potential;
  return result;
}

py::dict verify(const Model& model, int digits, std::size_t points, bool compile, std::uint64_t seed,
                const Callbacks& callbacks) {
  const VerifyOptions options{digits, points, seed, compile};
  const Certificate found = call_library(callbacks, [&](auto& c) { return model.verify(options, c.control()); });
  py::dict result;
  result["passed"] = found.pass;
  result["points"] = found.points;
  result["digits"] = found.digits;
  result["comparisons"] = list_of(found.comparisons, [](const Comparison& c) {
    return py::dict(py::arg("a") = c.a, py::arg("b") = c.b, py::arg("shares_code") = c.shares_code,
                    py::arg("max_relative_difference") = c.max_relative_difference, py::arg("tolerance") = c.tolerance,
                    py::arg("passed") = c.pass);
  });
  result["left_out"] = left_out(found.left_out);
  result["summary"] = found.summary;
  result["interrupted"] = found.interrupted;
  return result;
}

py::dict emit(const Model& model, const std::string& target, const std::string& approach, const std::string& form,
              const Names& functions, const Names& outputs, const Names& fixed, const std::string& real,
              std::uint64_t seed, const Callbacks& callbacks) {
  const EmitOptions options{target, approach_named(approach), form, functions, outputs, fixed, seed, real};
  const Sources found = call_library(callbacks, [&](auto& c) { return model.emit(options, c.control()); });
  py::dict files, result;
  for (const SourceFile& file : found.files) {
    const bool is_text = file.text.find('\0') == std::string::npos;
    files[py::str(file.name)] = is_text ? py::object(py::str(file.text)) : py::object(py::bytes(file.text));
  }
  result["files"] = files;
  result["formulation"] = found.formulation;
  result["approach"] = found.approach;
  result["form"] = found.form;
  result["flops"] = found.flops;
  result["certificate"] = found.certificate;
  result["single_precision_error"] = found.single_precision_error;
  return result;
}

RunOptions run_options(const py::dict& given) {
  RunOptions options;
  take(given, "scene", options.scene);
  take(given, "parameters", options.parameters);
  take(given, "t_end", options.t_end);
  take(given, "rtol", options.rtol);
  take(given, "atol", options.atol);
  take(given, "step", options.step);
  take(given, "max_step", options.max_step);
  take(given, "every", options.every);
  take(given, "solver", options.solver);
  take(given, "outputs", options.outputs);
  take(given, "form", options.form);
  take(given, "tier", options.tier);
  take(given, "max_steps", options.max_steps);
  take(given, "error_estimate", options.error_estimate);
  take(given, "estimate", options.estimate);
  take(given, "charts", options.charts);
  take(given, "seed", options.seed);
  std::string approach = "auto";
  take(given, "approach", approach);
  options.approach = approach_named(approach);
  return options;
}

py::dict run(const Model& model, const py::dict& given, const py::object& row, const Callbacks& callbacks) {
  const RunOptions options = run_options(given);
  const Motion motion = call_library(callbacks, [&](PythonControl& c) {
    RunOptions own = options;
    if (!row.is_none()) {
      own.row = [&](double t, std::span<const double> values) {
        c.call([&] { row(t, py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data())); });
      };
    }
    return model.run(own, c.control());
  });
  py::dict result;
  result["outcome"] = motion.outcome;
  result["detail"] = motion.detail;
  result["solver"] = motion.solver;
  result["solver_reason"] = motion.solver_reason;
  result["tier"] = motion.tier;
  result["tier_reason"] = motion.tier_reason;
  result["t"] = motion.t;
  result["columns"] = motion.columns;
  py::dict units;
  for (std::size_t i = 0; i < motion.columns.size(); ++i) units[py::str(motion.columns[i])] = motion.units[i];
  result["units"] = units;
  result["times"] = array_of(motion.times);
  result["rows"] = matrix_of(motion.rows, motion.columns.size());
  result["final"] = dict_of(motion.final);
  result["error_estimate"] = motion.error_estimate.empty() ? py::none() : py::object(dict_of(motion.error_estimate));
  result["estimate_note"] = none_if_empty(motion.estimate_note);
  result["invariants"] = list_of(motion.invariants, [](const Invariant& i) {
    return py::dict(py::arg("name") = i.name, py::arg("initial") = i.initial,
                    py::arg("max_relative_drift") = i.max_relative_drift);
  });
  result["power_balance"] = motion.power_balance;
  result["constraint_drift"] = motion.constraint_drift;
  result["steps"] = motion.steps;
  result["rhs_evaluations"] = motion.rhs_evaluations;
  result["events"] = event_list(motion.events);
  result["certificate"] = motion.certificate;
  return result;
}

py::dict run_sweep(const Model& model, const py::dict& given, const Names& names, const py::array& points,
                   std::size_t jobs, const Callbacks& callbacks) {
  const auto values = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(points);
  const SweepRequest request{run_options(given), names, {values.data(), static_cast<std::size_t>(values.size())}, jobs};
  const SweepResult found = call_library(callbacks, [&](auto& c) { return sweep(model, request, c.control()); });
  const std::size_t K = found.ends.size(), C = found.columns.size();
  py::array_t<double> final({K, C}), errors(static_cast<py::ssize_t>(K)), t(static_cast<py::ssize_t>(K));
  py::list outcomes, details;
  for (std::size_t k = 0; k < K; ++k) {
    const SweepEnd& end = found.ends[k];
    double* const to = final.mutable_data() + k * C;
    std::fill(to, to + C, std::numeric_limits<double>::quiet_NaN());
    std::copy(end.values.begin(), end.values.end(), to);
    errors.mutable_data()[k] = end.error;
    t.mutable_data()[k] = end.t;
    outcomes.append(end.outcome);
    details.append(end.detail);
  }
  py::dict result, units;
  for (std::size_t i = 0; i < C; ++i) units[py::str(found.columns[i])] = found.units[i];
  result["parameters"] = names;
  result["points"] = values;
  result["columns"] = found.columns;
  result["units"] = units;
  result["final"] = final;
  result["errors"] = request.options.error_estimate ? py::object(errors) : py::none();
  result["outcomes"] = outcomes;
  result["details"] = details;
  result["t"] = t;
  return result;
}

py::dict inverse(const Model& model, const std::string& scene, const NumbersByName& parameters, Real t_end, Real every,
                 Real rtol, Real atol, const Names& constraints, std::uint64_t seed, const Callbacks& callbacks) {
  const InverseOptions options{scene, parameters, t_end, every, rtol, atol, constraints, seed};
  const InverseDynamics found =
      call_library(callbacks, [&](auto& c) { return model.inverse_dynamics(options, c.control()); });
  py::dict result;
  result["outcome"] = found.outcome;
  result["detail"] = found.detail;
  result["certificate"] = found.certificate;
  result["columns"] = found.columns;
  result["forces"] = found.forces;
  result["times"] = array_of(found.times);
  result["rows"] = matrix_of(found.rows, found.columns.size());
  return result;
}

py::dict linearize(const Model& model, const std::string& scene, const NumbersByName& parameters, Real time,
                   std::uint64_t seed, const Names& outputs, const Callbacks& callbacks) {
  const LineariseOptions options{scene, parameters, time, seed, outputs};
  const Linearisation l = call_library(callbacks, [&](auto& c) { return model.linearise(options, c.control()); });
  py::dict result;
  result["kind"] = l.kind;
  result["states"] = l.states;
  result["inputs"] = l.inputs;
  result["A"] = matrix_of(l.A, l.states.size(), l.states.size());
  result["B"] = matrix_of(l.B, l.states.size(), l.inputs.size());
  result["outputs"] = l.outputs;
  result["output_values"] = array_of(l.output_values);
  result["C"] = matrix_of(l.C, l.outputs.size(), l.states.size());
  result["D"] = matrix_of(l.D, l.outputs.size(), l.inputs.size());
  result["eigenvalues"] = array_of(l.eigenvalues);
  result["structural_zeros"] = l.structural_zeros;
  result["certificate"] = l.certificate;
  return result;
}

py::dict equilibria(const Model& model, const std::string& scene, const NumbersByName& parameters,
                    const NumbersByName& hold, std::size_t starts, std::uint64_t seed, const Callbacks& callbacks) {
  const SteadyOptions options{scene, parameters, hold, starts, seed};
  const SteadyMotions found =
      call_library(callbacks, [&](auto& c) { return model.steady_motions(options, c.control()); });
  py::dict result;
  result["motions"] = list_of(found.motions, [](const SteadyMotion& m) {
    return py::dict(py::arg("kind") = m.kind, py::arg("state") = m.state, py::arg("stability") = m.stability,
                    py::arg("reason") = m.reason, py::arg("eigenvalues") = array_of(m.eigenvalues),
                    py::arg("family_dimension") = m.family_dimension);
  });
  result["held"] = found.held;
  result["interrupted"] = found.interrupted;
  result["certificate"] = found.certificate;
  return result;
}

py::dict bench(const Model& model, const std::string& scene, const NumbersByName& parameters, Real t_end,
               const Names& solvers, double max_seconds, bool other_libraries, std::uint64_t seed,
               const Callbacks& callbacks) {
  const BenchmarkOptions options{scene, parameters, t_end, solvers, max_seconds, other_libraries, seed};
  const Benchmark found = call_library(callbacks, [&](auto& c) { return model.benchmark(options, c.control()); });
  py::dict result;
  result["rows"] = list_of(found.rows, [](const BenchmarkRow& r) {
    return py::dict(py::arg("solver") = r.solver, py::arg("rtol") = r.rtol, py::arg("step") = r.step,
                    py::arg("error") = r.error, py::arg("seconds") = r.seconds, py::arg("steps") = r.steps,
                    py::arg("rhs_evaluations") = r.rhs_evaluations, py::arg("outcome") = r.outcome);
  });
  result["left_out"] = left_out(found.left_out);
  result["reference_digits"] = found.reference_digits;
  result["advice"] = found.advice;
  result["conclusive"] = found.conclusive;
  return result;
}

py::dict stress(const Model& model, const std::string& scene, const NumbersByName& parameters, Real t_end,
                const Names& solvers, double max_seconds, std::size_t max_steps, bool quick, std::uint64_t seed,
                const Callbacks& callbacks) {
  const StressOptions options{scene, parameters, t_end, solvers, max_seconds, max_steps, quick, seed};
  const StressTest found = call_library(callbacks, [&](auto& c) { return model.stress_test(options, c.control()); });
  py::dict result;
  result["rows"] = list_of(found.rows, [](const StressRow& r) {
    return py::dict(py::arg("test") = r.test, py::arg("solver") = r.solver, py::arg("verdict") = r.verdict,
                    py::arg("error") = r.error, py::arg("estimate") = r.estimate, py::arg("outcome") = r.outcome,
                    py::arg("note") = r.note);
  });
  result["left_out"] = left_out(found.left_out);
  result["passed"] = found.pass;
  result["reported"] = found.reported;
  result["undetected"] = found.undetected;
  return result;
}

}  // namespace

void add_model(py::module_& module) {
  py::class_<Callbacks>(module, "Callbacks")
      .def(py::init<py::object, py::object, py::object>(), py::arg("stage"), py::arg("progress"), py::arg("warning"));
  py::class_<Model, Holder<Model>>(module, "Model")
      .def_static("from_file", &Model::from_file, py::call_guard<py::gil_scoped_release>())
      .def_static("from_text", &Model::from_text, py::call_guard<py::gil_scoped_release>())
      .def("id", &Model::id)
      .def("title", &Model::title)
      .def("text", &Model::text)
      .def("folder", &Model::folder)
      .def("coordinates", &Model::coordinates)
      .def("parameters", &Model::parameters)
      .def("inputs", &Model::inputs)
      .def("scenes", &Model::scenes)
      .def("number_of",
           [](const Model& model, const std::string& name, const std::string& text, const py::object& warning) {
             return model.number_of(name, text, {.on_warning = [&](const std::string& what) { warning(what); }});
           })
      .def("warnings",
           [](const Model& model) {
             return list_of(model.reader_warnings(), [](const Warning& w) {
               return py::dict(py::arg("file") = w.where.file, py::arg("line") = w.where.line,
                               py::arg("column") = w.where.column, py::arg("source_line") = w.where.text,
                               py::arg("message") = w.message, py::arg("remedy") = w.remedy,
                               py::arg("report") = format_warning(w));
             });
           })
      .def("check", check)
      .def("derive", derive)
      .def("derivation", derivation)
      .def("document",
           [](const Model& model, std::uint64_t seed, const Callbacks& callbacks) {
             return call_library(callbacks, [&](auto& c) { return model.latex_document(c.control(), seed); });
           })
      .def("verify", verify)
      .def("emit", emit)
      .def("run", run)
      .def("sweep", run_sweep)
      .def("inverse", inverse)
      .def("linearize", linearize)
      .def("equilibria", equilibria)
      .def("bench", bench)
      .def("stress", stress);
}

}  // namespace eomgen::python

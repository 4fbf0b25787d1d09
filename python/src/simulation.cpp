// SPDX-License-Identifier: GPL-3.0-or-later
// eomgen._core.Simulation: a motion that Python advances in pieces.
#include <limits>

#include "arrays.hpp"
#include "calls.hpp"
#include "values.hpp"

namespace eomgen::python {
namespace {

/// Functions of time that are inputs may be called in a thread without the GIL, and their exceptions cross the library.
struct PythonSimulation {
  PythonSimulation(const CompiledModel& model, const SimulationOptions& options) : simulation(model, options) {}

  Simulation simulation;
  PythonControl* control = nullptr;  // of the call in progress
  double last = 0;                   // what a failed function of time returns until the call ends
};

SimulationOptions simulation_options(const py::dict& given) {
  SimulationOptions options;
  take(given, "parameters", options.parameters);
  take(given, "rtol", options.rtol);
  take(given, "atol", options.atol);
  take(given, "step", options.step);
  take(given, "max_step", options.max_step);
  take(given, "solver", options.solver);
  take(given, "every", options.every);
  take(given, "max_steps", options.max_steps);
  return options;
}

std::unique_ptr<PythonSimulation, DeleteWithoutGil<PythonSimulation>> simulate(const CompiledModel& model,
                                                                               const py::dict& given) {
  const SimulationOptions options = simulation_options(given);
  const py::gil_scoped_release released;
  return Holder<PythonSimulation>(new PythonSimulation(model, options));
}

/// Null: None.
double number(const char* name, PyObject* given) {
  if (given != nullptr && PyFloat_Check(given)) return PyFloat_AS_DOUBLE(given);
  return converted("number", name, given == nullptr ? Py_None : given).cast<double>();
}

/// `advance` returns what an interruption left undone, if the handler of the signal raised nothing.
template <class Piece>
Advance advance_in(PythonSimulation& s, Piece&& piece) {
  if (s.control != nullptr)
    throw Error("python", {}, "the simulation is advancing already", "use one simulation in one thread at a time");
  Advance whole;
  bool first = true;
  while (true) {
    PythonControl control({});
    Advance part;
    s.control = &control;
    try {
      const py::gil_scoped_release released;
      part = piece(control.control());
    } catch (...) {
      s.control = nullptr;
      control.rethrow();
      throw;
    }
    s.control = nullptr;
    control.rethrow();
    if (first && !control.is_stopped()) return part;
    first = false;
    whole.outcome = part.outcome;
    whole.detail = part.detail;
    whole.t = part.t;
    whole.steps += part.steps;
    whole.rhs_evaluations += part.rhs_evaluations;
    whole.events.insert(whole.events.end(), part.events.begin(), part.events.end());
    whole.times.insert(whole.times.end(), part.times.begin(), part.times.end());
    whole.rows.insert(whole.rows.end(), part.rows.begin(), part.rows.end());
    if (!control.is_stopped()) return whole;
  }
}

PyObject* result_of(Advance&& end) {
  if (!end.is_complete())
    throw Error("simulation", {},
                "the simulation ended at t = " + std::to_string(end.t) + " s: " + end.outcome +
                    (end.detail.empty() ? "" : ", " + end.detail),
                "change the tolerances, the solver or the inputs, or restore an earlier state", ErrorKind::numerical);
  return py::cast(std::move(end)).release().ptr();
}

PyObject* advance(PyObject* self, PyObject* const* arguments, Py_ssize_t count, PyObject* keywords) {
  return guarded([&] {
    const auto given = take_arguments<1>("advance", {"t"}, 1, arguments, count, keywords);
    const double t = number("t", given[0]);
    auto& s = object_of<PythonSimulation>(self);
    return result_of(advance_in(s, [&](const CallControl& control) { return s.simulation.advance(t, control); }));
  });
}

PyObject* step(PyObject* self, PyObject* const* arguments, Py_ssize_t count, PyObject* keywords) {
  return guarded([&] {
    const auto given = take_arguments<1>("step", {"limit"}, 0, arguments, count, keywords);
    double limit = std::numeric_limits<double>::infinity();
    if (given[0] != nullptr) limit = number("limit", given[0]);
    auto& s = object_of<PythonSimulation>(self);
    return result_of(advance_in(s, [&](const CallControl& control) { return s.simulation.step(limit, control); }));
  });
}

PyObject* set_inputs(PyObject* self, PyObject* const* arguments, Py_ssize_t count, PyObject* keywords) {
  return guarded([&] {
    const auto given = take_arguments<1>("set_inputs", {"values"}, 1, arguments, count, keywords);
    const Numbers values(given[0], "values");
    object_of<PythonSimulation>(self).simulation.set_inputs(values.span());
    Py_RETURN_NONE;
  });
}

/// A method without arguments that returns an array.
template <auto read>
PyObject* array_method(PyObject* self, PyObject* const* arguments, Py_ssize_t count, PyObject* keywords) {
  return guarded([&] {
    take_arguments<0>("the method", {}, 0, arguments, count, keywords);
    const auto& values = (object_of<PythonSimulation>(self).simulation.*read)();
    const std::array<Py_ssize_t, 1> shape{static_cast<Py_ssize_t>(values.size())};
    py::object array = new_array(shape);
    std::copy(values.begin(), values.end(), data_of(array));
    return array.release().ptr();
  });
}

void set_input(PythonSimulation& s, const std::string& name, const py::object& value) {
  if (PyCallable_Check(value.ptr()) == 0) return s.simulation.set_input(name, value.cast<double>());
  // The library copies and drops the function in any thread.
  const std::shared_ptr<PyObject> function(value.inc_ref().ptr(), [](PyObject* f) {
    const py::gil_scoped_acquire gil;
    Py_DECREF(f);
  });
  s.simulation.set_input(name, [&s, function, result = "the result of the input " + name](double t) {
    const auto call = [&] { s.last = number(result.c_str(), py::handle(function.get())(t).ptr()); };
    if (s.control != nullptr) {
      s.control->call(call);
    } else {
      const py::gil_scoped_acquire gil;
      call();
    }
    return s.last;
  });
}

}  // namespace

void add_simulation(py::module_& module) {
  py::class_<Advance>(module, "Advance", "The end of one advance: where it ended, and what happened until then.")
      .def_readonly("outcome", &Advance::outcome, "\"done\" or \"stopped_by_event\"")
      .def_readonly("detail", &Advance::detail, "which event stopped it")
      .def_readonly("t", &Advance::t, "the time reached, in s")
      .def_readonly("steps", &Advance::steps)
      .def_readonly("rhs_evaluations", &Advance::rhs_evaluations)
      .def_property_readonly(
          "events", [](const Advance& a) { return event_list(a.events); }, "list of Event")
      .def_property_readonly(
          "times", [](const Advance& a) { return array_of(a.times); }, "K times of rows, in s")
      .def_property_readonly(
          "rows", [](const Advance& a) { return matrix_of(a.rows, a.rows.empty() ? 0 : a.rows.front().size()); },
          "K x Y: the outputs at these times")
      .def("__repr__", [](const Advance& a) {
        return "<eomgen.Advance " + a.outcome + " at t = " + std::to_string(a.t) + " s, " + std::to_string(a.steps) +
               " steps>";
      });
  py::class_<SimulationState>(module, "SimulationState",
                              "All that the future of a simulation depends on. Only a simulation of the same "
                              "CompiledModel restores it; it cannot be pickled.")
      .def_property_readonly("t", &SimulationState::t, "s");
  py::class_<PythonSimulation, Holder<PythonSimulation>> type(module, "Simulation");
  type.def(py::init(&simulate))
      .def_property_readonly(
          "t", [](const PythonSimulation& s) { return s.simulation.t(); }, "The time reached, in s.")
      .def("_set_input", set_input)
      .def(
          "set_parameters",
          [](PythonSimulation& s, const py::object& values) {
            s.simulation.set_parameters(Numbers(values.ptr(), "values").span());
          },
          py::arg("values"), "Continues with other parameters: (P,). Parameters that depend on others do not follow.")
      .def(
          "set_state",
          [](PythonSimulation& s, const py::object& t_given, const py::object& x) {
            const double t = number("t", t_given.ptr());
            const Numbers values(x.ptr(), "x");
            const py::gil_scoped_release released;
            s.simulation.set_state(t, values.span());
          },
          py::arg("t"), py::arg("x"),
          "Continues from another time in s and state, (N,), which has to satisfy the constraints.")
      .def(
          "save", [](const PythonSimulation& s) { return s.simulation.save(); },
          "Returns the state with inputs, parameters, modes of contacts, charts and step size.")
      .def(
          "restore",
          [](PythonSimulation& s, const py::object& state) {
            if (!py::isinstance<SimulationState>(state))
              throw Error("python", {}, "state: it is not a saved state", "give the result of save()");
            s.simulation.restore(state.cast<const SimulationState&>());
          },
          py::arg("state"), "Continues from a saved state with the same bits.");
  add_method(type, "advance",
             "advance(t)\n--\n\nIntegrates until t in s, or to an event that stops the scene. Raises Error (kind "
             "\"numerical\")\nif it fails. Ctrl-C ends it, and the simulation is where it was interrupted.",
             advance);
  add_method(type, "step", "step(limit=None)\n--\n\nOne step of the solver, until `limit` in s at most.", step);
  add_method(type, "set_inputs", "set_inputs(values)\n--\n\nHolds all inputs at values from here on: (U,).",
             set_inputs);
  add_method(type, "state", "state()\n--\n\nThe state: (N,), a copy.", array_method<&Simulation::state>);
  add_method(type, "outputs", "outputs()\n--\n\nThe outputs at the time reached: (Y,).",
             array_method<&Simulation::outputs>);
  add_method(type, "inputs", "inputs()\n--\n\nThe inputs at the time reached: (U,).",
             array_method<&Simulation::inputs>);
  add_method(type, "parameters", "parameters()\n--\n\nThe parameters: (P,), a copy.",
             array_method<&Simulation::parameters>);
}

}  // namespace eomgen::python

// SPDX-License-Identifier: GPL-3.0-or-later
// eomgen._core.CompiledModel: functions of one state or of many, without the GIL.
#include <eomgen/fixed_step.hpp>
#include <limits>
#include <type_traits>

#include "arrays.hpp"
#include "calls.hpp"
#include "compiled_functions.hpp"
#include "values.hpp"

namespace eomgen::python {
namespace {

const char* meaning_of(int code) {
  switch (code) {
    case 1: return "the mass matrix is singular";
    case 2: return "`mode` names charts that there are not";
    case 3: return "the friction law has no solution in this mode";
    case 4: return "the friction law has several solutions in this mode";
    case 5: return "a value is not finite";
    case 6: return "the order is too large";
    case FixedStep::no_convergence: return "the step could not be solved";
    default: return "docs/abi.md, 'Return codes'";
  }
}

[[noreturn]] void refuse(const Function& f, int code) {
  if (code == CompiledModel::not_compiled)
    throw Error("python", {}, std::string("the function '") + f.compiled + "' was not compiled",
                std::string("name it: model.compile(functions=['") + f.compiled + "', ..])");
  throw Error(
      "python", {},
      std::string(f.name) + " has no value at this state: code " + std::to_string(code) + ", " + meaning_of(code),
      "evaluate it at another state", ErrorKind::numerical);
}

[[noreturn]] void refuse_shape(const char* name, const Numbers& given, const std::string& expected) {
  throw Error("python", {}, std::string(name) + " has the shape " + given.shape(), "give " + expected);
}

/// Numbers of one state, or of each of `count` states. Returns the step between states.
std::size_t step_of(const char* name, const Numbers& given, std::size_t length, std::size_t count, bool many) {
  if (!given) return 0;
  const bool own = given.dimensions() == 2;
  const std::size_t last = given.dimensions() == 0 ? 1 : static_cast<std::size_t>(given.length(given.dimensions() - 1));
  if (last != length || (own && (!many || static_cast<std::size_t>(given.length(0)) != count)))
    refuse_shape(name, given,
                 "(" + std::to_string(length) + ",)" +
                     (many ? " or (" + std::to_string(count) + ", " + std::to_string(length) + ")" : ""));
  return own ? length : 0;
}

std::vector<int> modes_of(PyObject* given, const CompiledModel& model) {
  std::vector<int> mode;
  if (given == nullptr) return mode;
  mode = converted("integers", "mode", given).cast<std::vector<int>>();
  const auto size = [](const auto& m) {
    if constexpr (requires { m.mode_size(); })
      return m.mode_size();
    else
      return std::size_t{1};
  }(model);
  if (mode.size() != size)
    throw Error("python", {}, "mode has " + std::to_string(mode.size()) + " entries",
                "give " + std::to_string(size) + " integers");
  return mode;
}

template <class At>
void set_mode(At& at, const std::vector<int>& mode) {
  if (mode.empty()) return;
  if constexpr (std::is_pointer_v<decltype(at.mode)>)
    at.mode = mode.data();
  else
    at.mode = mode.front();
}

/// Request of a call: one state, or `count` states.
struct Call {
  const CompiledModel& model;
  const Function& function;
  bool many;
  std::size_t count;
  const double *t, *x, *inputs, *parameters, *v;
  std::size_t t_step, input_step, parameter_step, v_step;
  std::vector<int> mode;
  std::array<double*, most_results> results;
  std::array<std::size_t, most_results> sizes;

  int evaluate() const;
};

int Call::evaluate() const {
  const std::size_t N = model.states().size();
  if (&function == functions.data() && many && input_step == 0 && parameter_step == 0 && mode.empty() && t_step == 1)
    return model.rhs_batch(count, t, x, parameters, inputs, results[0]);
  int first = 0;
  std::array<double*, most_results> to = results;
  for (std::size_t k = 0; k < count; ++k) {
    Arguments at{t[k * t_step], x + k * N, parameters == nullptr ? nullptr : parameters + k * parameter_step,
                 inputs == nullptr ? nullptr : inputs + k * input_step};
    if (v != nullptr) at.v = v + k * v_step;
    set_mode(at, mode);
    const int code = function.evaluate(model, at, to.data());
    if (code == CompiledModel::not_compiled) return code;
    if (code != 0 && first == 0) first = code;
    for (std::size_t i = 0; i < function.count; ++i) {
      if (code != 0) std::fill(to[i], to[i] + sizes[i], std::numeric_limits<double>::quiet_NaN());
      to[i] += sizes[i];
    }
  }
  return first;
}

py::object new_result(const ResultShape& shape, const CompiledModel& model, bool many, std::size_t count) {
  const auto rows = static_cast<Py_ssize_t>(value_of(shape.rows, model));
  const auto K = static_cast<Py_ssize_t>(count);
  if (shape.columns == Size::none) {
    const std::array<Py_ssize_t, 2> both{K, rows};
    return new_array(std::span(both).subspan(many ? 0 : 1));
  }
  const auto columns = static_cast<Py_ssize_t>(value_of(shape.columns, model));
  constexpr Py_ssize_t size = sizeof(double);
  const std::array<Py_ssize_t, 3> all{K, rows, columns}, strides{rows * columns * size, size, rows * size};
  return new_array(std::span(all).subspan(many ? 0 : 1), std::span(strides).subspan(many ? 0 : 1));
}

PyObject* call(const Function& f, PyObject* self, PyObject* const* arguments, Py_ssize_t positional,
               PyObject* keywords) {
  const CompiledModel& model = object_of<CompiledModel>(self);
  static constexpr std::array names{"t", "x", "inputs", "parameters", "mode"};
  static constexpr std::array names_with_v{"t", "x", "v", "inputs", "parameters", "mode"};
  std::array<PyObject*, 5> given{};
  PyObject* vector = nullptr;
  if (f.vector == Size::none) {
    given = take_arguments<5>(f.name, names, 2, arguments, positional, keywords);
  } else {
    const auto all = take_arguments<6>(f.name, names_with_v, 3, arguments, positional, keywords);
    vector = all[2];
    given = {all[0], all[1], all[3], all[4], all[5]};
  }
  const Numbers v(vector, "v");
  const Numbers t(given[0], "t"), x(given[1], "x"), parameters(given[3], "parameters");
  py::object returned;
  if (given[2] != nullptr && PyCallable_Check(given[2]) != 0)
    returned = py::handle(given[2])(py::handle(given[0]), py::handle(given[1]));
  const Numbers inputs(returned ? returned.ptr() : given[2], "inputs");
  const std::size_t N = model.states().size();
  const bool many = x.dimensions() == 2;
  const std::size_t count = many ? static_cast<std::size_t>(x.length(0)) : 1;
  if (!t || !x || x.dimensions() == 0 || static_cast<std::size_t>(x.length(many ? 1 : 0)) != N)
    refuse_shape("x", x, "(" + std::to_string(N) + ",) or (K, " + std::to_string(N) + ")");
  if (t.dimensions() > 1 || (t.dimensions() == 1 && (!many || static_cast<std::size_t>(t.length(0)) != count)))
    refuse_shape("t", t, many ? "a number or (" + std::to_string(count) + ",)" : "a number");
  Call evaluation{model,
                  f,
                  many,
                  count,
                  t.data(),
                  x.data(),
                  inputs.data(),
                  parameters.data(),
                  v.data(),
                  t.dimensions() == 1 ? std::size_t{1} : 0,
                  step_of("inputs", inputs, model.inputs().size(), count, many),
                  step_of("parameters", parameters, model.parameters().size(), count, many),
                  f.vector == Size::none ? 0 : step_of("v", v, value_of(f.vector, model), count, many),
                  modes_of(given[4], model),
                  {},
                  {}};
  std::array<py::object, most_results> results;
  for (std::size_t i = 0; i < f.count; ++i) {
    results[i] = new_result(f.results[i], model, many, count);
    evaluation.results[i] = data_of(results[i]);
    evaluation.sizes[i] = value_of(f.results[i].rows, model) * value_of(f.results[i].columns, model);
  }
  int code = 0;
  std::vector<double> times;
  if (many && evaluation.t_step == 0) {
    times.assign(count, *evaluation.t);
    evaluation.t = times.data();
    evaluation.t_step = 1;
  }
  {
    const py::gil_scoped_release released;
    code = evaluation.evaluate();
  }
  if (code == CompiledModel::not_compiled || (code != 0 && !many)) refuse(f, code);
  if (f.count == 1) return results[0].release().ptr();
  PyObject* const tuple = PyTuple_New(static_cast<Py_ssize_t>(f.count));
  for (std::size_t i = 0; i < f.count; ++i)
    PyTuple_SET_ITEM(tuple, static_cast<Py_ssize_t>(i), results[i].release().ptr());
  return tuple;
}

template <std::size_t i>
PyObject* method(PyObject* self, PyObject* const* arguments, Py_ssize_t count, PyObject* keywords) {
  return guarded([&] { return call(functions[i], self, arguments, count, keywords); });
}

template <std::size_t... i>
void add_methods(py::handle type, std::index_sequence<i...>) {
  (add_method(type, functions[i].name, functions[i].doc, method<i>), ...);
}

CompileOptions compile_options(const py::dict& given) {
  CompileOptions options;
  take(given, "scene", options.scene);
  take(given, "parameters", options.parameters);
  take(given, "form", options.form);
  take(given, "tier", options.tier);
  take(given, "solver", options.solver);
  take(given, "functions", options.functions);
  take(given, "outputs", options.outputs);
  take(given, "charts", options.charts);
  take(given, "seed", options.seed);
  std::string approach = "auto";
  take(given, "approach", approach);
  options.approach = approach_named(approach);
  return options;
}

CompiledModel compile(const Model& model, const py::dict& given, const Callbacks& callbacks) {
  const CompileOptions options = compile_options(given);
  return call_library(callbacks, [&](auto& c) { return model.compile(options, c.control()); });
}

py::list names_and_units(const std::vector<Quantity>& quantities) {
  return list_of(quantities, [](const Quantity& q) { return py::make_tuple(q.name, q.unit); });
}

py::tuple scene_values(const SceneValues& values) {
  return py::make_tuple(values.t_start, values.t_end, array_of(values.parameters), array_of(values.state));
}

py::array taylor(const CompiledModel& model, double t, const py::object& state, int order, const py::object& inputs,
                 const py::object& parameters, const py::object& mode) {
  const std::size_t N = model.states().size();
  const auto given = [](const py::object& object) { return object.is_none() ? nullptr : object.ptr(); };
  const Numbers x(state.ptr(), "x"), u(given(inputs), "inputs"), p(given(parameters), "parameters");
  if (x.dimensions() != 1 || static_cast<std::size_t>(x.length(0)) != N)
    refuse_shape("x", x, "(" + std::to_string(N) + ",)");
  step_of("inputs", u, model.inputs().size(), 1, false);
  step_of("parameters", p, model.parameters().size(), 1, false);
  const std::vector<int> modes = modes_of(given(mode), model);
  Arguments at{t, x.data(), p.data(), u.data()};
  set_mode(at, modes);
  py::array_t<double> result({static_cast<std::size_t>(order) + 1, N});
  const int code = model.taylor(at, order, result.mutable_data());
  if (code != 0) refuse({"taylor", "taylor", "", 1, {}, nullptr}, code);
  return result;
}

/// An argument of a step that is one number, or one of each state.
std::size_t step_of_number(const char* name, const Numbers& given, std::size_t count, bool many) {
  if (!given || given.dimensions() > 1 ||
      (given.dimensions() == 1 && (!many || static_cast<std::size_t>(given.length(0)) != count)))
    refuse_shape(name, given, many ? "a number or (" + std::to_string(count) + ",)" : "a number");
  return given.dimensions() == 1 ? 1 : 0;
}

/// x1 of one state or of each of K; with `derivatives` also those by x, inputs, parameters, h, t. None: a function is
/// missing.
py::tuple fixed_step(const CompiledModel& model, const py::object& t_given, const py::object& h_given,
                     const py::object& state, const py::object& inputs_given, const py::object& parameters,
                     const py::object& mode, const py::object& method_given, bool derivatives) {
  const auto method = converted("text", "method", method_given).cast<std::string>();
  const auto given = [](const py::object& object) { return object.is_none() ? nullptr : object.ptr(); };
  const bool calls = !inputs_given.is_none() && PyCallable_Check(inputs_given.ptr()) != 0;
  const py::object inputs = calls ? inputs_given(t_given, state) : inputs_given;
  const Numbers t(given(t_given), "t"), h(given(h_given), "h"), x(given(state), "x"), u(given(inputs), "inputs"),
      p(given(parameters), "parameters");
  const std::size_t N = model.states().size(), U = model.inputs().size(), P = model.parameters().size();
  const bool many = x.dimensions() == 2;
  const std::size_t K = many ? static_cast<std::size_t>(x.length(0)) : 1;
  if (!x || x.dimensions() == 0 || static_cast<std::size_t>(x.length(many ? 1 : 0)) != N)
    refuse_shape("x", x, "(" + std::to_string(N) + ",) or (K, " + std::to_string(N) + ")");
  const std::size_t t_step = step_of_number("t", t, K, many), h_step = step_of_number("h", h, K, many);
  const std::size_t u_step = step_of("inputs", u, U, K, many), p_step = step_of("parameters", p, P, K, many);
  const std::vector<int> modes = modes_of(given(mode), model);
  FixedStep step(model, method);
  constexpr std::array shapes{ResultShape{Size::states},
                              ResultShape{Size::states, Size::states},
                              ResultShape{Size::states, Size::inputs},
                              ResultShape{Size::states, Size::parameters},
                              ResultShape{Size::states},
                              ResultShape{Size::states}};
  const std::string slopes = method == "variational2" ? "momenta_jac" : "jac";
  const std::array<bool, 6> wanted{true,
                                   derivatives,
                                   derivatives && (U == 0 || model.has(slopes + "_u")),
                                   derivatives && (P == 0 || model.has(slopes + "_p")),
                                   derivatives,
                                   derivatives};
  std::array<py::object, 6> results;
  std::array<double*, 6> to{};
  std::array<std::size_t, 6> sizes{};
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i] = py::none();
    if (!wanted[i]) continue;
    results[i] = new_result(shapes[i], model, many, K);
    to[i] = data_of(results[i]);
    sizes[i] = value_of(shapes[i].rows, model) * value_of(shapes[i].columns, model);
  }
  // Without inputs or parameters there is nothing to compute.
  const bool by_inputs = U > 0 && wanted[2], by_parameters = P > 0 && wanted[3];
  int first = 0;
  {
    const py::gil_scoped_release released;
    for (std::size_t k = 0; k < K && first != CompiledModel::not_compiled; ++k) {
      Arguments at{t.data()[k * t_step], x.data() + k * N, p ? p.data() + k * p_step : nullptr,
                   u ? u.data() + k * u_step : nullptr};
      set_mode(at, modes);
      const StepDerivatives by{to[1], by_parameters ? to[3] : nullptr, by_inputs ? to[2] : nullptr, to[5], to[4]};
      const int code = step.derivatives(at, h.data()[k * h_step], to[0], by);
      if (first == 0) first = code;
      for (std::size_t i = 0; i < to.size(); ++i) {
        if (code != 0) std::fill(to[i], to[i] + sizes[i], std::numeric_limits<double>::quiet_NaN());
        to[i] += sizes[i];
      }
    }
  }
  if (first == CompiledModel::not_compiled || (first != 0 && !many))
    refuse({"step", slopes.c_str(), "", 1, {}, nullptr}, first);
  return py::make_tuple(results[0], results[1], results[2], results[3], results[4], results[5]);
}

}  // namespace

void add_compiled_model(py::module_& module) {
  py::class_<CompiledModel, Holder<CompiledModel>> type(module, "CompiledModel");
  type.def(py::init(&compile))
      .def("_scene", &CompiledModel::scene)
      .def("_states", [](const CompiledModel& f) { return names_and_units(f.states()); })
      .def("_parameters", [](const CompiledModel& f) { return names_and_units(f.parameters()); })
      .def("_inputs", [](const CompiledModel& f) { return names_and_units(f.inputs()); })
      .def("_outputs", [](const CompiledModel& f) { return names_and_units(f.outputs()); })
      .def("_constraints", [](const CompiledModel& f) { return f.constraints(); })
      .def("_reactions", [](const CompiledModel& f) { return f.reactions(); })
      .def("_events", [](const CompiledModel& f) { return f.events(); })
      .def("_frame_names", [](const CompiledModel& f) { return f.frames(); })
      .def("_inertial_parameter_names", [](const CompiledModel& f) { return f.inertial_parameters(); })
      .def("_event_count", &CompiledModel::event_count)
      .def("_coordinate_count", &CompiledModel::coordinate_count)
      .def("_certificate", &CompiledModel::certificate)
      .def("_tier", &CompiledModel::tier)
      .def(
          "has",
          [](const CompiledModel& f, const py::object& function) {
            return f.has(converted("text", "function", function).cast<std::string>());
          },
          py::arg("function"), "Whether a function was compiled: \"rhs\", \"jac\", ..")
      .def("_values", [](const CompiledModel& f) { return scene_values(f.values()); })
      .def("_scene_values",
           [](const CompiledModel& f, const std::map<std::string, double>& replaced) {
             return scene_values(call_library({}, [&](auto&) { return f.scene_values(replaced); }));
           })
      .def("_input_values", [](const CompiledModel& f, double t) { return array_of(f.input_values(t)); })
      .def("_taylor", taylor)
      .def("_step", fixed_step)
      .def_static("_step_methods", FixedStep::methods);
  add_methods(type, std::make_index_sequence<functions.size()>{});
}

}  // namespace eomgen::python

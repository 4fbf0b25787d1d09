// SPDX-License-Identifier: GPL-3.0-or-later
// eomgen._core.CompiledModel: functions of one state or of many, without the GIL.
#include <limits>
#include <type_traits>

#include "arrays.hpp"
#include "calls.hpp"
#include "values.hpp"

namespace eomgen::python {
namespace {

using Arguments = CompiledModel::Arguments;

enum class Size {
  none,
  states,
  states_twice,
  coordinates,
  parameters,
  inputs,
  constraints,
  reactions,
  outputs,
  events,
  energies,        // T, U
  slopes,          // by q, then by qdot
  poses,           // 12 of each frame
  twist,           // linear and angular
  twists,          // of each frame
  frame_tangents,  // of each frame by each coordinate
};

std::size_t value_of(Size size, const CompiledModel& model) {
  switch (size) {
    case Size::states: return model.states().size();
    case Size::states_twice: return 2 * model.states().size();
    case Size::coordinates: return model.coordinate_count();
    case Size::parameters: return model.parameters().size();
    case Size::inputs: return model.inputs().size();
    case Size::constraints: return model.constraints().size();
    case Size::reactions: return model.reactions().size();
    case Size::outputs: return model.outputs().size();
    case Size::events: return model.event_count();
    case Size::energies: return 2;
    case Size::slopes: return 2 * model.coordinate_count();
    case Size::poses: return 12 * model.frames().size();
    case Size::twist: return 6;
    case Size::twists: return 6 * model.frames().size();
    case Size::frame_tangents: return model.coordinate_count() * model.frames().size();
    case Size::none: break;
  }
  return 1;
}

/// A vector, or a matrix that the library stores by columns.
struct ResultShape {
  Size rows = Size::none, columns = Size::none;
};

constexpr std::size_t most_results = 3;

struct Function {
  const char* name;      // of the method
  const char* compiled;  // of the function that has to be compiled
  const char* doc;
  std::size_t count;  // of results
  std::array<ResultShape, most_results> results;
  int (*evaluate)(const CompiledModel& model, const Arguments& at, double* const* results);
  Size vector = Size::none;  // length of the argument v, if the function takes it
};

int jac_t(const CompiledModel& model, const Arguments& at, double* const* results) {
  thread_local std::vector<double> dfdx;
  dfdx.resize(model.states().size() * model.states().size());
  return model.jac(at, dfdx.data(), results[0]);
}

#define EOMGEN_VECTOR_ARGUMENTS "(t, x, v, inputs=None, parameters=None, mode=None)\n--\n\n"
#define EOMGEN_ARGUMENTS "(t, x, inputs=None, parameters=None, mode=None)\n--\n\n"

constexpr std::array functions{
    Function{
        "rhs",
        "rhs",
        "rhs" EOMGEN_ARGUMENTS "dx/dt: (N,), or (K, N) of K states.\n\n"
        "t in s: a number or (K,). x: (N,) or (K, N). inputs: (U,), (K, U), or a function of (t, x) that returns\n"
        "them; None: those of the scene. parameters: (P,) or (K, P); None: those of the scene. mode: states of\n"
        "contacts and kinks (docs/abi.md), integers; None: all are 0. One singular state raises Error; among many\n"
        "states it gives NaN.",
        1,
        {{{Size::states}}},
        [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.rhs(at, r[0]); }},
    Function{"jac",
             "jac",
             "jac" EOMGEN_ARGUMENTS "d(dx/dt)/dx at fixed inputs: (N, N), or (K, N, N). Arguments as of rhs.",
             1,
             {{{Size::states, Size::states}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.jac(at, r[0], nullptr); }},
    Function{"jac_t",
             "jac",
             "jac_t" EOMGEN_ARGUMENTS "d(dx/dt)/dt at fixed x and inputs: (N,), or (K, N). Arguments as of rhs.",
             1,
             {{{Size::states}}},
             jac_t},
    Function{"jac_p",
             "jac_p",
             "jac_p" EOMGEN_ARGUMENTS "d(dx/dt)/d(parameters): (N, P), or (K, N, P). Arguments as of rhs.",
             1,
             {{{Size::states, Size::parameters}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.jac_p(at, r[0]); }},
    Function{"jac_u",
             "jac_u",
             "jac_u" EOMGEN_ARGUMENTS "d(dx/dt)/d(inputs): (N, U), or (K, N, U). Arguments as of rhs.",
             1,
             {{{Size::states, Size::inputs}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.jac_u(at, r[0]); }},
    Function{"jvp",
             "jvp",
             "jvp" EOMGEN_VECTOR_ARGUMENTS "jac(t, x) v without the matrix: (N,), or (K, N).\n\n"
             "v: (N,), or (K, N). Other arguments as of rhs.",
             1,
             {{{Size::states}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.jvp(at, r[0]); },
             Size::states},
    Function{"vjp",
             "vjp",
             "vjp" EOMGEN_VECTOR_ARGUMENTS "v^T jac(t, x) without the matrix: (N,), or (K, N).\n\n"
             "v: (N,), or (K, N). Other arguments as of rhs.",
             1,
             {{{Size::states}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.vjp(at, r[0]); },
             Size::states},
    Function{
        "adjoint",
        "adjoint",
        "adjoint" EOMGEN_VECTOR_ARGUMENTS
        "(v^T jac, v^T jac_p, v^T jac_u) at once: (N,), (P,), (U,), or with K in front.\n\n"
        "v: (N,), or (K, N). Other arguments as of rhs.",
        3,
        {{{Size::states}, {Size::parameters}, {Size::inputs}}},
        [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.adjoint(at, r[0], r[1], r[2]); },
        Size::states},
    Function{"hvp",
             "hvp",
             "hvp" EOMGEN_VECTOR_ARGUMENTS "d^2(c^T dx/dt)/dx^2 d: (N,), or (K, N).\n\n"
             "v: c, then d: (2 N,), or (K, 2 N). Other arguments as of rhs.",
             1,
             {{{Size::states}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.hvp(at, r[0]); },
             Size::states_twice},
    Function{"inverse",
             "inverse",
             "inverse" EOMGEN_VECTOR_ARGUMENTS
             "Inverse dynamics: M v + h, the forces that the accelerations v need besides those of the model and its\n"
             "inputs, without reactions: (n,), or (K, n).\n\nv: (n,), or (K, n). Other arguments as of rhs.",
             1,
             {{{Size::coordinates}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.inverse(at, r[0]); },
             Size::coordinates},
    Function{"coriolis",
             "coriolis",
             "coriolis" EOMGEN_ARGUMENTS
             "C of C qdot by Christoffel symbols of M, so that dM/dt - 2 C is skew: (n, n), or (K, n, n).\n"
             "Arguments as of rhs.",
             1,
             {{{Size::coordinates, Size::coordinates}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.coriolis(at, r[0]); }},
    Function{"gravity",
             "gravity",
             "gravity" EOMGEN_ARGUMENTS "dU/dq of the potential energy: (n,), or (K, n). Arguments as of rhs.",
             1,
             {{{Size::coordinates}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.gravity(at, r[0]); }},
    Function{
        "mass",
        "mass",
        "mass" EOMGEN_ARGUMENTS
        "(M, h) of M qddot + h = A^T lambda, h with the default inputs: (n, n) and (n,), or (K, n, n) and (K, n).\n"
        "Arguments as of rhs.",
        2,
        {{{Size::coordinates, Size::coordinates}, {Size::coordinates}}},
        [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.mass(at, r[0], r[1]); }},
    Function{
        "momenta",
        "momenta",
        "momenta" EOMGEN_ARGUMENTS
        "(p, rates): dL/d(qdot) and their rates without constraint forces: (n,) each, or (K, n). Arguments as of rhs.",
        2,
        {{{Size::coordinates}, {Size::coordinates}}},
        [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.momenta(at, r[0], r[1]); }},
    Function{"constraints",
             "constraints",
             "constraints" EOMGEN_ARGUMENTS
             "(psi, A, b) of psi = 0 and A qdot + b = 0: (m,), (m, n), (m,), or with K in front. Arguments as of rhs.",
             3,
             {{{Size::constraints}, {Size::constraints, Size::coordinates}, {Size::constraints}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) {
               return f.constraints(at, r[0], r[1], r[2]);
             }},
    Function{
        "reactions",
        "reactions",
        "reactions" EOMGEN_ARGUMENTS
        "The multipliers of all constraints, in the order of reaction_names: (R,), or (K, R). Arguments as of rhs.",
        1,
        {{{Size::reactions}}},
        [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.reactions(at, r[0]); }},
    Function{"outputs",
             "outputs",
             "outputs" EOMGEN_ARGUMENTS
             "The outputs, in the order of output_names and in the units of output_units: (Y,), or (K, Y).\n"
             "Arguments as of rhs.",
             1,
             {{{Size::outputs}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.outputs(at, r[0]); }},
    Function{"events",
             "events",
             "events" EOMGEN_ARGUMENTS
             "Event functions, then kinks, then five values of each contact (docs/abi.md): (G,), or (K, G).\n"
             "Arguments as of rhs.",
             1,
             {{{Size::events}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.events(at, r[0]); }},
    Function{"energy_gradients",
             "energy_gradients",
             "energy_gradients" EOMGEN_ARGUMENTS
             "(energies, dT, dU): T and U, (2,); dT/dq, then dT/d(qdot), (2 n,); dU/dq, (n,); or with K in front.\n"
             "Arguments as of rhs.",
             3,
             {{{Size::energies}, {Size::slopes}, {Size::coordinates}}},
             [](const CompiledModel& f, const Arguments& at, double* const* r) {
               return f.energy_gradients(at, r[0], r[1], r[2]);
             }},
    Function{
        "_frames",
        "frames",
        "_frames" EOMGEN_ARGUMENTS
        "Position and axes of each frame: (12 F,); columns of all Jacobians: (6, F n); biases: (6 F,).",
        3,
        {{{Size::poses}, {Size::twist, Size::frame_tangents}, {Size::twists}}},
        [](const CompiledModel& f, const Arguments& at, double* const* r) { return f.frames(at, r[0], r[1], r[2]); }},
};

#undef EOMGEN_VECTOR_ARGUMENTS
#undef EOMGEN_ARGUMENTS

const char* meaning_of(int code) {
  switch (code) {
    case 1: return "the mass matrix is singular";
    case 2: return "`mode` names charts that there are not";
    case 3: return "the friction law has no solution in this mode";
    case 4: return "the friction law has several solutions in this mode";
    case 5: return "a value is not finite";
    case 6: return "the order is too large";
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
  if (PyLong_Check(given)) {
    mode.push_back(py::cast<int>(given));
  } else {
    mode = py::cast<std::vector<int>>(given);
  }
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

py::array taylor(const CompiledModel& model, double t, const py::array& state, int order, const py::object& inputs,
                 const py::object& parameters, const py::object& mode) {
  const std::size_t N = model.states().size();
  const auto given = [](const py::object& object) { return object.is_none() ? nullptr : object.ptr(); };
  const Numbers x(state.ptr(), "x"), u(given(inputs), "inputs"), p(given(parameters), "parameters");
  if (x.dimensions() != 1 || static_cast<std::size_t>(x.length(0)) != N)
    refuse_shape("x", x, "(" + std::to_string(N) + ",)");
  step_of("inputs", u, model.inputs().size(), 1, false);
  step_of("parameters", p, model.parameters().size(), 1, false);
  if (order < 0) throw py::value_error("order is negative");
  const std::vector<int> modes = modes_of(given(mode), model);
  Arguments at{t, x.data(), p.data(), u.data()};
  set_mode(at, modes);
  py::array_t<double> result({static_cast<std::size_t>(order) + 1, N});
  const int code = model.taylor(at, order, result.mutable_data());
  if (code != 0) refuse({"taylor", "taylor", "", 1, {}, nullptr}, code);
  return result;
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
      .def("_event_count", &CompiledModel::event_count)
      .def("_coordinate_count", &CompiledModel::coordinate_count)
      .def("_certificate", &CompiledModel::certificate)
      .def("_tier", &CompiledModel::tier)
      .def("has", &CompiledModel::has, "Whether a function was compiled: \"rhs\", \"jac\", ..")
      .def("_values", [](const CompiledModel& f) { return scene_values(f.values()); })
      .def("_scene_values",
           [](const CompiledModel& f, const std::map<std::string, double>& replaced) {
             return scene_values(call_library({}, [&](auto&) { return f.scene_values(replaced); }));
           })
      .def("_input_values", [](const CompiledModel& f, double t) { return array_of(f.input_values(t)); })
      .def("_taylor", taylor);
  add_methods(type, std::make_index_sequence<functions.size()>{});
}

}  // namespace eomgen::python

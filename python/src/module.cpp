// SPDX-License-Identifier: GPL-3.0-or-later
// The extension module eomgen._core. Results are dictionaries and arrays; the package makes objects of them.
#include "bindings.hpp"
#include "calls.hpp"
#include "values.hpp"

namespace eomgen::python {
namespace {

const char* name_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::check: return "check";
    case ErrorKind::input: return "input";
    case ErrorKind::numerical: return "numerical";
    case ErrorKind::tool: return "tool";
  }
  return "input";
}

}  // namespace

void raise_error(const Error& error) {
  const py::object type = py::module_::import("eomgen.errors").attr("Error");
  const SourceLocation& where = error.where();
  const py::object value = type(error.what(), error.stage(), where.file, where.line, where.column, where.length,
                                where.text, error.message(), error.remedy(), name_of(error.fault()));
  PyErr_SetObject(type.ptr(), value.ptr());
}

Approach approach_named(const std::string& name) {
  if (name == "auto") return Approach::automatic;
  if (name == "I") return Approach::one;
  if (name == "II") return Approach::two;
  throw Error("python", {}, "there is no approach '" + name + "'", "choose 'auto', 'I' or 'II'");
}

}  // namespace eomgen::python

PYBIND11_MODULE(_core, module) {
  using namespace eomgen::python;
  module.doc() = "The library of eomgen. The package eomgen has the interface for users.";
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const eomgen::Error& error) {
      raise_error(error);
    } catch (const eomgen::Interrupted&) {
      PyErr_SetString(py::module_::import("eomgen.errors").attr("Interrupted").ptr(), "ended by its callback");
    }
  });
  module.attr("version") = EOMGEN_VERSION;
  module.def("solvers", &eomgen::solvers);
  module.def("targets", &eomgen::targets);
  add_model(module);
  add_robot(module);
  add_plot(module);
  add_compiled_model(module);
  add_simulation(module);
}

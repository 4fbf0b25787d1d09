// SPDX-License-Identifier: GPL-3.0-or-later
// The classes of the module, each of which adds itself.
#pragma once

#include <pybind11/pybind11.h>

#include <eomgen/eomgen.hpp>

namespace eomgen::python {

namespace py = pybind11;

/// Destroys a value of the library without the GIL: it may wait for a call whose callback needs the GIL.
template <class T>
struct DeleteWithoutGil {
  void operator()(T* value) const {
    const py::gil_scoped_release released;
    delete value;
  }
};

template <class T>
using Holder = std::unique_ptr<T, DeleteWithoutGil<T>>;

void add_model(py::module_& module);
void add_robot(py::module_& module);
void add_plot(py::module_& module);
void add_compiled_model(py::module_& module);
void add_simulation(py::module_& module);

/// Sets eomgen.Error as the exception of Python.
void raise_error(const Error& error);

Approach approach_named(const std::string& name);

/// Takes an entry of a dictionary of options, if it is there and not None.
template <class T>
void take(const py::dict& given, const char* name, T& to) {
  if (given.contains(name) && !given[name].is_none()) to = given[name].cast<T>();
}

}  // namespace eomgen::python

// SPDX-License-Identifier: GPL-3.0-or-later
// Methods that are called a million times: arguments and results without pybind11's dispatch of calls, through
// CPython's fast calling convention and NumPy's C interface.
#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <exception>
#include <span>

#include "bindings.hpp"

namespace eomgen::python {

using Fast = PyObject* (*)(PyObject* self, PyObject* const* arguments, Py_ssize_t count, PyObject* names);

/// Adds a method to a class of pybind11. `name` and `doc` have to outlive the module.
void add_method(py::handle type, const char* name, const char* doc, Fast function);

/// The C++ object of an instance. Throws Error if its constructor was not called.
template <class T>
T& object_of(PyObject* self) {
  auto* const instance = reinterpret_cast<py::detail::instance*>(self);
  void* const held =
      instance->simple_layout ? instance->simple_value_holder[0] : instance->nonsimple.values_and_holders[0];
  if (held == nullptr) throw py::type_error("the object was not initialised: call __init__ of its base class");
  return *static_cast<T*>(held);
}

/// Calls `body`, with C++ exceptions turned into those of Python.
template <class Body>
PyObject* guarded(Body&& body) noexcept {
  try {
    return body();
  } catch (py::error_already_set& error) {
    error.restore();
  } catch (const py::builtin_exception& error) {
    error.set_error();
  } catch (const Error& error) {
    raise_error(error);
  } catch (const std::exception& error) {
    PyErr_SetString(PyExc_RuntimeError, error.what());
  }
  return nullptr;
}

/// Positional arguments and keywords by name; null where one is missing.
template <std::size_t count>
std::array<PyObject*, count> take_arguments(const char* function, const std::array<const char*, count>& names,
                                            std::size_t required, PyObject* const* arguments, Py_ssize_t positional,
                                            PyObject* keywords) {
  std::array<PyObject*, count> found{};
  if (static_cast<std::size_t>(positional) > count)
    throw py::type_error(std::string(function) + "() takes at most " + std::to_string(count) + " arguments");
  for (std::size_t i = 0; i < static_cast<std::size_t>(positional); ++i) found[i] = arguments[i];
  const Py_ssize_t given = keywords == nullptr ? 0 : PyTuple_GET_SIZE(keywords);
  for (Py_ssize_t k = 0; k < given; ++k) {
    PyObject* const keyword = PyTuple_GET_ITEM(keywords, k);
    std::size_t i = 0;
    while (i < count && PyUnicode_CompareWithASCIIString(keyword, names[i]) != 0) ++i;
    if (i == count || found[i] != nullptr)
      throw py::type_error(std::string(function) + "() got an unexpected argument '" +
                           py::str(keyword).cast<std::string>() + "'");
    found[i] = arguments[positional + k];
  }
  for (std::size_t i = 0; i < required; ++i) {
    if (found[i] == nullptr) throw py::type_error(std::string(function) + "() needs the argument '" + names[i] + "'");
  }
  for (PyObject*& argument : found) {
    if (argument == Py_None) argument = nullptr;
  }
  return found;
}

/// The value of an argument from a function of eomgen.arguments, which throws an error of Python that names it.
py::object converted(const char* converter, const char* name, py::handle value);

/// The float64 numbers of an array or of a sequence. They are those of the array itself if it is contiguous.
class Numbers {
 public:
  /// Null: no numbers.
  Numbers(PyObject* from, const char* name);
  Numbers(const Numbers&) = delete;
  Numbers& operator=(const Numbers&) = delete;

  explicit operator bool() const { return data_ != nullptr; }
  const double* data() const { return data_; }
  std::span<const double> span() const { return {data_, static_cast<std::size_t>(size_)}; }
  int dimensions() const { return dimensions_; }
  Py_ssize_t length(int dimension) const { return shape_[dimension]; }
  /// "(3, 4)".
  std::string shape() const;

 private:
  void take(PyObject* array);

  const char* name_;
  py::object copy_;
  const double* data_ = nullptr;
  int dimensions_ = 0;
  Py_ssize_t size_ = 0;
  std::array<Py_ssize_t, 2> shape_{};
  double scalar_ = 0;
};

/// A new float64 array. `strides` in bytes, or empty for row-major order.
py::object new_array(std::span<const Py_ssize_t> shape, std::span<const Py_ssize_t> strides = {});

inline double* data_of(const py::object& array) {
  return reinterpret_cast<double*>(py::detail::array_proxy(array.ptr())->data);
}

}  // namespace eomgen::python

// SPDX-License-Identifier: GPL-3.0-or-later
// Values of the library as values of Python: arrays, dictionaries, lists.
#pragma once

#include <pybind11/complex.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <complex>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace eomgen::python {

namespace py = pybind11;

/// One dimension; the array owns a copy.
template <class T>
py::array array_of(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// rows x columns, row-major.
inline py::array matrix_of(const std::vector<double>& values, std::size_t rows, std::size_t columns) {
  return py::array_t<double>({rows, columns}, values.data());
}

inline py::array matrix_of(const std::vector<std::vector<double>>& rows, std::size_t columns) {
  py::array_t<double> result({rows.size(), columns});
  double* to = result.mutable_data();
  for (const std::vector<double>& row : rows) to = std::copy(row.begin(), row.end(), to);
  return result;
}

/// A dictionary in the order of the pairs.
inline py::dict dict_of(const std::vector<std::pair<std::string, double>>& pairs) {
  py::dict result;
  for (const auto& [name, value] : pairs) result[py::str(name)] = value;
  return result;
}

/// A list of `make(entry)`.
template <class T, class Make>
py::list list_of(const std::vector<T>& entries, Make&& make) {
  py::list result;
  for (const T& entry : entries) result.append(make(entry));
  return result;
}

/// Records `Event` of Python (records.py).
inline py::list event_list(const std::vector<MotionEvent>& events) {
  const py::module_ records = py::module_::import("eomgen.records");
  const py::object event = records.attr("Event"), impulse = records.attr("ContactImpulse");
  return list_of(events, [&](const MotionEvent& e) {
    return event(e.t, e.kind, e.name, e.work, list_of(e.impulses, [&](const ContactImpulse& one) {
                   return impulse(one.contact, one.normal, one.friction, one.work);
                 }));
  });
}

}  // namespace eomgen::python

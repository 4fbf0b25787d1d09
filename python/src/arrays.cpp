// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrays.hpp"

#include <deque>

namespace eomgen::python {

using py::detail::npy_api;

py::object converted(const char* converter, const char* name, py::handle value) {
  return py::module_::import("eomgen.arguments").attr(converter)(name, value);
}

void add_method(py::handle type, const char* name, const char* doc, Fast function) {
  static std::deque<PyMethodDef> definitions;  // descriptors refer to them
  definitions.push_back(
      {name, reinterpret_cast<PyCFunction>(reinterpret_cast<void*>(function)), METH_FASTCALL | METH_KEYWORDS, doc});
  const auto method = py::reinterpret_steal<py::object>(
      PyDescr_NewMethod(reinterpret_cast<PyTypeObject*>(type.ptr()), &definitions.back()));
  py::setattr(type, name, method);
}

Numbers::Numbers(PyObject* from, const char* name) : name_(name) {
  if (from == nullptr) return;
  if (PyFloat_Check(from) || PyLong_CheckExact(from)) {
    scalar_ = PyFloat_AsDouble(from);
    if (scalar_ == -1 && PyErr_Occurred() != nullptr) throw py::error_already_set();
    data_ = &scalar_;
    size_ = 1;
    return;
  }
  const npy_api& api = npy_api::get();
  if (api.PyArray_Check_(from)) {
    const auto* const array = py::detail::array_proxy(from);
    const auto* const type = py::detail::array_descriptor_proxy(array->descr);
    constexpr int plain = npy_api::NPY_ARRAY_C_CONTIGUOUS_ | npy_api::NPY_ARRAY_ALIGNED_;
    if (type->type_num == npy_api::NPY_DOUBLE_ && (array->flags & plain) == plain && type->byteorder != '>') {
      take(from);
      return;
    }
  }
  copy_ = converted("array", name, from);
  copy_ = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(copy_);
  take(copy_.ptr());
}

void Numbers::take(PyObject* array) {
  const auto* const from = py::detail::array_proxy(array);
  dimensions_ = from->nd;
  if (dimensions_ > 2)
    throw Error("python", {}, std::string(name_) + " has " + std::to_string(dimensions_) + " dimensions",
                "give one row of numbers, or a row for each state");
  size_ = 1;
  for (int i = 0; i < dimensions_; ++i) size_ *= shape_[static_cast<std::size_t>(i)] = from->dimensions[i];
  data_ = reinterpret_cast<const double*>(from->data);
}

std::string Numbers::shape() const {
  if (dimensions_ == 0) return "()";
  std::string text = "(" + std::to_string(shape_[0]);
  return text + (dimensions_ == 1 ? ",)" : ", " + std::to_string(shape_[1]) + ")");
}

py::object new_array(std::span<const Py_ssize_t> shape, std::span<const Py_ssize_t> strides) {
  const npy_api& api = npy_api::get();
  PyObject* const array = api.PyArray_NewFromDescr_(api.PyArray_Type_, api.PyArray_DescrFromType_(npy_api::NPY_DOUBLE_),
                                                    static_cast<int>(shape.size()), shape.data(),
                                                    strides.empty() ? nullptr : strides.data(), nullptr, 0, nullptr);
  if (array == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(array);
}

}  // namespace eomgen::python

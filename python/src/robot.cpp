// SPDX-License-Identifier: GPL-3.0-or-later
#include "bindings.hpp"
#include "calls.hpp"
#include "values.hpp"

namespace eomgen::python {
namespace {

py::dict robot(const std::string& path, bool floating, const std::string& attitude, const std::string& friction,
               const std::string& actuators, const std::vector<std::string>& stops, bool parameters,
               bool exact_angles) {
  const RobotModel found = [&] {
    const py::gil_scoped_release released;
    return import_robot(path, {floating, attitude, friction, actuators, stops, parameters, exact_angles});
  }();
  py::dict result;
  result["robot"] = found.robot;
  result["text"] = found.text;
  result["left_out"] =
      list_of(found.left_out, [](const RobotOmission& o) { return py::make_tuple(o.what, o.why, o.count, o.line); });
  return result;
}

}  // namespace

void add_robot(py::module_& module) {
  module.def("import_robot", &robot, py::arg("path"), py::arg("floating"), py::arg("attitude"), py::arg("friction"),
             py::arg("actuators"), py::arg("stops"), py::arg("parameters"), py::arg("exact_angles"));
}

}  // namespace eomgen::python

// SPDX-License-Identifier: GPL-3.0-or-later
#include <eom/output/svg_plot.hpp>

#include "bindings.hpp"

namespace eomgen::python {
namespace {

std::string line_plot(const std::vector<std::string>& names, const std::vector<double>& times,
                      const std::vector<std::vector<double>>& columns, const std::string& y_label) {
  eom::Plot plot;
  plot.x_label = "t [s]";
  plot.y_label = y_label;
  for (std::size_t i = 0; i < names.size(); ++i) plot.series.push_back({names[i], times, columns.at(i)});
  return eom::svg(plot);
}

}  // namespace

void add_plot(py::module_& module) {
  module.def("line_plot", &line_plot, py::arg("names"), py::arg("times"), py::arg("columns"), py::arg("y_label"));
}

}  // namespace eomgen::python

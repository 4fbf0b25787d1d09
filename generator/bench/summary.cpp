// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <eom/output/svg_plot.hpp>
#include <fstream>
#include <thread>

#include "bench/bench.hpp"

namespace eomgen::bench {

std::string advice(const std::vector<Row>& rows) {
  std::string text, last;
  for (const int digits : {3, 6, 9, 12}) {
    const double wanted = std::pow(10.0, -digits);
    const Row* best = nullptr;
    for (const Row& row : rows) {
      if (row.outcome == "done" && row.error_along <= wanted && (best == nullptr || row.seconds < best->seconds)) best = &row;
    }
    const std::string what = fmt::format("1e-{}", digits);
    if (best == nullptr) {
      text += fmt::format("{} no solver reaches {}", text.empty() ? "" : ";", what);
      break;
    }
    const std::string how = best->step > 0 ? fmt::format("step {:.2g}", best->step) : fmt::format("rtol {:.0e}", best->rtol);
    text += fmt::format("{} {} for {} ({}, {:.3g} ms)", text.empty() ? "" : ",", best->solver, what, how, 1e3 * best->seconds);
  }
  return "For true errors along the whole run take" + text + ".";
}

std::string diagram(const std::vector<Row>& rows, const std::string& title) {
  eom::Plot plot;
  plot.title = title;
  plot.x_label = "median run time in s";
  plot.y_label = "true error at the end, relative";
  plot.log_x = plot.log_y = true;
  for (const Row& row : rows) {
    if (plot.series.empty() || plot.series.back().name != row.solver) {
      plot.series.emplace_back();
      plot.series.back().name = row.solver;
      plot.series.back().markers = true;
    }
    if (row.outcome != "done") continue;
    plot.series.back().x.push_back(row.seconds);
    plot.series.back().y.push_back(row.error);
  }
  return eom::svg(plot);
}

Machine machine() {
  Machine result;
  result.cores = std::thread::hardware_concurrency();
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (!line.starts_with("model name") || colon == std::string::npos) continue;
    result.processor = line.substr(colon + 2);
    break;
  }
  if (result.processor.empty()) result.processor = "unknown";
  return result;
}

}  // namespace eomgen::bench

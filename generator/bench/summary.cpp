// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <eom/ode.hpp>
#include <fstream>
#include <thread>

#include "bench/bench.hpp"

namespace eomgen::bench {

namespace {

/// A remark if stability makes explicit solvers take many more steps than accuracy requires; otherwise "".
std::string stiffness(const std::vector<Row>& rows) {
  constexpr std::size_t many = 20;            // ratio of steps; accuracy costs all solvers alike
  const Row* fewest[2] = {nullptr, nullptr};  // explicit, implicit; of rows with an error of at most a percent
  for (const Row& row : rows) {
    for (const eom::MethodInfo& method : eom::methods()) {
      if (row.solver != method.name || !method.adaptive || row.outcome != "done" || !(row.error_along <= 0.01))
        continue;
      const Row*& least = fewest[run::uses_jacobian(method) ? 1 : 0];
      if (least == nullptr || row.steps < least->steps) least = &row;
    }
  }
  if (fewest[0] == nullptr || fewest[1] == nullptr || fewest[0]->steps < many * fewest[1]->steps) return "";
  return fmt::format(
      " The motion is stiff and explicit solvers are inefficient: stability requires at least {} steps of them ({}), "
      "while {} takes {}.",
      fewest[0]->steps, fewest[0]->solver, fewest[1]->solver, fewest[1]->steps);
}

}  // namespace

std::string recommend_solvers(const std::vector<Row>& rows) {
  constexpr double worth_naming =
      1.1;  // `auto` mostly equals one of the other solvers, and its times are theirs within the noise of clocks
  const auto seconds = [](const Row& row) {
    return row.seconds * (row.solver == eom::Automatic::name ? worth_naming : 1);
  };
  std::string text;
  for (const int digits : {3, 6, 9, 12}) {
    const double wanted = std::pow(10.0, -digits);
    const Row* best = nullptr;
    for (const Row& row : rows) {
      if (row.outcome == "done" && row.error_along <= wanted && (best == nullptr || seconds(row) < seconds(*best)))
        best = &row;
    }
    const std::string what = fmt::format("1e-{}", digits);
    if (best == nullptr) {
      text += fmt::format("{} no solver reaches {}", text.empty() ? "" : ";", what);
      break;
    }
    const std::string how =
        best->step > 0 ? fmt::format("step {:.2g}", best->step) : fmt::format("rtol {:.0e}", best->rtol);
    text += fmt::format("{} {} for {} ({}, {:.3g} ms)", text.empty() ? "" : ",", best->solver, what, how,
                        1e3 * best->seconds);
  }
  return "For true errors along the whole run take" + text + "." + stiffness(rows);
}

eom::Plot work_precision_diagram(const std::vector<Row>& rows, const std::string& title) {
  eom::Plot plot;
  plot.title = title;
  plot.x_label = "median run time in s";
  plot.y_label = "true error at the end, relative";
  plot.log_x = plot.log_y = true;
  plot.height = 560;
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
  return plot;
}

Machine describe_machine() {
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

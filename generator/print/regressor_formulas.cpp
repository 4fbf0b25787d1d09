// SPDX-License-Identifier: GPL-3.0-or-later
// The regressor as formulas: the inertial parameters p, the entries of Y that are not zero, the base parameters.
#include <fmt/format.h>

#include <map>

#include "print/formulas.hpp"
#include "reading/regressor.hpp"

namespace eomgen::print {
namespace {

using reading::InertialParameter;

std::string description(const InertialParameter& p) {
  switch (p.kind) {
    case InertialParameter::Kind::mass: return "mass";
    case InertialParameter::Kind::moment: return fmt::format("first moment along e{}", p.i + 1);
    case InertialParameter::Kind::inertia: break;
  }
  return fmt::format("inertia {}{}", p.i + 1, p.k + 1);
}

Formula parameter(std::size_t j) { return mark("p", {index(static_cast<std::uint32_t>(j) + 1)}); }

Formula base_parameter(const reading::BaseParameter& base) {
  std::vector<Formula> terms{parameter(base.parameter)};
  for (const auto& [j, factor] : base.further) {
    if (factor == reading::Sum(1))
      terms.push_back(parameter(j));
    else if (factor == reading::Sum(-1))
      terms.push_back(reading::negative(parameter(j)));
    else
      terms.push_back(reading::product({reading::arrange(factor), parameter(j)}));
  }
  return reading::sum(std::move(terms));
}

/// The columns of Y that are not written, per particle or body.
void add_unwritten(const mechanics::Mechanics& m, const reading::Regressor& found, std::vector<Statement>& out) {
  std::map<std::uint32_t, std::vector<std::size_t>> columns;  // by place, numbered from 1
  for (std::size_t j = 0; j < found.columns.size(); ++j)
    if (found.columns[j].empty()) columns[found.parameters[j].place].push_back(j + 1);
  for (const auto& [place, numbers] : columns)
    out.push_back(left_out(
        "regressor", m.model->places[place].name, "",
        fmt::format("columns of Y that are too long to be written out: {}; emit --with regressor computes them",
                    fmt::join(numbers, ", "))));
}

}  // namespace

void add_regressor(const mechanics::Mechanics& m, std::vector<Statement>& out) {
  const reading::Regressor found = reading::regressor(m);
  const auto name = [&](std::size_t j) { return m.model->places[found.parameters[j].place].name; };
  for (std::size_t j = 0; j < found.parameters.size(); ++j)
    out.push_back({"regressor", name(j), "", description(found.parameters[j]),
                   reading::relation({parameter(j), reading::arrange(found.parameters[j].value)})});
  for (std::size_t i = 0; i < m.free.size(); ++i) {
    for (std::size_t j = 0; j < found.columns.size(); ++j) {
      if (found.columns[j].empty() || found.columns[j][i].is_zero()) continue;
      const auto row = static_cast<std::uint32_t>(i) + 1, column = static_cast<std::uint32_t>(j) + 1;
      out.push_back(
          {"regressor", name(j), m.model->coordinates[m.free[i]].name, "entry of Y",
           reading::relation({mark("Y", {index(row), index(column)}), reading::arrange(found.columns[j][i])})});
    }
  }
  add_unwritten(m, found, out);
  if (!found.base_left_out.empty()) out.push_back(left_out("regressor", "", "base parameters", found.base_left_out));
  for (std::size_t k = 0; k < found.base.size(); ++k)
    out.push_back(
        {"regressor", name(found.base[k].parameter), "", "base parameter",
         reading::relation({mark("beta", {index(static_cast<std::uint32_t>(k) + 1)}), base_parameter(found.base[k])})});
  for (const std::size_t j : found.without_effect)
    out.push_back({"regressor", name(j), "", "without effect on the motion", parameter(j)});
}

}  // namespace eomgen::print

// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/fmu/variables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/hybrid/problem.hpp>
#include <nlohmann/json.hpp>
#include <set>

#include "emit/metadata.hpp"
#include "emit/start/start.hpp"

namespace eomgen::emit {
namespace {

/// A power of ten of the size of the start; 1 for a state that starts at 0.
double nominal_value(double start) {
  if (start == 0 || !std::isfinite(start)) return 1;
  return std::pow(10.0, std::clamp(std::round(std::log10(std::abs(start))), -9.0, 9.0));
}

class VariableTable {
 public:
  VariableTable(FmuVariables& into, const FmuDescription& description) : into_(into), description_(description) {}
  /// The name gets a number if it is taken. Returns the value reference.
  std::size_t add(FmuVariable variable) {
    const std::string wanted = variable.name;
    for (int number = 2; !taken_.insert(variable.name).second; ++number)
      variable.name = fmt::format("{} ({})", wanted, number);
    if (variable.derivative_of) {
      const auto unit = description_.units.find(variable.unit);
      variable.unit = unit != description_.units.end() ? unit->second.rate : "";
    }
    into_.all.push_back(std::move(variable));
    return into_.all.size() - 1;
  }

 private:
  FmuVariables& into_;
  const FmuDescription& description_;
  std::set<std::string> taken_;
};

FmuVariable named(const Quantity& quantity, const char* causality, const char* variability, const char* initial) {
  FmuVariable v;
  v.name = quantity.name;
  v.unit = quantity.unit;
  v.description = quantity.note;
  v.causality = causality;
  v.variability = variability;
  v.initial = initial;
  return v;
}

void mark_parameters(const EmissionContext& context, FmuVariables& result) {
  result.calculated.assign(context.parameters.size(), false);
  result.from_start = result.calculated;
  const StartDescription& start = *context.start_functions;
  const auto mark = [](std::vector<bool>& list, const std::vector<int>& entries, std::size_t step) {
    for (std::size_t k = 0; k + step <= entries.size(); k += step) list.at(static_cast<std::size_t>(entries[k])) = true;
  };
  mark(result.from_start, start.initial, 3);
  mark(result.from_start, start.early, 2);
  mark(result.from_start, start.late, 2);
  for (std::size_t j = 0; j < context.parameters.size(); ++j)
    if (context.parameters[j].name == context.start_parameter) result.from_start[j] = true;
  result.calculated = result.from_start;
  mark(result.calculated, start.dependent, 2);
}

/// The entries of the state x, as NAME_info lists them.
std::vector<Quantity> state_quantities(const program::Program& program, const EmissionContext& context) {
  const auto info = nlohmann::json::parse(info_json(program, context));
  std::vector<Quantity> result;
  for (const std::string name : info.at("states")) result.push_back({name, info.at("units").at(name), "", 0});
  return result;
}

/// Outputs of the table of a run that are no states.
std::vector<std::size_t> further_outputs(const program::Program& program, const std::vector<Quantity>& states,
                                         const RunDescription& run) {
  std::vector<std::size_t> result;
  for (const std::size_t column : run.columns) {
    const std::string& name = program.outputs.at(column);
    const auto is_this = [&](const Quantity& state) { return state.name == name; };
    if (std::none_of(states.begin(), states.end(), is_this)) result.push_back(column);
  }
  return result;
}

std::vector<std::string> indicator_names(const program::Program& program, const EmissionContext& context,
                                         std::size_t jumps) {
  std::vector<std::string> names;
  for (const EventDescription& event : context.events) names.push_back("event " + event.name);
  if (program.events.empty()) names.clear();
  for (std::size_t k = 0; k < program.kinks.size(); ++k)
    names.push_back(fmt::format("kink {} of {}", k + 1, program.kinks[k]));
  for (const program::ContactInfo& contact : program.contacts) {
    for (const char* what :
         {"slip", "static limit", "static limit against the tangent", "normal force or gap", "margin"})
      names.push_back(fmt::format("contact {}: {}", contact.name, what));
  }
  for (std::size_t k = 0; k < jumps; ++k) names.push_back(fmt::format("jump {}", k + 1));
  return names;
}

}  // namespace

FmuVariables fmu_variables(const program::Program& program, const EmissionContext& context,
                           const FmuDescription& description) {
  FmuVariables result;
  mark_parameters(context, result);
  VariableTable table(result, description);
  table.add(named({"time", "s", "", 0}, "independent", "continuous", ""));
  const std::vector<Quantity> states = state_quantities(program, context);
  const std::size_t continuous = program.layout().discrete_begin();
  for (std::size_t i = 0; i < states.size(); ++i) {
    FmuVariable v = named(states[i], "output", i < continuous ? "continuous" : "discrete", "exact");
    v.start = context.start[i];
    v.is_state = i < continuous;
    if (v.is_state) {
      v.nominal = nominal_value(context.start[i]);
      result.nominals.push_back(*v.nominal);
    }
    table.add(std::move(v));
  }
  for (std::size_t i = 0; i < continuous; ++i) {
    FmuVariable v = named(states[i], "local", "continuous", "calculated");
    v.name = "der(" + v.name + ")";
    v.derivative_of = 1 + i;
    table.add(std::move(v));
  }
  for (const Quantity& input : context.inputs) {
    FmuVariable v = named(input, "input", "continuous", "");
    v.start = input.value;
    table.add(std::move(v));
  }
  for (std::size_t j = 0; j < context.parameters.size(); ++j) {
    const bool computed = result.calculated[j];
    FmuVariable v = named(context.parameters[j], computed ? "calculatedParameter" : "parameter",
                          result.from_start[j] ? "fixed" : "tunable", computed ? "calculated" : "exact");
    if (!computed) v.start = context.parameters[j].value;
    table.add(std::move(v));
  }
  result.outputs = further_outputs(program, states, *context.run);
  for (const std::size_t column : result.outputs) {
    const std::string unit = column < description.output_units.size() ? description.output_units[column] : "";
    table.add(named({program.outputs.at(column), unit, "", 0}, "output", "continuous", "calculated"));
  }
  for (const std::string& name : indicator_names(program, context, description.jump_surfaces)) {
    FmuVariable v = named({name, "", "", 0}, "local", "continuous", "calculated");
    v.is_indicator = true;
    table.add(std::move(v));
    ++result.event_indicators;
  }
  return result;
}

}  // namespace eomgen::emit

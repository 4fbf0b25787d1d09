// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/fmu/fmu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/hybrid/problem.hpp>
#include <kainjow/mustache.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "emit/fmu/runtime_sources.hpp"
#include "emit/fmu/xml.hpp"
#include "emit/metadata.hpp"
#include "emit/start/start.hpp"
#include "emit/template_data.hpp"
#include "emit/text.hpp"
#include "skeletons/fmu_buildDescription_xml.hpp"
#include "skeletons/fmu_fmi_cpp.hpp"
#include "skeletons/fmu_icon.hpp"
#include "skeletons/fmu_index_html.hpp"
#include "skeletons/fmu_modelDescription_xml.hpp"
#include "skeletons/fmu_model_fmu_cpp.hpp"

namespace eomgen::emit {

using kainjow::mustache::data;

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

namespace {

// modelDescription.xml of FMI 2.0 and 3.0, and buildDescription.xml of FMI 3.0.

void add_list(data& all, const std::string& name, const data& list) {
  all.set(name, list);
  if (list.is_non_empty_list()) all.set("has_" + name, true);
}

std::string number(const std::optional<double>& value) { return value ? decimal(*value) : ""; }

/// Units of the variables, each with its powers of base units where they are whole numbers.
data unit_definitions(const FmuDescription& description, const FmuVariables& variables) {
  static constexpr std::array<const char*, 7> base{"m", "kg", "s", "A", "K", "mol", "cd"};
  std::set<std::string> units;
  for (const FmuVariable& v : variables.all)
    if (!v.unit.empty()) units.insert(v.unit);
  data result{data::type::list};
  for (const std::string& unit : units) {
    const auto known = description.units.find(unit);
    data powers{data::type::list};
    for (std::size_t k = 0; known != description.units.end() && k < base.size(); ++k)
      if (const int power = known->second.powers[k]; power != 0)
        powers << template_object({{"base", base[k]}, {"power", fmt::format("{}", power)}});
    data entry = template_object({{"text", unit}, {"is_known", known != description.units.end() ? "true" : ""}});
    entry.set("powers", powers);
    result << entry;
  }
  return result;
}

/// FMI 2.0 counts variables from 1 in an attribute `derivative`, FMI 3.0 has value references.
data variable_list(const FmuVariables& variables, std::size_t first) {
  data result{data::type::list};
  for (std::size_t i = 0; i < variables.all.size(); ++i) {
    const FmuVariable& v = variables.all[i];
    result << template_object({{"name", v.name},
                               {"reference", fmt::format("{}", i)},
                               {"description", v.description},
                               {"causality", v.causality},
                               {"variability", v.variability},
                               {"initial", v.initial},
                               {"unit", v.unit},
                               {"nominal", number(v.nominal)},
                               {"derivative", v.derivative_of ? fmt::format("{}", *v.derivative_of + first) : ""},
                               {"is_state", v.is_state ? "true" : ""},
                               {"start", number(v.start)}});
  }
  return result;
}

bool is_output(const FmuVariable& v) { return v.causality == "output"; }
bool is_derivative(const FmuVariable& v) { return v.derivative_of.has_value(); }
/// Computed during the initialization.
bool is_initial_unknown(const FmuVariable& v) {
  return v.is_calculated() && (is_output(v) || is_derivative(v) || v.causality == "calculatedParameter");
}
bool is_indicator(const FmuVariable& v) { return v.is_indicator; }

/// One list of ModelStructure.
data unknowns(const FmuVariables& variables, bool (*belongs)(const FmuVariable&)) {
  data result{data::type::list};
  for (std::size_t i = 0; i < variables.all.size(); ++i)
    if (belongs(variables.all[i]))
      result << template_object({{"reference", fmt::format("{}", i)}, {"index", fmt::format("{}", i + 1)}});
  return result;
}

/// `token`: with which an importer instantiates this FMU and no other.
std::string model_description(const EmissionContext& context, const FmuDescription& description,
                              const FmuVariables& variables, const std::string& token) {
  const eom::hybrid::Problem& p = *context.run->problem;
  const double rows = context.run->rows;
  const double step = p.output_interval > 0 ? p.output_interval : rows > 0 ? (p.t1 - p.t0) / rows : 0;
  const bool is_fmi3 = description.version == 3;
  data all = template_object({{"fmi3", is_fmi3 ? "true" : ""},
                              {"id", context.id},
                              {"identifier", mangled_id(context.id)},
                              {"token", token},
                              {"title", context.title},
                              {"indicator_count", fmt::format("{}", variables.event_indicators)},
                              {"start_time", decimal(p.t0)},
                              {"stop_time", decimal(p.t1)},
                              {"tolerance", decimal(p.rtol)},
                              {"step_size", step > 0 ? decimal(step) : ""}});
  add_list(all, "units", unit_definitions(description, variables));
  add_list(all, "variables", variable_list(variables, is_fmi3 ? 0 : 1));
  add_list(all, "outputs", unknowns(variables, is_output));
  add_list(all, "derivatives", unknowns(variables, is_derivative));
  add_list(all, "initial_unknowns", unknowns(variables, is_initial_unknown));
  add_list(all, "event_indicators", unknowns(variables, is_indicator));
  kainjow::mustache::mustache text{std::string(skeleton::fmu_modelDescription_xml)};
  if (!text.is_valid()) throw std::logic_error(text.error_message());
  text.set_custom_escape([](const std::string& value) { return xml_text(value); });
  // A section that is left out leaves an empty line.
  std::string result = text.render(all);
  const auto both = [](char a, char b) { return a == '\n' && b == '\n'; };
  result.erase(std::unique(result.begin(), result.end(), both), result.end());
  return result;
}

std::string build_description(const std::string& name) {
  return render_template(skeleton::fmu_buildDescription_xml, {{"name", name}}, {});
}

/// FNV-1a of 64 bits.
std::uint64_t checksum(const std::string& text, std::uint64_t sum = 0xcbf29ce484222325U) {
  for (const char byte : text) sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3U;
  return sum;
}

template <class List, class Text>
std::string assignment(const char* member, const List& list, Text&& text) {
  const std::string entries = joined(list, text);
  return entries.empty() ? "" : wrapped(fmt::format("  model.{} = {{{}}};", member, entries), "      ") + "\n";
}

std::string numbers(const EmissionContext& context, const FmuVariables& variables) {
  const auto whole = [](std::size_t value) { return fmt::format("{}", value); };
  const auto truth = [](bool value) { return std::string(value ? "true" : "false"); };
  return assignment("nominals", variables.nominals, decimal) +
         assignment("inputs", values_of(context.inputs), decimal) +
         assignment("calculated", variables.calculated, truth) + assignment("from_start", variables.from_start, truth) +
         assignment("outputs", variables.outputs, whole) +
         fmt::format("  model.event_indicators = {};", variables.event_indicators);
}

std::string page(const EmissionContext& context, const FmuVariables& variables) {
  std::string rows;
  for (const FmuVariable& v : variables.all) {
    if (v.is_indicator || v.derivative_of) continue;
    rows += fmt::format("{}<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>", rows.empty() ? "" : "\n",
                        xml_text(v.name), v.causality, xml_text(v.unit), v.start ? decimal(*v.start) : "",
                        xml_text(v.description));
  }
  const eom::hybrid::Problem& p = *context.run->problem;
  return render_template(skeleton::fmu_index_html,
                         {{"title", xml_text(context.title.empty() ? context.id : context.title)},
                          {"model", xml_text(context.id)},
                          {"verdict", xml_text(context.verdict)},
                          {"rows", rows},
                          {"solver", xml_text(p.solver)},
                          {"rtol", decimal(p.rtol)}},
                         {});
}

}  // namespace

std::vector<EmittedFile> emit_fmu(const program::Program& program, const EmissionContext& context,
                                  const FmuDescription& description) {
  const std::string name = mangled_id(context.id);
  std::vector<EmittedFile> sources = emit_c(program, context);
  const FmuVariables variables = fmu_variables(program, context, description);
  const std::string token =
      fmt::format("{}-{:016x}", context.content_hash.substr(0, 32),
                  checksum(sources.front().text, checksum(fmt::format("{}", description.version))));
  sources.push_back({name + "_fmu.cpp", render_template(skeleton::fmu_model_fmu_cpp,
                                                        {{"banner", banner(program, context, "// ", "// ", "")},
                                                         {"name", name},
                                                         {"token", token},
                                                         {"numbers", numbers(context, variables)}},
                                                        {})});
  const std::string version = fmt::format("{}", description.version);
  sources.push_back({"fmi" + version + ".cpp", render_template(skeleton::fmu_fmi_cpp, {{"version", version}}, {})});
  std::string licence;
  for (const RuntimeSource& header : runtime_sources()) {
    if (std::string(header.name) == "LICENSE")
      licence = header.text;
    else
      sources.push_back({header.name, header.text});
  }

  std::vector<EmittedFile> files{{"modelDescription.xml", model_description(context, description, variables, token)}};
  const bool is_3 = description.version == 3;
  files.push_back({is_3 ? "terminalsAndIcons/icon.png" : "model.png", std::string(skeleton::fmu_icon)});
  files.push_back({"documentation/index.html", page(context, variables)});
  files.push_back({is_3 ? "documentation/licenses/LICENSE.txt" : "documentation/LICENSE.txt", licence});
  if (is_3) files.push_back({std::string(fmu_sources) + "buildDescription.xml", build_description(name)});
  for (EmittedFile& source : sources) files.push_back({fmu_sources + source.name, std::move(source.text)});
  return files;
}

}  // namespace eomgen::emit

// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/fmu/description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <eom/hybrid/problem.hpp>
#include <functional>
#include <kainjow/mustache.hpp>
#include <set>
#include <stdexcept>

#include "emit/fmu/xml.hpp"
#include "emit/metadata.hpp"
#include "emit/template_data.hpp"
#include "emit/text.hpp"
#include "skeletons/fmu_buildDescription_xml.hpp"
#include "skeletons/fmu_modelDescription_xml.hpp"

namespace eomgen::emit {
namespace {

using kainjow::mustache::data;

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

}  // namespace

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

}  // namespace eomgen::emit

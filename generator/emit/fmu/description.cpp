// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/fmu/description.hpp"

#include <fmt/format.h>

#include <array>
#include <eom/hybrid/problem.hpp>
#include <functional>
#include <set>

#include "emit/fmu/xml.hpp"
#include "emit/text.hpp"

namespace eomgen::emit {
namespace {

constexpr const char* declaration = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";

std::string number(const std::optional<double>& value) { return value ? decimal(*value) : ""; }

/// Units of the variables, each with its powers of base units where they are whole numbers.
std::string unit_definitions(const FmuDescription& description, const FmuVariables& variables) {
  static constexpr std::array<const char*, 7> base{"m", "kg", "s", "A", "K", "mol", "cd"};
  std::set<std::string> units;
  for (const FmuVariable& v : variables.all)
    if (!v.unit.empty()) units.insert(v.unit);
  std::string result = "  <UnitDefinitions>\n";
  for (const std::string& unit : units) {
    result += "    " + xml_element("Unit", {{"name", unit}}, true);
    if (const auto known = description.units.find(unit); known != description.units.end()) {
      XmlAttributes attributes;
      for (std::size_t k = 0; k < base.size(); ++k) {
        const int power = known->second.powers[k];
        if (power != 0) attributes.emplace_back(base[k], fmt::format("{}", power));
      }
      result += xml_element("BaseUnit", attributes);
    }
    result += "</Unit>\n";
  }
  return units.empty() ? "" : result + "  </UnitDefinitions>\n";
}

std::string experiment(const RunDescription& run) {
  const eom::hybrid::Problem& p = *run.problem;
  const double step = p.output_interval > 0 ? p.output_interval : run.rows > 0 ? (p.t1 - p.t0) / run.rows : 0;
  return "  " +
         xml_element("DefaultExperiment", {{"startTime", decimal(p.t0)},
                                           {"stopTime", decimal(p.t1)},
                                           {"tolerance", decimal(p.rtol)},
                                           {"stepSize", step > 0 ? decimal(step) : ""}}) +
         "\n";
}

/// Elements of one list of ModelStructure, by a condition on the variables.
std::string unknowns(const FmuVariables& variables, const char* indent,
                     const std::function<bool(const FmuVariable&)>& belongs,
                     const std::function<std::string(std::size_t reference)>& element) {
  std::string result;
  for (std::size_t i = 0; i < variables.all.size(); ++i)
    if (belongs(variables.all[i])) result += indent + element(i) + "\n";
  return result;
}

bool is_output(const FmuVariable& v) { return v.causality == "output"; }
bool is_derivative(const FmuVariable& v) { return v.derivative_of.has_value(); }
/// Computed during the initialization.
bool is_initial_unknown(const FmuVariable& v) {
  return v.is_calculated() && (is_output(v) || is_derivative(v) || v.causality == "calculatedParameter");
}

std::string structure_of_fmi3(const FmuVariables& variables) {
  const auto element = [](const char* name) {
    return [name](std::size_t i) { return xml_element(name, {{"valueReference", fmt::format("{}", i)}}); };
  };
  return "  <ModelStructure>\n" + unknowns(variables, "    ", is_output, element("Output")) +
         unknowns(variables, "    ", is_derivative, element("ContinuousStateDerivative")) +
         unknowns(variables, "    ", is_initial_unknown, element("InitialUnknown")) +
         unknowns(
             variables, "    ", [](const FmuVariable& v) { return v.is_indicator; }, element("EventIndicator")) +
         "  </ModelStructure>\n";
}

std::string structure_of_fmi2(const FmuVariables& variables) {
  const auto list = [&](const char* name, const std::function<bool(const FmuVariable&)>& belongs) {
    const std::string entries = unknowns(variables, "      ", belongs, [](std::size_t i) {
      return xml_element("Unknown", {{"index", fmt::format("{}", i + 1)}});  // counted from 1
    });
    return entries.empty() ? "" : fmt::format("    <{0}>\n{1}    </{0}>\n", name, entries);
  };
  const std::string lists =
      list("Outputs", is_output) + list("Derivatives", is_derivative) + list("InitialUnknowns", is_initial_unknown);
  return lists.empty() ? "  <ModelStructure/>\n" : "  <ModelStructure>\n" + lists + "  </ModelStructure>\n";
}

std::string variables_of_fmi3(const FmuVariables& variables) {
  std::string result = "  <ModelVariables>\n";
  for (std::size_t i = 0; i < variables.all.size(); ++i) {
    const FmuVariable& v = variables.all[i];
    result += "    " +
              xml_element("Float64", {{"name", v.name},
                                      {"valueReference", fmt::format("{}", i)},
                                      {"description", v.description},
                                      {"causality", v.causality},
                                      {"variability", v.variability},
                                      {"initial", v.initial},
                                      {"unit", v.unit},
                                      {"nominal", number(v.nominal)},
                                      {"derivative", v.derivative_of ? fmt::format("{}", *v.derivative_of) : ""},
                                      {"reinit", v.is_state ? "true" : ""},
                                      {"start", number(v.start)}}) +
              "\n";
  }
  return result + "  </ModelVariables>\n";
}

/// An attribute `derivative` counts variables from 1.
std::string variables_of_fmi2(const FmuVariables& variables) {
  std::string result = "  <ModelVariables>\n";
  for (std::size_t i = 0; i < variables.all.size(); ++i) {
    const FmuVariable& v = variables.all[i];
    result += "    " + xml_element("ScalarVariable",
                                   {{"name", v.name},
                                    {"valueReference", fmt::format("{}", i)},
                                    {"description", v.description},
                                    {"causality", v.causality},
                                    {"variability", v.variability},
                                    {"initial", v.initial}},
                                   true);
    result += xml_element("Real", {{"unit", v.unit},
                                   {"nominal", number(v.nominal)},
                                   {"derivative", v.derivative_of ? fmt::format("{}", *v.derivative_of + 1) : ""},
                                   {"reinit", v.is_state ? "true" : ""},
                                   {"start", number(v.start)}}) +
              "</ScalarVariable>\n";
  }
  return result + "  </ModelVariables>\n";
}

constexpr const char* log_categories =
    "  <LogCategories>\n    <Category name=\"logStatusDiscard\"/>\n    <Category name=\"logStatusError\"/>\n"
    "  </LogCategories>\n";

std::string description_of_fmi3(const EmissionContext& context, const FmuDescription& description,
                                const FmuVariables& variables, const std::string& token) {
  const std::string name = mangled_id(context.id);
  const XmlAttributes common{{"modelIdentifier", name},
                             {"canGetAndSetFMUState", "true"},
                             {"canSerializeFMUState", "true"},
                             {"providesDirectionalDerivatives", "true"},
                             {"providesAdjointDerivatives", "true"}};
  XmlAttributes exchange = common, simulation = common;
  exchange.emplace_back("needsCompletedIntegratorStep", "true");
  simulation.emplace_back("canHandleVariableCommunicationStepSize", "true");
  return declaration +
         xml_element("fmiModelDescription",
                     {{"fmiVersion", "3.0"},
                      {"modelName", context.id},
                      {"instantiationToken", token},
                      {"description", context.title},
                      {"generationTool", "eomgen"},
                      {"variableNamingConvention", "flat"}},
                     true) +
         "\n  " + xml_element("ModelExchange", exchange) + "\n  " + xml_element("CoSimulation", simulation) + "\n" +
         unit_definitions(description, variables) + log_categories + experiment(*context.run) +
         variables_of_fmi3(variables) + structure_of_fmi3(variables) + "</fmiModelDescription>\n";
}

std::string description_of_fmi2(const EmissionContext& context, const FmuDescription& description,
                                const FmuVariables& variables, const std::string& token) {
  const std::string name = mangled_id(context.id);
  const XmlAttributes common{{"modelIdentifier", name},
                             {"canGetAndSetFMUstate", "true"},
                             {"canSerializeFMUstate", "true"},
                             {"providesDirectionalDerivative", "true"}};
  XmlAttributes simulation = common;
  simulation.emplace_back("canHandleVariableCommunicationStepSize", "true");
  return declaration +
         xml_element("fmiModelDescription",
                     {{"fmiVersion", "2.0"},
                      {"modelName", context.id},
                      {"guid", token},
                      {"description", context.title},
                      {"generationTool", "eomgen"},
                      {"variableNamingConvention", "flat"},
                      {"numberOfEventIndicators", fmt::format("{}", variables.event_indicators)}},
                     true) +
         "\n  " + xml_element("ModelExchange", common) + "\n  " + xml_element("CoSimulation", simulation) + "\n" +
         unit_definitions(description, variables) + log_categories + experiment(*context.run) +
         variables_of_fmi2(variables) + structure_of_fmi2(variables) + "</fmiModelDescription>\n";
}

}  // namespace

std::string model_description(const EmissionContext& context, const FmuDescription& description,
                              const FmuVariables& variables, const std::string& token) {
  return description.version == 2 ? description_of_fmi2(context, description, variables, token)
                                  : description_of_fmi3(context, description, variables, token);
}

std::string build_description(const std::string& name) {
  const auto source = [](const std::string& file) {
    return "      " + xml_element("SourceFile", {{"name", file}}) + "\n";
  };
  return declaration + std::string("<fmiBuildDescription fmiVersion=\"3.0\">\n  ") +
         xml_element("BuildConfiguration", {{"modelIdentifier", name}}, true) + "\n    " +
         xml_element("SourceFileSet", {{"language", "C11"}}, true) + "\n" + source(name + ".c") +
         "    </SourceFileSet>\n    " + xml_element("SourceFileSet", {{"language", "C++20"}}, true) + "\n" +
         source(name + "_fmu.cpp") + source("fmi3.cpp") + "      " + xml_element("IncludeDirectory", {{"name", "."}}) +
         "\n    </SourceFileSet>\n  </BuildConfiguration>\n</fmiBuildDescription>\n";
}

}  // namespace eomgen::emit

// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/fmu/fmu.hpp"

#include <fmt/format.h>

#include <eom/hybrid/problem.hpp>

#include "emit/fmu/description.hpp"
#include "emit/fmu/runtime_sources.hpp"
#include "emit/fmu/xml.hpp"
#include "emit/metadata.hpp"
#include "emit/targets.hpp"
#include "emit/text.hpp"
#include "skeletons/fmu_fmi_cpp.hpp"
#include "skeletons/fmu_icon.hpp"
#include "skeletons/fmu_index_html.hpp"
#include "skeletons/fmu_model_fmu_cpp.hpp"

namespace eomgen::emit {
namespace {

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

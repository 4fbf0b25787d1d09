// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/report/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <kainjow/mustache.hpp>
#include <stdexcept>

#include "cli/report_skeletons/address_js.hpp"
#include "cli/report_skeletons/admissible_forces_js.hpp"
#include "cli/report_skeletons/camera_js.hpp"
#include "cli/report_skeletons/contact_forces_js.hpp"
#include "cli/report_skeletons/contact_search_js.hpp"
#include "cli/report_skeletons/contacts_js.hpp"
#include "cli/report_skeletons/controls_js.hpp"
#include "cli/report_skeletons/drag_js.hpp"
#include "cli/report_skeletons/fit_js.hpp"
#include "cli/report_skeletons/friction_problem_js.hpp"
#include "cli/report_skeletons/gif_js.hpp"
#include "cli/report_skeletons/guards_js.hpp"
#include "cli/report_skeletons/integrator_js.hpp"
#include "cli/report_skeletons/linear_js.hpp"
#include "cli/report_skeletons/main_js.hpp"
#include "cli/report_skeletons/motion_js.hpp"
#include "cli/report_skeletons/page_css.hpp"
#include "cli/report_skeletons/page_html.hpp"
#include "cli/report_skeletons/pencil_js.hpp"
#include "cli/report_skeletons/phase_js.hpp"
#include "cli/report_skeletons/plots_js.hpp"
#include "cli/report_skeletons/recorder_js.hpp"
#include "cli/report_skeletons/resets_js.hpp"
#include "cli/report_skeletons/results_js.hpp"
#include "cli/report_skeletons/scene_js.hpp"
#include "cli/report_skeletons/solids_js.hpp"
#include "cli/report_skeletons/solved_contacts_js.hpp"
#include "cli/report_skeletons/surfaces_js.hpp"
#include "cli/report_skeletons/transitions_js.hpp"
#include "print/notation.hpp"

namespace eomgen::cli {
namespace {

using print::escape_html;

// "</script>" and "<!--" have a meaning inside a script element, even in strings.
std::string inside_of_script(const std::string& json) {
  std::string result;
  for (const char c : json)
    result += c == '<' ? "\\u003c" : c == '>' ? "\\u003e" : c == '&' ? "\\u0026" : std::string(1, c);
  return result;
}

}  // namespace

void Html::heading(int level, const std::string& text) {
  text_ += fmt::format("<h{0}>{1}</h{0}>\n", level, escape_html(text));
}

void Html::paragraph(const std::string& text, const std::string& style) {
  text_ += (style.empty() ? "<p>" : "<p class=\"" + style + "\">") + escape_html(text) + "</p>\n";
}

void Html::formula(const std::string& mathml) { text_ += "<p class=\"formula\">" + mathml + "</p>\n"; }

void Html::preformatted(const std::string& summary, const std::string& text) {
  text_ += "<details><summary>" + escape_html(summary) + "</summary><pre>" + escape_html(text) + "</pre></details>\n";
}

void Html::table(const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows,
                 const std::vector<std::size_t>& numbers) {
  text_ += "<table>\n<tr>";
  for (const std::string& cell : head) text_ += "<th>" + escape_html(cell) + "</th>";
  text_ += "</tr>\n";
  for (const std::vector<std::string>& row : rows) {
    text_ += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool number = std::find(numbers.begin(), numbers.end(), i) != numbers.end();
      text_ += (number ? "<td class=\"n\">" : "<td>") + escape_html(row[i]) + "</td>";
    }
    text_ += "</tr>\n";
  }
  text_ += "</table>\n";
}

std::string render_page(const PageParts& parts) {
  kainjow::mustache::mustache skeleton{std::string(report::page_html)};
  if (!skeleton.is_valid()) throw std::logic_error(skeleton.error_message());
  kainjow::mustache::data all{kainjow::mustache::data::type::object};
  all.set("title", escape_html(parts.title));
  all.set("style", std::string(report::page_css));
  all.set("body", parts.body);
  all.set("motion", inside_of_script(parts.motion));
  // The target escapes text of the model; the script must not contain its end tag.
  const auto returned = [](const std::string& script, const std::string& name) {
    return script.empty() ? "return null;" : script + "return " + name + ";";
  };
  all.set("model", returned(parts.model, parts.name));
  all.set("surfaces", returned(parts.surfaces, parts.surfaces_name));
  std::string scripts;
  const auto add = [&scripts](std::initializer_list<const char*> some) {
    for (const char* script : some) scripts += script;
  };
  add({report::linear_js, report::resets_js});
  if (parts.has_contacts)
    add({report::contact_search_js, report::contacts_js, report::friction_problem_js, report::admissible_forces_js,
         report::contact_forces_js, report::transitions_js, report::solved_contacts_js, report::guards_js});
  add({report::integrator_js, report::motion_js, report::address_js, report::solids_js, report::camera_js,
       report::pencil_js, report::surfaces_js, report::scene_js, report::plots_js, report::phase_js, report::drag_js,
       report::controls_js, report::fit_js, report::results_js, report::gif_js, report::recorder_js, report::main_js});
  all.set("scripts", scripts);
  all.set("moving",
          parts.motion.empty() ? kainjow::mustache::data::type::bool_false : kainjow::mustache::data::type::bool_true);
  return skeleton.render(all);
}

}  // namespace eomgen::cli

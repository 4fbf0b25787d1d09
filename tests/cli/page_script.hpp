// SPDX-License-Identifier: GPL-3.0-or-later
// The computation of a page of `report` without its drawing, through Node. In: a model, values chosen on the page, a
// script. Out: what the script prints, as JSON.
#pragma once

#include <doctest/doctest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <string>

#include "program.hpp"
#include "support/folders.hpp"

namespace eomgen::test {

inline Json in_json(const std::map<std::string, double>& set) {
  Json result = Json::object();
  for (const auto& [name, value] : set) result[name] = value;
  return result;
}

inline std::string between(const std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  const std::size_t begin = at + from.size();
  return text.substr(begin, text.find(to, begin) - begin);
}

inline const char* const on_page = R"(
const data = JSON.parse(DATA), live = new Live(model, data.live, data), asked = JSON.parse(process.argv[2]);
const names = live.states.map((s) => s.name), find = (name) => live.parameters.findIndex((p) => p.name === name);
for (const name in asked) names.includes(name) ? live.starts_chosen.set(names.indexOf(name), asked[name]) : live.chosen[find(name)] = asked[name];
live.prepare();
)";
inline const char* const start_on_page = R"(
const states = {}, parameters = {};
names.forEach((name, k) => { states[name] = live.x[k]; });
live.parameters.forEach((p, i) => { parameters[p.name] = live.p[i]; });
console.log(JSON.stringify({refusal: live.refusal, t0: live.t0, t1: live.t1, states, parameters, psi: Array.from(live.constraintsAt(live.t0, live.x).psi)}));
)";

// The whole run in the page, at the tolerances of the run that it is compared with.
inline const char* const run_on_page = R"(
const integration = live.integration(500);
Object.assign(integration, {rtol: 1e-11, atol: 1e-13});
while (!integration.advance(1000));
const last = integration.states.length - 1, end = {};
names.forEach((name, k) => { end[name] = integration.states[last][k]; });
const valued = integration.states.every((x, k) => live.outputs(integration.times[k], x, integration.modes[k] || undefined).every(Number.isFinite));
console.log(JSON.stringify({refusal: live.refusal, valued, outcome: integration.outcome, t: integration.times[last], end, events: integration.found, rising: integration.times.every((t, k) => k === 0 || t >= integration.times[k - 1]),
  rows: integration.times.length}));
)";

/// The contents of the page after these values were chosen; nothing without Node.
inline std::optional<Json> page(const Folder& folder, const std::string& model,
                                const std::map<std::string, double>& set, const Words& options = {},
                                const char* wanted = start_on_page, int status = 0) {
  expect(status, folder, with({"report", model, "-o", "page.html"}, options));
  const std::string html = folder.read("page.html");
  std::string script = "\"use strict\";\nconst DATA = " + Json(between(html, "id=\"motion\">", "</script>")).dump() +
                       ";\nconst model = (() => {" +
                       between(html, "const model = (() => {", "})();\nconst surfaceCode") + "})();\n";
  for (const char* part : {"linear.js", "resets.js", "contact_search.js", "contacts.js", "friction_problem.js",
                           "admissible_forces.js", "contact_forces.js", "transitions.js", "solved_contacts.js",
                           "guards.js", "integrator.js", "motion.js", "address.js"}) {
    std::ifstream file(source_folder() + "/templates/report/" + part);
    script.append(std::istreambuf_iterator<char>(file), {});
  }
  folder.write("page.js", script + on_page + wanted);
  try {
    const ChildResult result = run_child({{"node", "page.js", in_json(set).dump()}, folder.path()});
    CAPTURE(result.err);
    REQUIRE(result.status == 0);
    return Json::parse(result.out);
  } catch (const std::runtime_error&) {
    MESSAGE("skipped: there is no node");
    return std::nullopt;
  }
}

}  // namespace eomgen::test

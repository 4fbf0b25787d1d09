// SPDX-License-Identifier: GPL-3.0-or-later
// Command report: a self-contained, well-formed page with escaped text of the model.
#include <doctest/doctest.h>

#include <cctype>
#include <cmath>
#include <fstream>
#include <iterator>
#include <tuple>
#include <vector>

#include "page_script.hpp"
#include "program.hpp"
#include "support/folders.hpp"

using namespace eomgen::test;

namespace {

/// First tag that is not closed properly; "" if all are. Scripts and styles are skipped as text.
std::string unbalanced(const std::string& page) {
  const Words void_tags{"meta", "input"};
  Words open;
  for (std::size_t at = page.find('<'); at != std::string::npos; at = page.find('<', at)) {
    const std::size_t end = page.find('>', at);
    if (end == std::string::npos) return "<";
    const bool closing = page[at + 1] == '/', single = page[end - 1] == '/';
    std::string name;
    for (std::size_t i = at + (closing ? 2 : 1);
         i < end && (std::isalnum(static_cast<unsigned char>(page[i])) != 0 || page[i] == '-'); ++i)
      name += page[i];
    at = end;
    if (name.empty() || single || std::find(void_tags.begin(), void_tags.end(), name) != void_tags.end())
      continue;  // <!DOCTYPE html>
    if (!closing) {
      open.push_back(name);
      if (name == "script" || name == "style") at = page.find("</" + name, end);
      continue;
    }
    if (open.empty() || open.back() != name) return name;
    open.pop_back();
  }
  return open.empty() ? "" : open.back();
}

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

Json motion(const std::string& page) {
  const std::string mark = "id=\"motion\">";
  const std::size_t begin = page.find(mark) + mark.size();
  return Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

/// Largest difference of the numbers of two documents of the same form.
double difference(const Json& a, const Json& b) {
  if (a.is_number() && b.is_number()) return std::abs(a.get<double>() - b.get<double>());
  REQUIRE(a.type() == b.type());
  REQUIRE(a.size() == b.size());
  double largest = 0;
  if (!a.is_structured()) CHECK(a == b);
  for (auto i = a.begin(), j = b.begin(); a.is_structured() && i != a.end(); ++i, ++j)
    largest = std::max(largest, difference(*i, *j));
  return largest;
}

}  // namespace

TEST_CASE("report: one page with equations, certificate, run, plots and animation, without external references") {
  const Folder folder;
  for (const char* model : {"S5_double_pendulum", "R6_rolling_disk", "stick_slip_belt", "P7_moving_sphere"}) {
    CAPTURE(std::string(model));
    const Json found = document(folder, {"report", model, "-o", "page.html"});
    CHECK(found["outcome"] == "done");
    CHECK(found["file"] == "page.html");
    const std::string page = folder.read("page.html");
    CHECK(unbalanced(page) == "");
    CHECK(occurrences(page, "<math") > 5);
    CHECK(occurrences(page, "<svg") >= 2);
    CHECK(contains(page, "pass: 5 points, 50 digits"));
    for (const char* reference : {"src=", "href=", "@import", "url(", "fetch(", "XMLHttpRequest"})
      CHECK_FALSE(contains(page, reference));
  }
}

TEST_CASE(
    "report: a page that integrates the model has the states of the run; one that replays has the drawn values and the "
    "reason") {
  const Folder folder;
  expect(0, folder, {"report", "S5_double_pendulum", "-o", "page.html", "--t-end", "1"});
  Json moving = motion(folder.read("page.html"));
  REQUIRE(moving["parts"]["places"].size() == 2);
  CHECK(moving["t"].back() == 1.0);
  CHECK(moving["parts"]["links"][0] == Json::parse(R"({"from": -1, "to": 0, "is_rod": true})"));
  CHECK(moving["parts"]["links"][1] == Json::parse(R"({"from": 0, "to": 1, "is_rod": true})"));
  CHECK(moving["live"]["n"] == 2);
  CHECK(moving["reason"] == "");
  CHECK(moving["y"].is_null());
  expect(0, folder, {"run", "S5_double_pendulum", "--t-end", "1", "--out", "rows.csv", "--every", "1"});
  const Table rows = read_table(folder.read("rows.csv"));
  CHECK(moving["x"].back()[1].get<double>() == doctest::Approx(rows.at(1, "theta2")).epsilon(1e-9));

  expect(0, folder, {"report", "bouncing_ball", "-o", "page.html"});
  moving = motion(folder.read("page.html"));
  CHECK(moving["reason"] == "");
  CHECK(moving["live"]["contacts"][0]["name"] == "floor");
  CHECK(moving["x"].size() == moving["y"].size());  // forces of the run in its modes
  CHECK(moving["down"] == Json({0.0, -9.81, 0.0}));
  const std::size_t at = moving["parts"]["places"][0]["at"];
  CHECK(moving["y"].front()[at + 1] == 1);
  double lowest = 1, highest = 0;
  for (const Json& y : moving["y"])
    lowest = std::min(lowest, y[at + 1].get<double>()), highest = std::max(highest, y[at + 1].get<double>());
  CHECK(lowest == doctest::Approx(0).epsilon(1e-5));
  CHECK(highest == 1);

  expect(0, folder, {"report", "dominoes", "-o", "page.html", "--t-end", "0.01"});
  moving = motion(folder.read("page.html"));
  CHECK(moving["live"].is_null());
  CHECK(contains(moving["reason"].get<std::string>(), "59 contacts"));
  CHECK(moving["x"].is_null());

  expect(0, folder, {"report", "box_stack", "-o", "page.html", "--t-end", "0.01"});
  CHECK(folder.read("page.html").size() < 1000000);  // hundreds of formulas, each with a line where it is left out
}

TEST_CASE("report: a page integrates a model with kinks, with and without events") {
  const Folder folder;
  expect(0, folder, {"report", "bilinear_oscillator", "-o", "page.html", "--t-end", "1"});
  const Json found = motion(folder.read("page.html"));
  CHECK(found["reason"] == "");
  CHECK(found["live"]["event_count"] == 1);  // x, at the switch of max and min
}

TEST_CASE("report: an output in J that is not an energy has its own panel, separate from the energies") {
  const Folder folder;
  folder.write("pushed.toml", R"toml(format = 1
[parameters]
k = "5 N/m"
F = "3 N"
[[particle]]
name = "P"
mass = "1 kg"
position = { cartesian = ["x", 0] }
[[force]]
on = "P"
force = "F*E1"
[[force]]
spring = { between = ["origin", "P"], stiffness = "k" }
[definitions]
work = "F*x"
stored = "k*x^2/2"
[scene.default]
t = [0, 1]
initial = { x = 1 }
outputs = ["work", "energy"]
[scene.both]
from = "default"
outputs = ["work", "kinetic", "stored"]
)toml");
  for (const auto& [scene, own] :
       {std::pair{"default", "work in J: work"}, std::pair{"both", "outputs in J: work stored"}}) {
    expect(0, folder, {"report", "pushed.toml", "--scene", scene, "-o", "page.html"});
    const std::string page = folder.read("page.html");
    const Json moving = motion(page);
    Words panels;
    for (const Json& panel : moving["panels"]) {
      const std::string title = panel["title"].get<std::string>();
      CHECK(occurrences(page, ">" + title + "<") == 1);  // at the axis of its plot
      panels.push_back(title + ":");
      for (const Json& curve : panel["of"]) panels.back() += " " + curve["name"].get<std::string>();
    }
    CHECK(panels == Words{"x in m: x", own, "energies in J: energy kinetic potential"});
  }
}

TEST_CASE("report: springs, dampers, struts, actuators and bushings are drawn between their points") {
  const Folder folder;
  folder.write("mount.toml", R"toml(format = 1
[[body]]
name = "B"
mass = "1 kg"
inertia = "1 kg*m^2"
position = { cartesian = ["x", "y"] }
rotation = { axis = "E3", angle = "b" }
[[force]]
bushing = { bodies = ["ground", "B"], at = ["origin", "B - 1[m]*B.e1"], stiffness = "100 N/m", rotational_stiffness = "5 N*m" }
[[force]]
spring_damper = { between = ["2[m]*E2", "B"], stiffness = "5 N/m", coefficient = "1 N*s/m" }
[[force]]
linear_actuator = { between = ["B", "3[m]*E1"], force = "1 N" }
[scene.default]
t = [0, 0.1]
initial = { x = 1 }
)toml");
  expect(0, folder, {"report", "mount.toml", "-o", "page.html"});
  const Json parts = motion(folder.read("page.html"))["parts"];
  REQUIRE(parts["springs"].size() == 2);
  REQUIRE(parts["dampers"].size() == 3);
  CHECK(parts["springs"][0]["a"] != parts["springs"][0]["b"]);
}

TEST_CASE("report: the solids of a page follow its parameters as in a run of the program") {
  const Folder folder;
  // Shapes of [draw] and of inertias, wheels, a bar towards a contact.
  for (const auto& [model, name, value] :
       {std::tuple{"geared_hoist", "r1", 0.08}, {"rocking_block", "b", 0.3}, {"R7_satellite", "m", 2.0}}) {
    CAPTURE(model);
    std::ifstream file(source_folder() + "/templates/report/solids.js");
    const std::string compared = std::string(std::istreambuf_iterator<char>(file), {}) + R"(
const {parts, sizes} = data, all = (values) => parts.solids.map(({list}) => list.map((solid) => solidOf(solid, parts.polyhedra, values)));
console.log(JSON.stringify({solids: all(live.sizes), wheels: parts.wheels.map(({radii}) => radii.map((i) => live.sizes[i])), before: all(sizes)}));)";
    const std::optional<Json> moved = page(folder, model, {{name, value}}, {"--t-end", "0.1"}, compared.c_str());
    if (!moved) return;
    const std::optional<Json> set =
        page(folder, model, {}, {"--t-end", "0.1", "--set", std::string(name) + "=" + std::to_string(value)},
             compared.c_str());
    CHECK((*moved)["before"] != (*set)["solids"]);
    CHECK(difference((*moved)["solids"], (*set)["solids"]) < 1e-9);
    CHECK(difference((*moved)["wheels"], (*set)["wheels"]) < 1e-9);
  }
}

TEST_CASE(
    "report: dependent parameters are updated on the page and have no slider; parameters set by options are numbers") {
  const Folder folder;
  expect(0, folder, {"report", "R6_rolling_disk", "-o", "page.html", "--set", "J=0.01", "--t-end", "0.1"});
  const Json moving = motion(folder.read("page.html"));
  for (const Json& p : moving["live"]["parameters"]) CHECK(p["moved"] == (p["name"] != "J3"));
  CHECK(contains(folder.read("page.html"), "start_dependent"));
}

TEST_CASE("report: a page with many coordinates and outputs stays below 1 MB with fewer rows, and reports it") {
  const Folder folder;
  std::string text = "format = 1\n[parameters]\nm = \"1 kg\"\n", outputs;
  for (int i = 1; i <= 22; ++i) {
    const std::string n = std::to_string(i), name = "P" + n;
    text += "[[particle]]\nname = \"" + name + "\"\nmass = \"m\"\nposition = { cartesian = [\"x" + n + "\", \"y" + n +
            "\", \"z" + n + "\"] }\n";
    for (const char* axis : {"x", "y", "z"}) outputs += (outputs.empty() ? "\"" : ", \"") + (axis + n) + "_ddot\"";
    for (const char* of : {".velocity", ".position"}) {
      for (const char* axis : {"1", "2", "3"}) outputs += ", \"" + name + of + axis + "\"";
    }
  }
  folder.write("rain.toml",
               text +
                   "[[force]]\ngravity = \"-9.81[m/s^2]*E3\"\n[[constraint]]\nname = \"floor\"\nholonomic = "
                   "\"z1\"\nholds = \"unilateral\"\nrestitution = 0.5\n[scene.default]\nt = [0, 1]\noutputs = [" +
                   outputs + "]\ninitial = { z1 = 1, x1_dot = 0.3 }\n");
  expect(0, folder, {"report", "rain.toml", "-o", "page.html"});
  const std::string page = folder.read("page.html");
  CHECK(page.size() < 1000000);
  const Json moving = motion(page);
  CHECK(moving["t"].size() < 100);
  CHECK(moving["t"].back() == 1.0);
  CHECK(moving["y"].size() == moving["t"].size());
  CHECK(contains(page, "Coarser than of a small system, so that the page stays below 1 MB: " +
                           std::to_string(moving["t"].size()) + " rows of the run."));
  expect(0, folder, {"report", "S5_double_pendulum", "-o", "page.html", "--t-end", "1"});
  CHECK_FALSE(contains(folder.read("page.html"), "Coarser"));
}

TEST_CASE("report: the page reports what is not drawn: forces without a vector, surplus arrows and rods") {
  const Folder folder;
  std::string text = "format = 1\n[parameters]\nm = \"1 kg\"\n[coordinates]\nX = \"m\"\n";
  for (int i = 1; i <= 202; ++i) {
    const std::string n = std::to_string(i);
    text += "[[particle]]\nname = \"P" + n + "\"\nmass = \"m\"\nposition = \"X*E1 + " + n + "[m]*E2\"\n";
  }
  folder.write("row.toml",
               text +
                   "[[force]]\ngravity = \"-9.81[m/s^2]*E1\"\n[[force]]\nname = \"push\"\ngeneralized = { X = \"4 "
                   "N\" }\n[scene.default]\nt = [0, 1]\ninitial = { X_dot = 1 }\n");
  expect(0, folder, {"report", "row.toml", "-o", "page.html"});
  const std::string page = folder.read("page.html");
  const Json parts = motion(page)["parts"];
  CHECK(parts["arrows"].size() == 60);
  CHECK(parts["beyond"].get<int>() > 100);
  CHECK(parts["without_vector"] == Json::array({"push"}));
  CHECK(parts["untried"] == true);
  for (const char* words :
       {" arrows are drawn, ", "no vector is known", "Rods are not looked for among so many places."})
    CHECK(contains(page, words));
}

TEST_CASE("report: text of a model is escaped") {
  const Folder folder;
  folder.write("hostile.toml",
               "format = 1\ntitle = \"</title><script>alert(1)</script>\"\nnotes = \"<img src=x onerror=alert(2)> "
               "{{{body}}} & </script>\"\n"
               "[parameters]\nm = { value = 1, note = \"</script><b>\", unit = \"kg\" }\n[[particle]]\nname = "
               "\"P\"\nmass = \"m\"\nposition = { cartesian = [\"x\", \"y\", \"z\"] }\n"
               "[scene.default]\nt = [0, 1]\ninitial = { x_dot = 1 }\n# </pre><script>alert(3)</script>\n");
  expect(0, folder, {"report", "hostile.toml"});
  const std::string page = folder.read("report.html");
  CHECK(unbalanced(page) == "");
  CHECK(occurrences(page, "<script") == 2);  // the motion, and the script of the page with the model
  CHECK(occurrences(page, "</script") == 2);
  CHECK(occurrences(page, "<!--") == 0);
  CHECK(occurrences(page, "<img") == 0);
  CHECK(contains(page, "&lt;script&gt;alert(1)"));
  CHECK(contains(page, "{{{body}}}"));
}

TEST_CASE("report: a failed run is reported on the page, an unwritable path before any work") {
  const Folder folder;
  folder.write("diverging.toml", diverging_text());
  CHECK(document(folder, {"report", "diverging.toml"}, 3)["file"] == "report.html");
  CHECK(contains(folder.read("report.html"), "<td>outcome</td>"));
  CHECK(contains(expect(2, folder, {"report", "diverging.toml", "-o", "nowhere/page.html"}).err, "--out"));
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Pages of `report` in a headless browser: contents, animation, and agreement of their computation with the program.
// Skipped with a message without Chromium (scripts/setup --with page).
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <sstream>

#include "program.hpp"
#include "support/folders.hpp"

using namespace eomgen::test;

namespace {

constexpr std::size_t largest_page = 1000000;  // bytes
constexpr double as_run_does = 1e-5;  // the page integrates with rtol 1e-8, the run with 1e-9 and another method
constexpr double a_pixel = 1;
constexpr double far_colours = 1e-4;  // share of the values of a picture that the palette of 255 colours lacks
constexpr double first_view = 900;    // height of the frames, in pixels
constexpr std::size_t longest_formula = 60000;  // bytes, as in report
constexpr double on_the_sphere = 1e-3;  // for radius 1: intersections of surface lines with cells are found by secants

// A box in free flight with a point at one of its corners. It is drawn as a box, by its corners and an inner point, and
// by two of its faces.
const char* const brick = R"(format = 1
title = "Brick & <b>hostile</b> \"name\" </script>"
[parameters]
m = "2 kg"
a = "0.4 m"
g = { value = "9.81 m/s^2", note = "</script><script>throw 1</script>" }
[[body]]
name = "brick"
mass = "m"
inertia = { box = ["a", "0.3 m", "0.1 m"] }
position = { cartesian = ["x", "y", "z"] }
rotation = { euler = "321", angles = ["psi", "theta", "phi"] }
[[point]]
name = "corner"
on = "brick"
at = ["a/2", "0.15 m", "-0.05 m"]
[[force]]
gravity = "-g*E3"
[draw]
brick = [{ box = ["a", "0.3 m", "0.1 m"] },
  { mesh = [["-a/2", -0.15, -0.05], ["a/2", -0.15, -0.05], ["-a/2", 0.15, -0.05], ["a/2", 0.15, -0.05], ["-a/2", -0.15, 0.05],
      ["a/2", -0.15, 0.05], ["-a/2", 0.15, 0.05], ["a/2", 0.15, 0.05], ["a/10", 0, 0], [0, 0, 0.05]] },
  { mesh = [["a/2", 0.15, -0.05], ["a/2", -0.15, -0.05], ["-a/2", -0.15, -0.05], [0, 0, "a"]], faces = [[1, 2, 3], [1, 2, 4]] }]
[scene.default]
t = [0, 1]
initial = { psi_dot = 2, theta_dot = 0.7, phi_dot = 4, x_dot = 1, z_dot = 4 }
)";

// A bead in a sliding bowl: its surface moves with the cart.
const char* const bowl = R"(format = 1
title = "Bead in a bowl that slides"
[parameters]
m = "1 kg"
L = "1 m"
g = "9.81 m/s^2"
[coordinates]
X = "m"
[[particle]]
name = "cart"
mass = "2*m"
position = "X*E1"
[[particle]]
name = "bead"
mass = "m"
position = { cartesian = ["x", "y", "z"], from = "cart" }
[[force]]
gravity = "-g*E3"
[[constraint]]
name = "bowl"
holonomic = "z - (x^2 + y^2)/L"
[scene.default]
t = [0, 2]
initial = { x = 0.5, y = 0, y_dot = 1.5, X = 0.3, X_dot = 1 }
solve = ["z", "z_dot"]
)";

// A ball that is pushed by a table of values: the page replays its run.
const char* const pushed = R"(format = 1
title = "Ball that is pushed"
[parameters]
m = "1 kg"
g = "9.81 m/s^2"
[inputs]
F = { unit = "N" }
[[particle]]
name = "ball"
mass = "m"
position = { cartesian = ["x", "y"] }
[[force]]
gravity = "-g*E2"
[[force]]
generalized = { x = "F" }
[[constraint]]
name = "floor"
holonomic = "y"
holds = "unilateral"
restitution = 0.5
friction = { static = 0.3, dynamic = 0.2 }
[scene.default]
t = [0, 1]
initial = { x_dot = 1, y = 1 }
inputs = { F = { t = [0, 0.5], value = [5, 0] } }
outputs = ["energy", "reaction.floor"]
)";

struct PageCase {
  std::string model;        // a name, or a file in the folder
  bool live = true;         // the page integrates it
  std::string slider = {};  // a parameter that is moved
  double value = 0;
  std::string drag = {};               // a point that is dragged
  std::string corner = {};             // a point that is a corner of a drawn body
  bool sphere = false;                 // its particle is on a sphere about the origin
  std::array<int, 2> by = {-40, -30};  // pixels by which the point is dragged
};

std::string source(const std::string& path) {
  std::ifstream file(eomgen::test::source_folder() + "/" + path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string in_script(const Json& value) {
  std::string result;
  for (const char c : value.dump()) result += c == '<' ? "\\u003c" : std::string(1, c);
  return result;
}

std::optional<std::string> browser() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    try {
      if (run_child({{name, "--version"}}).status == 0) return name;
    } catch (const std::exception&) {  // the program is not installed
    }
  }
  return std::nullopt;
}

ChildResult browse(const Folder& folder, const std::string& program, Words words) {
  Words all{program,         "--headless",        "--no-sandbox",
            "--disable-gpu", "--hide-scrollbars", "--user-data-dir=" + (folder / "profile")};
  all.insert(all.end(), words.begin(), words.end());
  ChildCommand command{all, folder.path(), {}, 240};
  return run_child(command);
}

/// Results of page_checks.js for the cases.
Json inspect_pages(const Folder& folder, const std::string& program, const Json& cases) {
  // The encoding is stated: a browser guesses it from the first bytes otherwise, and marks of rates would not be found.
  folder.write("checks.html",
               "<!DOCTYPE html><html><head><meta charset=\"utf-8\"></head><body><pre id=\"found\"></pre><script "
               "id=\"cases\">const cases = " +
                   in_script(cases) + ";</script><script>" + source("tests/cli/page_checks.js") +
                   "</script></body></html>");
  const ChildResult result = browse(folder, program,
                                    {"--window-size=1300,1000", "--virtual-time-budget=100000000", "--dump-dom",
                                     "file://" + (folder / "checks.html")});
  const std::string mark = "<pre id=\"found\">";
  const std::size_t begin = result.out.find(mark);
  REQUIRE(begin != std::string::npos);
  std::string text = result.out.substr(begin + mark.size(), result.out.find("</pre>", begin) - begin - mark.size());
  for (const auto& [escaped, plain] : std::vector<std::pair<std::string, std::string>>{
           {"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&nbsp;", " "}, {"&amp;", "&"}}) {
    for (std::size_t at = 0; (at = text.find(escaped, at)) != std::string::npos; at += plain.size())
      text.replace(at, escaped.size(), plain);
  }
  const Json found = Json::parse(text, nullptr, false);
  CAPTURE(text);
  REQUIRE(found.is_array());
  REQUIRE(found.size() == cases.size());
  return found;
}

Json positions(const Folder& folder, const std::string& model, const Json& parts) {
  Words words{"run", model, "--out", "rows.csv", "--every", "0.25"};
  for (const Json& place : parts) {
    for (const char* axis : {"1", "2", "3"}) {
      words.push_back("--output");
      words.push_back(place["name"].get<std::string>() + ".position" + axis);
    }
  }
  expect(0, folder, words);
  const Table table = read_table(folder.read("rows.csv"));
  return {{"columns", table.columns}, {"rows", table.rows}};
}

/// The tables and the start show the run that is drawn: numbers of 10 and 6 digits.
void check_tables(const Json& shown) {
  CHECK(shown["in_table"] > 0);
  CHECK(shown["table_off"] < 1e-9);
  CHECK(shown["start_off"] < 1e-5);
}

void check(const Json& found, const PageCase& c, const Json& wanted) {
  CAPTURE(c.model);
  CAPTURE(found.dump());
  REQUIRE_FALSE(found.contains("failed"));
  for (const std::string width : {"1280", "390"}) {
    const Json& at = found["widths"][width];
    CAPTURE(width);
    CHECK(at["messages"] == Json::array());
    CHECK(at["sideways"] == 0);
    CHECK(at["formulas"]["count"] > 5);
    CHECK(at["formulas"]["overlaps"][0] == 0);
    CHECK(at["formulas"]["tight"][0] == 0);
    CHECK(at["formulas"]["wide"][0] == 0);
    CHECK(at["dot_gap"] > 1);  // pixels
    CHECK(at["controls"]["cut"] == 0);
    CHECK(at["controls"]["twice"] == Json::array());
    if (width == "1280") CHECK(at["controls"]["bottom"] < first_view);
    CHECK(at["ink"] > 500);
    CHECK(at["moves"] == true);
    CHECK(at["plays"] == true);
    CHECK(at["curves"] >= 4);
    if (c.model == "S5_double_pendulum") CHECK(at["covered"] == Json::array({"r2 (as r1)"}));
    CHECK(at["live"] == c.live);
    CHECK(at.contains("phase") == c.live);
    if (c.live) {
      CHECK(at["phase"]["curves"] == 2);  // the axes and the path
      CHECK(at["phase"]["points"] == at["phase"]["crossed"]);
      CHECK(at["phase"]["note"] == std::to_string(at["phase"]["crossed"].get<int>()) + " points");
      CHECK(at["phase"]["left"] == 0);
    }
    if (c.model == "S5_double_pendulum") CHECK(at["phase"]["points"] > 1);
    REQUIRE(at["forces"].is_object());
    CHECK(at["forces"]["drawn"] == true);
    CHECK(at["forces"]["taken_back"] == true);
    CHECK(at["forces"]["legend_of_moments"] == (at["forces"]["moments"] > 0));
    if (c.model == "R7_satellite" || c.model == "R15_pin_joint") CHECK(at["forces"]["moments"] > 0);
    if (c.model == "bowl.toml") {  // z of its lines is the bowl above the cart
      CHECK(at["carried"]["lines"] > 300);
      CHECK(at["carried"]["off"] < on_the_sphere);
      CHECK(at["carried"]["moved"] > 0.1);
    }
    if (c.model == "bouncing_ball") {  // the line of the floor, below the ball
      CHECK(at["floor"]["lines"] > 50);
      CHECK(at["floor"]["off"] < 1e-9);
    }
    if (!c.sphere) continue;
    CHECK(at["surfaces"]["lines"] > 500);
    CHECK(at["surfaces"]["off"] < on_the_sphere);
  }
  const Json& wide = found["widths"]["1280"];
  CHECK(wide["furthest"] < a_pixel);
  if (!c.corner.empty()) {
    CHECK(wide["corner"] < a_pixel);
    CHECK(wide["faces"] == Json{6, 6, 2});
  }
  if (!c.drag.empty()) {
    CHECK(wide["drag"]["moved"] > 5);
    CHECK(wide["drag"]["nearer"] == true);
    CHECK(wide["drag"]["psi"] < 1e-9);
    CHECK(wide["drag"]["ran"] == true);
    check_tables(wide["drag"]);
  }
  if (c.model == "bouncing_ball") {
    const Json& film = wide["film"];
    CHECK(film["pictures"] == 5);
    CHECK(film["repeats"] == true);
    CHECK(film["duration"] == 70000);  // microseconds
    CHECK(film["off"] < far_colours);
    CHECK(film["moves"] > 10 * far_colours);
    CHECK(film["seconds"].get<double>() == doctest::Approx(4).epsilon(0.02));  // as the player shows it
    CHECK(film["same"] == true);
    CHECK(film["type"] == "image/gif");
  }
  if (c.slider.empty()) return;
  CHECK(wide["ran"] == true);
  CHECK(contains(wide["link"].get<std::string>(), "#" + c.slider + "="));
  CHECK(wide["link_reset"] == "");
  CHECK(wide["link_value"].get<double>() == doctest::Approx(c.value));
  check_tables(wide);
  for (const auto& [name, value] : wide["end"].items()) {
    const auto& shown = name;
    CAPTURE(shown);
    const double expected = wanted[name].get<double>();
    CHECK(std::fabs(value.get<double>() - expected) <= as_run_does * (1 + std::fabs(expected)));
  }
}

void keep_picture(const Folder& folder, const std::string& program, const std::string& name) {
  const std::string place = eomgen::test::build_folder() + "/pages";
  std::filesystem::create_directories(place);
  browse(folder, program,
         {"--window-size=1280,1600", "--virtual-time-budget=1500", "--screenshot=" + place + "/" + name + ".png",
          "file://" + (folder / "page.html")});
}

}  // namespace

TEST_CASE("page: reports show complete equations, replay the run, and integrate the model in a browser") {
  const std::optional<std::string> program = browser();
  if (!program) {
    MESSAGE("skipped: there is no chromium");
    return;
  }
  const Folder folder;
  folder.write("chain_10.toml", replaced(source("models/S6_chain_6.toml"), "n = 6", "n = 10"));
  folder.write("brick.toml", brick);
  folder.write("bowl.toml", bowl);
  folder.write("pushed.toml", pushed);
  const std::vector<PageCase> list{{"brick.toml", true, "a", 0.5, "", "corner"},
                                   {"P7_moving_sphere", true, "m", 2, "", "", true},
                                   {"S5_double_pendulum", true, "m2", 1.5, "P2"},
                                   {"R6_rolling_disk", true, "R", 0.25},
                                   {"bowl.toml"},
                                   {"bouncing_ball", true, "e", 0.7, "ball"},
                                   {"R7_satellite"},
                                   {"R10_lagrange_top"},
                                   {"R15_pin_joint", true, "m1", 2},
                                   {"R16_sphere_on_sphere"},
                                   {"R16_disk_on_disk", true},
                                   {"rocking_block", true, "b", 0.3, "block"},
                                   {"pushed.toml", false},
                                   {"six_bar_spatial", true, "k", 170, "plate"},
                                   // To where it does not swing through its singular position.
                                   {"n_four_bar_2", true, "", 0, "K1", "", false, {-150, 160}},
                                   {"rimless_wheel", true, "gamma", 0.1},
                                   {"sampled_cart_pole", true, "kp", 44},
                                   {"chain_10.toml", true, "L", 1.2}};
  Json cases = Json::array();
  std::vector<Json> wanted;
  for (const PageCase& c : list) {
    CAPTURE(c.model);
    expect(0, folder, {"report", c.model, "-o", "page.html"});
    const std::string page = folder.read("page.html");
    CHECK(page.size() < largest_page);
    const std::size_t begin = page.find("id=\"motion\">") + 12;
    const Json motion = Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
    Json entry{{"name", c.model}, {"page", page}, {"csv", positions(folder, c.model, motion["parts"]["places"])}};
    if (!c.drag.empty()) entry["drag"] = {{"name", c.drag}, {"by", c.by}};
    if (c.model == "bowl.toml") entry["bowl"] = true;
    if (c.model == "bouncing_ball") entry["floor"] = entry["film"] = true;
    if (!c.corner.empty()) entry["corner"] = c.corner;
    wanted.emplace_back();
    if (!c.slider.empty()) {
      entry["slider"] = {{"name", c.slider}, {"value", c.value}};
      wanted.back() = document(folder, {"run", c.model, "--set", c.slider + "=" + std::to_string(c.value)})["final"];
    }
    if (c.live)
      CHECK(motion["reason"] == "");
    else
      CHECK(motion["reason"] != "");
    if (c.model == "S5_double_pendulum" || c.model == "six_bar_spatial") keep_picture(folder, *program, c.model);
    cases.push_back(std::move(entry));
  }
  // A few pages per browser, each of which has a limit of time.
  constexpr std::size_t at_once = 4;
  for (std::size_t begin = 0; begin < list.size(); begin += at_once) {
    Json some = Json::array();
    for (std::size_t k = begin; k < std::min(begin + at_once, list.size()); ++k) some.push_back(std::move(cases[k]));
    const Json found = inspect_pages(folder, *program, some);
    for (std::size_t k = 0; k < some.size(); ++k) check(found[k], list[begin + k], wanted[begin + k]);
  }
}

TEST_CASE("page: the formulas of all shipped models fit their column, with gaps and without overlaps") {
  const std::optional<std::string> program = browser();
  if (!program) {
    MESSAGE("skipped: there is no chromium");
    return;
  }
  const Folder folder;
  const std::string head = "<!DOCTYPE html><html><head><style>" + source("templates/report/page.css") +
                           "</style></head><body><main>",
                    foot =
                        "</main><script>" + source("templates/report/fit.js") + "fitFormulas();</script></body></html>";
  std::vector<std::string> models;
  for (const auto& entry : std::filesystem::directory_iterator(source_folder() + "/models")) {
    if (entry.path().extension() == ".toml") models.push_back(entry.path().stem().string());
  }
  std::sort(models.begin(), models.end());
  Json cases = Json::array();
  for (const std::string& model : models) {
    std::string body;
    const std::function<void(const Json&)> collect = [&](const Json& value) {
      if (value.is_object() && value.contains("mathml") && value["mathml"].is_string() &&
          value["mathml"].get<std::string>().size() < longest_formula)
        body += "<p class=\"formula\">" + value["mathml"].get<std::string>() + "</p>\n";
      if (value.is_structured()) std::for_each(value.begin(), value.end(), collect);
    };
    collect(document(folder, {"derive", model, "--show", "all"}));
    cases.push_back({{"name", model}, {"page", head + body + foot}});
  }
  std::size_t count = 0;
  for (const Json& found : inspect_pages(folder, *program, cases)) {
    CAPTURE(found.dump());
    REQUIRE_FALSE(found.contains("failed"));
    for (const std::string width : {"1280", "390"}) {
      const Json& at = found["widths"][width];
      CHECK(at["messages"] == Json::array());
      CHECK(at["sideways"] == 0);
      for (const char* fault : {"overlaps", "tight", "wide"}) CHECK(at["formulas"][fault][0] == 0);
      count += at["formulas"]["count"].get<std::size_t>();
    }
  }
  CHECK(count > 10000);
}

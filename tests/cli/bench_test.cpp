// SPDX-License-Identifier: GPL-3.0-or-later
// Command bench: errors are true errors, independent of the measured times.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "program.hpp"
#include "support/elliptic.hpp"

using namespace eomgen::test;

TEST_CASE("bench: an unknown solver is refused before the model is derived") {
  const Folder folder;
  // The motion of this model is given, so that its derivation ends with an error of its own.
  CHECK(contains(expect(2, folder, {"bench", "P10_rocket", "--solver", "dop583"}).err, "there is no solver 'dop583'"));
}

TEST_CASE("bench: the error of every solver decreases with its tolerance or step, and the document lists all") {
  const Folder folder;
  const Json found =
      document(folder, {"bench", "P2_planar_pendulum", "--t-end", "1", "--csv", "out.csv", "--svg", "out.svg"});
  CHECK(found["reference"]["digits"].get<int>() >= 30);
  for (const Json& left : found["left_out"]) {  // no solver of this program
    CHECK(contains(left["why"].get<std::string>(), "not installed"));
    CHECK((left["solver"] == "Odeint" || left["solver"] == "GSL" || left["solver"] == "SUNDIALS"));
  }
  CHECK(contains(found["advice"].get<std::string>(), "for 1e-12"));
  const Json listed = document(folder, {"list"});
  for (const Json& solver : listed["solvers"]) {
    const std::string name = solver["name"];
    if (solver["constrained"].get<bool>()) continue;  // this model has no constraint for it
    CAPTURE(name);
    std::vector<double> errors;
    for (const Json& row : found["rows"]) {
      if (row["solver"] != name) continue;
      REQUIRE(row["outcome"] == "done");
      CHECK(row["step"].is_null() == solver["adaptive"].get<bool>());
      CHECK(row["error_along"].get<double>() >= row["error"].get<double>());
      CHECK(row["seconds"].get<double>() > 0);
      // Within its long steps, the interpolation of radau only has the stage order.
      errors.push_back(row[name == "radau" ? "error" : "error_along"]);
    }
    REQUIRE(errors.size() >= 9);
    const double fall = errors.front() / errors.back();
    CHECK(fall > (solver["order"].get<int>() == 2 ? 1e4 : 1e7));  // nine step sizes, halved each time, at order 2: 4^8
    if (solver["adaptive"].get<bool>()) CHECK(errors.back() < 1e-10);
  }
  CHECK(contains(folder.read("out.svg"), "</svg>"));
  CHECK(contains(folder.read("out.csv"), "solver,rtol,step,error,error_along,seconds"));
}

TEST_CASE("bench: the error is the difference from the exact motion") {
  const Folder folder;
  const Json found = document(folder, {"bench", "P2_planar_pendulum", "--t-end", "2", "--solver", "dopri5"});
  const Json run = document(folder, {"run", "P2_planar_pendulum", "--t-end", "2", "--solver", "dopri5", "--rtol",
                                     "1e-5", "--atol", "1e-8", "--no-error-estimate"});
  const Json sharp = document(folder, {"run", "P2_planar_pendulum", "--t-end", "2", "--solver", "taylor", "--rtol",
                                       "1e-14", "--atol", "1e-15", "--no-error-estimate"});
  const double difference = std::abs(run["final"]["theta"].get<double>() - sharp["final"]["theta"].get<double>());
  REQUIRE(difference > 1e-9);
  int rows = 0;
  for (const Json& row : found["rows"]) {
    if (std::abs(row["rtol"].get<double>() / 1e-5 - 1) > 1e-9) continue;
    CHECK(row["errors"]["theta"].get<double>() == doctest::Approx(difference).epsilon(1e-3).scale(0));
    ++rows;
  }
  CHECK(rows == 1);
}

TEST_CASE("bench: other libraries reach the same motion with the same right-hand side, or are reported as missing") {
  const Folder folder;
  const Json found = document(folder, {"bench", "S5_double_pendulum", "--scene", "released", "--t-end", "1"});
  for (const auto& [library, names] : std::map<std::string, std::vector<std::string>>{
           {"Odeint", {"Odeint dopri5", "Odeint rkf78", "Odeint bulirsch_stoer"}},
           {"GSL", {"GSL rk8pd", "GSL msbdf"}},
           {"SUNDIALS", {"CVODE BDF", "CVODE Adams", "ARKODE ERK 8", "ARKODE DIRK 5", "IDA"}}}) {
    const bool is_missing = std::any_of(found["left_out"].begin(), found["left_out"].end(),
                                        [&name = library](const Json& left) { return left["solver"] == name; });
    for (const std::string& name : names) {
      CAPTURE(name);
      double least = 1, evaluations = 0;
      for (const Json& row : found["rows"]) {
        if (row["solver"] != name || row["outcome"] != "done") continue;
        least = std::min(least, row["error"].get<double>());
        evaluations = row["rhs_evaluations"];
      }
      CHECK((least < 1e-6) != is_missing);  // the most accurate run that finished; multistep methods lose some digits
      CHECK((evaluations > 50) != is_missing);
    }
  }
  const Json alone = document(folder, {"bench", "P2_planar_pendulum", "--t-end", "1", "--no-libraries"});
  for (const Json& row : alone["rows"]) CHECK_FALSE(contains(row["solver"].get<std::string>(), " "));
}

TEST_CASE("bench: scenes without reference solution and unknown solvers are reported") {
  const Folder folder;
  const auto refused = [&](const Words& words, const char* what) {
    const auto result = expect(2, folder, words);
    CHECK(contains(result.err, what));
    CHECK(contains(result.err, "remedy: "));
  };
  refused({"bench", "bouncing_ball"}, "contacts and friction");
  refused({"bench", "bilinear_oscillator"}, "crosses a kink");
  refused({"bench", "P2_planar_pendulum", "--solver", "rk5"}, "there is no solver 'rk5'");
}

namespace {

/// A particle of 1 kg on a line, with `more`.
std::string line_text(const std::string& more) {
  return "format = 1\n[coordinates]\nx = {}\n[[particle]]\nname = \"P\"\nmass = 1\nposition = [\"x\", 0, 0]\n" + more;
}

/// The reference of a scene. Runs by dop853 come as near to it as their tolerances.
Json reference(const Folder& folder, const std::string& text) {
  folder.write("resets.toml", text);
  const Json found = document(folder, {"bench", "resets.toml", "--solver", "dop853"});
  double least = 1;
  for (const Json& row : found["rows"]) {
    REQUIRE(row["outcome"] == "done");
    least = std::min(least, row["error_along"].get<double>());
  }
  CHECK(least < 1e-10);
  CHECK(found["reference"]["digits_at_end"].get<int>() >= 20);
  return found["reference"]["end"];
}

constexpr double rounding = 1e-14;  // of the closed forms in long double, and of the end in binary64

}  // namespace

// x = 1 - 5 t^2 between bounces at speeds v, e v, e^2 v, ..
TEST_CASE("bench: the reference has resets at events, at the times of the closed form") {
  const Folder folder;
  const Json end = reference(folder, line_text("[[force]]\ngravity = \"-10*E1\"\n[discrete]\nbounces = 0\n"
                                               "[[event]]\nname = \"bounce\"\nwhen = \"x\"\ndirection = \"down\"\n"
                                               "set = { x_dot = \"-x_dot*4/5\", bounces = \"bounces + 1\" }\n"
                                               "[scene.default]\ninitial = { x = 1 }\nt = [0, 2]\n"));
  long double v = std::sqrt(20.0L), t = std::sqrt(0.2L);
  int bounces = 0;
  for (; t < 2; ++bounces) {
    v *= 4.0L / 5;
    if (t + v / 5 > 2) break;
    t += v / 5;
  }
  const long double s = 2 - t;
  CHECK(end["bounces"].get<int>() == bounces + 1);
  CHECK(std::abs(end["x"].get<double>() - static_cast<double>(v * s - 5 * s * s)) < rounding);
  CHECK(std::abs(end["x_dot"].get<double>() - static_cast<double>(v - 10 * s)) < rounding);
}

// x'' = u between samples, from the start on; a limit of u is an event that samples cause.
TEST_CASE("bench: the reference has samples, and events that they cause") {
  const Folder folder;
  const Json end =
      reference(folder, line_text("[[force]]\non = \"P\"\nforce = \"u*E1\"\n[discrete]\nu = 0\n"
                                  "[[sample]]\nname = \"c\"\nevery = 0.125\nset = { u = \"-8*x - 3*x_dot\" }\n"
                                  "[[event]]\nname = \"limit\"\nwhen = \"u + 3\"\ndirection = \"down\"\n"
                                  "set = { u = -2 }\n[scene.default]\ninitial = { x = 1 }\nt = [0, 2]\n"));
  long double x = 1, v = 0, u = 0;
  const long double h = 0.125L;
  for (int k = 0; k < 16; ++k) {
    const long double before = u;
    u = -8 * x - 3 * v;
    if (before > -3 && u < -3) u = -2;
    x += v * h + u * h * h / 2;
    v += u * h;
  }
  CHECK(std::abs(end["x"].get<double>() - static_cast<double>(x)) < rounding);
  CHECK(std::abs(end["x_dot"].get<double>() - static_cast<double>(v)) < rounding);
}

TEST_CASE("bench: resets of a model with constraints keep them, as in a run; what has no order is refused") {
  const Folder folder;
  const std::string pendulum =
      "format = 1\n[coordinates]\nx = {}\ny = {}\n[[particle]]\nname = \"P\"\nmass = 1\n"
      "position = [\"x\", \"y\", 0]\n[[force]]\ngravity = \"-10*E2\"\n"
      "[[constraint]]\nname = \"rod\"\nholonomic = \"x^2 + y^2 - 1\"\n"
      "[[event]]\nname = \"struck\"\nwhen = \"x - 0.3\"\ndirection = \"up\"\nset = { SET }\n"
      "[scene.default]\ninitial = { x = 0, y = -1, x_dot = 1 }\nt = [0, 3]\n";
  const auto with = [&](const char* set) {
    std::string text = pendulum;
    return text.replace(text.find("SET"), 3, set);
  };
  const Json end = reference(folder, with("x_dot = \"x_dot + 0.5\""));
  const Json run = document(folder, {"run", "resets.toml", "--rtol", "1e-13", "--atol", "1e-13"});
  for (const char* name : {"x", "y", "x_dot", "y_dot"})
    CHECK(std::abs(end[name].get<double>() - run["final"][name].get<double>()) < 1e-10);
  folder.write("resets.toml", with("x = \"-x\", x_dot = \"-x_dot\""));
  const ChildResult moved = expect(2, folder, {"bench", "resets.toml", "--solver", "dop853"});
  CHECK(contains(moved.err, "'struck' moves coordinates that are subject to constraints"));
  // The event occurs at the end of the run.
  folder.write("resets.toml", line_text(""
                                        "[[event]]\nname = \"there\"\nwhen = \"t - 2\"\nset = { x_dot = 2 }\n"
                                        "[scene.default]\ninitial = { x = 1 }\nt = [0, 2]\n"));
  const ChildResult order = expect(2, folder, {"bench", "resets.toml", "--solver", "dop853"});
  CHECK(contains(order.err, "too close to the end or to another change"));
}

// The motion crosses y = 0 ahead of the cut of atan2, where nothing bends; the other one crosses the cut.
TEST_CASE("bench: a surface at which the equations are smooth has a reference, the cut of atan2 has none") {
  const Folder folder;
  const auto text = [](const char* x) {
    return "format = 1\n[coordinates]\nx = {}\ny = {}\n[[particle]]\nname = \"P\"\nmass = 1\n"
           "position = [\"x\", \"y\", 0]\n[[force]]\non = \"P\"\nforce = \"-atan2(y, x)*E2\"\n"
           "[scene.default]\nt = [0, 2]\ninitial = { y = 0.3, y_dot = -0.4, x = " +
           std::string(x) + " }\n";
  };
  reference(folder, text("1"));
  folder.write("resets.toml", text("-1"));
  const ChildResult cut = expect(2, folder, {"bench", "resets.toml", "--solver", "dop853"});
  CHECK(contains(cut.err, "crosses a kink"));
}

TEST_CASE("bench: the reference has the impulses and kinks in time of the run") {
  const Folder folder;
  const std::string pendulum =
      "format = 1\n[parameters]\nm = 1\ng = 9.81\n[coordinates]\nth = \"1\"\n[functions]\ns = "
      "\"SUPPORT\"\n[[particle]]\n"
      "name = \"P\"\nmass = \"m\"\nposition = [\"s + sin(th)\", \"-cos(th)\", 0]\n[[force]]\ngravity = \"-g*E2\"\n"
      "[scene.default]\nt = [0, 3]\ninitial = { th = 0.4 }\n";
  for (const char* support : {"0.3*abs(t - 1)", "0.3*abs(sin(2*t))", "0.3*abs(t - 1)^3", "0.3*abs(t - 3)"}) {
    CAPTURE(support);
    std::string text = pendulum;
    folder.write("support.toml", text.replace(text.find("SUPPORT"), 7, support));
    const Json found = document(folder, {"bench", "support.toml", "--no-libraries"});
    CHECK(found["reference"]["digits_at_end"].get<int>() >= 12);
    const Json run =
        document(folder, {"run", "support.toml", "--solver", "taylor", "--rtol", "1e-13", "--atol", "1e-15"});
    for (const char* name : {"th", "th_dot"})
      CHECK(std::abs(found["reference"]["end"][name].get<double>() - run["final"][name].get<double>()) < 1e-11);
    std::map<std::string, double> least;
    for (const Json& row : found["rows"]) {
      REQUIRE(row["outcome"] == "done");
      const auto at = least.emplace(row["solver"], 1).first;
      at->second = std::min(at->second, row["error_along"].get<double>());
    }
    for (const auto& [solver, error] : least) {
      CAPTURE(solver);
      CHECK(error < (solver == "midpoint" || solver == "variational2" ? 1e-3 : 1e-5));
    }
    CHECK(least.at("dop853") < 1e-10);
  }
}

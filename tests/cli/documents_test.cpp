// SPDX-License-Identifier: GPL-3.0-or-later
// JSON documents of all commands: documented keys, the schemas of docs/schema, correct values.
#include <doctest/doctest.h>

#include <cstdlib>

#include "program.hpp"

using namespace eomgen::test;

namespace {

void has_keys(const Json& document, const Words& keys) {
  for (const std::string& key : keys) {
    CAPTURE(key);
    CHECK(document.contains(key));
  }
}

const Words models{"P7_moving_sphere", "P2_planar_pendulum", "S5_double_pendulum_cartesian", "cart_pendulum",
                   "G1_spherical"};

}  // namespace

TEST_CASE("list: the document contains the registries, and the readable output has the same names") {
  const Folder folder;
  const Json all = document(folder, {"list"});
  has_keys(all, {"coordinates", "rotations", "joints", "couplings", "forces", "solvers", "targets"});
  const std::string readable = expect(0, folder, {"list"}).out;
  for (const char* key : {"coordinates", "solvers", "targets", "formulations"}) {
    CHECK_FALSE(all[key].empty());
    for (const Json& entry : all[key]) CHECK(contains(readable, "  " + entry["name"].get<std::string>() + " "));
  }
  CHECK_FALSE(contains(readable, "{"));
}

TEST_CASE("check: the documents of all models") {
  const Folder folder;
  for (const std::string& model : models) {
    CAPTURE(model);
    const Json found = document(folder, {"check", model});
    has_keys(found, {"coordinates", "dof", "parameters", "constraints", "forces", "conserved", "singular", "units",
                     "warnings"});
    CHECK_FALSE(contains(expect(0, folder, {"check", model}).out, "{"));
  }
  const Json sphere = document(folder, {"check", "P7_moving_sphere"});
  CHECK(sphere["dof"] == 2);
  REQUIRE(sphere["coordinates"].size() == 3);
  CHECK(sphere["coordinates"][0]["name"] == "R");
  CHECK(sphere["coordinates"][0]["eliminated"] == true);
  CHECK(sphere["parameters"][1]["value"] == "9.81");
  REQUIRE(sphere["forces"].size() == 2);
  CHECK(sphere["forces"][0]["conservative"] == "yes");
  CHECK(sphere["forces"][0]["potential"] == "m g R cos(phi)");
  CHECK(sphere["forces"][1]["conservative"] == "no");
  CHECK(sphere["forces"][1]["potential"].is_null());
  CHECK(sphere["constraints"][0]["integrable"] == "yes");
  // Each set once, with the approaches that fail there. R is no coordinate of approach II, d(t) none of approach I.
  for (const Json& one : sphere["singular"]) {
    CHECK(std::count_if(sphere["singular"].begin(), sphere["singular"].end(),
                        [&](const Json& s) { return s["set"] == one["set"]; }) == 1);
  }
}

TEST_CASE("derive: one key per kind of formula, in three formats") {
  const Folder folder;
  for (const std::string& model : models) {
    CAPTURE(model);
    for (const char* approach : {"I", "II"}) {
      const Json shown = document(folder, {"derive", model, "--approach", approach, "--show", "all"});
      has_keys(shown, {"approach", "equations", "reactions", "energies", "lagrangian"});
      CHECK(shown["approach"] == approach);
      CHECK_FALSE(shown["equations"].empty());
    }
  }
  for (const char* key : {"kinematics", "regressor", "basis", "metric", "christoffel", "line_element", "energies",
                          "lagrangian", "constraints", "singular", "solved", "contravariant"}) {
    CAPTURE(key);
    const Json shown = document(folder, {"derive", "P7_moving_sphere", "--show", key});
    has_keys(shown, {key, "equations", "reactions"});
    CHECK_FALSE(shown[key].empty());
  }
  const Words words{"derive", "P7_moving_sphere", "--approach", "I", "--format"};
  const auto in_format = [&](const char* format) {
    Words all = words;
    all.emplace_back(format);
    return expect(0, folder, all).out;
  };
  CHECK(contains(in_format("text"), "lambda = m d_ddot - m d (phi_dot^2 + sin^2(phi) theta_dot^2) + m g cos(phi)"));
  CHECK(contains(in_format("latex"), "\\dot{\\theta}"));
  CHECK(contains(in_format("mathml"), "<math"));
}

TEST_CASE("derive: an item of which the model has none is named, and --about needs a scene that is an equilibrium") {
  const Folder folder;
  CHECK(contains(expect(0, folder, {"derive", "S1_two_masses", "--show", "singular"}).out, "singular\n  none\n"));
  CHECK_FALSE(contains(expect(0, folder, {"derive", "S1_two_masses"}).out, "none"));
  const auto about = [&](int status, const char* scene) {
    return expect(status, folder, {"derive", "cart_pendulum", "--show", "linear", "--about", scene});
  };
  CHECK(contains(about(2, "no_scene").err, "there is no scene 'no_scene'"));
  CHECK(contains(expect(2, folder, {"derive", "cart_pendulum", "--about", "default"}).err, "add --show linear"));
}

TEST_CASE("derive --document: writes the derivation as LaTeX, with the same bytes as emit --target latex") {
  const Folder folder;
  CHECK(contains(expect(0, folder, {"derive", "P9_paraboloid", "--document", "paper.tex"}).out, "wrote paper.tex"));
  const std::string text = folder.read("paper.tex");
  for (const char* part :
       {"\\section{System}", "Approach II: constraints that fix a coordinate are built in",
        "\\section{Constraint forces}", "$\\theta$ is cyclic", "p_{\\theta} = m c^{2} u^{2} \\dot{\\theta}",
        "\\section{Routh's reduction}", "\\mathcal{R} = ", "\\textbf{steady motion}: ", "\\emph{stable}: ",
        "\\section{Where the equations fail}", "\\section{Certificate}", "pass at 5 random states in 50 digits"}) {
    CAPTURE(part);
    CHECK(contains(text, part));
  }
  expect(0, folder, {"emit", "P9_paraboloid", "--target", "latex", "-o", "out"});
  CHECK(folder.read("out/P9_paraboloid.tex") == text);
  CHECK(document(folder, {"derive", "P9_paraboloid", "--document", "paper.tex"})["document"] == "paper.tex");
  // The document goes to standard output, and the equations then to standard error.
  const ChildResult both = expect(0, folder, {"derive", "P9_paraboloid", "--document", "-"});
  CHECK(both.out == text);
  CHECK(contains(both.err, "Approach I\n"));
}

TEST_CASE("derive --document --omit: leaves parts out, and lists them") {
  const Folder folder;
  expect(0, folder, {"derive", "knife_edge", "--document", "whole.tex"});
  const std::string whole = folder.read("whole.tex");
  CHECK(contains(whole, "Its time derivative:"));
  expect(0, folder,
         {"derive", "knife_edge", "--document", "short.tex", "--omit", "constraint_derivatives,energy_derivatives"});
  const std::string brief = folder.read("short.tex");
  CHECK_FALSE(contains(brief, "Its time derivative:"));
  CHECK_FALSE(contains(brief, "Of the energies above:"));
  CHECK(contains(brief, "time derivatives of the constraints: omitted on request."));
  CHECK(contains(brief, "\\section{Conserved quantities}"));
  expect(0, folder,
         {"emit", "knife_edge", "--target", "latex", "-o", "out", "--omit",
          "constraint_forces,conserved,routh,steady,singular"});
  const std::string other = folder.read("out/knife_edge.tex");
  CHECK(contains(other, "Its time derivative:"));
  for (const char* part : {"Constraint forces", "Conserved quantities", "Routh's reduction",
                           "Equilibria and steady motions", "Where the equations fail"}) {
    CAPTURE(part);
    CHECK_FALSE(contains(other, std::string("\\section{") + part));
  }
  const std::string wrong =
      expect(2, folder, {"derive", "knife_edge", "--document", "short.tex", "--omit", "constraint_derivative"}).err;
  CHECK(contains(wrong, "a document has no part 'constraint_derivative' that can be omitted"));
  CHECK(contains(wrong, "did you mean 'constraint_derivatives'?"));
  CHECK(contains(expect(2, folder, {"derive", "knife_edge", "--omit", "routh"}).err, "add --document F.tex"));
  CHECK(contains(expect(2, folder, {"emit", "knife_edge", "-o", "out", "--omit", "routh"}).err, "--target latex"));
}

TEST_CASE("derive --document: invalid paths are refused before any work") {
  const Folder folder;
  folder.write("m.toml", pendulum_text("[scene.default]\nt = [0, 1]\ninitial = { x = 1, y = 0 }\n"));
  CHECK(contains(expect(2, folder, {"derive", "m.toml", "--document", "paper.pdf"}).err, "--document"));
  CHECK(contains(expect(2, folder, {"derive", "m.toml", "--document", "m.toml"}).err, "--document"));
  CHECK(contains(expect(2, folder, {"derive", "m.toml", "--document", "there_is_no/paper.tex"}).err, "--document"));
  CHECK(contains(expect(2, folder, {"derive", "m.toml", "--document", "-", "--json"}).err, "--document"));
  CHECK_FALSE(folder.has("paper.pdf"));
}

TEST_CASE(
    "the document of hostile texts, of a prescribed motion, and of a model without search of equilibria states it and "
    "compiles") {
  const Folder folder;
  folder.write("hostile.toml", R"(format = 1
title = 'a\input{/etc/passwd}$x$ & 100% #1 _b^c~'
notes = '\end{document} {{{ }'
[parameters]
k = { value = "1 N/m", note = '\write18{id} & % $' }
[coordinates]
write18 = "m"
[[particle]]
name = "the_end"
mass = "1 kg"
position = "write18*E1"
[[force]]
name = "csname_x"
on = "the_end"
force = "-k*write18*E1"
)");
  expect(0, folder, {"derive", "hostile.toml", "--document", "hostile.tex"});
  const std::string hostile = folder.read("hostile.tex");
  for (const char* command : {"\\input", "\\write", "\\csname"}) CHECK_FALSE(contains(hostile, command));
  CHECK(contains(hostile, "\\textbf{equilibrium}: $\\mathrm{write}_{18}$~$= 0$. \\emph{stable}"));
  expect(0, folder, {"derive", "P10_rocket", "--document", "rocket.tex"});
  CHECK(contains(folder.read("rocket.tex"), "the constraints prescribe the motion"));
  expect(0, folder, {"derive", "S6_chain_6", "--document", "chain.tex"});
  CHECK(contains(folder.read("chain.tex"), "eomgen equilibria makes it"));
  if (std::system("command -v pdflatex > /dev/null 2>&1") != 0) {
    MESSAGE("pdflatex is not installed: skipped");
    return;
  }
  for (const char* name : {"hostile", "rocket", "chain"}) {
    CAPTURE(name);
    const std::string command =
        "cd '" + folder.path() +
        "' && max_print_line=1000 pdflatex -no-shell-escape -interaction=nonstopmode -halt-on-error " + name +
        ".tex > out.txt 2>&1";
    CHECK(std::system(command.c_str()) == 0);
    CHECK_FALSE(contains(folder.read("out.txt"), "Overfull \\hbox"));
  }
}

TEST_CASE("derive: headings describe the formulas, and a legend explains the multipliers") {
  const Folder folder;
  const std::string disk =
      expect(0, folder, {"derive", "R6_rolling_disk", "--show", "constraints,equations,reactions,singular"}).out;
  for (const char* heading :
       {"\nconstraint 'contact.1', binds velocities, not integrable\n",
        "\nconstraint 'contact.3', its first time derivative\n", "\nequations of motion\n  d/dt(m x1_dot)",
        "\nequations of motion, written out\n", "\nconstraint force on 'disk'\n", "\nwhere both approaches fail\n",
        "\nmeaning of the multipliers\n  lambda_1: of the constraint 'contact.1'\n"}) {
    CAPTURE(heading);
    CHECK(contains(disk, heading));
  }
  const std::string sphere = expect(0, folder, {"derive", "P7_moving_sphere"}).out;
  CHECK(contains(sphere, "\nfunctions of time\n  d = "));
  CHECK(contains(sphere, "\nequations that give the constraint forces\n"));
  CHECK_FALSE(contains(sphere, "which multiplier"));
  // Bouncing: equations of leaving the floor are not friction.
  const std::string ball = expect(0, folder, {"derive", "bouncing_ball"}).out;
  CHECK(contains(ball, "\nfriction at 'floor', slides\n"));
  CHECK(contains(ball, "\ncontact 'floor', impact\n"));
  const Json pin = document(folder, {"derive", "R15_pin_joint", "--show", "reactions"});
  REQUIRE(pin["multipliers"].size() == 5);
  CHECK(pin["multipliers"][4]["name"] == "lambda_pin_M2");
  CHECK(pin["multipliers"][4]["latex"] == "\\lambda_{\\mathrm{pin},\\mathrm{M2}}");
  // In approach II, eliminated constraints have no multipliers.
  CHECK(document(folder, {"derive", "P8_smooth_helix", "--approach", "II"})["multipliers"].empty());
  CHECK(document(folder, {"derive", "P8_smooth_helix", "--approach", "I"})["multipliers"].size() == 2);
}

TEST_CASE("derive: a result that does not apply is an empty list, not a missing key") {
  const Folder folder;
  for (const char* key :
       {"basis", "metric", "christoffel", "line_element", "constraints", "conserved", "reactions", "singular"}) {
    CAPTURE(key);
    has_keys(document(folder, {"derive", "cart_pendulum", "--show", key}), {key});
  }
}

TEST_CASE("verify: formulations with the code they share, and a verdict") {
  const Folder folder;
  for (const char* model : {"P7_moving_sphere", "S5_double_pendulum_cartesian"}) {
    CAPTURE(model);
    const Json certificate = document(folder, {"verify", model, "--points", "5"});
    has_keys(certificate, {"formulations", "points", "rejected", "verdict"});
    CHECK(certificate["verdict"] == "pass");
    CHECK(certificate["points"] == 5);
    std::size_t independent = 0, emitted = 0;
    for (const Json& row : certificate["formulations"]) {
      independent += row["shares_code"] == false ? 1 : 0;
      emitted += row["a"] == "emitted code" ? 1 : 0;
    }
    CHECK(independent >= 6);
    CHECK(emitted == 1);
  }
  const std::string readable = expect(0, folder, {"verify", "P7_moving_sphere", "--points", "2", "--no-compile"}).out;
  CHECK_FALSE(contains(readable, "{"));
  CHECK_FALSE(contains(readable, "emitted code"));
  // Comparisons without shared code come first.
  CHECK(readable.find("they share code") > readable.rfind("display form II "));
}

TEST_CASE("emit: the files exist; the operation counts are those of the chosen formulation") {
  const Folder folder;
  const Json emitted = document(folder, {"emit", "P7_moving_sphere", "-o", "out"});
  has_keys(emitted, {"files", "formulation", "tried", "operations", "seconds"});
  CHECK(emitted["files"] == Json({"out/P7_moving_sphere.hpp", "out/P7_moving_sphere.c", "out/P7_moving_sphere.h"}));
  for (const Json& file : emitted["files"]) CHECK(folder.has(file));
  bool among = false;
  for (const Json& tried : emitted["tried"])
    among = among || (tried["formulation"] == emitted["formulation"] && tried["operations"] == emitted["operations"]);
  CHECK(among);
  const Json paper = document(folder, {"emit", "P7_moving_sphere", "-o", "paper", "--target", "latex"});
  CHECK(paper["files"] == Json({"paper/P7_moving_sphere.tex"}));
  CHECK(contains(folder.read("paper/P7_moving_sphere.tex"), "\\documentclass"));
  CHECK(contains(expect(0, folder, {"emit", "P7_moving_sphere", "-o", "out"}).out, "wrote out/P7_moving_sphere.hpp"));
}

TEST_CASE("run: the document reports method, time and accuracy") {
  const Folder folder;
  for (const std::string& model : models) {
    CAPTURE(model);
    const Json run = document(folder, {"run", model, "--t-end", "2"});
    has_keys(run, {"solver", "outcome", "steps", "rejected", "rhs_evaluations", "seconds", "final", "error_estimate",
                   "invariants", "power_balance", "constraint_drift", "events", "solver_reason"});
    CHECK(run["outcome"] == "done");
    CHECK(run["error_estimate"]["max"].get<double>() > 0);
    CHECK(run["error_estimate"]["max"].get<double>() < 1e-3);
    CHECK(run["power_balance"].get<double>() < 1e-6);
    has_keys(run["final"], {"energy"});
  }
  const Json without = document(folder, {"run", "P2_planar_pendulum", "--no-error-estimate"});
  CHECK_FALSE(without.contains("error_estimate"));
  CHECK(without["constraint_drift"].is_null());  // both constraints are eliminated
  CHECK(document(folder, {"run", "S5_double_pendulum_cartesian"})["constraint_drift"].get<double>() < 1e-10);
}

TEST_CASE("run: the readable report has the same contents") {
  const Folder folder;
  const ChildResult run = expect(0, folder, {"run", "S5_double_pendulum_cartesian", "--t-end", "1"});
  CHECK(run.err.empty());
  for (const char* word : {"solver            dop853 (rtol is 1e-4 or below", "outcome           done at t = 1\n",
                           "error estimate    ", "invariant         energy = ", "power balance     ",
                           "constraints       |psi| at most ", "seconds           derive "}) {
    CAPTURE(word);
    CHECK(contains(run.out, word));
  }
  CHECK_FALSE(contains(run.out, "{"));
  CHECK_FALSE(contains(run.out, "0.20000000000000001"));
  CHECK_FALSE(contains(expect(0, folder, {"run", "P2_planar_pendulum", "--t-end", "1", "--no-error-estimate"}).out,
                       "error estimate"));
}

TEST_CASE("derive: geometry of several particles names the particle, or the configuration manifold") {
  const Folder folder;
  const std::string text = expect(0, folder, {"derive", "--show", "basis,metric,line_element", "S4_two_particles"}).out;
  for (const char* heading : {"basis: covariant of 'P1'", "basis: contravariant of 'P2'", "metric: determinant of 'P2'",
                              "line_element of 'P1'", "metric: covariant of the configuration manifold",
                              "basis: covariant basis of E^6 (e_1 to e_3: 'P1'"}) {
    CAPTURE(heading);
    CHECK(contains(text, std::string("\n") + heading));
  }
}

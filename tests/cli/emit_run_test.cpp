// SPDX-License-Identifier: GPL-3.0-or-later
// emit --with run: a default scene that emitted code can run with the runtime, or the reason why not.
#include <doctest/doctest.h>

#include "program.hpp"

using namespace eomgen::test;

namespace {

/// x'' = F/m, with `more` appended to the model.
std::string particle(const std::string& scene, const std::string& more = "") {
  return "format = 1\n[parameters]\nm = \"1 kg\"\n[inputs]\nF = { unit = \"N\", default = 0 }\n[[particle]]\nname = "
         "\"P\"\nmass = \"m\"\n"
         "position = [\"x\", 0, 0]\n[coordinates]\nx = \"m\"\n[[force]]\non = \"P\"\nforce = \"F*E1\"\n" +
         more + "[scene.default]\nt = [0, 1]\ninitial = { x = 1 }\n" + scene;
}

std::string pendulum(const std::string& solver) {
  return pendulum_text("[scene.default]\nt = [0, 1]\ninitial = { x = 0.6, y = -0.8 }\nsolver = \"" + solver + "\"\n");
}

struct EmittedCase {
  const char* what;
  std::string text;
  std::vector<std::string> expected_parts;
};

/// The run is refused with these words and nothing is written. Without the run, the model is emitted.
void check_refusal(const EmittedCase& c) {
  CAPTURE(std::string(c.what));
  const Folder folder;
  folder.write("model.toml", c.text);
  const ChildResult refused = expect(2, folder, {"emit", "model.toml", "-o", "code", "--with", "run"});
  for (const std::string& part : c.expected_parts) {
    CAPTURE(part);
    CHECK(contains(refused.err, part));
  }
  CHECK_FALSE(folder.has("code"));
  expect(0, folder, {"emit", "model.toml", "-o", "code"});
}

}  // namespace

TEST_CASE("emit --with run: a solver of the default scene that is ineligible for the model is refused") {
  const std::string clipped = "[[force]]\non = \"P\"\nforce = \"-max(x, 0)*1[N/m]*E1\"\n";
  const std::vector<EmittedCase> cases{
      {"no constraints",
       particle("solver = \"ggl\"\n"),
       {"solver 'ggl' cannot integrate this model", "no constraints with multipliers", "dop853 or auto"}},
      {"kinks",
       particle("solver = \"variational4\"\nstep = 0.01\n", clipped),
       {"solver 'variational4' cannot integrate this model", "the equations have kinks"}},
      {"moving inputs",
       particle("solver = \"taylor\"\ninputs = { F = \"3*sin(2*t)\" }\n"),
       {"solver 'taylor' cannot integrate this scene", "an input varies continuously with t"}}};
  for (const EmittedCase& c : cases) check_refusal(c);
}

TEST_CASE("emit --with run: an eligible solver adds the functions that it needs") {
  struct Needs {
    const char *solver, *function;
  };
  for (const Needs& needs : {Needs{"ggl", "jac"}, {"taylor", "taylor"}, {"radau5", "jac"}, {"dop853", nullptr}}) {
    CAPTURE(std::string(needs.solver));
    const Folder folder;
    folder.write("model.toml", pendulum(needs.solver));
    expect(0, folder, {"emit", "model.toml", "-o", ".", "--target", "c", "--with", "run"});
    const std::string header = folder.read("model_run.hpp");
    CHECK(contains(header, "problem.solver = \"" + std::string(needs.solver) + "\";"));
    for (const std::string function : {"jac", "taylor"}) {
      CAPTURE(function);
      const bool wanted = needs.function != nullptr && function == needs.function;
      CHECK(contains(header, "code." + function + " = model_" + function + ";") == wanted);
    }
  }
}

// As in `run`: where steps are shorter than the interval, more rows follow.
TEST_CASE("emit --with run: rows follow short steps, unless the scene gives their interval or the step") {
  const Folder folder;
  for (const auto& [scene, follow] :
       {std::pair{"", true}, {"every = 0.1\n", false}, {"solver = \"rk4\"\nstep = 0.01\n", false}}) {
    CAPTURE(std::string(scene));
    folder.write("model.toml", particle(scene));
    expect(0, folder, {"emit", "model.toml", "-o", ".", "--target", "c", "--with", "run"});
    CHECK(contains(folder.read("model_run.hpp"), "problem.row_subdivisions = 32;") == follow);
  }
}

TEST_CASE("emit --with run: requested outputs come first, in their order, and the columns of the run remain") {
  const Folder folder;
  folder.write("model.toml", particle("outputs = [\"P.velocity1\"]\n"));
  expect(0, folder,
         {"emit", "model.toml", "-o", ".", "--target", "c", "--with", "run", "--output", "potential,kinetic,energy"});
  std::string code = folder.read("model.c");
  for (std::size_t at = 0; (at = code.find("\"\n", at)) != std::string::npos;)  // joined lines of one literal
    code.erase(at, code.find('"', at + 1) + 1 - at);
  CHECK(contains(code, R"(\"outputs\":[\"potential\",\"kinetic\",\"energy\",\"x\",\"x_dot\")"));
  CHECK(contains(folder.read("model_run.hpp"), "return {3, 4, 6};"));
}

TEST_CASE("emit --with run: targets that do not write C report that there is no header of the run") {
  const Folder folder;
  folder.write("model.toml", particle(""));
  for (const char* target : {"javascript", "cuda", "rust", "octave", "julia", "modelica"})
    CHECK(contains(expect(0, folder, {"emit", "model.toml", "-o", target, "--target", target, "--with", "run"}).err,
                   "the target " + std::string(target) + " has no header of a run"));
  for (const char* target : {"cpp", "batch", "python"})
    CHECK_FALSE(contains(
        expect(0, folder, {"emit", "model.toml", "-o", target, "--target", target, "--with", "run"}).err, "warning"));
}

TEST_CASE("emit --with run: inputs are tables with jumps, or expressions as tables of operations") {
  const Folder folder;
  const auto header_of = [&](const std::string& inputs) {
    folder.write("model.toml", particle("inputs = { F = " + inputs + " }\n"));
    expect(0, folder, {"emit", "model.toml", "-o", ".", "--target", "c", "--with", "run"});
    return folder.read("model_run.hpp");
  };
  CHECK(contains(header_of("{ t = [0, 0.7], value = [5, -3] }"),
                 "problem.inputs = {{{}, {0.0, 0.7}, {5.0, -3.0}, {}}};"));
  CHECK(
      contains(header_of("\"m*sin(t*1[1/s])*1[N/kg]\""),
               "problem.inputs = {{{}, {}, {}, {{{Op::variable, {0}}, {Op::parameter, {0}}, {Op::sin, {0}}, {Op::mul"));
}

TEST_CASE("targets that integrate refuse kinks in time at which velocities jump") {
  const Folder folder;
  const auto write = [&](const std::string& s) {
    folder.write("kink.toml", "format = 1\n[[particle]]\nname = \"P\"\nmass = 1\nposition = [\"" + s +
                                  " + sin(th)\", \"-cos(th)\", 0]\n[coordinates]\nth = {}\n[[force]]\ngravity = "
                                  "\"-9.81*E2\"\n[scene.default]\nt = [0, 4.3]\ninitial = { th = 0.4 }\n");
  };
  write("0.3*abs(t-1)");
  // Every target refuses such a model, or reports that its functions have no impulses. `fmu` has the runtime within,
  // and `latex` no functions.
  const auto warned = [&](const Words& further) {
    Words words{"emit", "kink.toml", "-o", "."};
    words.insert(words.end(), further.begin(), further.end());
    return contains(expect(0, folder, words).err, "have no impulses");
  };
  const Json registries = document(folder, {"list"});
  for (const Json& target : registries["targets"]) {
    const std::string name = target["name"];
    CAPTURE(name);
    if (name == "fmu" || name == "latex") continue;
    const bool integrates = name == "modelica" || name == "cuda";
    if (integrates)
      CHECK(contains(expect(2, folder, {"emit", "kink.toml", "--target", name, "-o", "."}).err, "kink in time"));
    else
      CHECK(warned({"--target", name}));
  }
  CHECK(contains(folder.read("kink.jl"), "impulses    none here"));
  CHECK(!warned({"--target", "cpp", "--with", "run"}));
  const bool has_python = run_child({{"sh", "-c", "python3 -c 'import ctypes'"}, folder.path()}).status == 0;
  if (!has_python) MESSAGE("skipped in part: there is no python3");
  const auto simulated = [&] {
    expect(0, folder, {"emit", "kink.toml", "--target", "python", "-o", "."});
    return run_child({{"python3", "-B", "-c", "import kink\nprint(kink.simulate(4.3).outcome)"}, folder.path()});
  };
  if (has_python) CHECK(contains(simulated().err, "simulate has no impulses: use run"));
  // A kink in the place of a force gives no impulse.
  write("0.3*sin(t)");
  folder.write("kink.toml", folder.read("kink.toml") + "[[force]]\non = \"P\"\nforce = \"abs(t - 1)*E1\"\n");
  expect(0, folder, {"emit", "kink.toml", "--target", "modelica", "-o", "."});
  CHECK(!warned({"--target", "c"}));
  if (has_python) CHECK(contains(simulated().out, "done"));
}

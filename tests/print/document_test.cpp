// SPDX-License-Identifier: GPL-3.0-or-later
// The LaTeX document: user text never acts as LaTeX, and the document compiles if LaTeX is installed.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "print/article.hpp"
#include "print/latex_writer.hpp"
#include "print/render.hpp"
#include "support/folders.hpp"

using namespace eomgen;
namespace fs = std::filesystem;

namespace {

std::string document(const model::Model& model) {
  const mechanics::Mechanics m = mechanics::build_mechanics(model);
  return print::latex_document(m, reading::derive_display_form(m, system::Approach::one),
                               reading::derive_display_form(m, system::Approach::two));
}

model::Model hostile() {
  return model::read_model_text(R"(format = 1
title = 'wwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwwww a\input{/etc/passwd}$x$ & 100% #1 _b^c~ "quoted" \write18{touch here} 日本'
notes = '''\end{document} {{{ }'''
[parameters]
input = { value = "1 kg", note = '\immediate\write18{id} & % $' }
end_document = "2 m"
csname = 3
[coordinates]
write18 = "m"
[[particle]]
name = "P_end"
mass = "input"
position = "write18*E1"
[[force]]
on = "P_end"
force = "-csname*write18*E1"
[[constraint]]
name = "the_end"
holonomic = "write18 - end_document"
)",
                                "hostile");
}

bool compiles(const std::string& text, const std::string& name) {
  const fs::path folder = fs::path(test::build_folder()) / "print_test" / name;
  fs::create_directories(folder);
  std::ofstream(folder / "document.tex") << text;
  const std::string command =
      "cd '" + folder.string() +
      "' && pdflatex -no-shell-escape -interaction=nonstopmode -halt-on-error document.tex > out.txt 2>&1";
  return std::system(command.c_str()) == 0 && fs::exists(folder / "document.pdf");
}

}  // namespace

TEST_CASE("hostile names and texts are printed literally") {
  const std::string text = document(hostile());
  const std::string body = text.substr(text.find("\\begin{document}") + 16);
  for (const char* command : {"\\input", "\\write", "\\immediate", "\\csname", "\\catcode"}) {
    CAPTURE(command);
    CHECK(body.find(command) == std::string::npos);
  }
  CHECK(body.find("\\end{document}") == body.size() - 15);  // the one at the end
  CHECK(body.find("\\mathrm{write}_{18}") != std::string::npos);
}

TEST_CASE("the document shows both approaches side by side, and the constraint force") {
  const std::string text = document(model::read_model(test::source_folder() + "/models/P7_moving_sphere.toml"));
  CHECK(text.find("Approach I}") != std::string::npos);
  CHECK(text.find("Approach II}") != std::string::npos);
  CHECK(text.find("& \\lambda = m \\ddot{d}") != std::string::npos);
  CHECK(text.find("$9.81$ & $\\mathrm{m/s^{2}}$") != std::string::npos);
}

namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

std::string shipped(const std::string& name) {
  return document(model::read_model(test::source_folder() + "/models/" + name + ".toml"));
}

}  // namespace

TEST_CASE("an equation that is equal in both approaches is printed once, across both columns") {
  const std::string text = shipped("P7_moving_sphere");
  const std::string phi =
      "\\frac{d}{dt}\\left(m d^{2} \\dot{\\phi}\\right) - m d^{2} \\sin\\phi\\, \\cos\\phi\\, \\dot{\\theta}^{2} - m g "
      "d \\sin\\phi = 0";
  CHECK(count(text, phi) == 1);
  CHECK(text.find("$\\phi$ & \\multicolumn{2}{p{0.84\\linewidth}}{$\\displaystyle " + phi + "$} & (1)") !=
        std::string::npos);
  // In approach II the equation of theta of the rolling disk differs, and x3 has none.
  const std::string disk = shipped("R6_rolling_disk");
  CHECK(count(disk, "$\\theta$ & \\multicolumn") == 0);
  CHECK(disk.find("$x_{3}$ & $\\displaystyle m \\ddot{x}_{3} + m g = \\lambda_{3}$ & --- & ") != std::string::npos);
}

TEST_CASE("the document derives the equations from the energies step by step, as (2.110)") {
  const std::string text = shipped("P7_moving_sphere");
  for (const char* step :
       {"\\frac{\\partial T}{\\partial \\dot{\\phi}} = m R^{2} \\dot{\\phi}",
        "\\frac{d}{dt}\\left(\\frac{\\partial T}{\\partial \\dot{R}}\\right) = m \\ddot{R}",
        "\\frac{\\partial T}{\\partial \\phi} = m R^{2} \\sin\\phi\\, \\cos\\phi\\, \\dot{\\theta}^{2}",
        "\\frac{\\partial U}{\\partial \\phi} = -m g R \\sin\\phi", "Q_{\\theta} = D R^{2} \\sin\\phi",
        "Q_{\\theta} = D d^{2} \\sin\\phi"}) {
    CAPTURE(step);
    CHECK(text.find(step) != std::string::npos);
  }
}

TEST_CASE("the document states the kind of every constraint, and which equations decouple") {
  const std::string sphere = shipped("P7_moving_sphere");
  CHECK(sphere.find("\\textbf{sphere} is holonomic and rheonomic") != std::string::npos);
  CHECK(sphere.find("it fixes $R$:") != std::string::npos);
  CHECK(sphere.find("(3) gives the constraint force") != std::string::npos);
  CHECK(sphere.find("(1) and (2) have no constraint force in them") != std::string::npos);
  const std::string disk = shipped("R6_rolling_disk");
  CHECK(disk.find("\\textbf{contact.1} is nonholonomic: on velocities, and not integrable") != std::string::npos);
  CHECK(disk.find("\\textbf{contact.3} is holonomic and scleronomic") != std::string::npos);
  CHECK(disk.find("By Approach II \\textbf{contact.3} takes $x_{3}$ out") != std::string::npos);
  CHECK(shipped("P8_rough_helix").find("(1) does not decouple") != std::string::npos);
  CHECK(shipped("G1_spherical").find("What decouples") == std::string::npos);
}

TEST_CASE("words that are longer than a line may be broken at every letter") {
  CHECK(print::escape_user_text("short words & more") == "short words \\& more");
  const std::string broken = print::escape_user_text(std::string(40, 'x'));
  CHECK(count(broken, "\\hspace{0pt}") == 39);
  CHECK(count(print::escape_user_text("\xc3\xa4" + std::string(30, 'x')), "\xc3\xa4\\hspace{0pt}") ==
        1);  // a letter of two bytes counts as one
}

TEST_CASE("the document compiles with pdflatex, if it is installed") {
  if (std::system("command -v pdflatex > /dev/null 2>&1") != 0) {
    MESSAGE("pdflatex is not installed: skipped");
    return;
  }
  CHECK(compiles(document(model::read_model(test::source_folder() + "/models/P7_moving_sphere.toml")), "P7"));
  CHECK(
      compiles(document(model::read_model(test::source_folder() + "/models/S5_spherical_double_pendulum.toml")), "S5"));
  CHECK(compiles(document(hostile()), "hostile"));
}

TEST_CASE("the document loads amssymb only if a name needs it") {
  std::string text =
      "format = 1\n[coordinates]\nx = { tex = '\\mathfrak{x}' }\ny = { tex = 'y^2' }\n[parameters]\nk = { value = 1, "
      "tex = '\\mathbb{K}_1' }\n"
      "[energy]\nkinetic = \"x_dot^2 + y_dot^2\"\npotential = \"k*x^2 + y^2\"\n";
  const std::string with = document(model::read_model_text(text, "m.toml"));
  CHECK(with.find("\\usepackage{amssymb}") != std::string::npos);
  for (const char* name : {"\\mathfrak{x}", "\\mathbb{K}_1"})
    text.replace(text.find(name), std::string(name).size(), "z");
  CHECK(document(model::read_model_text(text, "m.toml")).find("amssymb") == std::string::npos);
  if (std::system("command -v pdflatex > /dev/null 2>&1") == 0) CHECK(compiles(with, "amssymb"));
}

TEST_CASE("a planar body has one moment of inertia, about the axis of the plane") {
  const std::string text = document(model::read_model_text(R"(format = 1
[parameters]
m = "1 kg"
L = "2 m"
[[body]]
name = "rod"
mass = "m"
inertia = "m*L^2/12"
position = { cartesian = ["x", "y"] }
rotation = { axis = "E3", angle = "theta" }
)",
                                                           "rod"));
  const std::size_t at = text.find("its moment of inertia about ");
  REQUIRE(at != std::string::npos);
  CHECK(text.substr(at, text.find('.', at) - at).find("3}") != std::string::npos);
  CHECK(text.find("own axes are") == std::string::npos);
}

TEST_CASE("the document names the axes of the components of omega, and their indices") {
  const std::string top = document(model::read_model(test::source_folder() + "/models/R10_lagrange_top.toml"));
  CHECK(top.find("along the axes of the body before its last rotation.") != std::string::npos);
  CHECK(top.find("the index $k$ is that of the axis and $b$ that of the body: 1 for ") != std::string::npos);
  const std::string body = document(model::read_model(test::source_folder() + "/models/R1_free_body.toml"));
  CHECK(body.find("The components are taken along the axes of the body.") != std::string::npos);
}

TEST_CASE("angles that the model gives in degrees are printed in degrees") {
  const std::string text = document(model::read_model_text(R"toml(format = 1
[parameters]
alpha = "48.85 deg"
beta = "0.5 rad"
m = "1 kg"
g = "9.81 m/s^2"
[[particle]]
name = "P"
mass = "m"
position = "x*(cos(alpha + beta)*E1 - sin(alpha)*E2)"
[coordinates]
x = "m"
[[force]]
gravity = "-g*E2"
)toml",
                                                           "incline"));
  CHECK(text.find("$\\alpha$ & $48.85^{\\circ}$ &  \\\\") != std::string::npos);
  CHECK(text.find("$\\beta$ & $0.5$ & $\\mathrm{rad}$") != std::string::npos);
}

// SPDX-License-Identifier: GPL-3.0-or-later
// The LaTeX document: nothing of the user's acts as LaTeX, and it compiles where LaTeX is installed.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "print/render.hpp"
#include "support/folders.hpp"

using namespace eomgen;
namespace fs = std::filesystem;

namespace {

std::string document(const model::Model& model) {
  const mechanics::Mechanics m = mechanics::build_mechanics(model);
  return print::latex_document(m, reading::derive_reading(m, system::Approach::one), reading::derive_reading(m, system::Approach::two));
}

model::Model hostile() {
  return model::read_model_text(R"(format = 1
title = 'a\input{/etc/passwd}$x$ & 100% #1 _b^c~ "quoted" \write18{touch here} 日本'
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
)", "hostile");
}

bool compiles(const std::string& text, const std::string& name) {
  const fs::path folder = fs::path(test::build_folder()) / "print_test" / name;
  fs::create_directories(folder);
  std::ofstream(folder / "document.tex") << text;
  const std::string command = "cd '" + folder.string() + "' && pdflatex -no-shell-escape -interaction=nonstopmode -halt-on-error document.tex > out.txt 2>&1";
  return std::system(command.c_str()) == 0 && fs::exists(folder / "document.pdf");
}

}  // namespace

TEST_CASE("hostile names and texts stay texts") {
  const std::string text = document(hostile());
  const std::string body = text.substr(text.find("\\begin{document}") + 16);
  for (const char* command : {"\\input", "\\write", "\\immediate", "\\csname", "\\catcode"}) {
    CAPTURE(command);
    CHECK(body.find(command) == std::string::npos);
  }
  CHECK(body.find("\\end{document}") == body.size() - 15);  // the one at the end
  CHECK(body.find("\\mathrm{write}_{18}") != std::string::npos);
}

TEST_CASE("the document has both approaches side by side and the constraint force") {
  const std::string text = document(model::read_model(test::source_folder() + "/models/P7_moving_sphere.toml"));
  CHECK(text.find("Approach I}") != std::string::npos);
  CHECK(text.find("Approach II}") != std::string::npos);
  CHECK(text.find("\\[\n\\lambda = m \\ddot{d}") != std::string::npos);
  CHECK(text.find("$9.81$ & $\\mathrm{m/s^{2}}$") != std::string::npos);
}

TEST_CASE("the document compiles with pdflatex, if it is installed") {
  if (std::system("command -v pdflatex > /dev/null 2>&1") != 0) {
    MESSAGE("pdflatex is not installed: skipped");
    return;
  }
  CHECK(compiles(document(model::read_model(test::source_folder() + "/models/P7_moving_sphere.toml")), "P7"));
  CHECK(compiles(document(model::read_model(test::source_folder() + "/models/S5_spherical_double_pendulum.toml")), "S5"));
  CHECK(compiles(document(hostile()), "hostile"));
}

TEST_CASE("the document loads amssymb where a name needs it, and only there") {
  std::string text = "format = 1\n[coordinates]\nx = { tex = '\\mathfrak{x}' }\ny = { tex = 'y^2' }\n[parameters]\nk = { value = 1, tex = '\\mathbb{K}_1' }\n"
                     "[energy]\nkinetic = \"x_dot^2 + y_dot^2\"\npotential = \"k*x^2 + y^2\"\n";
  const std::string with = document(model::read_model_text(text, "m.toml"));
  CHECK(with.find("\\usepackage{amssymb}") != std::string::npos);
  for (const char* name : {"\\mathfrak{x}", "\\mathbb{K}_1"}) text.replace(text.find(name), std::string(name).size(), "z");
  CHECK(document(model::read_model_text(text, "m.toml")).find("amssymb") == std::string::npos);
  if (std::system("command -v pdflatex > /dev/null 2>&1") == 0) CHECK(compiles(with, "amssymb"));
}

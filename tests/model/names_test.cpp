// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/names.hpp"

#include <doctest/doctest.h>

#include "model/content_hash.hpp"
#include "model_support.hpp"

using namespace eomgen::model;

TEST_CASE("a transposition counts as one edit") {
  CHECK(edit_distance("theta", "tehta", 3) == 1);
  CHECK(edit_distance("theta", "thta", 3) == 1);
  CHECK(edit_distance("theta", "thetaa", 3) == 1);
  CHECK(edit_distance("theta", "thata", 3) == 1);
  CHECK(edit_distance("theta", "phi", 2) == 3);  // more than the limit
}

TEST_CASE("the nearest name is meant, and far ones are not") {
  const std::vector<std::string> names{"theta", "phi", "mass", "x"};
  CHECK(nearest("tehta", names) == "theta");
  CHECK(nearest("maas", names) == "mass");
  CHECK(!nearest("velocity", names));
  CHECK(!nearest("y", names));
}

TEST_CASE("numbered names and short pairs are no misspellings of one another") {
  CHECK(looks_misspelt("tehta", "theta"));
  CHECK(looks_misspelt("thta", "theta"));
  CHECK(looks_misspelt("Theta", "theta"));
  CHECK(looks_misspelt("pih", "phi"));
  CHECK(!looks_misspelt("theta1", "theta2"));
  CHECK(!looks_misspelt("theta", "theta1"));
  CHECK(!looks_misspelt("phi", "psi"));
  CHECK(!looks_misspelt("x", "y"));
  CHECK(!looks_misspelt("x1", "y1"));
  CHECK(!looks_misspelt("thetaA", "thetaB"));
  CHECK(!looks_misspelt("x_cart", "y_cart"));
  CHECK(!looks_misspelt("theta_a", "theta_b"));
  CHECK(looks_misspelt("thera", "theta"));
}

TEST_CASE("every legal name is accepted, also those of C++ and Python") {
  const Model model =
      with_parameters("class = 1\nlambda = 2\ndouble = 3\nNone = 4\nextension = 5\nenergy = 6\nm_1 = 7\nE = 8\ne1 = 9");
  CHECK(model.parameters.size() == 9);
}

TEST_CASE("names are kept apart from derivatives and functions") {
  CHECK(illegal_name("x_dot"));
  CHECK(illegal_name("x_ddot"));
  CHECK(illegal_name("sin"));
  CHECK(illegal_name("E1"));
  CHECK(illegal_name("ground"));
  CHECK(illegal_name("1x"));
  CHECK(illegal_name("x-y"));
  CHECK(!illegal_name("dot_x"));
  CHECK(!illegal_name("E4"));
}

TEST_CASE("harmless LaTeX passes, everything else is refused") {
  for (const char* good :
       {"\\theta", "m_{\\mathrm{cart}}", "\\bar\\omega'", "x^{*}", "\\vec{r}\\,", "L_{1,2}", "x'^2", "x''_1", "L_1^2",
        "{L_1}_2", "\\mathbb{R}", "\\mathfrak g", "\\text{of the rod}", "x_\\alpha", "\\hat x", "e^{-x^2}"}) {
    CAPTURE(good);
    CHECK(!illegal_tex(good));
  }
  for (const char* bad : {"",
                          "\\write18{x}",
                          "\\input{x}",
                          "\\def\\a{b}",
                          "}{",
                          "{",
                          "$x$",
                          "x & y",
                          "a%b",
                          "#1",
                          "\\\\",
                          "<b>",
                          "~",
                          "\\catcode`\\%=0",
                          "L_1_2",
                          "x^a^b",
                          "x^2'",
                          "x'_1'",
                          "x_",
                          "x^",
                          "{x_}",
                          "\\bar",
                          "\\mathrm",
                          "x_\\hat{a}",
                          "\\text{a_1}",
                          "\\text a",
                          "\\text{\\alpha}",
                          "x_'",
                          "x^_2"}) {
    CAPTURE(bad);
    CHECK(illegal_tex(bad));
  }
}

TEST_CASE("quotes in messages are short and free of control characters") {
  CHECK(quote("a\nb\x1b[31m") == "'a b [31m'");
  CHECK(quote(std::string(100, 'x')).size() == 45);
  CHECK(quote(std::string(39, 'x') + "\xc3\xa9\xc3\xa9") == "'" + std::string(39, 'x') + "...'");
}

TEST_CASE("the content hash is SHA-256") {
  CHECK(content_hash("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  CHECK(content_hash("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  CHECK(content_hash(std::string(1000, 'a')) == "41edece42d63e8d9bf515a9ba6932e1c20cbc9f5a5d134645adb5db1b9737ea3");
}

TEST_CASE("names that the reader makes up give way to those of the model, events too") {
  const Model model = read_model_text(R"toml(format = 1
[parameters]
m = 1
[functions]
f = "exp(-t^2)"
[coordinates]
x = {}
[energy]
kinetic = "m*x_dot^2/2"
[[force]]
name = "integral_2"
generalized = { x = "integral(f) + integral(t*f)" }
[[event]]
name = "t_start"
when = "x"
[[event]]
name = "integral_1"
when = "x_dot"
)toml",
                                      "names");
  REQUIRE(model.integrals.size() == 2);
  CHECK(model.integrals[0].name == "integral_1_");
  CHECK(model.integrals[1].name == "integral_2_");
  REQUIRE(model.start_time);
  CHECK(model.parameters[*model.start_time].name == "t_start_");
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Printed formulas: a few golden strings, brackets, and well-formed MathML.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "print/render.hpp"
#include "reading/linear_form.hpp"
#include "support/folders.hpp"

using namespace eomgen;
using print::PrintedFormula;

namespace {

struct Printed {
  explicit Printed(const model::Model& read, system::Approach approach, std::vector<std::string> show = {"all"})
      : model(read),
        mechanics(mechanics::build_mechanics(model)),
        items(print::render(mechanics, reading::derive_display_form(mechanics, approach), show)) {}
  std::vector<PrintedFormula> of(const std::string& key) const {
    std::vector<PrintedFormula> result;
    std::copy_if(items.begin(), items.end(), std::back_inserter(result),
                 [&](const PrintedFormula& item) { return item.key == key; });
    return result;
  }
  model::Model model;
  mechanics::Mechanics mechanics;
  std::vector<PrintedFormula> items;
};

std::string shipped_file(const std::string& name) { return test::source_folder() + "/models/" + name + ".toml"; }

// Whether elements open and close in order.
bool well_formed(const std::string& xml) {
  std::vector<std::string> open;
  for (std::size_t i = xml.find('<'); i != std::string::npos; i = xml.find('<', i + 1)) {
    const std::size_t end = xml.find('>', i);
    if (end == std::string::npos) return false;
    const std::string tag = xml.substr(i + 1, end - i - 1);
    if (tag.ends_with("/")) continue;
    if (tag.starts_with("/")) {
      if (open.empty() || open.back() != tag.substr(1)) return false;
      open.pop_back();
    } else {
      open.push_back(tag.substr(0, tag.find(' ')));
    }
  }
  return open.empty();
}

template <class Form>  // a format or a style
std::string expression(const std::string& is, const Form& form) {
  const model::Model model = model::read_model_text(
      "format = 1\n[parameters]\na = 1\nb = 2\nc = 3\n[coordinates]\nx = {}\ny = {}\n"
      "[definitions]\ne = \"" +
          is + "\"\n[energy]\nkinetic = \"(x_dot^2 + y_dot^2)/2\"\n",
      "text");
  const mechanics::Mechanics m = mechanics::build_mechanics(model);
  return print::print(reading::arrange(reading::display_sum(m, m.scalar_definition[0])), print::Notation(m), form);
}

}  // namespace

TEST_CASE("P7 reads as (2.111)") {
  const Printed one(model::read_model(shipped_file("P7_moving_sphere")), system::Approach::one,
                    {"equations", "reactions"});
  const auto equations = one.of("equations");
  REQUIRE(equations.size() == 3);
  CHECK(equations[0].coordinate == "phi");
  CHECK(equations[0].role == "motion");
  CHECK(equations[0].text == "d/dt(m d^2 phi_dot) - m d^2 sin(phi) cos(phi) theta_dot^2 - m g d sin(phi) = 0");
  CHECK(equations[1].text == "d/dt(m d^2 sin^2(phi) theta_dot) = D d^2 sin(phi)");
  CHECK(equations[1].latex ==
        "\\frac{d}{dt}\\left(m d^{2} \\sin^{2}\\phi\\, \\dot{\\theta}\\right) = D d^{2} \\sin\\phi");
  CHECK(equations[2].role == "constraint force");
  CHECK(equations[2].text == "d/dt(m d_dot) - m d phi_dot^2 - m d sin^2(phi) theta_dot^2 + m g cos(phi) = lambda");
  const auto reactions = one.of("reactions");
  REQUIRE(reactions.size() == 2);
  CHECK(reactions[1].text == "N = lambda e_R");
  CHECK(reactions[0].name == "sphere");
  CHECK(reactions[0].text == "lambda = m d_ddot - m d (phi_dot^2 + sin^2(phi) theta_dot^2) + m g cos(phi)");
}

TEST_CASE("P7 by approach II reads as (2.109), without the constraint force") {
  const Printed two(model::read_model(shipped_file("P7_moving_sphere")), system::Approach::two,
                    {"equations", "energies"});
  REQUIRE(two.of("equations").size() == 2);
  for (const PrintedFormula& item : two.items) CHECK(item.text.find("lambda") == std::string::npos);
  CHECK(two.of("energies")[0].text == "T~ = 1/2 m (d^2 phi_dot^2 + d^2 sin^2(phi) theta_dot^2 + d_dot^2)");
}

TEST_CASE("a rod about its end: energies of translation and rotation are one term; angles are shown in degrees") {
  const auto rod = [](const std::string& angle) {
    return Printed(
        model::read_model_text("format = 1\n[parameters]\nm = 1\nL = 1\n[coordinates]\ntheta = \"rad\"\n[[body]]\n"
                               "name = \"B\"\nmass = \"m\"\ninertia = \"m*L^2/12\"\n"
                               "position = [\"L/2*sin(theta)\", \"-L/2*cos(theta)\", 0]\n"
                               "rotation = { axis = \"E3\", angle = \"theta\" }\n[[force]]\non = \"B\"\n"
                               "force = \"2*sin(" +
                                   angle + ")*E2\"\n",
                               "rod.toml"),
        system::Approach::two, {"equations", "energies"});
  };
  const Printed given = rod("48.85*pi/180");
  CHECK(given.of("energies")[0].text == "T~ = 1/6 m L^2 theta_dot^2");
  CHECK(given.of("equations")[0].text == "d/dt(1/3 m L^2 theta_dot) = L sin(48.85[deg]) sin(theta)");
  CHECK(given.of("equations")[0].latex.find("48.85^{\\circ}") != std::string::npos);
  CHECK(rod("37*pi/180").of("equations")[0].text == "d/dt(1/3 m L^2 theta_dot) = L sin(37[deg]) sin(theta)");
  // In sums too.
  CHECK(rod("2*theta - 48.85*pi/180").of("equations")[0].text ==
        "d/dt(1/3 m L^2 theta_dot) = L sin(theta) sin(2 theta - 48.85[deg])");
  CHECK(rod("-48.85*pi/180 - m*theta").of("equations")[0].text.find("48.85[deg]") != std::string::npos);
  const Printed spring(
      model::read_model_text("format = 1\n[parameters]\nm = 1\nk = 1\n[coordinates]\nphi = \"rad\"\n[energy]\n"
                             "kinetic = \"m*phi_dot^2/2\"\npotential = \"k*(phi - 48.85*pi/180)^2/2\"\n",
                             "spring.toml"),
      system::Approach::two, {"equations"});
  CHECK(spring.of("explicit")[0].text == "m phi_ddot + k (phi - 48.85[deg]) = 0");
  CHECK(rod("pi/1024").of("equations")[0].text == "d/dt(1/3 m L^2 theta_dot) = L sin(pi/1024) sin(theta)");
}

TEST_CASE("common parameter factors come first") {
  const Printed one(model::read_model(shipped_file("S5_double_pendulum")), system::Approach::two, {"equations"});
  CHECK(one.of("explicit")[0].text ==
        "(m1 + m2) L1^2 theta1_ddot + m2 L1 L2 cos(theta1 - theta2) theta2_ddot + m2 L1 L2 sin(theta1 - theta2) "
        "theta2_dot^2"
        " + (m1 + m2) L1 g sin(theta1) = 0");
}

TEST_CASE("everything that `all` selects exists in three formats, and MathML is well-formed") {
  for (const char* name : {"P7_moving_sphere", "S5_spherical_double_pendulum", "S5_double_pendulum_cartesian",
                           "P14_kepler_cartesian", "cart_pendulum", "S6_chain_6"}) {
    for (const system::Approach approach : {system::Approach::one, system::Approach::two}) {
      const Printed printed(model::read_model(shipped_file(name)), approach);
      CHECK(printed.items.size() > 3);
      for (const PrintedFormula& item : printed.items) {
        CAPTURE(item.text);
        CHECK_FALSE(item.text.empty());
        CHECK_FALSE(item.latex.empty());
        CHECK(well_formed(item.mathml));
        CHECK(std::count(item.latex.begin(), item.latex.end(), '{') ==
              std::count(item.latex.begin(), item.latex.end(), '}'));
      }
    }
  }
}

TEST_CASE("MathML: a space separates a function from its argument, and factors that would run together") {
  using print::Format;
  const std::string gap = " lspace=\"0\" rspace=\"0.167em\"";
  const std::string applied = "<mo" + gap + ">&#x2061;</mo>", times = "<mo" + gap + ">&#x2062;</mo>";
  const auto has = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  CHECK(has(expression("a*cos(x)", Format::mathml),
            "<mi>a</mi>" + times + "<mrow><mi>cos</mi>" + applied + "<mi>x</mi></mrow>"));
  CHECK(has(expression("sin(x)*y", Format::mathml), times + "<mrow><mi>sin</mi>"));  // y sin x
  // No space is needed next to a bracket or between single letters.
  CHECK(has(expression("sin(x + y)", Format::mathml), "<mi>sin</mi><mo>&#x2061;</mo><mrow><mo stretchy=\"false\">("));
  CHECK(has(expression("a*b", Format::mathml), "<mi>a</mi><mo>&#x2062;</mo><mi>b</mi>"));
  // Signs are infix even if a line, or a <math>, starts with them.
  CHECK(has(expression("a - b", Format::mathml), "<mo form=\"infix\">−</mo>"));
  CHECK(has(expression("-a", Format::mathml), "<mo form=\"prefix\">−</mo>"));
}

TEST_CASE("brackets appear only if needed") {
  using print::Format;
  CHECK(expression("a/(b*c)", Format::text) == "a/(b c)");
  CHECK(expression("a/b*c", Format::model_language) == "a*c/b");
  CHECK(expression("x/(a + b)", Format::latex) == "\\frac{x}{a + b}");
  CHECK(expression("sin(x + y)^2*cos(x)^3", Format::text) == "cos^3(x) sin^2(x + y)");
  CHECK(expression("sqrt(x + y)", Format::latex) == "\\sqrt{x + y}");
  CHECK(expression("exp(-a*x)", Format::latex) == "e^{-a x}");
  CHECK(expression("-(a - b)*x", Format::text) == "(b - a) x");
  CHECK(expression("x/2 + y/3", Format::text) == "1/2 x + 1/3 y");
  CHECK(expression("abs(x)*min(x, y)", Format::latex) == "\\left|x\\right| \\min(x, y)");
  CHECK(expression("if(x < y, x, -y)", Format::model_language) == "if(x < y, x, -y)");
  CHECK(expression("(x + y)^(a/b)", Format::model_language) == "(x + y)^(a/b)");
}

TEST_CASE("lines break inside brackets, and unbreakable parts are abbreviated") {
  const auto narrow = print::latex_style(10);
  const model::Model model =
      model::read_model_text("format = 1\n[coordinates]\nx = {}\n[energy]\nkinetic = \"x_dot^2/2\"\n", "text");
  const mechanics::Mechanics m = mechanics::build_mechanics(model);
  const auto f = [](const char* word) { return reading::mark(word); };
  const auto shown = [&](const reading::Formula& formula) {
    return print::print(formula, print::Notation(m), *narrow);
  };
  CHECK(shown(reading::product({f("p"), reading::sum({f("b"), f("c")})})) == "p (b + c)");
  CHECK(shown(reading::product({f("p"), reading::sum({f("b"), reading::negative(f("c")), f("d"), f("f")}), f("q")})) ==
        "\\begin{aligned}[t]\n&p \\bigl(b - c + d \\\\\n&\\quad{} + f\\bigr) q\n\\end{aligned}");
  CHECK(expression("a/sqrt(b*x + a*y + c)", *narrow) ==
        "\\begin{aligned}[t]\n&\\frac{a}{\\sqrt{\\mathcal{S}_{1}}}, \\\\\n&\\mathcal{S}_{1} = b x + a y "
        "\\\\\n&\\quad{} + c\n\\end{aligned}");
}

TEST_CASE("the language of model files can be pasted back") {
  for (const char* text : {"a*x^2/(b + c) - 3/7*sin(x - y)*x_dot", "sqrt(x^2 + y^2)^(-3)", "atan2(x, y)*exp(-x^2)",
                           "abs(x*y)^3/log(2 + x^2)"}) {
    const std::string once = expression(text, print::Format::model_language);
    CAPTURE(once);
    CHECK(expression(once, print::Format::model_language) == once);
  }
}

TEST_CASE("letters of mechanics change if the model uses them") {
  const model::Model model = model::read_model_text(R"(format = 1
[parameters]
m = 1
L = 2
lambda = 3
[coordinates]
T = {}
psi = {}
[energy]
kinetic = "m*(T_dot^2 + L^2*psi_dot^2)/2"
potential = "lambda*T"
[[constraint]]
name = "c"
holonomic = "T^2 - L*psi^2"
)",
                                                    "letters");
  const Printed printed(model, system::Approach::two);
  CHECK(printed.of("lagrangian")[0].latex.starts_with("\\tilde{\\mathcal{L}} = "));
  CHECK(printed.of("energies")[0].text.starts_with("kinetic~ = "));
  CHECK(printed.of("constraints")[0].latex.starts_with("\\Psi = "));
  CHECK(printed.of("equations")[0].text.find("= 2 mu T") != std::string::npos);
}

TEST_CASE("quarter turns are removed from the angles of sines and cosines, with the right sign") {
  CHECK(expression("sin(pi/2 - x)", print::Format::text) == "cos(x)");
  CHECK(expression("cos(pi/2 - x)", print::Format::text) == "sin(x)");
  CHECK(expression("sin(x + pi/2)", print::Format::text) == "cos(x)");
  CHECK(expression("cos(x + pi/2)", print::Format::text) == "-sin(x)");
  CHECK(expression("sin(x + pi)", print::Format::text) == "-sin(x)");
  CHECK(expression("cos(x - pi)", print::Format::text) == "-cos(x)");
  CHECK(expression("sin(x - 3*pi/2)", print::Format::text) == "cos(x)");
  CHECK(expression("cos(7*pi/2 + x)", print::Format::text) == "sin(x)");
  CHECK(expression("sin(x + pi/3)", print::Format::text) == "sin(x + pi/3)");
}

TEST_CASE("a leading minus is avoided by a bracket or another order") {
  CHECK(expression("x_dot*(b*sin(y)^2 - a*sin(y)^2 + c*cos(y))", print::Format::text).front() != '-');
  CHECK(expression("-(a - b)*x", print::Format::text) == "(b - a) x");
  CHECK(expression("y_dot - a*x_dot*cos(y)", print::Format::text).front() != '-');
  CHECK(expression("-(a - b)*x/(a + b)", print::Format::text) == "(b - a) x/(a + b)");
}

TEST_CASE("linear: trivial equilibrium conditions are omitted, and none begins with an avoidable minus") {
  const mechanics::Mechanics m = mechanics::build_mechanics(
      model::read_model_text("format = 1\n[parameters]\nm = \"1 kg\"\nk = \"2 N/m\"\n[[particle]]\nname = \"P\"\nmass "
                             "= \"m\"\nposition = { cartesian "
                             "= [\"x\", \"y\"] }\n[[force]]\non = \"P\"\nforce = \"k*x*E1\"\n",
                             "text"));
  std::vector<std::string> rest;
  for (const PrintedFormula& item : print::render_linear(m, reading::linear_form(m))) {
    if (item.role == "at rest where") rest.push_back(item.text);
  }
  CHECK(rest == std::vector<std::string>{"k x = 0"});
}

TEST_CASE("decimals in the model stay decimals, and simple fractions stay fractions") {
  CHECK(expression("9.81*x", print::Format::text) == "9.81 x");
  CHECK(expression("9.81*x", print::Format::latex) == "9.81 x");
  CHECK(expression("0.0125*x", print::Format::text) == "1/80 x");
  CHECK(expression("x/12", print::Format::text) == "1/12 x");
  CHECK(expression("3*x/10", print::Format::text) == "3/10 x");
  CHECK(expression("x*pi/6", print::Format::text) == "1/6 pi x");
}

TEST_CASE("the constraint force on a particle is a vector along the unit vectors of its coordinates") {
  const Printed cone(model::read_model(shipped_file("P4_moving_cone")), system::Approach::one, {"reactions"});
  const auto is_force = [](const PrintedFormula& item) { return item.role == "constraint force"; };
  const std::vector<PrintedFormula> of_cone = cone.of("reactions");
  const auto found = std::find_if(of_cone.begin(), of_cone.end(), is_force);
  REQUIRE(found != of_cone.end());
  CHECK(found->text == "N = (lambda/R) e_phi");
  const Printed helix(model::read_model(shipped_file("P8_smooth_helix")), system::Approach::one, {"reactions"});
  CHECK(helix.of("reactions").back().text == "N = lambda_1 a^r + lambda_2 a^nu");
}

TEST_CASE("by approach II no vector contains the multiplier of an imposed constraint") {
  for (const char* name : {"P7_moving_sphere", "P4_moving_cone", "P8_smooth_helix"}) {
    CAPTURE(name);
    const model::Model model = model::read_model(shipped_file(name));
    for (const PrintedFormula& item : Printed(model, system::Approach::two, {"reactions"}).items)
      CHECK_MESSAGE(item.text.find("lambda") == std::string::npos, item.text);
  }
  const model::Model sphere = model::read_model(shipped_file("P7_moving_sphere"));
  CHECK_FALSE(Printed(sphere, system::Approach::one).of("reactions").empty());
}

TEST_CASE("numeric factors of moments are combined in front") {
  const model::Model model = model::read_model_text(
      "format = 1\n[parameters]\nm = 1\nl = 1\n[[body]]\nname = \"B\"\nmass = \"m\"\ninertia = { cylinder = [\"l\", "
      "\"l\"] }\nposition = { cartesian = [\"x\", \"y\", \"z\"] }\n"
      "rotation = { euler = \"313\", angles = [\"psi\", \"theta\", \"phi\"] }\n",
      "text");
  for (const PrintedFormula& item : Printed(model, system::Approach::two, {"energies"}).of("energies"))
    CHECK(item.text.find("1/2 (1/12") == std::string::npos);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/notation.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "mechanics/mechanics.hpp"
#include "support/folders.hpp"

using namespace eomgen;
using namespace eomgen::print;

namespace {

std::string in_latex(const std::string& name, int dots = 0) {
  Glyph glyph = split_name(name);
  glyph.dots = dots;
  return latex(glyph);
}

}  // namespace

TEST_CASE("names become letters with indices and dots") {
  CHECK(in_latex("m") == "m");
  CHECK(in_latex("theta") == "\\theta");
  CHECK(in_latex("theta1") == "\\theta_{1}");
  CHECK(in_latex("theta_1", 1) == "\\dot{\\theta}_{1}");
  CHECK(in_latex("d0", 2) == "\\ddot{d}_{0}");
  CHECK(in_latex("m_P") == "m_{P}");
  CHECK(in_latex("alpha_max") == "\\alpha_{\\mathrm{max}}");
  CHECK(in_latex("x1_ref") == "x_{1,\\mathrm{ref}}");
  CHECK(in_latex("length") == "\\mathrm{length}");
  CHECK(in_latex("GM") == "\\mathrm{GM}");
  CHECK(in_latex("Omega_alpha") == "\\Omega_{\\alpha}");
  CHECK(in_latex("q", 3) == "\\dddot{q}");
  CHECK(in_latex("d", 5) == "d^{(5)}");
  CHECK(in_latex("a__b") == "a_{b}");
}

TEST_CASE("names that are LaTeX commands stay words") {
  for (const char* name :
       {"input", "write18", "end", "def", "newcommand", "catcode", "sin", "frac", "Alpha", "csname"}) {
    const std::string text = in_latex(name);
    CAPTURE(text);
    CHECK(text.find('\\') == text.find("\\mathrm{"));
    CHECK(std::count(text.begin(), text.end(), '\\') == 1);
  }
}

TEST_CASE("MathML of names contains only letters, digits and known elements") {
  CHECK(mathml(split_name("theta1")) == "<msub><mi>θ</mi><mrow><mn>1</mn></mrow></msub>");
  Glyph rate = split_name("q_1");
  rate.dots = 1;
  CHECK(mathml(rate) == "<msub><mover accent=\"true\"><mi>q</mi><mo>˙</mo></mover><mrow><mn>1</mn></mrow></msub>");
  CHECK(mathml(split_name("script")) == "<mi>script</mi>");
}

TEST_CASE("a tex override replaces base and index, in LaTeX only") {
  Glyph glyph = split_name("omega_e");
  glyph.tex = "\\Omega_{\\oplus}";
  CHECK(latex(glyph) == "{\\Omega_{\\oplus}}");
  glyph.dots = 1;
  CHECK(latex(glyph) == "\\dot{\\Omega_{\\oplus}}");
  CHECK(mathml(glyph).find("oplus") == std::string::npos);
}

TEST_CASE("text of users is escaped") {
  CHECK(escape_latex("50% of $5 & {x}_1 #2 ^~\\") ==
        "50\\% of \\$5 \\& \\{x\\}\\_1 \\#2 \\textasciicircum{}\\textasciitilde{}\\textbackslash{}");
  CHECK(escape_latex("\\input{/etc/passwd}") == "\\textbackslash{}input\\{/etc/passwd\\}");
  CHECK(escape_latex("M\xc3\xbcller \xe6\x97\xa5\xf0\x9f\x98\x80 \x01") == "M\xc3\xbcller ??  ");
  CHECK(escape_html("<script>alert('x & \"y\"')</script>") ==
        "&lt;script&gt;alert(&#39;x &amp; &quot;y&quot;&#39;)&lt;/script&gt;");
}

TEST_CASE("names of joint multipliers contain the joint and the force or moment, as in the mechanics") {
  for (const char* name : {"R15_pin_joint", "four_bar_spatial_pins", "six_bar_spatial"}) {
    CAPTURE(name);
    const model::Model model = model::read_model(test::source_folder() + "/models/" + name + ".toml");
    const mechanics::Mechanics m = mechanics::build_mechanics(model);
    const print::Notation notation(m);
    REQUIRE_FALSE(m.joints.empty());
    for (std::size_t j = 0; j < m.joints.size(); ++j) {
      const mechanics::JointReaction& reaction = m.joints[j];
      for (std::uint32_t k = 0; k < reaction.equations(); ++k) {
        const std::string shown = notation.multiplier(reaction.first + k).name,
                          begin = "lambda_" + model.joints[j].name + "_";
        CAPTURE(shown);
        REQUIRE(shown.starts_with(begin));
        const bool force = shown[begin.size()] == 'F';
        if (!force) CHECK(shown[begin.size()] == 'M');
        // A force if the multiplier is a force, else a pure moment.
        bool exerts_force = false;
        for (std::size_t c = 0; c < 3; ++c) exerts_force = exerts_force || !m.dag->is_zero(reaction.along[c][k]);
        CHECK(exerts_force == force);
      }
    }
  }
}

TEST_CASE("a legend describes the multipliers if there are several") {
  const auto meanings = [](const char* name) {
    const model::Model model = model::read_model(test::source_folder() + "/models/" + name + ".toml");
    return print::multiplier_descriptions(mechanics::build_mechanics(model));
  };
  const std::vector<print::MultiplierDescription> pin = meanings("R15_pin_joint");
  REQUIRE(pin.size() == 5);
  CHECK(pin[0].text == "of the joint 'pin' on 'second': force along E1");
  CHECK(pin[3].text == "of the joint 'pin' on 'second': moment along b x a1");
  const std::vector<print::MultiplierDescription> wire = meanings("P8_rough_helix");
  REQUIRE(wire.size() == 2);
  CHECK(wire[1].text == "of the constraint 'wire.2'");
  CHECK(meanings("P7_moving_sphere").empty());
}

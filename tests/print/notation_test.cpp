// SPDX-License-Identifier: GPL-3.0-or-later
#include "print/notation.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

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
  for (const char* name : {"input", "write18", "end", "def", "newcommand", "catcode", "sin", "frac", "Alpha", "csname"}) {
    const std::string text = in_latex(name);
    CAPTURE(text);
    CHECK(text.find('\\') == text.find("\\mathrm{"));
    CHECK(std::count(text.begin(), text.end(), '\\') == 1);
  }
}

TEST_CASE("MathML of names holds nothing but letters, digits and known elements") {
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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/text.hpp"

#include <cln/integer.h>
#include <cln/rational_io.h>
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>

using namespace eomgen::emit;
using eomgen::symbolic::Rational;

TEST_CASE("text: comments cannot be ended or continued from inside") {
  for (const char* text : {"*/", "/*/", "**//", "\\", "?\?/", "a\nb", "*\n/", "/", "*",
                           "??"
                           "?\?/",
                           "\x7f\x80"}) {
    const std::string safe = "/* " + comment_text(text) + "*/";
    CHECK(safe.find("*/") == safe.size() - 2);
    CHECK(safe.find("/*", 2) == std::string::npos);
    CHECK(safe.find('\\') == std::string::npos);
    CHECK(safe.find('\n') == std::string::npos);
    CHECK(safe.find("??") == std::string::npos);
  }
  CHECK(comment_text("m/s^2") == "m/s^2");
}

TEST_CASE("text: a string literal preserves its text") {
  CHECK(string_literal("a\"b\\c?\n", "") == "\"a\\\"b\\\\c\\?\\012\"");
  CHECK(string_literal(std::string(200, 'x'), "  ").find("\"\n  \"") != std::string::npos);
}

TEST_CASE("text: decimals read back as the same number") {
  for (const double value : {0.0, 1.0, 9.81, 1e-7, 1e300, 0.1 + 0.2, 5e-324, 123456789012345678.0}) {
    const std::string text = decimal(value);
    CHECK(std::strtod(text.c_str(), nullptr) == value);
    CHECK(text.find_first_of(".e") != std::string::npos);
  }
}

TEST_CASE("text: exact numbers are rounded to the nearest double") {
  // strtod is correctly rounded: it is the reference for decimals
  for (const char* text :
       {"9.81", "0.1", "0.3", "6.67430e-11", "1.7976931348623157e308", "4.9e-324", "2.5e-324", "2.4e-324",
        "9007199254740993", "9007199254740995", "0.1000000000000000055511151231257827", "1e-320",
        "2.2250738585072011e-308", "1e400", "1e-400", "3.141592653589793238462643383279502884"}) {
    const std::string all = text;
    const std::size_t e = all.find('e'), point = all.find('.');
    const std::string digits = all.substr(0, e);
    std::string whole = digits;
    long shift = e == std::string::npos ? 0 : std::stol(all.substr(e + 1));
    if (point != std::string::npos) {
      whole.erase(point, 1);
      shift -= static_cast<long>(digits.size() - point - 1);
    }
    const Rational value = Rational(cln::cl_I(whole.c_str())) * cln::expt(Rational(10), cln::cl_I(shift));
    INFO(all);
    CHECK(nearest_double(value) == std::strtod(text, nullptr));
    CHECK(nearest_double(-value) == -std::strtod(text, nullptr));
  }
  CHECK(nearest_double(Rational(1) / 3) == 1.0 / 3.0);
}

TEST_CASE("text: long lines break at blanks and lose nothing") {
  std::string line = "  const double a = x";
  for (int i = 0; i < 60; ++i) line += " + b" + std::to_string(i);
  const std::string broken = wrapped(line, "      ", 60);
  std::string without;
  for (std::size_t i = 0; i < broken.size(); ++i) {
    if (broken[i] == '\n') {
      without += ' ';
      i += 6;
    } else {
      without += broken[i];
    }
  }
  CHECK(without == line);
}

TEST_CASE("text: a comment to the end of the line stays a comment where it is wrapped") {
  const std::string name(64, 'q'), code = "  dfdx[0] = " + std::string(30, 'a') + " + " + std::string(30, 'b') + ";";
  for (const std::string& comment : {"d/d " + name, name + " of " + name + " and of " + name, std::string(200, 'n'),
                                     "d/d " + std::string(200, 'n')}) {
    CAPTURE(comment);
    std::string rest = wrapped(code + "  // " + comment, "      ");
    std::string seen;
    bool in_comment = false;
    for (std::size_t end = 0; end != std::string::npos;) {
      end = rest.find('\n');
      const std::string line = rest.substr(0, end);
      rest = end == std::string::npos ? "" : rest.substr(end + 1);
      const std::size_t at = line.find("// ");
      if (in_comment) CHECK(line.find_first_not_of(' ') == at);
      in_comment = in_comment || at != std::string::npos;
      if (at != std::string::npos) seen += (seen.empty() ? "" : " ") + line.substr(at + 3);
    }
    CHECK(in_comment);
    CHECK(seen == comment);
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/decimal.hpp"

#include <cln/integer.h>
#include <cln/integer_io.h>
#include <cln/rational_io.h>
#include <fmt/format.h>

#include <cctype>
#include <cstdlib>
#include <sstream>

#include "error.hpp"

namespace eomgen::symbolic {

Rational parse_decimal(const std::string& text, const std::string& shown) {
  constexpr std::size_t digit_limit = 400;
  constexpr long exponent_limit = 400;
  const auto fail = [&] {
    throw Error("cli", {}, fmt::format("'{}' has no decimal number where one is needed", shown),
                "write it as 9.81 or 1e-3, in SI units");
  };
  std::size_t at = 0;
  const bool negative = !text.empty() && text[0] == '-';
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) ++at;
  std::string digits;
  long exponent = 0;
  bool point = false;
  for (; at < text.size() && (std::isdigit(static_cast<unsigned char>(text[at])) || (text[at] == '.' && !point));
       ++at) {
    if (text[at] == '.') {
      point = true;
      continue;
    }
    digits += text[at];
    if (point) --exponent;
  }
  if (digits.empty() || digits.size() > digit_limit) fail();
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    const std::string power = text.substr(at + 1);
    char* end = nullptr;
    const bool sign = !power.empty() && (power[0] == '-' || power[0] == '+');
    if (power.size() < (sign ? 2u : 1u) || power.size() > 5 ||
        !std::isdigit(static_cast<unsigned char>(power[sign ? 1 : 0])))
      fail();
    const long written = std::strtol(power.c_str(), &end, 10);
    if (*end != '\0' || std::labs(written) > exponent_limit) fail();
    exponent += written;
    at = text.size();
  }
  if (at != text.size()) fail();
  const Rational mantissa = cln::cl_I(digits.c_str());
  const Rational value = mantissa * cln::expt(Rational(10), static_cast<int>(exponent));
  return negative ? -value : value;
}

std::string decimal_text(const Rational& value) {
  const double nearest = cln::double_approx(value);
  const std::string text = fmt::format("{}", nearest);
  const bool exact =
      text.size() < 40 && text.find_first_of("in") == std::string::npos && parse_decimal(text, text) == value;
  if (exact) return text;
  std::ostringstream fraction;
  fraction << value;
  return fraction.str();
}

}  // namespace eomgen::symbolic

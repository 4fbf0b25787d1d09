// Numbers as text without <charconv>, compared with <charconv>: random bits, texts of every form, and the ends of the
// ranges.
#include "eom/output/decimal.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace {

std::string standard(double value) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string by_printf(double value) {
  char text[40];
  return {text, eom::decimals::by_c_library::write_shortest(text, text + sizeof text, value)};
}

/// The same end, the same error and the same value as from_chars.
template <class Number>
void compare_reading(const std::string& text) {
  Number expected = 7, found = 7;
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, expected);
  const auto [found_end, found_error] = eom::decimals::by_c_library::read_decimal(text.data(), last, found);
  INFO(text);
  CHECK(found_end - text.data() == end - text.data());
  CHECK((found_error == error));
  CHECK((found == expected || (found != found && expected != expected)));
  CHECK(std::signbit(found) == std::signbit(expected));
}

const std::vector<double> special = {0.0,
                                     -0.0,
                                     1,
                                     -1,
                                     0.1,
                                     100,
                                     1e5,
                                     123456,
                                     1e15,
                                     1e16,
                                     1e21,
                                     1e22,
                                     1e23,
                                     9007199254740992.0,
                                     123456789012345680.0,
                                     1e-4,
                                     0.00012,
                                     1e-5,
                                     12e-5,
                                     5e-324,
                                     1e-310,
                                     2.2250738585072011e-308,
                                     std::numeric_limits<double>::min(),
                                     std::numeric_limits<double>::max(),
                                     std::numeric_limits<double>::epsilon()};

}  // namespace

TEST_CASE("decimal: numbers are written without <charconv> as with it") {
  for (const double value : special) {
    CHECK(by_printf(value) == standard(value));
    for (int digits = 1; digits <= 17; ++digits) {
      char text[40], expected[40];
      CHECK(std::string(text, eom::decimals::by_c_library::write_decimal(text, text + sizeof text, value, digits)) ==
            std::string(
                expected,
                std::to_chars(expected, expected + sizeof expected, value, std::chars_format::general, digits).ptr));
    }
  }
  std::mt19937_64 random(5);
  for (int k = 0; k < 20000; ++k) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value)) REQUIRE(by_printf(value) == standard(value));
    const double near = std::ldexp(static_cast<double>(random() >> 20), static_cast<int>(random() % 60) - 60);
    REQUIRE(by_printf(near) == standard(near));
    const double rounded = std::round(near * 1000) / 1000;
    REQUIRE(by_printf(rounded) == standard(rounded));
  }
}

TEST_CASE("decimal: texts are read without <charconv> as with it") {
  for (const char* text : {"",
                           "-",
                           "+1",
                           " 1",
                           ".",
                           "-.",
                           ".5",
                           "5.",
                           "-.5e3",
                           "1e",
                           "1e+",
                           "1e-",
                           "1e5",
                           "1E-5",
                           "1.5e+3x",
                           "0x10",
                           "1,5",
                           "1.2.3",
                           "inf",
                           "-INF",
                           "infinity",
                           "infinit",
                           "nan",
                           "-nan",
                           "NaN(ab_1)",
                           "nan(",
                           "in",
                           "e5",
                           "1e400",
                           "-1e400",
                           "1e-400",
                           "-1e-400",
                           "0e999",
                           "0.000e-999",
                           "9007199254740993",
                           "123456789012345678901234567890",
                           "2.2250738585072011e-308",
                           "2.4703282292062328e-324",
                           "5e-324",
                           "1.7976931348623157e308",
                           "179769313486231580793e289",
                           "16777217",
                           "3.4028236e38",
                           "1e-46"}) {
    compare_reading<double>(text);
    compare_reading<float>(text);
  }
  std::mt19937_64 random(7);
  for (int k = 0; k < 20000; ++k) {
    const double value = std::bit_cast<double>(random());
    if (!std::isfinite(value)) continue;
    char text[40];
    const int digits = 1 + static_cast<int>(random() % 25);
    std::snprintf(text, sizeof text, "%.*e", digits, value);
    compare_reading<double>(text);
    compare_reading<float>(text);
  }
}

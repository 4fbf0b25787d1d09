// SPDX-License-Identifier: MIT
// Decimal numbers as <charconv> reads and writes them: correctly rounded, in any locale. Standard libraries that lack
// these functions for floating-point numbers get them from printf and strtod of a C library
// that rounds correctly, with the same results (libc++ 13: both ways, libc++ 19: reading). In: text or a number. Out: a
// number or text.
#pragma once

#include <algorithm>
#include <cctype>
#include <cfloat>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>
#include <version>

namespace eom::decimals {

namespace by_c_library {

/// The length of the number at the start of the text, as from_chars reads it: no blanks, no plus sign, no hexadecimal
/// digits. 0 if there is none.
inline std::size_t length_of_number(std::string_view text) {
  const auto digits_from = [&](std::size_t at) {
    while (at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0) ++at;
    return at;
  };
  const auto has_word = [&](std::size_t at, std::string_view word) {
    for (std::size_t i = 0; i < word.size(); ++i) {
      if (at + i >= text.size() || std::tolower(static_cast<unsigned char>(text[at + i])) != word[i]) return false;
    }
    return true;
  };
  const std::size_t first = text.starts_with('-') ? 1 : 0;
  for (const std::string_view word : {"infinity", "inf", "nan"}) {
    if (!has_word(first, word)) continue;
    const std::size_t end = first + word.size();
    if (word != "nan" || end >= text.size() || text[end] != '(') return end;
    std::size_t close = end + 1;
    while (close < text.size() && (std::isalnum(static_cast<unsigned char>(text[close])) != 0 || text[close] == '_'))
      ++close;
    return close < text.size() && text[close] == ')' ? close + 1 : end;
  }
  std::size_t end = digits_from(first), digits = end - first;
  if (end < text.size() && text[end] == '.') {
    const std::size_t fraction = digits_from(end + 1);
    digits += fraction - end - 1;
    if (digits > 0) end = fraction;
  }
  if (digits == 0) return 0;
  if (end < text.size() && (text[end] == 'e' || text[end] == 'E')) {
    const bool has_sign = end + 1 < text.size() && (text[end + 1] == '+' || text[end + 1] == '-');
    const std::size_t power = end + 1 + (has_sign ? 1 : 0), last = digits_from(power);
    if (last > power) end = last;
  }
  return end;
}

template <class Number>
std::from_chars_result read_decimal(const char* first, const char* last, Number& value) {
  const std::size_t length = length_of_number({first, static_cast<std::size_t>(last - first)});
  if (length == 0) return {first, std::errc::invalid_argument};
  const std::string text(first, length);
  Number read = 0;
  if constexpr (std::is_same_v<Number, float>)
    read = std::strtof(text.c_str(), nullptr);
  else if constexpr (std::is_same_v<Number, double>)
    read = std::strtod(text.c_str(), nullptr);
  else
    read = std::strtold(text.c_str(), nullptr);
  const bool is_word = text.find_first_of("iInN") != std::string::npos;
  const bool is_zero = text.substr(0, text.find_first_of("eE")).find_first_of("123456789") == std::string::npos;
  if (!is_word && (std::isinf(read) || (read == 0 && !is_zero)))
    return {first + length, std::errc::result_out_of_range};
  value = read;
  return {first + length, std::errc()};
}

/// As printf's %.{digits}g.
inline char* write_decimal(char* first, char* last, double value, int digits) {
  return first + std::snprintf(first, static_cast<std::size_t>(last - first), "%.*g", digits, value);
}

/// The shortest text that reads back as the finite value: with an exponent if that is shorter.
inline char* write_shortest(char* first, char* last, double value) {
  constexpr std::size_t longest = 400;  // 1e-308 without an exponent
  char with_exponent[longest], without[longest];
  // Texts of up to 15 digits are recovered from binary64, so shorter ones appear as zeros at the end.
  for (int digits = std::fabs(value) < DBL_MIN ? 1 : 15; digits <= 17; ++digits) {
    std::snprintf(with_exponent, longest, "%.*e", digits - 1, value);
    if (std::strtod(with_exponent, nullptr) == value) break;
  }
  const std::string_view text = with_exponent;
  const std::size_t mark = text.find('e');
  std::string shortest(text.substr(0, mark));
  if (shortest.find('.') != std::string::npos) shortest.erase(shortest.find_last_not_of('0') + 1);
  if (shortest.ends_with('.')) shortest.pop_back();
  const std::size_t point = shortest.find('.');
  const int decimals = (point == std::string::npos ? 0 : static_cast<int>(shortest.size() - point) - 1) -
                       std::atoi(with_exponent + mark + 1);
  shortest += text.substr(mark);
  std::snprintf(without, longest, "%.*f", decimals > 0 ? decimals : 0, value);
  if (std::strlen(without) <= shortest.size()) shortest = without;
  const std::size_t length = std::min(shortest.size(), static_cast<std::size_t>(last - first));
  return std::copy_n(shortest.data(), length, first);
}

}  // namespace by_c_library

/// Reads a number as from_chars does.
template <class Number>
std::from_chars_result read_decimal(const char* first, const char* last, Number& value) {
#ifdef __cpp_lib_to_chars
  return std::from_chars(first, last, value);
#else
  return by_c_library::read_decimal(first, last, value);
#endif
}

template <class Number>
std::from_chars_result read_decimal(std::string_view text, Number& value) {
  return read_decimal(text.data(), text.data() + text.size(), value);
}

/// Writes a number as printf's %.{digits}g does in the C locale. Returns its end. 30 characters suffice for 17 digits.
inline char* write_decimal(char* first, char* last, double value, int digits) {
#ifdef __cpp_lib_to_chars
  return std::to_chars(first, last, value, std::chars_format::general, digits).ptr;
#else
  return by_c_library::write_decimal(first, last, value, digits);
#endif
}

/// Writes the shortest text that reads back as the finite value. Returns its end.
inline char* write_shortest(char* first, char* last, double value) {
#ifdef __cpp_lib_to_chars
  return std::to_chars(first, last, value).ptr;
#else
  return by_c_library::write_shortest(first, last, value);
#endif
}

}  // namespace eom::decimals

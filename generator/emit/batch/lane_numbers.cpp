// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/batch/lane_numbers.hpp"

#include "emit/single_precision.hpp"
#include "emit/text.hpp"

namespace eomgen::emit {

Dialect lane_dialect(bool single, const std::string& prefix) {
  Dialect dialect;
  if (single) {
    dialect = single_dialect();
  } else {
    dialect.real = "double";
    dialect.constant = [](const symbolic::Rational& value) { return decimal(nearest_double(value)); };
    dialect.value = decimal;
    dialect.pi = "3.141592653589793";
    dialect.abs_function = "fabs";
  }
  dialect.use_lanes(prefix);
  return dialect;
}

std::vector<std::pair<std::string, std::string>> lane_template_values(bool single) {
  if (single) {
    return {{"real", "float"},
            {"integer", "int"},
            {"size", "4"},
            {"f", "f"},
            {"lanes_128", "4"},
            {"lanes_256", "8"},
            {"lanes_512", "16"},
            {"letter", "s"},
            {"letter_512", "d"},
            {"every_128", "15"},
            {"every_256", "255"},
            {"every_512", "65535"},
            {"all_but_sign", "0x7fffffffU"},
            {"wider", "FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16"}};
  }
  return {{"real", "double"},
          {"integer", "long long"},
          {"size", "8"},
          {"f", ""},
          {"lanes_128", "2"},
          {"lanes_256", "4"},
          {"lanes_512", "8"},
          {"letter", "d"},
          {"letter_512", "q"},
          {"every_128", "3"},
          {"every_256", "15"},
          {"every_512", "255"},
          {"all_but_sign", "0x7fffffffffffffffULL"},
          {"wider", "FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 1 && FLT_EVAL_METHOD != 16"}};
}

}  // namespace eomgen::emit

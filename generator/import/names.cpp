// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/names.hpp"

#include <array>

#include "model/names.hpp"

namespace eomgen::import {
namespace {

// Leaves room for names made of this one ("u_NAME", "NAME_origin") and for a number.
constexpr std::size_t longest_name = 48;
// Outputs that coordinates and definitions may not be named as (docs/model-format.md).
constexpr std::array<std::string_view, 6> output_names{"energy", "kinetic", "potential", "power", "jacobi", "all"};

std::string legal(std::string_view wanted) {
  std::string name;
  for (const char c : wanted.substr(0, longest_name)) name += model::is_identifier(std::string{'x', c}) ? c : '_';
  if (name.empty() || !model::is_identifier(name)) name = "n" + name;
  return name;
}

}  // namespace

std::string Names::claim(std::string_view wanted, std::string_view suffix) {
  const std::string base = legal(wanted);
  const auto is_free = [&](const std::string& name) {
    return !model::name_error(name) && !taken_.contains(name) &&
           std::find(output_names.begin(), output_names.end(), name) == output_names.end();
  };
  std::string name = base;
  if (!is_free(name)) name += suffix;
  for (int number = 2; !is_free(name); ++number) name = base + std::string(suffix) + std::to_string(number);
  taken_.insert(name);
  return name;
}

}  // namespace eomgen::import

// SPDX-License-Identifier: GPL-3.0-or-later
#include "system/output.hpp"

#include "lists.hpp"

namespace eomgen::system {

const Output* find(const std::vector<Output>& outputs, const std::string& name) { return find_named(outputs, name); }

std::vector<std::string> names_of(const std::vector<Output>& outputs, OutputKind kind, std::uint32_t index) {
  std::vector<std::string> names;
  for (const Output& output : outputs) {
    if (output.kind == kind && output.index == index) names.push_back(output.name);
  }
  return names;
}

std::string per_second(const std::string& unit, int times) {
  if (unit.empty()) return "";
  const std::string seconds = times == 1 ? "s" : "s^" + std::to_string(times);
  if (unit == "1") return "1/" + seconds;
  return (unit.find('/') == std::string::npos ? unit : "(" + unit + ")") + "/" + seconds;
}

}  // namespace eomgen::system

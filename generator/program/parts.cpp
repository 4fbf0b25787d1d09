// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/parts.hpp"

namespace eomgen::program {
namespace {

// Maximum number of instructions of an undivided function, and of a part.
constexpr std::size_t max_function_length = 3000, max_part_length = 1000;

}  // namespace

std::vector<std::size_t> assign_parts(const Function& function) {
  const auto& code = function.code;
  std::vector<std::size_t> part(code.size(), 0);
  if (code.size() <= max_function_length) return part;
  std::size_t now = 0;
  for (std::size_t i = 0, since = 0; i < code.size(); ++i, ++since) {
    const bool together = i > 0 && code[i].pack != 0 && code[i].pack == code[i - 1].pack;
    if (since >= max_part_length && !together) {
      ++now;
      since = 0;
    }
    part[i] = now;
  }
  return part;
}

}  // namespace eomgen::program

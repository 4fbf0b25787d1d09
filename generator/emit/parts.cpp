// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/parts.hpp"

#include <fmt/format.h>

namespace eomgen::emit {
namespace {

// Maximum number of instructions of an undivided function, and of a part.
constexpr std::size_t max_function_length = 3000, max_part_length = 1000;

}  // namespace

std::vector<std::size_t> assign_parts(const program::Function& function) {
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

std::string part_calls(const std::string& name, const FunctionText& text, const std::string& arguments,
                       const std::string& real) {
  std::string result = fmt::format("  {} {}[{}];\n", real, text.work, text.work_size);
  for (std::size_t k = 1; k <= text.parts.size(); ++k) {
    const std::string call = fmt::format("{}_part{}({}, {})", name, k, arguments, text.work);
    if (k == text.parts.size())
      result += fmt::format("  return {};\n", call);
    else
      result += fmt::format("  {}{} = {};\n  if ({} != 0) return {};\n", k == 1 ? "int " : "", text.code, call,
                            text.code, text.code);
  }
  return result;
}

}  // namespace eomgen::emit

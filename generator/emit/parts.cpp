// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/parts.hpp"

#include <fmt/format.h>

namespace eomgen::emit {

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

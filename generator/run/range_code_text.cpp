// SPDX-License-Identifier: GPL-3.0-or-later
// Code as statements of C++, for programs that run without the generator: the same operations in the same order, so
// that they give the same bits.
#include <fmt/format.h>

#include "run/range_code.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::run {

using symbolic::Op;

std::string RangeCode::text(const std::vector<std::string>& variables, std::size_t root) const {
  std::string result;
  for (std::size_t i = 0; i <= roots_[root]; ++i) {
    const Step& step = code_[i];
    const auto arg = [&](std::size_t k) { return fmt::format("v{}", step.args[k]); };
    const auto infix = [&](const char* op) { return arg(0) + op + arg(1); };
    std::string value;
    switch (step.op) {
      case Op::constant:
      case Op::pi: value = fmt::format("{:.17g}", constants_[static_cast<std::size_t>(step.payload)]); break;
      case Op::symbol: value = variables.at(static_cast<std::size_t>(step.payload)); break;
      case Op::add: value = infix(" + "); break;
      case Op::sub: value = infix(" - "); break;
      case Op::mul: value = infix(" * "); break;
      case Op::div: value = infix(" / "); break;
      case Op::neg: value = "-" + arg(0); break;
      case Op::power: value = fmt::format("std::pow({}, {}.0)", arg(0), step.payload); break;
      case Op::abs: value = fmt::format("{0} < 0 ? -{0} : {0}", arg(0)); break;
      case Op::sign: value = fmt::format("{0} > 0 ? 1 : {0} < 0 ? -1 : 0", arg(0)); break;
      case Op::min: value = fmt::format("{0} - {1} > 0 ? {1} : {0}", arg(0), arg(1)); break;
      case Op::max: value = fmt::format("{0} - {1} < 0 ? {1} : {0}", arg(0), arg(1)); break;
      case Op::select: value = fmt::format("{} - {} < 0 ? {} : {}", arg(0), arg(1), arg(2), arg(3)); break;
      default: {
        const symbolic::Function& function = symbolic::function_of(step.op);
        value = fmt::format("std::{}({}{})", function.code, arg(0), function.arity == 2 ? ", " + arg(1) : "");
      }
    }
    result += fmt::format("const double v{} = {};\n", i, value);
  }
  return result + fmt::format("return v{};", roots_[root]);
}

}  // namespace eomgen::run

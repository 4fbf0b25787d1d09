// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/op_names.hpp"

#include "symbolic/functions.hpp"

namespace eomgen::symbolic {

const char* op_name(Op op) {
  switch (op) {
    case Op::constant: return "number";
    case Op::pi: return "pi";
    case Op::symbol: return "symbol";
    case Op::add: return "+";
    case Op::sub: return "-";
    case Op::mul: return "*";
    case Op::div: return "/";
    case Op::neg: return "neg";
    case Op::power: return "^";
    default: return function_of(op).name;
  }
}

}  // namespace eomgen::symbolic

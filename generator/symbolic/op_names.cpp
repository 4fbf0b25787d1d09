// SPDX-License-Identifier: GPL-3.0-or-later
#include "symbolic/op_names.hpp"

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
    case Op::power:
    case Op::pow: return "^";
    case Op::sqrt: return "sqrt";
    case Op::sin: return "sin";
    case Op::cos: return "cos";
    case Op::tan: return "tan";
    case Op::asin: return "asin";
    case Op::acos: return "acos";
    case Op::atan: return "atan";
    case Op::sinh: return "sinh";
    case Op::cosh: return "cosh";
    case Op::tanh: return "tanh";
    case Op::exp: return "exp";
    case Op::log: return "log";
    case Op::abs: return "abs";
    case Op::sign: return "sign";
    case Op::atan2: return "atan2";
    case Op::min: return "min";
    case Op::max: return "max";
    case Op::select: return "if";
  }
  return "";
}

}  // namespace eomgen::symbolic

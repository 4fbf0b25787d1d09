// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/rounding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "numeric/numbers.hpp"
#include "symbolic/arithmetic.hpp"
#include "symbolic/functions.hpp"

namespace eomgen::program {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double smallest_normal = std::numeric_limits<double>::min();  // smaller numbers lose digits
constexpr double library_half_units = 4;                                // error of C library functions in half units

/// A value and the bound of its error.
struct BoundedValue {
  double value = 0, error = 0;
};

BoundedValue rounded(double value, double error, double half_units = 1) {
  if (!std::isfinite(value)) return {value, infinite};
  return {value,
          error + half_units * unit_roundoff * std::fabs(value) + (value == 0 && error == 0 ? 0 : smallest_normal)};
}

/// x times y with 0 times infinity = 0.
double times(double x, double y) { return x == 0 || y == 0 ? 0 : x * y; }

BoundedValue product(const BoundedValue& a, const BoundedValue& b) {
  const double error =
      times(a.error, std::fabs(b.value)) + times(std::fabs(a.value), b.error) + times(a.error, b.error);
  if (a.value == 0 && a.error == 0) return {0, 0};
  if (b.value == 0 && b.error == 0) return {0, 0};
  return rounded(a.value * b.value, error);
}

BoundedValue quotient(const BoundedValue& a, const BoundedValue& b) {
  const double least = std::fabs(b.value) - b.error;  // smallest magnitude of the denominator
  if (!(least > 0)) return {a.value / b.value, infinite};
  const double value = a.value / b.value;
  return rounded(value, (a.error + std::fabs(value) * b.error) / least);
}

BoundedValue root(const BoundedValue& a) {
  if (a.value - a.error > 0) return rounded(std::sqrt(a.value), a.error / std::sqrt(a.value - a.error));
  return a.error == 0 && a.value == 0
             ? BoundedValue{0, 0}
             : BoundedValue{std::sqrt(std::max(0.0, a.value)), std::sqrt(std::fabs(a.value) + a.error)};
}

BoundedValue rounded_power(const BoundedValue& a, const BoundedValue& b) {
  const double value = std::pow(a.value, b.value);
  const double error =
      std::fabs(value) * (std::fabs(b.value) * a.error / std::fabs(a.value) + std::fabs(std::log(a.value)) * b.error);
  return rounded(value, error, library_half_units);
}

BoundedValue inverse_sine(Op op, const BoundedValue& a) {
  const double inside = (1 - std::fabs(a.value) - a.error) * (1 + std::fabs(a.value));
  const double error = inside > 0 ? a.error / std::sqrt(inside) : a.error == 0 ? 0 : std::sqrt(2 * a.error);
  return rounded(op == Op::asin ? std::asin(a.value) : std::acos(a.value), error, library_half_units);
}

/// `numbers` of symbolic::slope_of.
struct BinaryNumbers {
  static double one() { return 1; }
  static double two() { return 2; }
  static double square(double x) { return x * x; }
  static double call(Op op, double x) { return symbolic::Binary64Arithmetic::call(op, x); }
};

BoundedValue of_one(Op op, const BoundedValue& a) {
  const double x = a.value;
  // The slope at x plus half of the contribution of the curvature.
  const auto smooth = [&](double value, double slope) {
    return rounded(value, times(std::fabs(slope), a.error) + times(a.error, a.error), library_half_units);
  };
  switch (op) {
    case Op::sqrt: return root(a);
    case Op::asin:
    case Op::acos: return inverse_sine(op, a);
    case Op::log: return x - a.error > 0 ? smooth(std::log(x), 1 / (x - a.error)) : BoundedValue{std::log(x), infinite};
    case Op::abs: return {std::fabs(x), a.error};
    case Op::sign: return {x > 0 ? 1.0 : x < 0 ? -1.0 : x, std::fabs(x) < a.error ? infinite : 0};
    default: {
      const double value = BinaryNumbers::call(op, x);
      const auto [size, divides, falls] = symbolic::slope_of(symbolic::function_of(op), x, value, BinaryNumbers{});
      return smooth(value, divides ? 1 / size : size);
    }
  }
}

/// Whether rounding may reverse the comparison a < b.
bool undecided(const BoundedValue& a, const BoundedValue& b) {
  return a.error + b.error > 0 && std::fabs(a.value - b.value) <= a.error + b.error;
}

BoundedValue of_two(Op op, const BoundedValue& a, const BoundedValue& b) {
  switch (op) {
    case Op::div: return quotient(a, b);
    case Op::pow: return rounded_power(a, b);
    case Op::atan2: {
      const double square = a.value * a.value + b.value * b.value;
      return rounded(std::atan2(a.value, b.value),
                     (std::fabs(b.value) * a.error + std::fabs(a.value) * b.error) / square, library_half_units);
    }
    case Op::min: return {std::min(a.value, b.value), std::max(a.error, b.error)};
    case Op::max: return {std::max(a.value, b.value), std::max(a.error, b.error)};
    default: return {std::nan(""), infinite};
  }
}

class Run {
 public:
  Run(const Function& function, const Arguments<double>& arguments, const std::vector<double>& w_error)
      : function_(function), arguments_(arguments), w_off_(w_error) {}

  std::vector<std::vector<double>> operator()() {
    for (const Instruction& instruction : function_.code) value_.push_back(of(instruction));
    std::vector<std::vector<double>> result;
    for (const Result& of_function : function_.results) {
      result.emplace_back();
      for (const Operand& entry : of_function.entries) {
        const BoundedValue b = read(entry);
        result.back().push_back(std::isfinite(b.value) && std::isfinite(b.error) ? b.error : infinite);
      }
    }
    return result;
  }

 private:
  BoundedValue leaf(const Operand& operand) const {
    switch (operand.slot) {
      case Slot::constant: {
        const symbolic::Rational& exact = function_.constants[operand.index];
        const double value = cln::double_approx(exact);
        return {value, exact == numeric::exact(value) ? 0 : unit_roundoff * std::fabs(value)};
      }
      case Slot::pi: return {3.14159265358979323846, 2 * unit_roundoff};
      case Slot::time: return {arguments_.t, 0};
      case Slot::state: return {arguments_.x.at(operand.index), 0};
      case Slot::parameter: return {arguments_.p.at(operand.index), 0};
      case Slot::input: return {arguments_.u.at(operand.index), 0};
      case Slot::prepared:
        return {arguments_.w.at(operand.index), operand.index < w_off_.size() ? w_off_[operand.index] : 0};
      case Slot::vector: return {arguments_.v.at(operand.index), 0};
      case Slot::side: return {operand.index < arguments_.side.size() ? arguments_.side[operand.index] : 0, 0};
      case Slot::contact: return {static_cast<double>(contact_sign(arguments_, operand.index)), 0};
      case Slot::value: break;
    }
    return value_[operand.index];
  }
  BoundedValue read(const Operand& operand) const {
    BoundedValue result = leaf(operand);
    if (operand.negated) result.value = -result.value;
    return result;
  }

  BoundedValue of(const Instruction& instruction) const {
    std::vector<BoundedValue> o;
    for (const Operand& operand : instruction.operands) o.push_back(read(operand));
    if (instruction.op == Op::add || instruction.op == Op::mul) {
      BoundedValue result = o[0];
      for (std::size_t i = 1; i < o.size(); ++i) {
        result = instruction.op == Op::add ? rounded(result.value + o[i].value, result.error + o[i].error)
                                           : product(result, o[i]);
      }
      return result;
    }
    if (instruction.op == Op::select)
      return undecided(o[0], o[1]) ? BoundedValue{0, infinite} : o[0].value < o[1].value ? o[2] : o[3];
    return o.size() == 1 ? of_one(instruction.op, o[0]) : of_two(instruction.op, o[0], o[1]);
  }

  const Function& function_;
  const Arguments<double>& arguments_;
  const std::vector<double>& w_off_;
  std::vector<BoundedValue> value_;
};

}  // namespace

std::vector<std::vector<double>> rounding_bounds(const Function& function, const Arguments<double>& arguments,
                                                 const std::vector<double>& w_error) {
  return Run(function, arguments, w_error)();
}

}  // namespace eomgen::program

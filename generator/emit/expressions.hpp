// SPDX-License-Identifier: GPL-3.0-or-later
// Printing of one instruction of a Function as an expression of C or C++.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// Shorter values that are used once are printed inline.
inline constexpr std::size_t max_inline_length = 64;

/// Whether the printed form of an operation repeats its operands, which must then be names.
bool repeats_operands(symbolic::Op op);

class Expressions {
 public:
  /// Text and its operator precedence.
  struct Expression {
    enum Precedence : std::uint8_t { sum, product, atom };
    std::string text;
    Precedence precedence = atom;
  };

  Expressions(const program::Function& function, const ModelNames& names, const Dialect& dialect);

  Expression print(const program::Instruction& instruction);
  Expression unsigned_value(const program::Operand& operand) const;
  Expression signed_value(const program::Operand& operand) const;
  /// The operand as a lane vector if the dialect has lanes; numbers are broadcast.
  Expression in_lanes(const program::Operand& operand, bool with_sign = false) const;
  /// Sets the text for the value of instruction `index`.
  void set(std::size_t index, Expression value) { value_[index] = std::move(value); }

  const std::set<std::string>& library_calls() const { return library_calls_; }  // called functions of the C library
  void call(const std::string& name) { library_calls_.insert(name); }

 private:
  Expression print_operation(const program::Instruction& instruction);
  std::optional<Expression> print_lanes(const program::Instruction& instruction);
  Expression call(const std::string& name, const std::vector<program::Operand>& operands);
  Expression conditional(const std::string& a, const std::string& b, const std::string& x, const std::string& y) const;
  std::string function_name(symbolic::Op op) const;
  Expression rounded(Expression value) const;
  std::string first_factor(const program::Operand& operand) const;
  Expression product(const std::vector<program::Operand>& operands) const;
  Expression sum(const std::vector<program::Operand>& operands) const;

  const program::Function& function_;
  const ModelNames& names_;
  const Dialect& dialect_;
  std::vector<Expression> value_;
  std::set<std::string> library_calls_;
};

}  // namespace eomgen::emit

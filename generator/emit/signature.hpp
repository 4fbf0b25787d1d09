// SPDX-License-Identifier: GPL-3.0-or-later
// The arguments of each function of the ABI (abi/functions.inc), as emitted text.
#pragma once

#include <string>
#include <vector>

#include "emit/straight_line.hpp"
#include "emit/uses.hpp"

namespace eomgen::emit {

struct Argument {
  enum class Kind : std::uint8_t { number, input, mode, integer, result } kind;  // Real, const Real*, int, int, Real*
  program::Slot slot = program::Slot::constant;  // what is read from it; constant: nothing
  std::string name;
};

/// With the names that `text` and `names` give to them.
std::vector<Argument> arguments(const std::string& function, const FunctionText& text, const ModelNames& names);

/// With the names of docs/abi.md, results included.
std::vector<Argument> abi_arguments(const std::string& function);

/// The names of docs/abi.md, whatever the model's own names are.
ModelNames abi_names();

/// "double t, const double* x".
std::string argument_list(const std::vector<Argument>& arguments, const std::string& real);

/// "int NAME(double t, const double* x, ...)".
std::string function_head(const std::string& name, const program::Function& function, const FunctionText& text,
                          const ModelNames& names, const std::string& real);

/// "t, x, p, u, mode, dx": to hand them on.
std::string argument_names(const program::Function& function, const FunctionText& text, const ModelNames& names);

/// Arguments of a function that is printed whole which it does not read, and results without entries.
std::vector<std::string> unused(const program::Function& function, const FunctionText& text, const ModelNames& names,
                                const Leaves& leaves);

/// "  (void)x; (void)p;", a line; nothing where there are no names.
std::string ignored(const std::vector<std::string>& names);

}  // namespace eomgen::emit

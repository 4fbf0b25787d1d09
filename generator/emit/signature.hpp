// SPDX-License-Identifier: GPL-3.0-or-later
// Arguments of each function of the ABI (abi/functions.inc) as emitted text.
#pragma once

#include <string>
#include <vector>

#include "emit/straight_line.hpp"
#include "emit/uses.hpp"

namespace eomgen::emit {

struct Argument {
  enum class Kind : std::uint8_t {
    number,
    input,
    mode,
    integer,
    result
  } kind;                                        // Real, const Real*, const int*, int, Real*
  program::Slot slot = program::Slot::constant;  // kind of leaf that is read from it; constant: none
  std::string name;
};

/// The arguments with the names from `text` and `names`.
std::vector<Argument> arguments(const std::string& function, const FunctionText& text, const ModelNames& names);

/// The arguments with the names of docs/abi.md, results included.
std::vector<Argument> abi_arguments(const std::string& function);

/// The names of docs/abi.md, independent of the model's names.
ModelNames abi_names();

/// "double t, const double* x".
std::string argument_list(const std::vector<Argument>& arguments, const std::string& real);

/// "int NAME(double t, const double* x, ...)".
std::string function_head(const std::string& name, const program::Function& function, const FunctionText& text,
                          const ModelNames& names, const std::string& real);

/// The argument names "t, x, p, u, mode, dx" for a forwarding call.
std::string argument_names(const program::Function& function, const FunctionText& text, const ModelNames& names);

/// Arguments that a function printed in one piece does not read, and results without entries.
std::vector<std::string> unread_arguments(const program::Function& function, const FunctionText& text,
                                          const ModelNames& names, const Leaves& leaves);

/// A line "  (void)x; (void)p;" of casts; empty without names.
std::string void_casts(const std::vector<std::string>& names);

}  // namespace eomgen::emit

// SPDX-License-Identifier: GPL-3.0-or-later
// Printing of a Function as statements of C or C++, without the head, which each target writes.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "emit/context.hpp"
#include "program/program.hpp"

namespace eomgen::emit {

using program::Function;
using program::Instruction;
using program::Operand;
using program::Slot;
using symbolic::Op;

/// Syntax that differs between the languages of the C family.
struct Dialect {
  std::string real;                                    // "double", "Real"
  std::string (*constant)(const symbolic::Rational&);  // prints a nonnegative number
  std::string (*value)(double);                        // prints a default
  std::string pi;
  std::string abs_function;  // name of the function for |x|
  double pivot_tolerance = program::pivot_tolerance;
  std::string kernel_prefix;  // prefix of kernel names
  // Evaluates sines and cosines of small angles first. Without a call in between the compiler need not spill registers.
  // The function restarts if an angle turns out to be large (FunctionText::near_angles_first).
  bool near_angles_first = false;
  bool line_comments = false;
  bool using_std = false;                // emits `using std::sin;` before calls
  bool is_typed = true;                  // false: JavaScript, which declares constants without a type
  std::string sincos_range = "65536.0";  // largest angle of sincos (templates/kernels)
  std::string lane_prefix;               // prefix of the functions of templates/batch; empty: one state
  std::string lane_type;                 // type of one lane
  std::string rounding_function;         // function that rounds each value if the language has doubles only
  // Languages outside the C family (languages/language.hpp). Null: as in C.
  std::string (*conditional)(const std::string& a, const std::string& b, const std::string& x,
                             const std::string& y) = nullptr;                     // x if a < b, else y
  std::string (*element)(const std::string& array, std::size_t index) = nullptr;  // index from 0
  const char* (*function_name)(symbolic::Op op) = nullptr;

  /// The start of a declaration.
  std::string declaration_prefix() const { return is_typed ? "const " + real : "const"; }
  std::string rounded(const std::string& text) const {
    return rounding_function.empty() ? text : rounding_function + "(" + text + ")";
  }
  /// Switches to lane vectors of the same numbers.
  void use_lanes(const std::string& prefix) {
    lane_type = real;
    lane_prefix = prefix;
    real = prefix + "lanes";
  }
};

/// Identifiers of one model, shared by all its functions.
struct ModelNames {
  std::vector<std::string> state;  // entries of x: coordinates, then velocities
  std::vector<std::string> parameters, inputs, outputs, reactions, events, frames, inertial;
  std::vector<std::string> sides;     // kinks whose branches `mode` freezes
  std::size_t first_kink = 0;         // entry of `mode`
  std::vector<std::string> contacts;  // per contact: slides_NAME, normal_force_sign_NAME (eom/modes/contact_state.hpp)
  std::vector<std::string> acceleration;              // "theta_ddot", for the free coordinates
  std::vector<std::string> all_coordinates;           // with eliminated ones (for names that a Program suggests)
  std::vector<std::string> prepared;                  // entries of w, if lanes are loaded one by one
  std::vector<std::string> vector;                    // entries of v, if a function takes it
  std::string time = "t", x, p, w, u, mode, v = "v";  // names of the other arguments
};
/// The identifiers of a model. `taken`: further reserved words. `longest`: the most characters of a name.
ModelNames model_names(const program::Program& program, const EmissionContext& context,
                       std::span<const std::string_view> taken = {},
                       std::size_t longest = static_cast<std::size_t>(-1));

struct FunctionText {
  std::vector<std::string> results;  // names of the result arguments, in order
  std::string body;                  // statements, without braces
  std::uint32_t packs = 0;           // number of groups of sines and cosines
  bool near_angles_first = false;    // has a first argument `guarded`; if it is 0, -1 may be returned (angle too large)
  std::string guarded;
  /// Parts of a long function, called in order, because compile time grows faster than the length of a function. Each
  /// part has its own arguments and an array for values that later parts need. `body` is empty then.
  std::vector<std::string> parts;
  std::string work, code;  // names of the array and of the return code of a part
  std::size_t work_size = 1;
  // For lanes: the names of the arguments, and functions of the C library that are called lane by lane.
  std::string block, block_index;
  std::set<std::string> library;
};

/// Prints a function. The right-hand side returns code 5 if an entry of the lower half of its result is not finite.
FunctionText print_function(const program::Function& function, const ModelNames& names, const EmissionContext& context,
                            const Dialect& dialect);

}  // namespace eomgen::emit

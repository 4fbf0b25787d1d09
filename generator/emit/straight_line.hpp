// SPDX-License-Identifier: GPL-3.0-or-later
// A Function as statements of C or C++; everything but the function's head, which targets write themselves.
#pragma once

#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "emit/context.hpp"
#include "program/program.hpp"

namespace eomgen::emit {

/// How a language of the C family writes what differs.
struct Dialect {
  std::string real;                                    // "double", "Real"
  std::string (*constant)(const symbolic::Rational&);  // of a number that is not negative
  std::string (*value)(double);                        // of a default
  std::string pi;
  std::string absolute;  // name of the function |x|
  double pivot_tolerance = program::pivot_tolerance;
  std::string kernels;  // prefix of the kernels' names
  // Sines and cosines of near angles first, without a call in between that would make the compiler keep what it has in
  // memory; the function starts again where an angle turns out to be far (FunctionText::near_first).
  bool near_first = false;
  bool line_comments = false;
  bool using_std = false;         // `using std::sin;` before calls
  bool typed = true;              // false: JavaScript, where constants are declared without a type
  std::string reach = "65536.0";  // of the angles of sincos (templates/kernels)
  std::string lanes;              // several states side by side: the prefix of the functions of templates/batch
  std::string element;            // of lanes: what each of them holds
  std::string rounding;  // the function that every value goes through, where the language computes in double only

  /// What the declaration of a value begins with.
  std::string declares() const { return typed ? "const " + real : "const"; }
  std::string rounded(const std::string& text) const { return rounding.empty() ? text : rounding + "(" + text + ")"; }
  /// The same numbers, several side by side.
  void in_lanes_of(const std::string& prefix) {
    element = real;
    lanes = prefix;
    real = prefix + "lanes";
  }
};

/// Identifiers of one model: the same in all its functions.
struct ModelNames {
  std::vector<std::string> state;  // of x: coordinates, then velocities
  std::vector<std::string> parameters, inputs, outputs, reactions, events;
  std::vector<std::string> sides;            // of the kinks whose branches `mode` holds
  std::vector<std::string> contacts;         // per contact: slides_NAME, presses_NAME (eom/modes/contact_state.hpp)
  std::vector<std::string> acceleration;     // "theta_ddot", of the free coordinates
  std::vector<std::string> all_coordinates;  // of the model, also eliminated ones (for names that a Program suggests)
  std::vector<std::string> prepared;         // of w, where lanes are loaded one by one
  std::string arguments_t = "t", x, p, w, u, mode;  // names of the arguments that are left
};
/// `taken`: further words that no name may be.
ModelNames model_names(const program::Program& program, const EmissionContext& context,
                       std::span<const std::string_view> taken = {});

struct FunctionText {
  std::vector<std::string> results;  // names of the result arguments, in order
  std::string body;                  // statements, without braces
  std::uint32_t packs = 0;           // of sines and cosines that are computed together
  bool near_first = false;           // it takes a first argument `guarded`; where that is 0 it may return -1: too far
  std::string guarded;
  /// Of a long function: bodies of the parts that it calls one after the other, each with its own arguments and an
  /// array that keeps what later parts need; a compiler's time grows faster than the length of a function. `body` is
  /// empty then.
  std::vector<std::string> parts;
  std::string work, code;  // names of the array and of what a part returns
  std::size_t work_size = 1;
  // Of lanes: the names of the arguments, and functions of the C library that are called lane by lane.
  std::string block, now;
  std::set<std::string> library;
};

/// `checks_finite`: code 5 where an entry of the results' lower half is not finite.
FunctionText print_function(const program::Function& function, const ModelNames& names, const EmissionContext& context,
                            const Dialect& dialect);

}  // namespace eomgen::emit

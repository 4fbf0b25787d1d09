// SPDX-License-Identifier: GPL-3.0-or-later
// NAME_start (docs/abi.md, "Starts"): what follows from parameters and initial values that a caller gives. In: the
// formulas of a scene and the equations of its start as functions, and which entries belong to what. Out: the text of
// the function in C or JavaScript, from templates/kernels.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "emit/straight_line.hpp"

namespace eomgen::emit {

/// Entries of v are results of `values`; -1 stands for none. States are entries of x. An order is 0 for positions, 1
/// for rates; an entry of both orders is that of a state.
struct StartDescription {
  program::Function values;  // "start_values": v, a function of t, x, p; v[0], v[1]: the span of the scene
  program::Function rows;    // "start_rows": A (by rows), psi, b of the equations of the start

  bool has_time_kinks = false;  // constraints may have a kink in time: rates at one are those behind it

  std::vector<int> dependent;  // parameter, v
  std::vector<int> stated;     // state, v: initial values of the scene
  std::vector<int> initial;    // parameter that is the initial value of a state, state, v of its guess
  std::vector<int> early;      // parameter that is the initial value of an eliminated coordinate, v before the solution
  std::vector<int> late;       // the same, v after the solution
  std::vector<int> first_order;  // state of first order or discrete value, v after the solution
  std::vector<int> fixed;        // v of a stated value, v of the value that a constraint fixes
  std::vector<int> inside;       // v that must be positive: distances to the ends of ranges

  std::vector<int> guess;      // per state: v
  std::vector<int> movable;    // per state: 1 if it may change although it is given
  std::vector<int> angle;      // per state: 1 if it is an angle that is held at 0
  std::vector<int> unit;       // per state: the number of its four Euler parameters
  std::vector<int> quadruple;  // four states for each of them
  bool holds_angles = false;   // angles are held until the constraints need them: contacts
  bool tries_angles = false;   // .. until positions cannot be met otherwise: joints
  std::vector<int> taken;      // per row, order 0, then order 1: 1 if the row takes part
  std::vector<int> target;     // per row: v of its target
  std::vector<int> rolls;      // per row: the contact that rolls
  std::vector<int> contacts;   // per contact: the row that is 0 while it is closed
  std::size_t row_count() const { return target.size(); }
  /// `values`, and `rows` if there are any.
  std::vector<const program::Function*> functions() const;
};

/// The largest product of rows and coordinates: the function keeps its matrices on the stack.
inline constexpr std::size_t max_start_entries = 20000;

struct StartLanguage {
  bool is_c = true;
  std::string prefix;  // of functions of the file, "NAME_" or ""
  bool single = false;
};

/// The sizes and tolerances of the function, by their names in the skeletons. `suffix`: of literals in single
/// precision.
std::vector<std::pair<std::string, std::string>> start_numbers(const StartDescription& start,
                                                               const EmissionContext& context,
                                                               const program::Program& program, bool single,
                                                               const std::string& suffix);

/// The tables, the functions of the constraints and NAME_start. The functions start_values and start_rows precede it.
std::string start_text(const StartDescription& start, const EmissionContext& context, const program::Program& program,
                       const StartLanguage& language);

/// The prototype in C.
std::string start_head(const std::string& prefix, const std::string& real);
extern const char* const start_purpose;

/// Statements of the self test: the start of the default scene follows from nothing given.
std::string start_comparison(const EmissionContext& context, std::size_t states, const std::string& function,
                             const std::string& null_pointer, const std::string& real);

}  // namespace eomgen::emit

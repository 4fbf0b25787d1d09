// SPDX-License-Identifier: MIT
// The reason why a run ended early or has no valid end, as a value beside the outcome and as a sentence.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "eom/expressions/operations.hpp"
#include "eom/hybrid/text.hpp"

namespace eom::hybrid {

/// Whether the function of a kink, by its name in the code's list, is continuous there: only its slope jumps.
constexpr bool is_continuous_kink(std::string_view function) {
  using expressions::Op;
  for (auto op = std::uint8_t{0}; op <= static_cast<std::uint8_t>(Op::select); ++op) {
    const auto each = static_cast<Op>(op);
    if (is_kink(each) && !jumps(each) && function == name_of(each)) return true;
  }
  return false;
}

/// Why a run ended, if its outcome alone does not give it.
struct Reason {
  /// The kind of the reason.
  enum class Kind {
    none,
    method,                   // `what`: message of the method
    start,                    // it cannot be projected onto the constraints
    parameter,                // one is infinite or NaN
    rows,                     // interrupted while rows were written
    range,                    // the coordinate `what` leaves its range (lower, upper) between the times from and until
    position_jump,            // `what` jumps by `amount`, with an unbounded velocity
    branch_jump,              // `what` jumps by `amount`, at a surface in the state
    support_jump_in_contact,  // the velocity of a support jumps while a contact is closed
    support_jump_unsolvable,  // the velocity of a support jumps, and no velocities satisfy the constraints after it
    friction_no_solution,     // the friction law at the contact `what` has no solution
    friction_many_solutions,  // the friction law at the contact `what` has several solutions
    surface,                  // the motion slides along a surface of the function `what`
    reset_without_value,      // a value that the event or sample `what` sets has no value
    reset_off_constraints,    // the event or sample `what` sets coordinates or velocities that no constraint allows
    event_chain,              // events `what` cause one another without end
    slip,                     // slip starts and ends without progress in time
    chart,                    // a step leads beyond the singularity of the coordinates
    balance                   // the energy changes by the fraction `amount` more than the forces account for
  };
  Kind kind = Kind::none;
  double t = 0, amount = 0;
  std::string what = {};
  std::size_t index = 0;  // of the coordinate, contact or function
  double from = 0, until = 0, lower = 0, upper = 0;

  explicit operator bool() const { return kind != Kind::none; }
};

/// "" for none.
inline std::string sentence(const Reason& reason) {
  using Kind = Reason::Kind;
  const std::string at = " at t = " + printed(reason.t);
  switch (reason.kind) {
    case Kind::none: return "";
    case Kind::method: return reason.what;
    case Kind::start: return "the start cannot be projected onto the constraints";
    case Kind::parameter: return "a parameter is infinite or not a number";
    case Kind::rows: return "while rows were written";
    case Kind::range:
      return reason.what + " leaves its range (" + printed(reason.lower) + ", " + printed(reason.upper) +
             ") between t = " + printed(reason.from) + " and " + printed(reason.until);
    case Kind::position_jump:
      return reason.what + " jumps at t = " + printed(reason.t, 15) + " by " + printed(reason.amount, 6) +
             ", with an unbounded velocity: make it a motion that takes some time";
    case Kind::branch_jump:
      return reason.what + " jumps by " + printed(reason.amount, 6) + " at t = " + printed(reason.t, 15) +
             ", where a branch of `if` or `sign` changes: the equations do not determine the effect of the impulse; "
             "make "
             "it a steep but smooth step, for example tanh((x - a)/w), or a constraint that holds = \"unilateral\"";
    case Kind::support_jump_in_contact:
      return "the velocity of a support jumps" + at +
             " while a contact is closed: the equations do not determine the effect of the impulse; make it a motion "
             "that takes some time";
    case Kind::support_jump_unsolvable:
      return "the velocity of a support jumps" + at + ", and no velocities satisfy the constraints after it";
    case Kind::friction_no_solution:
    case Kind::friction_many_solutions:
      return "just after t = " + printed(reason.t) + " the law of friction at '" + reason.what + "' has " +
             (reason.kind == Kind::friction_no_solution ? "no solution" : "several solutions") +
             ": friction changes its own normal force by more than that force (Painleve)";
    case Kind::surface:
      // No motion slides along a kink without a jump: the last digit of the state decides its side.
      if (is_continuous_kink(reason.what))
        return "a kink of " + reason.what + " is so narrow" + at +
               " that rounding of the state hides its side: make it wider, or take coordinates that are 0 there";
      return "the motion slides along a surface of " + reason.what + ": on both sides it leads back to it," + at +
             "; for dry friction use a constraint with friction, or a smooth law";
    case Kind::reset_without_value: return "a new value that '" + reason.what + "' sets is not finite" + at;
    case Kind::reset_off_constraints:
      return "'" + reason.what + "' sets values" + at + " that violate the constraints" +
             (reason.amount > 0 ? " (by a displacement of " + printed(reason.amount, 2) + ")" : "") +
             ": set coordinates that satisfy them; velocities are made consistent by impulses of the constraints";
    case Kind::event_chain:
      return "events follow one another without end" + at + ": " + reason.what +
             "; give them a direction or a condition (`if`), or a contact (holds = \"unilateral\") in place of bounces";
    case Kind::slip: return "slip starts and ends" + at + " without progress in time";
    case Kind::chart:
      return "a step just after t = " + printed(reason.t) +
             " leads beyond the singularity of the coordinates: choose a shorter one";
    case Kind::balance:
      return "the energy changes by " + printed(reason.amount, 2) +
             " of itself more than the forces account for, and the error estimate does not explain it: something "
             "was passed over; compare with shorter steps, a tighter rtol or another solver";
  }
  return "";
}

}  // namespace eom::hybrid

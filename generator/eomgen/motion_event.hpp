// SPDX-License-Identifier: GPL-3.0-or-later
// Events of runs as the library returns them.
#pragma once

#include "eomgen/motion.hpp"
#include "run/runner.hpp"

namespace eomgen {

/// The event of a run, for a caller of the library.
inline MotionEvent motion_event(const run::RunEvent& from) {
  MotionEvent to{from.t, from.kind, from.name, from.work};
  for (const eom::hybrid::ContactImpulse& one : from.impulses)
    to.impulses.push_back({one.contact, one.normal, one.friction, one.work});
  return to;
}

}  // namespace eomgen

// SPDX-License-Identifier: GPL-3.0-or-later
// The events of a run as a report lists them. A contact that bounces to rest has infinitely many impacts in a finite
// time, of which a run makes as many as its tolerances resolve: the list sums up short bounces. In: all events. Out:
// the list.
#pragma once

#include <vector>

#include "run/runner.hpp"

namespace eomgen::run {

/// Bounces of a contact that are shorter than this share of the longest time from an impact, an opening or the start to
/// its next impact are not listed one by one.
inline constexpr double short_bounce = 1e-3;

struct ListedEvent {
  RunEvent event;           // impulses and work: summed over the impacts
  std::size_t impacts = 1;  // of a `contact` event: its own, and those of the short bounces that follow it
};

/// events: in order of time, of a run that starts at t0. An impact of a contact that ends a short bounce is summed up
/// in the listed impact before it; other events of the contact in that bounce (lose_contact, slip, stick) are left out.
std::vector<ListedEvent> list_events(const std::vector<RunEvent>& events, double t0);

}  // namespace eomgen::run

// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/event_list.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <string>

namespace eomgen::run {
namespace {

/// A contact on its way through the events.
struct Flight {
  double begin;                           // when it opened last, or its last impact
  double longest = 0;                     // of its flights so far
  std::optional<std::size_t> impact;      // its last listed impact
  std::vector<std::size_t> changes = {};  // its other events since the last impact
};

bool is_of_contact(const RunEvent& event) {
  return event.kind == "contact" || event.kind == "lose_contact" || event.kind == "slip" || event.kind == "stick" ||
         event.kind == "roll" || event.kind == "reverse";
}

void add_impulse(std::vector<eom::hybrid::ContactImpulse>& sums, const eom::hybrid::ContactImpulse& one) {
  const auto sum = std::find_if(sums.begin(), sums.end(), [&](const auto& s) { return s.contact == one.contact; });
  if (sum == sums.end()) {
    sums.push_back(one);
    return;
  }
  sum->normal += one.normal;
  sum->work += one.work;
  for (std::size_t a = 0; a < sum->friction.size() && a < one.friction.size(); ++a) sum->friction[a] += one.friction[a];
}

}  // namespace

std::vector<ListedEvent> list_events(const std::vector<RunEvent>& events, double t0) {
  std::vector<ListedEvent> all;
  for (const RunEvent& event : events) all.push_back({event});
  std::map<std::string, Flight> flights;
  std::vector<bool> is_listed(events.size(), true);
  std::vector<std::size_t> sum_of(events.size(), 0);  // of an impact that is not listed: the one before it
  for (std::size_t k = 0; k < events.size(); ++k) {
    const RunEvent& event = events[k];
    if (!is_of_contact(event)) continue;
    Flight& flight = flights.try_emplace(event.name, Flight{t0, 0, std::nullopt}).first->second;
    if (event.kind != "contact") {
      if (event.kind == "lose_contact") flight.begin = event.t;
      flight.changes.push_back(k);
      continue;
    }
    const double length = event.t - flight.begin;
    flight.begin = event.t;
    if (flight.impact && length <= short_bounce * flight.longest) {
      is_listed[k] = false;
      for (const std::size_t change : flight.changes) is_listed[change] = false;
      ++all[*flight.impact].impacts;
      sum_of[k] = *flight.impact;
    } else {
      flight.impact = k;
    }
    flight.longest = std::max(flight.longest, length);
    flight.changes.clear();
  }
  // Of the events of one impact, the first has the impulses of all contacts.
  for (std::size_t k = 0; k < events.size(); ++k) {
    if (is_listed[k] || events[k].kind != "contact") continue;
    std::size_t to = sum_of[k];
    for (std::size_t i = k + 1; i < events.size() && events[i].t == events[k].t; ++i) {
      if (!is_listed[i] || events[i].kind != "contact" || !events[i].impulses.empty()) continue;
      to = i;
      break;
    }
    all[to].event.work += events[k].work;
    for (const eom::hybrid::ContactImpulse& one : events[k].impulses) add_impulse(all[to].event.impulses, one);
  }
  std::vector<ListedEvent> listed;
  for (std::size_t k = 0; k < events.size(); ++k)
    if (is_listed[k]) listed.push_back(std::move(all[k]));
  return listed;
}

}  // namespace eomgen::run

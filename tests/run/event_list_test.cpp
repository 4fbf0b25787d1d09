// SPDX-License-Identifier: GPL-3.0-or-later
// Short bounces are summed up in the list of events; flights of ordinary length, and all other events, stay.
#include "run/event_list.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace eomgen::run;

namespace {

RunEvent impact(double t, const std::string& contact, double normal) {
  return {t, "contact", contact, -normal, {{contact, normal, {normal / 2}, -normal}}};
}
RunEvent change(double t, const std::string& kind, const std::string& contact) { return {t, kind, contact, 0, {}}; }

/// A ball that falls for 1 s and bounces n times, each flight `ratio` times as long as the one before.
std::vector<RunEvent> bounces(int n, double ratio) {
  std::vector<RunEvent> events;
  double t = 1, flight = 2 * ratio, normal = 1;
  for (int k = 0; k < n; ++k, t += flight, flight *= ratio, normal *= ratio)
    events.push_back(impact(t, "floor", normal));
  return events;
}

}  // namespace

TEST_CASE("event list: the number of listed bounces does not depend on that of the resolved ones") {
  // Flights: 1, 2 r, 2 r^2, ...; the longest is 1 for r = 1/2. Those above 1e-3 are listed.
  const std::vector<RunEvent> all = bounces(40, 0.5);
  const std::vector<ListedEvent> list = list_events(all, 0), shorter = list_events(bounces(25, 0.5), 0);
  REQUIRE(list.size() == 11);  // the first impact, and 2 r^k > 1e-3
  CHECK(shorter.size() == list.size());
  CHECK(list.back().impacts == 30);
  CHECK(shorter.back().impacts == 15);
  double normal = 0, work = 0, friction = 0;
  for (const ListedEvent& one : list) {
    REQUIRE(one.event.impulses.size() == 1);
    normal += one.event.impulses[0].normal, friction += one.event.impulses[0].friction[0], work += one.event.work;
  }
  CHECK(normal == doctest::Approx(2 - std::ldexp(1.0, -39)).epsilon(1e-14));
  CHECK(friction == doctest::Approx(normal / 2).epsilon(1e-14));
  CHECK(work == doctest::Approx(-normal).epsilon(1e-14));
}

TEST_CASE("event list: bounces that become longer, short flights of a contact that had no longer one, other events") {
  const std::vector<RunEvent> growing = bounces(8, 2);
  CHECK(list_events(growing, 0).size() == growing.size());
  // A contact that is closed at the start: the time before it opens is no flight.
  const std::vector<RunEvent> hop{change(10, "lose_contact", "foot"), impact(10.001, "foot", 1),
                                  change(10.001, "stick", "foot")};
  CHECK(list_events(hop, 0).size() == hop.size());
  std::vector<RunEvent> mixed{impact(1, "floor", 1),
                              change(1.5, "lose_contact", "floor"),
                              change(1.50001, "slip", "floor"),
                              {1.50002, "custom", "apex", 0, {}},
                              impact(1.5001, "floor", 0.1),
                              change(1.5001, "stick", "floor")};
  const std::vector<ListedEvent> list = list_events(mixed, 0);
  REQUIRE(list.size() == 3);
  CHECK(list[0].impacts == 2);
  CHECK(list[1].event.kind == "custom");
  CHECK(list[2].event.kind == "stick");
}

TEST_CASE("event list: an impact of a short and of a long flight together keeps its impulses") {
  std::vector<RunEvent> events{impact(1, "left", 1), impact(1.0001, "left", 0.25), change(1.0001, "contact", "right")};
  events[1].impulses.push_back({"right", 3, {0}, 0});
  const std::vector<ListedEvent> list = list_events(events, 0);
  REQUIRE(list.size() == 2);
  CHECK(list[0].impacts == 2);
  CHECK(list[0].event.impulses.size() == 1);
  CHECK(list[1].event.name == "right");
  REQUIRE(list[1].event.impulses.size() == 2);
  CHECK(list[1].event.impulses[1].normal == 3);
}

// Events of many runs at once: events and end of each member are bitwise equal to those of integrate_events().
#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "eom/ensemble/integrate.hpp"
#include "eom/ode.hpp"
#include "lib/ensemble_members.hpp"

using namespace members;

namespace {

struct Seen {
  double t, x0;
  std::size_t function;
  bool up;
  bool operator==(const Seen&) const = default;
};

struct Watched {
  End end;
  std::vector<Seen> seen;
};
struct WatchedAlone {
  eom::Result end;
  std::vector<Seen> seen;
};

const eom::EventFunction watched_functions[] = {
    {eom::Direction::any, eom::Watch::passing}, {eom::Direction::down}, {eom::Direction::up, eom::Watch::passing}};

Seen seen(const eom::EventPoint& point) { return {point.t, point.x[0], point.crossing.function, point.crossing.up}; }

template <class Rhs>
std::vector<Watched> watched(const char* method, const Rhs& rhs, std::size_t members,
                             const eom::EnsembleOptions& options) {
  std::vector<Watched> all(members);
  eom::integrate_ensemble_events(
      method, rhs, members, states, parameters, options, watched_functions,
      [&](std::size_t member, const eom::EventPoint& point) { all[member].seen.push_back(seen(point)); }, start_of,
      [&](const eom::EnsembleEnd& end) { all[end.member].end.take(end); });
  return all;
}

template <class Rhs>
WatchedAlone watched_alone(const char* method, const Rhs& rhs, std::size_t i, const eom::EnsembleOptions& options) {
  Member member(i);
  auto one = rhs.member_rhs(i, member.p.data());
  WatchedAlone result;
  const auto g = [&](double t, const double* at, double* values) { return one.events(t, at, values); };
  const auto handler = [&](const eom::EventPoint& point) {
    result.seen.push_back(seen(point));
    return point.crossing.function == 1 ? eom::EventAction::stop : eom::EventAction::resume;
  };
  result.end =
      eom::integrate_events(method, one, member.start.t0, member.x, member.start.t1, eom::ensemble::options_of(options),
                            g, {std::begin(watched_functions), std::end(watched_functions)}, handler);
  return result;
}

template <class Rhs>
void events_as_alone(const char* method, const Rhs& rhs, const eom::EnsembleOptions& options) {
  const std::vector<Watched> all = watched(method, rhs, 120, options);
  std::size_t reported = 0, stopped = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    CAPTURE(std::string(method));
    CAPTURE(i);
    const WatchedAlone one = watched_alone(method, rhs, i, options);
    check_same(all[i].end, one.end);
    CHECK(all[i].seen == one.seen);
    reported += all[i].seen.size();
    stopped += all[i].end.outcome == eom::Outcome::stopped_by_event ? 1 : 0;
  }
  CHECK(reported > 100);
  CHECK(stopped > 20);
}

}  // namespace

TEST_CASE("ensemble: events and end of every member are bitwise those of a single run") {
  for (const char* method : {"rk4", "dopri5", "tsit5", "dop853"}) {
    eom::EnsembleOptions options;
    if (std::string(method) == "rk4") options.fixed_step = 0.02;
    options.lanes = 13;
    options.threads = 2;
    events_as_alone(method, Plain{}, options);
  }
  eom::EnsembleOptions options;
  options.rtol = 1e-6;
  options.lanes = 13;
  events_as_alone("rodas", WithJacobians{}, options);
  options.quadratures = 1;
  events_as_alone("rodas", WithJacobians{3}, options);
  options.quadratures = 0;
  options.rtol = 1e-9;
  events_as_alone("taylor", WithSeries{}, options);
  CHECK_THROWS_AS(watched("rodas", Plain{}, 1, {}), std::invalid_argument);
}

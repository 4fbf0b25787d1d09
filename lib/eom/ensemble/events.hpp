// SPDX-License-Identifier: MIT
// Events of members that are integrated side by side. Each member has its own locator, and crossings are refined with
// its own functions, as integrate_events() does. In: steps of a member, its functions. Out: crossings, passed to a
// callback; a breaking one ends the member.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "eom/ensemble/members.hpp"
#include "eom/events/integrate.hpp"

namespace eom::ensemble {

/// The first parameter: (size_t member, const double* p) -> an object with operator()(t, x, dx), events(t, x, values)
/// and optionally hidden_crossing() of EventLocator. The second: (size_t member, const EventPoint&).
template <class MemberRhs, class OnCrossing>
class EventMonitor {
 public:
  static constexpr bool dense = true;

  EventMonitor(std::string_view method, MemberRhs& member_rhs, std::span<const EventFunction> functions,
               OnCrossing& on_crossing, const EnsembleOptions& options, std::size_t slots)
      : method_(method),
        member_rhs_(member_rhs),
        functions_(functions.begin(), functions.end()),
        on_crossing_(on_crossing),
        options_(options_of(options)),
        slots_(slots) {}

  Outcome begin(std::size_t slot, std::size_t member, const EnsembleStart& start) {
    slots_[slot] = std::make_unique<Slot>(*this, member, start);
    return slots_[slot]->run.begin() ? Outcome::done : slots_[slot]->run.total().outcome;
  }
  bool step(std::size_t slot, const StepView& view) { return slots_[slot]->run.observe(view); }
  /// x: the storage of end.x.
  void end(std::size_t slot, EnsembleEnd& end, std::span<double> x) {
    Options piece;
    slots_[slot]->run.continue_after_piece({end.outcome, end.t, {x.begin(), x.end()}, end.statistics, ""}, piece);
    const Result& total = slots_[slot]->run.total();
    end.outcome = total.outcome;
    end.t = total.t;
    end.statistics = total.statistics;
    std::copy(total.x.begin(), total.x.end(), x.begin());
    slots_[slot].reset();
  }

 private:
  using One = decltype(std::declval<MemberRhs&>()(std::size_t{}, static_cast<const double*>(nullptr)));
  struct Functions {
    One& one;
    int operator()(double t, const double* x, double* values) const { return one.events(t, x, values); }
    void begin_step(const StepView& view) const requires requires { one.begin_step(view); }
    { one.begin_step(view); }
    auto hidden_crossing(const StepView& view, std::size_t i, int side, double from,
                         double to) const requires requires {
      one.hidden_crossing(view, i, side, from, to);
    }
    { return one.hidden_crossing(view, i, side, from, to); }
  };
  struct Handler {
    OnCrossing& on_crossing;
    std::size_t member;
    EventAction operator()(const EventPoint& point) const {
      const bool ends = point.functions[point.crossing.function].watch == Watch::breaking;
      on_crossing(member, point);
      return ends ? EventAction::stop : EventAction::resume;
    }
  };
  struct Slot {
    Slot(EventMonitor& of, std::size_t member, const EnsembleStart& start)
        : p(start.p.begin(), start.p.end()),
          one(of.member_rhs_(member, p.data())),
          system(system_of(one)),
          functions{one},
          handler{of.on_crossing_, member},
          run(of.method_, system, functions, of.functions_, start.t0, start.x, start.t1, of.options_, handler, observer,
              after_step) {}
    std::vector<double> p;
    One one;
    System system;
    Functions functions;
    Handler handler;
    NoObserver observer;
    NoProjection after_step;
    events::Run<System, Functions, Handler, NoObserver, NoProjection> run;
  };

  std::string_view method_;
  MemberRhs& member_rhs_;
  std::vector<EventFunction> functions_;
  OnCrossing& on_crossing_;
  Options options_;
  std::vector<std::unique_ptr<Slot>> slots_;
};

}  // namespace eom::ensemble

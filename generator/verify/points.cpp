// SPDX-License-Identifier: GPL-3.0-or-later
#include "verify/points.hpp"

#include <cln/float.h>
#include <cln/integer.h>
#include <cln/rational.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"
#include "verify/linear_solve.hpp"

namespace eomgen::verify {
namespace {

// Initial spread of random values around the defaults and initial values; it narrows after rejections.
constexpr double parameter_spread = 0.25;    // relative
constexpr double coordinate_spread = 0.5;    // of the scale of its unit
constexpr double angle_spread = 1.2;         // rad
constexpr double range_margin = 0.05;        // of a chart's range, at either end: charts are singular there
constexpr double longest_span = 100;         // s; later times add no new tests
constexpr double kink_margin = 1e-6;         // so that rounding to binary64 cannot change the branch
constexpr std::size_t patience = 12;         // attempts to close the same contacts before one of them is left open
constexpr std::size_t inside_patience = 48;  // the same if they close, but never within the ranges

bool is_angle(const model::Unit& unit) { return unit.text == "rad" || unit.text == "1"; }

}  // namespace

Points::Points(const Oracle& oracle, std::uint64_t seed, std::size_t cap, std::map<std::uint32_t, cln::cl_RA> fixed,
               std::vector<std::size_t> leavable)
    : oracle_(oracle), engine_(seed), cap_(cap), fixed_(std::move(fixed)), leavable_(std::move(leavable)), choosings_(1) {
  try {
    read_scene();
  } catch (const NoValue& none) {
    throw Error("verify", none.where, std::string("this has no value: ") + none.what(),
                "check the numbers that it is computed from");
  }
}

double Points::uniform() { return (static_cast<double>(engine_() >> 12) + 0.5) * 0x1p-52; }
double Points::symmetric() { return 2 * uniform() - 1; }
Real Points::exact(double value) const { return oracle_.precision().round(verify::exact(value)); }

// ---- ranges and scales from the model file

void Points::read_scene() {
  const model::Model& m = oracle_.model();
  State start;
  start.integrals.assign(m.integrals.size(), Real(0));  // integrals begin at the start
  start.parameters = oracle_.default_parameters();
  const model::Scene* scene = m.scenes.empty() ? nullptr : &m.scenes.front();
  if (scene != nullptr)
    for (const auto& [index, value] : scene->parameters)
      start.parameters[index] = oracle_.constant(value, oracle_.parameters(start.parameters));
  defaults_ = start.parameters;
  start.parameters = oracle_.parameters(defaults_);
  if (scene != nullptr && scene->t0 != model::no_node) {
    t0_ = cln::double_approx(oracle_.constant(scene->t0, start.parameters));
    t1_ = t0_ + 1;
    if (scene->t1 != model::no_node) t1_ = cln::double_approx(oracle_.constant(scene->t1, start.parameters));
  }
  t1_ = std::min(t1_, t0_ + longest_span);
  start.t = exact(t0_);  // before functions of time are evaluated: they may be undefined at other times
  for (const model::Input& input : m.inputs) {
    start.inputs.push_back(oracle_.constant(input.default_value, start.parameters));
    input_defaults_.push_back(cln::double_approx(start.inputs.back()));
  }
  start.q.assign(m.coordinates.size(), exact(0));
  start.qdot = start.qddot = start.q;
  std::vector<bool> given(m.coordinates.size(), false);
  if (scene != nullptr)
    for (const auto* values : {&scene->guess, &scene->initial})
      for (const model::InitialValue& value : *values) {
        std::vector<Real>& target = value.order == 0 ? start.q : start.qdot;
        try {
          target[value.coordinate] = oracle_.value(value.value, start);
          if (values == &scene->initial && value.order == 0) given[value.coordinate] = true;
        } catch (const std::domain_error&) {
          continue;  // the start depends on values that only the constraints determine, or a function has no rate at
                     // this time, as t^1.5 at 0
        }
      }
  read_ranges(start);
  read_scales();
  settle(std::move(start), given);
}

/// Coordinates without an initial value follow from the constraints: neither their guess nor 0 gives their usual values
/// and scales.
void Points::settle(State start, const std::vector<bool>& given) {
  const bool holonomic = [&] {
    for (std::size_t k = 0; k < oracle_.constraints().size(); ++k)
      if (oracle_.holonomic(k)) return true;
    return false;
  }();
  if (!holonomic || std::find(given.begin(), given.end(), false) == given.end()) return;
  for (std::size_t i = 0; i < choices_.size(); ++i) start.q[i] = exact(choices_[i].center);
  for (const std::size_t j : leavable_) start.apart.insert(j);  // unilateral constraints may be open
  try {
    project_positions(start, &given);
    require_inside(start);
  } catch (const std::runtime_error&) {
    return;  // given values may have to change too, or the guess is too far away: sampling begins from the given values
  } catch (const std::domain_error&) {
    return;  // the start is undefined, as the rate of t^1.5 at 0
  }
  for (std::size_t i = 0; i < choices_.size(); ++i) choices_[i].center = cln::double_approx(start.q[i]);
  read_scales();
}

void Points::read_ranges(const State& start) {
  const model::Model& m = oracle_.model();
  for (std::size_t i = 0; i < m.coordinates.size(); ++i) {
    Choice c;
    c.center = cln::double_approx(start.q[i]);
    c.rate_center = cln::double_approx(start.qdot[i]);
    c.has_lower = m.coordinates[i].lower != model::no_node;
    c.has_upper = m.coordinates[i].upper != model::no_node;
    if (c.has_lower) c.lower = cln::double_approx(oracle_.constant(m.coordinates[i].lower, start.parameters));
    if (c.has_upper) c.upper = cln::double_approx(oracle_.constant(m.coordinates[i].upper, start.parameters));
    choices_.push_back(c);
  }
}

/// Coordinates of the same unit share a scale: an orbit that starts at (7e6, 0) m has this scale in both.
void Points::read_scales() {
  const model::Model& m = oracle_.model();
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    Choice& c = choices_[i];
    const model::Unit& unit = m.coordinates[i].unit;
    double scale = std::fabs(c.center), rate = std::fabs(c.rate_center);
    if (!unit.text.empty() && !is_angle(unit))
      for (std::size_t k = 0; k < choices_.size(); ++k) {
        if (m.coordinates[k].unit.text != unit.text) continue;
        scale = std::max(scale, std::fabs(choices_[k].center));
        rate = std::max(rate, std::fabs(choices_[k].rate_center));
      }
    c.scale = scale > 0 && !is_angle(unit) ? scale : 1;
    c.rate_scale = rate > 0 ? rate : 1;
    const bool below = c.has_lower && c.center <= c.lower, above = c.has_upper && c.center >= c.upper;
    if (below || above) {  // not given: it follows from the constraints
      if (c.has_lower && c.has_upper)
        c.center = (c.lower + c.upper) / 2;
      else
        c.center = below ? c.lower + c.scale : c.upper - c.scale;
    }
  }
}

double Points::decades() const {
  constexpr double decimals = 0.30103;  // decimal digits per binary digit
  double largest = 0;
  const auto look_at = [&](const Real& value) {
    if (cln::zerop(value)) return;
    const auto exponent = cln::float_exponent(cln::cl_float(cln::abs(value), cln::float_format(20)));
    largest = std::max(largest, decimals * std::fabs(static_cast<double>(exponent)));
  };
  for (const Real& value : defaults_) look_at(value);
  for (const double value : {t0_, t1_}) look_at(verify::exact(value));
  for (const Choice& c : choices_)
    for (const double value : {c.center, c.scale, c.rate_center, c.rate_scale}) look_at(verify::exact(value));
  for (const double value : input_defaults_) look_at(verify::exact(value));
  return largest;
}

// ---- one state

double Points::draw_coordinate(const Choice& c) {
  if (c.has_lower && c.has_upper) {
    const double margin = range_margin * (c.upper - c.lower);
    const double anywhere = c.lower + margin + uniform() * (c.upper - c.lower - 2 * margin);
    return c.center + spread_ * (anywhere - c.center);
  }
  if (c.has_lower || c.has_upper) {
    const double bound = c.has_lower ? c.lower : c.upper;
    return bound + (c.center - bound) * (1 + coordinate_spread * spread_ * symmetric());
  }
  return c.center + spread_ * symmetric() * c.scale;
}

void Points::fix(std::vector<Real>& parameters) const {
  for (const auto& [index, value] : fixed_) parameters[index] = oracle_.precision().round(value);
}

State Points::draw() {
  const model::Model& m = oracle_.model();
  State s;
  s.t = exact(t0_ + uniform() * (t1_ - t0_));
  for (std::size_t i = 0; i < m.parameters.size(); ++i) {
    const double u = symmetric();
    const bool zero = cln::zerop(defaults_[i]);  // test terms that are switched off by default too
    s.parameters.push_back(zero ? exact(spread_ * (0.55 + 0.45 * u))
                                : defaults_[i] * exact(1 + parameter_spread * spread_ * u));
  }
  fix(s.parameters);  // before: others depend on them; after: they may depend on others
  s.parameters = oracle_.parameters(std::move(s.parameters));
  fix(s.parameters);
  s.integrals = oracle_.integrals(s);
  for (const double fallback : input_defaults_)
    s.inputs.push_back(exact(fallback + symmetric() * std::max(1.0, std::fabs(fallback))));
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    Choice c = choices_[i];
    c.scale *= is_angle(m.coordinates[i].unit) ? angle_spread : coordinate_spread;
    s.q.push_back(exact(draw_coordinate(c)));
    s.qdot.push_back(exact(c.rate_center + spread_ * symmetric() * c.rate_scale));
  }
  s.qddot.assign(s.q.size(), Real(0));
  return s;
}

void Points::require_inside(const State& s) const {
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    const Choice& c = choices_[i];
    const double q = cln::double_approx(s.q[i]);
    const double margin = c.has_lower && c.has_upper ? 0.5 * range_margin * (c.upper - c.lower) : 0;
    if ((c.has_lower && q <= c.lower + margin) || (c.has_upper && q >= c.upper - margin))
      throw Outside("outside the range of a coordinate");
  }
}

void Points::require_smooth(const State& s) const {
  Margin margin;
  const std::vector<Real> no_forces(oracle_.constraints().size(), Real(0));
  oracle_.dalembert(s, no_forces, &margin);
  if (margin.kink < kink_margin) throw Rejected("too near a kink");
}

// Whether the closed contacts cause the failure; if so, another set of contacts is tried.
bool Points::give_up_closing(Choosing& choosing) {
  if (choosing.open.size() == leavable_.size()) return false;
  if (choosing.reached) {  // rare failure: add states with all of them open
    constexpr std::size_t seldom = 4;
    if (++choosing.failures != seldom * patience) return false;
    Choosing all;
    for (std::size_t j = 0; j < leavable_.size(); ++j) all.open.insert(j);
    choosings_.push_back(std::move(all));
    return true;
  }
  if (++choosing.failures == patience) leave_one_open();
  return true;
}

// Leaves one more contact open: replaces the current set by sets with each of its closed contacts open.
void Points::leave_one_open() {
  const std::set<std::size_t> open = choosings_[turn_ % choosings_.size()].open;
  choosings_.erase(choosings_.begin() + static_cast<std::ptrdiff_t>(turn_ % choosings_.size()));
  for (std::size_t j = 0; j < leavable_.size(); ++j) {
    if (open.contains(j)) continue;
    Choosing more;
    more.open = open;
    more.open.insert(j);
    // Another set whose open contacts are all open in this one closes more contacts.
    const auto closes_more = [&](const Choosing& other) {
      return std::includes(more.open.begin(), more.open.end(), other.open.begin(), other.open.end());
    };
    if (std::none_of(choosings_.begin(), choosings_.end(), closes_more)) choosings_.push_back(std::move(more));
  }
}

State Points::next() {
  for (;;) {
    Choosing& choosing = choosings_[turn_ % choosings_.size()];
    try {
      open_.clear();
      State s = draw();
      for (const std::size_t j : choosing.open) s.apart.insert(leavable_[j]);
      project_positions(s);
      close_implied(s);
      project_velocities(s);
      require_implied(s);
      require_inside(s);
      require_smooth(s);
      if (!choosing.reached) choosing.failures = 0;
      choosing.reached = true;
      ++turn_;
      return s;
    } catch (const Unclosed& unclosed) {
      if (give_up_closing(choosing)) continue;
      ++turn_;  // a set that was reached before does not block the others
      reject(unclosed.what());
    } catch (const Outside& outside) {
      // The projection closes a distant contact only outside a chart: it cannot be closed within the ranges.
      if (choosing.reached && give_up_closing(choosing)) continue;
      const bool closes = choosing.open.size() < leavable_.size();
      if (choosing.reached)
        ++turn_;
      else if (closes && ++choosing.outside == inside_patience)
        leave_one_open();
      reject(outside.what());
    } catch (const Rejected& rejected) {
      reject(rejected.what());
    } catch (const Singular& singular) {
      reject(singular.what());
    }
  }
}

void Points::reject(const std::string& why) {
  ++rejected_[why];
  // The more loops a model has, the fewer random states can be projected onto its constraints.
  constexpr std::size_t often = 10, few = 8;
  const std::size_t rows = std::max(few, oracle_.constraints().size());
  if (++rejections_ % std::max<std::size_t>(1, often * few / rows) == 0) spread_ *= 0.8;
  if (rejections_ <= cap_) return;
  std::string reasons;
  for (const auto& [reason, count] : rejected_)
    reasons += (reasons.empty() ? "" : ", ") + reason + " (" + std::to_string(count) + ")";
  throw Error("verify", SourceLocation{oracle_.model().file, 0, 0, 1, ""},
              "no states were found at which the equations can be checked: " + reasons,
              "look at the ranges of the coordinates, the constraints and the start of the default scene",
              ErrorKind::check);
}

}  // namespace eomgen::verify

// SPDX-License-Identifier: GPL-3.0-or-later
#include "oracle/state_sampler.hpp"

#include <cln/float.h>
#include <cln/integer.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "error.hpp"

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

constexpr const char* at_kink = "too near the kink";

bool is_angle(const model::Unit& unit) { return unit.text == "rad" || unit.text == "1"; }

}  // namespace

StateSampler::StateSampler(const Oracle& oracle, std::uint64_t seed, std::size_t cap,
                           std::map<std::uint32_t, cln::cl_RA> fixed, std::vector<std::size_t> unilateral_constraints)
    : oracle_(oracle),
      engine_(seed),
      cap_(cap),
      fixed_(std::move(fixed)),
      unilateral_constraints_(std::move(unilateral_constraints)),
      contact_sets_(1) {
  try {
    read_scene();
  } catch (const UndefinedValue& none) {
    throw Error("verify", none.where, std::string("this has no value: ") + none.what(),
                "check the numbers that it is computed from");
  }
}

double StateSampler::uniform() { return (static_cast<double>(engine_() >> 12) + 0.5) * 0x1p-52; }
double StateSampler::uniform_symmetric() { return 2 * uniform() - 1; }
Real StateSampler::exact(double value) const { return oracle_.precision().round(verify::exact(value)); }

// ---- ranges and scales from the model file

void StateSampler::read_scene() {
  const model::Model& m = oracle_.model();
  State start;
  start.z.assign(m.states.size(), Real(0));  // integrals begin at the start
  start.parameters = oracle_.default_parameters();
  const model::Scene* scene = m.scenes.empty() ? nullptr : &m.scenes.front();
  if (scene != nullptr)
    for (const auto& [index, value] : scene->parameters)
      start.parameters[index] = oracle_.evaluate_constant(value, oracle_.parameters(start.parameters));
  defaults_ = start.parameters;
  start.parameters = oracle_.parameters(defaults_);
  if (scene != nullptr && scene->t0 != model::no_node) {
    t0_ = cln::double_approx(oracle_.evaluate_constant(scene->t0, start.parameters));
    t1_ = t0_ + 1;
    if (scene->t1 != model::no_node) t1_ = cln::double_approx(oracle_.evaluate_constant(scene->t1, start.parameters));
  }
  t1_ = std::min(t1_, t0_ + longest_span);
  start.t = exact(t0_);  // before functions of time are evaluated: they may be undefined at other times
  for (const model::Input& input : m.inputs) {
    start.inputs.push_back(oracle_.evaluate_constant(input.default_value, start.parameters));
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
          target[value.coordinate] = oracle_.evaluate(value.value, start);
          if (values == &scene->initial && value.order == 0) given[value.coordinate] = true;
        } catch (const std::domain_error&) {
          continue;  // the start depends on values that only the constraints determine, or a function has no rate at
                     // this time, as t^1.5 at 0
        }
      }
  read_states(start, scene);
  read_ranges(start);
  read_scales();
  solve_start(std::move(start), given);
}

/// Coordinates without an initial value follow from the constraints: neither their guess nor 0 gives their usual values
/// and scales.
void StateSampler::solve_start(State start, const std::vector<bool>& given) {
  const bool holonomic = [&] {
    for (std::size_t k = 0; k < oracle_.constraints().size(); ++k)
      if (oracle_.is_holonomic(k)) return true;
    return false;
  }();
  if (!holonomic || std::find(given.begin(), given.end(), false) == given.end()) return;
  for (std::size_t i = 0; i < sampling_ranges_.size(); ++i) start.q[i] = exact(sampling_ranges_[i].center);
  for (const std::size_t j : unilateral_constraints_) start.open.insert(j);  // unilateral constraints may be open
  for (const auto& [constraint, input] : oracle_.contact_inputs().forces) start.open.insert(constraint);
  try {
    project_positions(start, &given);
    require_inside(start);
  } catch (const std::runtime_error&) {
    return;  // given values may have to change too, or the guess is too far away: sampling begins from the given values
  } catch (const std::domain_error&) {
    return;  // the start is undefined, as the rate of t^1.5 at 0
  }
  for (std::size_t i = 0; i < sampling_ranges_.size(); ++i) sampling_ranges_[i].center = cln::double_approx(start.q[i]);
  read_scales();
}

void StateSampler::read_states(State& start, const model::Scene* scene) {
  const model::Model& m = oracle_.model();
  state_ranges_.resize(m.states.size());
  for (std::uint32_t i = 0; i < m.states.size(); ++i) {
    if (m.states[i].integral) continue;
    model::NodeId initial = m.states[i].initial;
    if (scene != nullptr)
      for (const model::InitialState& given : scene->states)
        if (given.state == i) initial = given.value;
    try {
      if (initial != model::no_node) start.z[i] = oracle_.evaluate(initial, start);
    } catch (const std::domain_error&) {
      continue;  // it depends on values that only the constraints determine
    }
    state_ranges_[i].center = cln::double_approx(start.z[i]);
    if (!cln::zerop(start.z[i])) state_ranges_[i].scale = std::fabs(state_ranges_[i].center);
  }
}

void StateSampler::read_ranges(const State& start) {
  const model::Model& m = oracle_.model();
  for (std::size_t i = 0; i < m.coordinates.size(); ++i) {
    SamplingRange c;
    c.center = cln::double_approx(start.q[i]);
    c.rate_center = cln::double_approx(start.qdot[i]);
    c.has_lower = m.coordinates[i].lower != model::no_node;
    c.has_upper = m.coordinates[i].upper != model::no_node;
    if (c.has_lower) c.lower = cln::double_approx(oracle_.evaluate_constant(m.coordinates[i].lower, start.parameters));
    if (c.has_upper) c.upper = cln::double_approx(oracle_.evaluate_constant(m.coordinates[i].upper, start.parameters));
    sampling_ranges_.push_back(c);
  }
}

/// Coordinates of the same unit share a scale: an orbit that starts at (7e6, 0) m has this scale in both.
void StateSampler::read_scales() {
  const model::Model& m = oracle_.model();
  for (std::size_t i = 0; i < sampling_ranges_.size(); ++i) {
    SamplingRange& c = sampling_ranges_[i];
    const model::Unit& unit = m.coordinates[i].unit;
    double scale = std::fabs(c.center), rate = std::fabs(c.rate_center);
    if (!unit.text.empty() && !is_angle(unit))
      for (std::size_t k = 0; k < sampling_ranges_.size(); ++k) {
        if (m.coordinates[k].unit.text != unit.text) continue;
        scale = std::max(scale, std::fabs(sampling_ranges_[k].center));
        rate = std::max(rate, std::fabs(sampling_ranges_[k].rate_center));
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

double StateSampler::max_decades_from_one() const {
  constexpr double decimals = 0.30103;  // decimal digits per binary digit
  double largest = 0;
  const auto look_at = [&](const Real& value) {
    if (cln::zerop(value)) return;
    const auto exponent = cln::float_exponent(cln::cl_float(cln::abs(value), cln::float_format(20)));
    largest = std::max(largest, decimals * std::fabs(static_cast<double>(exponent)));
  };
  for (const Real& value : defaults_) look_at(value);
  for (const double value : {t0_, t1_}) look_at(verify::exact(value));
  for (const SamplingRange& c : sampling_ranges_)
    for (const double value : {c.center, c.scale, c.rate_center, c.rate_scale}) look_at(verify::exact(value));
  for (const SamplingRange& z : state_ranges_)
    for (const double value : {z.center, z.scale}) look_at(verify::exact(value));
  for (const double value : input_defaults_) look_at(verify::exact(value));
  return largest;
}

// ---- one state

double StateSampler::sample_coordinate(const SamplingRange& c) {
  if (c.has_lower && c.has_upper) {
    const double margin = range_margin * (c.upper - c.lower);
    const double drawn = c.lower + margin + uniform() * (c.upper - c.lower - 2 * margin);
    return c.center + spread_ * (drawn - c.center);
  }
  if (c.has_lower || c.has_upper) {
    const double bound = c.has_lower ? c.lower : c.upper;
    return bound + (c.center - bound) * (1 + coordinate_spread * spread_ * uniform_symmetric());
  }
  return c.center + spread_ * uniform_symmetric() * c.scale;
}

void StateSampler::apply_fixed(std::vector<Real>& parameters) const {
  for (const auto& [index, value] : fixed_) parameters[index] = oracle_.precision().round(value);
}

State StateSampler::sample_state() {
  const model::Model& m = oracle_.model();
  State s;
  s.t = exact(t0_ + uniform() * (t1_ - t0_));
  for (std::size_t i = 0; i < m.parameters.size(); ++i) {
    const double u = uniform_symmetric();
    const bool zero = cln::zerop(defaults_[i]);  // test terms that are switched off by default too
    s.parameters.push_back(zero ? exact(spread_ * (0.55 + 0.45 * u))
                                : defaults_[i] * exact(1 + parameter_spread * spread_ * u));
  }
  apply_fixed(s.parameters);  // before: others depend on them; after: they may depend on others
  s.parameters = oracle_.parameters(std::move(s.parameters));
  apply_fixed(s.parameters);
  for (std::size_t i = 0; i < m.states.size(); ++i) {
    const SamplingRange& z = state_ranges_[i];
    const double moved = m.states[i].integral ? 0 : spread_ * uniform_symmetric() * z.scale;
    s.z.push_back(exact(z.center + moved));
  }
  s.z = oracle_.with_integrals(s);
  for (const double fallback : input_defaults_)
    s.inputs.push_back(exact(fallback + uniform_symmetric() * std::max(1.0, std::fabs(fallback))));
  for (std::size_t i = 0; i < sampling_ranges_.size(); ++i) {
    SamplingRange c = sampling_ranges_[i];
    c.scale *= is_angle(m.coordinates[i].unit) ? angle_spread : coordinate_spread;
    s.q.push_back(exact(sample_coordinate(c)));
    s.qdot.push_back(exact(c.rate_center + spread_ * uniform_symmetric() * c.rate_scale));
  }
  s.qddot.assign(s.q.size(), Real(0));
  return s;
}

void StateSampler::require_inside(const State& s) const {
  for (std::size_t i = 0; i < sampling_ranges_.size(); ++i) {
    const SamplingRange& c = sampling_ranges_[i];
    const double q = cln::double_approx(s.q[i]);
    const double margin = c.has_lower && c.has_upper ? 0.5 * range_margin * (c.upper - c.lower) : 0;
    if ((c.has_lower && q <= c.lower + margin) || (c.has_upper && q >= c.upper - margin))
      throw OutOfRange("outside the range of a coordinate");
  }
}

void StateSampler::require_smooth(const State& s) const {
  KinkMargin margin;
  const std::vector<Real> no_forces(oracle_.constraints().size(), Real(0));
  oracle_.dalembert_residuals(s, no_forces, &margin);
  if (margin.kink < kink_margin)
    throw RejectedState(margin.line > 0 ? fmt::format("{} of line {}", at_kink, margin.line) : at_kink);
}

// Whether the closed contacts cause the failure; if so, another set of contacts is tried.
bool StateSampler::give_up_closing(OpenContactSet& contact_set) {
  if (contact_set.open.size() == unilateral_constraints_.size()) return false;
  if (contact_set.reached) {  // rare failure: add states with all of them open
    constexpr std::size_t seldom = 4;
    if (++contact_set.failures != seldom * patience) return false;
    OpenContactSet all;
    for (std::size_t j = 0; j < unilateral_constraints_.size(); ++j) all.open.insert(j);
    contact_sets_.push_back(std::move(all));
    return true;
  }
  if (++contact_set.failures == patience) leave_one_open();
  return true;
}

// A state with these contacts closed has no values, or is outside the ranges: the next one has others, as this one does
// after many that failed.
void StateSampler::try_other_contacts(OpenContactSet& contact_set) {
  const bool closes = contact_set.open.size() < unilateral_constraints_.size();
  if (contact_set.reached)
    ++turn_;
  else if (closes && ++contact_set.outside == inside_patience)
    leave_one_open();
}

// Leaves one more contact open: replaces the current set by sets with each of its closed contacts open.
void StateSampler::leave_one_open() {
  const std::set<std::size_t> open = contact_sets_[turn_ % contact_sets_.size()].open;
  contact_sets_.erase(contact_sets_.begin() + static_cast<std::ptrdiff_t>(turn_ % contact_sets_.size()));
  for (std::size_t j = 0; j < unilateral_constraints_.size(); ++j) {
    if (open.contains(j)) continue;
    OpenContactSet more;
    more.open = open;
    more.open.insert(j);
    // Another set whose open contacts are all open in this one closes more contacts.
    const auto closes_more = [&](const OpenContactSet& other) {
      return std::includes(more.open.begin(), more.open.end(), other.open.begin(), other.open.end());
    };
    if (std::none_of(contact_sets_.begin(), contact_sets_.end(), closes_more)) contact_sets_.push_back(std::move(more));
  }
}

State StateSampler::next() {
  for (;;) {
    OpenContactSet& contact_set = contact_sets_[turn_ % contact_sets_.size()];
    try {
      open_.clear();
      State s = sample_state();
      for (const std::size_t j : contact_set.open) s.open.insert(unilateral_constraints_[j]);
      for (const auto& [constraint, input] : oracle_.contact_inputs().forces) s.open.insert(constraint);
      project_positions(s);
      close_implied(s);
      project_velocities(s);
      require_implied(s);
      require_inside(s);
      require_smooth(s);
      if (!contact_set.reached) contact_set.failures = 0;
      contact_set.reached = true;
      ++turn_;
      return s;
    } catch (const UnsatisfiedConstraints& unclosed) {
      if (give_up_closing(contact_set)) continue;
      ++turn_;  // a set that was reached before does not block the others
      reject(unclosed.what());
    } catch (const OutOfRange& outside) {
      // The projection closes a distant contact only outside a chart: it cannot be closed within the ranges.
      if (contact_set.reached && give_up_closing(contact_set)) continue;
      try_other_contacts(contact_set);
      reject(outside.what());
    } catch (const RejectedState& rejected) {
      try_other_contacts(contact_set);
      reject(rejected.what());
    } catch (const Singular& singular) {
      try_other_contacts(contact_set);
      reject(singular.what());
    }
  }
}

void StateSampler::reject(const std::string& why) {
  ++rejected_[why];
  // The more loops a model has, the fewer random states can be projected onto its constraints.
  constexpr std::size_t often = 10, few = 8;
  const std::size_t rows = std::max(few, oracle_.constraints().size());
  if (++rejections_ % std::max<std::size_t>(1, often * few / rows) == 0) spread_ *= 0.8;
  if (rejections_ <= cap_) return;
  std::string reasons;
  std::size_t most = 0;
  bool by_kink = false;
  for (const auto& [reason, count] : rejected_) {
    reasons += (reasons.empty() ? "" : ", ") + reason + " (" + std::to_string(count) + ")";
    if (count > most) most = count, by_kink = reason.starts_with(at_kink);
  }
  throw Error("verify", SourceLocation{oracle_.model().file, 0, 0, 1, ""},
              "no states were found at which the equations can be checked: " + reasons,
              by_kink
                  ? "if the constraints hold this quantity at its kink, leave the term out; friction is written as dry"
                  : "look at the ranges of the coordinates, the constraints and the start of the default scene",
              ErrorKind::check);
}

}  // namespace eomgen::verify

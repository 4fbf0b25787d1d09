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

/// A state that is not compared, and why; counted by reason.
struct Rejected : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The constraints cannot be met there.
struct Unclosed : Rejected {
  using Rejected::Rejected;
};

// How far random values go from the defaults and starts, before anything is rejected.
constexpr double parameter_spread = 0.25;  // relative
constexpr double coordinate_spread = 0.5;  // of the scale of its unit
constexpr double angle_spread = 1.2;       // rad
constexpr double range_margin = 0.05;      // of a chart's range, at either end: charts are singular there
constexpr double longest_span = 100;       // s; later times test nothing more
constexpr double kink_margin = 1e-6;       // so that rounding to binary64 cannot change the branch
constexpr double singular_constraints = 1e10;
constexpr std::size_t patience = 12;  // tries to close the same contacts before one of them is left open

bool is_angle(const model::Unit& unit) { return unit.text == "rad" || unit.text == "1"; }

}  // namespace

Points::Points(const Judge& judge, std::uint64_t seed, std::size_t cap, std::map<std::uint32_t, cln::cl_RA> fixed,
               std::vector<std::size_t> leavable)
    : judge_(judge), engine_(seed), cap_(cap), fixed_(std::move(fixed)), leavable_(std::move(leavable)), choosings_(1) {
  try {
    read_scene();
  } catch (const NoValue& none) {
    throw Error("verify", none.where, std::string("this has no value: ") + none.what(),
                "check the numbers that it is computed from");
  }
}

double Points::uniform() { return (static_cast<double>(engine_() >> 12) + 0.5) * 0x1p-52; }
double Points::symmetric() { return 2 * uniform() - 1; }
Real Points::exact(double value) const { return judge_.precision().round(verify::exact(value)); }

// ---- what the file says about where the system lives

void Points::read_scene() {
  const model::Model& m = judge_.model();
  State start;
  start.integrals.assign(m.integrals.size(), Real(0));  // they count from the start
  start.parameters = judge_.default_parameters();
  const model::Scene* scene = m.scenes.empty() ? nullptr : &m.scenes.front();
  if (scene != nullptr)
    for (const auto& [index, value] : scene->parameters)
      start.parameters[index] = judge_.constant(value, judge_.parameters(start.parameters));
  defaults_ = start.parameters;
  start.parameters = judge_.parameters(defaults_);
  if (scene != nullptr && scene->t0 != model::no_node) {
    t0_ = cln::double_approx(judge_.constant(scene->t0, start.parameters));
    t1_ = t0_ + 1;
    if (scene->t1 != model::no_node) t1_ = cln::double_approx(judge_.constant(scene->t1, start.parameters));
  }
  t1_ = std::min(t1_, t0_ + longest_span);
  start.t = exact(t0_);  // before functions of time are looked at, which may have no value at other times
  for (const model::Input& input : m.inputs) {
    start.inputs.push_back(judge_.constant(input.fallback, start.parameters));
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
          target[value.coordinate] = judge_.value(value.value, start);
          if (values == &scene->initial && value.order == 0) given[value.coordinate] = true;
        } catch (const std::domain_error&) {
          continue;  // a start that needs values which only the constraints give, or a time at which a function has no
                     // rate, as t^1.5 at 0
        }
      }
  read_ranges(start);
  read_scales();
  settle(std::move(start), given);
}

/// What the scene leaves to the constraints is where they put it: neither its guess nor a zero says where the system
/// lives, or how large it is.
void Points::settle(State start, const std::vector<bool>& given) {
  const bool holonomic = [&] {
    for (std::size_t k = 0; k < judge_.constraints().size(); ++k)
      if (judge_.holonomic(k)) return true;
    return false;
  }();
  if (!holonomic || std::find(given.begin(), given.end(), false) == given.end()) return;
  for (std::size_t i = 0; i < choices_.size(); ++i) start.q[i] = exact(choices_[i].center);
  for (const std::size_t j : leavable_) start.apart.insert(j);  // they need not touch
  try {
    project_positions(start, &given);
    require_inside(start);
  } catch (const std::runtime_error&) {
    return;  // given values may be moved too, or the guess is too far away: the states are looked for from there
  } catch (const std::domain_error&) {
    return;  // the start has no value, as t^1.5 has no rate at 0
  }
  for (std::size_t i = 0; i < choices_.size(); ++i) choices_[i].center = cln::double_approx(start.q[i]);
  read_scales();
}

void Points::read_ranges(const State& start) {
  const model::Model& m = judge_.model();
  for (std::size_t i = 0; i < m.coordinates.size(); ++i) {
    Choice c;
    c.center = cln::double_approx(start.q[i]);
    c.rate_center = cln::double_approx(start.qdot[i]);
    c.has_lower = m.coordinates[i].lower != model::no_node;
    c.has_upper = m.coordinates[i].upper != model::no_node;
    if (c.has_lower) c.lower = cln::double_approx(judge_.constant(m.coordinates[i].lower, start.parameters));
    if (c.has_upper) c.upper = cln::double_approx(judge_.constant(m.coordinates[i].upper, start.parameters));
    choices_.push_back(c);
  }
}

/// Coordinates of the same unit share a scale: an orbit that starts at (7e6, 0) m moves in both.
void Points::read_scales() {
  const model::Model& m = judge_.model();
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
    if (below || above) {  // not given: it follows from a constraint
      if (c.has_lower && c.has_upper)
        c.center = (c.lower + c.upper) / 2;
      else
        c.center = below ? c.lower + c.scale : c.upper - c.scale;
    }
  }
}

double Points::decades() const {
  constexpr double decimals = 0.30103;  // of a binary digit
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
  for (const auto& [index, value] : fixed_) parameters[index] = judge_.precision().round(value);
}

State Points::draw() {
  const model::Model& m = judge_.model();
  State s;
  s.t = exact(t0_ + uniform() * (t1_ - t0_));
  for (std::size_t i = 0; i < m.parameters.size(); ++i) {
    const double u = symmetric();
    const bool zero = cln::zerop(defaults_[i]);  // a term that is switched off by default is tested too
    s.parameters.push_back(zero ? exact(spread_ * (0.55 + 0.45 * u))
                                : defaults_[i] * exact(1 + parameter_spread * spread_ * u));
  }
  fix(s.parameters);  // before: others depend on them; after: they may depend on others
  s.parameters = judge_.parameters(std::move(s.parameters));
  fix(s.parameters);
  s.integrals = judge_.integrals(s);
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

/// How far a coordinate is from the nearer end of its range; its scale, if that is less.
Real Points::room(const State& state, std::size_t i) const {
  const Choice& c = choices_[i];
  Real room = exact(c.scale);
  if (c.has_lower) room = cln::min(room, state.q[i] - exact(c.lower));
  if (c.has_upper) room = cln::min(room, exact(c.upper) - state.q[i]);
  return room;
}

/// Takes the step, or of it what leaves every coordinate inside its range. False: it was cut.
bool Points::move_inside(State& s, const std::vector<Real>& step) const {
  const Real most = cln::cl_RA(9) / 10;  // of the way to the end of the range
  Real part = 1;
  for (std::size_t i = 0; i < step.size(); ++i) {
    const Choice& c = choices_[i];
    const auto keep = [&](const Real& way) {  // of the sign of the step
      if (cln::abs(step[i]) > most * cln::abs(way)) part = cln::min(part, most * way / step[i]);
    };
    if (c.has_lower && cln::minusp(step[i]) && s.q[i] > exact(c.lower)) keep(exact(c.lower) - s.q[i]);
    if (c.has_upper && cln::plusp(step[i]) && s.q[i] < exact(c.upper)) keep(exact(c.upper) - s.q[i]);
  }
  for (std::size_t i = 0; i < step.size(); ++i) s.q[i] = s.q[i] + part * step[i];
  return part == 1;
}

/// The least change that removes the defect, measured by the scales, or by what is left to the ends of the ranges:
/// W A^T (A W A^T)^-1 (-defect).
std::vector<Real> Points::correction(const State& state, bool rates, const std::vector<bool>* held,
                                     bool by_room) const {
  State at = state;
  at.qddot.clear();  // nobody asks for psi_ddot here
  ConstraintValues c = judge_.constraint_values(at);
  const std::size_t n = choices_.size();
  std::vector<Real> defect = rates ? c.psi_dot : c.psi;
  for (std::size_t k = c.gradient.size(); k-- > 0;) {
    if ((rates || judge_.holonomic(k)) && !judge_.implied(k) && !state.apart.contains(k))
      continue;  // else: binds no position, follows, is open
    c.gradient.erase(c.gradient.begin() + static_cast<std::ptrdiff_t>(k));
    defect.erase(defect.begin() + static_cast<std::ptrdiff_t>(k));
  }
  const std::size_t rows = c.gradient.size();
  if (rows == 0) return std::vector<Real>(n, Real(0));
  std::vector<Real> weight;
  for (std::size_t i = 0; i < n; ++i) {
    const Real scale = held != nullptr && (*held)[i] ? Real(0)
                       : rates                       ? exact(choices_[i].rate_scale)
                       : by_room                     ? room(state, i)
                                                     : exact(choices_[i].scale);
    weight.push_back(scale * scale);
  }
  std::vector<Real> gram(rows * rows, Real(0)), right;
  for (const Real& value : defect) right.push_back(-value);
  for (std::size_t j = 0; j < n; ++j) {
    std::vector<std::size_t> bound;  // constraints that it is in
    for (std::size_t i = 0; i < rows; ++i)
      if (!cln::zerop(c.gradient[i][j])) bound.push_back(i);
    for (const std::size_t i : bound) {
      const Real scaled = c.gradient[i][j] * weight[j];
      for (const std::size_t k : bound) gram[i * rows + k] = gram[i * rows + k] + scaled * c.gradient[k][j];
    }
  }
  const Solution y = solve(std::move(gram), std::move(right));
  if (!y.exists() || y.condition > singular_constraints) throw Unclosed("the constraints lose rank");
  std::vector<Real> change(n, Real(0));
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < rows; ++i)
      if (!cln::zerop(c.gradient[i][j])) change[j] = change[j] + weight[j] * c.gradient[i][j] * y.x()[i];
  return change;
}

void Points::project_positions(State& s, const std::vector<bool>* held) const {
  if (judge_.constraints().empty()) return;
  // Convergence is quadratic: after a step of relative size 10^-h the error is of the order 10^-2h.
  const Real small = cln::expt(cln::cl_RA(1) / 10, cln::cl_I(judge_.digits() / 2 + 2));
  const Real own = cln::expt(cln::cl_RA(1) / 10, cln::cl_I(judge_.digits() / 2 - 8));
  constexpr int most_settling = 8;
  int settled = 0;
  bool by_room = false;  // once a step would have left a range: coordinates near an end are moved less then
  for (int iteration = 0; iteration < 40; ++iteration) {
    const std::vector<Real> step = correction(s, false, held, by_room);
    Real size = 0;
    for (std::size_t i = 0; i < step.size(); ++i) size = cln::max(size, cln::abs(step[i]) / exact(choices_[i].scale));
    if (!move_inside(s, step)) by_room = true;
    // The first step may be as long as a prescribed motion is far away: a radius of a planet, where no start gives a
    // scale.
    if (iteration > 0 && size > 1000) break;
    if (size >= small) continue;
    // A coordinate far below its scale, as a height of 1 beside a width of 1e300, has digits of its own to come.
    const auto coarse = [&](std::size_t i) { return cln::abs(step[i]) > cln::abs(s.q[i]) * own; };
    if (++settled == most_settling) return;
    bool any = false;
    for (std::size_t i = 0; i < step.size(); ++i) any = any || coarse(i);
    if (!any) return;
  }
  throw Unclosed("no configuration on the constraints was found");
}

void Points::project_velocities(State& s) const {
  if (judge_.constraints().empty()) return;
  // Linear; a second time for the digits of what is nearly at rest. What is left where nothing can move is 0.
  const Real small = cln::expt(cln::cl_RA(1) / 10, cln::cl_I(judge_.digits() - 6));
  std::vector<Real> size;
  for (std::size_t i = 0; i < choices_.size(); ++i)
    size.push_back(cln::max(cln::abs(s.qdot[i]), exact(choices_[i].rate_scale)) * small);
  for (int round = 0; round < 2; ++round) {
    const std::vector<Real> change = correction(s, true, nullptr, false);
    for (std::size_t i = 0; i < change.size(); ++i) s.qdot[i] = s.qdot[i] + change[i];
  }
  for (std::size_t i = 0; i < size.size(); ++i) {
    if (cln::abs(s.qdot[i]) <= size[i]) s.qdot[i] = 0;
  }
}

/// Relative to the size of the terms, as far as the digits of a projection go.
void Points::require_implied(const State& s) const {
  if (!judge_.any_implied()) return;
  const ConstraintValues c = judge_.constraint_values(s);
  const Real small = cln::expt(cln::cl_RA(1) / 10, cln::cl_I(judge_.digits() - 15));
  for (std::size_t k = 0; k < c.psi.size(); ++k) {
    if (!judge_.implied(k)) continue;
    Real size = 1, rate = 1;
    for (std::size_t i = 0; i < s.q.size(); ++i) {
      size = size + cln::abs(c.gradient[k][i] * s.q[i]);
      rate = rate + cln::abs(c.gradient[k][i] * s.qdot[i]);
    }
    if (cln::abs(c.psi[k]) > small * size || cln::abs(c.psi_dot[k]) > small * rate)
      throw Rejected("a joint closes in another way");
  }
}

void Points::require_inside(const State& s) const {
  for (std::size_t i = 0; i < choices_.size(); ++i) {
    const Choice& c = choices_[i];
    const double q = cln::double_approx(s.q[i]);
    const double margin = c.has_lower && c.has_upper ? 0.5 * range_margin * (c.upper - c.lower) : 0;
    if ((c.has_lower && q <= c.lower + margin) || (c.has_upper && q >= c.upper - margin))
      throw Rejected("outside the range of a coordinate");
  }
}

void Points::require_smooth(const State& s) const {
  Margin margin;
  const std::vector<Real> no_forces(judge_.constraints().size(), Real(0));
  judge_.dalembert(s, no_forces, &margin);
  if (margin.kink < kink_margin) throw Rejected("too near a kink");
}

// One more contact stays open, each of those that were to be closed in turn. False: the fault lies elsewhere.
bool Points::give_up_closing(Choosing& choosing) {
  if (choosing.reached || choosing.open.size() == leavable_.size()) return false;
  if (++choosing.failures < patience) return true;
  const std::set<std::size_t> open = choosing.open;
  choosings_.erase(choosings_.begin() + static_cast<std::ptrdiff_t>(turn_ % choosings_.size()));
  for (std::size_t j = 0; j < leavable_.size(); ++j) {
    if (open.contains(j)) continue;
    Choosing more;
    more.open = open;
    more.open.insert(j);
    // What is open in another one is open in this one too: that one closes more.
    const auto closes_more = [&](const Choosing& other) {
      return std::includes(more.open.begin(), more.open.end(), other.open.begin(), other.open.end());
    };
    if (std::none_of(choosings_.begin(), choosings_.end(), closes_more)) choosings_.push_back(std::move(more));
  }
  return true;
}

State Points::next() {
  for (;;) {
    Choosing& choosing = choosings_[turn_ % choosings_.size()];
    try {
      State s = draw();
      for (const std::size_t j : choosing.open) s.apart.insert(leavable_[j]);
      project_positions(s);
      project_velocities(s);
      require_implied(s);
      require_inside(s);
      require_smooth(s);
      choosing.reached = true;
      ++turn_;
      return s;
    } catch (const Unclosed& unclosed) {
      if (!give_up_closing(choosing)) reject(unclosed.what());
    } catch (const Rejected& rejected) {
      reject(rejected.what());
    } catch (const Singular& singular) {
      reject(singular.what());
    }
  }
}

void Points::reject(const std::string& why) {
  ++rejected_[why];
  // Of states drawn at random, the fewer close the more loops there are.
  constexpr std::size_t often = 10, few = 8;
  const std::size_t rows = std::max(few, judge_.constraints().size());
  if (++rejections_ % std::max<std::size_t>(1, often * few / rows) == 0) spread_ *= 0.8;
  if (rejections_ <= cap_) return;
  std::string reasons;
  for (const auto& [reason, count] : rejected_)
    reasons += (reasons.empty() ? "" : ", ") + reason + " (" + std::to_string(count) + ")";
  throw Error("verify", Where{judge_.model().file, 0, 0, 1, ""},
              "no states were found at which the equations can be checked: " + reasons,
              "look at the ranges of the coordinates, the constraints and the start of the default scene",
              Fault::check);
}

}  // namespace eomgen::verify

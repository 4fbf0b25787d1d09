// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/integration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <eom/modes/chart_state.hpp>

namespace eomgen::run {

namespace {

constexpr double beyond_rounding = 1e-6;

}  // namespace

Integration::Integration(const RunRequest& request, std::string solver)
    : request_(request),
      charts_(request),
      solver_(std::move(solver)),
      keeps_constraints_(method_named(solver_).variational || method_named(solver_).constrained),
      n_(request.code.free.size()),
      energy_(index_of(request.code.output_names, "energy")),
      u_(std::max<std::size_t>(1, request.scene.inputs.size())),
      y_(request.code.output_names.size()),
      rows_(request),
      projection_(n_, rows_.size(), rows_.on_positions()) {
  // Before the first piece starts: just inside it, so that a table gives its value right of t0.
  side_ = std::nextafter(request.scene.t0, request.scene.t1);
  prepare();
  start_ = own_start();
  g_.resize(first_jump() + (request_.scene.jumps ? request_.scene.jumps->surfaces() : 0));
  g_size_.resize(request.code.kinks.size());
  if (request.watch_power) power_ = index_of(request.code.output_names, "power");
  start_charts(request.scene.t0, start_);
  if (compiled().contacts.empty()) {
    if (rows_.size() == 0 || keeps_constraints_) return;
    psi_.resize(rows_.size());
    b_.resize(rows_.size());
    passage_ = std::make_unique<SingularPassage>(n_, rows_.size(), [this](double t, const double* x, double* A) {
      return rows_(t, x, inputs(t), psi_.data(), A, b_.data());
    });
    return;
  }
  const auto in_mode = [this](int contacts) { return (mode_ & ~eom::contact_bits) | contacts; };
  contacts_ = std::make_unique<ContactModes>(
      request, rows_, initial_state().size(), [this](double t) { return inputs(t); },
      [this, in_mode](double t, const double* x, int contacts, double* dx) {
        return motion(t, x, inputs(t), in_mode(contacts), dx);
      },
      [this, in_mode](double t, const double* x, int contacts, double* g) {
        const int code =
            compiled().events(t, x, request_.scene.parameters.data(), inputs(t), in_mode(contacts), g_.data());
        std::copy(g_.begin() + static_cast<std::ptrdiff_t>(first_contact()),
                  g_.begin() + static_cast<std::ptrdiff_t>(first_jump()), g);
        return code != 0 ? code : contact_code(g);
      },
      [this](double t, std::span<const double> before, std::span<const double> after) {
        outputs(t, before.data(), y_);
        const double energy = y_[energy_];
        outputs(t, after.data(), y_);
        contact_work += y_[energy_] - energy;
      });
  std::vector<double> x = initial_state();
  start_contacts(request.scene.t0, x);  // who looks at the start sees its mode
}

void Integration::prepare() {
  w_.assign(compiled().prepare != nullptr ? compiled().prepared : 0, 0.0);
  // A code of prepare is told by rhs, which is asked then.
  if (compiled().prepare != nullptr && compiled().prepare(request_.scene.parameters.data(), w_.data()) != 0) w_.clear();
}

std::vector<std::string> Integration::start_charts(double t, std::span<double> x) {
  mode_ &= ~eom::chart_bits;
  if (!charts_.any() || !charts_.start(t, x.data())) return {};
  return exchange_charts(t, x);
}

std::vector<std::string> Integration::exchange_charts(double t, std::span<double> x) {
  const Code* const before = &compiled();
  std::vector<std::string> told = charts_.exchange(t, x);
  if (before != &compiled()) prepare();
  mode_ = (mode_ & ~eom::chart_bits) | charts_.mode();
  rows_.charts(compiled(), charts_.mode());
  return told;
}

std::vector<double> Integration::own_state(const eom::Result& end) const {
  std::vector<double> x = end.x;
  charts_.own(end.t, end.x.data(), std::span(x).first(2 * n_ + compiled().integrals));
  return x;
}

std::vector<eom::ModeEvent> Integration::start_contacts(double t, std::span<double> x) {
  if (!contacts_) return {};
  contact_work = 0;
  mode_ = 0;  // a model with contacts keeps its charts
  std::vector<eom::ModeEvent> told = contacts_->start(t, x);
  mode_ = contacts_->mode();
  return told;
}

std::vector<double> Integration::own_start() const {
  std::vector<double> x;
  for (const std::uint32_t i : compiled().free) x.push_back(request_.scene.q[i]);
  for (const std::uint32_t i : compiled().free) x.push_back(request_.scene.qdot[i]);
  x.insert(x.end(), compiled().integrals, 0.0);
  if (request_.watch_power) x.push_back(0);  // the work done since the start
  return x;
}

const double* Integration::inputs(double t) const {
  for (std::size_t i = 0; i < request_.scene.inputs.size(); ++i) u_[i] = request_.scene.inputs[i](t, side_);
  return u_.data();
}

int Integration::rhs(double t, const double* x, double* dx) {
  if (charts_.any()) {
    if (const int code = charts_.admits(x); code != 0) return code;
  }
  const double* u = inputs(t);
  const int code = motion(t, x, u, mode_, dx);
  // A branch that is held beyond its surface may have no value there (a root); what the surface separates always has.
  const int live = mode_ & (eom::contact_bits | eom::chart_bits);
  return code != 0 && mode_ != live ? motion(t, x, u, live, dx) : code;
}

/// Of the states without the work, which is a quadrature; partial, with the inputs held: df/dt along them is not told.
int Integration::jacobian(double t, const double* x, double* dfdx, double* dfdt) {
  if (compiled().jac == nullptr) return eom::no_jacobian_here;
  const double* p = request_.scene.parameters.data();
  const double* u = inputs(t);
  const int live = mode_ & (eom::contact_bits | eom::chart_bits);
  int code = compiled().jac(t, x, p, u, mode_, dfdx, dfdt);
  if (code != 0 && mode_ != live) code = compiled().jac(t, x, p, u, live, dfdx, dfdt);
  return code == 0 && !request_.scene.inputs.empty() ? eom::no_time_derivative_here : code;
}

/// Of the states without the work, which is integrated along them.
int Integration::taylor(double t, const double* x, int order, double* coefficients) {
  const double* p = request_.scene.parameters.data();
  const double* u = inputs(t);
  const int live = mode_ & (eom::contact_bits | eom::chart_bits);
  const int code = compiled().taylor(t, x, p, u, mode_, order, coefficients);
  return code != 0 && mode_ != live ? compiled().taylor(t, x, p, u, live, order, coefficients) : code;
}

int Integration::momenta(double t, const double* x, double* p, double* rate) {
  return compiled().momenta(t, x, request_.scene.parameters.data(), inputs(t), mode_, p, rate);
}

int Integration::mass(double t, const double* x, double* M) {
  const double* p = request_.scene.parameters.data();
  h_.resize(n_);
  return charts_.second() != 0 ? compiled().mass_in(t, x, p, mode_, M, h_.data())
                               : compiled().mass(t, x, p, M, h_.data());
}

int Integration::motion(double t, const double* x, const double* u, int mode, double* dx) {
  const double* p = request_.scene.parameters.data();
  const int code =
      w_.empty() ? compiled().rhs(t, x, p, u, mode, dx) : compiled().rhs_prepared(t, x, p, w_.data(), u, mode, dx);
  if (code != 0 || !request_.watch_power) return code;
  const int watched = compiled().outputs(t, x, p, u, mode, y_.data());
  dx[2 * n_ + compiled().integrals] = y_[power_];
  return watched;
}

int Integration::outputs(double t, const double* x, std::span<double> y) const {
  const int result = compiled().outputs(t, x, request_.scene.parameters.data(), inputs(t), mode_, y.data());
  if (charts_.second() != 0) own_values(t, x, y);
  return result;
}

/// What second charts do not give: the coordinates, and what is conserved or defined in the own charts only.
void Integration::own_values(double t, const double* x, std::span<double> y) const {
  own_x_.resize(2 * n_ + compiled().integrals);
  charts_.own(t, x, own_x_);
  for (std::size_t i = 0; i < n_; ++i) {
    y[2 * compiled().free[i]] = own_x_[i];
    y[2 * compiled().free[i] + 1] = own_x_[n_ + i];
  }
  if (charts_.own_outputs().empty()) return;
  own_y_.resize(y.size());
  const int code = compiled().outputs(t, own_x_.data(), request_.scene.parameters.data(), inputs(t),
                                      mode_ & ~eom::chart_bits, own_y_.data());
  for (const std::uint32_t i : charts_.own_outputs()) y[i] = code == 0 ? own_y_[i] : std::nan("");
}

int Integration::events(double t, const double* x, double* g) {
  const int code =
      compiled().events == nullptr ? 0 : compiled().events(t, x, request_.scene.parameters.data(), inputs(t), mode_, g);
  if (code == 0 && g_.size() > first_jump())
    request_.scene.jumps->values({t, {x, start_.size()}, inputs(t)}, g + first_jump());
  if (code != 0 || !contacts_) return code;
  if (const int bad = contact_code(g + first_contact()); bad != 0) return bad;
  contacts_->adjust(g + first_contact());
  return 0;
}

/// What is not a number is neither within a law nor beyond it.
int Integration::contact_code(const double* g) const {
  const std::size_t count = eom::contact_values * compiled().contacts.size();
  return std::any_of(g, g + count, [](double value) { return std::isnan(value); }) ? eom::code_not_finite : 0;
}

std::vector<eom::EventFunction> Integration::watched() const {
  std::vector<eom::EventFunction> functions;
  for (const WatchedEvent& event : request_.events)
    functions.push_back({event.direction, event.stop ? eom::Watch::breaking : eom::Watch::passing});
  functions.resize(g_.size());
  if (contacts_) contacts_->watch(std::span(functions).subspan(first_contact(), first_jump() - first_contact()));
  return functions;
}

/// Holds each kink on the side where the state is; where it is on the surface itself its branch follows the state.
void Integration::hold_sides(double t, const double* x, bool anew) {
  if (compiled().kinks.empty()) return;
  if (anew) mode_ &= eom::contact_bits | eom::chart_bits;
  bool all = !anew;
  for (std::size_t k = 0; k < compiled().kinks.size(); ++k)
    all = all && (mode_ >> (compiled().first_kink_bit + 2 * k) & 3) != 0;
  if (all || events(t, x, g_.data()) != 0) return;
  for (std::size_t k = 0; k < compiled().kinks.size(); ++k) {
    const double g = g_[request_.events.size() + k];
    const std::size_t bit = compiled().first_kink_bit + 2 * k;
    if (std::isfinite(g)) g_size_[k] = std::max(g_size_[k], std::abs(g));
    // What is small beside former values may be rounding, and the side another than the locator of events will find.
    if ((mode_ >> bit & 3) != 0 || !(std::abs(g) > (anew ? 0 : beyond_rounding * g_size_[k]))) continue;
    mode_ |= 1 << (g > 0 ? bit : bit + 1);
  }
}

eom::AtEvent Integration::at_event(const eom::EventPoint& point, const OnEvent& event) {
  const std::size_t i = point.crossing.function;
  if (i >= first_jump()) {
    jump_ = request_.scene.jumps->cross({point.t, point.x, inputs(point.t)}, i - first_jump());
    return jump_.empty() ? eom::AtEvent::go_on : eom::AtEvent::stop;
  }
  if (i >= first_contact()) return change_contact(point, event);
  if (i < request_.events.size()) {
    const WatchedEvent& watched = request_.events[i];
    if (event) event({point.t, watched.stop ? "stop" : "custom", watched.name}, point.x);
    stopped_ = stopped_ || watched.stop;
    return eom::AtEvent::stop;
  }
  cross_kink(point, i - request_.events.size());
  return eom::AtEvent::go_on;
}

void Integration::cross_kink(const eom::EventPoint& point, std::size_t k) {
  const std::size_t bit = compiled().first_kink_bit + 2 * k;
  ++kink_crossings[k];
  kink_ = k;
  kink_at_ = point.t;
  mode_ = (mode_ & ~(3 << bit)) | 1 << (point.crossing.up ? bit : bit + 1);
}

eom::AtEvent Integration::change_contact(const eom::EventPoint& point, const OnEvent& event) {
  eom::Crossing crossing = point.crossing;
  crossing.function -= first_contact();
  const eom::AtEvent answer = contacts_->take(point.t, point.x, crossing,
                                              point.functions.subspan(first_contact(), first_jump() - first_contact()));
  mode_ = (mode_ & ~eom::contact_bits) | contacts_->mode();
  if (const eom::ModeEvent* told = contacts_->told(); told != nullptr && event)
    event({told->t, told->kind, told->name}, point.x);
  if (answer != eom::AtEvent::restart) return answer;
  hold_sides(point.t, point.x.data(), true);
  steps_due_ = steps_due_ || steps_due(point.t, point.x.data());
  return steps_due_ ? eom::AtEvent::stop : answer;
}

/// Whether the steps are to be others from (t, x) on: chosen ones where fixed ones would not follow the direction of
/// slip, or its end.
bool Integration::steps_due(double t, const double* x) {
  return fixed_step_ > 0 && contacts_ && contacts_->slow_slip(t, x, fixed_step_, finer_) != finer_;
}

eom::Options Integration::finer(const eom::Options& piece) {
  eom::Options options = piece;
  options.fixed_step = options.initial_step = 0;
  options.max_step = piece.fixed_step;
  // Tighter in a further run, as its steps are shorter, so that the estimate sees the error of these steps too.
  const double part = std::min(1.0, piece.fixed_step / request_.scene.step);
  options.rtol = slow_slip_rtol * std::max(0.01, std::pow(part, 4));
  options.atol = slow_slip_atol;
  options.choice = &finer_choice_;
  return options;
}

/// Of an accepted step: the work of its projection; others were made on trial.
void Integration::accept(const eom::StepView& step) {
  const auto made =
      std::find_if(projected_.rbegin(), projected_.rend(), [&](const auto& p) { return p.first == step.t1; });
  if (made != projected_.rend()) work += made->second;
  projected_.clear();
}

int Integration::project(double t, double* x) {
  outputs(t, x, y_);
  const double before = y_[energy_];
  const eom::ProjectionResult moved = projection_(
      t, x,
      [&](double at, const double* state, double* psi, double* A, double* b) {
        return rows_(at, state, inputs(at), psi, A, b);
      },
      [&](double at, const double* state, double* M, double*) { return mass(at, state, M); });
  if (moved.code != 0) return moved.code;
  outputs(t, x, y_);
  position_correction = std::max(position_correction, moved.position_correction);
  velocity_correction = std::max(velocity_correction, moved.velocity_correction);
  projected_.emplace_back(t, y_[energy_] - before);
  return 0;
}

/// Whose law of friction has no solution, or several: the margin of that contact is the smallest.
void Integration::tell_friction(eom::Result& end) {
  const bool none = end.outcome == eom::Outcome::friction_no_solution;
  if (!none && end.outcome != eom::Outcome::friction_many_solutions) return;
  if (!contacts_ || events(end.t, end.x.data(), g_.data()) != 0) return;
  std::size_t worst = 0;
  const auto margin = [&](std::size_t j) { return g_[first_contact() + eom::contact_values * j + 4]; };
  for (std::size_t j = 1; j < compiled().contacts.size(); ++j) {
    if (margin(j) < margin(worst)) worst = j;
  }
  end.detail = fmt::format(
      "just after t = {:.17g} the law of friction at '{}' has {}: friction changes its own normal force by more than "
      "that force (Painleve)",
      end.t, compiled().contacts[worst].name, none ? "no solution" : "several solutions");
}

/// Of a step of the method: infinity, unless a force that is narrow in the state lies in it unseen.
double Integration::longest_step(const eom::StepView& step) {
  if (charts_.second() != 0) return std::numeric_limits<double>::infinity();
  const double longest =
      request_.narrow.longest(step, {[this](double t) { return inputs(t); },
                                     [this](double t, const double* x, double* dx) { return rhs(t, x, dx); },
                                     request_.scene.rtol, request_.scene.atol, method_named(solver_).series});
  if (fixed_step_ > 0 && !finer_ && !passed_over_ && longest < step.t1 - step.t0) passed_over_ = step.t0;
  return longest;
}

/// Why a run ended, where the outcome alone does not say it.
void Integration::explain(eom::Result& end) {
  if (end.outcome == eom::Outcome::step_too_small && kink_at_ == end.t) {
    end.detail = fmt::format(
        "the motion slides along a surface of {}: on both sides it leads back to it, at t = {:.17g}; for dry friction "
        "use "
        "a constraint with friction, or a smooth law",
        compiled().kinks[kink_], end.t);
  }
  if (!jump_.empty()) {
    end.outcome = eom::Outcome::jump_undetermined;
    end.detail = jump_;
  }
  if (contacts_ && contacts_->ended()) {
    end.outcome = *contacts_->ended();
    end.detail = contacts_->detail();
  }
  if (end.outcome == eom::Outcome::chart_left && charts_.any()) {
    end.detail =
        fmt::format("a step just after t = {:.17g} leads past where the coordinates fail: choose a shorter one", end.t);
  }
  tell_friction(end);
}

eom::Result Integration::run(const eom::Options& options, const Observer& observer, const OnEvent& event) {
  position_correction = velocity_correction = work = 0;
  kink_at_ = std::nan("");
  kink_crossings.assign(compiled().kinks.size(), 0);
  projected_.clear();
  stopped_ = finer_ = steps_due_ = false;
  jump_.clear();
  fixed_step_ = options.fixed_step;
  if (contacts_)
    contacts_->tolerances(fixed_step_ > 0 ? slow_slip_rtol : options.rtol,
                          fixed_step_ > 0 ? slow_slip_atol : options.atol);
  choice = finer_choice_ = {};
  eom::Options piece = options;
  piece.choice = &choice;
  piece.step_bounds = request_.scene.clock.bounds;
  passed_over_.reset();
  if (request_.narrow.any()) piece.admit = [this](const eom::StepView& step) { return longest_step(step); };
  // Where contacts stick the state may stand still, and the steps would see nothing of the work of what moves them.
  piece.quadratures = request_.watch_power && compiled().contacts.empty() ? 1 : 0;
  eom::Result total;
  total.x = own_start();
  total.t = request_.scene.t0;
  for (const std::string& whose : start_charts(total.t, total.x)) {
    if (event) event({total.t, "chart", whose}, total.x);
  }
  rows_.start(total.t, total.x.data(), inputs(total.t));
  for (const eom::ModeEvent& told : start_contacts(total.t, total.x)) {
    if (event) event({told.t, told.kind, told.name}, total.x);
  }
  if (method_named(solver_).constrained &&
      project(total.t, total.x.data()) != 0) {  // it has to begin on the constraints, to rounding
    total.outcome = eom::Outcome::inconsistent_start;
    total.detail = "the start cannot be moved onto the constraints";
    return total;
  }
  position_correction = velocity_correction = 0;  // of the run
  projected_.clear();
  const std::vector<Piece> all = pieces();
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (k > 0) begin_piece(all[k - 1], total, event);
    side_ = (total.t + all[k].end) / 2;
    piece.max_steps =
        options.max_steps - std::min(options.max_steps, total.statistics.steps + total.statistics.rejected);
    if (options.fixed_step > 0 && request_.scene.step > 0)
      piece.fixed_step = options.fixed_step * all[k].step / request_.scene.step;
    if (jump_.empty()) integrate_until(all[k].end, piece, observer, event, total);
    explain(total);
    if (total.outcome != eom::Outcome::done) break;
  }
  return total;
}

}  // namespace eomgen::run

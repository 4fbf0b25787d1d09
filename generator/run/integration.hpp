// SPDX-License-Identifier: GPL-3.0-or-later
// One integration of a scene, restarted at the jumps of its inputs; `run` makes one for the result and others for the
// error estimate.
#pragma once

#include <eom/constraints/projection.hpp>
#include <eom/events/integrate.hpp>

#include "run/chart_switch.hpp"
#include "run/contact_modes.hpp"
#include "run/jumps.hpp"
#include "run/singular_passage.hpp"

namespace eomgen::run {

/// Where fixed steps have to be shorter than the scene's to follow a function of time.
struct FinerSteps {
  double begin, end, step;
};
std::vector<FinerSteps> finer_steps(const Scene& scene);
inline constexpr double steps_of_bound = 0.03125;  // of a bound of chosen steps

class Integration {
 public:
  explicit Integration(const RunRequest& request, std::string solver);

  /// observer(step, u_side): called after each accepted step; may be empty.
  using Observer = std::function<bool(const eom::StepView&)>;
  /// One of the model: a recorded one before the observer sees the step that it lies in, a stop after it; or a change
  /// of mode of a contact, after the step that ends there.
  using OnEvent = std::function<void(const RunEvent& event, std::span<const double> x)>;
  eom::Result run(const eom::Options& options, const Observer& observer, const OnEvent& event = {});

  /// Of a start near where a chart fails: in the second one.
  const std::vector<double>& initial_state() const { return start_; }
  /// The state at the end of a run in the model's own charts.
  std::vector<double> own_state(const eom::Result& end) const;
  const ChartSwitch& charts() const { return charts_; }
  int outputs(double t, const double* x, std::span<double> y) const;
  /// Of contacts, where the run is.
  int contact_mode() const { return mode_ & eom::contact_bits; }
  /// dx/dt in the mode of the start; a code.
  int derivative(double t, const double* x, double* dx) { return rhs(t, x, dx); }
  /// Largest |psi|, |f . qdot + b| of a state; 0 without active constraints.
  double constraint_defect(double t, const double* x) { return rows_.defect(t, x); }

  /// Where fixed steps first went over a force that is narrow in the state.
  std::optional<double> passed_over() const { return passed_over_; }

  eom::Choice choice;                                                 // of the solver auto, and its changes in the run
  std::vector<std::size_t> kink_crossings;                            // of the run, per kink
  double position_correction = 0, velocity_correction = 0, work = 0;  // of projections, summed or largest
  double contact_work = 0;  // of impacts, and where sliding in two directions starts or ends

 private:
  friend struct MotionOf;
  friend struct EventsOf;
  int rhs(double t, const double* x, double* dx);
  int jacobian(double t, const double* x, double* dfdx, double* dfdt);
  int taylor(double t, const double* x, int order, double* coefficients);
  int momenta(double t, const double* x, double* p, double* rate);
  int mass(double t, const double* x, double* M);
  int motion(double t, const double* x, const double* u, int mode, double* dx);
  int events(double t, const double* x, double* g);
  int contact_code(const double* g) const;
  std::vector<eom::EventFunction> watched() const;
  void hold_sides(double t, const double* x, bool anew);
  std::vector<eom::ModeEvent> start_contacts(double t, std::span<double> x);
  std::vector<std::string> start_charts(double t, std::span<double> x);
  std::vector<std::string> exchange_charts(double t, std::span<double> x);
  void prepare();
  std::vector<double> own_start() const;
  void own_values(double t, const double* x, std::span<double> y) const;
  void cross_kink(const eom::EventPoint& point, std::size_t kink);
  eom::AtEvent change_contact(const eom::EventPoint& point, const OnEvent& event);
  void tell_friction(eom::Result& end);
  /// Between two times at which something jumps, or fixed steps change their size.
  struct Piece {
    double end, next;  // the one after it begins at `next`, a rounding behind the end where a kink of time lies between
    double step;       // of fixed steps
  };
  std::vector<Piece> pieces() const;
  void begin_piece(const Piece& before, eom::Result& total, const OnEvent& event);
  bool any_contact_touches() const;
  void cross_jump(const Piece& before, eom::Result& total, const OnEvent& event);
  std::optional<std::pair<double, double>> hidden(const eom::StepView& step, std::size_t i, int side, double from,
                                                  double to) const;
  void integrate_until(double end, eom::Options piece, const Observer& observer, const OnEvent& event,
                       eom::Result& total);
  bool passable(const eom::Result& from, double length, const eom::Options& piece);
  std::string name_of_row(std::size_t row) const;
  void tell_passage(const eom::StepView& step, const OnEvent& event);
  void explain(eom::Result& end);
  bool steps_due(double t, const double* x);
  eom::Options finer(const eom::Options& piece);
  std::size_t first_jump() const { return first_contact() + eom::contact_values * compiled().contacts.size(); }
  std::size_t first_contact() const { return request_.events.size() + request_.code.kinks.size(); }
  const Code& compiled() const { return charts_.code(); }  // knows all charts that the run is or was in
  double longest_step(const eom::StepView& step);
  void accept(const eom::StepView& step);
  eom::AtEvent at_event(const eom::EventPoint& point, const OnEvent& event);
  int project(double t, double* x);
  const double* inputs(double t) const;

  const RunRequest& request_;
  ChartSwitch charts_;
  std::string solver_;
  bool keeps_constraints_;  // the solver itself
  std::size_t n_;
  std::size_t power_ = 0, energy_ = 0;
  std::size_t kink_ = 0;  // crossed last, and when
  double kink_at_ = 0;
  int mode_ = 0;                                      // of the step that is being made: contacts, sides of kinks
  std::vector<double> g_, g_size_;                    // event functions; largest |g| seen of each kink
  std::vector<std::pair<double, double>> projected_;  // time, work of projections since the last accepted step
  bool stopped_ = false, exchange_due_ = false;
  std::optional<double> passed_over_;
  double fixed_step_ = 0;  // of the run
  bool finer_ = false,
       steps_due_ =
           false;  // steps that are chosen in place of fixed ones, where slip in two directions is slow; to be changed
  eom::Choice finer_choice_;
  double last_step_ = 0;
  std::vector<double> start_;
  mutable std::vector<double> own_x_, own_y_;
  double side_ = 0;  // a time inside the piece of the inputs that is being integrated
  mutable std::vector<double> u_;
  std::vector<double> w_;  // of Code::prepare
  std::vector<double> y_, h_;
  std::string jump_;  // what jumped that nothing says the consequences of
  std::vector<double> psi_, b_;
  ConstraintRows rows_;
  eom::Projection projection_;
  std::unique_ptr<ContactModes> contacts_;    // where there are any
  std::unique_ptr<SingularPassage> passage_;  // where constraints without contacts may lose their rank
  std::size_t passage_evaluations_ = 0;       // of trials
};

}  // namespace eomgen::run

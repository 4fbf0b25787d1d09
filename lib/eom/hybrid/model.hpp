// SPDX-License-Identifier: MIT
// The compiled model during one run: its functions in the current mode, charts and segment of the inputs. In: a
// Problem. Out: codes of the C ABI; arrays of the caller.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "eom/contacts/contact_forces.hpp"
#include "eom/hybrid/inputs.hpp"
#include "eom/hybrid/problem.hpp"
#include "eom/hybrid/sliding_surfaces.hpp"
#include "eom/hybrid/slip_start.hpp"
#include "eom/modes/contact_table.hpp"
#include "eom/modes/mode_array.hpp"
#include "eom/with_jacobian.hpp"

namespace eom::hybrid {

/// The compiled functions of a problem with parameters, inputs, contact forces and the current mode. Functions that
/// return int return a code of the C ABI.
class Model {
 public:
  /// The problem must outlive this object.
  explicit Model(const Problem& problem)
      : problem_(problem),
        code_(problem.code),
        n_(problem.n()),
        mode_(problem.mode_layout()),
        other_(mode_),
        inputs_(problem),
        u_(std::max<std::size_t>(1, problem.inputs.size())),
        inputs_move_(std::any_of(problem.inputs.begin(), problem.inputs.end(), is_time_dependent)),
        h_(n_),
        y_(problem.code->output_names.size()),
        sliding_(Branches{this}, Surfaces{this}, problem.code->layout().size(), problem.states(),
                 problem.code->kinks.size()) {
    // Before the first segment: a time just inside it, so that a table returns its value right of t0.
    segment_time_ = std::nextafter(problem.t0, problem.t1);
    prepare();
    if (code_->contact_set.empty()) return;
    scene_inputs_ = code_->contact_set.contacts.front().friction_input;  // those of contacts follow
    forces_ = std::make_unique<contacts::ContactForces>(code_->contact_set, contact_system_);
  }

  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;

  const Code& code() const { return *code_; }  // includes all charts of the run so far
  /// Continues with code that has more charts.
  void set_code(const Code& code) {
    if (code_ == &code) return;
    code_ = &code;
    prepare();
  }

  /// The argument `mode` of the compiled functions.
  const ModeArray& mode() const { return mode_; }
  /// Replaces all entries.
  void set_mode(const ModeArray& mode) { mode_ = mode; }
  /// Sets all entries to 0.
  void reset_mode() { mode_ = ModeArray(mode_.layout()); }
  /// The number of the mode of the contacts.
  int contact_mode() const { return mode_.contacts(); }
  /// Sets the number of the mode of the contacts.
  void set_contact_mode(int contacts) { mode_.set_contacts(contacts); }
  /// Bit j of the set: chart j is the second one.
  void set_charts(unsigned set) { mode_.set_charts(set); }
  /// Freezes a branch of kink k (1 or -1), or releases it (0).
  void set_kink(std::size_t k, int side) { mode_.set_kink(k, side); }
  /// The state stays on surfaces along which it slides.
  void release_branches() {
    mode_.release_branches();
    for (const std::size_t k : sliding_.kinks()) mode_.set_kink(k, 1);
  }

  /// The kinks along whose surfaces the state slides.
  const std::vector<std::size_t>& sliding_kinks() const { return sliding_.kinks(); }
  /// Whether the state slides along the surface of this kink.
  bool is_sliding(std::size_t kink) const { return sliding_.contains(kink); }
  /// The state slides along no surface any more.
  void clear_sliding() { sliding_.clear(); }
  /// The state slides along the surfaces of these kinks.
  void set_sliding(const std::vector<std::size_t>& kinks) {
    sliding_.clear();
    for (const std::size_t k : kinks) sliding_.add(k), mode_.set_kink(k, 1);
  }
  /// Whether the state on the surface of a kink stays there, because both sides lead back to it. If so, it slides. Else
  /// a kink without a side gets that to which both sides lead.
  bool begin_sliding(std::size_t kink, double t, const double* x) {
    const int side = mode_.kink(kink);
    sliding_.add(kink);
    std::vector<double> dx(problem_.states());
    const bool known = sliding_.evaluate(mode_, t, x, dx.data()) == 0;
    const bool slides = known && sliding_.hold() && sliding_.is_affine(t, x);
    const int leaves = known ? sliding_.leaving_side(sliding_.kinks().size() - 1) : 0;
    if (!slides) sliding_.remove(kink);
    mode_.set_kink(kink, slides ? 1 : side != 0 ? side : leaves);
    return slides;
  }
  /// Ends the sliding along a surface, on the side to which its weight has come.
  void end_sliding(std::size_t kink, double t, const double* x) {
    std::vector<double> dx(problem_.states());
    int side = 1;
    if (sliding_.evaluate(mode_, t, x, dx.data()) == 0) {
      const std::vector<std::size_t>& all = sliding_.kinks();
      const auto j = static_cast<std::size_t>(std::find(all.begin(), all.end(), kink) - all.begin());
      side = sliding_.leaving_side(j);
      if (side == 0) side = sliding_.weights()[j] > 0 ? 1 : -1;
    }
    sliding_.remove(kink);
    mode_.set_kink(kink, side);
  }
  /// Ends the sliding along all surfaces that no longer hold the state.
  void end_invalid_sliding(double t, const double* x) {
    std::vector<double> dx(problem_.states());
    for (std::size_t round = sliding_.kinks().size(); round-- > 0 && sliding_.any();) {
      if (sliding_.evaluate(mode_, t, x, dx.data()) != 0) return sliding_.clear();
      if (sliding_.hold()) return;
      const std::vector<double>& w = sliding_.weights();
      const auto farthest =
          std::max_element(w.begin(), w.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
      end_sliding(sliding_.kinks()[static_cast<std::size_t>(farthest - w.begin())], t, x);
    }
  }
  /// Removes the drift from the surfaces along which the state slides. Returns a code.
  int correct_sliding(double t, double* x) {
    if (!sliding_.any()) return 0;
    std::vector<double> dx(problem_.states());
    if (const int code = sliding_.evaluate(mode_, t, x, dx.data()); code != 0) return code;
    return sliding_.correct(mode_, t, x);
  }
  /// The values of the surfaces of all kinks.
  int surfaces(double t, const double* x, double* values) { return Surfaces{this}(mode_, x, t, values); }

  /// A time inside the current segment of the inputs.
  double segment_time() const { return segment_time_; }
  /// Replaces segment_time(). Returns the one before.
  double set_segment_time(double t) {
    forget_contact_forces();
    return std::exchange(segment_time_, t);
  }
  /// Valid until the next call. Forces of contacts are those of the last state for which they were solved.
  const double* inputs(double t) const {
    for (std::size_t i = 0; i < std::min(scene_inputs_, inputs_.size()); ++i) u_[i] = inputs_(i, t, segment_time_);
    return u_.data();
  }

  /// The contacts whose forces are inputs; null if there are none.
  contacts::ContactForces* contact_forces() { return forces_.get(); }
  /// The inputs at t, without forces of contacts.
  double* inputs_without_contacts(double t) {
    forget_contact_forces();
    std::fill(u_.begin() + static_cast<std::ptrdiff_t>(std::min(scene_inputs_, u_.size())), u_.end(), 0.0);
    inputs(t);
    return u_.data();
  }
  /// Solves for the forces of contacts at a state. They are then among inputs(t). choice: of forces that the motion
  /// does not determine.
  int solve_contacts(double t, const double* x, contacts::ForceChoice choice = contacts::ForceChoice::unique) const {
    if (!forces_ || is_in_flight()) return 0;
    if (t == solved_t_ && choice <= solved_choice_ && std::equal(solved_x_.begin(), solved_x_.end(), x)) return 0;
    forget_contact_forces();
    std::fill(u_.begin() + static_cast<std::ptrdiff_t>(scene_inputs_), u_.end(), 0.0);
    inputs(t);
    if (const int code = forces_->solve(t, x, u_.data(), choice); code != 0) return code;
    solved_choice_ = choice;
    if (forces_->all_open()) flight_ = forces_->changes();
    solved_t_ = t;
    solved_x_.assign(x, x + code_->layout().size());
    return 0;
  }
  /// The forces of contacts are solved for again at the next evaluation.
  void forget_contact_forces() const { solved_t_ = std::numeric_limits<double>::quiet_NaN(), flight_.reset(); }
  /// The parameters of the problem.
  const double* parameters() const { return problem_.parameters.data(); }

  /// dx = f(t, x) in the current mode.
  int rhs(double t, const double* x, double* dx) {
    if (sliding_.any()) return sliding_.evaluate(mode_, t, x, dx);
    if (const int code = solve_contacts(t, x, contacts::ForceChoice::any); code != 0) return code;
    const double* u = inputs(t);
    const double* const at = state_at_slip_start(t, x, u);
    int code = motion(t, at, u, mode_.data(), dx);
    // A branch that is frozen beyond its surface may have no value there (a root). The unfrozen expression has one.
    if (code != 0 && mode_.has_frozen_branches()) code = motion(t, at, u, mode_without_branches(), dx);
    if (at != x) std::copy_n(x + n_, n_, dx);  // rates are those of x
    return code;
  }

  /// Slip in two directions that has just begun; null: none. They must outlive this object.
  void set_slip_starts(SlipStarts* starts) { slip_starts_ = starts; }
  /// The place of the right-hand side: x, or beside it where slip has just begun. Valid until the next call.
  const double* state_at_slip_start(double t, const double* x, const double* u) {
    return is_slip_starting() ? slip_starts_->lead(t, x, u) : x;
  }
  /// In a given mode of the contacts.
  int rhs_of(int contacts, double t, const double* x, double* dx) {
    return motion(t, x, inputs(t), mode_with_contacts(contacts), dx);
  }

  /// The derivatives are partial, at fixed inputs. If inputs vary between their jumps, df/dt is not available. `work`:
  /// whether the work is a state here; else it is a quadrature, without row and column.
  int jacobian(double t, const double* x, double* dfdx, double* dfdt, bool work) {
    if (code_->jac == nullptr || sliding_.any() || forces_ || is_slip_starting()) return no_jacobian_here;
    const std::size_t n = code_->layout().size();
    if (work) dfdx_.resize(n * n);
    const double* u = inputs(t);
    double* const matrix = work ? dfdx_.data() : dfdx;
    int code = code_->jac(t, x, parameters(), u, mode_.data(), matrix, dfdt);
    if (code != 0 && mode_.has_frozen_branches())
      code = code_->jac(t, x, parameters(), u, mode_without_branches(), matrix, dfdt);
    if (code == 0 && work) code = add_work(t, x, n, dfdx, dfdt);
    return code == 0 && inputs_move_ ? no_time_derivative_here : code;
  }

  /// For the states without the work, which is integrated as a quadrature.
  int taylor(double t, const double* x, int order, double* coefficients) {
    const double* u = inputs(t);
    const int code = code_->taylor(t, x, parameters(), u, mode_.data(), order, coefficients);
    return code != 0 && mode_.has_frozen_branches()
               ? code_->taylor(t, x, parameters(), u, mode_without_branches(), order, coefficients)
               : code;
  }

  /// p = dT/dqdot and its rate without constraint forces: n each.
  int momenta(double t, const double* x, double* p, double* rate) {
    return code_->momenta(t, x, parameters(), inputs(t), mode_.data(), p, rate);
  }

  /// M: n x n by columns.
  int mass(double t, const double* x, double* M) {
    return mode_.charts() != 0 ? code_->mass_in(t, x, parameters(), mode_.data(), M, h_.data())
                               : code_->mass(t, x, parameters(), M, h_.data());
  }

  /// In second charts, entries that exist only in the own charts remain unchanged.
  int outputs(double t, const double* x, double* y,
              contacts::ForceChoice choice = contacts::ForceChoice::unique) const {
    if (const int code = solve_contacts(t, x, choice); code != 0) return code;
    const auto in_mode = [&](const ModeArray& mode, double* values) {
      return code_->outputs(t, x, parameters(), inputs(t), mode.data(), values);
    };
    if (!sliding_.any()) return in_mode(mode_, y);
    std::vector<double> dx(problem_.states());
    const int code = sliding_.evaluate(mode_, t, x, dx.data());
    return code != 0 ? code : sliding_.combine(in_mode, y, y_.size());
  }
  /// Of a state in the own charts.
  int own_outputs(double t, const double* x, double* y) const {
    other_ = mode_;
    other_.set_charts(0);
    return code_->outputs(t, x, parameters(), inputs(t), other_.data(), y);
  }

  /// Values of the model's events, kinks and contacts. Does nothing if there are none. A surface along which the state
  /// slides has 1 - w^2 with its weight w, which is positive while it holds the state.
  int events(double t, const double* x, double* g) {
    if (code_->events == nullptr) return 0;
    // Events of the model may be functions of the forces; those of contacts depend on their signs only.
    const auto choice = problem_.events.empty() ? contacts::ForceChoice::admissible : contacts::ForceChoice::unique;
    if (const int code = solve_contacts(t, x, choice); code != 0) return code;
    const int code = code_->events(t, x, parameters(), inputs(t), mode_.data(), g);
    if (code != 0 || !sliding_.any()) return code;
    std::vector<double> dx(problem_.states());
    if (const int bad = sliding_.evaluate(mode_, t, x, dx.data()); bad != 0) return bad;
    for (std::size_t j = 0; j < sliding_.kinks().size(); ++j) {
      const double w = sliding_.weights()[j];
      g[problem_.events.size() + sliding_.kinks()[j]] = 1 - w * w;
    }
    return 0;
  }
  /// Values that resets set, Code::reset_values of them.
  int resets(double t, const double* x, double* r) {
    return code_->resets(t, x, parameters(), inputs(t), mode_.data(), r);
  }
  /// The event functions in a given mode of the contacts.
  int events_of(int contacts, double t, const double* x, double* g) {
    return code_->events(t, x, parameters(), inputs(t), mode_with_contacts(contacts), g);
  }

 private:
  /// The functions that contacts need.
  struct ContactSystem : contacts::System {
    explicit ContactSystem(Model* model) : of(model) {}
    Model* of;
    std::size_t coordinates() const override { return of->n_; }
    int accelerations(double t, const double* x, const double* u, double* qddot) override {
      return of->accelerations(t, x, u, qddot);
    }
    int rows(double t, const double* x, const double* u, double* c) override {
      return of->code_->contact_rows(t, x, of->parameters(), u, of->mode_.data(), c);
    }
    std::size_t equations() override {
      if (!(of->mode_ == mode)) mode = of->mode_, ++changes;
      return changes;
    }
    ModeArray mode;
    std::size_t changes = 0;
  };
  /// Whether all contacts are known to be open: their forces among the inputs are 0.
  bool is_in_flight() const { return flight_ && *flight_ == forces_->changes(); }
  int accelerations(double t, const double* x, const double* u, double* qddot) {
    dx_.resize(code_->layout().size());
    const auto evaluate = [&](const int* mode) {
      return w_.empty() ? code_->rhs(t, x, parameters(), u, mode, dx_.data())
                        : code_->rhs_prepared(t, x, parameters(), w_.data(), u, mode, dx_.data());
    };
    int code = evaluate(mode_.data());
    if (code != 0 && mode_.has_frozen_branches()) code = evaluate(mode_without_branches());
    std::copy_n(dx_.begin() + static_cast<std::ptrdiff_t>(n_), n_, qddot);
    return code;
  }

  /// The right-hand side for given branches of the kinks.
  struct Branches {
    Model* of;
    int operator()(const ModeArray& mode, const double* x, double t, double* dx) const {
      return of->motion(t, x, of->inputs(t), mode.data(), dx);
    }
  };
  /// The values of the surfaces of all kinks.
  struct Surfaces {
    Model* of;
    int operator()(const ModeArray& mode, const double* x, double t, double* values) const {
      const Code& code = *of->code_;
      const std::size_t first = of->problem_.events.size(), count = code.kinks.size();
      of->g_.resize(first + count + contact_values * code.contacts.size());
      const int result = code.events(t, x, of->parameters(), of->inputs(t), mode.data(), of->g_.data());
      std::copy_n(of->g_.begin() + static_cast<std::ptrdiff_t>(first), count, values);
      return result;
    }
  };
  bool is_slip_starting() const { return slip_starts_ != nullptr && slip_starts_->any(); }
  // Both are valid until the next call.
  const int* mode_without_branches() {
    other_ = mode_;
    other_.release_branches();
    return other_.data();
  }
  const int* mode_with_contacts(int contacts) {
    other_ = mode_;
    other_.set_contacts(contacts);
    return other_.data();
  }

  void prepare() {
    w_.assign(code_->prepare != nullptr ? code_->prepared : 0, 0.0);
    // An error of prepare is reported by rhs, which is then called instead.
    if (code_->prepare != nullptr && code_->prepare(parameters(), w_.data()) != 0) w_.clear();
  }

  /// Copies df/dx of n states, and adds the row of the work.
  int add_work(double t, const double* x, std::size_t n, double* dfdx, double* dfdt);

  int motion(double t, const double* x, const double* u, const int* mode, double* dx) {
    double* const power = problem_.power ? dx + code_->layout().size() : nullptr;
    if (code_->rhs_open != nullptr && is_in_flight()) return code_->rhs_open(t, x, parameters(), u, mode, dx, power);
    const int code = w_.empty() ? code_->rhs(t, x, parameters(), u, mode, dx)
                                : code_->rhs_prepared(t, x, parameters(), w_.data(), u, mode, dx);
    if (code != 0 || power == nullptr) return code;
    if (code_->power != nullptr) return code_->power(t, x, parameters(), u, mode, power);
    const int watched = code_->outputs(t, x, parameters(), u, mode, y_.data());
    *power = y_[*problem_.power];
    return watched;
  }

  const Problem& problem_;
  const Code* code_;
  std::size_t n_;
  ModeArray mode_;           // of the current step
  mutable ModeArray other_;  // of one call
  double segment_time_ = 0;
  Inputs inputs_;
  mutable std::vector<double> u_;
  SlipStarts* slip_starts_ = nullptr;
  bool inputs_move_;       // some input varies between its jumps
  std::vector<double> w_;  // output of Code::prepare
  std::vector<double> dfdx_, x_, h_, y_, g_, dx_;
  std::size_t scene_inputs_ = std::numeric_limits<std::size_t>::max();  // inputs before those of contacts
  ContactSystem contact_system_{this};
  std::unique_ptr<contacts::ContactForces> forces_;
  mutable double solved_t_ = std::numeric_limits<double>::quiet_NaN();  // the state for which u_ has contact forces
  mutable std::vector<double> solved_x_;
  mutable contacts::ForceChoice solved_choice_ = contacts::ForceChoice::any;
  mutable std::optional<std::size_t> flight_;  // ContactForces::changes() since which all contacts are open
  mutable SlidingSurfaces<Branches, Surfaces> sliding_;
};

}  // namespace eom::hybrid

#include "eom/hybrid/work_derivatives.hpp"  // the member that adds the derivatives of the power

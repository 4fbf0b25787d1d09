// SPDX-License-Identifier: MIT
// The compiled model during one run: its functions in the current mode, charts and segment of the inputs. In: a
// Problem. Out: codes of the C ABI; arrays of the caller.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "eom/hybrid/inputs.hpp"
#include "eom/hybrid/problem.hpp"
#include "eom/modes/mode_array.hpp"
#include "eom/with_jacobian.hpp"

namespace eom::hybrid {

class Model {
 public:
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
        y_(problem.code->output_names.size()) {
    // Before the first segment: a time just inside it, so that a table returns its value right of t0.
    segment_time_ = std::nextafter(problem.t0, problem.t1);
    prepare();
  }

  const Code& code() const { return *code_; }  // includes all charts of the run so far
  void set_code(const Code& code) {
    if (code_ == &code) return;
    code_ = &code;
    prepare();
  }

  const ModeArray& mode() const { return mode_; }
  void set_mode(const ModeArray& mode) { mode_ = mode; }
  void reset_mode() { mode_ = ModeArray(mode_.layout()); }
  /// The number of the mode of the contacts.
  int contact_mode() const { return mode_.contacts(); }
  void set_contact_mode(int contacts) { mode_.set_contacts(contacts); }
  void set_charts(unsigned set) { mode_.set_charts(set); }
  void set_kink(std::size_t k, int side) { mode_.set_kink(k, side); }
  void release_branches() { mode_.release_branches(); }

  /// A time inside the current segment of the inputs.
  double segment_time() const { return segment_time_; }
  double set_segment_time(double t) { return std::exchange(segment_time_, t); }
  /// Valid until the next call.
  const double* inputs(double t) const {
    for (std::size_t i = 0; i < inputs_.size(); ++i) u_[i] = inputs_(i, t, segment_time_);
    return u_.data();
  }
  const double* parameters() const { return problem_.parameters.data(); }

  int rhs(double t, const double* x, double* dx) {
    const double* u = inputs(t);
    const int code = motion(t, x, u, mode_.data(), dx);
    // A branch that is frozen beyond its surface may have no value there (a root). The unfrozen expression always has
    // one.
    return code != 0 && mode_.has_frozen_branches() ? motion(t, x, u, mode_without_branches(), dx) : code;
  }

  /// In a given mode of the contacts.
  int rhs_of(int contacts, double t, const double* x, double* dx) {
    return motion(t, x, inputs(t), mode_with_contacts(contacts), dx);
  }

  /// The derivatives are partial, at fixed inputs. If inputs vary between their jumps, df/dt is not available. `work`:
  /// whether the work is a state here; else it is a quadrature, without row and column.
  int jacobian(double t, const double* x, double* dfdx, double* dfdt, bool work) {
    if (code_->jac == nullptr) return no_jacobian_here;
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

  int momenta(double t, const double* x, double* p, double* rate) {
    return code_->momenta(t, x, parameters(), inputs(t), mode_.data(), p, rate);
  }

  int mass(double t, const double* x, double* M) {
    return mode_.charts() != 0 ? code_->mass_in(t, x, parameters(), mode_.data(), M, h_.data())
                               : code_->mass(t, x, parameters(), M, h_.data());
  }

  /// In second charts, entries that exist only in the own charts remain unchanged.
  int outputs(double t, const double* x, double* y) const {
    return code_->outputs(t, x, parameters(), inputs(t), mode_.data(), y);
  }
  /// Of a state in the own charts.
  int own_outputs(double t, const double* x, double* y) const {
    other_ = mode_;
    other_.set_charts(0);
    return code_->outputs(t, x, parameters(), inputs(t), other_.data(), y);
  }

  /// Values of the model's events, kinks and contacts. Does nothing if there are none.
  int events(double t, const double* x, double* g) {
    return code_->events == nullptr ? 0 : code_->events(t, x, parameters(), inputs(t), mode_.data(), g);
  }
  /// Values that resets set, Code::reset_values of them.
  int resets(double t, const double* x, double* r) {
    return code_->resets(t, x, parameters(), inputs(t), mode_.data(), r);
  }
  int events_of(int contacts, double t, const double* x, double* g) {
    return code_->events(t, x, parameters(), inputs(t), mode_with_contacts(contacts), g);
  }

 private:
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

  /// Copies df/dx of n states, and adds the row of the work: derivatives of the power, by central differences.
  int add_work(double t, const double* x, std::size_t n, double* dfdx, double* dfdt) {
    constexpr double part = 6e-6;  // the cube root of the rounding
    const std::size_t m = n + 1;
    for (std::size_t j = 0; j < n; ++j) std::copy_n(dfdx_.data() + n * j, n, dfdx + m * j);
    std::fill_n(dfdx + m * n, m, 0.0);
    x_.assign(x, x + m);
    double largest = 0;
    for (std::size_t j = 0; j < n; ++j) largest = std::max(largest, std::abs(x[j]));
    const auto slope = [&](double& moved, const double& at, double size, double& result) {
      const double middle = moved;
      double power[2] = {0, 0}, place[2] = {0, 0};
      int code = 0;
      for (const int side : {0, 1}) {
        moved = middle + (side == 0 ? -size : size);
        place[side] = moved;
        if (code == 0) code = outputs(at, x_.data(), y_.data());
        power[side] = y_[*problem_.power];
      }
      moved = middle;
      result = (power[1] - power[0]) / (place[1] - place[0]);
      return code;
    };
    for (std::size_t j = 0; j < n; ++j) {
      const double size = part * (x_[j] != 0 ? std::abs(x_[j]) : largest > 0 ? largest : 1);
      if (const int code = slope(x_[j], t, size, dfdx[n + m * j]); code != 0) return code;
    }
    double at = t;
    return slope(at, at, part * (t != 0 ? std::abs(t) : 1), dfdt[n]);
  }

  int motion(double t, const double* x, const double* u, const int* mode, double* dx) {
    const int code = w_.empty() ? code_->rhs(t, x, parameters(), u, mode, dx)
                                : code_->rhs_prepared(t, x, parameters(), w_.data(), u, mode, dx);
    if (code != 0 || !problem_.power) return code;
    const int watched = code_->outputs(t, x, parameters(), u, mode, y_.data());
    dx[code_->layout().size()] = y_[*problem_.power];
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
  bool inputs_move_;       // some input varies between its jumps
  std::vector<double> w_;  // output of Code::prepare
  std::vector<double> dfdx_, x_;
  std::vector<double> h_, y_;
};

}  // namespace eom::hybrid

// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/gradient.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <eom/error_estimate.hpp>
#include <eom/events/integrate.hpp>
#include <eom/ode.hpp>
#include <optional>
#include <variant>

#include "run/central_differences.hpp"
#include "run/derivative_run.hpp"
#include "run/directional_derivative.hpp"
#include "run/forward_gradient.hpp"
#include "run/lost_rank.hpp"
#include "run/trajectory.hpp"
#include "run/variational.hpp"
#include "run/variational_jumps.hpp"

namespace eomgen::run {
namespace {

constexpr std::size_t budget = std::size_t{64} << 20;  // bytes of a trajectory

/// Changes of the state alone, then the directions; all without a scale.
std::vector<Direction> with_unit_vectors(const std::vector<std::string>& names,
                                         const std::vector<Direction>& directions) {
  const std::size_t states = names.size();
  std::vector<Direction> all;
  for (std::size_t i = 0; i < states; ++i) {
    all.push_back({names[i], 1, 0, {}, {}, std::vector<double>(states, 0.0), 0, 0, {}, {}});
    all.back().dx[i] = 1;
  }
  all.insert(all.end(), directions.begin(), directions.end());
  for (Direction& d : all) d.scale = 1;
  return all;
}

double product(const double* a, const double* b, std::size_t count) {
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) sum += a[i] * b[i];
  return sum;
}

class GradientRun {
 public:
  GradientRun(const RunRequest& request, const RunResult& motion, const std::string& solver,
              const GradientRequest& wanted)
      : request_(request),
        motion_(motion),
        scene_(request.scene),
        state_names_(request.state_names),
        solver_(solver),
        wanted_(wanted),
        n_(request.state_names.size()),
        count_(wanted.directions.size()),
        directions_(with_unit_vectors(request.state_names, wanted.directions)),
        jumps_(request, motion, solver, directions_),
        trajectory_(n_, get_method(solver).dense_order, budget),
        x_(n_),
        vJ_(n_),
        vP_(scene_.parameters.size() + 1),
        vU_(scene_.inputs.size() + 1),
        u_(scene_.inputs.size() + 1) {
    for (std::size_t d = 0; d < count_; ++d) {
      if (!wanted.directions[d].du.empty()) driven_.push_back(d);
    }
  }

  /// The state at the end, then the value of each output and its gradient.
  eom::Result operator()(const eom::Options& options) {
    eom::Result end = forward(options);
    if (end.outcome != eom::Outcome::done) return end;
    // The directions alone tell whether they lead off the surface of a jump.
    if (jumps_.is_on_jump()) VariationalRun(request_, motion_, solver_, wanted_.directions)(options);
    const std::vector<double> extended = end.x;
    end.x.resize(n_);
    for (const std::string& output : wanted_.outputs) {
      if (!backward(output, extended, options, end)) return end;
    }
    return end;
  }

  std::size_t adjoint_evaluations() const { return adjoint_evaluations_; }

  /// The adjoint equations in part_: w, then integrals of the parameters and of the directions that change inputs.
  int operator()(double t, const double* w, double* dw) {
    if (const int code = adjoint(t, w); code != 0) return code;
    for (std::size_t i = 0; i < n_; ++i) dw[i] = -vJ_[i];
    const std::size_t parameters = scene_.parameters.size();
    for (std::size_t k = 0; k < parameters; ++k) dw[n_ + k] = -vP_[k];
    const double inside = jumps_.equations().context.model.segment_time();
    for (std::size_t k = 0; k < driven_.size(); ++k) {
      const Direction& d = wanted_.directions[driven_[k]];
      double sum = 0;
      for (std::size_t j = 0; j < d.du.size(); ++j) sum -= vU_[j] == 0 ? 0 : vU_[j] * d.du[j](t, inside);
      dw[n_ + parameters + k] = sum;
    }
    return 0;
  }

 private:
  /// A part of the trajectory in one mode.
  struct Piece {
    std::size_t first, last;  // parts [first, last)
    std::size_t segment;
    eom::ModeArray mode;
  };
  /// s behind an interruption: of every unit vector, then of the directions from s = 0.
  struct Jump {
    std::vector<double> s;
  };

  // ---- forward

  eom::Result forward(const eom::Options& options) {
    trajectory_ = Trajectory(n_, get_method(solver_).dense_order, budget);
    history_.clear();
    adjoint_evaluations_ = 0;
    jumps_.set_tolerances(options.rtol, options.atol);
    eom::Result total;
    total.t = scene_.t0;
    total.x = extended(jumps_.equations().context.own_start());
    if (!jumps_.start(total)) return total;
    note_jump(total.x);
    for (;;) {
      eom::Result part = integrate(total, options);
      part.statistics += total.statistics;
      total = std::move(part);
      if (total.outcome != eom::Outcome::done) return total;
      total.x = extended(total.x);
      if (jumps_.is_last_segment()) break;
      if (!jumps_.cross_kink_in_time(total)) return total;
      note_jump(total.x);
    }
    jumps_.end(total);
    return total;
  }

  /// A state with unit vectors, and zeros as s of the directions.
  std::vector<double> extended(std::vector<double> x) const {
    x.resize(n_);
    x.resize(n_ * (1 + directions_.size()));
    for (std::size_t i = 0; i < n_; ++i) x[n_ * (i + 1) + i] = 1;
    return x;
  }
  void note_jump(std::vector<double>& x) {
    history_.emplace_back(Jump{{x.begin() + static_cast<std::ptrdiff_t>(n_), x.end()}});
    x.resize(n_);
  }
  void begin_piece(double t, const std::vector<double>& x) {
    end_piece();
    trajectory_.begin(t, x);
    history_.emplace_back(
        Piece{trajectory_.parts() - 1, trajectory_.parts(), jumps_.segment(), jumps_.equations().context.model.mode()});
  }
  void end_piece() {
    if (history_.empty() || !std::holds_alternative<Piece>(history_.back())) return;
    std::get<Piece>(history_.back()).last = trajectory_.parts();
  }
  /// A branch that got its side during a piece has it from the begin of the piece on.
  void note_mode() { std::get<Piece>(history_.back()).mode = jumps_.equations().context.model.mode(); }

  eom::Result integrate(const eom::Result& from, const eom::Options& options) {
    auto& context = jumps_.equations().context;
    begin_piece(from.t, from.x);
    const auto rhs = [&](double t, const double* x, double* dx) { return context.rhs(t, x, dx); };
    const eom::System f = eom::system_of(rhs);
    const auto surfaces = [&](double t, const double* x, double* g) { return context.events(t, x, g); };
    const auto observe = [&](const eom::StepView& step) {
      trajectory_.add(step);
      jumps_.observe_state(step.t1, step.x1.data());
      note_mode();
      return true;
    };
    const auto cross = [&](const eom::EventPoint& point) {
      jumps_.settle_branch(point.crossing);
      note_mode();
      end_piece();
      std::vector<double> x = extended({point.x.begin(), point.x.end()});
      const bool changed = jumps_.cross_event({point.t, x, point.crossing, point.functions, point.simultaneous});
      std::copy_n(x.begin(), n_, point.x.begin());
      if (changed) note_jump(x);
      x.resize(n_);
      begin_piece(point.t, x);
      return changed ? eom::EventAction::restart : eom::EventAction::resume;
    };
    const eom::Result part = eom::integrate_events(solver_, f, from.t, from.x, jumps_.segment_end(), options, surfaces,
                                                   jumps_.watched_functions(), cross, observe);
    end_piece();
    return part;
  }

  // ---- backward

  /// Appends the value of an output and its gradient to end.x. False: an integration failed.
  bool backward(const std::string& output, const std::vector<double>& extended, const eom::Options& options,
                eom::Result& end) {
    enter(std::get<Piece>(history_.back()));  // an output before this one has gone back to the start
    std::vector<double> gradient;
    w_ = end_slopes(output, end.t, extended, end.x, gradient);
    for (auto at = history_.rbegin(); at != history_.rend(); ++at) {
      if (const Jump* jump = std::get_if<Jump>(&*at)) {
        for (std::size_t d = 0; d < count_; ++d) gradient[d] += product(w_.data(), jump->s.data() + (n_ + d) * n_, n_);
        std::vector<double> before(n_);
        for (std::size_t i = 0; i < n_; ++i) before[i] = product(w_.data(), jump->s.data() + i * n_, n_);
        std::copy(before.begin(), before.end(), w_.begin());
      } else if (!backward_through(std::get<Piece>(*at), options, end)) {
        return false;
      }
    }
    for (std::size_t d = 0; d < count_; ++d) {
      const Direction& direction = wanted_.directions[d];
      gradient[d] += product(w_.data(), direction.dx.data(), n_);
      gradient[d] += product(w_.data() + n_, direction.dp.data(), direction.dp.size());
    }
    for (std::size_t k = 0; k < driven_.size(); ++k) gradient[driven_[k]] += w_[n_ + scene_.parameters.size() + k];
    end.x.insert(end.x.end(), gradient.begin(), gradient.end());
    return true;
  }

  /// w at the end, without the changes there; appends the value of the output to `values`. gradient: what the changes
  /// at the end add.
  std::vector<double> end_slopes(const std::string& output, double t, const std::vector<double>& x,
                                 std::vector<double>& values, std::vector<double>& gradient) {
    const std::vector<double> own(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n_));
    const auto value = [&](double at, const std::vector<double>& state) {
      return std::vector<double>{value_of(output, {scene_.parameters, scene_.inputs}, at, state)};
    };
    std::vector<double> by_state(n_), unit(n_);
    const auto what = [&] { return fmt::format("the output '{}' has no slope at the end", output); };
    for (std::size_t i = 0; i < n_; ++i) {
      unit[i] = 1;
      by_state[i] = derivative_along(jumps_.scales(), t, own, 0, unit, what, value)[0];
      unit[i] = 0;
    }
    // The end moves: s there, and the change of its time, follow the s before.
    const double* const s = x.data() + n_;
    const double* const dt = x.data() + n_ * (1 + directions_.size());
    const bool moves = std::any_of(dt, dt + directions_.size(), [](double change) { return change != 0; });
    const double rate =
        moves ? derivative_along(jumps_.scales(), t, own, 1, std::vector<double>(n_, 0.0), what, value)[0] : 0;
    std::vector<double> w(n_ + scene_.parameters.size() + driven_.size(), 0.0);
    for (std::size_t i = 0; i < n_; ++i) w[i] = product(by_state.data(), s + i * n_, n_) + rate * dt[i];
    for (std::size_t d = 0; d < count_; ++d) {
      gradient.push_back(product(by_state.data(), s + (n_ + d) * n_, n_) + rate * dt[n_ + d] +
                         slope_by_scene(output, wanted_.directions[d], t, own));
    }
    values.push_back(value(t, own)[0]);
    return w;
  }

  struct Setting {
    const std::vector<double>& parameters;
    const std::vector<Signal>& inputs;
  };

  /// An output at (t, x) in the mode of the run. NaN: it has no value.
  double value_of(const std::string& output, const Setting& setting, double t, const std::vector<double>& x) {
    const auto state = std::find(state_names_.begin(), state_names_.end(), output);
    if (state != state_names_.end()) return x[static_cast<std::size_t>(state - state_names_.begin())];
    const eom::hybrid::Model& model = jumps_.equations().context.model;
    const eom::hybrid::Code& code = *jumps_.equations().problem.code;
    for (std::size_t i = 0; i < setting.inputs.size(); ++i) u_[i] = setting.inputs[i](t, model.segment_time());
    y_.resize(code.output_names.size());
    if (code.outputs(t, x.data(), setting.parameters.data(), u_.data(), model.mode().data(), y_.data()) != 0)
      return std::nan("");
    const auto place = std::find(code.output_names.begin(), code.output_names.end(), output);
    return y_[static_cast<std::size_t>(place - code.output_names.begin())];
  }

  /// The derivative of an output along a direction at fixed t and x.
  double slope_by_scene(const std::string& output, const Direction& direction, double t, const std::vector<double>& x) {
    if (std::find(state_names_.begin(), state_names_.end(), output) != state_names_.end()) return 0;
    std::vector<std::vector<double>> beside;
    for (const Scene& scene : direction.beside)
      beside.push_back({value_of(output, {scene.parameters, scene.inputs}, t, x)});
    const Slopes found = slopes({value_of(output, {scene_.parameters, scene_.inputs}, t, x)}, beside, direction.step);
    if (!found.smooth)
      refuse_derivative(
          fmt::format("the output '{}' at the end does not change smoothly with {}", output, direction.name));
    return found.value[0];
  }

  /// Evaluations are in the segment and the mode of the piece from here on.
  void enter(const Piece& piece) {
    jumps_.equations().enter(piece.segment);
    jumps_.equations().context.model.set_mode(piece.mode);
  }

  bool backward_through(const Piece& piece, eom::Options options, eom::Result& end) {
    enter(piece);
    options.step_bounds = {};  // they describe times in ascending order
    options.quadratures = w_.size() - n_;
    for (std::size_t k = piece.last; k-- > piece.first;) {
      const Trajectory::Part& part = trajectory_.part(k);
      if (part.ends.empty()) continue;
      const bool is_repeated = !trajectory_.is_stored(k);
      if (is_repeated && !repeat(k, options, end)) return false;
      part_ = k;
      double size = 0;
      for (std::size_t i = 0; i < n_; ++i) size = std::max(size, std::abs(w_[i]));
      if (size == 0) continue;
      // The tolerances are those of a state of size 1.
      for (double& value : w_) value /= size;
      const eom::Result back = eom::integrate(solver_, eom::system_of(*this), part.t1, w_, part.t0, options);
      end.statistics += back.statistics;
      if (back.outcome != eom::Outcome::done) return end.outcome = back.outcome, end.detail = back.detail, false;
      for (std::size_t i = 0; i < w_.size(); ++i) w_[i] = size * back.x[i];
      if (is_repeated) trajectory_.release(k);
    }
    return true;
  }

  /// Integrates a part from its checkpoint.
  bool repeat(std::size_t k, eom::Options options, eom::Result& end) {
    options.quadratures = 0;
    options.step_bounds = scene_.clock.bounds;
    options.initial_step = std::abs(trajectory_.part(k).first_step);
    const double t0 = trajectory_.part(k).t0, t1 = trajectory_.part(k).t1;
    const std::vector<double> x0 = trajectory_.part(k).x0;
    trajectory_.restart(k);
    const auto rhs = [&](double t, const double* x, double* dx) { return jumps_.equations().context.rhs(t, x, dx); };
    const eom::Result again =
        eom::integrate(solver_, eom::system_of(rhs), t0, x0, t1, options, [&](const eom::StepView& step) {
          trajectory_.add_to(k, step);
          return true;
        });
    end.statistics += again.statistics;
    if (again.outcome != eom::Outcome::done) end.outcome = again.outcome, end.detail = again.detail;
    return again.outcome == eom::Outcome::done;
  }

  int adjoint(double t, const double* w) {
    ++adjoint_evaluations_;
    const eom::hybrid::Model& model = jumps_.equations().context.model;
    trajectory_.state(part_, t, x_.data());
    const double* u = model.inputs(t);
    std::copy(u, u + scene_.inputs.size(), u_.begin());
    const auto call = [&](const int* mode) {
      return wanted_.adjoint(t, x_.data(), scene_.parameters.data(), u_.data(), mode, w, vJ_.data(), vP_.data(),
                             vU_.data());
    };
    const int code = call(model.mode().data());
    // As for f: a branch that is frozen beyond its surface may have no value there.
    return code == 0 || call(nullptr) == 0 ? 0 : code;
  }

  const RunRequest& request_;
  const RunResult& motion_;
  const Scene& scene_;
  const std::vector<std::string>& state_names_;
  const std::string& solver_;
  const GradientRequest& wanted_;
  std::size_t n_, count_;
  std::vector<Direction> directions_;  // unit vectors of the state, then those that are wanted
  VariationalJumps jumps_;
  Trajectory trajectory_;
  std::vector<std::variant<Piece, Jump>> history_;
  std::vector<std::size_t> driven_;  // directions that change inputs
  std::vector<double> w_;            // as of operator()
  std::size_t part_ = 0, adjoint_evaluations_ = 0;
  std::vector<double> x_, y_, vJ_, vP_, vU_, u_;
};

void require_outputs(const RunRequest& request, const std::vector<std::string>& outputs) {
  for (const std::string& name : outputs) {
    const auto is_in = [&](const std::vector<std::string>& list) {
      return std::find(list.begin(), list.end(), name) != list.end();
    };
    if (!is_in(request.state_names) && !is_in(request.code.output_names))
      refuse_derivative(fmt::format("the output '{}' is known only along a run", name));
  }
}

}  // namespace

Gradients integrate_gradients(const RunRequest& request, const RunResult& motion, const GradientRequest& wanted) {
  require_derivatives(request, motion);
  require_outputs(request, wanted.outputs);
  Gradients result;
  result.solver = derivative_solver(motion.solver);
  result.t = motion.t;
  for (const Direction& d : wanted.directions) result.directions.push_back(d.name);
  const eom::Options options = derivative_options(request, result.solver);
  std::optional<GradientRun> backward;
  std::optional<ForwardGradientRun> forward;
  std::string reason;  // why not the adjoint equations
  if (request.code.contact_set.empty())
    backward.emplace(request, motion, result.solver, wanted);
  else
    reason = "contact forces are solved for at every evaluation";
  // The tighter run of the estimate may be the first that cannot go backward.
  const auto run = [&](const eom::Options& given) {
    try {
      if (backward) return (*backward)(given);
    } catch (const NoAdjointEquations& none) {
      backward.reset();
      reason = none.reason;
    } catch (const Error& refused) {  // along one state alone: the directions that are wanted may have derivatives
      backward.reset();
      reason = reason_of_refusal(refused);
    }
    if (!forward) forward.emplace(request, motion, result.solver, wanted.directions, wanted.outputs);
    return (*forward)(given);
  };
  const auto start = std::chrono::steady_clock::now();
  const eom::Result end = run(options);
  result.method = backward ? GradientMethod::adjoint : GradientMethod::variational;
  result.reason = reason;
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  result.outcome = end.outcome;
  result.statistics = end.statistics;
  if (backward) result.adjoint_evaluations = backward->adjoint_evaluations();
  if (end.outcome != eom::Outcome::done) {
    require_bounded(request, motion, end.outcome, motion.t);
    return result;
  }
  const std::size_t n = request.state_names.size(), count = wanted.directions.size();
  const auto gradient_of = [&](const std::vector<double>& x, std::size_t k) {
    const auto begin = x.begin() + static_cast<std::ptrdiff_t>(n + k * (count + 1) + 1);
    return std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  for (std::size_t k = 0; k < wanted.outputs.size(); ++k)
    result.list.push_back({wanted.outputs[k], end.x[n + k * (count + 1)], gradient_of(end.x, k), {}});
  const EndComparison comparison(request, motion, end.x);
  if (!wanted.estimate && comparison.agrees({})) return result;
  const eom::ErrorEstimate error =
      eom::estimate_error(get_method(result.solver).order, request.scene.t0, end, options, run);
  comparison.require(error.x);
  if (!wanted.estimate) return result;
  for (std::size_t k = 0; k < wanted.outputs.size(); ++k) result.list[k].error = gradient_of(error.x, k);
  if (error.outcome != eom::Outcome::done)
    result.estimate_note =
        fmt::format("a tighter run ended with '{}'; the estimate is not to be trusted", eom::name(error.outcome));
  return result;
}

}  // namespace eomgen::run

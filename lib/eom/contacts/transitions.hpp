// SPDX-License-Identifier: MIT
// Changes of contacts at an instant. In: a state at which a contact meets, parts, slips or stops. Out: impulses with
// the velocities after them, then the states of all contacts from one complementarity problem on accelerations.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "eom/contacts/contact_forces.hpp"
#include "eom/contacts/contact_problem.hpp"
#include "eom/contacts/stronge.hpp"
#include "eom/contacts/thresholds.hpp"

namespace eom::contacts {

/// The function of a contact that crossed zero: it favours the change that the crossing announces.
struct Hint {
  std::size_t contact = none;
  bool parts = false;  // its normal force vanished
  bool slips = false;  // friction reached its limit
  bool stops = false;  // its slip vanished
};

/// A state a short time after a crossing, in the modes before it, where the function that crossed is clearly negative.
/// At the crossing itself both modes obey the laws; only what follows decides which contacts change together.
struct LaterState {
  double t = 0;
  std::vector<double> x, u;  // u has no contact forces
};

class Transitions {
 public:
  using Index = Eigen::Index;
  using Vector = Eigen::VectorXd;

  Transitions(ContactForces& forces, std::size_t coordinates) : forces_(forces), n_(coordinates) {}

  enum class Outcome { done, no_solution, no_value, endless };  // endless: a sequence of impacts
  struct Result {
    Outcome outcome = Outcome::done;
    int code = 0;                // of the ABI, for no_value
    std::size_t contact = none;  // for no_solution
  };

  /// The impulse of a contact, summed over the collisions of an impact.
  struct Impulse {
    double lambda = 0;                 // along the normal row
    std::array<double, 2> friction{};  // along the tangents
    double work = 0;                   // impulse times J qdot, with the mean of the rates before and after
  };
  /// Of the last impact(), per contact.
  const std::vector<Impulse>& impulses() const { return impulses_; }

  /// Impulses of the contacts in `touching` (indices) that approach one another; the rates in x change. Contacts in
  /// `plastic` do not bounce. `rest`: the speeds of all gaps become 0, and slip that is as slow as they. `hit` receives
  /// those that had an impulse and approached.
  Result impact(double t, double* x, double* u, const std::vector<std::size_t>& touching,
                const std::vector<bool>& plastic, bool rest, const Tolerances& tolerances,
                std::vector<std::size_t>& hit) {
    if (const int code = prepare(t, x, u); code != 0) return {Outcome::no_value, code, none};
    before_ = Eigen::Map<const Vector>(x + n_, static_cast<Index>(n_));
    impulses_.assign(forces_.set().contacts.size(), {});
    if (rest) {  // first what the law does, then the speeds that are left of it
      const std::vector<bool> all(plastic.size(), true);
      constexpr double times = 3;  // such a slip has the energy of the bounces that are left out
      rest_slip_ = 0;
      for (const std::size_t j : touching)
        rest_slip_ = std::max(rest_slip_, times * std::abs(forces_.rate(forces_.contact(j).normal)));
      const Result first = apply(t, x, u, touching, all, false, tolerances, hit);
      return first.outcome != Outcome::done ? first : apply(t, x, u, touching, all, true, tolerances, hit);
    }
    const bool energetic = forces_.set().law == ImpactLaw::stronge;  // of one contact at a time
    if (forces_.set().order == ImpactOrder::simultaneous && !energetic)
      return apply(t, x, u, touching, plastic, false, tolerances, hit);
    constexpr int most = 10000;  // each reduces the kinetic energy, or exchanges it
    for (int count = 0; count < most; ++count) {
      std::size_t fastest = none;
      double speed = -tolerances.speed;
      for (const std::size_t j : touching) {
        if (!forces_.contact(j).unilateral) continue;
        const double rate = gap_speed(j, x);
        if (rate < speed) speed = rate, fastest = j;
      }
      if (fastest == none) return {};
      const Result result = energetic ? collide(t, x, u, fastest, plastic[fastest], hit)
                                      : apply(t, x, u, {fastest}, plastic, false, tolerances, hit);
      if (result.outcome != Outcome::done) return result;
    }
    return {Outcome::endless, 0, none};
  }

  /// The states of the contacts at (t, x), whose gap speeds are not negative. Only those in `touching` can be closed.
  /// `later`: the state of which the forces decide; none: (t, x), with a small acceleration towards the change.
  Result decide(double t, const double* x, double* u, const std::vector<std::size_t>& touching, Hint hint,
                const Tolerances& tolerances, std::optional<LaterState> later = {}) {
    if (const int code = forces_.evaluate_rows(t, x, u); code != 0) return {Outcome::no_value, code, none};
    // Friction that reaches its limit as another slip ends is that of the end: all may stick together.
    if (begin_states(touching, hint, tolerances) && hint.slips) hint = {}, later.reset();
    if (later) {
      t = later->t, x = later->x.data(), u = later->u.data();
      if (const int code = forces_.evaluate_rows(t, x, u); code != 0) return {Outcome::no_value, code, none};
    }
    favours_ = !later;
    std::vector<bool> broken(forces_.set().contacts.size(), false);
    if (hint.slips) broken[hint.contact] = true;
    for (std::size_t round = 0; round <= forces_.set().contacts.size(); ++round) {
      bool again = false;
      const Result result = settle(t, x, u, hint, broken, again);
      if (result.outcome != Outcome::done || !again) return result;
    }
    return {};
  }

 private:
  int prepare(double t, const double* x, double* u) {
    if (const int code = forces_.evaluate_rows(t, x, u); code != 0) return code;
    return forces_.evaluate_free(t, x, u);
  }

  double gap_speed(std::size_t j, const double* x) const { return speed(forces_.contact(j).normal, x); }
  /// The velocity of a row at changed rates: rows were evaluated before.
  double speed(const Row& row, const double* x) const {
    double sum = forces_.rate(row);
    for (std::size_t k = 0; k < row.columns.size(); ++k)
      sum += forces_.value(row.slope(k)) * (x[n_ + row.columns[k]] - before_(static_cast<Index>(row.columns[k])));
    return sum;
  }

  /// Impulses of `acting` contacts; those that cannot open always act.
  Result apply(double t, double* x, double* u, const std::vector<std::size_t>& acting, const std::vector<bool>& plastic,
               bool rest, const Tolerances& tolerances, std::vector<std::size_t>& hit) {
    const ImpactLaw law = forces_.set().law;
    ContactProblem rows(forces_, t, x, u);
    for (std::size_t j = 0; j < forces_.set().contacts.size(); ++j) {
      const Description& at = forces_.contact(j);
      const bool acts =
          at.unilateral ? std::find(acting.begin(), acting.end(), j) != acting.end() : at.has_constraint();
      if (!acts) continue;
      const Index normal = rows.add_row(j, at.normal, forces_.normal_pattern(j, false),
                                        at.unilateral && !rest ? Kind::unilateral : Kind::bilateral);
      if (law != ImpactLaw::newton && at.sticks && !rest)
        rows.add_friction(j, normal, forces_.value(at.dynamic_coefficient));
      double slip = 0;
      for (const Row& row : at.slip) slip = std::hypot(slip, speed(row, x));
      for (std::size_t a = 0; a < at.slip.size() && rest && at.sticks && slip <= rest_slip_; ++a)
        rows.add_row(j, at.slip[a], forces_.tangent_pattern(j, a), Kind::bilateral);
    }
    if (const int code = rows.complete(); code != 0) return {Outcome::no_value, code, none};
    FrictionProblem& problem = rows.problem();
    const Index count = rows.size();
    Vector approach(count), restitution(count);
    for (Index i = 0; i < count; ++i) {
      approach(i) = speed(rows.row(i), x);
      const bool bounces =
          rows.kind(i) == Kind::unilateral && !plastic[rows.contact(i)] && approach(i) < -tolerances.speed;
      restitution(i) = bounces ? forces_.value(forces_.contact(rows.contact(i)).restitution) : 0;
      const bool of_speeds = law != ImpactLaw::poisson;
      problem.q(i) = approach(i) * (of_speeds ? 1 + restitution(i) : 1);
    }
    const FrictionForces impulses = solve(problem);
    if (!impulses.found) return {Outcome::no_solution, 0, rows.fastest_contact()};
    Vector total = impulses.force;
    if (law == ImpactLaw::poisson) {
      // Restitution gives back a share of the normal impulses of compression; what comes to it may be more. Friction
      // has the impulses of restitution as its normal forces.
      const Vector share = restitution.cwiseProduct(total.cwiseMax(0.0));
      for (FrictionLaw& at : problem.laws) {
        if (at.normal >= 0) at.given_normal = at.normal_sign * share(at.normal);
      }
      problem.q += problem.G * (total + share);
      const FrictionForces more = solve(problem);
      if (!more.found) return {Outcome::no_solution, 0, rows.fastest_contact()};
      total += share + more.force;
    }
    push(rows, total, x);
    for (Index i = 0; i < count; ++i) {
      const std::size_t j = rows.contact(i);
      if (&rows.row(i) == &forces_.contact(j).normal && forces_.contact(j).unilateral &&
          approach(i) < -tolerances.speed && total(i) > 0 && std::find(hit.begin(), hit.end(), j) == hit.end())
        hit.push_back(j);
    }
    return {};
  }

  /// The impact of contact j by Stronge's law. Contacts that cannot open hold, without friction.
  Result collide(double t, double* x, double* u, std::size_t j, bool plastic, std::vector<std::size_t>& hit) {
    const Description& at = forces_.contact(j);
    ContactProblem rows(forces_, t, x, u);
    const Index normal = rows.add_row(j, at.normal, forces_.normal_pattern(j, false), Kind::unilateral);
    if (at.sticks) rows.add_friction(j, normal, forces_.value(at.dynamic_coefficient));
    const Index own = rows.size();
    for (std::size_t i = 0; i < forces_.set().contacts.size(); ++i) {
      if (!forces_.contact(i).unilateral && forces_.contact(i).has_constraint())
        rows.add_row(i, forces_.contact(i).normal, forces_.normal_pattern(i, false), Kind::bilateral);
    }
    if (const int code = rows.complete(); code != 0) return {Outcome::no_value, code, none};
    const Eigen::MatrixXd& G = rows.problem().G;
    const Index held = rows.size() - own;
    Eigen::MatrixXd reaction = Eigen::MatrixXd::Zero(held, own);  // of the held rows to unit impulses
    for (Index k = 0; k < own && held > 0; ++k)
      reaction.col(k) = solve_least_norm(G.bottomRightCorner(held, held), -G.block(own, k, held, 1)).x;
    const Eigen::MatrixXd response = G.topLeftCorner(own, own) + G.topRightCorner(own, held) * reaction;
    Collision collision;
    collision.normal = speed(rows.row(0), x);
    collision.nn = response(0, 0);
    collision.restitution = plastic ? 0 : forces_.value(at.restitution);
    if (own > 1) {
      const double scale = forces_.value(at.normal_scale);  // |normal force| = scale lambda
      collision.tangential = speed(rows.row(1), x);
      collision.nt = response(0, 1);
      collision.tt = response(1, 1);
      collision.friction = forces_.value(at.dynamic_coefficient) * scale;
    }
    const CollisionImpulse found = solve_collision(collision);
    if (!found.found) return {Outcome::no_solution, 0, j};
    Vector impulses = Vector::Zero(rows.size());
    impulses(0) = found.normal;
    if (own > 1) impulses(1) = found.tangential;
    if (held > 0) impulses.tail(held) = reaction * impulses.head(own);
    push(rows, impulses, x);
    if (std::find(hit.begin(), hit.end(), j) == hit.end()) hit.push_back(j);
    return {};
  }

  /// Applies the impulses to the rates, and adds them to impulses().
  void push(const ContactProblem& rows, const Vector& impulses, double* x) {
    Eigen::Map<Vector> rates(x + n_, static_cast<Index>(n_));
    const Vector before = rates;
    for (Index k = 0; k < rows.size(); ++k) rates += impulses(k) * rows.response(k);
    const Vector mean = (before + rates) / 2;
    for (Index k = 0; k < rows.size(); ++k) {
      const Description& at = forces_.contact(rows.contact(k));
      Impulse& sum = impulses_[rows.contact(k)];
      sum.work += impulses(k) * forces_.change(rows.row(k), mean);
      if (&rows.row(k) == &at.normal)
        sum.lambda += impulses(k);
      else
        sum.friction[static_cast<std::size_t>(&rows.row(k) - at.slip.data())] += impulses(k);
    }
  }

  FrictionForces solve(const FrictionProblem& problem) {
    FrictionForces result = solve_friction_problem(problem);
    if (result.found) largest_residual_ = std::max(largest_residual_, result.residual);
    return result;
  }

  /// Sliding where there is slip, closed where there is none, open where nothing touches. Returns whether a slip in two
  /// directions ends.
  bool begin_states(const std::vector<std::size_t>& touching, const Hint& hint, const Tolerances& tolerances) {
    bool ends = false;
    for (std::size_t j = 0; j < forces_.set().contacts.size(); ++j) {
      const Description& at = forces_.contact(j);
      ContactState& state = forces_.states()[j];
      const bool slid = state.mode == Mode::sliding || state.mode == Mode::sliding_back;
      if (at.unilateral && std::find(touching.begin(), touching.end(), j) == touching.end()) {
        state.mode = Mode::open;
        continue;
      }
      if (at.unilateral && gap_speed_now(j) > tolerances.speed) {
        state.mode = Mode::open;
        continue;
      }
      state.mode = Mode::closed;
      state.starts = false;
      if (!at.sticks || (hint.stops && hint.contact == j)) continue;
      // Points of one body that slides or turns to rest stop together. Their slips are as different as their distances
      // from the centre of the turn.
      constexpr double ratio = 10;
      const bool stop = hint.stops || hint.slips;
      const double slowest = stop ? ratio * std::max(tolerances.slip, tolerances.error) : tolerances.slip;
      const bool moves = forces_.slip_speed(j) > (at.slip.size() == 2 ? slowest : tolerances.speed);
      if (moves) state.mode = at.slip.size() == 1 && forces_.rate(at.slip[0]) < 0 ? Mode::sliding_back : Mode::sliding;
      ends = ends || (slid && !moves && at.slip.size() == 2);
    }
    return ends;
  }
  double gap_speed_now(std::size_t j) const { return forces_.rate(forces_.contact(j).normal); }

  /// One complementarity problem on accelerations. `again`: a contact has just begun to slide, whose coefficient
  /// changes.
  Result settle(double t, const double* x, double* u, const Hint& hint, std::vector<bool>& broken, bool& again);
  /// Adds a small acceleration towards the change that the crossing announces: at the crossing itself both states obey
  /// the law.
  void favour(ContactProblem& rows, const Vector& size, const Hint& hint) const;

 public:
  /// The friction of the contact of a Hint before the crossing.
  void set_friction_before(const std::array<double, 2>& phi) { friction_before_ = phi; }
  void set_input_count(std::size_t count) { input_count_ = count; }
  void start() { largest_residual_ = 0; }
  /// The largest complementarity residual of the problems solved since start().
  double largest_residual() const { return largest_residual_; }

 private:
  using Kind = FrictionProblem::Kind;
  static constexpr double negligible = 1e-12, announced = 1e-9;
  static constexpr double opens = 1e-10;  // forces of dependent rows are known to 1e-13, times their differences

  ContactForces& forces_;
  std::size_t n_;
  std::size_t input_count_ = 0;
  double largest_residual_ = 0;
  bool favours_ = true;
  double rest_slip_ = 0;
  Vector before_;  // rates at which the rows were evaluated
  std::vector<Impulse> impulses_;
  std::array<double, 2> friction_before_{};
};

}  // namespace eom::contacts

#include "eom/contacts/mode_decision.hpp"  // the members that decide the modes

// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "derive/imposition.hpp"
#include "numeric/dense.hpp"
#include "run/massless_coordinates.hpp"
#include "run/scene.hpp"
#include "run/start_refusal.hpp"
#include "run/start_rows.hpp"
#include "run/start_unknowns.hpp"

namespace eomgen::run {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Newton's method ends when the step is below start_rounding; 50 steps are far more than it needs.
constexpr int newton_steps = 50;

class StartSolver {
 public:
  explicit StartSolver(StartProblem& problem) : p_(problem), s_(problem.system), n_(s_.free.size()), rows_(problem) {
    const model::Model& model = *p_.mechanics.model;
    const auto has_contact = [](const model::Constraint& c) { return c.contact.has_value(); };
    if (std::any_of(model.constraints.begin(), model.constraints.end(), has_contact)) hold_angles(held_);
    if (!model.joints.empty()) hold_angles(loose_);
  }

  void run() {
    const std::size_t all = p_.mechanics.q.size();
    p_.q.assign(all, 0);
    p_.qdot.assign(all, 0);
    for (const auto& [key, given] : p_.given) rows_.value(key) = given.value;
    impose_fixed();
    leave(0);
    solve(0);
    require_tangents(p_, rows_);
    leave(1);
    if (rows_.add_rolling()) {
      const std::vector<double> given = p_.qdot;
      const std::vector<std::string> notes_before = p_.solved_notes;
      newton(1, unknowns(1));
      if (rows_.largest_residual(1) <= start_tolerance) return;
      p_.qdot = given;  // the body slides
      p_.solved_notes = notes_before;
      rows_.drop_rolling();
    }
    solve(1);
  }

 private:
  enum class Steps : std::uint8_t { full, damped };  // of Newton's method

  // A unilateral contact is open if all coordinates in its gap are given, and the gap is positive (order 0) or
  // increasing (order 1).
  void leave(std::uint8_t order) {
    p_.open.resize(rows_.contacts().size(), false);
    VectorXd residual;
    MatrixXd A;
    rows_.linearise(order, residual, A);
    const std::vector<std::size_t> numbers = rows_.of_order(order);  // before any row is dropped
    for (std::size_t j = 0; j < rows_.contacts().size(); ++j) {
      if (!rows_.contacts()[j].unilateral || p_.open[j]) continue;
      const std::size_t k = *rows_.contacts()[j].row;
      const Eigen::Index row = std::find(numbers.begin(), numbers.end(), k) - numbers.begin();
      bool given = std::isfinite(residual(row));
      for (std::size_t i = 0; i < n_; ++i) {
        const StartProblem::Key key{s_.free[i], order};
        if (A(row, static_cast<Eigen::Index>(i)) != 0) given = given && p_.given.contains(key) && !may_move(key);
      }
      if (!given || !(residual(row) > 0) || rows_.relative(residual, A, order, row) <= start_tolerance) continue;
      p_.open[j] = order == 0;  // the run reports a contact that opens
      rows_.drop(k);
    }
  }

  /// Whether three of four Euler parameters are given, with a norm below 1.
  bool follows_from_unit(std::uint32_t f) const {
    const model::Frame& frame = p_.mechanics.model->frames[f];
    if (frame.rotation != "euler_parameters") return false;
    double square = 0;
    std::size_t given = 0;
    for (const model::NodeId entry : frame.entries) {
      const model::Node& node = p_.mechanics.model->arena[entry];
      const auto found = p_.given.find({node.index, 0});
      if (node.op != model::Op::coordinate || found == p_.given.end()) continue;
      ++given;
      square += found->second.value * found->second.value;
    }
    return given + 1 == frame.entries.size() && square < 1 - start_tolerance;
  }

  // The position of a rolling or sliding body follows from its attitude, not vice versa: angles and their rates that
  // are not given are 0. The same holds for bodies in joints, unless a loop of joints determines their angles.
  void hold_angles(std::set<StartProblem::Key>& held) const {
    const model::Model& model = *p_.mechanics.model;
    for (std::uint32_t f = 1; f < model.frames.size(); ++f) {
      const auto given = [f](const StartProblem::AngularVelocity& turn) { return turn.frame == f; };
      const bool turns = std::any_of(p_.angular_velocities.begin(), p_.angular_velocities.end(), given);
      for (const model::NodeId entry : model.frames[f].entries) {
        const model::Node& node = model.arena[entry];
        if (node.op != model::Op::coordinate) continue;
        if (!p_.guess.contains({node.index, 0}) && !follows_from_unit(f)) held.insert({node.index, 0});
        if (!turns && !p_.guess.contains({node.index, 1})) held.insert({node.index, 1});
      }
    }
  }

  // The constraint determines an eliminated coordinate; a given value has to agree with it.
  void impose_fixed() {
    symbolic::Substitution written = derive::time_function_substitution(p_.mechanics);
    for (const mechanics::FixedCoordinate& fixed : p_.mechanics.fixed) {
      const std::vector<double> exact = rows_.evaluate({written(fixed.value), written(fixed.rate)});
      for (std::uint8_t order = 0; order < 2; ++order) {
        const StartProblem::Key key{fixed.coordinate, order};
        const std::string& constraint = p_.mechanics.constraints[fixed.constraint].label;
        const auto given = p_.given.find(key);
        if (given != p_.given.end() && !may_move(key)) {
          const double off = std::abs(given->second.value - exact[order]);
          if (!(off <= start_tolerance * std::max(std::abs(exact[order]), std::abs(given->second.value)))) {
            throw Error("scene", p_.mechanics.model->where(given->second.span),
                        fmt::format("{} = {} breaks constraint '{}', which fixes it at {} (off by {:.3g})",
                                    rows_.label(key), given->second.value, constraint, exact[order], off),
                        fmt::format("leave {} out: it follows from the constraint", rows_.label(key)));
          }
        }
        rows_.value(key) = exact[order];
        p_.solved_notes.push_back(fmt::format("{} = {} follows from '{}'", rows_.label(key), exact[order], constraint));
      }
    }
  }

  bool may_move(StartProblem::Key key) const {
    return std::find(p_.scene.solve.begin(), p_.scene.solve.end(), key) != p_.scene.solve.end();
  }

  std::vector<std::size_t> unknowns(std::uint8_t order) const {  // positions in s_.free
    std::vector<std::size_t> result;
    for (std::size_t i = 0; i < n_; ++i) {
      const StartProblem::Key key{s_.free[i], order};
      if ((!p_.given.contains(key) && !held_.contains(key) && !loose_.contains(key)) || may_move(key))
        result.push_back(i);
    }
    return result;
  }

  /// Unilateral contacts that are open at the current values, although not all coordinates in their gaps are given.
  std::vector<std::size_t> open_contacts() {
    VectorXd residual;
    MatrixXd A;
    rows_.linearise(0, residual, A);
    std::vector<std::size_t> open;
    for (std::size_t j = 0; j < rows_.contacts().size(); ++j) {
      if (!rows_.contacts()[j].unilateral || p_.open[j]) continue;
      const Eigen::Index row = row_of(0, *rows_.contacts()[j].row);
      if (residual(row) > 0 && rows_.relative(residual, A, 0, row) > start_tolerance) open.push_back(j);
    }
    return open;
  }
  Eigen::Index row_of(std::uint8_t order, std::size_t constraint) const {
    const auto found = std::find(rows_.of_order(order).begin(), rows_.of_order(order).end(), constraint);
    return static_cast<Eigen::Index>(found - rows_.of_order(order).begin());
  }

  /// Opens the contacts that are incompatible with the given values, if they are open at the initial guess.
  void open_unreachable_contacts(const std::vector<double>& begin, const std::vector<std::string>& notes_before) {
    const std::vector<double> end = p_.q;
    p_.q = begin;
    const std::vector<std::size_t> open = open_contacts();
    if (open.empty()) {
      p_.q = end;
      return;
    }
    p_.solved_notes = notes_before;
    std::string names;
    for (const std::size_t j : open) {
      p_.open[j] = true;
      rows_.drop(*rows_.contacts()[j].row);
      names += (names.empty() ? "'" : ", '") + rows_.contacts()[j].name + "'";
    }
    p_.solved_notes.push_back(names + (open.size() == 1 ? " is" : " are") + " open: the start cannot be met while " +
                              (open.size() == 1 ? "it is closed" : "all are closed"));
    solve(0);
    for (const std::size_t j : open) require_open(rows_.contacts()[j]);
  }
  void require_open(const StartRows::Contact& contact) {
    if (rows_.evaluate({rows_.psi()[*contact.row]})[0] >= 0) return;
    throw Error("scene", p_.mechanics.model->where(p_.scene.span),
                fmt::format("the start breaks constraint '{}', which is to be 0 or more", contact.name),
                "give values with which it is open or closed, or start the search elsewhere with guess = { .. }");
  }

  void solve(std::uint8_t order) {
    if (rows_.of_order(order).empty()) return;
    std::vector<std::size_t> free = unknowns(order);
    const std::vector<std::string> notes_before = p_.solved_notes;
    for (const std::size_t i : free) {
      const auto guess = p_.guess.find({s_.free[i], order});
      if (guess != p_.guess.end()) rows_.value({s_.free[i], order}) = guess->second;
    }
    const std::vector<double> begin = p_.q;
    if (rows_.largest_residual(order) > rounding) newton(order, free);
    if (rows_.largest_residual(order) > start_tolerance && !loose_.empty()) {
      loose_.clear();
      free = unknowns(order);
      newton(order, free);
      if (order == 0) hold_angles(loose_);
    }
    if (order == 1 && rows_.largest_residual(order) > start_tolerance &&
        !held_.empty()) {  // the velocity of a rolling body is given instead of its spin
      held_.clear();
      free = unknowns(order);
      newton(order, free);
    }
    if (rows_.largest_residual(order) > start_tolerance) choose(order, free);
    if (order == 0 && rows_.largest_residual(order) > start_tolerance) {
      open_unreachable_contacts(begin, notes_before);
      if (rows_.of_order(order).empty()) return;
    }
    Eigen::Index k = 0;
    if (rows_.largest_residual(order, &k) > start_tolerance)
      refuse_start(p_, rows_, order, static_cast<std::size_t>(k), free);
    if (order == 0) note_other_branch(begin, free);
  }

  /// Whether a coordinate may have a second value of its own. Angles and parameters of rotations have other names of
  /// the same attitude, and a range selects a branch.
  bool may_branch(std::uint32_t coordinate) const {
    const model::Model& model = *p_.mechanics.model;
    if (model.coordinates[coordinate].lower != model::no_node || model.coordinates[coordinate].upper != model::no_node)
      return false;
    for (const model::Frame& frame : model.frames) {
      if (frame.entries.size() < 2) continue;
      for (const model::NodeId entry : frame.entries) {
        const model::Node& node = model.arena[entry];
        if (node.op == model::Op::coordinate && node.index == coordinate) return false;
      }
    }
    return true;
  }

  /// Equations such as x^2 + y^2 = L^2 determine an unknown up to its branch: looks for a second solution on the other
  /// side, and reports it with the guess that selects it.
  void note_other_branch(const std::vector<double>& begin, const std::vector<std::size_t>& free) {
    const std::vector<double> found = p_.q;
    std::vector<std::size_t> solved;
    for (const std::size_t i : free) {
      const std::uint32_t c = s_.free[i];
      if (found[c] == begin[c]) continue;
      // A guess, or a value near the solution, has selected the branch.
      if (!may_branch(c) || p_.guess.contains({c, 0}) || p_.given.contains({c, 0})) return;
      solved.push_back(i);
    }
    if (solved.empty()) return;
    const auto negative = [](double x, double) { return -x; };
    const auto mirrored = [](double x, double from) { return 2 * from - x; };
    const auto supplement = [](double x, double) { return std::numbers::pi - x; };
    using Reflection = double (*)(double, double);
    std::vector<std::vector<double>> starts;
    for (const Reflection reflect : {Reflection(negative), Reflection(mirrored), Reflection(supplement)}) {
      const std::size_t all = (std::size_t{1} << std::min(solved.size(), most_reflected)) - 1;
      for (std::size_t subset = all; subset > 0; --subset) {  // unknowns beyond the first few are reflected together
        starts.push_back(found);
        for (std::size_t k = 0; k < solved.size(); ++k) {
          const std::uint32_t c = s_.free[solved[k]];
          if (((subset >> std::min(k, most_reflected - 1)) & 1u) != 0) starts.back()[c] = reflect(found[c], begin[c]);
        }
      }
    }
    for (const std::vector<double>& from : starts) {
      p_.q = from;
      if (!iterate(0, free, false) || !differs(found, free) || !are_open_contacts_open()) continue;
      std::string values;
      std::size_t count = 0;
      for (const std::size_t i : free) {
        const std::uint32_t c = s_.free[i];
        if (!is_other(found[c], p_.q[c])) continue;
        values += fmt::format("{}{} = {}", values.empty() ? "" : ", ", rows_.label({c, 0}), p_.q[c]);
        ++count;
      }
      p_.solved_notes.push_back(fmt::format("{} {} them too: the run starts there with guess = {{ {} }}", values,
                                            count == 1 ? "satisfies" : "satisfy", values));
      break;
    }
    p_.q = found;
  }
  static bool is_other(double first, double second) {
    return std::abs(first - second) > branch_tolerance * std::max({1.0, std::abs(first), std::abs(second)});
  }
  /// Whether the current values are another configuration: full turns are none.
  bool differs(const std::vector<double>& found, const std::vector<std::size_t>& free) const {
    return std::any_of(free.begin(), free.end(), [&](std::size_t i) {
      const std::uint32_t c = s_.free[i];
      return is_other(0, std::remainder(found[c] - p_.q[c], 2 * std::numbers::pi)) && is_other(found[c], p_.q[c]);
    });
  }
  bool are_open_contacts_open() {
    for (std::size_t j = 0; j < rows_.contacts().size(); ++j) {
      if (p_.open[j] && !(rows_.evaluate({rows_.psi()[*rows_.contacts()[j].row]})[0] >= 0)) return false;
    }
    return true;
  }

  /// If several choices satisfy the constraints (as for rolling without a given spin about the normal), solves for the
  /// unknowns that the constraints depend on most strongly, first for those without inertia, such as the place of a
  /// nearest point. The others stay 0 or keep their guess; this is reported.
  void choose(std::uint8_t order, const std::vector<std::size_t>& free) {
    VectorXd residual;
    MatrixXd A;
    rows_.linearise(order, residual, A);
    if (free.empty() || !A.allFinite()) return;
    MatrixXd columns(A.rows(), static_cast<Eigen::Index>(free.size()));
    std::vector<bool> first;
    for (std::size_t i = 0; i < free.size(); ++i) {
      columns.col(static_cast<Eigen::Index>(i)) = A.col(static_cast<Eigen::Index>(free[i]));
      first.push_back(may_move({s_.free[free[i]], order}) || is_massless(s_, free[i]));
    }
    std::vector<std::size_t> chosen;
    std::string open;
    const std::vector<bool> felt = select_most_sensitive(columns, first, start_rank_tolerance);
    for (std::size_t i = 0; i < free.size(); ++i) {
      const StartProblem::Key key{s_.free[free[i]], order};
      if (felt[i])
        chosen.push_back(free[i]);
      else if (columns.col(static_cast<Eigen::Index>(i)).cwiseAbs().maxCoeff() > 0)
        open += fmt::format("{}{} = {}", open.empty() ? "" : ", ", rows_.label(key), rows_.value(key));
    }
    if (chosen.size() == free.size() || open.empty()) return;
    newton(order, chosen);
    if (rows_.largest_residual(order) <= start_tolerance)
      p_.solved_notes.push_back(open + " (chosen: the constraints can be met in several ways)");
  }

  // Unknowns that no constraint depends on locally keep their values.
  void move_beside(std::uint8_t order, const std::vector<std::size_t>& free, double offset) {
    if (offset == 0) return;
    for (const std::size_t i : free) rows_.value({s_.free[i], order}) += offset;
    VectorXd residual;
    MatrixXd A;
    rows_.linearise(order, residual, A);
    for (const std::size_t i : free) {
      if (A.col(static_cast<Eigen::Index>(i)).isZero(0)) rows_.value({s_.free[i], order}) -= offset;
    }
  }

  // Starts from the guess (or 0), then from points near it: at 0 a gradient may vanish (x^2 + y^2 - L^2). Where all of
  // them fail, shorter steps may not: those of atan(50 z) - x leave the neighbourhood of z = 0.
  void newton(std::uint8_t order, const std::vector<std::size_t>& free) {
    if (!newton(order, free, Steps::full) && order == 0) newton(order, free, Steps::damped);
  }
  bool newton(std::uint8_t order, const std::vector<std::size_t>& free, Steps steps) {
    const std::vector<double> start = order == 0 ? p_.q : p_.qdot;
    for (const double offset : {0.0, 1.0, -1.0, 0.1, 10.0}) {
      (order == 0 ? p_.q : p_.qdot) = start;
      move_beside(order, free, offset);
      if (!iterate(order, free, offset == 0, steps))
        continue;  // away from the guess undetermined unknowns would not be 0
      // Accept only unknowns that the constraints determine; any other value would be arbitrary.
      for (const std::size_t i : free) {
        const StartProblem::Key key{s_.free[i], order};
        if (rows_.value(key) == start[key.first]) continue;
        p_.solved_notes.push_back(
            fmt::format("{} = {} follows from the constraints", rows_.label(key), rows_.value(key)));
      }
      return true;
    }
    (order == 0 ? p_.q : p_.qdot) = start;
    return false;
  }

  /// Subtracts the move; a smaller part of it if a function of the constraints, such as log, has no value there.
  /// Damped: or if the residuals, relative to their slopes, do not decrease enough.
  /// residual, A: the rows before the step, and behind it after.
  void take_step(std::uint8_t order, const std::vector<std::size_t>& moving, Steps steps, VectorXd& residual,
                 MatrixXd& A, VectorXd& move) {
    constexpr int most_halvings = 20;
    constexpr double sufficient = 0.25;  // of the decrease of the linear model
    const std::vector<double> before = order == 0 ? p_.q : p_.qdot;
    const VectorXd scale = A.rowwise().norm().cwiseMax(std::numeric_limits<double>::min());
    const double size = residual.cwiseQuotient(scale).norm();
    double part = 1;
    for (int halving = 0; halving <= most_halvings; ++halving, part /= 2) {
      for (std::size_t i = 0; i < moving.size(); ++i) {
        const std::uint32_t c = s_.free[moving[i]];
        rows_.value({c, order}) = before[c] - part * move(static_cast<Eigen::Index>(i));
      }
      rows_.linearise(order, residual, A);
      if (!residual.allFinite() || !A.allFinite()) continue;
      if (steps == Steps::full || residual.cwiseQuotient(scale).norm() <= (1 - sufficient * part) * size) break;
    }
    move *= part;
  }

  /// `partly`: if the constraints do not determine all unknowns, solves for those that they determine.
  bool iterate(std::uint8_t order, const std::vector<std::size_t>& free, bool partly, Steps steps = Steps::full) {
    VectorXd residual;
    MatrixXd A;
    rows_.linearise(order, residual, A);
    for (int step = 0; step < newton_steps; ++step) {
      if (!residual.allFinite() || !A.allFinite()) return false;
      std::vector<std::size_t> moving;  // unknowns with a nonzero column
      for (const std::size_t i : free) {
        if (A.col(static_cast<Eigen::Index>(i)).cwiseAbs().maxCoeff() > 0) moving.push_back(i);
      }
      if (moving.empty()) return rows_.largest_residual(order) <= rounding;
      MatrixXd columns(A.rows(), static_cast<Eigen::Index>(moving.size()));
      for (std::size_t i = 0; i < moving.size(); ++i) {
        columns.col(static_cast<Eigen::Index>(i)) = A.col(static_cast<Eigen::Index>(moving[i]));
      }
      auto [move, rank] = numeric::least_squares(columns, residual, start_rank_tolerance);
      if (rank < columns.cols()) {
        if (!partly) return false;
        if (!keep_determined(columns, rank, start_rank_tolerance, move))
          return rows_.largest_residual(order) <= rounding;
      }
      take_step(order, moving, steps, residual, A, move);
      double size = move.cwiseAbs().maxCoeff(), scale = 0;
      for (const std::size_t i : moving) scale = std::max(scale, std::abs(rows_.value({s_.free[i], order})));
      if (size <= start_rounding * scale || rows_.largest_residual(order) <= start_rounding)
        return rows_.largest_residual(order) <= rounding;
    }
    return rows_.largest_residual(order) <= rounding;
  }

  static constexpr std::size_t most_reflected = 2;  // subsets of so many unknowns are tried
  static constexpr double branch_tolerance = 1e-6;  // solutions that are nearer are one, found with rounding
  static constexpr double rounding = 1e-14;  // of rows_.relative(): a few units in the last place of a sum of terms

  StartProblem& p_;
  const system::EquationSystem& s_;
  std::size_t n_;
  StartRows rows_;
  std::set<StartProblem::Key> held_;   // not given, and set to 0
  std::set<StartProblem::Key> loose_;  // not given, and set to 0 if the constraints then hold
};

}  // namespace

void solve_start(StartProblem& problem) { StartSolver(problem).run(); }

}  // namespace eomgen::run

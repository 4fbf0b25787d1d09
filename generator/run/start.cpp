// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/start.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "derive/imposition.hpp"
#include "run/scene.hpp"
#include "run/start_unknowns.hpp"
#include "symbolic/evaluate.hpp"

namespace eomgen::run {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using symbolic::Ref;
using symbolic::Symbol;
using symbolic::SymbolKind;

// Newton ends when the step is below this many units in the last place; 50 steps are far more than it needs.
constexpr double newton_tolerance = 4e-16;
constexpr int newton_steps = 50;
// Columns of A whose part outside the span of the others is smaller than this (relative) do not fix their coordinate.
constexpr double rank_tolerance = 1e-10;

class StartSolver {
 public:
  explicit StartSolver(StartProblem& problem)
      : p_(problem), s_(problem.system), n_(s_.free.size()), m_(s_.active.size()) {
    for (std::size_t k = 0; k < m_; ++k) {
      if (s_.holonomic[k]) rows_[0].push_back(k);
      rows_[1].push_back(k);
    }
    A_ = s_.A;
    psi_ = s_.psi;
    b_ = s_.b;
    for (const system::Watched& watched : s_.redundant) {
      if (p_.mechanics.constraints[watched.constraint].holonomic()) rows_[0].push_back(b_.size());
      rows_[1].push_back(b_.size());
      A_.insert(A_.end(), watched.A.begin(), watched.A.end());
      psi_.push_back(watched.psi);
      b_.push_back(watched.b);
    }
    target_.assign(b_.size(), 0);
    for (const StartProblem::Turn& turn : p_.turns) add_turn(turn);
    const model::Model& model = *p_.mechanics.model;
    const auto touches = [](const model::Constraint& c) { return c.contact.has_value(); };
    if (std::any_of(model.constraints.begin(), model.constraints.end(), touches)) hold_angles(held_);
    if (!model.joints.empty()) hold_angles(loose_);
  }

  void run() {
    const std::size_t all = p_.mechanics.q.size();
    p_.q.assign(all, 0);
    p_.qdot.assign(all, 0);
    for (const auto& [key, given] : p_.given) value(key) = given.value;
    impose_fixed();
    leave(0);
    solve(0);
    leave(1);
    if (add_rolling()) {
      const std::vector<double> given = p_.qdot;
      const std::vector<std::string> told = p_.solved;
      newton(1, unknowns(1));
      if (worst(1) <= start_tolerance) return;
      p_.qdot = given;  // it slides
      p_.solved = told;
      drop_rolling();
    }
    solve(1);
  }

 private:
  // A contact that can be left is left where all that its gap depends on is given, and the gap is open (order 0) or
  // opening (1).
  void leave(std::uint8_t order) {
    p_.apart.resize(s_.contacts.size(), false);
    for (std::size_t j = 0; j < s_.contacts.size(); ++j) {
      if (!s_.contacts[j].unilateral || p_.apart[j]) continue;
      const std::size_t k = *s_.contacts[j].unilateral;
      VectorXd residual;
      MatrixXd A;
      linearise(order, residual, A);
      const auto found = std::find(rows_[order].begin(), rows_[order].end(), k);
      const auto row = static_cast<Eigen::Index>(found - rows_[order].begin());
      bool given = std::isfinite(residual(row));
      for (std::size_t i = 0; i < n_; ++i) {
        const StartProblem::Key key{s_.free[i], order};
        if (A(row, static_cast<Eigen::Index>(i)) != 0) given = given && p_.given.contains(key) && !may_move(key);
      }
      if (!given || !(residual(row) > 0) || relative(residual, A, order, row) <= start_tolerance) continue;
      p_.apart[j] = order == 0;  // what opens is told by the run
      for (auto& rows : rows_) std::erase(rows, k);
    }
  }

  // Of rolling with friction the rates that are not given follow from rolling, if those that are given allow it: slip 0
  // as more rows.
  bool add_rolling() {
    const std::size_t before = rows_[1].size();
    for (std::size_t j = 0; j < s_.contacts.size(); ++j) {
      const std::optional<std::uint32_t> body_contact = p_.mechanics.contacts[j].body_contact;
      if (!body_contact || !p_.mechanics.model->constraints[*body_contact].rolls_by_friction() || p_.apart[j]) continue;
      if (s_.contacts[j].unilateral &&
          std::find(rows_[1].begin(), rows_[1].end(), *s_.contacts[j].unilateral) == rows_[1].end())
        continue;
      for (const Ref slip : s_.contacts[j].slip) add_rate(slip, 0);
    }
    return rows_[1].size() > before;
  }
  void drop_rolling() {
    while (!rows_[1].empty() && rows_[1].back() >= m_ + s_.redundant.size() + 3 * p_.turns.size()) rows_[1].pop_back();
  }

  // Of a body that rolls or slides the position follows from the attitude, not the other way round: angles and their
  // rates that are not given are 0. So are those of bodies in joints, unless joints close a loop from which they
  // follow.
  void hold_angles(std::set<StartProblem::Key>& held) const {
    const model::Model& model = *p_.mechanics.model;
    for (std::uint32_t f = 1; f < model.frames.size(); ++f) {
      const auto given = [f](const StartProblem::Turn& turn) { return turn.frame == f; };
      const bool turns = std::any_of(p_.turns.begin(), p_.turns.end(), given);
      for (const model::NodeId entry : model.frames[f].entries) {
        const model::Node& node = model.arena[entry];
        if (node.op != model::Op::coordinate) continue;
        if (!p_.guess.contains({node.index, 0})) held.insert({node.index, 0});
        if (!turns && !p_.guess.contains({node.index, 1})) held.insert({node.index, 1});
      }
    }
  }

  // An angular velocity is linear in the rates: three more rows beside those of the constraints.
  void add_turn(const StartProblem::Turn& turn) {
    symbolic::Substitution imposed = derive::impose(p_.mechanics), written = derive::write_out(p_.mechanics);
    for (std::size_t k = 0; k < 3; ++k)
      add_rate(written(imposed(p_.mechanics.angular_velocity[turn.frame][k])), turn.value[k]);
  }

  // A row w = value, of w that is linear in the rates.
  void add_rate(Ref w, double wanted) {
    symbolic::Dag& dag = *s_.dag;
    std::map<Symbol, Ref> zero;
    for (const std::uint32_t i : s_.free) zero[{SymbolKind::coordinate, i, 1}] = dag.zero();
    symbolic::Substitution at_rest(dag, zero);
    rows_[1].push_back(b_.size());
    for (const std::uint32_t i : s_.free) A_.push_back(symbolic::partial(dag, {SymbolKind::coordinate, i, 1})(w));
    b_.push_back(at_rest(w));
    target_.push_back(wanted);
  }

  double& value(StartProblem::Key key) { return (key.second == 0 ? p_.q : p_.qdot)[key.first]; }
  std::string label(StartProblem::Key key) const {
    return p_.mechanics.model->coordinates[key.first].name + (key.second == 0 ? "" : "_dot");
  }

  double lookup(const Symbol& s) const {
    switch (s.kind) {
      case SymbolKind::parameter: return p_.parameters[s.index];
      case SymbolKind::time: return p_.t0;
      case SymbolKind::integral: return 0;  // counts from here
      case SymbolKind::coordinate: return s.order == 0 ? p_.q[s.index] : p_.qdot[s.index];
      default: return std::nan("");
    }
  }
  std::vector<double> evaluate(const std::vector<Ref>& refs) const {
    return symbolic::evaluate(*s_.dag, refs, [this](const Symbol& s) { return lookup(s); });
  }

  // Eliminated coordinates have their value from the constraint; a value that was given must be that one.
  void impose_fixed() {
    symbolic::Substitution written = derive::write_out(p_.mechanics);
    for (const mechanics::FixedCoordinate& fixed : p_.mechanics.fixed) {
      const std::vector<double> exact = evaluate({written(fixed.value), written(fixed.rate)});
      for (std::uint8_t order = 0; order < 2; ++order) {
        const StartProblem::Key key{fixed.coordinate, order};
        const std::string& constraint = p_.mechanics.constraints[fixed.constraint].label;
        const auto given = p_.given.find(key);
        if (given != p_.given.end() && !may_move(key)) {
          const double off = std::abs(given->second.value - exact[order]);
          if (!(off <= start_tolerance * std::max(std::abs(exact[order]), std::abs(given->second.value)))) {
            throw Error("scene", p_.mechanics.model->where(given->second.span),
                        fmt::format("{} = {} breaks constraint '{}', which fixes it at {} (off by {:.3g})", label(key),
                                    given->second.value, constraint, exact[order], off),
                        fmt::format("leave {} out: it follows from the constraint", label(key)));
          }
        }
        value(key) = exact[order];
        p_.solved.push_back(fmt::format("{} = {} follows from '{}'", label(key), exact[order], constraint));
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

  /// Residual of psi (order 0) or A qdot + b (order 1), and A.
  void linearise(std::uint8_t order, VectorXd& residual, MatrixXd& A) const {
    std::vector<Ref> refs = A_;
    const std::vector<Ref>& constant = order == 0 ? psi_ : b_;
    refs.insert(refs.end(), constant.begin(), constant.end());
    const std::vector<double> values = evaluate(refs);
    const std::vector<std::size_t>& bound = rows_[order];
    A.resize(static_cast<Eigen::Index>(bound.size()), static_cast<Eigen::Index>(n_));
    residual.resize(static_cast<Eigen::Index>(bound.size()));
    for (std::size_t row = 0; row < bound.size(); ++row) {
      const std::size_t k = bound[row];
      double sum = values[A_.size() + k] - (order == 1 ? target_[k] : 0);
      for (std::size_t i = 0; i < n_; ++i) {
        A(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(i)) = values[k * n_ + i];
        if (order == 1) sum += values[k * n_ + i] * p_.qdot[s_.free[i]];
      }
      residual(static_cast<Eigen::Index>(row)) = sum;
    }
  }

  // |psi_k| against the size of its linear terms: the relative measure of the contract.
  double relative(const VectorXd& residual, const MatrixXd& A, std::uint8_t order, Eigen::Index k) const {
    double terms = 0, slopes = 0, largest = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      const double x = order == 0 ? p_.q[s_.free[i]] : p_.qdot[s_.free[i]],
                   slope = std::abs(A(k, static_cast<Eigen::Index>(i)));
      terms += std::abs(slope * x);
      slopes += slope;
      largest = std::max(largest, std::abs(x));
    }
    const double size = std::abs(residual(k));
    // What is beyond the last digit of the other coordinates is 0, whatever it is made of.
    if (size <= newton_tolerance * slopes * largest) return 0;
    // At rest every term of A qdot vanishes; b itself is then the scale.
    return terms > size ? size / terms : 1;
  }

  double worst(std::uint8_t order, Eigen::Index* where = nullptr) const {
    VectorXd residual;
    MatrixXd A;
    linearise(order, residual, A);
    double largest = 0;
    for (Eigen::Index k = 0; k < residual.size(); ++k) {
      const double size = std::isfinite(residual(k)) ? relative(residual, A, order, k) : 1;
      if (size <= largest) continue;
      largest = size;
      if (where != nullptr) *where = k;
    }
    return largest;
  }

  void solve(std::uint8_t order) {
    if (rows_[order].empty()) return;
    std::vector<std::size_t> free = unknowns(order);
    for (const std::size_t i : free) {
      const auto guess = p_.guess.find({s_.free[i], order});
      if (guess != p_.guess.end()) value({s_.free[i], order}) = guess->second;
    }
    if (worst(order) > rounding) newton(order, free);
    if (worst(order) > start_tolerance && !loose_.empty()) {
      loose_.clear();
      free = unknowns(order);
      newton(order, free);
      if (order == 0) hold_angles(loose_);
    }
    if (order == 1 && worst(order) > start_tolerance &&
        !held_.empty()) {  // the speed of a body that rolls is given in place of its spin
      held_.clear();
      free = unknowns(order);
      newton(order, free);
    }
    if (worst(order) > start_tolerance) choose(order, free);
    Eigen::Index k = 0;
    if (worst(order, &k) > start_tolerance) refuse(order, static_cast<std::size_t>(k), free);
  }

  /// Where the constraints could be met in several ways, as by rolling that says nothing of the spin about the normal:
  /// those unknowns follow that they feel most, and the others stay 0 (or their guess), which is told.
  void choose(std::uint8_t order, const std::vector<std::size_t>& free) {
    VectorXd residual;
    MatrixXd A;
    linearise(order, residual, A);
    if (free.empty() || !A.allFinite()) return;
    MatrixXd columns(A.rows(), static_cast<Eigen::Index>(free.size()));
    std::vector<bool> first;
    for (std::size_t i = 0; i < free.size(); ++i) {
      columns.col(static_cast<Eigen::Index>(i)) = A.col(static_cast<Eigen::Index>(free[i]));
      first.push_back(may_move({s_.free[free[i]], order}));
    }
    std::vector<std::size_t> chosen;
    std::string open;
    const std::vector<bool> felt = felt_most(columns, first, rank_tolerance);
    for (std::size_t i = 0; i < free.size(); ++i) {
      const StartProblem::Key key{s_.free[free[i]], order};
      if (felt[i])
        chosen.push_back(free[i]);
      else if (columns.col(static_cast<Eigen::Index>(i)).cwiseAbs().maxCoeff() > 0)
        open += fmt::format("{}{} = {}", open.empty() ? "" : ", ", label(key), value(key));
    }
    if (chosen.size() == free.size() || open.empty()) return;
    newton(order, chosen);
    if (worst(order) <= start_tolerance)
      p_.solved.push_back(open + " (chosen: the constraints can be met in several ways)");
  }

  // Tried from the guess (or 0), then from points beside it: at 0 a gradient may vanish (x^2 + y^2 - L^2).
  void newton(std::uint8_t order, const std::vector<std::size_t>& free) {
    const std::vector<double> start = order == 0 ? p_.q : p_.qdot;
    for (const double offset : {0.0, 1.0, -1.0, 0.1, 10.0}) {
      (order == 0 ? p_.q : p_.qdot) = start;
      for (const std::size_t i : free) value({s_.free[i], order}) += offset;
      if (!iterate(order, free, offset == 0)) continue;  // beside it nothing that stays would be 0
      // Only what the constraints fix may follow from them; the rest would be a guess of ours.
      for (const std::size_t i : free) {
        const StartProblem::Key key{s_.free[i], order};
        if (value(key) == start[key.first]) continue;
        p_.solved.push_back(fmt::format("{} = {} follows from the constraints", label(key), value(key)));
      }
      return;
    }
    (order == 0 ? p_.q : p_.qdot) = start;
  }

  /// `partly`: where the constraints do not fix all of them, those that they fix.
  bool iterate(std::uint8_t order, const std::vector<std::size_t>& free, bool partly) {
    VectorXd residual;
    MatrixXd A;
    for (int step = 0; step < newton_steps; ++step) {
      linearise(order, residual, A);
      if (!residual.allFinite() || !A.allFinite()) return false;
      std::vector<std::size_t> moving;  // with a column that is not zero
      for (const std::size_t i : free) {
        if (A.col(static_cast<Eigen::Index>(i)).cwiseAbs().maxCoeff() > 0) moving.push_back(i);
      }
      if (moving.empty()) return worst(order) <= rounding;
      MatrixXd columns(A.rows(), static_cast<Eigen::Index>(moving.size()));
      for (std::size_t i = 0; i < moving.size(); ++i) {
        columns.col(static_cast<Eigen::Index>(i)) = A.col(static_cast<Eigen::Index>(moving[i]));
      }
      Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
      decomposition.setThreshold(rank_tolerance);
      decomposition.compute(columns);
      VectorXd move = decomposition.solve(residual);
      if (decomposition.rank() < columns.cols()) {
        if (!partly) return false;
        if (!keep_fixed(columns, decomposition.rank(), rank_tolerance, move)) return worst(order) <= rounding;
      }
      double size = 0, scale = 0;
      for (std::size_t i = 0; i < moving.size(); ++i) {
        double& x = value({s_.free[moving[i]], order});
        x -= move(static_cast<Eigen::Index>(i));
        size = std::max(size, std::abs(move(static_cast<Eigen::Index>(i))));
        scale = std::max(scale, std::abs(x));
      }
      if (size <= newton_tolerance * scale || worst(order) <= newton_tolerance) return worst(order) <= rounding;
    }
    return worst(order) <= rounding;
  }

  /// Of rates: the first constraint that cannot hold beside what is given and the constraints before it, and by how
  /// much it is off then.
  std::pair<std::size_t, double> first_broken(const std::vector<std::size_t>& free) const {
    VectorXd residual;
    MatrixXd A;
    linearise(1, residual, A);
    MatrixXd columns(A.rows(), static_cast<Eigen::Index>(free.size()));
    for (std::size_t i = 0; i < free.size(); ++i)
      columns.col(static_cast<Eigen::Index>(i)) = A.col(static_cast<Eigen::Index>(free[i]));
    const std::vector<std::size_t>& bound = rows_[1];
    const std::size_t turns = m_ + s_.redundant.size();
    std::vector<std::size_t> before;
    for (std::size_t k = 0; k < bound.size(); ++k) {
      if (bound[k] >= turns) before.push_back(k);
    }
    for (std::size_t k = 0; k < bound.size(); ++k) {
      if (bound[k] >= turns) continue;
      const auto count = static_cast<Eigen::Index>(before.size());
      MatrixXd held(count, columns.cols());
      VectorXd wanted(count);
      for (Eigen::Index i = 0; i < count; ++i) {
        held.row(i) = columns.row(static_cast<Eigen::Index>(before[static_cast<std::size_t>(i)]));
        wanted(i) = residual(static_cast<Eigen::Index>(before[static_cast<std::size_t>(i)]));
      }
      const auto row = static_cast<Eigen::Index>(k);
      VectorXd move = VectorXd::Zero(columns.cols());
      Eigen::CompleteOrthogonalDecomposition<MatrixXd> decomposition;
      decomposition.setThreshold(rank_tolerance);
      VectorXd beside = columns.row(row).transpose();
      if (count > 0 && columns.cols() > 0) {
        decomposition.compute(held);
        move = decomposition.solve(wanted);
        beside -= held.transpose() * held.transpose().completeOrthogonalDecomposition().solve(beside);
      }
      const double off = residual(row) - columns.row(row).dot(move);
      const double size = std::abs(residual(row)) + columns.row(row).cwiseAbs().dot(move.cwiseAbs());
      if (beside.norm() <= rank_tolerance * columns.row(row).norm() && std::abs(off) > start_tolerance * size)
        return {k, off};
      before.push_back(k);
    }
    return {bound.size(), 0};
  }

  [[noreturn]] void refuse_turn(const StartProblem::Turn& turn, double off) const {
    throw Error("scene", p_.mechanics.model->where(turn.span),
                fmt::format("no rates give '{}' this angular velocity: a component is off by {:.6g}",
                            p_.mechanics.model->frames[turn.frame].name, off),
                "start away from the singular places of its angles, which `check` lists; leave rates that follow from "
                "it out; its constraints may not allow it");
  }

  [[noreturn]] void refuse(std::uint8_t order, std::size_t k, const std::vector<std::size_t>& free) const {
    VectorXd residual;
    MatrixXd A;
    linearise(order, residual, A);
    double off = residual(static_cast<Eigen::Index>(k));
    if (order == 1 && !p_.turns.empty()) {
      const auto [broken, by] = first_broken(free);
      if (broken < rows_[1].size()) k = broken, off = by;
    }
    const auto row = static_cast<Eigen::Index>(k);
    const std::size_t bound = rows_[order][k], turns = m_ + s_.redundant.size();
    if (bound >= turns) refuse_turn(p_.turns[(bound - turns) / 3], residual(row));
    const mechanics::Constraint& constraint =
        p_.mechanics.constraints[bound < m_ ? s_.active[bound] : s_.redundant[bound - m_].constraint];
    std::string given, open;
    model::Span span = p_.scene.span;
    for (std::size_t i = 0; i < n_; ++i) {
      if (A(row, static_cast<Eigen::Index>(i)) == 0) continue;
      const StartProblem::Key key{s_.free[i], order};
      const auto found = p_.given.find(key);
      if (std::find(free.begin(), free.end(), i) != free.end()) {
        open += (open.empty() ? "" : ", ") + label(key);
      } else if (found != p_.given.end()) {
        given += (given.empty() ? "\"" : ", \"") + label(key) + "\"";
        span = found->second.span;
      }
    }
    const bool alone = open.find(',') == std::string::npos;  // one unknown or none: nothing else could fix it
    const std::string remedy =
        alone && !(open.empty() && !given.empty())
            ? fmt::format(
                  "{}: check its signs{}, or start the search elsewhere with guess = {{ .. }}",
                  open.empty()
                      ? "its gradient vanishes there: it has no real solution, or only ones where it has no force"
                      : fmt::format("no value of {} was found that meets it: it may have no real solution", open),
                  given.empty() ? "" : " and what is given")
        : !given.empty() && open.empty()
            ? fmt::format("give consistent values, or name what may be moved: solve = [one of {}]", given)
            : fmt::format("the constraint does not fix {} by itself: give all but one of them, or name one in solve",
                          open);
    throw Error("scene", p_.mechanics.model->where(span),
                fmt::format("the start breaks constraint '{}'{}: it is off by {:.6g} (relative {:.3g}, allowed {:.0e})",
                            constraint.label, order == 0 || !constraint.holonomic() ? "" : " in its rates", off,
                            relative(residual, A, order, row), start_tolerance),
                remedy);
  }

  static constexpr double rounding = 1e-14;  // of relative(): a few units in the last place of a sum of terms

  StartProblem& p_;
  const system::EquationSystem& s_;
  std::size_t n_, m_;
  std::set<StartProblem::Key> held_;   // not given, and 0
  std::set<StartProblem::Key> loose_;  // not given, and 0 if the constraints hold so
  std::vector<Ref> A_, psi_, b_;  // of the active constraints, then of redundant ones, then of given angular velocities
  std::vector<double> target_;    // what A qdot + b is to be
  std::array<std::vector<std::size_t>, 2> rows_;  // constraints on positions (order 0), on velocities: all
};

}  // namespace

void solve_start(StartProblem& problem) { StartSolver(problem).run(); }

}  // namespace eomgen::run

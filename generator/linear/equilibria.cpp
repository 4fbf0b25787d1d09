// SPDX-License-Identifier: GPL-3.0-or-later
#include "linear/equilibria.hpp"

#include <algorithm>
#include <utility>

#include "linear/newton.hpp"
#include "linear/reversed_speeds.hpp"
#include "numeric/numbers.hpp"
#include "work.hpp"

namespace eomgen::linear {
namespace {

constexpr double same_point = 1e-8;
constexpr double farthest_correction = 1e-2;  // of a state that is expected to be, or to be beside, a steady motion

State<double> rounded(const State<Precise>& z) {
  State<double> result;
  for (const Precise& x : z) result.push_back(to_double(x));
  return result;
}

class Search {
 public:
  Search(const SearchRequest& request, SearchResult& result)
      : r_(request),
        flow_(request.flow),
        n_(flow_.coordinates()),
        result_(result),
        symmetry_(result.symmetry),
        held_(std::in_place, flow_, request.held) {
    held_->targets = request.targets;
    find_turns();
    result_.is_angle = turns_;
    for (const EulerAngles& set : r_.euler_angles) {
      regular_.push_back(flow_.tape({set.regular}));
      reversed_.push_back(reversed_by_turn(flow_, symmetry_, r_.start, r_.setting, set.places, 900 + r_.seed));
    }
    rough_ = {rounded(r_.setting.parameters), rounded(r_.setting.inputs), rounded(r_.setting.held),
              rounded(r_.setting.leaf)};
  }

  // Searches once as requested. If families are found, searches again with their undetermined entries held; isolated
  // points are kept.
  void run() {
    all_starts();
    std::vector<FoundPoint> alone, members;
    for (FoundPoint& point : result_.points) (point.family == 0 ? alone : members).push_back(std::move(point));
    result_.points = std::move(alone);
    if (!members.empty() && result_.interrupted) {
      result_.points.push_back(members.front());
    } else if (!members.empty()) {
      hold_families(members.front().z);
      const std::size_t before = result_.points.size();
      members_ = 0;
      result_.converged = result_.failed_starts = result_.further_members = 0;
      all_starts();
      result_.held_in_vain = result_.points.size() == before && !result_.interrupted;
      if (result_.held_in_vain) result_.points.push_back(members.front());
    }
    std::sort(result_.points.begin(), result_.points.end(),
              [this](const FoundPoint& a, const FoundPoint& b) { return this->before(a.z, b.z); });
  }

 private:
  // Members of families that are examined: before any entry is held for them, and afterwards.
  static constexpr std::size_t first_members = 3, most_members = 20;

  void all_starts() {
    std::vector<double> targets;
    for (const Precise& t : held_->targets) targets.push_back(to_double(t));
    seen_.clear();
    for (std::size_t k = 0; k < r_.starts; ++k) {
      if (work::stop_requested()) {
        result_.interrupted = true;
        return;
      }
      if (r_.progress) r_.progress(static_cast<double>(k) / static_cast<double>(r_.starts));
      const State<double> start = spread_start(r_, symmetry_, turns_, k);
      const Outcome plain = follow(start, targets, {});
      result_.converged += plain == Outcome::nothing ? 0 : 1;
      if (plain != Outcome::known) continue;
      // A start whose iteration goes to a known point is used once more, to reach another one.
      const KnownPoints known = known_points();
      if (!known.points.empty()) follow(start, targets, known);
    }
  }

  /// The end of the iteration from a start.
  enum class Outcome { nothing, known, added };

  Outcome follow(const State<double>& start, const std::vector<double>& targets, const KnownPoints& away_from) {
    RoughSolution rough = rough_steady_state(flow_, symmetry_, start, rough_, *held_, targets,
                                             SteadyEquations::inertia_forces, away_from);
    if (!rough.found && away_from.points.empty())
      rough = rough_steady_state(flow_, symmetry_, start, rough_, *held_, targets, SteadyEquations::accelerations);
    if (!rough.reason.empty() && away_from.points.empty()) result_.record_failure(rough.reason, rough.z);
    if (!rough.found) return Outcome::nothing;
    State<double> named = rough.z;
    select_representative(named, rough_, 1e-8, [&](State<double>& at, const State<double>& other) {
      if (is_rough_steady_state(flow_, symmetry_, other, rough_, *held_, targets)) at = other;
    });
    State<Precise> z;
    for (const double x : named) z.push_back(number<Precise>(numeric::exact(x)));
    wrap(z);
    const auto known = std::find_if(seen_.begin(), seen_.end(), [&](const End& s) { return is_same(s.z, z); });
    if (known != seen_.end()) {
      if (known->point) ++result_.points[*known->point].reached;
      return known->leads ? Outcome::known : Outcome::nothing;
    }
    const bool enough = rough.is_slope_missing && members_ >= (result_.held.empty() ? first_members : most_members);
    result_.further_members += enough && away_from.points.empty() ? 1 : 0;
    const std::size_t before = result_.points.size();
    const std::optional<std::size_t> point = enough ? std::nullopt : steady_point(z);
    seen_.push_back({rounded(z), enough || point, point});
    if (enough) return Outcome::added;
    if (!point) return Outcome::nothing;
    return result_.points.size() > before ? Outcome::added : Outcome::known;
  }

  /// The isolated points found so far, as the iteration saw them.
  KnownPoints known_points() const {
    KnownPoints result{{}, turns_};
    for (const End& s : seen_) {
      if (s.point && result_.points[*s.point].family == 0) result.points.push_back(s.z);
    }
    return result;
  }

  std::optional<SteadyState> steady(const State<Precise>& z, double farthest = far_away) const {
    const auto all_held = [this](const State<Precise>& at, Matrix<Precise>& value, Matrix<Precise>& jacobian) {
      value = Matrix<Precise>(held_->targets.size(), 1);
      jacobian = Matrix<Precise>(held_->targets.size(), at.size());
      if (held_->targets.empty()) return;
      const ValueAndJacobian<Precise> s = held_->at(at, r_.setting);
      for (std::size_t k = 0; k < held_->targets.size(); ++k) value(k, 0) = s.value[k] - held_->targets[k];
      jacobian = s.jacobian;
    };
    return find_steady_state(flow_, symmetry_, z, r_.setting, all_held, farthest);
  }

  /// The quantities held by the request.
  void evaluate_held(const State<Precise>& at, Matrix<Precise>& value, Matrix<Precise>& jacobian) const {
    value = Matrix<Precise>(r_.targets.size(), 1);
    jacobian = Matrix<Precise>(r_.targets.size(), at.size());
    if (r_.targets.empty()) return;
    const ValueAndJacobian<Precise> s = held_->at(at, r_.setting);  // requested ones first, then those for families
    for (std::size_t k = 0; k < r_.targets.size(); ++k) {
      value(k, 0) = s.value[k] - r_.targets[k];
      for (std::size_t d = 0; d < s.jacobian.cols; ++d) jacobian(k, d) = s.jacobian(k, d);
    }
  }

  /// The index of the steady motion at an end of the rough iteration, if there is one.
  std::optional<std::size_t> steady_point(const State<Precise>& rough) {
    try {
      return polish(rough);
    } catch (const std::domain_error& error) {  // the coordinates are singular there, as angles at a pole
      result_.record_failure(error.what(), rough);
      return std::nullopt;
    }
  }

  /// The same, within the ranges of the coordinates.
  std::optional<std::size_t> polish(State<Precise> rough) {
    for (const std::size_t i : ignorable_entries(symmetry_)) rough[i] = r_.start[i];
    std::optional<SteadyState> found = steady(rough);
    if (!found) return std::nullopt;
    State<Precise>& z = found->z;
    normalise(z);
    for (std::size_t i = 0; i < n_; ++i) {
      const double q = to_double(z[i]);
      if (!(q > r_.ranges[i].lower && q < r_.ranges[i].upper)) return std::nullopt;
    }
    for (std::size_t k = 0; k < result_.points.size(); ++k) {
      if (!is_same(rounded(result_.points[k].z), z)) continue;
      ++result_.points[k].reached;
      return k;
    }
    flow_.require_regular(z, r_.setting);
    result_.points.push_back({z, found->parameter_change, family_directions(z).cols});
    if (result_.points.back().family > 0) ++members_;
    return result_.points.size() - 1;
  }

  bool is_same(const State<double>& a, const State<Precise>& b) const {
    constexpr double turn = 2 * 3.14159265358979323846;
    for (std::size_t i = 0; i < flow_.entries(); ++i) {
      double distance = std::abs(a[i] - to_double(b[i]));
      if (i < n_ && turns_[i]) distance = std::min(distance, std::abs(turn - distance));
      if (distance > same_point * (1 + std::abs(a[i]))) return false;
    }
    return true;
  }

  // Coordinates with period 2 pi: the flow and the constraints are the same there.
  void find_turns() {
    turns_.assign(n_, false);
    const Precise turn = Precise(2) * cln::pi(precise_format());
    for (std::size_t i = 0; i < n_; ++i) {
      try {
        Setting<Precise> setting = r_.setting;
        const auto point = nearby_state(flow_, r_.start, setting, 900 + r_.seed);
        if (!point) return;
        State<Precise> moved = *point;
        moved[i] = moved[i] + turn;
        const Field<Precise> a = flow_.at(*point, setting), b = flow_.at(moved, setting);
        turns_[i] = equal(a.X, b.X) && equal(a.phi, b.phi) && equal(a.jacobian, b.jacobian);
      } catch (const std::domain_error&) {
        continue;
      }
    }
    for (const std::size_t i : ignorable_entries(symmetry_)) turns_[i] = false;  // they keep their start values
  }

  static bool equal(const Matrix<Precise>& A, const Matrix<Precise>& B) {
    for (std::size_t i = 0; i < A.a.size(); ++i) {
      if (magnitude(A.a[i] - B.a[i]) > tiny<Precise>(100) * (Precise(1) + magnitude(A.a[i]))) return false;
    }
    return true;
  }

  /// Angles into (-pi, pi].
  void wrap(State<Precise>& z) const {
    const Precise pi = cln::pi(precise_format()), turn = Precise(2) * pi, slack = tiny<Precise>(30);
    for (std::size_t i = 0; i < n_; ++i) {
      if (turns_[i]) z[i] = z[i] - turn * cln::ceiling1((z[i] - pi - slack) / turn);
    }
  }

  void normalise(State<Precise>& z) const {
    select_representative(z, r_.setting, tiny<Precise>(30),
                          [this](State<Precise>& at, const State<Precise>& other) { take_if_steady(at, other); });
    wrap(z);
  }

  /// Selects one of the two coordinate triples of each attitude. `take` replaces the point if the other is steady too.
  template <class T, class Take>
  void select_representative(State<T>& z, const Setting<T>& setting, const T& nothing, const Take& take) const {
    for (const auto& e : r_.euler_parameters) {
      const auto first = std::find_if(e.begin(), e.end(), [&](std::size_t i) { return magnitude(z[i]) > nothing; });
      if (first == e.end() || z[*first] > T(0)) continue;
      State<T> other = z;
      for (const std::size_t i : e) {
        other[i] = -other[i];
        other[n_ + i] = -other[n_ + i];
      }
      take(z, other);
    }
    const T pi = number<T>(cln::pi(precise_format()));
    for (std::size_t k = 0; k < r_.euler_angles.size(); ++k) {
      const auto sign = [&](const State<T>& at) {
        return regular_[k].template values<T>(flow_.lookup(at, setting))[0];
      };
      if (!(sign(z) < T(0))) continue;
      const auto& [a, b, c] = r_.euler_angles[k].places;
      for (const T& middle : {T(0), pi}) {
        State<T> other = z;
        other[a] = z[a] + pi;
        other[b] = middle - z[b];
        other[c] = z[c] + pi;
        other[n_ + b] = -z[n_ + b];
        if (!(sign(other) > T(0))) continue;
        for (const std::size_t i : ignorable_entries(symmetry_)) other[i] = number<T>(r_.start[i]);
        for (const std::size_t i : reversed_[k]) other[n_ + i] = -z[n_ + i];
        take(z, other);
        break;
      }
    }
  }

  // The other triple of the same attitude; not if a held quantity or a force distinguishes them.
  void take_if_steady(State<Precise>& z, const State<Precise>& other) const {
    const auto found = steady(other, farthest_correction);
    if (found && is_same(rounded(other), found->z)) z = other;
  }

  /// Directions along which steady motions with the held quantities continue, as columns.
  Matrix<Precise> open_directions(const State<Precise>& z) const {
    const Field<Precise> field = flow_.at(z, r_.setting);
    Matrix<Precise> J = stacked(field.phi_jacobian, rows_of(field.jacobian, symmetry_.constant));
    J.cols = z.size();
    for (const std::size_t i : ignorable_entries(symmetry_)) {
      Matrix<Precise> row(1, z.size());
      row(0, i) = Precise(1);
      J = stacked(J, row);
    }
    if (!r_.held.empty()) {
      Matrix<Precise> held = held_->at(z, r_.setting).jacobian;
      std::vector<std::size_t> own;
      for (std::size_t k = 0; k < r_.targets.size(); ++k) own.push_back(k);
      J = stacked(J, rows_of(held, own));
    }
    std::vector<std::size_t> columns;
    for (std::size_t i = 0; i + 1 < z.size(); ++i) columns.push_back(i);
    return Elimination<Precise>(columns_of(J, columns), tiny<Precise>(40), tiny<Precise>(60)).null_space();
  }

  /// The open directions along which steady motions do continue. A multiple root has open directions too, but is
  /// isolated.
  Matrix<Precise> family_directions(const State<Precise>& z) const {
    const Matrix<Precise> N = open_directions(z);
    if (N.cols == 0) return N;
    Matrix<Precise> together(N.rows, 1);  // a generic direction
    for (std::size_t i = 0; i < N.rows; ++i) {
      for (std::size_t k = 0; k < N.cols; ++k)
        together(i, 0) = together(i, 0) + number<Precise>(Precise(1 + 0.3 * random_number(77, k))) * N(i, k);
    }
    if (family_continues(z, together, 0)) return N;
    std::vector<std::size_t> kept;
    for (std::size_t k = 0; k < N.cols; ++k) {
      if (family_continues(z, N, k)) kept.push_back(k);
    }
    return columns_of(N, kept);
  }

  bool family_continues(const State<Precise>& z, const Matrix<Precise>& N, std::size_t k) const {
    Precise size(0);
    for (std::size_t i = 0; i < N.rows; ++i) size = std::max(size, magnitude(N(i, k)) / (Precise(1) + magnitude(z[i])));
    if (is_zero(size)) return false;
    State<Precise> beside = z;
    const Precise step = tiny<Precise>(3) / size;
    for (std::size_t i = 0; i < N.rows; ++i) beside[i] = beside[i] + step * N(i, k);
    // Along a family the correction is of second order in the step.
    const std::optional<SteadyState> found =
        find_steady_state(flow_, symmetry_, beside, r_.setting, held_equations_, farthest_correction);
    if (!found) return false;
    for (std::size_t i = 0; i < N.rows; ++i) {  // no falling back
      if (magnitude(found->z[i] - beside[i]) > tiny<Precise>(3) / 4 * (Precise(1) + magnitude(z[i]))) return false;
    }
    return true;
  }

  // Retained positions, then speeds, at their start values: one for each open direction at a member.
  void hold_families(const State<Precise>& member) {
    const Matrix<Precise> N = family_directions(member);
    Matrix<Precise> chosen;
    for (const std::size_t i : symmetry_.chart.independent) {
      const Matrix<Precise> more = stacked(chosen, rows_of(N, {i}));
      if (Elimination<Precise>(more, tiny<Precise>(30), tiny<Precise>(60)).rank() < more.rows) continue;
      chosen = more;
      result_.held.push_back(i);
      if (chosen.rows == N.cols) break;
    }
    std::vector<Quantity> quantities = r_.held;
    for (const std::size_t i : result_.held) {
      quantities.push_back({flow_.names()[i], flow_.entry(i)});
      held_->targets.push_back(r_.start[i]);
    }
    std::vector<Precise> targets = std::move(held_->targets);
    held_.emplace(flow_, std::move(quantities));
    held_->targets = std::move(targets);
  }

  bool before(const State<Precise>& a, const State<Precise>& b) const {
    for (std::size_t i = 0; i < flow_.entries(); ++i) {
      const double difference = to_double(a[i] - b[i]);
      if (std::abs(difference) > same_point) return difference < 0;
    }
    return false;
  }

  const SearchRequest& r_;
  const Flow& flow_;
  std::size_t n_;
  SearchResult& result_;
  const Symmetry& symmetry_;
  std::optional<HeldQuantities> held_;
  ExtraEquations held_equations_ = [this](const State<Precise>& at, Matrix<Precise>& value, Matrix<Precise>& jacobian) {
    evaluate_held(at, value, jacobian);
  };
  Setting<double> rough_;
  std::size_t members_ = 0;
  struct End {  // of the rough iteration
    State<double> z;
    bool leads;  // far away, with rates of 1e8, binary64 Newton steps may be small without a solution
    std::optional<std::size_t> point;  // in result_.points
  };
  std::vector<End> seen_;
  std::vector<bool> turns_;
  std::vector<Tape> regular_;                       // per triple of Euler angles
  std::vector<std::vector<std::size_t>> reversed_;  // speeds, where the other triple is that of a turned motion
};

}  // namespace

std::optional<double> SearchResult::new_point_probability() const {
  std::size_t visits = further_members, single = 0;
  for (const FoundPoint& point : points) {
    visits += point.reached;
    single += point.reached == 1 && point.family == 0 ? 1 : 0;
  }
  if (visits == 0) return std::nullopt;
  return static_cast<double>(single) / static_cast<double>(visits);
}

void SearchResult::record_failure(const std::string& why, State<double> at) {
  if (failed_starts++ > 0) return;
  reason = why;
  failure_point = std::move(at);
}

void SearchResult::record_failure(const std::string& why, const State<Precise>& at) {
  record_failure(why, rounded(at));
}

SearchResult find_steady_motions(const SearchRequest& request) {
  SearchResult result;
  std::optional<State<Precise>> start;
  try {
    start = project_onto_constraints(request.flow, request.start, request.setting);
  } catch (const std::domain_error&) {  // no field there; the search needs a point that has one
    Setting<Precise> setting = request.setting;
    for (std::uint64_t seed = 500; !start && seed < 510; ++seed)
      start = nearby_state(request.flow, request.start, setting, seed);
    if (!start) throw;
  }
  require_domain(start.has_value(), "the start does not satisfy the constraints");
  result.symmetry = find_symmetry(request.flow, *start, request.setting, request.seed);
  if (result.symmetry.autonomous) Search(request, result).run();
  return result;
}

}  // namespace eomgen::linear

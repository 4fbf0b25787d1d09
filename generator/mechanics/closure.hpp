// SPDX-License-Identifier: GPL-3.0-or-later
// Configurations in which all holonomic constraints hold, in 50 digits. Constraints may be redundant, as where loops of
// joints close. In: Mechanics with its constraints. Out: values of coordinates, and the rows of the constraints.
#pragma once

#include <cln/real.h>

#include <optional>
#include <vector>

#include "mechanics/lowering.hpp"

namespace eomgen::mechanics {

using Row = std::vector<cln::cl_R>;

struct Configuration {
  std::vector<cln::cl_R> parameters, q;
  cln::cl_R t = 0;
};

/// The order in which rows are considered.
enum class RowPriority { always, first, last };

/// Independent rows of a matrix, chosen one after another. Each step takes the row with the largest part outside the
/// span of the rows chosen before, relative to its length. Rows of higher priority are considered first. Ties go to the
/// first row.
struct RowSelection {
  std::vector<std::size_t> selected, rest;  // ascending
};
RowSelection select_independent(const std::vector<Row>& rows, const std::vector<RowPriority>& priorities,
                                const cln::cl_R& tolerance);

class ClosureSolver {
 public:
  ClosureSolver(Mechanics& mechanics, Lowering& lower);

  /// Whether the constraints hold and are independent at the start of the default scene, in binary64. False is
  /// inconclusive.
  bool is_regular();
  /// The configuration at the start of the default scene. Values that the scene does not give follow from the
  /// constraints.
  std::optional<Configuration> start_configuration();
  /// Another configuration nearby; with other parameter values if `other_parameters` is set.
  std::optional<Configuration> nearby_configuration(const Configuration& from, std::uint64_t seed,
                                                    bool other_parameters);
  /// The next configuration beyond `at` in the direction from `before` to `at`.
  std::optional<Configuration> extrapolated_configuration(const Configuration& before, const Configuration& at);
  /// d psi/d q of all constraints (coefficients of velocities) by all coordinates.
  std::vector<Row> jacobian_rows(const Configuration& at) const;
  /// b of all constraints: d psi/d t at fixed q, or the constant part of a velocity constraint.
  std::vector<cln::cl_R> rates(const Configuration& at) const { return values(rates_, at); }
  std::vector<cln::cl_R> values(const std::vector<Ref>& expressions, const Configuration& at) const;

  /// After a failed search: the residual of an equation that looks redundant but does not hold, and its constraint. The
  /// residual is 0 if the search failed for another reason.
  double inconsistency() const { return inconsistency_; }
  std::uint32_t inconsistent_constraint() const { return inconsistent_constraint_; }

 private:
  Configuration given(std::vector<bool>& open) const;
  bool solve_constraints(Configuration& at, const std::vector<bool>& moves);
  void set_parameters(Configuration& at, std::uint64_t seed) const;
  double uniform(std::uint64_t& state) const;

  Mechanics& m_;
  Lowering& lower_;
  std::vector<std::uint32_t> bound_;  // constraints on positions that always hold
  std::vector<Ref> psi_;              // of `bound_`, with functions of time expanded
  std::vector<Ref> gradient_;         // of these
  std::vector<Ref> all_;              // rows of all constraints
  std::vector<Ref> rates_;
  std::vector<Ref> reaction_directions_;  // directions of joint forces and moments
  double inconsistency_ = 0;
  std::uint32_t inconsistent_constraint_ = 0;
};

}  // namespace eomgen::mechanics

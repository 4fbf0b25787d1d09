// SPDX-License-Identifier: GPL-3.0-or-later
// Configurations in which all holonomic constraints hold, in 50 digits, though some of the constraints may repeat
// others there: where loops of joints close. In: Mechanics with its constraints. Out: values of coordinates, and the
// rows of the constraints.
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

/// Which rows are asked first.
enum class Turn { always, first, last };

/// Rows of a matrix that are independent, chosen one after another: the one with the largest part outside the span of
/// those before it (relative to its length), turn after turn. Ties go to the first.
struct Selection {
  std::vector<std::size_t> kept, rest;  // ascending
};
Selection select_independent(const std::vector<Row>& rows, const std::vector<Turn>& turns, const cln::cl_R& tolerance);

class Closure {
 public:
  Closure(Mechanics& mechanics, Lowering& lower);

  /// In binary64, cheaply: whether the constraints hold and are independent at the start of the default scene. False
  /// says nothing.
  bool is_regular();
  /// At the start of the default scene: what it does not give follows from the constraints.
  std::optional<Configuration> start();
  /// Another configuration, not far away; with other values of the parameters, if asked.
  std::optional<Configuration> near(const Configuration& from, std::uint64_t seed, bool other_parameters);
  /// The one behind `at`, on the way that leads there from `before`.
  std::optional<Configuration> beyond(const Configuration& before, const Configuration& at);
  /// d psi/d q of all constraints (coefficients of velocities) by all coordinates.
  std::vector<Row> rows(const Configuration& at) const;
  /// b of all constraints: d psi/d t at fixed q, or what is there at rest.
  std::vector<cln::cl_R> rates(const Configuration& at) const { return values(rates_, at); }
  std::vector<cln::cl_R> values(const std::vector<Ref>& expressions, const Configuration& at) const;

  /// Of the last search that failed: by how much an equation that looks redundant does not hold, and which; 0 if that
  /// was not why.
  double gap() const { return gap_; }
  std::uint32_t gap_at() const { return gap_at_; }

 private:
  Configuration given(std::vector<bool>& open) const;
  bool settle(Configuration& at, const std::vector<bool>& moves);
  void set_parameters(Configuration& at, std::uint64_t seed) const;
  double uniform(std::uint64_t& state) const;

  Mechanics& m_;
  Lowering& lower_;
  std::vector<std::uint32_t> bound_;  // constraints on positions that always hold
  std::vector<Ref> psi_;              // of these, functions of time written out
  std::vector<Ref> gradient_;         // of these
  std::vector<Ref> all_;              // rows of all constraints
  std::vector<Ref> rates_;
  std::vector<Ref> along_;  // directions of what joints exert
  double gap_ = 0;
  std::uint32_t gap_at_ = 0;
};

}  // namespace eomgen::mechanics

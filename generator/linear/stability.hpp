// SPDX-License-Identifier: GPL-3.0-or-later
// The stability of a steady motion: unstable by an eigenvalue, attracting by all of them, or stable in Lyapunov's
// sense. The latter holds if the energy minus multiples of momenta has a definite second variation on the constraints
// at fixed momenta (docs/theory.md, "Steady motions").
#pragma once

#include <string>

#include "linear/linearise.hpp"
#include "lists.hpp"

namespace eomgen::linear {

/// Expressions of the state that are prescribed or conserved, with their values and derivatives along a flow.
struct Quantity {
  std::string name;
  Ref expression;
};

/// Quantities with their prescribed values.
class HeldQuantities {
 public:
  HeldQuantities(const Flow& flow, std::vector<Quantity> quantities)
      : flow_(flow), quantities_(std::move(quantities)), tape_(flow.tape(expressions())) {}

  const std::vector<Quantity>& quantities() const { return quantities_; }
  std::vector<Precise> targets;

  template <class T>
  ValueAndJacobian<T> at(const State<T>& z, const Setting<T>& setting) const {
    return flow_.value_and_jacobian(tape_, z, setting);
  }

 private:
  std::vector<Ref> expressions() const { return mapped(quantities_, &Quantity::expression); }
  const Flow& flow_;
  std::vector<Quantity> quantities_;
  Tape tape_;
};

enum class Stability { stable, unstable, unknown };

/// "stable", "unstable", "unknown"
const char* name(Stability stability);
/// "stable", "unstable", "stability unknown"
std::string in_words(Stability stability);

struct StabilityVerdict {
  Stability stability = Stability::unknown;
  std::string reason;
};

class StabilityTest {
 public:
  /// `energies`: conserved quantities, any of which may decide; `momenta`: further conserved quantities.
  StabilityTest(const Flow& flow, symbolic::Dag& dag, const std::vector<Quantity>& energies,
                const std::vector<Quantity>& momenta);

  /// Judges the retained entries; ignorable coordinates may drift.
  StabilityVerdict operator()(const Linearisation& steady) const;

 private:
  struct Function {
    std::string name;
    Tape gradient;  // its derivatives are the second derivatives
  };
  struct Slopes {
    Matrix<Precise> first, second;  // 1 x N, N x N
  };
  Slopes slopes(const Function& function, const Linearisation& l) const;
  bool definite(const Linearisation& l, const std::vector<std::size_t>& columns, const Function& energy) const;

  const Flow& flow_;
  std::vector<Function> energies_, momenta_, constraints_;
};

/// The dimension of the family of steady motions, if every direction in the null space of A leads along one; otherwise
/// empty.
std::optional<std::size_t> steady_family_dimension(const Flow& flow, const Linearisation& steady,
                                                   const Matrix<Precise>& retained);

}  // namespace eomgen::linear

// SPDX-License-Identifier: GPL-3.0-or-later
// Is a steady motion stable? Unstable by an eigenvalue, attracting by all of them, or stable in Lyapunov's sense
// because the energy less multiples of momenta has a definite second variation on the constraints at fixed momenta
// (docs/theory.md, "Steady motions").
#pragma once

#include <string>

#include "linear/quantities.hpp"

namespace eomgen::linear {

enum class Stability { stable, unstable, unknown };

/// "stable", "unstable", "unknown"
const char* name(Stability stability);
/// "stable", "unstable", "stability unknown"
std::string in_words(Stability stability);

struct Verdict {
  Stability stability = Stability::unknown;
  std::string reason;
};

class StabilityTest {
 public:
  /// `energies`: conserved, any of which may decide; `momenta`: conserved beside them.
  StabilityTest(const Flow& flow, symbolic::Dag& dag, const std::vector<Quantity>& energies,
                const std::vector<Quantity>& momenta);

  /// Of what is retained: coordinates that nothing feels may drift.
  Verdict operator()(const Linearisation& steady) const;

 private:
  struct Function {
    std::string name;
    Tape gradient;  // whose slopes are the second derivatives
  };
  struct Slopes {
    Matrix<Precise> first, second;  // 1 x 2n, 2n x 2n
  };
  Slopes slopes(const Function& function, const Linearisation& l) const;
  bool definite(const Linearisation& l, const std::vector<std::size_t>& columns, const Function& energy) const;

  const Flow& flow_;
  std::vector<Function> energies_, momenta_, constraints_;
};

/// Whether every direction in which A has no slope leads along steady motions: how many there are, or nothing.
std::optional<std::size_t> family(const Flow& flow, const Linearisation& steady, const Matrix<Precise>& retained);

}  // namespace eomgen::linear

// SPDX-License-Identifier: GPL-3.0-or-later
// Functions of time as sums of terms with known antiderivatives:
//   factor t^n (a t + b)^p exp(a t + b) {1, sin(a t + b), cos(a t + b)}.
// Sums, products and integer powers of such sums are again such sums (products of sines become sines of sums).
#pragma once

#include <optional>
#include <vector>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

/// a t + b with a, b free of t; a is not 0.
struct Linear {
  Ref a, b;
  friend bool operator==(const Linear&, const Linear&) = default;
};

struct TimeTerm {
  enum class Wave { none, sin, cos };
  Ref factor;                  // free of t
  long n = 0;                  // t^n, n >= 0
  std::optional<Linear> base;  // (a t + b)^exponent
  Rational exponent = 0;
  std::optional<Linear> growth;  // exp(a t + b)
  Wave wave = Wave::none;
  Linear phase;  // of the wave
};

class TimeTerms {
 public:
  /// `time` is the variable; everything else is constant.
  TimeTerms(Dag& dag, Symbol time) : dag_(dag), time_(time) {}

  /// The terms of an expression; nothing if it is not such a sum or has too many terms.
  std::optional<std::vector<TimeTerm>> operator()(Ref expression);
  bool is_time_independent(Ref expression) const;  // of time

 private:
  using Terms = std::optional<std::vector<TimeTerm>>;
  Terms of_node(Ref r);
  Terms sum(Ref a, Ref b, bool subtract);
  Terms product(const Terms& a, const Terms& b);
  bool multiply(const TimeTerm& a, const TimeTerm& b, std::vector<TimeTerm>& result);
  bool multiply_bases(const TimeTerm& a, const TimeTerm& b, TimeTerm& result) const;
  void multiply_waves(const TimeTerm& a, const TimeTerm& b, const TimeTerm& rest, std::vector<TimeTerm>& result);
  void add_wave(TimeTerm term, TimeTerm::Wave wave, const Linear& phase, std::vector<TimeTerm>& result);
  Terms root(Ref base, const Rational& exponent);
  Terms reciprocal(Ref r);
  Terms exponential(Ref argument, Ref scale);
  Terms wave(Ref argument, TimeTerm::Wave kind);
  std::optional<Linear> linear(Ref r);  // a may be 0 here
  bool vanishes(Ref constant);
  TimeTerm constant(Ref factor) const;

  Dag& dag_;
  Symbol time_;
};

}  // namespace eomgen::symbolic

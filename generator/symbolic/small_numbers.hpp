// SPDX-License-Identifier: GPL-3.0-or-later
// Fast paths for exact numbers that are mostly 1, -1 or another small integer. CLN stores small integers in the word
// itself, where they are compared without a call.
#pragma once

#include <cln/rational.h>

#include <cstdint>

#include "symbolic/dag.hpp"

namespace eomgen::symbolic {

/// Equality. CLN stores small integers in the word and all other numbers behind a pointer, each in one way only.
inline bool same(const Rational& a, const Rational& b) {
  if (a.word == b.word) return true;
  return a.pointer_p() && b.pointer_p() && cln::equal(a, b);
}
inline bool is_one(const Rational& a) { return a.word == cln::cl_combine(cl_FN_tag, 1); }
inline bool is_minus_one(const Rational& a) { return a.word == cln::cl_combine(cl_FN_tag, -1); }
inline bool is_unit(const Rational& a) { return is_one(a) || is_minus_one(a); }
inline bool is_zero(const Rational& a) { return a.word == cln::cl_combine(cl_FN_tag, 0); }

inline Rational plus(const Rational& a, const Rational& b) {
  if (a.pointer_p() || b.pointer_p()) return a + b;
  // Value and tag are one integer. The word of the sum is the sum of the words minus one tag.
  std::int64_t sum = 0;
  const auto other = static_cast<std::int64_t>(b.word - cl_FN_tag);
  if (__builtin_add_overflow(static_cast<std::int64_t>(a.word), other, &sum)) return a + b;
  return Rational(reinterpret_cast<cln::cl_private_thing>(sum));
}
inline Rational times(const Rational& a, const Rational& b) {
  if (is_one(a)) return b;
  if (is_one(b)) return a;
  return a * b;
}
inline Rational quotient(const Rational& a, const Rational& b) { return is_one(b) ? a : a / b; }

/// A hash that is the same for equal numbers.
inline std::uint64_t hash_of(const Rational& a) { return a.pointer_p() ? cln::equal_hashcode(a) : a.word; }

}  // namespace eomgen::symbolic

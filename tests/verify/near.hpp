// SPDX-License-Identifier: GPL-3.0-or-later
// Comparison of CLN reals by relative difference.
#pragma once

#include <cln/rational.h>
#include <cln/real.h>

namespace eomgen::verify::test {

/// |a - b| <= 10^-digits max(|a|, |b|, floor).
inline bool near(const cln::cl_R& a, const cln::cl_R& b, int digits, const cln::cl_R& floor = 0) {
  const cln::cl_R scale = cln::max(cln::max(cln::abs(a), cln::abs(b)), floor);
  return cln::abs(a - b) <= scale * cln::expt(cln::cl_RA(1) / 10, digits);
}

}  // namespace eomgen::verify::test

// SPDX-License-Identifier: GPL-3.0-or-later
// What the files of Flow share.
#pragma once

#include "linear/dense.hpp"

namespace eomgen::linear {

// Rank tolerance of a scaled matrix: far above rounding, far below values in mechanical systems.
template <class T>
T singular();
template <>
inline double singular<double>() {
  return 1e-12;
}
template <>
inline Precise singular<Precise>() {
  return tiny<Precise>(60);
}

/// Most derivatives are 0.
template <class T>
void subtract(T& sum, const T& jacobian, const T& by) {
  if (!is_zero(jacobian)) sum = sum - jacobian * by;
}

}  // namespace eomgen::linear

// SPDX-License-Identifier: MIT
// Radau IIA with three stages, order 5. Source: Hairer, Wanner, Solving Ordinary Differential Equations II, sections IV.5
// and IV.8. A is the method's matrix, T brings its inverse to the block form [gamma0, (alpha, -beta; beta, alpha)].
#pragma once

#include <array>

namespace eom::implicit::radau {

inline constexpr double root6 = 2.449489742783178098197284;
inline constexpr std::array<double, 3> c{(4 - root6) / 10, (4 + root6) / 10, 1};
inline constexpr double A[3][3]{{(88 - 7 * root6) / 360, (296 - 169 * root6) / 1800, (-2 + 3 * root6) / 225},
                                {(296 + 169 * root6) / 1800, (88 + 7 * root6) / 360, (-2 - 3 * root6) / 225},
                                {(16 - root6) / 36, (16 + root6) / 36, 1.0 / 9}};

inline constexpr double gamma0 = 3.637834252744495732208418;
inline constexpr double alpha = 2.681082873627752133895791;
inline constexpr double beta = 3.050430199247410569426378;
inline constexpr double T[3][3]{{0.091232394870892942792, -0.14125529502095420843, -0.030029194105147424492},
                                {0.24171793270710701896, 0.20412935229379993199, 0.38294211275726193779},
                                {0.96604818261509293619, 1, 0}};
inline constexpr double T_inverse[3][3]{{4.3255798900631553510, 0.33919925181580986954, 0.54177053993587487119},
                                        {-4.1787185915519047273, -0.32768282076106238708, 0.47662355450055045196},
                                        {-0.50287263494578687595, 2.5719269498556054292, -0.59603920482822492497}};

/// h f(0) + slope_defect . Z: what the derivative at the start differs by from that of the collocation polynomial.
inline constexpr std::array<double, 3> slope_defect{-(13 + 7 * root6) / 3, (-13 + 7 * root6) / 3, -1.0 / 3};

/// The cubic through 0 at s = 0 and z[i] at s = c[i].
inline constexpr double collocation(double s, double z1, double z2, double z3) {
  const double d01 = z1 / c[0], d12 = (z2 - z1) / (c[1] - c[0]), d23 = (z3 - z2) / (1 - c[1]);
  const double d012 = (d12 - d01) / c[1], d123 = (d23 - d12) / (1 - c[0]);
  return s * (d01 + (s - c[0]) * (d012 + (s - c[1]) * (d123 - d012)));
}

/// The quartic that is 0 at 0 and 1, has slope 1 at 0 and slope 0 at the stages.
inline constexpr double bump(double s) { return s * (1 + s * (-4.5 + s * (6 - 2.5 * s))); }

}  // namespace eom::implicit::radau

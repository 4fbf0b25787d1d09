/* The cart and its pendulum with the classical method of Runge and Kutta: plain C with the generated function only.
 */
#include <stdio.h>

#include "cart_pendulum.h"

enum { N = cart_pendulum_states };

/* x + factor y */
static void add(const double* x, double factor, const double* y, double* result) {
  for (int i = 0; i < N; ++i) result[i] = x[i] + factor * y[i];
}

static int rk4_step(double t, double h, double* x, const double* p) {
  double k1[N], k2[N], k3[N], k4[N], y[N];
  if (cart_pendulum_rhs(t, x, p, NULL, 0, k1) != 0) return 1;
  add(x, h / 2, k1, y);
  if (cart_pendulum_rhs(t + h / 2, y, p, NULL, 0, k2) != 0) return 1;
  add(x, h / 2, k2, y);
  if (cart_pendulum_rhs(t + h / 2, y, p, NULL, 0, k3) != 0) return 1;
  add(x, h, k3, y);
  if (cart_pendulum_rhs(t + h, y, p, NULL, 0, k4) != 0) return 1;
  for (int i = 0; i < N; ++i) x[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  return 0;
}

int main(void) {
  const int steps = 10000;
  const double h = 10.0 / steps;
  double x[N], p[cart_pendulum_parameters];
  cart_pendulum_defaults(x, p);
  if (cart_pendulum_selftest() != 0) return 1;
  for (int k = 0; k < steps; ++k) {
    if (rk4_step(k * h, h, x, p) != 0) return 1;
  }
  printf("x %.12g\ntheta %.12g\nx_dot %.12g\ntheta_dot %.12g\n", x[0], x[1], x[2], x[3]);
  return 0;
}

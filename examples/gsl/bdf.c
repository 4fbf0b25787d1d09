/* The cart and its pendulum with GSL's implicit multistep method, which requires the Jacobian. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <stdio.h>

#include "cart_pendulum.h"

enum { N = cart_pendulum_states };

static int rhs(double t, const double x[], double dx[], void* p) {
  return cart_pendulum_rhs(t, x, p, NULL, 0, dx) == 0 ? GSL_SUCCESS : GSL_EBADFUNC;
}

static int jacobian(double t, const double x[], double* dfdx, double dfdt[], void* p) {
  double by_columns[N * N];
  if (cart_pendulum_jac(t, x, p, NULL, 0, by_columns, dfdt) != 0) return GSL_EBADFUNC;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) dfdx[N * i + j] = by_columns[i + N * j]; /* GSL stores by rows */
  }
  return GSL_SUCCESS;
}

int main(void) {
  double x[N], p[cart_pendulum_parameters], t = 0;
  cart_pendulum_defaults(x, p);
  gsl_odeiv2_system system = {rhs, jacobian, N, p};
  gsl_odeiv2_driver* driver = gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_msbdf, 1e-4, 1e-10, 1e-10);
  if (driver == NULL) return 1;
  const int status = gsl_odeiv2_driver_apply(driver, &t, 10, x);
  gsl_odeiv2_driver_free(driver);
  if (status != GSL_SUCCESS) {
    fprintf(stderr, "%s at t = %g\n", gsl_strerror(status), t);
    return 1;
  }
  printf("x %.12g\ntheta %.12g\nx_dot %.12g\ntheta_dot %.12g\n", x[0], x[1], x[2], x[3]);
  return 0;
}

/* SPDX-License-Identifier: MIT */
/* The adaptive drivers of the GNU Scientific Library. */
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <string.h>

#include "task.h"

static int rhs(double t, const double x[], double dx[], void* data) {
  const struct eomgen_task* task = data;
  return task->rhs(t, x, dx, task->data) == 0 ? GSL_SUCCESS : GSL_EBADFUNC;
}

/* GSL stores by rows. */
static int jacobian(double t, const double x[], double* dfdx, double dfdt[], void* data) {
  const struct eomgen_task* task = data;
  if (task->jac(t, x, dfdx, dfdt, task->data) != 0) return GSL_EBADFUNC;
  for (int i = 0; i < task->n; ++i) {
    for (int j = 0; j < i; ++j) {
      const double kept = dfdx[i * task->n + j];
      dfdx[i * task->n + j] = dfdx[j * task->n + i];
      dfdx[j * task->n + i] = kept;
    }
  }
  return GSL_SUCCESS;
}

static int run(const struct eomgen_task* task, const gsl_odeiv2_step_type* type, double* x, long* steps) {
  struct eomgen_task copy = *task;
  gsl_odeiv2_system system = {rhs, task->jac ? jacobian : NULL, (size_t)task->n, &copy};
  gsl_set_error_handler_off();
  gsl_odeiv2_driver* driver =
      gsl_odeiv2_driver_alloc_y_new(&system, type, (task->t1 - task->t0) * 1e-3, task->atol, task->rtol);
  if (!driver) return GSL_ENOMEM;
  memcpy(x, task->x0, (size_t)task->n * sizeof *x);
  double t = task->t0;
  const int status = gsl_odeiv2_driver_apply(driver, &t, task->t1, x);
  *steps = (long)driver->e->count;
  gsl_odeiv2_driver_free(driver);
  return status;
}

int eomgen_gsl_rk8pd(const struct eomgen_task* task, double* x, long* steps) {
  return run(task, gsl_odeiv2_step_rk8pd, x, steps);
}

int eomgen_gsl_msbdf(const struct eomgen_task* task, double* x, long* steps) {
  return task->jac ? run(task, gsl_odeiv2_step_msbdf, x, steps) : -1;
}

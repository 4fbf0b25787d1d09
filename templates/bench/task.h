/* SPDX-License-Identifier: MIT */
/* One integration by another library for `eomgen bench`: the emitted right-hand side, to the end time, for one
 * tolerance. */
#pragma once

struct eomgen_task {
  int n;
  double t0, t1, rtol, atol;
  const double* x0;
  int (*rhs)(double t, const double* x, double* dx, void* data);                 /* not 0: stop */
  int (*jac)(double t, const double* x, double* dfdx, double* dfdt, void* data); /* stored by columns; may be null */
  void* data;
};

/* 0: done, `x` is the state at t1; -1: an implicit method without a Jacobian; else the library's own code. */
typedef int (*eomgen_solver)(const struct eomgen_task* task, double* x, long* steps);

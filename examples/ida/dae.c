/* The double pendulum in Cartesian coordinates with IDA (SUNDIALS 6), as a differential-algebraic system: its rods stay
 * constraints. In the stabilised form of index 2 (Gear, Gupta, Leimkuhler) with the unknowns q, v, mu, lambda:
 *     q' - v - A^T mu = 0,   M v' + h - A^T lambda = 0,   A v + b = 0,   psi = 0. */
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "S5_double_pendulum_cartesian.h"

enum {
  n = S5_double_pendulum_cartesian_states / 2,
  m = S5_double_pendulum_cartesian_constraints_active,
  size = 2 * n + 2 * m
};

static int residual(realtype t, N_Vector unknowns, N_Vector rates, N_Vector result, void* p) {
  const double* const y = N_VGetArrayPointer(unknowns); /* its first 2 n entries are the state (q, v) */
  const double* const dy = N_VGetArrayPointer(rates);
  const double* const mu = y + 2 * n;
  const double* const lambda = mu + m;
  double* const r = N_VGetArrayPointer(result);
  double M[n * n], h[n], psi[m], A[m * n], b[m];
  if (S5_double_pendulum_cartesian_mass(t, y, p, M, h) != 0) return 1;
  if (S5_double_pendulum_cartesian_constraints(t, y, p, psi, A, b) != 0) return 1;
  for (int i = 0; i < n; ++i) {
    r[i] = dy[i] - y[n + i];
    r[n + i] = h[i];
    for (int j = 0; j < n; ++j) r[n + i] += M[i + n * j] * dy[n + j];
    for (int k = 0; k < m; ++k) {
      r[i] -= A[k + m * i] * mu[k];
      r[n + i] -= A[k + m * i] * lambda[k];
    }
  }
  for (int k = 0; k < m; ++k) {
    r[2 * n + k] = b[k];
    for (int i = 0; i < n; ++i) r[2 * n + k] += A[k + m * i] * y[n + i];
    r[2 * n + m + k] = psi[k];
  }
  return 0;
}

/* A consistent start: the generated functions return accelerations and multipliers. The multipliers get a coarse
 * absolute tolerance: they have no error control, but IDA scales its difference quotients by it. */
static int start(double* y, double* dy, double* is_differential, double* tolerance, double* p) {
  for (int i = 0; i < size; ++i) {
    y[i] = dy[i] = 0;
    is_differential[i] = i < 2 * n;
    tolerance[i] = i < 2 * n ? 1e-9 : 1e-4;
  }
  S5_double_pendulum_cartesian_defaults(y, p);
  if (S5_double_pendulum_cartesian_rhs(0, y, p, NULL, 0, dy) != 0) return 1;
  return S5_double_pendulum_cartesian_reactions(0, y, p, NULL, 0, y + 2 * n + m);
}

int main(void) {
  double p[S5_double_pendulum_cartesian_parameters];
  SUNContext context;
  if (SUNContext_Create(NULL, &context) != 0) return 1;
  N_Vector y = N_VNew_Serial(size, context), dy = N_VClone(y), is_differential = N_VClone(y), tolerance = N_VClone(y);
  double* const values = N_VGetArrayPointer(y);
  if (start(values, N_VGetArrayPointer(dy), N_VGetArrayPointer(is_differential), N_VGetArrayPointer(tolerance), p) !=
      0) {
    return 1;
  }

  void* ida = IDACreate(context);
  SUNMatrix J = SUNDenseMatrix(size, size, context);
  SUNLinearSolver solver = SUNLinSol_Dense(y, J, context);
  realtype t = 0;
  const int failed = IDAInit(ida, residual, 0, y, dy) != IDA_SUCCESS ||
                     IDASVtolerances(ida, 1e-9, tolerance) != IDA_SUCCESS || IDASetUserData(ida, p) != IDA_SUCCESS ||
                     IDASetMaxNumSteps(ida, 100000) != IDA_SUCCESS || IDASetId(ida, is_differential) != IDA_SUCCESS ||
                     IDASetSuppressAlg(ida, SUNTRUE) != IDA_SUCCESS ||
                     IDASetLinearSolver(ida, solver, J) != IDA_SUCCESS || IDASetStopTime(ida, 10) != IDA_SUCCESS ||
                     IDASolve(ida, 10, &t, y, dy, IDA_NORMAL) < 0;
  if (!failed) {
    const char* const names[] = {"x1", "y1", "x2", "y2"};
    for (int i = 0; i < n; ++i) printf("%s %.12g\n%s_dot %.12g\n", names[i], values[i], names[i], values[n + i]);
  }
  IDAFree(&ida);
  SUNLinSolFree(solver);
  SUNMatDestroy(J);
  N_VDestroy(y);
  N_VDestroy(dy);
  N_VDestroy(is_differential);
  N_VDestroy(tolerance);
  SUNContext_Free(&context);
  return failed;
}

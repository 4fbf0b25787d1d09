/* The cart and its pendulum with CVODE (SUNDIALS 6): BDF, dense Newton iteration with the generated Jacobian. */
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "cart_pendulum.h"

static int rhs(realtype t, N_Vector x, N_Vector dx, void* p) {
  return cart_pendulum_rhs(t, N_VGetArrayPointer(x), p, NULL, 0, N_VGetArrayPointer(dx));
}

/* Both store by columns, so that the generated function fills SUNDIALS' matrix. */
static int jacobian(realtype t, N_Vector x, N_Vector dx, SUNMatrix J, void* p, N_Vector dfdt, N_Vector b, N_Vector c) {
  (void)dx, (void)b, (void)c;
  return cart_pendulum_jac(t, N_VGetArrayPointer(x), p, NULL, 0, SUNDenseMatrix_Data(J), N_VGetArrayPointer(dfdt));
}

int main(void) {
  double p[cart_pendulum_parameters];
  SUNContext context;
  if (SUNContext_Create(NULL, &context) != 0) return 1;
  N_Vector x = N_VNew_Serial(cart_pendulum_states, context);
  double* const values = N_VGetArrayPointer(x);
  cart_pendulum_defaults(values, p);

  void* cvode = CVodeCreate(CV_BDF, context);
  SUNMatrix J = SUNDenseMatrix(cart_pendulum_states, cart_pendulum_states, context);
  SUNLinearSolver solver = SUNLinSol_Dense(x, J, context);
  realtype t = 0;
  const int failed =
      CVodeInit(cvode, rhs, 0, x) != CV_SUCCESS || CVodeSStolerances(cvode, 1e-10, 1e-10) != CV_SUCCESS ||
      CVodeSetUserData(cvode, p) != CV_SUCCESS || CVodeSetMaxNumSteps(cvode, 100000) != CV_SUCCESS ||
      CVodeSetLinearSolver(cvode, solver, J) != CV_SUCCESS || CVodeSetJacFn(cvode, jacobian) != CV_SUCCESS ||
      CVodeSetStopTime(cvode, 10) != CV_SUCCESS || CVode(cvode, 10, x, &t, CV_NORMAL) < 0;
  if (!failed) {
    printf("x %.12g\ntheta %.12g\nx_dot %.12g\ntheta_dot %.12g\n", values[0], values[1], values[2], values[3]);
  }
  CVodeFree(&cvode);
  SUNLinSolFree(solver);
  SUNMatDestroy(J);
  N_VDestroy(x);
  SUNContext_Free(&context);
  return failed;
}

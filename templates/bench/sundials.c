/* SPDX-License-Identifier: MIT */
/* SUNDIALS 6: CVODE, ARKODE and IDA, with dense linear algebra. IDA takes the same equations as xdot - f(t, x) = 0. */
#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "task.h"

enum { most_steps = 100000000 };

static int rhs(realtype t, N_Vector x, N_Vector dx, void* data) {
  const struct eomgen_task* task = data;
  return task->rhs(t, N_VGetArrayPointer(x), N_VGetArrayPointer(dx), task->data) == 0 ? 0 : -1;
}

static int jacobian(realtype t, N_Vector x, N_Vector dx, SUNMatrix J, void* data, N_Vector dfdt, N_Vector b,
                    N_Vector c) {
  const struct eomgen_task* task = data;
  (void)dx, (void)b, (void)c;
  return task->jac(t, N_VGetArrayPointer(x), SUNDenseMatrix_Data(J), N_VGetArrayPointer(dfdt), task->data) == 0 ? 0
                                                                                                                : -1;
}

static int residual(realtype t, N_Vector x, N_Vector xdot, N_Vector r, void* data) {
  if (rhs(t, x, r, data) != 0) return -1;
  N_VLinearSum(1, xdot, -1, r, r);
  return 0;
}

static int residual_jacobian(realtype t, realtype c, N_Vector x, N_Vector xdot, N_Vector r, SUNMatrix J, void* data,
                             N_Vector dfdt, N_Vector u, N_Vector v) {
  const struct eomgen_task* task = data;
  double* const a = SUNDenseMatrix_Data(J);
  (void)xdot, (void)r, (void)u, (void)v;
  if (task->jac(t, N_VGetArrayPointer(x), a, N_VGetArrayPointer(dfdt), task->data) != 0) return -1;
  for (int i = 0; i < task->n * task->n; ++i) a[i] = -a[i];
  for (int i = 0; i < task->n; ++i) a[i * (task->n + 1)] += c;
  return 0;
}

static void discard_message(int code, const char* module, const char* function, char* message, void* data) {
  (void)code, (void)module, (void)function, (void)message, (void)data;
}

/* Common data of the integrators: a context, the state, and for implicit methods a matrix and its solver. */
struct workplace {
  SUNContext context;
  N_Vector x, xdot;
  SUNMatrix J;
  SUNLinearSolver solver;
};

static int open_workplace(struct workplace* w, const struct eomgen_task* task) {
  memset(w, 0, sizeof *w);
  if (SUNContext_Create(NULL, &w->context) != 0) return 1;
  w->x = N_VNew_Serial(task->n, w->context);
  w->xdot = N_VNew_Serial(task->n, w->context);
  w->J = SUNDenseMatrix(task->n, task->n, w->context);
  w->solver = SUNLinSol_Dense(w->x, w->J, w->context);
  memcpy(N_VGetArrayPointer(w->x), task->x0, (size_t)task->n * sizeof(double));
  return 0;
}

static void close_workplace(struct workplace* w, const struct eomgen_task* task, double* x) {
  memcpy(x, N_VGetArrayPointer(w->x), (size_t)task->n * sizeof *x);
  SUNLinSolFree(w->solver);
  SUNMatDestroy(w->J);
  N_VDestroy(w->x);
  N_VDestroy(w->xdot);
  SUNContext_Free(&w->context);
}

static int cvode(const struct eomgen_task* task, int method, double* x, long* steps) {
  struct workplace w;
  if (!task->jac && method == CV_BDF) return -1;
  if (open_workplace(&w, task) != 0) return 1;
  struct eomgen_task copy = *task;
  realtype t = task->t0;
  void* memory = CVodeCreate(method, w.context);
  int status = CVodeInit(memory, rhs, task->t0, w.x);
  CVodeSetErrHandlerFn(memory, discard_message, NULL);
  CVodeSStolerances(memory, task->rtol, task->atol);
  CVodeSetUserData(memory, &copy);
  CVodeSetMaxNumSteps(memory, most_steps);
  CVodeSetLinearSolver(memory, w.solver, w.J);
  if (task->jac) CVodeSetJacFn(memory, jacobian);
  CVodeSetStopTime(memory, task->t1);
  if (status == CV_SUCCESS) status = CVode(memory, task->t1, w.x, &t, CV_NORMAL);
  CVodeGetNumSteps(memory, steps);
  CVodeFree(&memory);
  close_workplace(&w, task, x);
  return status < 0 ? status : 0;
}

int eomgen_cvode_bdf(const struct eomgen_task* task, double* x, long* steps) { return cvode(task, CV_BDF, x, steps); }
int eomgen_cvode_adams(const struct eomgen_task* task, double* x, long* steps) {
  return cvode(task, CV_ADAMS, x, steps);
}

int eomgen_arkode_erk8(const struct eomgen_task* task, double* x, long* steps) {
  struct workplace w;
  if (open_workplace(&w, task) != 0) return 1;
  struct eomgen_task copy = *task;
  realtype t = task->t0;
  void* memory = ERKStepCreate(rhs, task->t0, w.x, w.context);
  ERKStepSetErrHandlerFn(memory, discard_message, NULL);
  ERKStepSStolerances(memory, task->rtol, task->atol);
  ERKStepSetUserData(memory, &copy);
  ERKStepSetOrder(memory, 8);
  ERKStepSetMaxNumSteps(memory, most_steps);
  ERKStepSetStopTime(memory, task->t1);
  const int status = ERKStepEvolve(memory, task->t1, w.x, &t, ARK_NORMAL);
  ERKStepGetNumSteps(memory, steps);
  ERKStepFree(&memory);
  close_workplace(&w, task, x);
  return status < 0 ? status : 0;
}

int eomgen_arkode_dirk5(const struct eomgen_task* task, double* x, long* steps) {
  struct workplace w;
  if (!task->jac) return -1;
  if (open_workplace(&w, task) != 0) return 1;
  struct eomgen_task copy = *task;
  realtype t = task->t0;
  void* memory = ARKStepCreate(NULL, rhs, task->t0, w.x, w.context);
  ARKStepSetErrHandlerFn(memory, discard_message, NULL);
  ARKStepSStolerances(memory, task->rtol, task->atol);
  ARKStepSetUserData(memory, &copy);
  ARKStepSetOrder(memory, 5);
  ARKStepSetMaxNumSteps(memory, most_steps);
  ARKStepSetLinearSolver(memory, w.solver, w.J);
  ARKStepSetJacFn(memory, jacobian);
  ARKStepSetStopTime(memory, task->t1);
  const int status = ARKStepEvolve(memory, task->t1, w.x, &t, ARK_NORMAL);
  ARKStepGetNumSteps(memory, steps);
  ARKStepFree(&memory);
  close_workplace(&w, task, x);
  return status < 0 ? status : 0;
}

int eomgen_ida(const struct eomgen_task* task, double* x, long* steps) {
  struct workplace w;
  if (!task->jac) return -1;
  if (open_workplace(&w, task) != 0) return 1;
  struct eomgen_task copy = *task;
  realtype t = task->t0;
  void* memory = IDACreate(w.context);
  int status = rhs(task->t0, w.x, w.xdot, &copy);
  if (status == 0) status = IDAInit(memory, residual, task->t0, w.x, w.xdot);
  IDASetErrHandlerFn(memory, discard_message, NULL);
  IDASStolerances(memory, task->rtol, task->atol);
  IDASetUserData(memory, &copy);
  IDASetMaxNumSteps(memory, most_steps);
  IDASetLinearSolver(memory, w.solver, w.J);
  IDASetJacFn(memory, residual_jacobian);
  IDASetStopTime(memory, task->t1);
  if (status == 0) status = IDASolve(memory, task->t1, &t, w.x, w.xdot, IDA_NORMAL);
  IDAGetNumSteps(memory, steps);
  IDAFree(&memory);
  close_workplace(&w, task, x);
  return status < 0 ? status : 0;
}

/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Calls the functions of NAME_casadi.c as CasADi does: by their sparsity patterns and work vectors. MODEL is the
 * function, as in -DMODEL=pendulum_ode. Prints what is wrong; returns the number of failures. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef long long int casadi_int;
#define JOIN(a, b, c) a##b##c
#define NAMED(a, b, c) JOIN(a, b, c)
#define DECLARE(f)                                                           \
  int f(const double**, double**, casadi_int*, double*, int);                \
  casadi_int NAMED(f, _n_, in)(void);                                        \
  casadi_int NAMED(f, _n_, out)(void);                                       \
  const char* NAMED(f, _name, _in)(casadi_int);                              \
  const char* NAMED(f, _name, _out)(casadi_int);                             \
  const casadi_int* NAMED(f, _sparsity, _in)(casadi_int);                    \
  const casadi_int* NAMED(f, _sparsity, _out)(casadi_int);                   \
  int NAMED(f, _work, )(casadi_int*, casadi_int*, casadi_int*, casadi_int*); \
  void NAMED(f, _incref, )(void);                                            \
  void NAMED(f, _decref, )(void);
#define JAC NAMED(jac_, MODEL, )
#define FWD NAMED(fwd1_, MODEL, )
#define ADJ NAMED(adj1_, MODEL, )
DECLARE(MODEL)
DECLARE(SCENE)
#ifdef DERIVATIVES
DECLARE(JAC)
DECLARE(FWD)
DECLARE(ADJ)
#endif

static int failures;

static void check(int holds, const char* what) {
  if (holds) return;
  printf("wrong: %s\n", what);
  ++failures;
}

typedef int (*Function)(const double**, double**, casadi_int*, double*, int);

/* Evaluates with a work vector of exactly the stated size. */
static int call(Function f, int (*work)(casadi_int*, casadi_int*, casadi_int*, casadi_int*), const double** arg, int in,
                double** res, int out) {
  casadi_int sizes[4];
  int code, i;
  check(work(&sizes[0], &sizes[1], &sizes[2], &sizes[3]) == 0, "work");
  check(sizes[0] >= in && sizes[1] >= out, "sizes of arg and res");
  {
    const double** a = malloc((size_t)(sizes[0] + 1) * sizeof *a);
    double** r = malloc((size_t)(sizes[1] + 1) * sizeof *r);
    casadi_int* iw = malloc((size_t)(sizes[2] + 1) * sizeof *iw);
    double* w = malloc((size_t)(sizes[3] > 0 ? sizes[3] : 1) * sizeof *w);
    for (i = 0; i < in; ++i) a[i] = arg[i];
    for (i = 0; i < out; ++i) r[i] = res[i];
    code = f(a, r, iw, w, 0);
    free(a);
    free(r);
    free(iw);
    free(w);
  }
  return code;
}

static casadi_int entries(const casadi_int* pattern) { return pattern[2 + pattern[1]]; }

static void check_pattern(const casadi_int* pattern, casadi_int rows, casadi_int columns) {
  casadi_int j, k;
  check(pattern[0] == rows && pattern[1] == columns && pattern[2] == 0, "shape of a pattern");
  for (j = 0; j < columns; ++j) {
    check(pattern[2 + j] <= pattern[3 + j], "starts of columns");
    for (k = pattern[2 + j]; k < pattern[3 + j]; ++k) {
      const casadi_int row = pattern[3 + columns + k];
      check(row >= 0 && row < rows, "rows");
      check(k == pattern[2 + j] || row > pattern[2 + columns + k], "ascending rows");
    }
  }
}

int main(void) {
  enum { most = 4096 };
  static double x[most], p[most], u[most], t, dx[most], other[most];
  double* scene[] = {x, p, u};
  const double* arg[] = {&t, x, p, u};
  double* res[] = {dx};
  const char* const names[] = {"t", "x", "p", "u"};
  double* const values[] = {&t, x, p, u};
  casadi_int n, i, j;
  NAMED(MODEL, _incref, )();
  check(NAMED(SCENE, _n_, in)() == 0 && NAMED(SCENE, _n_, out)() == 3, "ports of the scene");
  check(NAMED(MODEL, _n_, in)() == 4 && NAMED(MODEL, _n_, out)() == 1, "ports");
  for (i = 0; i < 4; ++i) {
    check(strcmp(NAMED(MODEL, _name, _in)(i), names[i]) == 0, "names");
    check_pattern(NAMED(MODEL, _sparsity, _in)(i), NAMED(MODEL, _sparsity, _in)(i)[0], 1);
  }
  check(NAMED(MODEL, _name, _in)(4) == NULL && NAMED(MODEL, _sparsity, _in)(4) == NULL, "ports that are not there");
  n = NAMED(MODEL, _sparsity, _in)(1)[0];
  check_pattern(NAMED(MODEL, _sparsity, _out)(0), n, 1);
  check(call(SCENE, NAMED(SCENE, _work, ), NULL, 0, scene, 3) == 0, "scene");
  for (i = 0; i < n; ++i) x[i] += 0.1 * sin((double)(i + 1));
  t = 0.3;
  check(call(MODEL, NAMED(MODEL, _work, ), arg, 4, res, 1) == 0, "the right-hand side");
  {
    double* none[] = {NULL};
    check(call(MODEL, NAMED(MODEL, _work, ), arg, 4, none, 1) == 0, "without a result");
  }
  for (i = 0; i < n; ++i) printf("%.17g\n", dx[i]);
#ifdef DERIVATIVES
  {
    static double blocks[4][most], seeds[4][most], forward[most], row[most], reverse[4][most], by_blocks[most];
    const double* all[9] = {&t, x, p, u, NULL, seeds[0], seeds[1], seeds[2], seeds[3]};
    const double* back[6] = {&t, x, p, u, NULL, row};
    double* out[4] = {blocks[0], blocks[1], blocks[2], blocks[3]};
    double* fwd[1] = {forward};
    double* adj[4] = {reverse[0], reverse[1], reverse[2], reverse[3]};
    double left = 0, right = 0, size = 0;
    check(NAMED(JAC, _n_, in)() == 5 && NAMED(JAC, _n_, out)() == 4, "ports of the Jacobian");
    check(NAMED(FWD, _n_, in)() == 9 && NAMED(FWD, _n_, out)() == 1, "ports of the forward derivative");
    check(NAMED(ADJ, _n_, in)() == 6 && NAMED(ADJ, _n_, out)() == 4, "ports of the adjoint derivative");
    check(entries(NAMED(JAC, _sparsity, _in)(4)) == 0, "the result is not read");
    check(call(JAC, NAMED(JAC, _work, ), all, 5, out, 4) == 0, "the Jacobian");
    for (i = 0; i < 4; ++i) {
      const casadi_int columns = NAMED(MODEL, _sparsity, _in)(i)[0];
      const casadi_int* const pattern = NAMED(JAC, _sparsity, _out)(i);
      check_pattern(pattern, n, columns);
      for (j = 0; j < columns; ++j) {
        casadi_int k, r;
        const double step = 1e-6 * (1 + fabs(values[i][j])), value = values[i][j];
        double *ahead[] = {dx}, *behind[] = {other};
        seeds[i][j] = cos((double)(3 * i + j));
        values[i][j] = value + step;
        check(call(MODEL, NAMED(MODEL, _work, ), arg, 4, ahead, 1) == 0, "ahead");
        values[i][j] = value - step;
        check(call(MODEL, NAMED(MODEL, _work, ), arg, 4, behind, 1) == 0, "behind");
        values[i][j] = value;
        k = pattern[2 + j];
        for (r = 0; r < n; ++r) { /* entries outside the pattern are zero */
          const double slope = (dx[r] - other[r]) / (2 * step);
          const int is_in = k < pattern[3 + j] && pattern[3 + columns + k] == r;
          const double stated = is_in ? blocks[i][k] : 0;
          check(fabs(slope - stated) <= 1e-5 * (1 + fabs(stated)), "a derivative");
          by_blocks[r] += stated * seeds[i][j];
          k += is_in;
        }
      }
    }
    check(call(FWD, NAMED(FWD, _work, ), all, 9, fwd, 1) == 0, "the forward derivative");
    for (i = 0; i < n; ++i) {
      check(fabs(forward[i] - by_blocks[i]) <= 1e-12 * (1 + fabs(forward[i])), "an entry of the forward derivative");
      row[i] = sin((double)(5 * i + 1));
      left += row[i] * forward[i];
      size += fabs(row[i] * forward[i]);
    }
    check(call(ADJ, NAMED(ADJ, _work, ), back, 6, adj, 4) == 0, "the adjoint derivative");
    for (i = 0; i < 4; ++i)
      for (j = 0; j < NAMED(MODEL, _sparsity, _in)(i)[0]; ++j) right += reverse[i][j] * seeds[i][j];
    check(fabs(left - right) <= 1e-11 * (1 + size), "the adjoint derivative is that of the forward one");
    {
      const double* without[9] = {&t, x, p, u, NULL, NULL, seeds[1], NULL, NULL};
      check(call(FWD, NAMED(FWD, _work, ), without, 9, fwd, 1) == 0, "without seeds");
    }
  }
#endif
  NAMED(MODEL, _decref, )();
  return failures;
}

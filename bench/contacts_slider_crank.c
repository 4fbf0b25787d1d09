/* models/slider_crank.toml for Siconos, by hand: compiled by contacts_beside.py. Matrices are stored by columns. */
#include <math.h>

static const double m1 = 0.038, m2 = 0.038, m3 = 0.076, J1 = 7.4e-5, J2 = 5.9e-4, J3 = 2.7e-6;
static const double l1 = 0.153, l2 = 0.306, a = 0.05, b = 0.025, c = 0.001, g = 9.81;

static void clear(double* matrix) {
  for (int i = 0; i < 9; ++i) matrix[i] = 0;
}

static double coupling(void) { return l1 * l2 * (m2 / 2 + m3); }
static double weight1(void) { return g * l1 * (m1 / 2 + m2 + m3); }
static double weight2(void) { return g * l2 * (m2 / 2 + m3); }

void mass(unsigned n, const double* q, double* M, unsigned nz, double* z) {
  clear(M);
  M[0] = J1 + l1 * l1 * (m1 / 4 + m2 + m3);
  M[4] = J2 + l2 * l2 * (m2 / 4 + m3);
  M[8] = J3;
  M[1] = M[3] = coupling() * cos(q[0] - q[1]);
}

/* On the side of the accelerations: M q'' + f = 0 without contacts. */
void forces(unsigned n, const double* q, const double* v, double* f, unsigned nz, double* z) {
  double twist = coupling() * sin(q[0] - q[1]);
  f[0] = twist * v[1] * v[1] + weight1() * cos(q[0]);
  f[1] = -twist * v[0] * v[0] + weight2() * cos(q[1]);
  f[2] = 0;
}

void forces_q(unsigned n, const double* q, const double* v, double* J, unsigned nz, double* z) {
  double both = coupling() * cos(q[0] - q[1]);
  clear(J);
  J[0] = both * v[1] * v[1] - weight1() * sin(q[0]);
  J[1] = -both * v[0] * v[0];
  J[3] = -both * v[1] * v[1];
  J[4] = both * v[0] * v[0] - weight2() * sin(q[1]);
}

void forces_v(unsigned n, const double* q, const double* v, double* J, unsigned nz, double* z) {
  double twist = coupling() * sin(q[0] - q[1]);
  clear(J);
  J[1] = -2 * twist * v[0];
  J[3] = 2 * twist * v[1];
}

/* Corners: side is 1 above and -1 below, end is -1 at the rear and 1 in front. */
static void gap(const double* q, double* y, int side, int end) {
  y[0] = b + c - side * (l1 * sin(q[0]) + l2 * sin(q[1]) + end * a * sin(q[2]) + side * b * cos(q[2]));
  y[1] = 0;
}

static void rows(const double* q, double* G, int side, int end) {
  double rx = end * a * cos(q[2]) - side * b * sin(q[2]), ry = end * a * sin(q[2]) + side * b * cos(q[2]);
  G[0] = -side * l1 * cos(q[0]);
  G[2] = -side * l2 * cos(q[1]);
  G[4] = -side * rx;
  G[1] = -l1 * sin(q[0]);
  G[3] = -l2 * sin(q[1]);
  G[5] = -ry;
}

#define CORNER(name, side, end)                                                                  \
  void gap_##name(unsigned n, const double* q, unsigned m, double* y, unsigned nz, double* z) {  \
    gap(q, y, side, end);                                                                        \
  }                                                                                              \
  void rows_##name(unsigned n, const double* q, unsigned m, double* G, unsigned nz, double* z) { \
    rows(q, G, side, end);                                                                       \
  }

CORNER(top_rear, 1, -1)
CORNER(top_front, 1, 1)
CORNER(bottom_rear, -1, -1)
CORNER(bottom_front, -1, 1)

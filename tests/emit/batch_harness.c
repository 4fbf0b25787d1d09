/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Compiled with the header and the sources from target batch and with -DNAME=.., in single precision with -DREAL=float.
 * Checks that every state of a batch has the same bits and the same code as alone. Returns the line of the first
 * failure. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include HEADER

#ifndef REAL
#define REAL double
#endif
#define LARGE ((REAL)(sizeof(REAL) == 4 ? 1e30 : 1e200)) /* also finite in single precision */

#define JOIN2(a, b) a##b
#define JOIN(a, b) JOIN2(a, b)
#define OF(what) JOIN(NAME, what)

enum {
  count = 29, /* not a multiple of any width */
  stride = count + 3,
  states = OF(_states),
  parameters = OF(_parameters) > 0 ? OF(_parameters) : 1,
  inputs = OF(_inputs) > 0 ? OF(_inputs) : 1,
  prepared = OF(_prepared_size) > 0 ? OF(_prepared_size) : 1,
  mode_size = OF(_mode_size) > 0 ? OF(_mode_size) : 1,
  all = OF(_own_time) | OF(_own_parameters) | OF(_own_inputs) | OF(_own_modes) | OF(_own_prepared) | OF(_own_orders)
};

static unsigned long long seed = 1;
static REAL within_one(void) /* -1 to 1 */
{
  seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
  return (REAL)((double)(seed >> 11) * 0x1p-52 - 1.0);
}

static REAL t[stride], x[states * stride], p[parameters * stride], u[inputs * stride], w[prepared * stride],
    own_x[states], own_p[parameters], own_u[inputs], own_w[prepared];
static int mode[mode_size * stride], own_mode[mode_size], codes[stride];
#ifdef TAYLOR
static int order[stride];
#endif

static void entries_of(const REAL* from, int entries, int s, int own, REAL* to) {
  for (int i = 0; i < entries; ++i) to[i] = own ? from[i * stride + s] : from[i];
}

/* Whether the results of state s in the batch have the same bits as alone. */
static int same(const REAL* batch, const REAL* alone, int entries, int s) {
  for (int i = 0; i < entries; ++i) {
    if (memcmp(&batch[i * stride + s], &alone[i], sizeof(REAL)) == 0) continue;
    if (isnan(batch[i * stride + s]) && isnan(alone[i])) continue; /* the sign of a NaN is unspecified */
    printf("state %d, entry %d: %.17g in the batch, %.17g alone\n", s, i, (double)batch[i * stride + s],
           (double)alone[i]);
    return 0;
  }
  return 1;
}

static void take(int s, int own) {
  entries_of(x, states, s, 1, own_x);
  entries_of(p, parameters, s, own & OF(_own_parameters), own_p);
  entries_of(u, inputs, s, own & OF(_own_inputs), own_u);
  entries_of(w, prepared, s, own & OF(_own_prepared), own_w);
  for (int i = 0; i < mode_size; ++i) own_mode[i] = (own & OF(_own_modes)) ? mode[i * stride + s] : mode[i];
}

#define CHECK_FUNCTION(entries, batch_call, alone_call)                                       \
  do {                                                                                        \
    static REAL batch[(entries)*stride + 1], before[(entries) + 1];                           \
    int first = 0;                                                                            \
    for (int i = 0; i < (entries)*stride; ++i) batch[i] = (REAL)7.25;                         \
    const int code = (batch_call);                                                            \
    for (int s = 0; s < count; ++s) {                                                         \
      take(s, own);                                                                           \
      for (int i = 0; i < (entries); ++i) before[i] = (REAL)7.25;                             \
      const int alone = (alone_call);                                                         \
      if (first == 0) first = alone;                                                          \
      if (codes[s] != alone || !same(batch, before, (entries), s)) return __LINE__;           \
    }                                                                                         \
    if (code != first) return __LINE__;                                                       \
    for (int i = 0; i < (entries); ++i) {                                                     \
      for (int s = count; s < stride; ++s) {                                                  \
        if (batch[i * stride + s] != (REAL)7.25) return __LINE__; /* beyond the last state */ \
      }                                                                                       \
    }                                                                                         \
  } while (0)

static int compare(int own, int with_inputs) {
  const REAL* const inputs_of = with_inputs ? u : NULL;
  const REAL* const inputs_alone = with_inputs ? own_u : NULL;
#define T (t[(own & OF(_own_time)) ? s : 0])
#define MODE own_mode
  CHECK_FUNCTION(states, OF(_rhs_batch)(count, stride, t, x, p, inputs_of, mode, own, batch, codes),
                 OF(_rhs)(T, own_x, own_p, inputs_alone, MODE, before));
#ifdef PREPARED
  CHECK_FUNCTION(prepared, OF(_prepare_batch)(count, stride, p, own, batch, codes), OF(_prepare)(own_p, before));
  CHECK_FUNCTION(states, OF(_rhs_prepared_batch)(count, stride, t, x, p, w, inputs_of, mode, own, batch, codes),
                 OF(_rhs_prepared)(T, own_x, own_p, own_w, inputs_alone, MODE, before));
#endif
#ifdef JAC
  CHECK_FUNCTION(states * states, OF(_jac_batch)(count, stride, t, x, p, inputs_of, mode, own, batch, NULL, codes),
                 OF(_jac)(T, own_x, own_p, inputs_alone, MODE, before, NULL));
#endif
#ifdef OUTPUTS
  CHECK_FUNCTION(OF(_output_count), OF(_outputs_batch)(count, stride, t, x, p, inputs_of, mode, own, batch, codes),
                 OF(_outputs)(T, own_x, own_p, inputs_alone, MODE, before));
#endif
#ifdef EVENTS
  CHECK_FUNCTION(OF(_event_count), OF(_events_batch)(count, stride, t, x, p, inputs_of, mode, own, batch, codes),
                 OF(_events)(T, own_x, own_p, inputs_alone, MODE, before));
#endif
#ifdef TAYLOR
  {
    static double series[states * (OF(_taylor_order) + 1) * stride], one[states * (OF(_taylor_order) + 1)];
    int highest = 0, first = 0;
    for (int s = 0; s < count; ++s) {
      const int asked = order[(own & OF(_own_orders)) ? s : 0];
      if (asked > highest && asked <= OF(_taylor_order)) highest = asked;
    }
    for (int i = 0; i < states * (OF(_taylor_order) + 1) * stride; ++i) series[i] = 7.25;
    const int code = OF(_taylor_batch)(count, stride, t, x, p, inputs_of, mode, order, own, series, codes);
    for (int s = 0; s < count; ++s) {
      const int asked = order[(own & OF(_own_orders)) ? s : 0];
      take(s, own);
      const int alone = OF(_taylor)(T, own_x, own_p, inputs_alone, MODE, asked, one);
      if (first == 0) first = alone;
      if (codes[s] != alone) return __LINE__;
      if (alone == 0 && !same(series, one, states * (asked + 1), s)) return __LINE__;
    }
    if (code != first) return __LINE__;
    for (int i = 0; i < states * (OF(_taylor_order) + 1); ++i) {
      for (int s = i < states * (highest + 1) ? count : 0; s < stride; ++s) {
        if (series[i * stride + s] != 7.25) return __LINE__; /* beyond the last state, or the highest order */
      }
    }
  }
#endif
  return 0;
}

int main(void) {
  static REAL kept[states * stride];
  REAL x0[states], p0[parameters];
  static const int modes[][mode_size] = {{0}, MODES};
  const int mode_count = (int)(sizeof modes / sizeof modes[0]);
  if (OF(_batch_width)() != WIDTH) return 1;
  OF(_defaults)(x0, p0);
  for (int s = 0; s < count; ++s) {
    t[s] = within_one() / 2 + 1;
    for (int i = 0; i < mode_size; ++i) mode[i * stride + s] = modes[(s * 7 + 1) % mode_count][i];
#ifdef TAYLOR
    order[s] = s == 11 ? -1 : s == 20 ? OF(_taylor_order) + 1 : (s * 5 + 3) % (OF(_taylor_order) - 1);
#endif
    for (int i = 0; i < states; ++i) x[i * stride + s] = x0[i] * (1 + within_one() / 8) + within_one() / 2;
    for (int i = 0; i < OF(_parameters); ++i) p[i * stride + s] = p0[i] * (1 + within_one() / 16);
    for (int i = 0; i < OF(_inputs); ++i) u[i * stride + s] = within_one();
  }
  for (int i = 0; i < OF(_prepared_size); ++i) {
    for (int s = 0; s < stride; ++s) w[i * stride + s] = 1 + within_one() / 4;
  }
  for (int own = 0; own <= all; own += own == 0 ? 5 : all - own > 0 ? all - own : 1) {
    const int line = compare(own, own != 5);
    if (line != 0) return line;
  }
  /* Lanes that must not affect others: large and infinite angles, NaN, singular masses. */
  for (int i = 0; i < states; ++i) {
    x[i * stride + 3] = (REAL)(1000000 + i);
    x[i * stride + 4] = (REAL)NAN;
    x[i * stride + 12] = LARGE;
    x[i * stride + 28] = (REAL)INFINITY;
  }
  for (int i = 0; i < parameters; ++i) p[i * stride + 17] = 0;
  for (int i = 0; i < OF(_prepared_size); ++i) w[i * stride + 17] = 0;
  const int line = compare(all, 1);
  if (line != 0) return line;
  /* dx may be x. */
  memcpy(kept, x, sizeof kept);
  OF(_rhs_batch)(count, stride, t, x, p, NULL, mode, all, x, NULL);
  for (int s = 0; s < count; ++s) {
    REAL dx[states];
    entries_of(kept, states, s, 1, own_x);
    entries_of(p, parameters, s, 1, own_p);
    memcpy(dx, own_x, sizeof dx);
    for (int i = 0; i < mode_size; ++i) own_mode[i] = mode[i * stride + s];
    OF(_rhs)(t[s], own_x, own_p, NULL, own_mode, dx);
    if (!same(x, dx, states, s)) return 2;
  }
  return 0;
}

# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives of the right-hand side of serial arms: the table of docs/benchmarks.md, "Derivatives".

    bench/derivatives.py EOMGEN [--write] [N ...]

Each row is the arm of bench/growth_models.py with N joints: operations of the right-hand side and of its Jacobian, the median time of one call of the right-hand side, of M and h and of the Jacobian (gcc -O3
-march=native), how many right-hand sides the Jacobian costs, processor seconds of the whole `emit` and of the compiler at -O2. With --write the table in docs/benchmarks.md is replaced.
"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile

import growth_models
from growth import main, measured

BEGIN, END = "<!-- derivatives: written by bench/derivatives.py -->", "<!-- end of derivatives -->"
SIZES = (7, 20, 50)
DRIVER = r"""
#define _POSIX_C_SOURCE 199309L
#include "NAME.h"
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { n = SIZE, N = 2 * n, repeats = 31 };
static double x[N], p[1000], dx[N], M[n * n], h[n], dfdx[N * N], dfdt[N];

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}
static int rising(const void* a, const void* b) {
  const double x = *(const double*)a, y = *(const double*)b;
  return (x > y) - (x < y);
}
static int rhs(void) { return NAME_rhs(0, x, p, NULL, NULL, dx); }
static int mass(void) { return NAME_mass(0, x, p, M, h); }
static int jac(void) { return NAME_jac(0, x, p, NULL, NULL, dfdx, dfdt); }

/* The median of the mean times of `calls` calls, each from a state of its own, in ns. */
static double median(int (*function)(void), int calls) {
  double times[repeats];
  for (int r = 0; r < repeats; ++r) {
    const double begin = now();
    for (int k = 0; k < calls; ++k) {
      x[k % N] += 1e-9;
      if (function() != 0) exit(1);
    }
    times[r] = (now() - begin) / calls;
  }
  qsort(times, repeats, sizeof times[0], rising);
  return times[repeats / 2];
}

int main(void) {
  NAME_defaults(x, p);
  for (int i = 0; i < n; ++i) x[n + i] = 0.1 * (i + 1);
  printf("[%.0f, %.0f, %.0f]", median(rhs, CALLS), median(mass, CALLS), median(jac, CALLS));
  return 0;
}
"""


def flops(source, function):
    return int(re.search(rf" \* {function} +(\d+) flops", source).group(1))


def row(eomgen, compiler, n, folder):
    name = f"arm_{n}"
    model = folder / f"{name}.toml"
    model.write_text(growth_models.arm(n))
    emitting, _, code, text = measured([eomgen, "emit", model, "-o", folder, "--target", "c", "--with", "jac,mass", "--json"])
    if code != 0:
        return f"| {n} | {'too long' if code is None else f'exit code {code}'} | | | | | | | |"
    if not json.loads(text)["certificate"].startswith("pass"):
        return f"| {n} | the derivations disagree | | | | | | | |"
    source = (folder / f"{name}.c").read_text()
    compiling, _, _, _ = measured([compiler, "-O2", "-c", "-o", folder / "model.o", folder / f"{name}.c"])
    driver = folder / "driver.c"
    driver.write_text(DRIVER.replace("NAME", name).replace("SIZE", str(n)).replace("CALLS", str(max(50, 100_000 // n**2))))
    subprocess.run([compiler, "-O3", "-march=native", "-I", folder, "-o", folder / "driver", driver, folder / f"{name}.c", "-lm"], check=True)
    rhs, mass, jac = json.loads(subprocess.run([folder / "driver"], check=True, capture_output=True, text=True).stdout)
    return f"| {n} | {flops(source, 'rhs')} | {flops(source, 'jac')} | {rhs} | {mass} | {jac} | {jac / rhs:.1f} | {emitting:.1f} | {compiling:.1f} |"


def table(eomgen, sizes):
    yield "| n | flops of rhs | of jac | rhs, ns | M and h, ns | jac, ns | jac/rhs | emit, s | compile, s |"
    yield "|---|---|---|---|---|---|---|---|---|"
    compiler = shutil.which(os.environ.get("CC", "gcc"))
    with tempfile.TemporaryDirectory() as folder:
        for n in [int(size) for size in sizes] or SIZES:
            yield row(eomgen, compiler, n, pathlib.Path(folder))


if __name__ == "__main__":
    main("bench/derivatives.py EOMGEN [--write] [N ...]", BEGIN, END, table)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives of the right-hand side and inverse dynamics: the table of docs/benchmarks.md, "Derivatives".

    bench/derivatives.py EOMGEN [--write] [--robots FOLDER] [MODEL ...]

Each row is a model FAMILY:N of bench/growth_models.py, or a robot of FOLDER (NAME.urdf, on a floating base): operations
of the right-hand side and of its derivatives, the median time of one call of each (gcc -O3 -march=native), and processor
seconds of the compiler at -O2 for all of them. `adjoint` is v^T df/dx, v^T df/dp and v^T df/du. `Pinocchio/jac` is the
time of computeABADerivatives in times of `jac`, from times measured side by side elsewhere. With --write the table in
docs/benchmarks.md is replaced.
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
MODELS = ("arm:7", "arm:20", "arm:50", "chain:20", "beam:40", "n_four_bar:40")
FLOATING = ("talos", "solo12")
FUNCTIONS = ("jac", "jac_p", "jvp", "vjp", "adjoint", "inverse")
LEFT_OUT = {"arm:50": ("jac_p",)}  # 301 parameters: about a million operations
# Pinocchio 3.7, computeABADerivatives, over the time of `rhs` on the same machine (-O3 -march=native).
PINOCCHIO = {"arm:7": 3307 / 128, "arm:20": 10770 / 704}
DRIVER = r"""
#define _POSIX_C_SOURCE 199309L
#include "NAME.h"
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { N = STATES, P = PARAMETERS, repeats = 31 };
static double x[N], p[P + 1], dx[N], v[N], a[N * (N + P)], b[N + P], c[N];

static double now(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}
static int rising(const void* left, const void* right) {
  const double one = *(const double*)left, other = *(const double*)right;
  return (one > other) - (one < other);
}
static int rhs(void) { return NAME_rhs(0, x, p, NULL, NULL, dx); }
static int mass(void) { return NAME_mass(0, x, p, a, b); }
static int jac(void) { return NAME_jac(0, x, p, NULL, NULL, a, b); }
static int jac_p(void) { return NAME_jac_p(0, x, p, NULL, NULL, a); }
static int jvp(void) { return NAME_jvp(0, x, p, NULL, NULL, v, a); }
static int vjp(void) { return NAME_vjp(0, x, p, NULL, NULL, v, a); }
static int adjoint(void) { return NAME_adjoint(0, x, p, NULL, NULL, v, a, b, c); }
static int inverse(void) { return NAME_inverse(0, x, p, NULL, NULL, v, a); }

/* The median of the mean times of `calls` calls, each from a state of its own, in ns. */
static double median(int (*function)(void), int calls) {
  double times[repeats];
  for (int r = 0; r < repeats; ++r) {
    const double begin = now();
    for (int k = 0; k < calls; ++k) {
      v[k % N] += 1e-9;
      if (function() != 0) exit(1);
    }
    times[r] = (now() - begin) / calls;
  }
  qsort(times, repeats, sizeof times[0], rising);
  return times[repeats / 2];
}

int main(void) {
  int (*const all[])(void) = {rhs, mass, jac, jac_p, jvp, vjp, adjoint, inverse};
  NAME_defaults(x, p);
  for (int i = N / 2; i < N; ++i) x[i] += SPREAD * (i - N / 2 + 1);
  for (int i = 0; i < N; ++i) v[i] = 1 - 0.01 * i;
  for (int k = 0; k < 8; ++k) printf("%s%.0f", k == 0 ? "[" : ", ", median(all[k], CALLS));
  printf("]");
  return 0;
}
"""
COLUMNS = ("model", "N", "P", "flops: rhs", *FUNCTIONS, "ns: rhs", "M and h", *FUNCTIONS, "jac/rhs", "adjoint/rhs", "Pinocchio/jac", "compile, s")


def flops(source, function):
    found = re.search(rf" \* {function} +(\d+) flops", source)
    return int(found.group(1)) if found else 0


def model_text(eomgen, what, robots):
    """The text of a model, and the rates that are added to its start (0: those of its scene, which satisfy constraints)."""
    if ":" in what:
        family, n = what.split(":")
        return growth_models.FAMILIES[family](int(n)), 0.0 if family == "n_four_bar" else 0.1
    path = next(iter(sorted(pathlib.Path(robots).rglob(f"*{what}*.urdf"))))
    return subprocess.run([eomgen, "import", path, "--floating"], check=True, capture_output=True, text=True).stdout, 0.0


def row(eomgen, compiler, what, robots, folder):
    name = re.sub("[^a-z0-9]", "_", what)
    text, spread = model_text(eomgen, what, robots)
    (folder / f"{name}.toml").write_text(text)
    left_out = LEFT_OUT.get(what, ())
    functions = ",".join(("mass", *(f for f in FUNCTIONS if f not in left_out)))
    _, _, code, text = measured([eomgen, "emit", folder / f"{name}.toml", "-o", folder, "--target", "c", "--with", functions, "--json"])
    if code != 0:
        return [what, "too long" if code is None else f"exit code {code}"]
    if not json.loads(text)["certificate"].startswith("pass"):
        return [what, "the derivations disagree"]
    source = (folder / f"{name}.c").read_text()
    compiling, _, _, _ = measured([compiler, "-O2", "-c", "-o", folder / "model.o", folder / f"{name}.c"])
    header = (folder / f"{name}.h").read_text()
    states, parameters = (int(re.search(rf"{name}_{size} = (\d+)", header).group(1)) for size in ("states", "parameters"))
    values = {"NAME": name, "STATES": states, "PARAMETERS": parameters, "SPREAD": spread, "CALLS": max(20, 200_000 // states**2)}
    driver = DRIVER
    for function in left_out:
        driver = re.sub(rf"return NAME_{function}\(.*\);", "return 0;", driver)
    for key, value in values.items():
        driver = driver.replace(key, str(value))
    (folder / "driver.c").write_text(driver)
    subprocess.run([compiler, "-O3", "-march=native", "-I", folder, "-o", folder / "driver", folder / "driver.c", folder / f"{name}.c", "-lm"], check=True)
    times = json.loads(subprocess.run([folder / "driver"], check=True, capture_output=True, text=True).stdout)
    named = zip(("rhs", "mass", *FUNCTIONS), times)
    ratio = f"{PINOCCHIO[what] * times[0] / times[2]:.1f}" if what in PINOCCHIO else ""
    return [what, states, parameters, *("" if f in left_out else flops(source, f) for f in ("rhs", *FUNCTIONS)),
            *("" if f in left_out else time for f, time in named), f"{times[2] / times[0]:.1f}", f"{times[6] / times[0]:.1f}", ratio,
            f"{compiling:.1f}"]


def table(eomgen, arguments):
    robots = None
    if "--robots" in arguments:
        at = arguments.index("--robots")
        robots = arguments[at + 1]
        arguments = arguments[:at] + arguments[at + 2:]
    yield f"| {' | '.join(COLUMNS)} |"
    yield "|---" * len(COLUMNS) + "|"
    compiler = shutil.which(os.environ.get("CC", "gcc"))
    with tempfile.TemporaryDirectory() as folder:
        for what in arguments or (*MODELS, *(FLOATING if robots else ())):
            cells = row(eomgen, compiler, what, robots, pathlib.Path(folder))
            yield f"| {' | '.join(str(cell) for cell in cells)}{' |' * (len(COLUMNS) - len(cells))} |"


if __name__ == "__main__":
    main("bench/derivatives.py EOMGEN [--write] [--robots FOLDER] [MODEL ...]", BEGIN, END, table)

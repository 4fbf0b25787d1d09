# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives of the right-hand side and inverse dynamics: the tables of docs/benchmarks.md, "Derivatives".

    bench/derivatives.py EOMGEN [--write] [--robots FOLDER] [--beside] [MODEL ...]

Each row is a model FAMILY:N of bench/growth_models.py, or a robot of FOLDER (NAME.urdf, on a floating base, without
friction): operations of the right-hand side and of its derivatives, the median processor time of one call of each (gcc -O3
-march=native), and processor seconds of the compiler at -O2 for all of them. `adjoint` is v^T df/dx, v^T df/dp and
v^T df/du.

With --beside another table has arms and robots in Pinocchio (bench/engines/pinocchio_derivatives.cpp), where it is
installed or PINOCCHIO_CXXFLAGS has its include paths: programs take turns, and each time is the median of ROUNDS. The
program ends if accelerations or derivatives differ by more than 1e-12. Without Pinocchio the table has the times that
follow from ratios measured elsewhere. With --write the table in docs/benchmarks.md is replaced.
"""
import json
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import tomllib
import xml.etree.ElementTree as ET

import growth_models
import robots_beside
from growth import main, measured

BEGIN, END = "<!-- derivatives: written by bench/derivatives.py -->", "<!-- end of derivatives -->"
BEGIN_BESIDE, END_BESIDE = "<!-- derivatives beside: written by bench/derivatives.py -->", "<!-- end of derivatives beside -->"
MODELS = ("arm:7", "arm:20", "arm:50", "chain:20", "beam:40", "n_four_bar:40")
FLOATING = ("talos", "solo12")
ARMS = ("arm:7", "arm:20", "arm:50")
FUNCTIONS = ("jac", "jac_p", "jvp", "vjp", "adjoint", "inverse")
BESIDE_FUNCTIONS = ("jac", "inverse")
LEFT_OUT = {"arm:50": ("jac_p",)}  # 301 parameters: about a million operations
PINOCCHIO = robots_beside.Engine("Pinocchio", "pinocchio_derivatives.cpp", "pinocchio/config.hpp", "pinocchio", [], "links",
                                 robots_beside.HEADER_ONLY)
ROUNDS = 5
# Pinocchio 3.7, computeABADerivatives, over the time of `rhs` on another machine (-O3 -march=native).
ELSEWHERE = {"arm:7": 3307 / 128, "arm:20": 10770 / 704}
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
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
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
  for (int i = 0; i < N / 2; ++i) x[i] += SHIFT * (i % 7 + 1);
  for (int i = N / 2; i < N; ++i) x[i] += SPREAD * (i - N / 2 + 1);
  for (int i = 0; i < N; ++i) v[i] = 1 - 0.01 * i;
  if (rhs() != 0 || jac() != 0) return 1;
  printf("{\"x\": [");
  for (int i = 0; i < N; ++i) printf("%s%.17g", i == 0 ? "" : ", ", x[i]);
  printf("], \"dx\": [");
  for (int i = 0; i < N; ++i) printf("%s%.17g", i == 0 ? "" : ", ", dx[i]);
  printf("], \"jac\": [");
  for (int i = 0; i < N * N; ++i) printf("%s%.17g", i == 0 ? "" : ", ", a[i]);
  printf("], \"ns\": [");
  for (int k = 0; k < 8; ++k) printf("%s%.0f", k == 0 ? "" : ", ", median(all[k], CALLS));
  printf("]}");
  return 0;
}
"""
COLUMNS = ("model", "N", "P", "flops: rhs", *FUNCTIONS, "ns: rhs", "M and h", *FUNCTIONS, "jac/rhs", "adjoint/rhs", "compile, s")
BESIDE_COLUMNS = ("model", "ns: rhs", "ABA", "ratio", "M and h", "CRBA and h", "ratio", "inverse", "RNEA", "ratio", "jac", "ABA derivatives", "ratio",
          "differs")


def flops(source, function):
    found = re.search(rf" \* {function} +(\d+) flops", source)
    return int(found.group(1)) if found else 0


def arm_links(text):
    """The links of growth_models.arm, in numbers."""
    values = {name: float(value.split()[0]) for name, value in tomllib.loads(text)["parameters"].items()}
    identity = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    links = []
    while f"m{len(links) + 1}" in values:
        k = len(links) + 1
        m, c, A, B, C = (values[f"{letter}{k}"] for letter in "mcABC")
        links.append(robots_beside.Link(f"q{k}", "revolute", k - 2, [values[f"L{k - 1}"] if k > 1 else 0, 0, 0], identity,
                                        [0, 0, 1] if k % 2 else [0, 1, 0], m, [c, 0, 0], [[A, 0, 0], [0, B, 0], [0, 0, C]], 0))
    return links


def frictionless(path, folder):
    """The file with joints that are free and without damping and friction."""
    tree = ET.parse(path)
    for joint in tree.getroot().iter("joint"):
        for child in [*joint.findall("mimic"), *joint.findall("dynamics")]:
            joint.remove(child)
    tree.write(folder / path.name)
    return folder / path.name


def model_of(eomgen, what, robots, folder):
    """The text of a model, shift and spread of positions and rates (0: the start satisfies constraints), links of Pinocchio."""
    if ":" in what:
        family, n = what.split(":")
        text = growth_models.FAMILIES[family](int(n))
        return text, 0.0, 0.0 if family == "n_four_bar" else 0.1, arm_links(text) if family == "arm" else []
    path = frictionless(next(iter(sorted(pathlib.Path(robots).rglob(f"*{what}*.urdf")))), folder)
    text = subprocess.run([eomgen, "import", path, "--floating", "-o", "-"], check=True, capture_output=True, text=True).stdout
    return text, 0.1, 0.05, robots_beside.links_of(path, floating=True)


class Emitted:
    """A model in C with the wanted functions, and a program that measures them."""

    def __init__(self, eomgen, compiler, what, robots, folder, wanted):
        self.what, self.folder, self.wanted, self.failure = what, folder, wanted, ""
        self.name = name = re.sub("[^a-z0-9]", "_", what)
        text, shift, spread, self.links = model_of(eomgen, what, robots, folder)
        (folder / f"{name}.toml").write_text(text)
        functions = ",".join(("mass", *wanted))
        _, _, code, text = measured([eomgen, "emit", folder / f"{name}.toml", "-o", folder, "--target", "c", "--with", functions, "--json"])
        if code != 0:
            self.failure = "too long" if code is None else f"exit code {code}"
            return
        if not json.loads(text)["certificate"].startswith("pass"):
            self.failure = "the derivations disagree"
            return
        self.source = (folder / f"{name}.c").read_text()
        header = (folder / f"{name}.h").read_text()
        self.states, self.parameters = (int(re.search(rf"{name}_{size} = (\d+)", header).group(1)) for size in ("states", "parameters"))
        self.calls = max(20, 200_000 // self.states**2)
        driver = DRIVER
        for function in FUNCTIONS:
            if function not in wanted:
                driver = re.sub(rf"return NAME_{function}\(.*\);", "return 0;", driver)
        values = {"NAME": name, "STATES": self.states, "PARAMETERS": self.parameters, "SHIFT": shift, "SPREAD": spread, "CALLS": self.calls}
        for key, value in values.items():
            driver = driver.replace(key, str(value))
        (folder / "driver.c").write_text(driver)
        subprocess.run([compiler, "-O3", "-march=native", "-I", folder, "-o", folder / "driver", folder / "driver.c", folder / f"{name}.c", "-lm"], check=True)

    def run(self):
        """The state, the right-hand side, its Jacobian, and times of rhs, mass and FUNCTIONS."""
        return json.loads(robots_beside.call(self.folder / "driver"))

    def by_links(self, found):
        """Numbers for Pinocchio: q, qdot, qddot and d(qddot)/d(q, qdot) by columns, in the order of the links."""
        coordinates = tomllib.loads((self.folder / f"{self.name}.toml").read_text()).get("coordinates")
        names = list(coordinates or [link.name for link in self.links])
        n = len(names)
        place = [names.index(robots_beside.legal(link.name)) for link in self.links]
        rates = [n + i for i in place]
        return [*(found["x"][i] for i in (*place, *rates)), *(found["dx"][i] for i in rates),
                *(found["jac"][i + 2 * n * j] for j in (*place, *rates) for i in rates)]


def row(eomgen, compiler, what, robots, folder):
    wanted = tuple(f for f in FUNCTIONS if f not in LEFT_OUT.get(what, ()))
    model = Emitted(eomgen, compiler, what, robots, folder, wanted)
    if model.failure:
        return [what, model.failure]
    compiling, _, _, _ = measured([compiler, "-O2", "-c", "-o", folder / "model.o", folder / f"{model.name}.c"])
    times = model.run()["ns"]
    named = zip(("rhs", "mass", *FUNCTIONS), times)
    return [what, model.states, model.parameters, *(flops(model.source, f) if f in ("rhs", *wanted) else "" for f in ("rhs", *FUNCTIONS)),
            *(time if f in ("rhs", "mass", *wanted) else "" for f, time in named), f"{times[2] / times[0]:.1f}", f"{times[6] / times[0]:.1f}",
            f"{compiling:.1f}"]


def beside_row(eomgen, compiler, what, robots, folder, pinocchio):
    model = Emitted(eomgen, compiler, what, robots, folder, BESIDE_FUNCTIONS)
    if model.failure:
        return [what, model.failure]
    robots_beside.write_links(model.links, folder / "robot.links")
    own, others = [], []
    for _ in range(ROUNDS):
        found = model.run()
        own.append(found["ns"])
        if pinocchio:
            floating = [] if ":" in what else ["floating"]
            others.append(json.loads(robots_beside.call(pinocchio, folder / "robot.links", model.calls, *floating,
                                                        text=robots_beside.numbers(model.by_links(found)))))
    times = [statistics.median(column) for column in zip(*own)]
    ours = (times[0], times[1], times[7], times[2])
    if not pinocchio:
        theirs = ["", "", "", ELSEWHERE[what] * times[0] if what in ELSEWHERE else "", ""]
    else:
        theirs = [statistics.median(column) for column in zip(*others)]
    cells = [what]
    for one, other in zip(ours, theirs):
        cells += [f"{one:.0f}", f"{other:.0f}", f"{other / one:.1f}"] if other else [f"{one:.0f}", "", ""]
    return [*cells, f"{theirs[-1]:.0e}" if pinocchio else ""]


def printed(columns, rows):
    yield f"| {' | '.join(columns)} |"
    yield "|---" * len(columns) + "|"
    for cells in rows:
        yield f"| {' | '.join(str(cell) for cell in cells)}{' |' * (len(columns) - len(cells))} |"


def table(eomgen, arguments):
    robots = None
    if "--robots" in arguments:
        at = arguments.index("--robots")
        robots = arguments[at + 1]
        arguments = arguments[:at] + arguments[at + 2:]
    models = [a for a in arguments if a != "--beside"]
    compiler = shutil.which(os.environ.get("CC", "gcc"))
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        floating = FLOATING if robots else ()
        if "--beside" in arguments:
            pinocchio = robots_beside.compiled(PINOCCHIO, folder)
            yield from printed(BESIDE_COLUMNS, (beside_row(eomgen, compiler, what, robots, folder, pinocchio) for what in models or (*ARMS, *floating)))
            if not pinocchio:
                yield from ("", "Pinocchio is not installed: its times are `rhs` times a ratio that was measured elsewhere.")
        else:
            yield from printed(COLUMNS, (row(eomgen, compiler, what, robots, folder) for what in models or (*MODELS, *floating)))


if __name__ == "__main__":
    ends = (BEGIN_BESIDE, END_BESIDE) if "--beside" in sys.argv else (BEGIN, END)
    main("bench/derivatives.py EOMGEN [--write] [--robots FOLDER] [--beside] [MODEL ...]", *ends, table)

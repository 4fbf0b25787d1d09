# SPDX-License-Identifier: GPL-3.0-or-later
"""Sweeps of an arm of six joints: the table of docs/benchmarks.md, "Sweeps".

    bench/sweeps.py EOMGEN [--write]

10 000 runs of the arm of bench/growth_models.py over 1 s at rtol 1e-6, from random angles of the first joint, with the
derivation already made once: wall-clock and processor seconds of the whole command, medians of 5. With --write the
table in docs/benchmarks.md is replaced.
"""
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import growth
import growth_models

BEGIN, END = "<!-- sweeps: written by bench/sweeps.py -->", "<!-- end of sweeps -->"
KINDS = (("without estimates", ["--no-error-estimate"]), ("with estimates", []), ("ensemble", ["--ensemble"]))
RUNS, REPEATS = 10000, 5


def processor_seconds():
    times = os.times()
    return times.children_user + times.children_system


def sweep(eomgen, model, folder, options):
    """Wall-clock and processor seconds."""
    out = folder / "sweep.csv"
    out.unlink(missing_ok=True)
    command = [eomgen, "sweep", model, "--sample", "q1=0:1", "--samples", str(RUNS), "--rtol", "1e-6", "-o", out]
    begin, used = time.perf_counter(), processor_seconds()
    done = subprocess.run(command + options, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return time.perf_counter() - begin, processor_seconds() - used


def table(eomgen, _):
    yield f"| {RUNS} runs | seconds | processor seconds | us per run and core |"
    yield "|---|---|---|---|"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        model = folder / "arm6.toml"
        model.write_text(growth_models.FAMILIES["arm"](6))
        for kind, options in KINDS:
            sweep(eomgen, model, folder, options)
            measured = [sweep(eomgen, model, folder, options) for _ in range(REPEATS)]
            wall, used = (statistics.median(values) for values in zip(*measured))
            yield f"| {kind} | {wall:.2f} | {used:.2f} | {1e6 * used / RUNS:.0f} |"


if __name__ == "__main__":
    growth.main("bench/sweeps.py EOMGEN [--write]", BEGIN, END, table)

# SPDX-License-Identifier: GPL-3.0-or-later
"""The time to the first result: the table of docs/benchmarks.md, "First result".

    bench/first_result.py EOMGEN [--write] [FAMILY ...]

Each row is one model of bench/growth_models.py: wall-clock seconds of a whole `eomgen run` with an empty cache folder in
both tiers, of the C compiler and of the generation of machine code, and microseconds of a step of rk4, as medians. The
results of both tiers must have the same bytes. With --write the table in docs/benchmarks.md is replaced.
"""
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import growth
import growth_models

BEGIN, END = "<!-- first result: written by bench/first_result.py -->", "<!-- end of first result -->"
MODELS = [("arm", 7), ("arm", 20), ("floating_angles", 30), ("floating_parameters", 30), ("n_four_bar", 40), ("beam", 20)]
RUNS, STEPS = 5, 20000  # runs of each kind; steps of rk4 in one second


def run(eomgen, model, tier, cache, *options):
    """Seconds of a run, its document and its table."""
    table = pathlib.Path(cache) / "rows.csv"
    command = [eomgen, "run", model, "--tier", tier, "--out", table, "--json", "--no-error-estimate", *options]
    start = time.perf_counter()
    done = subprocess.run(command, env=dict(os.environ, EOMGEN_CACHE_DIR=cache), capture_output=True, text=True)
    seconds = time.perf_counter() - start
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stderr}")
    return seconds, json.loads(done.stdout), table.read_bytes()


def cold_run(eomgen, model, tier):
    with tempfile.TemporaryDirectory() as cache:
        return run(eomgen, model, tier, cache)


def step_time(eomgen, model, tier):
    """Microseconds of a step of rk4: four evaluations, and the outputs that are monitored after it."""
    with tempfile.TemporaryDirectory() as cache:
        runs = [run(eomgen, model, tier, cache, "--step", str(1 / STEPS)) for _ in range(RUNS)]
    return 1e6 * statistics.median(document["seconds"]["integrate"] for _, document, _ in runs) / STEPS


def row(eomgen, family, size, folder):
    model = folder / f"{family}_{size}.toml"
    model.write_text(growth_models.FAMILIES[family](size))
    seconds, code, steps, tables = {}, {}, {}, set()
    for tier in ("jit", "compiled"):
        results = [cold_run(eomgen, model, tier) for _ in range(RUNS)]
        tables.update(table for _, _, table in results)
        seconds[tier] = statistics.median(total for total, _, _ in results)
        code[tier] = statistics.median(document["seconds"]["compile"] for _, document, _ in results)
        operations = results[0][1]["operations"]
        steps[tier] = step_time(eomgen, model, tier)
    if len(tables) != 1:
        sys.exit(f"{family} {size}: the tiers give different tables")
    return (
        f"| `{family}` {size} | {operations['add'] + operations['mul']} | {seconds['jit']:.2f} | {seconds['compiled']:.2f} |"
        f" {code['compiled']:.2f} | {1000 * code['jit']:.1f} | {steps['jit']:.2f} | {steps['compiled']:.2f} |"
    )


def table(eomgen, families):
    yield "| model | flops | `jit` (s) | `compiled` (s) | C compiler (s) | machine code (ms) | step, `jit` (us) | step, `compiled` (us) |"
    yield "|---|---|---|---|---|---|---|---|"
    with tempfile.TemporaryDirectory() as folder:
        for family, size in MODELS:
            if not families or family in families:
                yield row(eomgen, family, size, pathlib.Path(folder))


if __name__ == "__main__":
    growth.main("bench/first_result.py EOMGEN [--write] [FAMILY ...]", BEGIN, END, table)

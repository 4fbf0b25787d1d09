# SPDX-License-Identifier: GPL-3.0-or-later
"""The time to the first result: the table of docs/benchmarks.md, "First result".

    bench/first_result.py EOMGEN [--write] [FAMILY ...]

Each row is one model of bench/growth_models.py: wall-clock seconds of a whole `eomgen run` with an empty cache folder in
both tiers, of the C compiler and of the generation of machine code, as medians. The results of both tiers must have the
same bytes. With --write the table in docs/benchmarks.md is replaced.
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
RUNS = 5


def cold_run(eomgen, model, tier, folder):
    """Seconds of a run with an empty cache folder, its document and its table."""
    with tempfile.TemporaryDirectory(dir=folder) as cache:
        os.chmod(cache, 0o700)
        table = pathlib.Path(cache) / "rows.csv"
        command = [eomgen, "run", model, "--tier", tier, "--out", table, "--json", "--no-error-estimate"]
        start = time.perf_counter()
        done = subprocess.run(command, env=dict(os.environ, EOMGEN_CACHE_DIR=cache), capture_output=True, text=True)
        seconds = time.perf_counter() - start
        if done.returncode != 0:
            sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stderr}")
        return seconds, json.loads(done.stdout), table.read_bytes()


def row(eomgen, family, size, folder):
    model = folder / f"{family}_{size}.toml"
    model.write_text(growth_models.FAMILIES[family](size))
    cells, tables = {}, set()
    for tier in ("jit", "compiled"):
        results = [cold_run(eomgen, model, tier, folder) for _ in range(RUNS)]
        tables.update(table for _, _, table in results)
        cells[tier] = statistics.median(seconds for seconds, _, _ in results)
        cells[f"{tier} code"] = statistics.median(document["seconds"]["compile"] for _, document, _ in results)
        operations = results[0][1]["operations"]
    if len(tables) != 1:
        sys.exit(f"{family} {size}: the tiers give different tables")
    flops = operations["add"] + operations["mul"]
    return (
        f"| `{family}` {size} | {flops} | {cells['jit']:.2f} | {cells['compiled']:.2f} |"
        f" {cells['compiled code']:.2f} | {1000 * cells['jit code']:.1f} |"
    )


def table(eomgen, families):
    yield "| model | flops | `--tier jit` (s) | `--tier compiled` (s) | of it the C compiler (s) | machine code (ms) |"
    yield "|---|---|---|---|---|---|"
    with tempfile.TemporaryDirectory() as folder:
        for family, size in MODELS:
            if not families or family in families:
                yield row(eomgen, family, size, pathlib.Path(folder))


if __name__ == "__main__":
    growth.main("bench/first_result.py EOMGEN [--write] [FAMILY ...]", BEGIN, END, table)

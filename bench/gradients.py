# SPDX-License-Identifier: GPL-3.0-or-later
"""Gradients of runs beside the runs: the table of docs/benchmarks.md, "Gradients of runs".

    bench/gradients.py EOMGEN [--write] [FAMILY:SIZE ...]

Each model (bench/growth_models.py) is run five times over two seconds with the gradient of its first angle at the end
by 40 parameters, and the median counts: time of the run, of the motion there with the adjoint equations back, and their
ratio. The largest difference from `run --sensitivity` by four of the parameters is beside it, relative to the largest
derivative. With --write the table in docs/benchmarks.md is replaced.
"""
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

import growth
import growth_models

BEGIN, END = "<!-- gradients: written by bench/gradients.py -->", "<!-- end of gradients -->"
MODELS = ("arm:7", "arm:20", "chain:20")
PARAMETERS, COMPARED, REPEATS, SPAN = 40, 4, 5, "2"


def run(eomgen, model, *options):
    command = [eomgen, "run", model, "--json", "--t-end", SPAN, "--no-error-estimate", "--solver", "dop853", *options]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr.strip())
    return json.loads(done.stdout)


def row(eomgen, what, folder):
    family, size = what.split(":")
    model = folder / f"{family}_{size}.toml"
    model.write_text(growth_models.FAMILIES[family](int(size)))
    output = next(iter(run(eomgen, model)["final"]))
    names = list(run(eomgen, model, "--gradient", output)["gradients"]["values"][output])[:PARAMETERS]
    forward, both, values = [], [], {}
    for _ in range(REPEATS):
        document = run(eomgen, model, "--gradient", output, "--by", ",".join(names))
        forward.append(document["seconds"]["integrate"])
        both.append(document["gradients"]["seconds"])
        values = document["gradients"]["values"][output]
    some = names[:COMPARED]
    other = run(eomgen, model, "--sensitivity", ",".join(some))["sensitivities"]["values"]
    difference = max(abs(values[n] - other[n][output]) for n in some) / max(map(abs, values.values()))
    alone, there_and_back = statistics.median(forward), statistics.median(both)
    return [f"`{family}` {size}", len(names), f"{1e3 * alone:.2f}", f"{1e3 * there_and_back:.2f}",
            f"{there_and_back / alone:.1f}", f"{difference:.0e}"]


def table(eomgen, names):
    yield "| model | values | run, ms | with gradient, ms | ratio | difference from sensitivities |"
    yield "|---|---|---|---|---|---|"
    with tempfile.TemporaryDirectory() as folder:
        for what in names or MODELS:
            yield "| " + " | ".join(map(str, row(eomgen, what, pathlib.Path(folder)))) + " |"


if __name__ == "__main__":
    growth.main("bench/gradients.py EOMGEN [--write] [FAMILY:SIZE ...]", BEGIN, END, table)

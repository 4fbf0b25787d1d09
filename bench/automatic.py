# SPDX-License-Identifier: GPL-3.0-or-later
"""`auto` beside the other solvers with chosen steps: the table of docs/benchmarks.md, "Automatic choice".

    bench/automatic.py EOMGEN [--write] [MODEL ...]

`eomgen bench` measures each model with all these solvers at eleven tolerances. For each true error from 1e-3 to 1e-11
that `auto` reaches, its time is compared with that of the fastest solver, between two tolerances by a line in
logarithms. A row has the largest of these ratios. Without models: those of models/ and beams, a chain and an arm of
bench/growth_models.py. With --write the table in docs/benchmarks.md is replaced.
"""
import json
import math
import pathlib
import subprocess
import sys
import tempfile

import growth
import growth_models

BEGIN, END = "<!-- automatic: written by bench/automatic.py -->", "<!-- end of automatic -->"
SOLVERS = ("auto", "dopri5", "tsit5", "dop853", "radau5", "radau", "rodas", "taylor")
GROWN = (("rods", 20), ("beam", 20), ("chain", 10), ("arm", 7))
ROOT = pathlib.Path(__file__).resolve().parent.parent


def measured_rows(eomgen, model):
    """Rows of `bench`, or the reason why it has none."""
    command = [eomgen, "bench", str(model), "--json", "--no-libraries", "--seconds", "2", "--solver", ",".join(SOLVERS)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 3) or not done.stdout:
        return done.stderr.strip().splitlines()[:1]
    return json.loads(done.stdout)["rows"]


def curve(rows, solver):
    """Points (error, seconds), each faster than all that are more accurate."""
    points = sorted((row["error_along"], row["seconds"]) for row in rows
                    if row["solver"] == solver and row["outcome"] == "done" and row["error_along"])
    best, kept = math.inf, []
    for error, seconds in points:
        if seconds < best:
            kept.append((error, seconds))
            best = seconds
    return kept


def seconds_for(points, error):
    """Time to reach this error; None beyond the points."""
    for (below, slow), (above, fast) in zip(points, points[1:]):
        if below <= error <= above:
            part = math.log(error / below) / math.log(above / below)
            return math.exp(math.log(slow) + part * math.log(fast / slow))
    return points[-1][1] if points and error > points[-1][0] else None


def worst_ratio(rows, others):
    auto = curve(rows, "auto")
    curves = {name: curve(rows, name) for name in others}
    worst = None
    for digits in range(3, 12):
        error = 10.0**-digits
        own = seconds_for(auto, error)
        if own is None:
            continue
        times = {name: seconds_for(points, error) for name, points in curves.items()}
        reached = {name: seconds for name, seconds in times.items() if seconds is not None}
        if not reached:
            continue
        best = min(reached, key=reached.get)
        if worst is None or own / reached[best] > worst[0]:
            worst = (own / reached[best], error, best)
    return worst


def models_of(names, folder):
    """Pairs (name, path): the model files of these names, or those of models/ and grown ones, written to the folder."""
    if names:
        return [(pathlib.Path(name).stem, name) for name in names]
    models = [(path.stem, path) for path in sorted((ROOT / "models").glob("*.toml"))]
    for kind, n in GROWN:
        path = pathlib.Path(folder) / f"{kind}_{n}.toml"
        path.write_text(growth_models.FAMILIES[kind](n))
        models.append((f"{kind} {n}", path))
    return models


def table(eomgen, names):
    yield "| model | `auto` / best | at error | best | without `taylor` | at error | best |"
    yield "|---|---|---|---|---|---|---|"
    with tempfile.TemporaryDirectory() as folder:
        for name, path in models_of(names, folder):
            rows = measured_rows(eomgen, path)
            if not rows or isinstance(rows[0], str):
                print(f"{name}: {rows[0] if rows else 'nothing measured'}", file=sys.stderr)
                continue
            cells = [f"`{name}`"]
            for others in (SOLVERS[1:], SOLVERS[1:-1]):
                worst = worst_ratio(rows, others)
                cells += [f"{worst[0]:.2f}", f"{worst[1]:.0e}", worst[2]] if worst else ["-", "-", "-"]
            yield "| " + " | ".join(cells) + " |"


if __name__ == "__main__":
    growth.main("bench/automatic.py EOMGEN [--write] [MODEL ...]", BEGIN, END, table)

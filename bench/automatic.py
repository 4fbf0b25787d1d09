# SPDX-License-Identifier: GPL-3.0-or-later
"""`auto` beside the other solvers with chosen steps: the tables of docs/benchmarks.md, "Automatic choice".

    bench/automatic.py EOMGEN [--write] [MODEL ...]

`eomgen bench` measures each model with all these solvers at eleven tolerances, each run at most half a second. For each
true error from 1e-3 to 1e-11 that `auto` reaches, its time is compared with that of the fastest solver, between two
tolerances by a line in logarithms. A row has the largest of these ratios. Times are medians of up to 31 runs by the
clock: counted evaluations would leave out factorisations and the work of the solver itself. A model whose ratio exceeds
the limit is measured a second time, and each run counts by the smaller of its two times, since other programs only make
runs slower. A model takes at most LIMIT seconds. Without models: those of models/, and grown ones of
bench/growth_models.py. The full table is printed; with --write its summary in docs/benchmarks.md is replaced.
"""
import collections
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
GROWN = (("rods", 6), ("rods", 20), ("beam", 10), ("beam", 20), ("chain", 10), ("arm", 7), ("n_four_bar", 4),
         ("gravitating", 5), ("free_particles", 10), ("floating_parameters", 3), ("floating_angles", 3))
LIMIT = 120  # s, of one measurement of a model
WANTED = 1.5  # the largest ratio that the choice should have
CAUSES = {"contacts and friction": "contacts or friction: there is no reference solution",
          "input is": "an input varies: there is no reference solution",
          "crosses a kink": "the motion crosses a kink: there is no reference solution",
          "reference ends at": "the steps of the reference solution become too short",
          "run ends at": "an event ends the run",
          "fix every coordinate": "the constraints fix every coordinate",
          "not within": f"longer than {LIMIT} s"}
ROOT = pathlib.Path(__file__).resolve().parent.parent


def measured_rows(eomgen, model):
    """Rows of `bench`, or the reason why it has none."""
    command = [eomgen, "bench", str(model), "--json", "--no-libraries", "--seconds", "0.5", "--solver", ",".join(SOLVERS)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        return f"not within {LIMIT} s"
    if done.returncode not in (0, 3) or not done.stdout:
        return (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[0]
    return json.loads(done.stdout)["rows"]


def faster_of(first, second):
    """The rows of two measurements, each with the smaller time."""
    key = lambda row: (row["solver"], row["rtol"])
    seconds = {key(row): row["seconds"] for row in second}
    return [{**row, "seconds": min(row["seconds"], seconds.get(key(row), math.inf))} for row in first]


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


def line_of(name, ratios):
    cells = [f"`{name}`"]
    for worst in ratios:
        cells += [f"{worst[0]:.2f}", f"{worst[1]:.0e}", worst[2]] if worst else ["-", "-", "-"]
    return "| " + " | ".join(cells) + " |"


def measure(eomgen, names):
    """Prints a line for each model. Returns (name, ratios with and without taylor) and the reasons of the others."""
    measured, left_out = [], []
    with tempfile.TemporaryDirectory() as folder:
        for name, path in models_of(names, folder):
            rows = measured_rows(eomgen, path)
            ratios = lambda: [worst_ratio(rows, others) for others in (SOLVERS[1:], SOLVERS[1:-1])]
            worst = None if isinstance(rows, str) else ratios()
            if worst and worst[1] and worst[1][0] > WANTED:
                again = measured_rows(eomgen, path)
                if not isinstance(again, str):
                    rows = faster_of(rows, again)
                    worst = ratios()
            if worst and worst[1]:
                measured.append((name, worst))
                print(line_of(name, worst), flush=True)
            else:
                left_out.append((name, rows if isinstance(rows, str) else "no solver reaches 1e-3"))
                print(f"{name}: {left_out[-1][1]}", file=sys.stderr, flush=True)
    return measured, left_out


HEAD = ["| model | `auto` / best | at error | best | without `taylor` | at error | best |", "|---|---|---|---|---|---|---|"]


def share(measured, place):
    """The distribution of ratios: median, 90 %, largest, and how many are above the limit."""
    ratios = sorted(worst[place][0] for _, worst in measured)
    return (f"{ratios[len(ratios) // 2]:.2f} | {ratios[int(0.9 * len(ratios))]:.2f} | {ratios[-1]:.2f} |"
            f" {sum(r > WANTED for r in ratios)} of {len(ratios)}")


def summary(measured, left_out):
    """The lines of docs/benchmarks.md."""
    yield f"| compared with | median | 90 % | largest | above {WANTED} |"
    yield "|---|---|---|---|---|"
    yield f"| all solvers but `taylor` | {share(measured, 1)} |"
    yield f"| all solvers | {share(measured, 0)} |"
    yield ""
    yield "The ten largest ratios without `taylor`:"
    yield ""
    yield from HEAD
    for name, worst in sorted(measured, key=lambda entry: -entry[1][1][0])[:10]:
        yield line_of(name, worst)
    causes = collections.Counter(next((text for word, text in CAUSES.items() if word in why), why) for _, why in left_out)
    if causes:
        yield ""
        yield "Not measured:"
        yield ""
        yield "| models | reason |"
        yield "|---|---|"
        for cause, count in causes.most_common():
            yield f"| {count} | {cause} |"


if __name__ == "__main__":
    arguments = [a for a in sys.argv[1:] if a != "--write"]
    if not arguments:
        sys.exit("usage: bench/automatic.py EOMGEN [--write] [MODEL ...]")
    print("\n".join(HEAD), flush=True)
    lines = list(summary(*measure(str(pathlib.Path(arguments[0]).resolve()), arguments[1:])))
    print("\n" + "\n".join(lines))
    if "--write" in sys.argv:
        growth.write(BEGIN, END, lines)

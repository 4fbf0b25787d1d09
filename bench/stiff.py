# SPDX-License-Identifier: GPL-3.0-or-later
"""radau5 and rodas of two versions of eomgen on stiff models: the table of docs/benchmarks.md, "Stiff models".

    bench/stiff.py EOMGEN OTHER [--write] [--every] [MODEL ...]

EOMGEN and OTHER are two programs. A scene of models/ counts as stiff if `auto` of EOMGEN takes radau5 in it. Grown
models of bench/growth_models.py, FAMILY:N, count too. Both programs get the same file; if OTHER does not read it, then
its own model of that name; without one the row is left out. Times are those of the integration (`seconds.integrate`),
the shortest of RUNS, which other programs disturb least. Programs take turns. With --every all default scenes are
measured, stiff or not.
With --write the table in docs/benchmarks.md is replaced.
"""
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import tomllib

import growth
import growth_models

BEGIN, END = "<!-- stiff: written by bench/stiff.py -->", "<!-- end of stiff -->"
MODELS = pathlib.Path(__file__).resolve().parent.parent / "models"
SOLVERS = ("radau5", "rodas")
GROWN = ("beam:10", "beam:20", "beam:40")
RUNS = 15
LIMIT = 120  # s
DIFFERS = 1e-3  # of a run's end, relative to 1 + its size: another motion


def run(program, model, scene, solver):
    command = [program, "run", str(model), "--scene", scene, "--solver", solver, "--no-error-estimate", "--json"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=LIMIT)
        return json.loads(done.stdout)
    except (subprocess.TimeoutExpired, json.JSONDecodeError):
        return None


def is_stiff(found):
    return found is not None and ("radau5" in [change["to"] for change in found.get("solver_changes", [])] or found.get("solver") == "radau5")


def runs_to_end(found):
    return found is not None and found.get("outcome") in ("done", "event")


def agree(one, other):
    """Whether two runs have the same motion, by the outputs that both have."""
    ends = [(value, other["final"][name]) for name, value in one["final"].items() if name in other["final"]]
    return all(isinstance(a, (int, float)) and isinstance(b, (int, float)) and abs(a - b) <= DIFFERS * (1 + abs(a)) for a, b in ends)


def cells(programs, path, scene, solver):
    """Milliseconds of both and their ratio, steps and Jacobians of both; or None, and why."""
    files = [path, path]
    first = [run(program, file, scene, solver) for program, file in zip(programs, files)]
    if not runs_to_end(first[1]):
        files[1] = path.stem
        first[1] = run(programs[1], files[1], scene, solver)
    for who, found in zip(("", "the other version: "), first):
        if not runs_to_end(found):
            return None, f"{who}{'refused or too long' if found is None else found.get('outcome', 'failed')}"
    if not agree(*first):
        return None, "another motion"
    times = [[], []]
    for _ in range(RUNS):
        for k in (0, 1):
            times[k].append(1e3 * run(programs[k], files[k], scene, solver)["seconds"]["integrate"])
    shortest = [min(column) for column in times]
    counts = [f"{found['steps'] + found['rejected']}, {found['implicit']['jacobians']}" for found in first]
    return (shortest[1], shortest[0], shortest[0] / shortest[1], counts[1], counts[0]), ""


def grown(folder):
    """Files of GROWN."""
    for what in GROWN:
        family, n = what.split(":")
        path = folder / f"{family}_{n}.toml"
        path.write_text(growth_models.FAMILIES[family](int(n)))
        yield path


def scenes(eomgen, folder, models, every):
    """Files and scenes that are measured."""
    for path in (*sorted(MODELS.glob("*.toml")), *grown(folder)):
        if models and path.stem not in models:
            continue
        if every or path.parent == folder:
            yield path, "default"
            continue
        for scene in tomllib.loads(path.read_text()).get("scene", {"default": {}}):
            if is_stiff(run(eomgen, path, scene, "auto")):
                yield path, scene


def table(programs, models, every):
    yield "| model | scene | solver | ms, other | ms | ratio | steps, Jacobians of the other | the same |"
    yield "|---|---|---|---:|---:|---:|---:|---:|"
    ratios = {solver: [] for solver in SOLVERS}
    left_out = {}
    with tempfile.TemporaryDirectory() as folder:
        for path, scene in scenes(programs[0], pathlib.Path(folder), models, every):
            for solver in SOLVERS:
                found, reason = cells(programs, path, scene, solver)
                if found is None:
                    left_out.setdefault(f"`{path.stem}`, {reason}", []).append(solver)
                    continue
                other, own, ratio, *counts = found
                ratios[solver].append(ratio)
                yield f"| `{path.stem}` | {scene} | `{solver}` | {other:.3g} | {own:.3g} | {ratio:.2f} | {counts[0]} | {counts[1]} |"
    yield ""
    for solver, values in ratios.items():
        if values:
            yield f"- `{solver}`: median {statistics.median(values):.2f}, largest {max(values):.2f} of {len(values)} rows."
    yield from (f"- Left out: {what} ({', '.join(solvers)})." for what, solvers in left_out.items())


if __name__ == "__main__":
    arguments = [a for a in sys.argv[1:] if not a.startswith("--")]
    if len(arguments) < 2:
        sys.exit("usage: bench/stiff.py EOMGEN OTHER [--write] [--every] [MODEL ...]")
    lines = []
    for line in table(arguments[:2], arguments[2:], "--every" in sys.argv):
        print(line, flush=True)
        lines.append(line)
    if "--write" in sys.argv:
        growth.write(BEGIN, END, lines)

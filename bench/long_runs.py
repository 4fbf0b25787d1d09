# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of docs/long-runs.md: EOMGEN DOCUMENT FOLDER LIMIT. Called by bench/long_runs.

Each row is one solver with one step size or tolerance on one scene; its runs have 1, 10, 100, .. 1e6 periods and each begins anew. A run that would take more than
LIMIT seconds (ten times the one before it) is not begun, and the row says how far it came.
"""
import json
import math
import pathlib
import subprocess
import sys
import textwrap

BEGIN, END = "<!-- tables: written by bench/long_runs -->", "<!-- end of the tables -->"
COUNTS = [10**k for k in range(7)]
SHOWN = (1, 100, 10**4, 10**6)
SATURATED = 0.05  # a larger drift no longer grows as in theory

# title, arguments, period in s, fixed steps in it, meaning of the period
SCENES = [
    ("Pendulum, one angle", ["P2_planar_pendulum"], 2.1391376005586884, 50, "that of the swing of 1 rad"),
    ("Kepler, e = 0.5, Cartesian coordinates", ["kepler_eccentric", "--set", "e=0.5"], 2 * math.pi, 200, "one revolution"),
    ("Spherical pendulum, two angles", ["P1_spherical_pendulum"], 1.0919103148866738, 50, "from lowest to lowest point"),
    ("Double pendulum, two angles", ["S5_double_pendulum", "--scene", "released"], 2.621052430089015, 50, "that of the slow mode of small swings"),
    ("Double pendulum, Cartesian coordinates and two multipliers", ["S5_double_pendulum_cartesian"], 2.621052430089015, 50, "as before"),
    ("Free body, tumbling, Euler parameters", ["R1_free_body_euler_parameters", "--scene", "tumbling"], math.pi, 50, "one turn about the middle axis"),
]
TIGHT = {"taylor": ("1e-12", "1e-20"), "dop853": ("1e-12",), "radau": ("1e-12",)}  # beside 1e-9; a step of 1e-20 is wrong by rounding only


def settings(solvers, period, steps):
    for solver in solvers + [{"name": "auto", "adaptive": True}]:
        name = solver["name"]
        if not solver["adaptive"]:
            yield name, f"{steps} steps", ["--solver", name, "--step", repr(period / steps)]
            continue
        for tolerance in ("1e-9",) + TIGHT.get(name, ()):
            yield name, tolerance, ["--solver", name, "--rtol", tolerance, "--atol", tolerance]


def run(command, path):
    """The document of one run, with its memory; a reason (str) if the solver is not eligible for the scene."""
    if path.exists():
        return json.loads(path.read_text())
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        out, said = process.communicate()
    if process.returncode == 2:
        return said.strip().splitlines()[0].removeprefix("error: ")
    if process.returncode not in (0, 3):
        sys.exit(f"{' '.join(command)}: {said}")
    path.write_text(out)
    return json.loads(out)


def drift(found):
    """Energy, momenta, constraints."""
    momenta = [v["max_relative_drift"] for k, v in found["invariants"].items() if k != "energy"]
    return (found["invariants"].get("energy", {}).get("max_relative_drift"), max(momenta) if momenta and None not in momenta else None, found["constraint_drift"])


def growth(points):
    """Slope of log drift over log periods, from 100 periods on."""
    kept = [(math.log(n), math.log(d)) for n, d in points if n >= 100 and d and d < SATURATED]
    if len(kept) < 3:
        return None
    mx, my = (sum(c) / len(kept) for c in zip(*kept))
    return sum((x - mx) * (y - my) for x, y in kept) / sum((x - mx) ** 2 for x, _ in kept)


def number(value, form):
    return "" if value is None else format(value, form)


class Row:
    def __init__(self, name, setting):
        self.name, self.setting, self.runs, self.note = name, setting, {}, ""

    def points(self, which):
        return [(n, drift(found)[which]) for n, found in self.runs.items()]

    def cells(self):
        last = max(self.runs)
        cells = [self.name, self.setting]
        energies = dict(self.points(0))
        cells += [number(energies.get(n), ".0e") for n in SHOWN] + [number(growth(self.points(0)), ".2f")]
        for which in (1, 2):
            points = self.points(which)
            cells += [number(points[-1][1], ".0e"), number(growth(points), ".2f")]
        end = self.runs[last]
        return cells + [f"{last:.0e}", f"{end['steps']:.2g}", f"{end['seconds']['integrate']:.2g}", self.note]


def scene_rows(eomgen, folder, limit, solvers, index):
    title, model, period, steps, _ = SCENES[index]
    for name, setting, options in settings(solvers, period, steps):
        row = Row(name, setting)
        for count in COUNTS:
            command = [eomgen, "run", *model, *options, "--t-end", repr(period * count), "--no-error-estimate", "--max-steps", "100000000000", "--json"]
            found = run(command, pathlib.Path(folder, f"{index}.{name}.{setting.replace(' ', '_')}.{count}.json"))
            if isinstance(found, str):
                row.note = found
                break
            if found["outcome"] != "done":
                row.note = f"{found['outcome']} at {found['t'] / period:.3g} periods"
                break
            row.runs[count] = found
            if 10 * found["seconds"]["integrate"] > limit:
                break
        print(f"{title}: {name} {setting}: {max(row.runs, default=0)} {row.note}", file=sys.stderr)
        yield row


def table(rows, index):
    title, model, period, _, what = SCENES[index]
    lines = [f"### {title}", "", textwrap.fill(f"`{' '.join(model)}`; a period is {period:.6g} s, {what}.", 100, break_on_hyphens=False), "",
             "| solver | steps a period, or tolerance | energy: 1 | 1e2 | 1e4 | 1e6 periods | growth | momentum | growth | constraints | growth | periods | steps | s | ended by |",
             "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|"]
    lines += ["| " + " | ".join(row.cells()) + " |" for row in rows if row.runs]
    lines += [f"\n`{row.name}` ({row.setting}): {row.note}." for row in rows if not row.runs]
    return lines + [""]


def short(title):
    """The title of a scene as the head of a column."""
    return title.removesuffix(" and two multipliers").removesuffix(" coordinates").replace("Spherical pendulum, two angles", "Spherical pendulum")


def summary(tables):
    """The growth of the energy's drift, from scene to scene."""
    kinds = {}
    for index, rows in enumerate(tables):
        for row in rows:
            if row.runs:
                kinds.setdefault((row.name, "fixed" if "steps" in row.setting else row.setting), {})[index] = growth(row.points(0))
    lines = ["### Growth of the energy's drift, all scenes", "", "Exponent a of drift ~ periods^a, fitted from 100 periods on.", "",
             "| solver | tolerance | " + " | ".join(short(title) for title, *_ in SCENES) + " |", "|---|---|" + "---:|" * len(SCENES)]
    for (name, setting), found in kinds.items():
        lines.append(f"| {name} | {setting} | " + " | ".join(number(found.get(i), ".2f") for i in range(len(SCENES))) + " |")
    return lines + [""]


def main(eomgen, document, folder, limit):
    solvers = json.loads(subprocess.run([eomgen, "list", "--json"], check=True, capture_output=True, text=True).stdout)["solvers"]
    tables = [list(scene_rows(eomgen, folder, float(limit), solvers, index)) for index in range(len(SCENES))]
    lines = [f"Limit: {float(limit):g} s a run.", ""] + summary(tables)
    for index, rows in enumerate(tables):
        lines += table(rows, index)
    text = pathlib.Path(document).read_text()
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    pathlib.Path(document).write_text(before + BEGIN + "\n\n" + "\n".join(lines) + END + after)


if __name__ == "__main__":
    main(*sys.argv[1:5])

# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of docs/stress.md, of the JSON documents that `eomgen stress` wrote: FOLDER STEPS DOCUMENT. Called by bench/stress_all."""
import json
import pathlib
import sys

BEGIN, END = "<!-- table: written by bench/stress_all -->", "<!-- end of the table -->"


def number(extreme, form):
    if extreme is None:
        return ""
    return "infinite" if extreme["value"] is None else format(extreme["value"], form)


def row(name, found):
    audit = found["denominator_audit"]
    lost = audit["digits_lost"]
    where = f" ({lost['case']})" if lost and lost["value"] >= 0.5 else ""
    return (f"| {name} | {len({r['case'] for r in found['rows']})} | {found['pass']} | {found['reported']} | {found['undetected']} | {len(found['left_out'])} "
            f"| {number(audit['mass_condition'], '.1e')} | {number(audit['scaled_mass_condition'], '.1e')} | {number(lost, '.1f')}{where} |")


def main(folder, steps, document):
    lines = [f"At most {steps} steps a run.", "",
             "| model | cases | pass | reported | undetected | left out | condition of M | scaled | digits lost (in) |", "|---|---:|---:|---:|---:|---:|---:|---:|---|"]
    total, undetected, still, missing = [0, 0, 0], [], [], []
    for model in sorted(pathlib.Path("models").glob("*.toml"), key=lambda path: path.stem):
        path = pathlib.Path(folder, model.stem + ".json")
        if not path.exists():
            said = pathlib.Path(folder, model.stem + ".err")
            text = said.read_text().strip() if said.exists() else ""
            (still if "nothing is left to move" in text else missing).append(model.stem)
            continue
        found = json.loads(path.read_text())
        lines.append(row(model.stem, found))
        total = [a + found[k] for a, k in zip(total, ("pass", "reported", "undetected"))]
        undetected += [f"- {model.stem}, {r['case']}, {r['solver']}: error {r['error']}, estimate {r['estimate']}" for r in found["rows"] if r["verdict"] == "undetected"]
    lines += ["", f"Together {sum(total)} rows: {total[0]} pass, {total[1]} reported, {total[2]} undetected."]
    if still:
        lines += [f"Without a motion of their own, and so without rows: {', '.join(still)}."]
    if missing:
        lines += [f"Not in this table: {', '.join(missing)}."]
    lines += ["", "Undetected:", ""] * bool(undetected) + undetected
    text = pathlib.Path(document).read_text()
    before, rest = text.split(BEGIN)
    after = rest.split(END)[1]
    pathlib.Path(document).write_text(before + BEGIN + "\n" + "\n".join(lines) + "\n" + END + after)
    return 1 if undetected or missing else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:4]))

# SPDX-License-Identifier: GPL-3.0-or-later
"""The cost of mechanisms written as others write them: the table of docs/benchmarks.md.

    bench/mechanisms.py EOMGEN [--write] [NAME ...]

Each row is one model of bench/mechanism_models.py: coordinates and equations of its constraints, processor seconds of check, verify (without a compiler), run (of 0.2 s, with its compilation), linearize and equilibria, and the
most memory that one of them took. With --write the table in docs/benchmarks.md is replaced.
"""
import json
import os
import pathlib
import tempfile

import mechanism_models
from growth import main, measured

BEGIN, END = "<!-- mechanisms: written by bench/mechanisms.py -->", "<!-- end of mechanisms -->"
COMMANDS = [("check", []), ("verify", ["--no-compile"]), ("run", ["--t-end", "0.2"]), ("linearize", []), ("equilibria", [])]


def row(eomgen, name, folder):
    model = folder / f"{name}.toml"
    model.write_text(mechanism_models.MECHANISMS[name]())
    cells, most = [], 0
    for command, options in COMMANDS:
        seconds, memory, code, text = measured([eomgen, command, model, *options, "--json"])
        if command == "check" and code == 0:
            document = json.loads(text)
            cells = [str(len(document["coordinates"])), str(len(document["constraints"]))]
        cells.append(f"{seconds:.2f}" if code == 0 else "too long" if code is None else "refused" if code == 2 else f"exit code {code}")
        most = max(most, memory)
    return f"| {name} | {' | '.join(cells)} | {most:.0f} |"


def table(eomgen, names):
    yield "| model | coordinates | equations | check | verify | run | linearize | equilibria | MB |"
    yield "|---|---|---|---|---|---|---|---|---|"
    with tempfile.TemporaryDirectory() as folder:
        os.environ["EOMGEN_CACHE_DIR"] = str(pathlib.Path(folder) / "code")
        for name in names or mechanism_models.MECHANISMS:
            yield row(eomgen, name, pathlib.Path(folder))


if __name__ == "__main__":
    main("bench/mechanisms.py EOMGEN [--write] [NAME ...]", BEGIN, END, table)

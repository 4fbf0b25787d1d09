# SPDX-License-Identifier: GPL-3.0-or-later
"""The growth of cost with a model's size: the table of docs/benchmarks.md.

    bench/growth.py EOMGEN [--write] [FAMILY ...]

Each row is one model of bench/growth_models.py: processor seconds of the whole `emit` and its stages (read and derive, optimise, verify), of the compiler at -O2, operations of the right-hand side, and
the most memory that `emit` took. An exponent compares a row with the one before it of the same family: seconds or operations grow like n^exponent. With --write the table in docs/benchmarks.md is replaced.
"""
import json
import math
import os
import pathlib
import resource
import shutil
import sys
import tempfile

import growth_models

BEGIN, END = "<!-- growth: written by bench/growth.py -->", "<!-- end of growth -->"
SIZES = [
    ("arm", (6, 7, 10, 14, 20, 50)),
    ("floating_parameters", (10, 30)),
    ("floating_angles", (10, 30)),
    ("chain", (10, 20, 40)),
    ("n_four_bar", (10, 20, 40)),
    ("beam", (10, 20, 40)),
    ("rods", (2, 3, 6)),
    ("gravitating", (10, 30, 60)),
    ("free_particles", (30, 100, 333)),
]
LIMIT = 300  # s


def measured(command):
    """Processor seconds, memory in MB, exit code (None: too long) and standard output of a command."""
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        pid = os.fork()
        if pid == 0:
            os.dup2(out.fileno(), 1)
            os.dup2(err.fileno(), 2)
            resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT))
            os.execv(command[0], [str(part) for part in command])
        _, status, usage = os.wait4(pid, 0)
        out.seek(0)
        code = os.waitstatus_to_exitcode(status)
        return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, code if code >= 0 else None, out.read().decode()


def exponent(value, before, n, n_before):
    return "" if not before or not value else f"{math.log(value / before) / math.log(n / n_before):.1f}"


def row(eomgen, compiler, family, n, folder):
    model = folder / f"{family}_{n}.toml"
    model.write_text(growth_models.FAMILIES[family](n))
    seconds, memory, code, text = measured([eomgen, "emit", model, "-o", folder, "--target", "c", "--json"])
    if code != 0:
        return {"n": n, "failed": f"not within {LIMIT} s" if code is None else f"exit code {code}"}
    document = json.loads(text)
    compiling, _, _, _ = measured([compiler, "-O2", "-c", "-o", folder / "model.o", folder / f"{family}_{n}.c"])
    stages = document["seconds"]
    chosen = document["operations"]
    return {"n": n, "formulation": document["formulation"], "emit": seconds, "derive": stages["read"] + stages["derive"], "optimise": stages["optimise"], "verify": stages["verify"],
            "compile": compiling, "flops": chosen["add"] + chosen["mul"], "memory": memory, "pass": document["certificate"].startswith("pass")}


def table(eomgen, families):
    yield "| model | n | formulation | emit | exponent | derive | optimise | verify | compile | flops | exponent | MB |"
    yield "|---|---|---|---|---|---|---|---|---|---|---|---|"
    compiler = shutil.which(os.environ.get("CC", "gcc"))
    with tempfile.TemporaryDirectory() as name:
        for family, sizes in SIZES:
            if families and family not in families:
                continue
            before = None
            for n in sizes:
                r = row(eomgen, compiler, family, n, pathlib.Path(name))
                if "failed" in r:
                    yield f"| {family} | {n} | {r['failed']} | | | | | | | | | |"
                    before = None
                    continue
                of = lambda key: exponent(r[key], before and before[key], n, before and before["n"])
                yield (f"| {family} | {n} | {r['formulation']}{'' if r['pass'] else ' (fails)'} | {r['emit']:.2f} | {of('emit')} | {r['derive']:.2f} | {r['optimise']:.2f} | {r['verify']:.2f} | {r['compile']:.2f} |"
                       f" {r['flops']} | {of('flops')} | {r['memory']:.0f} |")
                before = r


def write(begin, end, lines):
    """Replaces the table between two comments of docs/benchmarks.md."""
    document = growth_models.ROOT / "docs" / "benchmarks.md"
    head, rest = document.read_text().split(begin)
    document.write_text(head + begin + "\n" + "\n".join(lines) + "\n" + end + rest.split(end)[1])


def main(usage, begin, end, table):
    """The command line of a program that prints a table: of all rows, or of those that are named."""
    arguments = [a for a in sys.argv[1:] if a != "--write"]
    if not arguments:
        sys.exit(f"usage: {usage}")
    lines = []
    for line in table(os.path.abspath(arguments[0]), arguments[1:]):
        print(line, flush=True)
        lines.append(line)
    if "--write" in sys.argv:
        write(begin, end, lines)


if __name__ == "__main__":
    main("bench/growth.py EOMGEN [--write] [FAMILY ...]", BEGIN, END, table)

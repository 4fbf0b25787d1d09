#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Operations of customised dynamics beside those that SYMORO wrote for the same arm.

    python3 bench/symoro.py EOMGEN FOLDER [--write]

FOLDER is a clone of https://github.com/symoro/symoro-robots: `rx90/rx90_idm.txt` has inverse dynamics, `rx90/rx90_ddm.txt` forward dynamics, as equations with one assignment each. bench/rx90.toml is the same arm. Sums, products and squares, and quotients are counted. External forces and friction, which the model leaves out, are 0 in SYMORO's equations, and assignments without effect on the result are not counted. --write replaces the table in docs/benchmarks.md.
"""
import ast
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
JOINTS = range(1, 7)
ABSENT = {f"{name}{j}" for j in JOINTS for name in ("FX", "FY", "FZ", "CX", "CY", "CZ", "FS", "FV")}
MODELS = {"inverse dynamics": ("rx90_idm.txt", "GAM", "inverse"), "forward dynamics": ("rx90_ddm.txt", "QDP", "rhs")}


def without_zeros(node, zeros):
    """The expression without the names `zeros`; None if nothing remains."""
    if isinstance(node, ast.Name):
        return None if node.id in zeros else node
    if isinstance(node, ast.UnaryOp):
        operand = without_zeros(node.operand, zeros)
        return operand and ast.UnaryOp(node.op, operand)
    if not isinstance(node, ast.BinOp):
        return node
    left, right = without_zeros(node.left, zeros), without_zeros(node.right, zeros)
    if isinstance(node.op, (ast.Add, ast.Sub)) and (left is None or right is None):
        return left or (right and (right if isinstance(node.op, ast.Add) else ast.UnaryOp(ast.USub(), right)))
    return left and right and ast.BinOp(left, node.op, right)


def operations_of_symoro(path, result):
    text = path.read_text().split("Equations:", 1)[1].split("*=*", 1)[0]
    zeros, equations = set(ABSENT), []
    for statement in filter(str.strip, text.split(";")):
        name, expression = statement.split("=", 1)
        value = without_zeros(ast.parse(expression.strip(), mode="eval").body, zeros)
        if value is None:
            zeros.add(name.strip())
        else:
            equations.append((name.strip(), value))
    live = {f"{result}{j}" for j in JOINTS}
    count = {"add": 0, "mul": 0, "div": 0}
    for name, value in reversed(equations):
        if name not in live:
            continue
        for node in ast.walk(value):
            if isinstance(node, ast.Name):
                live.add(node.id)
            if isinstance(node, ast.BinOp):
                count[{ast.Mult: "mul", ast.Pow: "mul", ast.Div: "div"}.get(type(node.op), "add")] += 1
    return count


def operations_of_eomgen(program):
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "emit", str(ROOT / "bench/rx90.toml"), "--target", "c", "--with", "inverse", "-o", folder], check=True, stdout=subprocess.DEVNULL)
        source = next(pathlib.Path(folder).glob("*.c")).read_text()
    literals = "".join(re.findall(r'"((?:[^"\\]|\\.)*)"', source)).replace('\\"', '"')
    return json.JSONDecoder().raw_decode(literals, literals.index('"operations":') + len('"operations":'))[0]


def table(program, folder):
    ours = operations_of_eomgen(program)
    lines = ["| RX 90 | SYMORO: multiplications | additions | divisions | together | eomgen: multiplications | additions | divisions | together |", "|---|---:|---:|---:|---:|---:|---:|---:|---:|"]
    for title, (file, result, function) in MODELS.items():
        cells = []
        for count in (operations_of_symoro(folder / "rx90" / file, result), ours[function]):
            cells += [count["mul"], count["add"], count["div"], count["mul"] + count["add"] + count["div"]]
        lines.append(f"| {title} | " + " | ".join(map(str, cells)) + " |")
    return "\n".join(lines)


def main():
    text = table(sys.argv[1], pathlib.Path(sys.argv[2]))
    print(text)
    if "--write" in sys.argv:
        page = ROOT / "docs/benchmarks.md"
        begin, end = "<!-- symoro: written by bench/symoro.py -->\n", "<!-- end of symoro -->"
        before, rest = page.read_text().split(begin)
        page.write_text(before + begin + text + "\n" + end + rest.split(end, 1)[1])


if __name__ == "__main__":
    main()

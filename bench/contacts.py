#!/usr/bin/env python3
"""Piles of discs: time per step and per event against the number of active contacts; the cost of open contacts.

usage: bench/contacts.py EOMGEN [DISCS ..]
Prints a table. Discs start in rows above the floor of a box and fall; the span is long enough for the lower rows to
come to rest on one another. `free`: the same discs far above the floor, with all contacts open.
"""
import json
import pathlib
import subprocess
import sys
import tempfile


def model(discs, fall, contacts=True):
    width = 0.1 * max(3, int(discs**0.5)) + 0.03
    columns = max(2, int((width - 0.02) / 0.105))
    numbers = range(1, discs + 1)
    lines = ["format = 1", 'title = "Pile of discs"', "[parameters]", 'm = "0.1 kg"', 'R = "0.05 m"', f'W = "{width:g} m"',
             'g = "9.81 m/s^2"', "e = 0.2"]
    for k in numbers:
        lines += ["[[particle]]", f'name = "d{k}"', 'mass = "m"', f'position = ["x{k}", 0, "z{k}"]']
    lines += ["[[force]]", 'gravity = "-g*E3"']
    if contacts:
        names = ", ".join(f'"d{k}"' for k in numbers)
        limits = ", ".join(f'x{k} = ["R", "W - R"]' for k in numbers)
        lines += ["[[contact]]", 'name = "pair"', f"spheres = [{names}]", 'radius = "R"', 'restitution = "e"']
        lines += ["[[contact]]", 'name = "wall"', f"limits = {{ {limits} }}", 'restitution = "e"']
        for k in numbers:
            lines += ["[[constraint]]", f'name = "floor{k}"', f'holonomic = "z{k} - R"', 'holds = "unilateral"',
                      'restitution = "e"']
    lines += ["[coordinates]"] + [f'{c}{k} = "m"' for k in numbers for c in "xz"]
    start = []
    for k in numbers:
        row, column = divmod(k - 1, columns)
        start.append(f"x{k} = {0.055 + column * 0.105 + (0.004 if row % 2 else 0):.5g}, z{k} = {fall + row * 0.11:.5g}")
    lines += ["[scene.default]", "t = [0, 0.6]", f"initial = {{ {', '.join(start)} }}"]
    return "\n".join(lines) + "\n"


def run(eomgen, text):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "pile.toml"
        path.write_text(text)
        done = subprocess.run([eomgen, "run", str(path), "--no-error-estimate", "--json"], capture_output=True, text=True)
    return json.loads(done.stdout)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    print("| discs | contacts | outcome | steps | events | us per step | free: us per step | without: us per step |")
    print("|---|---|---|---|---|---|---|---|")
    for discs in [int(argument) for argument in sys.argv[2:]] or [1, 3, 10, 20]:
        pile = run(sys.argv[1], model(discs, 0.06))
        free = run(sys.argv[1], model(discs, 10))
        without = run(sys.argv[1], model(discs, 10, contacts=False))

        def per_step(result):
            return 1e6 * result["seconds"]["integrate"] / max(1, result["steps"])

        contacts = discs * (discs - 1) // 2 + 3 * discs
        print(f"| {discs} | {contacts} | {pile['outcome']} | {pile['steps']} | "
              f"{len(pile['events'])} | {per_step(pile):.1f} | {per_step(free):.1f} | {per_step(without):.1f} |")


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Piles of discs: time per step and per event against the number of active contacts; the cost of open contacts.

usage: bench/contacts.py EOMGEN [DISCS ..]
       bench/contacts.py EOMGEN --independent [CONTACTS ..]
Prints a table. Discs start in rows above the floor of a box and fall; the span is long enough for the lower rows to
come to rest on one another. `free`: the same discs far above the floor, with all contacts open. With --independent,
balls bounce side by side on a floor, each with a contact of its own: time per step and per event, with the exponent of
the number of contacts between two rows.
"""
import json
import math
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
        if discs > 1:
            lines += ["[[contact]]", 'name = "pair"', f"spheres = [{names}]", 'radius = "R"',
                      'restitution = "e"']
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


def balls(count, contacts=True):
    """Balls side by side, whose contacts share no coordinate. Heights differ, so that impacts do not coincide."""
    lines = ["format = 1", 'title = "Balls side by side"', "[parameters]", 'm = "0.1 kg"', 'g = "9.81 m/s^2"', "e = 0.5"]
    for k in range(1, count + 1):
        lines += ["[[particle]]", f'name = "b{k}"', 'mass = "m"', f'position = [0, 0, "z{k}"]']
        if contacts:
            lines += ["[[constraint]]", f'name = "floor{k}"', f'holonomic = "z{k}"', 'holds = "unilateral"', 'restitution = "e"']
    lines += ["[[force]]", 'gravity = "-g*E3"', "[coordinates]"] + [f'z{k} = "m"' for k in range(1, count + 1)]
    if contacts:
        lines += ["[impacts]", 'law = "moreau"']  # one mechanism for every number of contacts
    start = ", ".join(f'z{k} = "{0.2 + 0.1 * k / count:.6g} m"' for k in range(1, count + 1))
    lines += ["[scene.default]", "t = [0, 0.6]", f"initial = {{ {start} }}"]
    return "\n".join(lines) + "\n"


def run(eomgen, text):
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "pile.toml"
        path.write_text(text)
        done = subprocess.run([eomgen, "run", str(path), "--no-error-estimate", "--json"], capture_output=True, text=True)
    return json.loads(done.stdout)


def independent(eomgen, counts):
    print("| contacts | outcome | steps | events | us per step | exponent | us per event | exponent |")
    print("|---|---|---|---|---|---|---|---|")
    before = None
    for count in counts:
        result = run(eomgen, balls(count))
        microseconds = 1e6 * result["seconds"]["integrate"]
        now = [microseconds / max(1, result["steps"]), microseconds / max(1, len(result["events"]))]
        exponents = ["", ""]
        if before is not None:
            exponents = [f"{math.log(b / a) / math.log(count / before[0]):.2f}" for a, b in zip(before[1], now)]
        print(f"| {count} | {result['outcome']} | {result['steps']} | {len(result['events'])} | "
              f"{now[0]:.1f} | {exponents[0]} | {now[1]:.1f} | {exponents[1]} |")
        before = (count, now)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    if sys.argv[2:3] == ["--independent"]:
        return independent(sys.argv[1], [int(argument) for argument in sys.argv[3:]] or [1, 10, 50, 100])
    print("| discs | contacts | outcome | t, s | steps | events | impacts | us per step | free: us per step | without: us per step |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for discs in [int(argument) for argument in sys.argv[2:]] or [1, 3, 10, 20]:
        pile = run(sys.argv[1], model(discs, 0.06))
        free = run(sys.argv[1], model(discs, 10))
        without = run(sys.argv[1], model(discs, 10, contacts=False))

        def per_step(result):
            return 1e6 * result["seconds"]["integrate"] / max(1, result["steps"])

        contacts = discs * (discs - 1) // 2 + 3 * discs
        impacts = sum(event.get("impacts", 1) for event in pile["events"] if event["kind"] == "contact")
        print(f"| {discs} | {contacts} | {pile['outcome']} | {pile['t']:.3g} | {pile['steps']} | "
              f"{len(pile['events'])} | {impacts} | {per_step(pile):.1f} | {per_step(free):.1f} | {per_step(without):.1f} |")


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Models of any size, as texts: those of docs/benchmarks.md, "How cost grows". Every mass, length and inertia is a separate parameter, so that nothing cancels by chance.

    python3 bench/growth_models.py FAMILY N > model.toml
"""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
HEAD = """format = 1
title = "{title}"

[parameters]
g = "9.81 m/s^2"
{parameters}
"""
GRAVITY = """
[[force]]
gravity = "-g*{up}"
"""


def parameters_of_body(k, spread):
    """Mass, length, centre of mass, principal inertias of one body of a robot."""
    return f"""m{k} = "{1 + 0.1 * (k % 7):.2f} kg"
L{k} = "{0.4 + 0.02 * (k % 5):.3f} m"
c{k} = "{0.2 + 0.01 * (k % 3):.3f} m"
A{k} = "{0.01 * spread:.4f} kg*m^2"
B{k} = "{0.02 * spread:.4f} kg*m^2"
C{k} = "{0.025 * spread:.4f} kg*m^2"
"""


def scene(initial, end=1):
    inside = ", ".join(f"{name} = {value}" for name, value in initial.items())
    return f"""
[scene.default]
t = [0, {end}]
initial = {{ {inside} }}
"""


def body(k, position, rotation, parent=None):
    relative = f'relative_to = "{parent}"\n' if parent else ""
    return f"""
[[body]]
name = "b{k}"
mass = "m{k}"
inertia = {{ principal = ["A{k}", "B{k}", "C{k}"] }}
position = "{position}"
{relative}rotation = {rotation}
"""


def point(name, position):
    return f"""
[[point]]
name = "{name}"
position = "{position}"
"""


def arm(n):
    """A serial arm of n pin joints, axes in turn along e3 and e2 of the link before, links along e1."""
    text = HEAD.format(title=f"Serial arm of {n} pin joints", parameters="".join(parameters_of_body(k, 1 + 0.1 * (k % 4)) for k in range(1, n + 1)))
    base = "origin"
    for k in range(1, n + 1):
        axis = "3" if k % 2 else "2"
        where = f"b{k - 1}.e{axis}" if k > 1 else f"E{axis}"
        text += body(k, f"{base} + c{k}*b{k}.e1" if k > 1 else f"c{k}*b{k}.e1", f'{{ axis = "{where}", angle = "q{k}" }}', f"b{k - 1}" if k > 1 else None)
        if k < n:
            text += point(f"J{k}", f"{base} + L{k}*b{k}.e1" if k > 1 else f"L{k}*b{k}.e1")
            base = f"J{k}"
    return text + GRAVITY.format(up="E3") + scene({f"q{k}": round(0.3 + 0.1 * (k % 5), 2) for k in range(1, n + 1)})


def floating(n, rotation):
    """A floating base with n joints in four branches: pins, every fifth joint a universal one (two angles), every seventh a slider."""
    text = HEAD.format(title=f"Floating base with {n} joints", parameters="".join(parameters_of_body(k, 1 + 0.1 * (k % 4)) for k in range(n + 1)))
    text += f"""
[[body]]
name = "b0"
mass = "m0"
inertia = {{ principal = ["A0", "B0", "C0"] }}
position = {{ cartesian = ["x", "y", "z"] }}
rotation = {rotation}
"""
    ends = [("b0", s) for s in ("b0 + L0*b0.e1", "b0 - L0*b0.e1", "b0 + L0*b0.e2", "b0 - L0*b0.e2")]
    initial = {"x": 0, "y": 0, "z": 1}
    frames = joints = k = 0
    while joints < n:
        k += 1
        parent, base = ends[(k - 1) % 4]
        axis = k // 4 % 2 + 2
        initial[f"q{k}"] = round(0.2 + 0.05 * (k % 5), 2)
        if k % 7 == 0:  # slides along an axis of its parent
            text += f"""
[coordinates]
q{k} = "m"
""" if "[coordinates]" not in text else ""
            text = text if f'\nq{k} = "m"' in text else text.replace("[coordinates]\n", f"[coordinates]\nq{k} = \"m\"\n")
            text += body(k, f"{base} + (c{k} + q{k})*b{k}.e1", "{ fixed = true }", parent)
            joints += 1
        elif k % 5 == 0 and joints + 2 <= n:
            frames += 1
            text += f"""
[[frame]]
name = "f{frames}"
relative_to = "{parent}"
rotation = {{ axis = "{parent}.e3", angle = "q{k}" }}
"""
            initial[f"u{frames}"] = 0.1
            text += body(k, f"{base} + c{k}*b{k}.e1", f'{{ axis = "f{frames}.e2", angle = "u{frames}" }}', f"f{frames}")
            joints += 2
        else:
            text += body(k, f"{base} + c{k}*b{k}.e1", f'{{ axis = "{parent}.e{axis}", angle = "q{k}" }}', parent)
            joints += 1
        end = f"{base} + L{k}*b{k}.e1"
        if len(end) > 120:  # a separate name keeps expressions short
            text += point(f"P{k}", end)
            end = f"P{k}"
        ends[(k - 1) % 4] = (f"b{k}", end)
    text = "\n".join(line for line in text.split("\n") if not any(line.startswith(f"{letter}{unused} = ") for letter in "mLcABC" for unused in range(k + 1, n + 1)))
    return text + GRAVITY.format(up="E3") + scene(initial)


def floating_parameters(n):
    return floating(n, '{ euler_parameters = ["e0", "e1", "e2", "e3"] }')


def floating_angles(n):
    return floating(n, '{ euler = "321", angles = ["psi", "theta", "phi"] }')


def chain(n):
    """A planar chain of n particles on rods, every mass and length its own."""
    numbers = "".join(f'm{k} = "{1 + 0.1 * (k % 7):.2f} kg"\nL{k} = "{0.4 + 0.02 * (k % 5):.3f} m"\n' for k in range(1, n + 1))
    names = lambda letter: "[" + ", ".join(f'"{letter}{k}"' for k in range(1, n + 1)) + "]"
    return HEAD.format(title=f"Planar chain of {n} particles", parameters=numbers) + f"""
[[chain]]
name = "P"
n = {n}
mass = {names("m")}
length = {names("L")}
""" + GRAVITY.format(up="E2") + scene({f"theta{k}": round(0.3 + 0.05 * (k % 5), 2) for k in range(1, n + 1)})


def n_four_bar(n):
    return subprocess.run([ROOT / "scripts" / "n-four-bar", str(n)], check=True, capture_output=True, text=True).stdout


def beam(n):
    """A beam of n rods given by its energies alone: particles of mass m at the joints, springs in them."""
    definitions, squares = "", []
    for k in range(1, n + 1):
        before = (f"x{k - 1} + ", f"y{k - 1} + ") if k > 1 else ("", "")
        definitions += f'x{k} = "{before[0]}h*cos(th{k})"\ny{k} = "{before[1]}h*sin(th{k})"\n'
        squares.append(f"ddt(x{k})^2 + ddt(y{k})^2")
    bends = ["th1^2"] + [f"(th{k} - th{k - 1})^2" for k in range(2, n + 1)]
    coordinates = "".join(f'th{k} = "rad"\n' for k in range(1, n + 1))
    return f"""format = 1
title = "Beam of {n} rods by its energies"

[parameters]
m = "0.1 kg"
h = "0.1 m"
K = "100 N*m"

[coordinates]
{coordinates}
[definitions]
{definitions}
[energy]
kinetic = "m/2*({" + ".join(squares)})"
potential = "K/2*({" + ".join(bends)})"
""" + scene({f"th{k}": round(0.01 * k, 3) for k in range(1, n + 1)}, 0.1)


def rods(n):
    """n rods in space on one another by conical joints (two angles each)."""
    numbers = "".join(f'm{k} = "{1 + 0.1 * k:.1f} kg"\nL{k} = "{0.5 + 0.1 * k:.1f} m"\nJ{k} = "{0.02 * k:.2f} kg*m^2"\n' for k in range(1, n + 1))
    text, base = HEAD.format(title=f"{n} rods in space on conical joints", parameters=numbers), ""
    for k in range(1, n + 1):
        text += f"""
[[body]]
name = "b{k}"
mass = "m{k}"
inertia = {{ principal = ["J{k}", "J{k}", 0] }}
position = "{base}L{k}/2*b{k}.e3"
rotation = {{ euler = "313", angles = ["a{k}", "b_{k}", 0] }}
"""
        base += f"L{k}*b{k}.e3 + "
    initial = {f"a{k}": 0.1 * k for k in range(1, n + 1)} | {f"b_{k}": 0.5 + 0.2 * k for k in range(1, n + 1)}
    return text + GRAVITY.format(up="E3") + scene({name: round(value, 2) for name, value in initial.items()})


def free_particles(n):
    text = HEAD.format(title=f"{n} free particles", parameters='m = "1 kg"')
    for k in range(1, n + 1):
        text += f"""
[[particle]]
name = "P{k}"
mass = "m"
position = {{ cartesian = ["x{k}", "y{k}", "z{k}"] }}
"""
    return text + GRAVITY.format(up="E3") + scene({"x1": 1})


def gravitating(n):
    """n particles that attract one another."""
    text = HEAD.format(title=f"{n} bodies that gravitate", parameters='G = "1 m^3/(kg*s^2)"\n' + "".join(f'm{k} = "{1 + 0.1 * (k % 7):.2f} kg"\n' for k in range(1, n + 1))).replace('g = "9.81 m/s^2"\n', "")
    for k in range(1, n + 1):
        text += f"""
[[particle]]
name = "P{k}"
mass = "m{k}"
position = {{ cartesian = ["x{k}", "y{k}", "z{k}"] }}
"""
    initial = {}
    for k in range(1, n + 1):
        initial |= {f"x{k}": k, f"y{k}": k * k % 11, f"z{k}": k**3 % 13}
    return text + """
[[force]]
gravitation = { G = "G" }
""" + scene(initial)


FAMILIES = {
    "arm": arm,
    "floating_parameters": floating_parameters,
    "floating_angles": floating_angles,
    "chain": chain,
    "n_four_bar": n_four_bar,
    "beam": beam,
    "rods": rods,
    "free_particles": free_particles,
    "gravitating": gravitating,
}

if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in FAMILIES:
        sys.exit(f"usage: growth_models.py {'|'.join(FAMILIES)} N")
    print(FAMILIES[sys.argv[1]](int(sys.argv[2])), end="")

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Imports every URDF file of a folder and prints a table: coordinates, operations, time, agreement.

    bench/robots.py PROGRAM FOLDER [--floating]
    bench/robots.py PROGRAM FOLDER --beside [--write]

The second form prints forward dynamics of URDF and MJCF files beside other programs (bench/robots_beside.py). With --write
the table in docs/benchmarks.md is replaced.
`differs` is the largest difference of the emitted accelerations from a Newton-Euler recursion on the XML tree, which is
part of this file and shares nothing with the generator, relative to the largest acceleration of each state.
"""
import argparse
import ctypes
import json
import math
import pathlib
import random
import subprocess
import tempfile
import time
import xml.etree.ElementTree as ET

STATES = 20
CALLS = 20000
GRAVITY = 9.81
SMOOTH = {"angle": 0.01, "length": 0.001}  # widths of the smooth law of friction


def dot(a, b): return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
def add(a, b, s=1.0): return [a[i] + s * b[i] for i in range(3)]
def cross(a, b): return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
def times(R, v): return [dot(row, v) for row in R]
def transposed(R): return [list(column) for column in zip(*R)]
def product(A, B): return transposed([times(A, column) for column in transposed(B)])


def about(n, angle):
    """Rodrigues' formula."""
    length = math.sqrt(dot(n, n))
    n = [x / length for x in n]
    c, s = math.cos(angle), math.sin(angle)
    columns = []
    for k in range(3):
        e = [float(i == k) for i in range(3)]
        columns.append(add(add([c * x for x in e], cross(n, e), s), n, (1 - c) * n[k]))
    return transposed(columns)


def by_rpy(rpy): return product(about([0, 0, 1], rpy[2]), product(about([0, 1, 0], rpy[1]), about([1, 0, 0], rpy[0])))
def numbers(element, name, default): return [float(x) for x in (element.get(name) if element is not None and element.get(name) else default).split()]


def multiple_of_pi(angle):
    """As the import does with decimals of many digits."""
    k = round(angle / (math.pi / 12))
    return k * math.pi / 12 if abs(angle - k * math.pi / 12) < 1e-9 else angle


def pose(element):
    origin = element.find("origin") if element is not None else None
    return numbers(origin, "xyz", "0 0 0"), by_rpy([multiple_of_pi(a) for a in numbers(origin, "rpy", "0 0 0")])


class Robot:
    """Joints, parents first: (type, parent, place, axes, axis, mass, centre, tensor, damping, friction)."""

    def __init__(self, path, floating):
        root = ET.parse(path).getroot()
        links = {link.get("name"): link for link in root.findall("link")}
        joints = [joint for joint in root.findall("joint") if joint.find("child") is not None]
        above = {joint.find("child").get("link"): joint for joint in joints}
        base = next(name for name in links if name not in above)
        self.joints, self.names, self.mimics = [], [], {}
        identity = by_rpy([0, 0, 0])
        place = {base: -1}
        if floating:
            for name, kind, axis in zip(["x", "y", "z", "yaw", "pitch", "roll"], ["prismatic"] * 3 + ["revolute"] * 3,
                                        [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 1], [0, 1, 0], [1, 0, 0]]):
                inertia = self.inertia(links[base]) if name == "roll" else (0.0, [0, 0, 0], [[0] * 3] * 3)
                self.joints.append((kind, len(self.joints) - 1, [0, 0, 0], identity, axis, *inertia, 0.0, 0.0))
                self.names.append("base_" + name)
            place[base] = 5
        waiting = [base]
        while waiting:
            link = waiting.pop(0)
            for joint in joints:
                if joint.find("parent").get("link") != link:
                    continue
                child, kind = joint.find("child").get("link"), joint.get("type")
                dynamics, mimic = joint.find("dynamics"), joint.find("mimic")
                axis = numbers(joint.find("axis"), "xyz", "1 0 0")
                place[child] = len(self.joints)
                self.joints.append((kind, place[link], *pose(joint), axis, *self.inertia(links[child]),
                                    numbers(dynamics, "damping", "0")[0], numbers(dynamics, "friction", "0")[0]))
                self.names.append(joint.get("name"))
                if mimic is not None and kind != "fixed":
                    self.mimics[joint.get("name")] = (mimic.get("joint"), float(mimic.get("multiplier") or 1),
                                                      float(mimic.get("offset") or 0))
                waiting.append(child)
        self.moving = [i for i, joint in enumerate(self.joints) if joint[0] != "fixed"]
        self.coordinates = [self.names[i] for i in self.moving]

    @staticmethod
    def inertia(link):
        inertial = link.find("inertial")
        if inertial is None:
            return 0.0, [0, 0, 0], [[0] * 3] * 3
        centre, A = pose(inertial)
        J = {key: float(value) for key, value in inertial.find("inertia").attrib.items()}
        entry = lambda key: J.get(key, 0.0)
        tensor = [[entry("ixx"), entry("ixy"), entry("ixz")], [entry("ixy"), entry("iyy"), entry("iyz")],
                  [entry("ixz"), entry("iyz"), entry("izz")]]
        return float(inertial.find("mass").get("value")), centre, product(A, product(tensor, transposed(A)))

    def forces(self, q, qdot, qddot, g, dissipation):
        motions, F, N = [], [], []
        index = {i: k for k, i in enumerate(self.moving)}
        for i, (kind, parent, xyz, R0, axis, mass, centre, tensor, _, _) in enumerate(self.joints):
            R, p, w, wd, vd = motions[parent][:5] if parent >= 0 else (by_rpy([0, 0, 0]), [0, 0, 0], [0, 0, 0], [0, 0, 0], [0, 0, g])
            arm = times(R, xyz)
            R = product(R, R0)
            n = times(R, axis)
            length = math.sqrt(dot(n, n)) or 1.0
            n = [x / length for x in n]
            k = index.get(i)
            if kind == "prismatic":
                arm = add(arm, n, q[k])
            p = add(p, arm)
            vd = add(add(vd, cross(wd, arm)), cross(w, cross(w, arm)))
            if kind == "prismatic":
                vd = add(add(vd, cross(w, n), 2 * qdot[k]), n, qddot[k])
            elif k is not None:
                R = product(R, about(axis, q[k]))
                wd = add(add(wd, cross(w, n), qdot[k]), n, qddot[k])
                w = add(w, n, qdot[k])
            c = times(R, centre)
            inertia = product(R, product(tensor, transposed(R)))
            a = add(add(vd, cross(wd, c)), cross(w, cross(w, c)))
            F.append([mass * x for x in a])
            N.append(add(add(times(inertia, wd), cross(w, times(inertia, w))), cross(add(p, c), F[-1])))
            motions.append((R, p, w, wd, vd, n))
        result = [0.0] * len(self.moving)
        for i in reversed(range(len(self.joints))):
            kind, parent, p, n, k = self.joints[i][0], self.joints[i][1], motions[i][1], motions[i][5], index.get(i)
            if k is not None:
                result[k] = dot(n, F[i]) if kind == "prismatic" else dot(n, add(N[i], cross(p, F[i]), -1))
                if dissipation:
                    width = SMOOTH["length" if kind == "prismatic" else "angle"]
                    result[k] += self.joints[i][8] * qdot[k] + self.joints[i][9] * qdot[k] / math.hypot(qdot[k], width)
            if parent >= 0:
                F[parent], N[parent] = add(F[parent], F[i]), add(N[parent], N[i])
        return result

    def accelerations(self, q, qdot):
        """Reduced by the mimics: q = G q_free."""
        n = len(self.moving)
        free = [k for k in range(n) if self.coordinates[k] not in self.mimics]
        G = [[0.0] * len(free) for _ in range(n)]
        for k in range(n):
            factor, name = 1.0, self.coordinates[k]
            while name in self.mimics:
                factor *= self.mimics[name][1]
                name = self.mimics[name][0]
            G[k][free.index(self.coordinates.index(name))] = factor
        zero = [0.0] * n
        h = self.forces(q, qdot, zero, GRAVITY, True)
        columns = [self.forces(q, zero, [G[k][c] for k in range(n)], 0.0, False) for c in range(len(free))]
        rows = [[sum(G[k][r] * columns[c][k] for k in range(n)) for c in range(len(free))] +
                [-sum(G[k][r] * h[k] for k in range(n))] for r in range(len(free))]
        m = len(free)
        for k in range(m):
            for i in range(k + 1, m):
                s = rows[i][k] / rows[k][k]
                rows[i] = [x - s * y for x, y in zip(rows[i], rows[k])]
        x = [0.0] * m
        for k in reversed(range(m)):
            x[k] = (rows[k][m] - sum(rows[k][j] * x[j] for j in range(k + 1, m))) / rows[k][k]
        return [dot_all(G[k], x) for k in range(n)]

    def complete(self, q, offset):
        """Values of joints that follow others."""
        values = dict(zip(self.coordinates, q))
        def value(name):
            if name not in self.mimics:
                return values[name]
            master, factor, shift = self.mimics[name]
            return factor * value(master) + (shift if offset else 0.0)
        return [value(name) for name in self.coordinates]


def dot_all(a, b): return sum(x * y for x, y in zip(a, b))


def measure(program, path, floating, folder):
    model = folder / (path.stem + ".toml")
    imported = json.loads(subprocess.run([program, "import", path, "-o", model, "--json"] + (["--floating"] if floating else []),
                                         check=True, capture_output=True, text=True).stdout)
    begin = time.perf_counter()
    emitted = subprocess.run([program, "emit", model, "--target", "c", "-o", folder / path.stem, "--json"],
                             capture_output=True, text=True)
    derived = time.perf_counter() - begin
    if emitted.returncode != 0:
        raise RuntimeError(emitted.stderr)
    emission = json.loads(emitted.stdout)
    name = subprocess.run([program, "emit", model, "--print-name"], check=True, capture_output=True, text=True).stdout.strip()
    library = folder / (name + ".so")
    subprocess.run(["cc", "-O3", "-march=native", "-ffp-contract=off", "-shared", "-fPIC", folder / path.stem / (name + ".c"),
                    "-o", library, "-lm"], check=True)
    code = ctypes.CDLL(str(library))
    robot = Robot(path, floating)
    order = [robot.coordinates.index(coordinate) for coordinate in imported["coordinates"]]
    held = [k for k in range(len(robot.coordinates)) if k not in order]
    if held:
        raise RuntimeError("a joint is held, which the recursion has not")
    n = len(order)
    x, dx, p = (ctypes.c_double * (2 * n))(), (ctypes.c_double * (2 * n))(), (ctypes.c_double * 1000)()
    getattr(code, name + "_defaults")(x, p)
    rhs = getattr(code, name + "_rhs")
    rhs.argtypes = [ctypes.c_double] + [ctypes.c_void_p] * 3 + [ctypes.c_void_p] * 2
    generator = random.Random(3)
    worst = 0.0
    for _ in range(STATES):
        q = robot.complete([generator.uniform(-1, 1) for _ in robot.coordinates], True)
        qdot = robot.complete([generator.uniform(-1, 1) for _ in robot.coordinates], False)
        expected = robot.accelerations(q, qdot)
        x[:] = [q[k] for k in order] + [qdot[k] for k in order]
        if rhs(0.0, x, p, None, None, dx) != 0:
            raise RuntimeError("the right-hand side has no value")
        scale = max(abs(a) for a in expected)
        worst = max(worst, max(abs(dx[n + i] - expected[k]) for i, k in enumerate(order)) / scale)
    loop = folder / "loop.c"
    loop.write_text(f"int {name}_rhs(double, const double*, const double*, const double*, const int*, double*);\n"
                    f"void many(double* x, double* p, double* dx, int n) {{ for (int i = 0; i < n; ++i) {{ {name}_rhs(0, x, p, 0, 0, dx); x[0] += 1e-9 * dx[0]; }} }}\n")
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", loop, library, "-o", folder / (name + "_loop.so"), "-Wl,-rpath," + str(folder)], check=True)
    many = ctypes.CDLL(str(folder / (name + "_loop.so"))).many
    seconds = []
    for _ in range(5):
        begin = time.perf_counter()
        many(x, p, dx, CALLS)
        seconds.append(time.perf_counter() - begin)
    run = time.perf_counter()
    finished = subprocess.run([program, "run", model, "--t-end", "0.1", "--json"], capture_output=True, text=True)
    run = time.perf_counter() - run
    outcome = json.loads(finished.stdout)["outcome"] if finished.returncode in (0, 3) else "refused"
    operations = emission["operations"]
    return (f"| {path.stem} | {imported['links']} | {n} | {emission['formulation']} | {sum(operations.values())} | "
            f"{1e9 * sorted(seconds)[2] / CALLS:.0f} | {worst:.1e} | {derived:.2f} | {run:.2f} | {outcome} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--floating", action="store_true")
    parser.add_argument("--beside", action="store_true", help="beside other programs for rigid bodies")
    parser.add_argument("--write", action="store_true", help="with --beside: into docs/benchmarks.md")
    options = parser.parse_args()
    if options.beside:
        import robots_beside
        return robots_beside.table(options.program, options.folder, options.write)
    print("| robot | links | coordinates | formulation | operations | ns | differs | emit s | run s | outcome |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as scratch:
        for path in sorted(options.folder.glob("*.urdf")):
            try:
                print(measure(options.program, path, options.floating, pathlib.Path(scratch)), flush=True)
            except (RuntimeError, subprocess.CalledProcessError) as error:
                print(f"| {path.stem} | failed: {str(error).splitlines()[0]} |", flush=True)


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Forward dynamics of robot files, emitted by eomgen and computed by other programs, in one run. Used by bench/robots.py.

All without contacts, limits and friction of joints; a joint that follows another is free. The others get the robot at its
simplest: a URDF file without shapes, links on fixed joints merged into those that move, angles in all digits. The programs
get the same random states; `differs` is relative to the largest acceleration of each state. ENGINES is the registry: one
entry for each program, with its source in bench/engines. A program that is not installed is left out by name. Flags for
one outside the folders of the system are in the environment: PINOCCHIO_CXXFLAGS="-I/opt/pinocchio/include".
"""
import json
import math
import os
import pathlib
import random
import shlex
import subprocess
import tempfile
import typing
import xml.etree.ElementTree as ET

import growth
import robots

BEGIN, END = "<!-- robots beside: written by bench/robots.py -->", "<!-- end of robots beside -->"
STATES = 20
SOURCES = pathlib.Path(__file__).parent / "engines"
NATIVE = ["-O3", "-march=native", "-ffp-contract=off"]
GENERIC = ["-O2"]  # the processor that packages of Debian are compiled for
HEADER_ONLY = ("-std=c++17", "-O3", "-march=native", "-DNDEBUG", "-w")


class Engine(typing.NamedTuple):
    name: str
    source: str
    header: str  # a program is installed if its header is found
    package: str  # of pkg-config; "" without one
    libraries: list
    file: str  # the kind of file that it reads: a key of FILES
    flags: tuple = ("-std=c++17", "-O3", "-DNDEBUG")


ENGINES = [
    Engine("MuJoCo", "mujoco.cpp", "mujoco/mujoco.h", "", ["-lmujoco"], "urdf"),
    Engine("DART", "dart.cpp", "dart/utils/urdf/DartLoader.hpp", "dart", ["-ldart-utils-urdf"], "urdf"),
    Engine("Simbody", "simbody.cpp", "Simbody.h", "simbody", [], "links",
           ("-std=c++11", "-O3")),  # objects of Debian's library have another layout with NDEBUG
    Engine("Pinocchio", "pinocchio.cpp", "pinocchio/config.hpp", "pinocchio", [], "links", HEADER_ONLY),
    Engine("RBDL", "rbdl.cpp", "rbdl/rbdl.h", "rbdl", ["-lrbdl_urdfreader"], "urdf"),
]


def call(*command, text=None):
    result = subprocess.run([str(word) for word in command], input=text, capture_output=True, text=True)
    if result.returncode != 0:
        raise RuntimeError((result.stderr.strip() or f"{command[0]} failed").splitlines()[-1])
    return result.stdout


def flags_of(engine):
    """Those of the environment, or else of pkg-config."""
    given = os.environ.get(engine.name.upper() + "_CXXFLAGS")
    if given or not engine.package:
        return shlex.split(given or "")
    result = subprocess.run(["pkg-config", "--cflags", "--libs", engine.package], capture_output=True, text=True)
    flags = shlex.split(result.stdout) if result.returncode == 0 else []
    # Instances of Pinocchio's templates in its library are not compiled for this processor.
    return [flag for flag in flags if not flag.startswith(("-std", "-DPINOCCHIO_ENABLE_TEMPLATE_INSTANTIATION"))]


def compiled(engine, folder):
    """The program, or None if it is not installed."""
    flags = flags_of(engine)
    probe = subprocess.run(["c++", *flags, "-E", "-x", "c++", "-"], input=f"#include <{engine.header}>\n", capture_output=True, text=True)
    if probe.returncode != 0:
        return None
    # -march=native changes the layout of Eigen's objects: only for programs without an installed library.
    target = folder / pathlib.Path(engine.source).stem
    call("c++", *engine.flags, SOURCES / engine.source, "-o", target, *flags, *engine.libraries)
    return target


def emitted(source, name, flags, target):
    call("cc", *flags, "-c", source, "-o", target.with_suffix(".o"))
    call("c++", "-std=c++17", "-O2", f"-DMODEL_rhs={name}_rhs", f"-DMODEL_defaults={name}_defaults", SOURCES / "eomgen.cpp",
         target.with_suffix(".o"), "-o", target, "-lm")
    return target


class Link(typing.NamedTuple):
    """A link that moves: joint, index of the link before, place and axes of the joint in it, inertia about the centre."""
    name: str
    kind: str
    parent: int
    place: list
    axes: list
    axis: list
    mass: float
    centre: list
    tensor: list
    damping: float


def steiner(mass, d):
    square = robots.dot(d, d)
    return [[mass * ((square if i == k else 0.0) - d[i] * d[k]) for k in range(3)] for i in range(3)]


def matrix_sum(*matrices):
    return [[sum(m[i][k] for m in matrices) for k in range(3)] for i in range(3)]


def merged(a, b):
    """The mass, centre and tensor of two bodies."""
    mass = a[0] + b[0]
    if mass == 0:
        return a
    centre = robots.add([a[0] / mass * x for x in a[1]], b[1], b[0] / mass)
    return mass, centre, matrix_sum(a[2], b[2], *(steiner(m, robots.add(c, centre, -1)) for m, c, _ in (a, b)))


def depth_first(links):
    """The same links, each branch in one piece: Pinocchio's algorithms assume it."""
    order = []

    def append_branches_of(parent):
        for i, link in enumerate(links):
            if link.parent == parent:
                order.append(i)
                append_branches_of(i)

    append_branches_of(-1)
    place = {-1: -1} | {i: k for k, i in enumerate(order)}
    return [links[i]._replace(parent=place[links[i].parent]) for i in order]


def links_of(path, floating=False):
    """The links that move, depth first, with all that is fixed to them. The base of a floating robot has six joints."""
    robot = robots.Robot(path, floating)
    links, frames = [], []  # frames: of each joint of the file, the moving link and the pose in it
    for name, (kind, parent, place, axes, axis, mass, centre, tensor, damping, _) in zip(robot.names, robot.joints):
        owner, R, p = frames[parent] if parent >= 0 else (-1, robots.by_rpy([0, 0, 0]), [0, 0, 0])
        R, p = robots.product(R, axes), robots.add(p, robots.times(R, place))
        if kind != "fixed":
            length = robots.dot(axis, axis) ** 0.5
            links.append(Link(name, kind, owner, p, R, [x / length for x in axis], mass, centre, tensor, damping))
            frames.append((len(links) - 1, robots.by_rpy([0, 0, 0]), [0, 0, 0]))
            continue
        frames.append((owner, R, p))
        if owner >= 0:
            here = mass, robots.add(p, robots.times(R, centre)), robots.product(R, robots.product(tensor, robots.transposed(R)))
            link = links[owner]
            mass, centre, tensor = merged((link.mass, link.centre, link.tensor), here)
            links[owner] = link._replace(mass=mass, centre=centre, tensor=tensor)
    return depth_first(links)


def numbers(values):
    return " ".join(repr(float(x)) for x in values)


def rpy_of(R):
    across = math.hypot(R[0][0], R[1][0])
    pitch = math.atan2(-R[2][0], across)
    if across < 1e-9:  # of roll and yaw only the difference or the sum is determined
        return [math.atan2(math.copysign(1, pitch) * R[0][1], R[1][1]), pitch, 0.0]
    return [math.atan2(R[2][1], R[2][2]), pitch, math.atan2(R[1][0], R[0][0])]


def write_urdf(links, path):
    """A link has the name of its joint."""
    root = ET.Element("robot", name="robot")
    ET.SubElement(root, "link", name="ground")
    for link in links:
        element = ET.SubElement(ET.SubElement(root, "link", name=link.name), "inertial")
        ET.SubElement(element, "origin", xyz=numbers(link.centre), rpy="0 0 0")
        ET.SubElement(element, "mass", value=repr(link.mass))
        entries = {f"i{'xyz'[i]}{'xyz'[k]}": repr(link.tensor[i][k]) for i in range(3) for k in range(i, 3)}
        ET.SubElement(element, "inertia", entries)
        joint = ET.SubElement(root, "joint", name=link.name, type="prismatic" if link.kind == "prismatic" else "continuous")
        ET.SubElement(joint, "origin", xyz=numbers(link.place), rpy=numbers(rpy_of(link.axes)))
        ET.SubElement(joint, "parent", link=links[link.parent].name if link.parent >= 0 else "ground")
        ET.SubElement(joint, "child", link=link.name)
        ET.SubElement(joint, "axis", xyz=numbers(link.axis))
        if link.kind == "prismatic":
            ET.SubElement(joint, "limit", lower="-100", upper="100", effort="1e9", velocity="1e9")
        ET.SubElement(joint, "dynamics", damping=repr(link.damping))
    ET.ElementTree(root).write(path)


def write_links(links, path):
    """Lines of numbers, as bench/engines/simbody.cpp and pinocchio_model.hpp read them."""
    with path.open("w") as file:
        for link in links:
            J = matrix_sum(link.tensor, steiner(link.mass, link.centre))
            values = [*link.place, *[x for row in link.axes for x in row], *link.axis, link.mass, *link.centre,
                      *[J[i][k] for i, k in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]]
            kind = "slider" if link.kind == "prismatic" else "pin"
            file.write(f"{link.name} {kind} {link.parent} {numbers(values)}\n")


FILES = {"urdf": write_urdf, "links": write_links}


def without_mimics(path, folder):
    """The file with all of its joints free."""
    tree = ET.parse(path)
    for joint in tree.getroot().iter("joint"):
        for mimic in joint.findall("mimic"):
            joint.remove(mimic)
    tree.write(folder / path.name)
    return folder / path.name


def legal(name):
    return "".join(c if c.isalnum() or c == "_" else "_" for c in name)


def results(command, states):
    lines = call(*command, text="\n".join(numbers(state) for state in states)).strip().split("\n")
    return [[float(v) for v in line.split()] for line in lines[:-1]], float(lines[-1])


def difference(ours, theirs):
    return max(max(abs(a - b) for a, b in zip(one, other)) / max(abs(a) for a in one) for one, other in zip(ours, theirs))


def row(program, path, folder, engines):
    is_urdf = path.suffix == ".urdf"
    robot = without_mimics(path, folder) if is_urdf else path
    model = folder / (legal(path.stem) + ".toml")
    imported = json.loads(call(program, "import", robot, "-o", model, "--friction", "none", "--json"))
    document = json.loads(call(program, "emit", model, "--target", "c", "-o", folder / path.stem, "--json"))
    name = call(program, "emit", model, "--print-name").strip()
    n = len(imported["coordinates"])
    links = links_of(robot) if is_urdf else []
    names = [link.name for link in links] or [joint.get("name") for joint in ET.parse(path).getroot().iter("joint") if joint.get("name")]
    joints = [next((name for name in names if q in (name, legal(name), legal(name) + "_joint")), q) for q in imported["coordinates"]]
    damping = {link.name: link.damping for link in links}
    rest = [*joints, *(repr(damping.get(joint, 0.0)) for joint in joints)]
    for kind, write in FILES.items():
        write(links, folder / f"robot.{kind}")
    generator = random.Random(3)
    states = [[generator.uniform(-1, 1) for _ in range(2 * n)] for _ in range(STATES)]
    cells = [path.stem, n, sum(document["operations"].values())]
    expected = None
    for flags in (NATIVE, GENERIC):
        own = emitted(folder / path.stem / (name + ".c"), name, flags, folder / "own")
        accelerations, ns = results([own, STATES, n, "-", *rest], states)
        expected = expected or accelerations
        cells.append(f"{ns:.0f}")
    notes = []
    for engine, other in engines:
        file = folder / f"robot.{engine.file}" if is_urdf else path
        if not is_urdf and engine.name != "MuJoCo":
            cells += ["", ""]
            continue
        try:
            theirs, ns = results([other, STATES, n, file, *rest], states)
            cells += [f"{ns:.0f}", f"{difference(expected, theirs):.0e}"]
        except RuntimeError as error:
            cells += ["", "refused"]
            notes.append(f"{engine.name} refuses {path.stem}: {error}")
    return "| " + " | ".join(str(cell) for cell in cells) + " |", notes


def lines(program, folder):
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        programs = [(engine, compiled(engine, scratch)) for engine in ENGINES]
        engines = [(engine, other) for engine, other in programs if other]
        heads = ["robot", "coordinates", "operations", "eomgen", "eomgen -O2"]
        for engine, _ in engines:
            heads += [engine.name, "differs"]
        yield "| " + " | ".join(heads) + " |"
        yield "|---" + "|---:" * (len(heads) - 1) + "|"
        remarks = []
        for path in sorted([*folder.glob("*.urdf"), *folder.glob("*.xml")]):
            try:
                line, notes = row(program, path, scratch, engines)
                remarks += notes
                yield line
            except RuntimeError as error:
                yield f"| {path.stem} | failed: {error} |"
        remarks += [f"{engine.name} is not installed" for engine, other in programs if not other]
        if remarks:
            yield ""
            yield from (f"- {remark}." for remark in remarks)


def table(program, folder, write):
    found = []
    for line in lines(program, folder):
        print(line, flush=True)
        found.append(line)
    if write:
        growth.write(BEGIN, END, found)

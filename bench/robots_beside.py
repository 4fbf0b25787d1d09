# SPDX-License-Identifier: GPL-3.0-or-later
"""Forward dynamics of robot files, emitted by eomgen and computed by MuJoCo, in one run. Used by bench/robots.py.

All without contacts, limits and friction of joints: `qacc_smooth` of MuJoCo. Robots have joints with one coordinate and
no joint that follows another. The programs get the same random states; `differs` is relative to the largest acceleration
of each state. A program that is not installed has an empty column.
"""
import json
import pathlib
import random
import subprocess
import tempfile
import xml.etree.ElementTree as ET

STATES = 20
CALLS = 2000

LOOP = """
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
enum { RUNS = 25 };
static double now(void) { struct timespec t; clock_gettime(CLOCK_MONOTONIC, &t); return t.tv_sec + 1e-9 * t.tv_nsec; }
static int by_value(const void* a, const void* b) { double d = *(const double*)a - *(const double*)b; return (d > 0) - (d < 0); }
/* Prints the shortest mean time of a call in ns among runs, which other programs disturb least. */
#define MEASURE(call) { double s[RUNS]; for (int r = 0; r < RUNS; ++r) { double begin = now(); \\
  for (int i = 0; i < calls; ++i) { call; } s[r] = (now() - begin) / calls; } \\
  qsort(s, RUNS, sizeof *s, by_value); printf("%.17g\\n", 1e9 * s[0]); }
"""

EOMGEN = LOOP + """
int NAME_rhs(double, const double*, const double*, const double*, const int*, double*);
int NAME_defaults(double* x, double* p);
int main(int argc, char** argv) {
  int states = atoi(argv[1]), calls = atoi(argv[2]), n = atoi(argv[3]);
  double *x = calloc(2 * n, sizeof *x), *dx = calloc(2 * n, sizeof *x), *p = calloc(1000, sizeof *p), *u = calloc(1000, sizeof *u);
  NAME_defaults(x, p);
  for (int s = 0; s < states; ++s) {
    for (int i = 0; i < 2 * n; ++i) if (scanf("%lf", &x[i]) != 1) return 1;
    if (NAME_rhs(0, x, p, u, 0, dx) != 0) return 1;
    for (int i = 0; i < n; ++i) printf("%.17g ", dx[n + i]);
    printf("\\n");
  }
  MEASURE(NAME_rhs(0, x, p, u, 0, dx); x[0] += 1e-9 * dx[0])
  return argc < 4;
}
"""

MUJOCO = LOOP + """
#include <mujoco/mujoco.h>
/* qacc_smooth: no contacts, no limits, no sensors. */
static void forward(const mjModel* m, mjData* d) {
  mj_kinematics(m, d);
  mj_comPos(m, d);
  mj_crb(m, d);
  mj_factorM(m, d);
  mj_comVel(m, d);
  mj_passive(m, d);
  mj_rne(m, d, 0, d->qfrc_bias);
  for (int i = 0; i < m->nv; ++i) d->qfrc_smooth[i] = d->qfrc_passive[i] - d->qfrc_bias[i];
  mj_solveM(m, d, d->qacc_smooth, d->qfrc_smooth, 1);
}
int main(int argc, char** argv) {
  int states = atoi(argv[1]), calls = atoi(argv[2]);
  char error[500] = "";
  mjModel* m = mj_loadXML(argv[4], NULL, error, sizeof error);
  if (m == NULL) { fprintf(stderr, "%s\\n", error); return 1; }
  mjData* d = mj_makeData(m);
  if (m->nq != m->nv || m->neq > 0) { fprintf(stderr, "free joints or equalities\\n"); return 1; }
  int* place = calloc(m->nv, sizeof *place);
  for (int i = 0; i < m->nv; ++i) {
    place[i] = mj_name2id(m, mjOBJ_JOINT, argv[5 + i]);
    if (i + 5 >= argc || place[i] < 0) { fprintf(stderr, "no joint %s\\n", argv[5 + i]); return 1; }
  }
  for (int s = 0; s < states; ++s) {
    for (int k = 0; k < 2; ++k)
      for (int i = 0; i < m->nv; ++i) {
        double value;
        if (scanf("%lf", &value) != 1) return 1;
        if (k == 0) d->qpos[m->jnt_qposadr[place[i]]] = m->qpos0[m->jnt_qposadr[place[i]]] + value;
        else d->qvel[m->jnt_dofadr[place[i]]] = value;
      }
    forward(m, d);
    for (int i = 0; i < m->nv; ++i) printf("%.17g ", d->qacc_smooth[m->jnt_dofadr[place[i]]]);
    printf("\\n");
  }
  MEASURE(forward(m, d); d->qpos[0] += 1e-9 * d->qacc_smooth[0])
  return 0;
}
"""


def compiled(source, folder, name, *options):
    """The program, or None if its library is not installed."""
    file = folder / (name + ".c")
    file.write_text(source)
    result = subprocess.run(["cc", "-O3", "-march=native", "-ffp-contract=off", "-o", folder / name, file, *options],
                            capture_output=True, text=True)
    return folder / name if result.returncode == 0 else None


def for_mujoco(path, folder):
    """The file as MuJoCo reads it: URDF without shapes, whose files are not at hand."""
    if path.suffix != ".urdf":
        return path
    tree = ET.parse(path)
    for link in tree.getroot().findall("link"):
        for shape in link.findall("visual") + link.findall("collision"):
            link.remove(shape)
    compiler = ET.SubElement(ET.SubElement(tree.getroot(), "mujoco"), "compiler")
    compiler.set("discardvisual", "true")
    tree.write(folder / (path.stem + "_plain.urdf"))
    return folder / (path.stem + "_plain.urdf")


def joints_of(path, coordinates):
    """Names in the file of the joints with these coordinates, which may be changed to be legal."""
    names = [joint.get("name") for joint in ET.parse(path).getroot().iter("joint") if joint.get("name")]
    def legal(name):
        return "".join(c if c.isalnum() or c == "_" else "_" for c in name)
    return [next((name for name in names if q in (name, legal(name), legal(name) + "_joint")), q) for q in coordinates]


def run_program(command, states):
    text = "\n".join(" ".join(repr(v) for v in state) for state in states)
    result = subprocess.run(command, input=text, capture_output=True, text=True)
    if result.returncode != 0:
        raise RuntimeError(result.stderr.strip() or "the program failed")
    lines = result.stdout.strip().split("\n")
    return [[float(v) for v in line.split()] for line in lines[:-1]], float(lines[-1])


def difference(ours, theirs):
    return max(max(abs(a - b) for a, b in zip(one, other)) / max(abs(a) for a in one) for one, other in zip(ours, theirs))


def row(program, path, folder, mujoco):
    model = folder / (path.stem + ".toml")
    imported = json.loads(subprocess.run([program, "import", path, "-o", model, "--friction", "none", "--json"],
                                         check=True, capture_output=True, text=True).stdout)
    emitted = subprocess.run([program, "emit", model, "--target", "c", "-o", folder / path.stem, "--json"],
                             check=True, capture_output=True, text=True)
    operations = sum(json.loads(emitted.stdout)["operations"].values())
    name = subprocess.run([program, "emit", model, "--print-name"], check=True, capture_output=True, text=True).stdout.strip()
    coordinates = imported["coordinates"]
    has_followers = imported["constraints"] > 0
    n = len(coordinates)
    own = compiled(EOMGEN.replace("NAME", name), folder, name + "_calls", folder / path.stem / (name + ".c"), "-lm")
    generator = random.Random(3)
    states = [[generator.uniform(-1, 1) for _ in range(2 * n)] for _ in range(STATES)]
    counts = [str(STATES), str(CALLS), str(n)]
    accelerations, ns = run_program([own, *counts], states)
    cells = [path.stem, n, operations, f"{ns:.0f}"]
    if has_followers:
        return "| " + " | ".join(str(cell) for cell in [*cells, "", "joints follow others"]) + " |"
    try:
        theirs, other_ns = run_program([mujoco, *counts, for_mujoco(path, folder), *joints_of(path, coordinates)], states) \
            if mujoco else (None, None)
        cells += ["", ""] if theirs is None else [f"{other_ns:.0f}", f"{difference(accelerations, theirs):.1e}"]
    except RuntimeError as error:
        cells += ["", str(error).splitlines()[0]]
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def table(program, folder):
    print("| robot | coordinates | operations | eomgen ns | MuJoCo ns | MuJoCo differs |")
    print("|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        mujoco = compiled(MUJOCO, scratch, "mujoco_calls", "-lmujoco", "-lm")
        for path in sorted([*folder.glob("*.urdf"), *folder.glob("*.xml")]):
            try:
                print(row(program, path, scratch, mujoco), flush=True)
            except subprocess.CalledProcessError as error:
                print(f"| {path.stem} | failed: {(error.stderr or str(error)).strip().splitlines()[-1]} |", flush=True)

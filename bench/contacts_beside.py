#!/usr/bin/env python3
"""Contacts beside Siconos: error at one time against run time.

usage: bench/contacts_beside.py EOMGEN
Needs the Python package of Siconos (Debian: python3-siconos), and ends with a message where it is not installed.
Models: `ball_chain` after 24 impacts, `woodpecker` after the first cycle of sticking, sliding and the beak's impact,
`slider_crank` after four impacts of two corners each, before its first infinite sequence of bounces, and at the end of
its scene, after three such sequences. Siconos has the equations from this file, those of the slider-crank from
contacts_slider_crank.c (compiled by `cc`: relations that are nonlinear in the coordinates work as compiled functions
only). It runs Moreau's time stepping (theta 1/2) with several steps, and for the balls the event-driven scheme (LSODAR).
Errors are the largest of coordinates at the end, in the unit of the coordinate. Reference of the balls: parabolas between
impacts in 40 digits. References of the others: integration from event to event in 60 digits (contacts_reference.py, one
minute). Run times are medians of three, of one above 2 s, without the set-up of the model: wall time of eomgen, processor
time of Siconos, whose runs are longer, so that other work on the machine extends them more.
"""
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from decimal import Decimal, getcontext

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"  # threads slow down matrices of this size

try:
    import numpy as np
    import siconos.kernel as sk
    import siconos.numerics as sn
except ImportError:
    sys.exit("bench/contacts_beside.py: skipped, the Python package of Siconos is not installed (Debian: python3-siconos)")
try:
    import contacts_reference
except ImportError:
    sys.exit("bench/contacts_beside.py: skipped, the Python package mpmath is not installed (Debian: python3-mpmath)")

BALLS_END, WOODPECKER_END, SLIDER_ENDS = 0.48, 0.14, (0.0087, 0.08)
SLIDER_CRANK = []  # path of the compiled equations, without its ending


def fall_of_balls(end):
    """Positions at `end`: between impacts all balls fall alike, and the time to each impact has a closed form."""
    getcontext().prec = 40
    R, g, e = Decimal("0.05"), Decimal("9.81"), Decimal("0.6")
    z, v, t = [Decimal("0.3"), Decimal("0.5"), Decimal("0.75")], [Decimal(0)] * 3, Decimal(0)
    end = Decimal(str(end))
    while True:
        times = [((v[0] + (v[0] * v[0] + 2 * g * max(z[0] - R, Decimal(0))).sqrt()) / g, 0)]
        for i in (1, 2):
            if v[i] < v[i - 1]:
                times.append((max(z[i] - z[i - 1] - 2 * R, Decimal(0)) / (v[i - 1] - v[i]), i))
        step, i = min(times)
        hits = t + step < end
        step = min(step, end - t)
        z = [a + b * step - g * step * step / 2 for a, b in zip(z, v)]
        v = [b - g * step for b in v]
        t += step
        if not hits:
            return [float(x) for x in z]
        if i == 0:
            v[0] = -e * v[0]
        else:
            mean, half = (v[i - 1] + v[i]) / 2, e * (v[i] - v[i - 1]) / 2
            v[i - 1], v[i] = mean + half, mean - half


def balls(h, end, events):
    m, R, g, e = 0.1, 0.05, 9.81, 0.6
    system = sk.LagrangianLinearTIDS(np.array([0.3, 0.5, 0.75]), np.zeros(3), m * np.eye(3))
    force = np.full(3, -m * g)
    system.setFExtPtr(force)
    model = sk.NonSmoothDynamicalSystem(0, end)
    model.insertDynamicalSystem(system)
    kept = [system, force, model]
    for row, b in (([1, 0, 0], -R), ([-1, 1, 0], -2 * R), ([0, -1, 1], -2 * R)):
        relation = sk.LagrangianLinearTIR(np.array([row], dtype=float), np.array([b]))
        contact = sk.Interaction(sk.NewtonImpactNSL(e), relation)
        model.link(contact, system)
        kept += [relation, contact]
    grid = sk.TimeDiscretisation(0, h)
    if not events:
        return system, sk.TimeStepping(model, grid, sk.MoreauJeanOSI(0.5), sk.LCP()), kept
    simulation = sk.EventDriven(model, grid)
    simulation.insertIntegrator(sk.LsodarOSI())
    simulation.insertNonSmoothProblem(sk.LCP(), sk.SICONOS_OSNSP_ED_IMPACT)
    simulation.insertNonSmoothProblem(sk.LCP(), sk.SICONOS_OSNSP_ED_SMOOTH_ACC)
    return system, simulation, kept


def woodpecker(h, end, events):
    """Coordinates y, phi_M, phi_S of models/woodpecker.toml. Tangential directions are those of its points along E2."""
    m_M, J_M, m_S, J_S, c, g, mu = 3e-4, 5e-9, 4.5e-3, 7e-7, 0.0056, 9.81, 0.3
    l_M, l_G, l_S, h_M, h_S, r_0, r_M = 0.010, 0.015, 0.0201, 0.0058, 0.020, 0.0025, 0.0031
    arm = np.array([1, l_M, l_G])
    M = np.diag([m_M, J_M, J_S]) + m_S * np.outer(arm, arm)
    K = c * np.array([[0, 0, 0], [0, 1, -1], [0, -1, 1.0]])
    system = sk.LagrangianLinearTIDS(np.array([0, -(r_M - r_0) / h_M, -0.2788]), np.array([-0.3411, 0, -7.4583]), M, K,
                                     np.zeros((3, 3)))
    force = -g * (np.array([m_M, 0, 0]) + m_S * arm)
    system.setFExtPtr(force)
    model = sk.NonSmoothDynamicalSystem(0, end)
    model.insertDynamicalSystem(system)
    kept = [system, force, model]
    for normal, tangent, b, e in (([0, 0, -h_S], [1, l_M, l_G - l_S], l_M + l_G - l_S - r_0, 0.5),
                                  ([0, h_M, 0], [1, r_M, 0], r_M - r_0, 0),
                                  ([0, -h_M, 0], [1, r_M, 0], r_M - r_0, 0)):
        relation = sk.LagrangianLinearTIR(np.array([normal, tangent], dtype=float), np.array([b, 0.0]))
        contact = sk.Interaction(sk.NewtonImpactFrictionNSL(e, 0, mu, 2), relation)
        model.link(contact, system)
        kept += [relation, contact]
    friction = sk.FrictionContact(2)
    friction.numericsSolverOptions().dparam[0] = 1e-12
    kept.append(friction)
    return system, sk.TimeStepping(model, sk.TimeDiscretisation(0, h), sk.MoreauJeanOSI(0.5), friction), kept


def slider_crank(h, end, events):
    """Coordinates theta1, theta2, theta3 of models/slider_crank.toml. Friction is solved by enumeration: NSGS and CPG
    report steps that they do not solve, and with Lemke's method errors do not fall with the step."""
    library = SLIDER_CRANK[0]
    system = sk.LagrangianDS(np.zeros(3), np.array([150.0, -75.0, 0.0]))
    system.setComputeMassFunction(library, "mass")
    system.setComputeFGyrFunction(library, "forces")
    system.setComputeJacobianFGyrqFunction(library, "forces_q")
    system.setComputeJacobianFGyrqDotFunction(library, "forces_v")
    model = sk.NonSmoothDynamicalSystem(0, end)
    model.insertDynamicalSystem(system)
    kept = [system, model]
    for corner in ("top_rear", "top_front", "bottom_rear", "bottom_front"):
        relation = sk.LagrangianScleronomousR(f"{library}:gap_{corner}", f"{library}:rows_{corner}")
        contact = sk.Interaction(sk.NewtonImpactFrictionNSL(0.4, 0, 0.01, 2), relation)
        model.link(contact, system)
        kept += [relation, contact]
    friction = sk.FrictionContact(2, sn.SICONOS_FRICTION_2D_ENUM)
    friction.numericsSolverOptions().dparam[0] = 1e-12
    kept.append(friction)
    return system, sk.TimeStepping(model, sk.TimeDiscretisation(0, h), sk.MoreauJeanOSI(0.5), friction), kept


def compile_slider_crank(folder):
    SLIDER_CRANK.append(os.path.join(folder, "slider_crank_plugin"))
    source = os.path.join(os.path.dirname(os.path.abspath(__file__)), "contacts_slider_crank.c")
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", SLIDER_CRANK[0] + ".so", source, "-lm"], check=True)


def siconos(build, h, end, events):
    seconds = []
    for _ in range(3):
        system, simulation, kept = build(h, end, events)
        start = time.process_time()
        while simulation.hasNextEvent():
            if events:
                simulation.advanceToEvent()
                simulation.processEvents()
            else:
                simulation.computeOneStep()
                simulation.nextStep()
        seconds.append(time.process_time() - start)
        q = np.array(system.q())
        del kept
        if seconds[-1] > 2:
            break
    return q, statistics.median(seconds)


def eomgen(program, model, names, end, rtol):
    seconds = []
    for _ in range(3):
        done = subprocess.run([program, "run", model, "--t-end", str(end), "--rtol", str(rtol), "--atol", str(rtol / 1000),
                               "--no-error-estimate", "--json"], capture_output=True, text=True, check=True)
        result = json.loads(done.stdout)
        seconds.append(result["seconds"]["integrate"])
    return np.array([result["final"][name] for name in names]), statistics.median(seconds)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    program = sys.argv[1]
    cases = [("ball_chain", ["z1", "z2", "z3"], BALLS_END, balls, fall_of_balls),
             ("woodpecker", ["y", "phi_M", "phi_S"], WOODPECKER_END, woodpecker, contacts_reference.woodpecker)]
    cases += [("slider_crank", ["theta1", "theta2", "theta3"], end, slider_crank, contacts_reference.slider_crank)
              for end in SLIDER_ENDS]
    with tempfile.TemporaryDirectory() as folder:
        compile_slider_crank(folder)
        print("| model | end | program | method | error | ms |")
        print("|---|---|---|---|---:|---:|")
        for case in cases:
            rows_of(program, *case)


def rows_of(program, model, names, end, build, reference):
    rows = [("eomgen", f"rtol {rtol:g}", *eomgen(program, model, names, end, rtol)) for rtol in (1e-6, 1e-9, 1e-12)]
    rows += [("Siconos", f"Moreau, step {h:g} s", *siconos(build, h, end, False)) for h in (1e-4, 1e-5, 1e-6)]
    if build is balls:
        rows += [("Siconos", f"event-driven, grid {h:g} s", *siconos(build, h, end, True)) for h in (1e-2, 1e-3)]
    exact = np.array([float(x) for x in reference(str(end))])
    for who, method, q, seconds in rows:
        print(f"| `{model}` | {end:g} s | {who} | {method} | {np.max(np.abs(q - exact)):.1e} | {1e3 * seconds:.2f} |", flush=True)


if __name__ == "__main__":
    main()

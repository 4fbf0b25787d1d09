# SPDX-License-Identifier: GPL-3.0-or-later
"""Costs of calls from Python (docs/reference/python.md): functions of a CompiledModel, a control loop at 1 kHz, runs.

    PYTHONPATH=build/release/python python3 bench/python_calls.py
"""
import statistics
import time
import timeit

import eomgen
import growth_models
import numpy as np


def controlled_arm(n):
    """The serial arm with a motor at each joint."""
    inputs = "[inputs]\n" + "".join(f'u{k} = {{ unit = "N*m", default = 0 }}\n' for k in range(1, n + 1))
    torques = ", ".join(f'q{k} = "u{k}"' for k in range(1, n + 1))
    text = growth_models.arm(n)
    at = text.index("[scene.default]")
    return eomgen.Model(text[:at] + inputs + f"[[force]]\ngeneralized = {{ {torques} }}\n" + text[at:], f"arm{n}")


def seconds(statement, number, **names):
    return statistics.median(timeit.repeat(statement, globals=names, number=number, repeat=9)) / number


def functions(name, f):
    x, u, t = f.start, np.zeros(len(f.input_names)), 0.0
    X = np.tile(x, (50000, 1))
    T = np.zeros(len(X))
    row = [seconds("call(t, x, u)", 20000, call=getattr(f, each), t=t, x=x, u=u) * 1e6 for each in ("rhs", "jac", "mass", "outputs")]
    batch = seconds("rhs(T, X, u)", 1, rhs=f.rhs, T=T, X=X, u=u) / len(X) * 1e9
    print(f"| {name} | " + " | ".join(f"{value:.2f}" for value in row) + f" | {batch:.0f} |")


def control_loop(f, steps=2000):
    """Microseconds of a period: the whole loop, and what remains beside the integration in one advance."""
    def loop(simulation):
        u = np.zeros(6)
        for k in range(1, steps + 1):
            simulation.set_inputs(u)
            simulation.advance(1e-3 * k)
            simulation.state()

    rest = (seconds("s.set_inputs(u)", 20000, s=f.simulate(), u=np.zeros(6)) + seconds("s.state()", 20000, s=f.simulate())) * 1e6
    whole, empty = [], []
    for _ in range(5):
        simulation = f.simulate()
        start = time.perf_counter()
        loop(simulation)
        whole.append((time.perf_counter() - start) / steps * 1e6)
    simulation = f.simulate()
    simulation.advance(1e-3)
    at = simulation.t
    empty = seconds("s.advance(t)", 20000, s=simulation, t=at) * 1e6
    return statistics.median(whole), rest, empty


if __name__ == "__main__":
    print("| model | rhs us | jac us | mass us | outputs us | rhs, batch, ns a state |\n|---|---|---|---|---|---|")
    functions("pendulum", eomgen.Model.from_file(growth_models.ROOT / "models/P2_planar_pendulum.toml").compile())
    functions("cart and pendulum", eomgen.Model.from_file(growth_models.ROOT / "models/cart_pendulum.toml").compile())
    model = controlled_arm(6)
    arm = model.compile(solver="dop853")
    functions("arm of 6 joints", arm)
    whole, rest, empty = control_loop(arm)
    print(f"\ncontrol loop of the arm: {whole:.1f} us a period of 1 ms; set_inputs and state {rest:.2f} us, advance without a step {empty:.2f} us")
    model.run(error_estimate=False)
    once = seconds("model.run(error_estimate=False, every=1)", 20, model=model) * 1e3
    print(f"run of the arm over 1 s, again: {once:.2f} ms")

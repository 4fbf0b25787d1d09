# SPDX-License-Identifier: GPL-3.0-or-later
"""Linear systems, trim and discrete steps of a CompiledModel, against closed forms and SciPy."""

import math
import os
import unittest

import eomgen
import numpy as np

SOURCE = os.environ["EOMGEN_SOURCE"]

OSCILLATOR = """format = 1
[parameters]
m = "2 kg"
c = "0.6 N*s/m"
k = "8 N/m"
[inputs]
F = { unit = "N", default = 0 }
[[particle]]
name = "P"
mass = "m"
position = ["x", 0, 0]
[coordinates]
x = "m"
[[force]]
on = "P"
force = "(F - k*x - c*x_dot)*E1"
[definitions]
stretch_power = "k*x*x_dot + F*x_dot"
[scene.default]
t = [0, 1]
initial = { x = 0.5 }
"""


def shipped(name):
    return eomgen.Model.from_file(f"{SOURCE}/models/{name}.toml")


class ControlTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        model = eomgen.Model(OSCILLATOR, "oscillator")
        cls.f = model.compile(functions=["jac", "jac_u"], outputs=["stretch_power", "energy"])

    def test_matrices_are_those_of_the_oscillator(self):
        system = self.f.linearize({"x": 0.5, "x_dot": -1}, [3.0], outputs=["x", "stretch_power"])
        np.testing.assert_allclose(system.A, [[0, 1], [-4, -0.3]], rtol=1e-14)
        np.testing.assert_allclose(system.B, [[0], [0.5]], rtol=1e-14)
        # k x x' + F x': its derivatives are k x', k x + F; x'.
        np.testing.assert_allclose(system.C, [[1, 0], [-8, 4 + 3]], rtol=1e-10, atol=1e-10)
        np.testing.assert_allclose(system.D, [[0], [-1]], rtol=1e-10, atol=1e-10)
        self.assertEqual((system.states, system.inputs, system.outputs), (["x", "x_dot"], ["F"], ["x", "stretch_power"]))
        np.testing.assert_allclose(system.y, [0.5, 8 * 0.5 * -1 - 3], rtol=1e-14)
        np.testing.assert_allclose(system.rate, [-1, (3 - 4 + 0.6) / 2], rtol=1e-14)
        A, B, C, D = system
        self.assertIs(A, system.A)

    def test_transfer_function_is_one_over_m_s2_c_s_k(self):
        num, den = self.f.transfer_function({"x": 0}, outputs="x")
        np.testing.assert_allclose(den, [1, 0.3, 4], rtol=1e-14)
        np.testing.assert_allclose(num[0, 0], [0, 0, 0.5], atol=1e-14)
        system = self.f.linearize({"x": 0}, outputs="x")
        w = np.array([0.1, 2.0, 30.0])
        expected = 0.5 / ((1j * w) ** 2 + 0.3j * w + 4)
        np.testing.assert_allclose(system.frequency_response(w)[0, 0], expected, rtol=1e-12)
        np.testing.assert_allclose(sorted(system.poles().imag), [-math.sqrt(4 - 0.0225), math.sqrt(4 - 0.0225)])

    def test_discrete_system_is_the_exact_solution(self):
        T = 0.2
        held = self.f.linearize({"x": 0}).discretize(T)
        w, d = math.sqrt(4 - 0.15**2), 0.15
        e, s, c = math.exp(-d * T), math.sin(w * T), math.cos(w * T)
        expected = [[e * (c + d / w * s), e * s / w], [-4 * e * s / w, e * (c - d / w * s)]]
        np.testing.assert_allclose(held.A, expected, rtol=1e-13)
        # From rest with F = 1: x = (1 - its free motion)/k.
        np.testing.assert_allclose(held.B[0, 0], (1 - expected[0][0]) / 8, rtol=1e-12)
        self.assertEqual(held.period, T)
        with self.assertRaisesRegex(eomgen.Error, "in discrete time"):
            held.discretize(T)
        step = self.f.discretize(T, {"x": 0.5, "x_dot": 1}, [2.0])
        np.testing.assert_allclose(step.A, held.A, rtol=1e-9, atol=1e-11)
        np.testing.assert_allclose(step.B, held.B, rtol=1e-9, atol=1e-11)
        np.testing.assert_allclose(step.x, held.A @ [0.5, 1] + held.B[:, 0] * 2, rtol=1e-9)

    def test_exponential_agrees_with_scipy(self):
        try:
            from scipy.linalg import expm
            from scipy.signal import StateSpace
        except ImportError:
            self.skipTest("no SciPy")
        rng = np.random.default_rng(2)
        for size in (1, 4, 9):
            for scale in (1e-3, 1, 30):
                M = scale * rng.normal(size=(size, size))
                ours = eomgen.control.matrix_exponential(M)
                np.testing.assert_allclose(ours, expm(M), rtol=1e-9, atol=1e-12 * np.abs(ours).max())
        self.assertEqual(StateSpace(*self.f.linearize()).A.shape, (2, 2))

    def test_nonlinear_step_and_its_derivatives_are_those_of_differences(self):
        f = shipped("cart_pendulum").compile(functions=["jac", "jac_u"])
        x, u, T = np.array([0.1, 2.0, -0.5, 1.5]), np.array([3.0]), 0.1
        step = f.discretize(T, x, u)
        run = f.simulate(rtol=1e-12, atol=1e-13)
        run.set_state(0, x)
        run.set_inputs(u)
        run.advance(T)
        np.testing.assert_allclose(step.x, run.state(), rtol=1e-9)
        h = 1e-4
        for j in range(4):
            e = h * np.eye(4)[j]
            slope = (f.discretize(T, x + e, u).x - f.discretize(T, x - e, u).x) / (2 * h)
            np.testing.assert_allclose(step.A[:, j], slope, rtol=1e-6, atol=1e-7)
        slope = (f.discretize(T, x, u + h).x - f.discretize(T, x, u - h).x) / (2 * h)
        np.testing.assert_allclose(step.B[:, 0], slope, rtol=1e-6, atol=1e-7)

    def test_trim_gives_the_force_that_holds_a_spring(self):
        found = self.f.trim({"x": 0.25})
        np.testing.assert_allclose(found.inputs, [2.0], rtol=1e-13)
        self.assertTrue(found.unique)
        moving = self.f.trim({"x": 0.25, "x_dot": 0.5})  # a steady speed at this instant
        np.testing.assert_allclose(moving.inputs, [2.3], rtol=1e-13)

    def test_trim_of_states_of_first_order(self):
        f = shipped("dc_motor").compile(functions=["jac", "jac_u"])
        found = f.trim({"phi_dot": 10})
        # kt i = b w, u = R i + kt w
        np.testing.assert_allclose(found.state[2], 0.002 * 10 / 0.1, rtol=1e-12)
        np.testing.assert_allclose(found.inputs, [0.2 + 1.0], rtol=1e-12)

    def test_what_inputs_cannot_hold_is_an_error_with_its_coordinates(self):
        f = shipped("cart_pendulum").compile(functions=["jac", "jac_u"])
        with self.assertRaisesRegex(eomgen.Error, "F cannot hold this state"):
            f.trim({"theta": 0.5})
        np.testing.assert_allclose(f.trim({"theta": math.pi}).inputs, [0], atol=1e-12)
        with self.assertRaisesRegex(eomgen.Error, "there is no input 'G'"):
            f.trim({"theta": 0}, "G")
        with self.assertRaisesRegex(eomgen.Error, "was not compiled"):
            f.linearize(outputs="x_ddot")

    def test_constraints_with_multipliers_are_refused(self):
        f = shipped("S5_double_pendulum_cartesian").compile()
        with self.assertRaisesRegex(eomgen.Error, "manifold"):
            f.linearize()


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""The functions of a CompiledModel, against formulas written by hand, differences and SciPy."""

import concurrent.futures
import json
import math
import os
import pickle
import subprocess
import unittest

import eomgen
import numpy as np

SOURCE = os.environ["EOMGEN_SOURCE"]


def shipped(name):
    return eomgen.Model.from_file(f"{SOURCE}/models/{name}.toml")


M, m, l, g, c = 2.0, 0.5, 0.8, 9.81, 0.1  # of cart_pendulum


def cart_rhs(x, F):
    """The cart with its pendulum, solved by Cramer's rule."""
    _, theta, v, w = x
    A = np.array([[M + m, m * l * math.cos(theta)], [m * l * math.cos(theta), m * l**2]])
    b = np.array([F - c * v + m * l * w**2 * math.sin(theta), -m * g * l * math.sin(theta)])
    return np.concatenate([[v, w], np.linalg.solve(A, b)])


class CompiledModelTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = shipped("cart_pendulum")
        functions = ["jac", "jac_u", "jac_p", "mass", "momenta", "energy_gradients", "taylor", "momenta_jac",
                     "momenta_jac_p", "momenta_jac_u"]
        cls.f = cls.model.compile(functions=functions, outputs="all")

    def states(self, count):
        return np.random.default_rng(1).uniform(-2, 2, (count, 4))

    def test_names_units_and_numbers_of_the_scene(self):
        f = self.f
        self.assertEqual(f.state_names, ["x", "theta", "x_dot", "theta_dot"])
        self.assertEqual(f.states[3], ("theta_dot", "rad/s", ""))
        self.assertEqual(f.units["F"], "N")
        self.assertEqual(f.span, (0, 10))
        self.assertEqual(f.start.tolist(), [0, 0.3, 0, 0])
        self.assertEqual(f.parameters.tolist(), [2, 0.5, 0.8, 9.81, 0.1])
        self.assertEqual(f.values({"theta": 1, "m": 3}).state.tolist(), [0, 1, 0, 0])
        self.assertEqual(f.values({"m": 3}).parameters.tolist(), [2, 3, 0.8, 9.81, 0.1])
        self.assertEqual(f.state(theta=0.5).tolist(), [0, 0.5, 0, 0])
        self.assertEqual(f.input_values(0).tolist(), [0])
        with self.assertRaises(KeyError):
            f.state(phi=1)

    def test_rhs_is_that_of_the_textbook(self):
        for x in self.states(20):
            np.testing.assert_allclose(self.f.rhs(0.0, x, [1.5]), cart_rhs(x, 1.5), rtol=1e-13, atol=1e-13)

    def test_many_states_are_those_of_one(self):
        X = self.states(50)
        U = np.linspace(-1, 1, 50)[:, None]
        for name in ("rhs", "jac", "jac_t", "jac_u", "jac_p", "outputs"):
            function = getattr(self.f, name)
            for inputs in (None, [0.7], U):
                many = function(0.0, X, inputs)
                for k in (0, 17, 49):
                    u = U[k] if inputs is U else inputs
                    np.testing.assert_array_equal(many[k], function(0.0, X[k], u), name)
        masses, forces = self.f.mass(np.zeros(50), X)
        self.assertEqual((masses.shape, forces.shape), ((50, 2, 2), (50, 2)))
        np.testing.assert_array_equal(masses[3], self.f.mass(0, X[3])[0])

    def test_lists_views_and_integers_are_arguments(self):
        x = self.states(1)[0]
        expected = self.f.rhs(0.0, x)
        np.testing.assert_array_equal(self.f.rhs(0, list(x)), expected)
        np.testing.assert_array_equal(self.f.rhs(np.float64(0), np.repeat(x, 2)[::2]), expected)
        # Without parameters, what depends on them alone is computed once, in another order.
        np.testing.assert_allclose(self.f.rhs(t=0.0, x=x, parameters=self.f.parameters), expected, rtol=1e-14)
        np.testing.assert_array_equal(self.f.rhs(0.0, np.asfortranarray(np.tile(x, (3, 1))))[2], expected)
        np.testing.assert_array_equal(self.f.rhs(0.0, np.array([0, 1, 2, 3])), self.f.rhs(0.0, [0.0, 1.0, 2.0, 3.0]))

    def test_derivatives_are_those_of_differences(self):
        x, u, p = self.states(1)[0], np.array([0.4]), self.f.parameters
        for function, argument in (("jac", 0), ("jac_u", 1), ("jac_p", 2)):
            J = getattr(self.f, function)(0.0, x, u, p)
            arguments = [x, u, p]
            for j in range(J.shape[1]):
                d = 1e-6
                up, down = [a.copy() for a in arguments], [a.copy() for a in arguments]
                up[argument][j] += d
                down[argument][j] -= d
                slope = (self.f.rhs(0.0, *up) - self.f.rhs(0.0, *down)) / (2 * d)
                np.testing.assert_allclose(J[:, j], slope, rtol=1e-6, atol=1e-7, err_msg=function)

    def test_products_are_those_of_the_matrices(self):
        names = ["jac", "jac_p", "jac_u", "mass", "jvp", "vjp", "adjoint", "hvp", "inverse", "coriolis", "gravity"]
        f = self.model.compile(functions=names)
        X, u = self.states(5), np.array([0.4])
        x, v, d = X[0], np.array([1.0, -2, 0.5, 3]), np.array([0.2, 1, -1, 0.7])
        J = f.jac(0.0, x, u)
        np.testing.assert_allclose(f.jvp(0.0, x, v, u), J @ v, rtol=1e-12)
        np.testing.assert_allclose(f.vjp(0.0, x, v, inputs=u), v @ J, rtol=1e-12, atol=1e-13)
        by_x, by_p, by_u = f.adjoint(0.0, x, v, u)
        np.testing.assert_allclose(by_x, v @ J, rtol=1e-12, atol=1e-13)
        np.testing.assert_allclose(by_p, v @ f.jac_p(0.0, x, u), rtol=1e-12, atol=1e-13)
        np.testing.assert_allclose(by_u, v @ f.jac_u(0.0, x, u), rtol=1e-12)
        slope = (f.vjp(0.0, x + 1e-6 * d, v, u) - f.vjp(0.0, x - 1e-6 * d, v, u)) / 2e-6
        np.testing.assert_allclose(f.hvp(0.0, x, np.concatenate([v, d]), u), slope, rtol=1e-6, atol=1e-7)
        M, h = f.mass(0.0, x)
        np.testing.assert_allclose(f.inverse(0.0, x, [0.5, -1], [0.0]), M @ [0.5, -1] + h, rtol=1e-12)
        np.testing.assert_allclose(f.gravity(0.0, x), [0, m * g * l * np.sin(x[1])], rtol=1e-13)
        self.assertEqual(f.coriolis(0.0, x)[1].tolist(), [0, 0])
        np.testing.assert_allclose(f.jvp(0.0, X, v, u)[3], f.jvp(0.0, X[3], v, u), rtol=1e-15)
        with self.assertRaises(eomgen.Error):
            f.jvp(0.0, x, v[:3])

    def test_jacobians_of_outputs_and_reactions_are_slopes(self):
        functions = [of + "_jac" + by for of in ("outputs", "reactions") for by in ("", "_p", "_u")]
        f = shipped("n_four_bar_2").compile(functions=functions + ["reactions"], outputs=["energy", "power"])
        x, p = f.start + 0.1, f.parameters
        for of in ("outputs", "reactions"):
            values = getattr(f, of)
            self.assertEqual(getattr(f, of + "_jac_t")(0.0, x).tolist(), [0] * len(values(0.0, x)))
            self.assertEqual(getattr(f, of + "_jac_u")(0.0, x).shape, (len(values(0.0, x)), len(f.input_names)))
            for name, arguments, j in ((of + "_jac", [x, p], 0), (of + "_jac_p", [x, p], 1)):
                J = getattr(f, name)(0.0, x, None, p)
                for k in range(J.shape[1]):
                    d = 1e-6 * np.eye(J.shape[1])[k]
                    up, down = list(arguments), list(arguments)
                    up[j], down[j] = up[j] + d, down[j] - d
                    slope = (values(0.0, up[0], None, up[1]) - values(0.0, down[0], None, down[1])) / 2e-6
                    np.testing.assert_allclose(J[:, k], slope, rtol=1e-6, atol=1e-6, err_msg=name)

    def test_regressor_and_momentum_are_those_of_the_masses(self):
        f = shipped("spatial_chain_3").compile(functions=["regressor", "inverse", "momentum", "frames"])
        n = f.coordinate_count
        x = np.random.default_rng(5).uniform(0.3, 1.2, len(f.state_names))
        Y, inertial = f.regressor(0.0, x, np.ones(n))
        self.assertEqual(Y.shape, (n, len(f.inertial_parameter_names)))
        self.assertEqual(inertial.shape, (len(f.inertial_parameter_names),))
        masses = dict(zip(f.inertial_parameter_names, inertial))
        AG, hG, centre = f.momentum(0.0, x)
        self.assertEqual((AG.shape, hG.shape, centre.shape), ((6, n), (6,), (3,)))
        frames = f.frames(0.0, x)
        P = sum(masses[name + ".mass"] * frame.jacobian[:3] for name, frame in frames.items() if name + ".mass" in masses)
        np.testing.assert_allclose(AG[3:], P, atol=1e-12)
        many = f.momentum(0.0, np.tile(x, (4, 1)))
        np.testing.assert_array_equal(many[1][2], hG)

    def test_mass_and_bias_give_the_accelerations(self):
        x = self.states(1)[0]
        mass, bias = self.f.mass(0.0, x)
        np.testing.assert_allclose(np.linalg.solve(mass, -bias), self.f.rhs(0.0, x)[2:], rtol=1e-12)
        momenta, _ = self.f.momenta(0.0, x)
        np.testing.assert_allclose(momenta, mass @ x[2:], rtol=1e-13)
        slopes = self.f.momenta_jac(0.0, x)
        self.assertEqual(slopes.shape, (4, 4))
        np.testing.assert_allclose(slopes[:2, 2:], mass, rtol=1e-13, atol=1e-15)
        np.testing.assert_array_equal(self.f.momenta_jac_t(0.0, x), np.zeros(4))
        self.assertEqual(self.f.momenta_jac_u(0.0, x).shape, (4, 1))
        self.assertEqual(self.f.momenta_jac_p(0.0, x).shape, (4, len(self.f.parameters)))
        energies, dT, dU = self.f.energy_gradients(0.0, x)
        np.testing.assert_allclose(energies, [x[2:] @ mass @ x[2:] / 2, -m * g * l * np.cos(x[1])], rtol=1e-13)
        np.testing.assert_allclose(dT[2:], momenta, rtol=1e-13)
        np.testing.assert_allclose(dT[:2], [0, -m * l * x[2] * x[3] * np.sin(x[1])], rtol=1e-13)
        np.testing.assert_allclose(dU, [0, m * g * l * np.sin(x[1])], rtol=1e-13)

    def test_frames_have_poses_jacobians_and_biases(self):
        f = shipped("R10_lagrange_top").compile(functions=["frames"])
        n, states = f.coordinate_count, np.random.default_rng(2).uniform(0.3, 1.2, (5, len(f.state_names)))
        self.assertTrue(f.frame_names)
        many = f.frames(0.0, states)
        for name in f.frame_names:
            x, d = states[3], 1e-6
            frame = f.frames(0.0, x)[name]
            shapes = [part.shape for part in frame]
            self.assertEqual(shapes, [(3,), (3, 3), (6, n), (6,)])
            self.assertEqual([part.shape for part in many[name]], [(5,) + shape for shape in shapes])
            for one, part in zip(frame, many[name]):
                np.testing.assert_array_equal(part[3], one)
            np.testing.assert_allclose(frame.rotation.T @ frame.rotation, np.eye(3), atol=1e-14)
            np.testing.assert_allclose(np.linalg.det(frame.rotation), 1)
            for j in range(n):
                step = d * np.eye(len(x))[j]
                up, down = f.frames(0.0, x + step)[name], f.frames(0.0, x - step)[name]
                slope = (up.position - down.position) / (2 * d)
                np.testing.assert_allclose(frame.jacobian[:3, j], slope, atol=1e-8)
                spin = (up.rotation - down.rotation) @ frame.rotation.T / (2 * d)
                np.testing.assert_allclose(frame.jacobian[3:, j], [spin[2, 1], spin[0, 2], spin[1, 0]], atol=1e-8)
            # At qddot = 0 the acceleration is the bias.
            ahead = np.concatenate([x[n : 2 * n], np.zeros(n)])
            rates = [f.frames(0.0, x + h * ahead)[name].jacobian @ x[n : 2 * n] for h in (d, -d)]
            np.testing.assert_allclose(frame.bias, (rates[0] - rates[1]) / (2 * d), atol=1e-7)
        with self.assertRaises(eomgen.Error):
            self.f.frames(0.0, self.states(1)[0])

    def test_constraints_and_their_forces(self):
        f = shipped("S5_double_pendulum_pfaffian").compile(approach="I")
        x = f.start
        psi, A, b = f.constraints(0.0, x)
        n, constraints = f.coordinate_count, len(f.constraint_names)
        self.assertEqual((psi.shape, A.shape, b.shape), ((constraints,), (constraints, n), (constraints,)))
        np.testing.assert_allclose(A @ x[n : 2 * n] + b, 0, atol=1e-12)
        mass, bias = f.mass(0.0, x)
        acceleration = f.rhs(0.0, x)[n : 2 * n]
        multipliers = f.reactions(0.0, x)
        np.testing.assert_allclose(mass @ acceleration + bias, A.T @ multipliers[-constraints:], atol=1e-10)

    def test_taylor_is_the_series_of_the_motion(self):
        x = self.f.start
        series = self.f.taylor(0.0, x, 20)
        self.assertEqual(series.shape, (21, 4))
        np.testing.assert_array_equal(series[0], x)
        np.testing.assert_allclose(series[1], self.f.rhs(0.0, x), rtol=1e-14)
        h = 0.05
        end = self.model.run(t_end=h, rtol=1e-12, atol=1e-14).final
        np.testing.assert_allclose(np.polynomial.polynomial.polyval(h, series)[1], end["theta"], rtol=1e-12)

    def test_steps_are_those_of_a_run_with_fixed_steps(self):
        for method in ("rk4", "midpoint", "variational2"):
            rows = self.model.run(t_end=0.5, step=0.0625, every=0.0625, solver=method, error_estimate=False)
            x = self.f.start
            for k in range(8):
                x = self.f.step(0.0625 * k, 0.0625, x, method=method)
                expected = [rows[name][k + 1] for name in self.f.state_names]
                np.testing.assert_allclose(x, expected, rtol=0, atol=1e-14)

    def test_derivatives_of_steps_are_those_of_differences(self):
        x, u, p, h, d = self.states(1)[0], np.array([0.4]), self.f.parameters, 0.1, 1e-5
        for method in self.f.step_methods():
            step = self.f.step_jac(0.0, h, x, u, p, method=method)
            np.testing.assert_array_equal(step.x1, self.f.step(0.0, h, x, u, p, method=method))
            for J, place in ((step.A, 2), (step.B, 3), (step.P, 4)):
                arguments = [0.0, h, x, u, p]
                for j in range(J.shape[1]):
                    ends = []
                    for by in (d, -d):
                        moved = [np.copy(a) for a in arguments]
                        moved[place][j] += by
                        ends.append(self.f.step(*moved, method=method))
                    np.testing.assert_allclose(J[:, j], (ends[0] - ends[1]) / (2 * d), rtol=1e-7, atol=1e-8)
            ends = [self.f.step(0.0, h + by, x, u, p, method=method) for by in (d, -d)]
            np.testing.assert_allclose(step.h, (ends[0] - ends[1]) / (2 * d), rtol=1e-7, atol=1e-8)
            np.testing.assert_array_equal(step.t, np.zeros(4))

    def test_chained_derivatives_of_steps_are_the_sensitivities_of_a_run(self):
        command = [os.environ["EOMGEN"], "run", f"{SOURCE}/models/cart_pendulum.toml", "--t-end", "1", "--json"]
        command += ["--rtol", "1e-11", "--atol", "1e-13", "--sensitivity", "m,theta"]
        expected = json.loads(subprocess.run(command, capture_output=True, check=True).stdout)["sensitivities"]["values"]
        x, h, place = self.f.start, 0.02, self.f.parameter_names.index("m")
        S = np.column_stack([np.zeros(4), np.eye(4)[self.f.state_names.index("theta")]])
        for k in range(50):
            step = self.f.step_jac(h * k, h, x, method="dop853")
            x, S = step.x1, step.A @ S
            S[:, 0] += step.P[:, place]
        for column, name in enumerate(("m", "theta")):
            values = [expected[name][state] for state in self.f.state_names]
            np.testing.assert_allclose(S[:, column], values, rtol=1e-10)

    def test_steps_take_many_states_and_refuse_what_is_missing(self):
        X, U = self.states(5), np.linspace(-1, 1, 5)[:, None]
        h = np.linspace(0.01, 0.05, 5)
        many = self.f.step_jac(0.0, h, X, U)
        self.assertEqual([part.shape for part in many], [(5, 4), (5, 4, 4), (5, 4, 1), (5, 4, 5), (5, 4), (5, 4)])
        one = self.f.step_jac(0.0, h[3], X[3], U[3])
        for part, expected in zip(many, one):
            np.testing.assert_array_equal(part[3], expected)
        np.testing.assert_array_equal(self.f.step(0.0, h, X, lambda t, x: U)[3], one.x1)
        bare = self.model.compile(functions=["jac"])
        step = bare.step_jac(0.0, 0.1, X[0])
        self.assertIsNone(step.B)
        self.assertIsNone(step.P)
        for arguments, name in (((0.0, [0.1, 0.2], X), "h"), (([0.0], 0.1, X[0]), "t"), ((0.0, 0.1, X[0][:3]), "x")):
            with self.assertRaisesRegex(eomgen.Error, f"error: {name} has the shape"):
                bare.step(*arguments)
        with self.assertRaisesRegex(eomgen.Error, "choose one of rk4"):
            bare.step(0.0, 0.1, X[0], method="euler")
        with self.assertRaisesRegex(eomgen.Error, "'jac' was not compiled"):
            self.model.compile(functions=["mass"]).step_jac(0.0, 0.1, X[0])

    def test_inputs_may_be_a_function_of_time_and_state(self):
        x = self.states(1)[0]
        feedback = lambda t, x: [t - 2 * x[..., 1]]
        np.testing.assert_array_equal(self.f.rhs(0.5, x, feedback), self.f.rhs(0.5, x, [0.5 - 2 * x[1]]))
        X = self.states(5)
        many = self.f.rhs(0.5, X, lambda t, x: (t - 2 * x[:, 1])[:, None])
        np.testing.assert_array_equal(many[4], self.f.rhs(0.5, X[4], feedback))

        def fail(t, x):
            raise ZeroDivisionError

        with self.assertRaises(ZeroDivisionError):
            self.f.rhs(0.5, x, fail)

    def test_errors_name_the_argument(self):
        x = self.f.start
        for arguments, name in (
            (([0.0], x), "t"),
            ((0.0, x[:3]), "x"),
            ((0.0, x, [1, 2]), "inputs"),
            ((0.0, x, None, [1.0]), "parameters"),
            ((0.0, np.zeros((3, 4)), np.zeros((2, 1))), "inputs"),
        ):
            with self.assertRaisesRegex(eomgen.Error, f"error: {name} has the shape"):
                self.f.rhs(*arguments)
        with self.assertRaises(TypeError):
            self.f.rhs(0.0)
        with self.assertRaises(TypeError):
            self.f.rhs(0.0, x, nothing=1)
        with self.assertRaises(TypeError):
            self.f.rhs(0.0, "text")
        with self.assertRaises(TypeError):
            eomgen.CompiledModel.__new__(eomgen.CompiledModel).rhs(0.0, x)
        with self.assertRaisesRegex(eomgen.Error, "compile\\(functions=\\['events'"):
            self.f.events(0.0, x)

    def test_singular_states_raise_and_are_nan_among_many(self):
        f = shipped("P14_kepler_spherical").compile()
        x = f.start
        bad = x.copy()
        bad[f.state_names.index(next(n for n in f.state_names if n in ("r", "R")))] = 0
        with self.assertRaises(eomgen.Error) as caught:
            f.rhs(0.0, bad)
        self.assertEqual(caught.exception.kind, "numerical")
        both = f.rhs(0.0, np.array([x, bad]))
        np.testing.assert_array_equal(both[0], f.rhs(0.0, x))
        self.assertTrue(np.isnan(both[1]).all())

    def test_threads_get_the_same_bits(self):
        X = self.states(20000)
        expected = self.f.rhs(0.0, X)
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            for found in pool.map(lambda _: self.f.rhs(0.0, X), range(32)):
                np.testing.assert_array_equal(found, expected)

    def test_compiled_models_are_pickled(self):
        again = pickle.loads(pickle.dumps(self.f))
        x = self.states(1)[0]
        np.testing.assert_array_equal(again.rhs(0.0, x), self.f.rhs(0.0, x))
        self.assertTrue(again.has("jac_u"))

    def test_scipy_integrates_with_rhs_and_jacobian(self):
        try:
            from scipy.integrate import solve_ivp
        except ImportError:
            self.skipTest("SciPy is not installed")
        expected = self.model.run(t_end=2, rtol=1e-11, atol=1e-12).final
        for method, jac in (("DOP853", None), ("Radau", self.f.jac)):
            options = {} if jac is None else {"jac": jac}
            found = solve_ivp(self.f.rhs, (0, 2), self.f.start, method=method, rtol=1e-9, atol=1e-11, **options)
            np.testing.assert_allclose(found.y[1, -1], expected["theta"], rtol=1e-6)
            controlled = solve_ivp(self.f.rhs, (0, 1), self.f.start, method=method, args=([2.0],), **options)
            self.assertTrue(controlled.success)


if __name__ == "__main__":
    unittest.main()

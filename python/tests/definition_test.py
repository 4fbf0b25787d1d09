# SPDX-License-Identifier: GPL-3.0-or-later
"""Models built from objects, expressions, and equations in SymPy."""

import math
import os
import subprocess
import sys
import unittest
from fractions import Fraction

import eomgen
import numpy as np
from eomgen import expressions as e

SOURCE = os.environ["EOMGEN_SOURCE"]


class ExpressionTest(unittest.TestCase):
    def test_operators_write_the_model_language(self):
        a, b, c = (e.Expression(name) for name in "abc")
        for written, text in (
            (a + b * c, "a + b*c"),
            ((a + b) * c, "(a + b)*c"),
            (a - (b - c), "a - (b - c)"),
            (a - b - c, "a - b - c"),
            (a / (b / c), "a/(b/c)"),
            (a / b / c, "a/b/c"),
            (a * (b / c), "a*(b/c)"),
            (-(a**2), "-a^2"),
            ((-a) ** 2, "(-a)^2"),
            (a ** (b**c), "a^(b^c)"),
            ((a**b) ** c, "(a^b)^c"),
            (-a * b, "-a*b"),
            (a - -b, "a - -b"),
            (2 * a - 1, "2*a - 1"),
            (a + -1, "a + (-1)"),
            (0.1 / a, "0.1/a"),
            (a**-2, "a^(-2)"),
            (a * Fraction(1, 3), "a*(1/3)"),
            (a * np.float64(2.5), "a*2.5"),
            (np.float64(2.5) * a, "2.5*a"),
            (e.sin(a + b) * abs(c), "sin(a + b)*abs(c)"),
            (e.if_(a < 2 * b, a, 0), "if(a < 2*b, a, 0)"),
            (e.quantity(0.3, "N/m") * a, "0.3[N/m]*a"),
            (a.dot + a.ddot, "a_dot + a_ddot"),
        ):
            self.assertEqual(str(written), text)
        with self.assertRaises(TypeError):
            (a + b).dot
        with self.assertRaises(TypeError):
            bool(a < b)
        with self.assertRaises(TypeError):
            bool(a)

    def test_values_of_expressions_are_those_of_python(self):
        # Every operator, nested at random, evaluated by the library and by Python.
        random = np.random.default_rng(7)
        values = {"a": 1.25, "b": -0.75, "c": 2.5}

        def nested(depth):
            if depth == 0:
                name = random.choice(list(values))
                return e.Expression(str(name)), values[name]
            (x, u), (y, v) = nested(depth - 1), nested(depth - 1)
            k = random.integers(6)
            if k == 0:
                return x + y, u + v
            if k == 1:
                return x - y, u - v
            if k == 2:
                return x * y, u * v
            if k == 3:
                return x / (2 + y * y), u / (2 + v * v)
            if k == 4:
                return -x, -u
            return (x - 2) ** 3, (u - 2) ** 3

        d = eomgen.Definition()
        x = d.coordinate("x")
        a, b, c = d.parameters(**values)
        d.add(eomgen.Particle("P", mass=1, position=[x, 0, 0]))
        d.add(eomgen.Force(on="P", force=[x, 0, 0]))
        pairs = [nested(4) for _ in range(20)]
        names = [f"value{k}" for k in range(len(pairs))]
        for name, (expression, _) in zip(names, pairs):
            d.define(name, expression + 0 * (a + b + c))
        d.scene(outputs=names)
        f = d.model().compile(functions=[])
        found = dict(zip(f.output_names, f.outputs(0.0, [0.0, 0.0])))
        for name, (expression, value) in zip(names, pairs):
            self.assertAlmostEqual(found[name], value, delta=1e-12 * max(1, abs(value)), msg=str(expression))


class DefinitionTest(unittest.TestCase):
    def arm(self):
        d = eomgen.Definition("Two links", notes='Of "two" links.')
        m, L, g = d.parameters(m="2 kg", L="0.5 m", g="9.81 m/s^2")
        q1, q2 = d.coordinates(q1="rad", q2="rad")
        u = d.input("u", "N*m")
        upper = d.add(
            eomgen.Body("upper", mass=m, inertia=m * L**2 / 12, rotation={"axis": e.E3, "angle": q1}, position="L/2*upper.e1")
        )
        elbow = d.add(eomgen.Point("elbow", position=L * upper.e1))
        d.add(
            eomgen.Body(
                "lower", mass=m, inertia=m * L**2 / 12, relative_to="upper",
                rotation={"axis": "E3", "angle": q2}, position=elbow + L / 2 * e.Expression("lower.e1"),
            )
        )  # fmt: skip
        d.add(eomgen.Force(gravity=-g * e.E2))
        d.add(eomgen.Force(generalized={q1: u}))
        d.scene(t=[0, 2], initial={q1: 0.3, q2: "30 deg", q1.dot: -1}, outputs=["energy"])
        d.scene("fast", start_from="default", initial={q2.dot: 20})
        return d

    def test_a_definition_is_a_model(self):
        model = self.arm().model("arm")
        self.assertEqual(model.coordinates, ["q1", "q2"])
        self.assertEqual(model.scenes, ["default", "fast"])
        f = model.compile()
        np.testing.assert_allclose(f.start, [0.3, math.pi / 6, -1, 0], rtol=1e-15)
        np.testing.assert_allclose(model.compile("fast").start, [0.3, math.pi / 6, -1, 20], rtol=1e-15)
        # The inertia of a double pendulum of rods: M22 = m L^2/3.
        mass, _ = f.mass(0.0, f.start)
        self.assertAlmostEqual(mass[1, 1], 2 * 0.25 / 3)
        self.assertTrue(model.verify(points=3, compile=False))

    def test_errors_have_the_line_of_the_text(self):
        d = self.arm()
        d.add(eomgen.Force(gravitation="-g*E2"))
        with self.assertRaises(eomgen.Error) as caught:
            d.model("arm")
        error = caught.exception
        self.assertEqual(d.text.splitlines()[error.line - 1], 'gravitation = "-g*E2"')
        with self.assertRaises(TypeError):
            eomgen.Definition().parameter("m", object()) and eomgen.definition.toml(object())

    def test_text_is_escaped(self):
        d = eomgen.Definition('A "title"\n[parameters]\\')
        x = d.coordinate("x", "m")
        d.add(eomgen.Particle("P", mass="1 kg", position=[x, 0, 0]))
        self.assertEqual(d.model().title, 'A "title"\n[parameters]\\')

    def test_states_events_and_joints_are_sections(self):
        d = eomgen.Definition("Motor")
        J, R, K = d.parameters(J="1 kg*m^2", R="2 Ohm", K="0.5 N*m/A")
        phi = d.coordinate("phi", "rad")
        U = d.input("U", "V", default=2)
        i = d.add(eomgen.State("i", rate=(U - R * "i" - K * "1[V*s/(N*m/A)]" * phi.dot) / e.quantity(0.1, "H"), unit="A"))
        d.energy(kinetic=J / 2 * phi.dot**2)
        d.add(eomgen.Force(generalized={phi: K * i}))
        d.scene(t=[0, 1])
        self.assertEqual(d.model().compile().state_names, ["phi", "phi_dot", "i"])


class SympyTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        try:
            import sympy
        except ImportError:
            raise unittest.SkipTest("SymPy is not installed")
        cls.sympy = sympy

    def test_equations_of_the_cart_are_those_of_sympy(self):
        sympy = self.sympy
        found = eomgen.Model.from_file(f"{SOURCE}/models/cart_pendulum.toml").to_sympy(functions_of_time=True)
        s, t = found.symbols, found.t
        x, theta = found.coordinates
        L = found.kinetic - found.potential
        force = s["F"] - s["c"] * x.diff(t)
        for q, Q, row in zip((x, theta), (force, 0), found.equations()):
            lagrange = L.diff(q.diff(t)).diff(t) - L.diff(q) - Q
            self.assertEqual(sympy.simplify(lagrange - row.lhs), 0)
        self.assertIn("\\frac{d^{2}}{d t^{2}}", found._repr_latex_())

    def test_values_are_those_of_the_compiled_model(self):
        for name in ("S5_double_pendulum_cartesian", "R8_pendulum_body", "elastic_pendulum"):
            model = eomgen.Model.from_file(f"{SOURCE}/models/{name}.toml")
            f = model.compile(approach="II", functions=["mass"])
            found = model.to_sympy()
            n = len(found.coordinates)
            x = f.start + 0.1
            at = {found.symbols[q]: v for q, v in zip(f.state_names, x) if q in found.symbols}
            at.update({found.symbols[p]: v for p, v in zip(f.parameter_names, f.parameters) if p in found.symbols})
            at.update({found.symbols[u]: v for u, v in zip(f.input_names, f.input_values(0)) if u in found.symbols})
            at[found.t] = 0
            M = np.array(found.M.subs(at).evalf(), dtype=float)
            np.testing.assert_allclose(M, f.mass(0.0, x)[0], rtol=1e-12, atol=1e-12, err_msg=name)


class StubTest(unittest.TestCase):
    def test_the_types_of_the_package_are_consistent(self):
        done = subprocess.run([sys.executable, "-c", "import mypy"], capture_output=True)
        if done.returncode != 0:
            self.skipTest("mypy is not installed")
        command = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", os.devnull, "--no-warn-unused-ignores", "-p", "eomgen"]
        done = subprocess.run(command, capture_output=True, text=True, cwd=f"{SOURCE}/python")
        self.assertEqual(done.returncode, 0, done.stdout)

    def test_every_public_name_has_a_docstring(self):
        for name in eomgen.__all__:
            value = getattr(eomgen, name)
            self.assertTrue(value.__doc__, name)
            for part in vars(value) if isinstance(value, type) else ():
                if not part.startswith("_") and callable(getattr(value, part)):
                    self.assertTrue(getattr(value, part).__doc__, f"{name}.{part}")
        self.assertIn("(K, N)", eomgen.CompiledModel.rhs.__doc__)


if __name__ == "__main__":
    unittest.main()

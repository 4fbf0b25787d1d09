# SPDX-License-Identifier: GPL-3.0-or-later
"""Values of wrong types are refused in the words of Python, and values with units are those of the command line."""

import inspect
import os
import tempfile
import unittest
import warnings

import eomgen
import numpy as np
from eomgen import arguments

TEXT = """
format = 1
[parameters]
m = "1 kg"
l = "0.5 m"
slope = "10 deg"
g = "9.81 m/s^2"
[inputs]
F = { unit = "N", default = 0 }
[coordinates]
theta = "rad"
[[particle]]
name = "bob"
mass = "m"
position = ["l*sin(theta)", "-l*cos(theta)", 0]
[[force]]
gravity = "-g*(cos(slope)*E2 + sin(slope)*E1)"
[[force]]
generalized = { theta = "l*F" }
[scene.default]
t = [0, 1]
initial = { theta = "60 deg" }
"""

# Names of C++ and of its binding, none of which a message may have.
FOREIGN = ("std::", "::", "pybind", "incompatible function arguments", "Unable to cast", "C++")


class Odd:
    """A value that no argument takes."""

    def __repr__(self):
        return "<odd>"


def public_methods(of):
    for name in dir(of):
        if name.startswith("_") or isinstance(inspect.getattr_static(of, name), property):
            continue
        if callable(getattr(of, name)):
            yield name


def arguments_of(method):
    """Names of the arguments, in their order; those that are required are marked."""
    try:
        signature = inspect.signature(method)
    except ValueError:  # a method of pybind11: its signature is the first line of its documentation
        inside = method.__doc__.splitlines()[0].partition("(self")[2].rpartition(") ->")[0]
        names = [part.partition(":")[0].strip() for part in inside.split(",") if ":" in part]
        return [(name, True) for name in names if name and "." not in name]
    kinds = (inspect.Parameter.VAR_KEYWORD, inspect.Parameter.VAR_POSITIONAL)
    return [
        (p.name, p.default is inspect.Parameter.empty)
        for p in signature.parameters.values()
        if p.kind not in kinds and p.name != "self"
    ]


class ArgumentsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = eomgen.Model.from_text(TEXT, "pendulum")
        cls.compiled = cls.model.compile(functions=["jac", "jac_u", "mass", "taylor", "jvp"])
        cls.simulation = cls.compiled.simulate(rtol=1e-8)

    def refuse(self, call, name):
        """The Error of a call, which names the argument and is in the words of Python."""
        with self.assertRaises(eomgen.Error) as caught:
            call()
        error = caught.exception
        report = str(error)
        for word in FOREIGN:
            self.assertNotIn(word, report)
        self.assertEqual(error.kind, "input", report)
        self.assertIn(name, report)
        self.assertTrue(error.remedy)
        return report

    def test_every_argument_of_every_call_refuses_a_value_of_no_meaning(self):
        x = self.compiled.start
        valid = {
            "t": 0.0, "x": x, "v": x, "h": 0.01, "order": 2, "path": "a.toml", "text": TEXT, "period": 0.1,
            "values": [0.0], "name": "F", "value": 1.0, "inputs": None, "every": 0.1, "times": [0.0, 1.0],
            "function": "jac", "state": self.simulation.save(), "points": None,
        }  # fmt: skip
        vectors = {"hvp": np.zeros(4), "inverse": [0.0], "regressor": [0.0]}
        system = self.compiled.linearize()
        for of, skipped in (
            (self.model, ("from_mjcf",)),
            (self.compiled, ()),
            (self.simulation, ()),
            (system, ()),
        ):
            count = 0
            for method_name in public_methods(of):
                if method_name in skipped:
                    continue
                method = getattr(of, method_name)
                listed = arguments_of(method)
                for name, _ in listed:
                    given = {other: valid[other] for other, needed in listed if needed and other != name}
                    if "v" in given:
                        given["v"] = vectors.get(method_name, x)
                    with self.subTest(f"{type(of).__name__}.{method_name}({name}=)"):
                        self.refuse(lambda: method(**given, **{name: Odd()}), name)
                        count += 1
            self.assertGreater(count, 0)
        for name in inspect.signature(eomgen.Simulation).parameters:
            if name != "model":
                self.refuse(lambda: eomgen.Simulation(self.compiled, **{name: Odd()}), name)
        self.refuse(lambda: eomgen.Simulation(Odd()), "model")

    def test_options_of_a_run_and_of_a_sweep_name_what_is_wrong(self):
        for call in (self.model.run, lambda **options: self.model.sweep(grid={"m": [1]}, **options)):
            for options, name, is_not in (
                ({"t_end": "abc"}, "t_end", "'abc' is not a number"),
                ({"rtol": [1e-9]}, "rtol", "is not a number"),
                ({"max_steps": 1.5}, "max_steps", "1.5 is not a whole number"),
                ({"max_steps": -1}, "max_steps", "-1 is not a whole number"),
                ({"outputs": [1]}, "outputs", "is not a list of names"),
                ({"error_estimate": "no"}, "error_estimate", "is not a truth value"),
                ({"scene": 3}, "scene", "3 is not text"),
                ({"parameters": [1, 2]}, "parameters", "is not a dictionary"),
                ({"parameters": {"m": None}}, "parameters['m']", "None is not a number"),
                ({"parameters": {3: 1.0}}, "a name in parameters", "3 is not text"),
                ({"t_end": 10**400}, "t_end", "is not a number"),
                ({"t_end": float("nan")}, "t_end", "is nan"),
            ):
                with self.subTest(name=name):
                    self.assertIn(is_not, self.refuse(lambda: call(**options), name))

    def test_arrays_of_compiled_functions_name_what_is_wrong(self):
        f, x = self.compiled, self.compiled.start
        self.assertIn("'abc' is not an array of numbers", self.refuse(lambda: f.rhs(0, "abc"), "x"))
        self.assertIn("is not an array of numbers", self.refuse(lambda: f.rhs("0", x), "t"))
        self.assertIn("is not an array of numbers", self.refuse(lambda: f.rhs(0, x + 1j), "x"))
        self.assertIn("is not an array of numbers", self.refuse(lambda: f.rhs(0, [[1, 2], [3]]), "x"))
        self.assertIn("has 3 dimensions", self.refuse(lambda: f.rhs(0, np.zeros((2, 2, 2))), "x"))
        self.assertIn("is not a whole number", self.refuse(lambda: f.rhs(0, x, mode="a"), "mode"))
        self.assertIn("is not a whole number", self.refuse(lambda: f.step(0, 0.1, x, mode=1 << 40), "mode"))
        self.assertIn("the result of the input F", self.refuse_input_function(lambda t: "abc"))
        message = self.refuse(lambda: self.simulation.set_inputs([1, 2]), "inputs")
        self.assertIn("give one number for each of them: F", message)
        self.refuse(lambda: self.simulation.set_parameters([1]), "parameters")
        with self.assertRaises(TypeError):  # what a program may catch too
            f.rhs(0, "abc")

    def refuse_input_function(self, function):
        simulation = self.compiled.simulate()
        simulation.set_input("F", function)
        return self.refuse(lambda: simulation.advance(0.1), "F")

    def test_objects_of_a_definition_name_what_is_wrong(self):
        self.refuse(lambda: eomgen.Definition().add(Odd()), "section")
        for call in (lambda: eomgen.Expression("m") * Odd(), lambda: eomgen.quantity(Odd(), "N")):
            with self.assertRaisesRegex(TypeError, "<odd> is no value of the model language"):
                call()

    def test_values_with_units_are_those_of_the_command_line(self):
        expected = self.model.run(parameters={"l": 0.5, "theta": np.pi / 6, "slope": np.pi / 18})
        texts = {"l": "50cm", "theta": "30 deg", "slope": "10deg"}
        self.assertAlmostEqual(self.model.run(parameters=texts).final["theta"], expected.final["theta"], places=14)
        np.testing.assert_allclose(self.compiled.values(texts).state, [np.pi / 6, 0], rtol=1e-15)
        np.testing.assert_allclose(self.compiled.state(theta="30 deg", theta_dot="180 deg/s"), [np.pi / 6, np.pi])
        simulation = self.compiled.simulate(parameters=texts)
        np.testing.assert_allclose(simulation.state(), [np.pi / 6, 0], rtol=1e-15)
        self.assertEqual(simulation.parameters()[1], 0.5)
        found = self.model.sweep({"l": ["50 cm", 0.6]}, grid={"theta": ["30 deg"]}, t_end=0.1)
        np.testing.assert_allclose(found.points, [[0.5, np.pi / 6], [0.6, np.pi / 6]], rtol=1e-15)
        self.assertEqual(self.model.linearize(parameters={"l": "50 cm"}).A.shape, (2, 2))
        self.assertEqual(self.compiled.linearize(inputs={"F": "2 kN"}).u[0], 2000)

    def test_units_of_another_dimension_are_refused(self):
        message = self.refuse(lambda: self.model.run(parameters={"l": "50 kg"}), "l")
        self.assertIn("is set in kg, and the model has it in m", message)
        self.assertIn("'furlong', which is no unit", self.refuse(lambda: self.model.run(parameters={"l": "5furlong"}), "l"))

    def test_text_without_a_unit_warns_where_the_model_has_another_unit_than_si(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            self.assertEqual(self.compiled.values({"slope": "0.1"}).parameters[2], 0.1)
        self.assertIn("the model states slope in deg, and 0.1 without a unit is in rad", str(caught[0].message))
        self.assertEqual(os.path.basename(caught[0].filename), os.path.basename(__file__))

    def test_files_may_be_paths(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(len(self.model.emit("c").write(folder)), len(os.listdir(folder)))
            self.refuse(lambda: self.model.emit("c").write(3), "folder")

    def test_a_new_kind_of_argument_needs_a_converter(self):
        with self.assertRaises(KeyError):

            @arguments.checked
            def method(self, name: "complex"):
                pass


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Every call of a Model, against results that are known."""

import math
import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import eomgen
import numpy as np

SOURCE = os.environ["EOMGEN_SOURCE"]

PENDULUM = """
format = 1
title = "Simple pendulum"
[parameters]
m = "1 kg"
l = "0.5 m"
g = "9.81 m/s^2"
[coordinates]
theta = "rad"
[[particle]]
name = "bob"
mass = "m"
position = ["l*sin(theta)", "-l*cos(theta)", 0]
[[force]]
gravity = "-g*E2"
[scene.default]
t = [0, 10]
initial = { theta = "60 deg" }
outputs = ["energy"]
"""


def shipped(name):
    return eomgen.Model.from_file(f"{SOURCE}/models/{name}.toml")


class ModelTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = eomgen.Model.from_text(PENDULUM, "pendulum")

    def test_a_model_has_names_and_its_text(self):
        self.assertEqual(self.model.name, "pendulum")
        self.assertEqual(self.model.title, "Simple pendulum")
        self.assertEqual(self.model.coordinates, ["theta"])
        self.assertEqual(self.model.parameters, ["m", "l", "g"])
        self.assertEqual(self.model.scenes, ["default"])
        self.assertEqual(self.model.text, PENDULUM)
        with open(f"{SOURCE}/models/cart_pendulum.toml", encoding="utf-8") as file:
            self.assertEqual(shipped("cart_pendulum").text, file.read())

    def test_errors_have_place_and_remedy(self):
        with self.assertRaises(eomgen.Error) as caught:
            eomgen.Model.from_text(PENDULUM.replace("-l*cos(theta)", "-l*cos(thet)"))
        error = caught.exception
        self.assertEqual((error.file, error.line, error.column), ("model.toml", 13, 37))
        self.assertEqual(error.kind, "input")
        self.assertEqual(error.exit_code, 2)
        self.assertIn("theta", error.remedy)
        self.assertIn("thet", error.source_line)
        self.assertIn("remedy", str(error))
        again = pickle.loads(pickle.dumps(error))
        self.assertEqual((again.line, again.remedy, str(again)), (error.line, error.remedy, str(error)))

    def test_warnings_have_places(self):
        model = eomgen.Model.from_text(PENDULUM.replace('m = "1 kg"', 'm = "1 kg"\nunused = "2 m"'))
        (warning,) = model.warnings
        self.assertEqual(warning.line, 6)
        self.assertIn("unused", warning.message)

    def test_check_has_units_and_classes(self):
        found = self.model.check()
        self.assertEqual(found.degrees_of_freedom, 1)
        self.assertEqual(found.coordinates, [("theta", "rad", "")])
        self.assertEqual(found.parameters[1], ("l", "m", "0.5"))
        self.assertEqual(found.forces[0].conservative, "yes")
        self.assertEqual(found.conserved[0].name, "energy")

    def test_derive_gives_text_and_latex(self):
        equations = self.model.derive()
        self.assertEqual(equations["explicit"][0].text, "m l^2 theta_ddot + m l g sin(theta) = 0")
        self.assertIn("\\ddot{\\theta}", equations.latex("explicit"))
        self.assertTrue(equations._repr_latex_().startswith("$$"))
        self.assertIn("\\dot{\\theta}", equations["equations"][0]._repr_latex_())
        self.assertIn("\\documentclass", self.model.document())

    def test_verify_and_emit(self):
        certificate = self.model.verify(points=5, compile=False)
        self.assertTrue(certificate)
        self.assertEqual(certificate.points, 5)
        sources = self.model.emit("python", functions="jac")
        self.assertIn("pendulum.py", sources.files)
        with tempfile.TemporaryDirectory() as folder:
            paths = sources.write(folder)
            self.assertTrue(all(os.path.getsize(path) > 0 for path in paths))
        with self.assertRaises(eomgen.Error):
            self.model.emit("fortran")

    def test_run_has_arrays_units_and_an_error_estimate(self):
        motion = self.model.run(rtol=1e-10, atol=1e-12, every=0.1)
        self.assertTrue(motion.is_complete)
        self.assertEqual(motion.rows.shape, (101, 3))
        self.assertEqual(motion.rows.dtype, np.float64)
        np.testing.assert_allclose(motion.times, np.arange(101) * 0.1, atol=1e-14)
        self.assertEqual(motion.units["theta_dot"], "rad/s")
        # The period of a pendulum by the arithmetic-geometric mean: after whole periods it is at its start.
        a, b = 1.0, math.cos(math.pi / 6)
        while abs(a - b) > 1e-15:
            a, b = (a + b) / 2, math.sqrt(a * b)
        period = 2 * math.pi / a * math.sqrt(0.5 / 9.81)
        end = self.model.run(t_end=6 * period, rtol=1e-10, atol=1e-12)
        error = abs(end.final["theta"] - math.pi / 3)
        self.assertLess(error, 10 * max(end.error_estimate["theta"], 1e-11))
        self.assertEqual(pickle.loads(pickle.dumps(motion)), motion)
        self.assertNotEqual(motion, end)

    def test_rows_go_to_a_function(self):
        seen = []
        motion = self.model.run(t_end=1, every=0.25, row=lambda t, values: seen.append((t, values.copy())))
        self.assertEqual([t for t, _ in seen], [0, 0.25, 0.5, 0.75, 1])
        self.assertEqual(len(motion.times), 0)
        self.assertEqual(seen[0][1].shape, (3,))

        def fail(t, values):
            raise ValueError("no more")

        with self.assertRaisesRegex(ValueError, "no more"):
            self.model.run(row=fail)

    def test_sweep_equals_single_runs(self):
        found = self.model.sweep(grid={"l": [0.5, 0.7], "theta": [0.1, 0.2, 0.3]}, t_end=2, jobs=3)
        self.assertEqual(len(found), 6)
        np.testing.assert_array_equal(found.given("theta"), [0.1, 0.2, 0.3] * 2)
        for k in range(6):
            one = self.model.run(parameters={"l": found.given("l")[k], "theta": found.given("theta")[k]}, t_end=2)
            self.assertEqual(found.final[k].tolist(), [one.final[name] for name in found.columns])
            self.assertEqual(found.errors[k], one.error_estimate["max"])
        both = self.model.sweep({"m": [1, 2]}, grid={"l": [1, 2]}, t_end=0.1, error_estimate=False)
        self.assertEqual(both.points.tolist(), [[1, 1], [1, 2], [2, 1], [2, 2]])
        self.assertIsNone(both.errors)
        self.assertEqual(found["theta"].tolist(), found.final[:, found.columns.index("theta")].tolist())
        with self.assertRaises(KeyError):
            found["l"]
        with self.assertRaises(eomgen.Error):
            self.model.sweep({"nothing": [1, 2]})
        with self.assertRaises(TypeError):
            self.model.sweep({"m": [1]}, rtoll=1e-3)

    def test_linearize_and_equilibria(self):
        cart = shipped("cart_pendulum")
        upright = {"theta": math.pi}
        at = cart.linearize(parameters=upright)
        self.assertEqual(at.states, ["x", "theta", "x_dot", "theta_dot"])
        self.assertEqual(at.A.shape, (4, 4))
        self.assertEqual(at.B.shape, (4, 1))
        self.assertAlmostEqual(at.B[2, 0], 1 / 2)  # 1/M
        self.assertAlmostEqual(at.B[3, 0], 1 / (2 * 0.8))  # 1/(M l)
        measured = cart.linearize(parameters=upright, outputs=["theta", "theta_ddot"])
        self.assertEqual(measured.outputs, ["theta", "theta_ddot"])
        np.testing.assert_allclose(measured.C, [[0, 1, 0, 0], at.A[3]])
        np.testing.assert_allclose(measured.D, [[0], at.B[3]])
        self.assertAlmostEqual(measured.output_values[0], math.pi)
        np.testing.assert_allclose(np.sort(np.linalg.eigvals(at.A).real), np.sort(at.eigenvalues.real), atol=1e-9)
        found = self.model.equilibria()
        self.assertEqual({m.stability for m in found}, {"stable", "unstable"})

    def test_inverse_dynamics(self):
        found = shipped("R9_robot_arm").inverse(t_end=1, every=0.5)
        self.assertEqual(found.outcome, "done")
        self.assertEqual(found.rows.shape, (3, len(found.columns)))
        self.assertTrue(set(found.forces) <= set(found.columns))

    def test_bench_and_stress(self):
        found = self.model.bench(solvers=["dop853"], t_end=1, max_seconds=1)
        self.assertTrue(found.conclusive)
        self.assertEqual({row.solver for row in found.rows}, {"dop853"})
        tested = self.model.stress(solvers="dop853", quick=True, max_seconds=2, t_end=1)
        self.assertEqual(tested.undetected, 0)
        self.assertEqual(tested.passed + tested.reported, len(tested.rows))

    def test_report_is_one_page(self):
        page = self.model.report(t_end=1, parameters={"theta": 0.1})
        self.assertIn("Simple pendulum", page.html)
        self.assertIn("<iframe", page._repr_html_())
        with self.assertRaisesRegex(eomgen.Error, "nothing"):
            self.model.report(parameters={"nothing": 1})

    def test_models_are_pickled(self):
        again = pickle.loads(pickle.dumps(self.model))
        self.assertEqual((again.name, again.text), (self.model.name, self.model.text))

    def test_a_csv_file_beside_the_model_is_an_input(self):
        text = """
format = 1
[inputs]
F = {}
[coordinates]
x = {}
[[particle]]
name = "P"
mass = 1
position = ["x", 0, 0]
[[force]]
on = "P"
force = "F*E1"
[scene.default]
t = [0, 2]
initial = { x = 0 }
inputs = { F = { csv = "force.csv", interpolation = "linear" } }
"""
        with tempfile.TemporaryDirectory() as folder:
            for name, content in (("push.toml", text), ("force.csv", "t,F\n0,0\n1,3\n")):
                with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                    file.write(content)
            read = eomgen.Model.from_file(os.path.join(folder, "push.toml"))
            for model in (read, eomgen.Model.from_text(text, folder=folder), pickle.loads(pickle.dumps(read))):
                # x'' = 3 t until 1 s, then 3: x(1) = 1/2, x'(1) = 3/2.
                self.assertAlmostEqual(model.run(rtol=0.1, atol=0.1).final["x"], 0.5 + 1.5 + 1.5, 13)
            self.assertEqual(read.compile().rhs(0.5, [0, 0]).tolist(), [0, 1.5])
        with self.assertRaisesRegex(eomgen.Error, "a model that is given as text names no files"):
            eomgen.Model.from_text(text)

    def test_progress_may_end_a_run(self):
        fractions = []

        def progress(fraction):
            fractions.append(fraction)
            return len(fractions) < 3

        motion = self.model.run(t_end=1e6, on_progress=progress, error_estimate=False)
        self.assertEqual(motion.outcome, "interrupted")
        self.assertGreater(motion.t, 0)
        self.assertEqual(len(fractions), 3)

    def test_exceptions_of_callbacks_reach_the_caller(self):
        def fail(*_):
            raise KeyError("stage")

        with self.assertRaises(KeyError):
            eomgen.Model.from_text(PENDULUM.replace("0.5 m", "0.51 m")).derive(on_stage=fail)

    def test_a_callback_may_call_the_library(self):
        seen = []
        other = eomgen.Model.from_text(PENDULUM.replace("0.5 m", "0.53 m"))
        self.model.verify(points=2, compile=False, on_stage=lambda stage: seen.append(other.check().degrees_of_freedom))
        self.assertEqual(set(seen), {1})

    def test_runs_of_threads_go_on_at_once(self):
        counts = [0]
        end = threading.Event()

        def count():
            while not end.is_set():
                counts[0] += 1

        thread = threading.Thread(target=count)
        thread.start()
        before = counts[0]
        self.model.run(t_end=2000, error_estimate=False)
        during = counts[0] - before
        end.set()
        thread.join()
        self.assertGreater(during, 1000)


class InterruptTest(unittest.TestCase):
    """Ctrl-C ends long calls. Each runs in a program of its own, which gets a signal."""

    def interrupt(self, body, after=0.5):
        program = (
            "import eomgen, sys, time, signal\n"
            f"model = eomgen.Model.from_text({PENDULUM!r})\n"
            "model.run(t_end=1)\nprint('ready', flush=True)\n" + body
        )
        child = subprocess.Popen(
            [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        self.assertEqual(child.stdout.readline(), "ready\n")
        time.sleep(after)
        start = time.monotonic()
        child.send_signal(signal.SIGINT)
        out, err = child.communicate(timeout=60)
        return out, err, time.monotonic() - start

    def test_a_run_ends_with_keyboard_interrupt(self):
        out, _, seconds = self.interrupt(
            "try:\n  model.run(t_end=1e9, error_estimate=False)\n  print('ran')\nexcept KeyboardInterrupt: print('interrupted')\n"
        )
        self.assertEqual(out, "interrupted\n")
        self.assertLess(seconds, 5)

    def test_a_sweep_ends_with_keyboard_interrupt(self):
        out, _, seconds = self.interrupt(
            "try: model.sweep({'m': [1, 2, 3]}, t_end=1e9, error_estimate=False)\nexcept KeyboardInterrupt: print('interrupted')\n"
        )
        self.assertEqual(out, "interrupted\n")
        self.assertLess(seconds, 5)

    def test_a_handler_that_raises_nothing_ends_nothing(self):
        out, err, _ = self.interrupt(
            "signal.signal(signal.SIGINT, lambda *_: print('signal', flush=True))\n"
            "print(model.run(t_end=2e4, error_estimate=False, max_steps=10**9).outcome)\n",
            after=0.05,
        )
        self.assertEqual(out, "signal\ndone\n", err)


class PlotTest(unittest.TestCase):
    def test_a_plot_is_an_svg_picture_of_the_columns(self):
        from xml.etree import ElementTree

        table = eomgen.records.Table(columns=["a<b", "v"], times=np.array([0.0, 1.0]), rows=np.array([[1.0, 2.0], [3.0, 4.0]]))
        for names in ([], ["v"]):
            root = ElementTree.fromstring(table.svg(*names))
            self.assertTrue(root.tag.endswith("svg"))
            texts = "".join(root.itertext())
            self.assertIn("v", texts)
            self.assertEqual("a<b" in texts, not names)
        with self.assertRaises(KeyError):
            table.svg("w")


if __name__ == "__main__":
    unittest.main()

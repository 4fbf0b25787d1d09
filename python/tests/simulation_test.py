# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulations that Python advances: against runs, controllers, tables, saved states, interruption."""

import math
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import unittest

import eomgen
import numpy as np

SOURCE = os.environ["EOMGEN_SOURCE"]


def shipped(name):
    return eomgen.Model.from_file(f"{SOURCE}/models/{name}.toml")


class SimulationTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = shipped("cart_pendulum")
        cls.f = cls.model.compile()

    def test_pieces_give_the_motion_of_a_run(self):
        simulation = eomgen.Simulation(self.f, rtol=1e-11, atol=1e-13)
        for k in range(20):
            end = simulation.advance(0.1 * (k + 1))
            self.assertEqual(end.outcome, "done")
        final = self.model.run(t_end=2, rtol=1e-11, atol=1e-13).final
        self.assertAlmostEqual(simulation.t, 2)
        np.testing.assert_allclose(simulation.state(), [final[name] for name in self.f.state_names], atol=1e-9)
        np.testing.assert_array_equal(simulation.outputs()[:4], [final_of(simulation, n) for n in self.f.output_names[:4]])

    def test_pieces_follow_resets_and_samples_of_the_model(self):
        for name in ("thermostat", "clock_escapement", "sampled_cart_pole", "rimless_wheel"):
            with self.subTest(name):
                model = shipped(name)
                run = model.run(rtol=1e-11, atol=1e-12, error_estimate=False)
                simulation = model.compile().simulate(rtol=1e-11, atol=1e-12)
                events = []
                for k in range(1, 8):  # also from a state that was saved between two changes
                    simulation.restore(simulation.save())
                    events += simulation.advance(run.t * k / 7).events
                self.assertEqual([e.name for e in events], [e.name for e in run.events])
                expected = [run.final[state] for state in simulation.model.state_names]
                np.testing.assert_allclose(simulation.state(), expected, rtol=1e-7, atol=1e-9)

    def test_inputs_are_held_functions_or_tables(self):
        # Momentum of cart and pendulum without friction: F integrated over time.
        def momentum(simulation):
            x = simulation.state()
            return (M + m) * x[2] + m * l * math.cos(x[1]) * x[3]

        M, m, l = 2.0, 0.5, 0.8
        free = eomgen.Model.from_text(self.model.text.replace('c = "0.1 N*s/m"', 'c = "0 N*s/m"')).compile()
        simulation = free.simulate(rtol=1e-10, atol=1e-12)
        simulation.set_inputs([3.0])
        simulation.advance(0.5)
        self.assertAlmostEqual(momentum(simulation), 1.5, places=8)
        self.assertEqual(simulation.inputs().tolist(), [3.0])
        simulation.set_input("F", lambda t: math.cos(t))
        simulation.advance(1.5)
        self.assertAlmostEqual(momentum(simulation), 1.5 + math.sin(1.5) - math.sin(0.5), places=8)
        simulation.set_input("F", 0)
        start = momentum(simulation)
        simulation.follow(3, [1.5, 2, 2.5], [[0], [2], [0]])
        self.assertAlmostEqual(momentum(simulation), start + 1, places=8)
        with self.assertRaises(eomgen.Error):
            simulation.follow(4, [1, 1], [[0], [1]])
        with self.assertRaisesRegex(eomgen.Error, "no input"):
            simulation.set_input("G", 1)
        with self.assertRaises(eomgen.Error):
            simulation.set_inputs([1, 2])

    def test_a_sampled_controller_holds_the_pendulum_upright(self):
        at = self.model.linearize(parameters={"theta": math.pi})
        A, B = at.A, at.B
        X = np.eye(4)
        for _ in range(20000):  # Riccati's equation, to its steady state
            X = X + 1e-3 * (A.T @ X + X @ A - X @ B @ B.T @ X + np.eye(4))
        K = (B.T @ X)[0]
        simulation = self.f.simulate(parameters={"theta": math.pi - 0.1})
        calls = []

        def u(t, x):
            calls.append(t)
            return [-K @ (x - [0, math.pi, 0, 0])]

        end = simulation.control(15.0, u, 1e-2)
        self.assertEqual(end.outcome, "done")
        self.assertEqual(len(calls), 1500)
        self.assertAlmostEqual(simulation.state()[1], math.pi, places=3)

        def fail(t, x):
            raise ValueError("controller")

        with self.assertRaisesRegex(ValueError, "controller"):
            simulation.control(16, fail, 0.1)
        simulation.set_input("F", lambda t: fail(t, None))
        with self.assertRaisesRegex(ValueError, "controller"):
            simulation.advance(17)

    def test_save_and_restore_continue_with_the_same_bits(self):
        simulation = self.f.simulate()
        simulation.set_inputs([0.3])
        simulation.advance(1)
        saved = simulation.save()
        self.assertEqual(saved.t, 1)
        simulation.advance(2)
        other = self.f.simulate()
        other.restore(saved)
        other.advance(2)
        np.testing.assert_array_equal(other.state(), simulation.state())
        with self.assertRaises(eomgen.Error):
            shipped("P2_planar_pendulum").compile().simulate().restore(saved)
        with self.assertRaises(TypeError):
            pickle.dumps(simulation)

    def test_steps_states_parameters_and_rows(self):
        simulation = self.f.simulate(every=0.25)
        end = simulation.advance(1)
        self.assertEqual(end.times.tolist(), [0, 0.25, 0.5, 0.75, 1][-len(end.times) :])
        self.assertEqual(end.rows.shape, (len(end.times), len(self.f.output_names)))
        before = simulation.t
        one = simulation.step()
        self.assertEqual(one.steps, 1)
        self.assertGreater(simulation.t, before)
        simulation.set_state(5.0, [0, 1, 0, 0])
        self.assertEqual((simulation.t, simulation.state().tolist()), (5.0, [0, 1, 0, 0]))
        parameters = simulation.parameters()
        parameters[1] = 0.7
        simulation.set_parameters(parameters)
        self.assertEqual(simulation.parameters()[1], 0.7)
        with self.assertRaises(eomgen.Error):
            simulation.advance(4)
        with self.assertRaises(TypeError):
            simulation.advance("late")

    def test_events_of_contacts(self):
        ball = shipped("bouncing_ball").compile()
        end = ball.simulate().advance(ball.span[1])
        self.assertTrue(end.events)
        self.assertIn("contact", {event.kind for event in end.events})
        impact = next(event for event in end.events if event.kind == "contact")
        self.assertGreater(impact.impulses[0].normal, 0)
        self.assertAlmostEqual(sum(one.work for one in impact.impulses), impact.work)

    def test_simulations_of_threads_are_independent(self):
        def run(results, k):
            simulation = self.f.simulate(parameters={"theta": 0.1 * k})
            for step in range(200):
                simulation.advance(0.01 * (step + 1))
            results[k] = simulation.state().tolist()

        at_once, alone = {}, {}
        threads = [threading.Thread(target=run, args=(at_once, k)) for k in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for k in range(8):
            run(alone, k)
        self.assertEqual(at_once, alone)

    def test_interrupt_ends_an_advance(self):
        program = (
            "import eomgen, os\n"
            f"f = eomgen.Model.from_file({SOURCE + '/models/P2_planar_pendulum.toml'!r}).compile()\n"
            "s = f.simulate(max_steps=10**12)\nprint('ready', flush=True)\n"
            "try: s.advance(1e9)\n"
            "except KeyboardInterrupt: print('interrupted', 0 < s.t < 1e9)\n"
        )
        child = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
        self.assertEqual(child.stdout.readline(), "ready\n")
        time.sleep(0.3)
        child.send_signal(signal.SIGINT)
        self.assertEqual(child.communicate(timeout=60)[0], "interrupted True\n")


def final_of(simulation, name):
    return simulation.state()[simulation.model.state_names.index(name)]


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Models from robot files, against the formulas of a pendulum."""

import math
import os
import pickle
import tempfile
import unittest
import warnings

import eomgen
import numpy as np

PENDULUM = """<?xml version="1.0"?>
<robot name="swing">
  <link name="world"/>
  <link name="arm">
    <inertial>
      <origin xyz="0 0 -0.4"/>
      <mass value="1.5"/>
      <inertia ixx="0.02" ixy="0" ixz="0" iyy="0.03" iyz="0" izz="0.01"/>
    </inertial>
    <visual><geometry><sphere radius="0.1"/></geometry></visual>
  </link>
  <joint name="hinge" type="continuous">
    <parent link="world"/>
    <child link="arm"/>
    <axis xyz="0 1 0"/>
  </joint>
</robot>
"""


class RobotTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = os.path.join(self.folder.name, "swing.urdf")
        with open(self.path, "w") as file:
            file.write(PENDULUM)

    def model(self, **options):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", eomgen.ModelWarning)
            return eomgen.Model.from_urdf(self.path, **options)

    def test_a_joint_is_a_pendulum(self):
        model = self.model(actuators="all")
        self.assertEqual((model.name, model.coordinates, model.inputs), ("swing", ["hinge"], ["u_hinge"]))
        f = model.compile()
        q, u = 0.7, 0.3
        inertia = 0.03 + 1.5 * 0.4**2
        gravity = float(f.parameters[model.parameters.index("g")])
        expected = (u - 1.5 * gravity * 0.4 * math.sin(q)) / inertia
        np.testing.assert_allclose(f.rhs(0.0, [q, 0.2], [u]), [0.2, expected], rtol=1e-12)
        self.assertEqual(pickle.loads(pickle.dumps(model)).text, model.text)

    def test_an_mjcf_file_is_the_same_pendulum(self):
        path = os.path.join(self.folder.name, "swing.xml")
        with open(path, "w") as file:
            file.write(
                '<mujoco><worldbody><body name="arm"><joint name="hinge" axis="0 1 0"/><inertial pos="0 0 -0.4" '
                'mass="1.5" diaginertia="0.02 0.03 0.01"/></body></worldbody><actuator><motor joint="hinge"/>'
                "</actuator></mujoco>"
            )
        model = eomgen.Model.from_mjcf(path)
        self.assertEqual((model.name, model.coordinates, model.inputs), ("swing", ["hinge"], ["u_hinge"]))
        ours, urdf = model.compile(), self.model(actuators="all").compile()
        np.testing.assert_allclose(ours.rhs(0.0, [0.7, 0.2], [0.3]), urdf.rhs(0.0, [0.7, 0.2], [0.3]), rtol=1e-14)

    def test_a_floating_robot_has_six_further_coordinates(self):
        self.assertEqual(len(self.model(floating=True).coordinates), 7)

    def test_errors_name_the_place_and_the_words(self):
        with open(self.path, "w") as file:
            file.write(PENDULUM.replace('mass value="1.5"', 'mass value="heavy"'))
        with self.assertRaises(eomgen.Error) as caught:
            self.model()
        self.assertTrue(caught.exception.file.endswith("swing.urdf"))
        self.assertEqual(caught.exception.line, 7)
        with self.assertRaisesRegex(eomgen.Error, "friction does not take 'wet'"):
            self.model(friction="wet")


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""The wheel: its content, and a program that has nothing but it and NumPy."""

import os
import subprocess
import sys
import tempfile
import unittest
import zipfile

SOURCE, BUILD = os.environ["EOMGEN_SOURCE"], os.environ["EOMGEN_BUILD"]
sys.path.insert(0, f"{SOURCE}/python/backend")
import eomgen_wheel  # noqa: E402

PROGRAM = """
import sys, time
start = time.perf_counter()
import eomgen
assert time.perf_counter() - start < 0.1, "import takes more than 0.1 s"
assert eomgen.__file__.startswith(sys.argv[1]), eomgen.__file__
model = eomgen.Model.from_text('''
format = 1
[coordinates]
x = "m"
[[particle]]
name = "P"
mass = "1 kg"
position = ["x", 0, 0]
[[force]]
on = "P"
force = ["-4[N/m]*x", 0, 0]
[scene.default]
t = [0, 1]
initial = { x = 1 }
''')
assert abs(model.run().final["x"] + 0.41614683654714241) < 1e-7
assert model.compile().rhs(0.0, [1, 0]).tolist() == [0, -4]
assert "<html" in model.report().html
for line in open("/proc/self/maps"):
    path = line.split()[-1]
    if any(name in path for name in ("libeomgen", "libginac", "libcln", "libgmp", "libfmt", "libtomlplusplus")):
        assert path.startswith(sys.argv[1]), path
print("done")
"""


class WheelTest(unittest.TestCase):
    def test_a_program_needs_the_wheel_and_numpy_alone(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = os.path.realpath(folder)
            built = subprocess.run(
                [sys.executable, "-c", "import sys, eomgen_wheel as w\nprint(w.build_wheel(sys.argv[1], {'build-dir': sys.argv[2]}))",
                 folder, BUILD],
                env={**os.environ, "PYTHONPATH": f"{SOURCE}/python/backend"}, capture_output=True, text=True,
            )  # fmt: skip
            self.assertEqual(built.returncode, 0, built.stdout + built.stderr)
            wheel = os.path.join(folder, built.stdout.splitlines()[-1])
            site = os.path.join(folder, "site")
            with zipfile.ZipFile(wheel) as archive:
                names = archive.namelist()
                self.assertIn("eomgen/py.typed", names)
                self.assertTrue(any(name.endswith("licenses/LICENSE") for name in names))
                recorded = archive.read(next(n for n in names if n.endswith("RECORD"))).decode().split("\n")
                self.assertEqual(sorted(line.split(",")[0] for line in recorded if line), sorted(names))
            pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "install", "-q", "--no-index", "--no-deps", "--target", site, wheel]
            if subprocess.run(pip, capture_output=True).returncode != 0:  # without pip
                with zipfile.ZipFile(wheel) as archive:
                    for entry in archive.infolist():
                        path = archive.extract(entry, site)
                        os.chmod(path, entry.external_attr >> 16)
            clean = {"PATH": "/usr/bin:/bin", "PYTHONPATH": site, "EOMGEN_CACHE_DIR": folder, "HOME": folder}
            done = subprocess.run([sys.executable, "-c", PROGRAM, site], env=clean, cwd=folder, capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout), (0, "done\n"), done.stderr)
            version = subprocess.run([sys.executable, "-m", "eomgen", "--version"], env=clean, cwd=folder, capture_output=True, text=True)
            self.assertTrue(version.stdout.startswith("eomgen " + eomgen_wheel.version()), version.stderr)


if __name__ == "__main__":
    unittest.main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds the wheel (PEP 517) by CMake's component `python`. It needs the standard library alone.

Config setting `build-dir`: a configured build folder, from the top of the source tree; without it build/wheel is configured.
"""
import base64
import hashlib
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

PYTHON = pathlib.Path(__file__).resolve().parent.parent
ROOT = PYTHON.parent
TARGETS = ["eomgen_python", "eomgen_python_program"]
EARLIEST = (1980, 1, 1, 0, 0, 0)  # that a ZIP file can state: equal content gives equal bytes


def get_requires_for_build_wheel(config_settings=None):
    return []


def build_sdist(sdist_directory, config_settings=None):
    raise SystemExit("eomgen: build the wheel from the source tree: python3 -m build --wheel python")


def version():
    header = (ROOT / "lib/eom/version.hpp").read_text()
    return ".".join(re.search(rf"EOM_VERSION_{part} (\d+)", header)[1] for part in ("MAJOR", "MINOR", "PATCH"))


def project():
    try:
        import tomllib
    except ImportError:
        import tomli as tomllib
    return tomllib.loads((PYTHON / "pyproject.toml").read_text())["project"]


def metadata():
    p = project()
    lines = [
        "Metadata-Version: 2.1",
        f"Name: {p['name']}",
        f"Version: {version()}",
        f"Summary: {p['description']}",
        f"License: {p['license']['text']}",
        f"Requires-Python: {p['requires-python']}",
        "Description-Content-Type: text/markdown",
        *(f"Requires-Dist: {each}" for each in p["dependencies"]),
    ]
    for extra, needed in p["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}", *(f'Requires-Dist: {each} ; extra == "{extra}"' for each in needed)]
    return "\n".join(lines) + "\n\n" + (PYTHON / p["readme"]).read_text()


def tag():
    interpreter = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{interpreter}-{interpreter}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def configured(settings):
    """A build folder in which CMake has configured this Python."""
    given = (settings or {}).get("build-dir")
    if given:
        return (ROOT / given).resolve()
    folder = ROOT / "build/wheel"
    generator = ["-G", "Ninja"] if shutil.which("ninja") else []
    subprocess.run(
        ["cmake", "-S", ROOT, "-B", folder, *generator, "-DCMAKE_BUILD_TYPE=Release", "-DEOMGEN_BUILD_TESTS=OFF",
         f"-DPython3_EXECUTABLE={sys.executable}"],
        check=True,
    )  # fmt: skip
    return folder


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    folder = configured(config_settings)
    jobs = str(len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1)
    subprocess.run(["cmake", "--build", folder, "--parallel", jobs, "--target", *TARGETS], check=True)
    name = f"{project()['name']}-{version()}"
    wheel = f"{name}-{tag()}.whl"
    with tempfile.TemporaryDirectory() as scratch:
        content = pathlib.Path(scratch)
        subprocess.run(["cmake", "--install", folder, "--component", "python", "--strip", "--prefix", content], check=True)
        about = content / f"{name}.dist-info"
        (about / "licenses").mkdir(parents=True)
        shutil.copy(ROOT / "LICENSE", about / "licenses/LICENSE")
        shutil.copy(ROOT / "templates/LICENSE", about / "licenses/LICENSE.emitted-code")
        shutil.copy(ROOT / "docs/licensing.md", about / "licenses/licensing.md")
        (about / "METADATA").write_text(metadata())
        (about / "WHEEL").write_text(f"Wheel-Version: 1.0\nGenerator: eomgen\nRoot-Is-Purelib: false\nTag: {tag()}\n")
        scripts = "".join(f"{script} = {target}\n" for script, target in project()["scripts"].items())
        (about / "entry_points.txt").write_text("[console_scripts]\n" + scripts)
        write(content, about, pathlib.Path(wheel_directory) / wheel)
    return wheel


def write(content, about, wheel):
    record = []
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:

        def add(path, data, mode):
            entry = zipfile.ZipInfo(path, EARLIEST)
            entry.external_attr = (0o100000 | mode) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, data)

        for file in sorted(path for path in content.rglob("*") if path.is_file()):
            path, data = file.relative_to(content).as_posix(), file.read_bytes()
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append(f"{path},sha256={digest},{len(data)}\n")
            add(path, data, 0o755 if os.access(file, os.X_OK) else 0o644)
        path = f"{about.name}/RECORD"
        add(path, "".join(record) + f"{path},,\n", 0o644)

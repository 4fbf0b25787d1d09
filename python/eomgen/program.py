# SPDX-License-Identifier: GPL-3.0-or-later
"""The program eomgen, which the package brings along: commands that are of the command line alone."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from typing import List, Optional

from .errors import Error, input_error


def find_program() -> str:
    """The path of the program: $EOMGEN, that of the package, or one on the PATH."""
    beside = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin", "eomgen")
    for path in (os.environ.get("EOMGEN"), beside, shutil.which("eomgen")):
        if path and os.access(path, os.X_OK):
            return path
    raise input_error("the program eomgen is not found", "install it, or name it in the environment variable EOMGEN")


def call_program(arguments: List[str], folder: Optional[str] = None) -> str:
    """Runs the program in a folder and returns what it prints. Throws Error if it fails."""
    import json

    done = subprocess.run([find_program(), *arguments, "--json"], cwd=folder, capture_output=True, text=True)
    if done.returncode == 0:
        return done.stdout
    kind = {1: "check", 3: "numerical", 4: "tool"}.get(done.returncode, "input")
    report = done.stderr
    try:
        report = json.loads(done.stdout)["error"] if not report else report
    except (ValueError, KeyError):
        pass
    raise Error(report or f"eomgen {arguments[0]} failed with exit code {done.returncode}", arguments[0], kind=kind)


def main() -> None:
    """The command line: ``python3 -m eomgen check pendulum.toml``."""
    try:
        program = find_program()
    except Error as error:
        sys.exit(str(error))
    os.execv(program, [program, *sys.argv[1:]])

# SPDX-License-Identifier: GPL-3.0-or-later
"""Exceptions and warnings of the package."""

from __future__ import annotations

import os
import sys
import warnings


class Error(Exception):
    """An error of a model, of an option, of a run, or of a tool.

    ``str(error)`` is the whole report, as the command line prints it. ``file``, ``line`` and ``column`` are the place
    in the model (counted from 1; 0 and "" if there is none), ``length`` the number of characters there, and
    ``source_line`` the line itself. ``message`` is the error, ``remedy`` what to do. ``stage`` is the part of eomgen
    that found it. ``kind`` is "input", "check", "numerical" or "tool".
    """

    def __init__(
        self,
        report: str,
        stage: str = "",
        file: str = "",
        line: int = 0,
        column: int = 0,
        length: int = 1,
        source_line: str = "",
        message: str = "",
        remedy: str = "",
        kind: str = "input",
    ) -> None:
        super().__init__(report, stage, file, line, column, length, source_line, message, remedy, kind)
        self.report = report
        self.stage = stage
        self.file = file
        self.line = line
        self.column = column
        self.length = length
        self.source_line = source_line
        self.message = message or report
        self.remedy = remedy
        self.kind = kind

    def __str__(self) -> str:
        return self.report.rstrip("\n")

    @property
    def exit_code(self) -> int:
        """The exit code of the command line: 1 check, 2 input, 3 numerical, 4 tool."""
        return {"check": 1, "input": 2, "numerical": 3, "tool": 4}[self.kind]


class ArgumentError(Error, TypeError):
    """An Error about the type of an argument, which programs may also catch as a TypeError."""


def input_error(message: str, remedy: str, stage: str = "python") -> Error:
    """An Error without a place in a file."""
    return Error(f"error: {message}\n  remedy: {remedy}", stage, message=message, remedy=remedy)


class Interrupted(Exception):
    """A callback ended a call that has no partial result."""


class ModelWarning(UserWarning):
    """A warning about a model or a result."""


def warn(text: str) -> None:
    """A ModelWarning at the line that called the package."""
    folder = os.path.dirname(__file__)
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == folder:
        level, frame = level + 1, frame.f_back
    warnings.warn(text.rstrip("\n"), ModelWarning, stacklevel=level)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Equations of motion as data, and as expressions of SymPy."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Callable, Dict, List, Tuple

from .records import Record


class Derivation(Record):
    """M qddot = f + A^T lambda, A qddot + gamma = 0, for n free coordinates and m constraints with multipliers.

    ``nodes``: (operation, text, operands) with operands before their users. ``M`` (n x n, by rows), ``f`` (n), ``A``
    (m x n, by rows), ``gamma`` (m), ``kinetic`` and ``potential`` are numbers of nodes. ``to_sympy`` makes
    expressions of them.
    """

    approach: str
    formulation: str
    coordinates: List[str]
    constraints: List[str]
    nodes: List[Tuple[str, str, Tuple[int, ...]]]
    M: List[int]
    f: List[int]
    A: List[int]
    gamma: List[int]
    kinetic: int
    potential: int

    def to_sympy(self, functions_of_time: bool = False) -> "SympyEquations":
        """The equations as expressions of SymPy, which has to be installed.

        Names of the model are real symbols: ``q``, ``q_dot``. ``functions_of_time``: coordinates are functions q(t)
        instead, and rates their derivatives.
        """
        sympy: Any = import_module("sympy")
        values: List[Any] = []
        symbols: Dict[str, Any] = {}
        t = sympy.Symbol("t", real=True)

        def symbol(name: str) -> Any:
            if name == "t":
                return t
            if name not in symbols:
                symbols[name] = _symbol(sympy, name, self.coordinates, t if functions_of_time else None)
            return symbols[name]

        operations = _operations(sympy)
        for operation, text, operands in self.nodes:
            arguments = [values[i] for i in operands]
            if operation == "number":
                values.append(sympy.Rational(text))
            elif operation == "pi":
                values.append(sympy.pi)
            elif operation == "symbol":
                values.append(symbol(text))
            elif operation == "^":
                values.append(arguments[0] ** (arguments[1] if len(arguments) == 2 else sympy.Integer(text)))
            else:
                values.append(operations[operation](*arguments))
        n, m = len(self.coordinates), len(self.constraints)
        rates = [_symbol(sympy, name + "_ddot", self.coordinates, t if functions_of_time else None) for name in self.coordinates]
        return SympyEquations(
            t=t,
            symbols=symbols,
            coordinates=[symbol(name) for name in self.coordinates],
            accelerations=sympy.Matrix(n, 1, rates),
            multipliers=sympy.Matrix(m, 1, [sympy.Symbol(f"lambda_{k + 1}", real=True) for k in range(m)]),
            M=sympy.Matrix(n, n, [values[i] for i in self.M]),
            f=sympy.Matrix(n, 1, [values[i] for i in self.f]),
            A=sympy.Matrix(m, n, [values[i] for i in self.A]),
            gamma=sympy.Matrix(m, 1, [values[i] for i in self.gamma]),
            kinetic=values[self.kinetic],
            potential=values[self.potential],
        )


class SympyEquations(Record):
    """M qddot = f + A^T lambda, A qddot + gamma = 0 in SymPy.

    ``symbols``: symbols by name. ``coordinates``: n. ``accelerations`` (n x 1), ``multipliers`` (m x 1), ``M`` (n x n),
    ``f`` (n x 1), ``A`` (m x n), ``gamma`` (m x 1) are matrices.
    """

    t: Any
    symbols: Dict[str, Any]
    coordinates: List[Any]
    accelerations: Any
    multipliers: Any
    M: Any
    f: Any
    A: Any
    gamma: Any
    kinetic: Any
    potential: Any

    def equations(self) -> List[Any]:
        """M qddot - f - A^T lambda = 0 and A qddot + gamma = 0 as equations: n + m."""
        sympy: Any = import_module("sympy")
        left = self.M * self.accelerations - self.f - self.A.T * self.multipliers
        rows = list(left) + list(self.A * self.accelerations + self.gamma)
        return [sympy.Eq(row, 0, evaluate=False) for row in rows]

    def _repr_latex_(self) -> str:
        sympy: Any = import_module("sympy")
        lines = " \\\\\n".join(sympy.latex(equation) for equation in self.equations())
        return f"$$\\begin{{array}}{{l}}\n{lines}\n\\end{{array}}$$"


def _symbol(sympy: Any, name: str, coordinates: List[str], t: Any) -> Any:
    if t is not None:
        for ending, order in (("_ddot", 2), ("_dot", 1), ("", 0)):
            base = name[: len(name) - len(ending)]
            if name.endswith(ending) and base in coordinates:
                function = sympy.Function(base, real=True)(t)
                return sympy.Derivative(function, (t, order)) if order else function
    return sympy.Symbol(name, real=True)


def _operations(sympy: Any) -> Dict[str, Callable[..., Any]]:
    return {
        "+": lambda a, b: a + b,
        "-": lambda a, b: a - b,
        "*": lambda a, b: a * b,
        "/": lambda a, b: a / b,
        "neg": lambda a: -a,
        "if": lambda a, b, x, y: sympy.Piecewise((x, a < b), (y, True)),
        "sqrt": sympy.sqrt,
        "sin": sympy.sin,
        "cos": sympy.cos,
        "tan": sympy.tan,
        "asin": sympy.asin,
        "acos": sympy.acos,
        "atan": sympy.atan,
        "atan2": sympy.atan2,
        "sinh": sympy.sinh,
        "cosh": sympy.cosh,
        "tanh": sympy.tanh,
        "exp": sympy.exp,
        "log": sympy.log,
        "abs": sympy.Abs,
        "sign": sympy.sign,
        "min": sympy.Min,
        "max": sympy.Max,
    }

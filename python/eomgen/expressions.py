# SPDX-License-Identifier: GPL-3.0-or-later
"""Expressions of the model language with the operators of Python.

>>> m, L, g = Expression("m"), Expression("L"), Expression("g")
>>> str(m * L**2 / 12)
'm*L^2/12'
"""

from __future__ import annotations

from typing import Any, Union

# How strongly the outermost operator of a text binds.
_SUM, _PRODUCT, _SIGN, _POWER, _ATOM = range(1, 6)


class Expression:
    """An expression of the model language: a text, and the operators ``+ - * / **``.

    ``str(e)`` is the text. Comparisons give conditions for ``if_``. ``q.dot`` and ``q.ddot`` are the derivatives of a
    coordinate or of a function of time.
    """

    __slots__ = ("_text", "_strength")

    def __init__(self, text: str, strength: int = _ATOM) -> None:
        self._text = text
        self._strength = strength

    def __str__(self) -> str:
        return self._text

    def __repr__(self) -> str:
        return f"<eomgen.Expression {self._text}>"

    def __add__(self, other: "Operand") -> "Expression":
        return Expression(f"{self._text} + {_operand(other, _PRODUCT)}", _SUM)

    def __radd__(self, other: "Operand") -> "Expression":
        return Expression(f"{_operand(other, _SUM)} + {_operand(self, _PRODUCT)}", _SUM)

    def __sub__(self, other: "Operand") -> "Expression":
        return Expression(f"{self._text} - {_operand(other, _PRODUCT)}", _SUM)

    def __rsub__(self, other: "Operand") -> "Expression":
        return Expression(f"{_operand(other, _SUM)} - {_operand(self, _PRODUCT)}", _SUM)

    def __mul__(self, other: "Operand") -> "Expression":
        return Expression(f"{_operand(self, _PRODUCT)}*{_operand(other, _POWER)}", _PRODUCT)

    def __rmul__(self, other: "Operand") -> "Expression":
        return Expression(f"{_operand(other, _PRODUCT)}*{_operand(self, _POWER)}", _PRODUCT)

    def __truediv__(self, other: "Operand") -> "Expression":
        return Expression(f"{_operand(self, _PRODUCT)}/{_operand(other, _POWER)}", _PRODUCT)

    def __rtruediv__(self, other: "Operand") -> "Expression":
        return Expression(f"{_operand(other, _PRODUCT)}/{_operand(self, _POWER)}", _PRODUCT)

    def __pow__(self, other: "Operand") -> "Expression":
        return Expression(f"{_operand(self, _ATOM)}^{_operand(other, _ATOM)}", _POWER)

    def __rpow__(self, other: "Operand") -> "Expression":
        return Expression(f"{_operand(other, _ATOM)}^{_operand(self, _ATOM)}", _POWER)

    def __neg__(self) -> "Expression":
        return Expression(f"-{_operand(self, _PRODUCT)}", _SIGN)

    def __pos__(self) -> "Expression":
        return self

    def __abs__(self) -> "Expression":
        return call("abs", self)

    def __lt__(self, other: "Operand") -> "Condition":
        return Condition(f"{self._text} < {_operand(other, _SUM)}")

    def __le__(self, other: "Operand") -> "Condition":
        return Condition(f"{self._text} <= {_operand(other, _SUM)}")

    def __gt__(self, other: "Operand") -> "Condition":
        return Condition(f"{self._text} > {_operand(other, _SUM)}")

    def __ge__(self, other: "Operand") -> "Condition":
        return Condition(f"{self._text} >= {_operand(other, _SUM)}")

    def __bool__(self) -> bool:
        raise TypeError(f"the expression '{self._text}' is neither true nor false")

    def _named(self, what: str) -> str:
        if self._strength != _ATOM or "(" in self._text:
            raise TypeError(f"'{self._text}' is no name, so it has no {what}; write ddt({self._text})")
        return self._text

    @property
    def dot(self) -> "Expression":
        """The rate of a coordinate or of a function of time."""
        return Expression(self._named("rate") + "_dot")

    @property
    def ddot(self) -> "Expression":
        """The second derivative by time."""
        return Expression(self._named("second derivative") + "_ddot")


Operand = Union[Expression, int, float, str]


class Condition:
    """A comparison, for ``if_``."""

    __slots__ = ("_text",)

    def __init__(self, text: str) -> None:
        self._text = text

    def __str__(self) -> str:
        return self._text

    def __bool__(self) -> bool:
        raise TypeError(f"'{self._text}' is a condition of the model: use if_(condition, x, y)")


def number(value: "int | float") -> str:
    """The shortest decimal that denotes a number."""
    if isinstance(value, int):
        return str(int(value))
    try:
        text = repr(float(value))
    except (TypeError, ValueError):
        raise TypeError(f"{value!r} is no value of the model language: give a number, text or an expression") from None
    return text[:-2] if text.endswith(".0") else text


def _operand(value: Any, least: int) -> str:
    """The text of an operand, in parentheses if it binds less strongly than `least`."""
    if isinstance(value, Expression):
        return f"({value._text})" if value._strength < least else value._text
    if isinstance(value, str):
        return f"({value})"
    if hasattr(value, "numerator") and hasattr(value, "denominator") and not hasattr(value, "dtype"):
        if value.denominator != 1:
            return f"({value.numerator}/{value.denominator})" if least > _PRODUCT or value < 0 else f"{value.numerator}/{value.denominator}"
        value = int(value)
    text = number(value)
    return f"({text})" if text.startswith("-") and least > _SUM else text


def as_text(value: Any) -> str:
    """The text of a value of the model language."""
    return value if isinstance(value, str) else _operand(value, _SUM)


def call(name: str, *arguments: Any) -> Expression:
    """A function of the model language: ``call("atan2", y, x)``."""
    return Expression(f"{name}({', '.join(as_text(a) for a in arguments)})")


def quantity(value: "int | float", unit: str) -> Expression:
    """A number with its unit within an expression: ``quantity(0.3, "N/m")*x``."""
    digits = number(value)
    text = Expression(f"{digits.lstrip('-')}[{unit}]")
    return -text if digits.startswith("-") else text


def if_(condition: Condition, x: Any, y: Any) -> Expression:
    """``x`` where the condition holds, and ``y`` elsewhere: ``if_(t < 1, 0, F)``."""
    return Expression(f"if({condition}, {as_text(x)}, {as_text(y)})")


def _function(name: str, meaning: str) -> Any:
    def function(*arguments: Any) -> Expression:
        return call(name, *arguments)

    function.__name__ = function.__qualname__ = name
    function.__doc__ = meaning
    return function


sin = _function("sin", "The sine.")
cos = _function("cos", "The cosine.")
tan = _function("tan", "The tangent.")
asin = _function("asin", "The inverse sine.")
acos = _function("acos", "The inverse cosine.")
atan = _function("atan", "The inverse tangent.")
atan2 = _function("atan2", "The angle of (x, y): atan2(y, x).")
sinh = _function("sinh", "The hyperbolic sine.")
cosh = _function("cosh", "The hyperbolic cosine.")
tanh = _function("tanh", "The hyperbolic tangent.")
exp = _function("exp", "The exponential function.")
log = _function("log", "The natural logarithm.")
sqrt = _function("sqrt", "The square root.")
sign = _function("sign", "-1, 0 or 1.")
minimum = _function("min", "The least of two to 64 values.")
maximum = _function("max", "The greatest of two to 64 values.")
dot = _function("dot", "The scalar product of two vectors.")
cross = _function("cross", "The vector product of two vectors.")
norm = _function("norm", "The length of a vector.")
unit = _function("unit", "A vector divided by its length.")
position = _function("position", "The position of a particle, point or body.")
velocity = _function("velocity", "The velocity of a particle, point or body.")
acceleration = _function("acceleration", "The acceleration of a particle, point or body.")
omega = _function("omega", "The angular velocity of a body or frame.")
ddt = _function("ddt", "The total derivative by time.")
diff = _function("diff", "The partial derivative of an expression by a name.")
integral = _function("integral", "The integral of a function of time from the start of the run.")
initial = _function("initial", "The start value of a coordinate.")

t = Expression("t")
pi = Expression("pi")
E1, E2, E3 = Expression("E1"), Expression("E2"), Expression("E3")
origin = Expression("origin")

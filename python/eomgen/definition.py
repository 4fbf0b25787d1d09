# SPDX-License-Identifier: GPL-3.0-or-later
"""Models built from objects of Python. They write the text of a model file (docs/model-format.md).

>>> from eomgen import Definition, Force, Particle
>>> from eomgen.expressions import E2, cos, sin
>>> d = Definition("Simple pendulum")
>>> m, l, g = d.parameters(m="1 kg", l="0.5 m", g="9.81 m/s^2")
>>> theta = d.coordinate("theta", "rad")
>>> bob = d.add(Particle("bob", mass=m, position=[l * sin(theta), -l * cos(theta), 0]))
>>> d.add(Force(gravity=-g * E2))
>>> d.scene(t=[0, 10], initial={theta: "60 deg"})
>>> model = d.model("pendulum")

Each class has the name of a section, and takes its keys. The reader checks them: errors have the line of ``d.text``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Dict, List, Mapping, Optional, TypeVar

from .arguments import wrong
from .expressions import Condition, Expression, number

if TYPE_CHECKING:
    from .model import Model


def _quoted(text: str) -> str:
    """A basic string of TOML."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(c if c >= " " and c != "\x7f" else f"\\u{ord(c):04x}" for c in escaped) + '"'


def _key(name: Any) -> str:
    text = str(name)
    plain = text != "" and all(c.isascii() and (c.isalnum() or c in "_-") for c in text)
    return text if plain else _quoted(text)


def toml(value: Any) -> str:
    """A value of a key as TOML: text, numbers, booleans, expressions, sequences, mappings, arrays of NumPy."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (Expression, Condition)):
        return _quoted(str(value))
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(key)} = {toml(entry)}" for key, entry in value.items()) + " }" if value else "{}"
    if hasattr(value, "tolist"):
        return toml(value.tolist())
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml(entry) for entry in value) + "]"
    if isinstance(value, (int, float)):
        return number(value)
    if hasattr(value, "numerator"):
        return _quoted(f"{value.numerator}/{value.denominator}")
    raise TypeError(f"{value!r} is no value of a model file: give text, a number, an expression, a list or a dict")


class Section:
    """A ``[[section]]`` of a model file with its keys."""

    section: ClassVar[str] = ""

    def __init__(self, name: Optional[str] = None, **keys: Any) -> None:
        self.keys: Dict[str, Any] = {} if name is None else {"name": name}
        self.keys.update((key, value) for key, value in keys.items() if value is not None)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{key}={value}' for key, value in self.keys.items())})"

    def toml(self) -> str:
        """The lines of the section."""
        return f"[[{self.section}]]\n" + "".join(f"{_key(key)} = {toml(value)}\n" for key, value in self.keys.items())


class Place(Section, Expression):
    """A section that is a place. As an expression it is its position: ``elbow + L*arm.e1``.

    ``P.e_q``, ``P.a_q``, ``P.g_q`` are basis vectors of a coordinate q of the position of P. ``P.omega`` is the angular
    velocity of a body.
    """

    __slots__ = ()

    def __init__(self, name: str, **keys: Any) -> None:
        Section.__init__(self, name, **keys)
        Expression.__init__(self, name)

    __repr__ = Section.__repr__

    def __getattr__(self, part: str) -> Expression:
        if part in ("e1", "e2", "e3", "omega") or part[:2] in ("e_", "a_", "g_"):
            return Expression(f"{self._text}.{part}")
        raise AttributeError(f"'{self._text}' has no part '{part}'")

    def __bool__(self) -> bool:
        return True

    def axis(self, k: int, after: int = 0) -> Expression:
        """The axis k of a body after the first (1) or second (2) of its Euler angles; after all of them: 0."""
        return Expression(f"{self._text}.e{k}" + "'" * after)


class Particle(Place):
    """``[[particle]]``: ``mass``, ``position``."""

    section = "particle"


class Point(Place):
    """``[[point]]``: ``position``, or ``on`` a body ``at`` three components along its axes."""

    section = "point"


class Body(Place):
    """``[[body]]``: ``mass``, ``inertia``, ``position`` of the centre of mass, ``rotation``, ``relative_to``."""

    section = "body"


class Frame(Place):
    """``[[frame]]``: axes without mass: ``rotation``, ``relative_to``."""

    section = "frame"


class Chain(Section):
    """``[[chain]]``: particles on rods."""

    section = "chain"


class Force(Section):
    """``[[force]]``: ``gravity``, ``on`` and ``force``, ``generalized``, springs, dampers and other kinds."""

    section = "force"


class Constraint(Section):
    """``[[constraint]]``: ``holonomic``, ``velocity``, surfaces and contacts with friction, gears."""

    section = "constraint"


class Joint(Section):
    """``[[joint]]``: ``type``, ``bodies``, ``at``, ``axis``."""

    section = "joint"


class State(Section, Expression):
    """``[[state]]``: a state of first order: ``rate``, ``unit``, ``initial``. It is an expression."""

    section = "state"

    def __init__(self, name: str, **keys: Any) -> None:
        Section.__init__(self, name, **keys)
        Expression.__init__(self, name)

    __repr__ = Section.__repr__


class Event(Section):
    """``[[event]]``: ``when`` its function changes sign, ``action``, ``set``."""

    section = "event"


class Sample(Section):
    """``[[sample]]``: changes at equal intervals of time: ``every``, ``set``."""

    section = "sample"


AnySection = TypeVar("AnySection", bound=Section)


class Definition:
    """The sections of a model in the order of insertion. ``text`` is the model file, ``model()`` reads it."""

    def __init__(self, title: str = "", notes: str = "") -> None:
        self._head: Dict[str, Any] = {"format": 1}
        self._head.update({key: text for key, text in (("title", title), ("notes", notes)) if text})
        self._tables: Dict[str, Dict[str, Any]] = {}
        self._sections: List[Section] = []
        self._scenes: Dict[str, Dict[str, Any]] = {}

    def set(self, section: str, key: str, value: Any) -> Expression:
        """Appends a key to a ``[section]`` and returns the key as an expression."""
        self._tables.setdefault(section, {})[key] = value
        return Expression(key)

    def parameter(self, name: str, value: Any, **keys: Any) -> Expression:
        """A parameter: "9.81 m/s^2", a number, or an expression of others. ``keys``: unit, tex, note, positive."""
        return self.set("parameters", name, {"value": value, **keys} if keys else value)

    def parameters(self, **values: Any) -> List[Expression]:
        """Several parameters: ``m, g = d.parameters(m="1 kg", g="9.81 m/s^2")``."""
        return [self.parameter(name, value) for name, value in values.items()]

    def coordinate(self, name: str, unit: Optional[str] = None, **keys: Any) -> Expression:
        """A coordinate with its SI unit. ``keys``: tex, range."""
        return self.set("coordinates", name, {**({"unit": unit} if unit else {}), **keys} if keys or not unit else unit)

    def coordinates(self, **units: Optional[str]) -> List[Expression]:
        """Several coordinates: ``x, theta = d.coordinates(x="m", theta="rad")``."""
        return [self.coordinate(name, unit) for name, unit in units.items()]

    def input(self, name: str, unit: Optional[str] = None, default: float = 0, **keys: Any) -> Expression:
        """An input with its SI unit. ``keys``: tex."""
        return self.set("inputs", name, {**({"unit": unit} if unit else {}), "default": default, **keys})

    def function(self, name: str, value: Any, **keys: Any) -> Expression:
        """A function of time: an expression of t and parameters. ``keys``: unit, tex."""
        return self.set("functions", name, {"is": value, **keys} if keys else value)

    def define(self, name: str, value: Any) -> Expression:
        """A named expression, which is also an output."""
        return self.set("definitions", name, value)

    def discrete(self, name: str, value: Any) -> Expression:
        """A discrete value, which events and samples change."""
        return self.set("discrete", name, value)

    def energy(self, *, kinetic: Any = None, potential: Any = None) -> None:
        """The energies, or what is added to those of particles and forces."""
        for key, value in (("kinetic", kinetic), ("potential", potential)):
            if value is not None:
                self.set("energy", key, value)

    def draw(self, name: str, **shape: Any) -> None:
        """The shape of a particle or body in drawings."""
        self.set("draw", name, shape)

    def add(self, section: AnySection) -> AnySection:
        """Appends a section and returns it."""
        if not isinstance(section, Section):
            raise wrong("section", section, "a section", 'give one, such as eomgen.Force(gravity="-g*E2")')
        self._sections.append(section)
        return section

    def scene(self, name: str = "default", **keys: Any) -> None:
        """A scene: ``t``, ``initial``, ``guess``, ``outputs``, ``solver``, ``rtol``, .. ``start_from``: another scene."""
        if "start_from" in keys:
            keys["from"] = keys.pop("start_from")
        self._scenes[name] = keys

    @property
    def text(self) -> str:
        """The text of the model file."""
        parts = ["".join(f"{key} = {toml(value)}\n" for key, value in self._head.items())]
        for name in ("parameters", "functions", "inputs", "coordinates", "discrete"):
            parts.append(self._table(name))
        parts += [section.toml() for section in self._sections]
        known = ("parameters", "functions", "inputs", "coordinates", "discrete")
        parts += [self._table(name) for name in self._tables if name not in known]
        for name, keys in self._scenes.items():
            parts.append(f"[scene.{_key(name)}]\n" + "".join(f"{key} = {toml(value)}\n" for key, value in keys.items()))
        return "\n".join(part for part in parts if part)

    def _table(self, name: str) -> str:
        keys = self._tables.get(name)
        if not keys:
            return ""
        return f"[{name}]\n" + "".join(f"{_key(key)} = {toml(value)}\n" for key, value in keys.items())

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"<eomgen.Definition {self._head.get('title', '')}>"

    def model(self, name: str = "model") -> "Model":
        """Reads the model. Raises Error with the line of ``text``."""
        from .model import Model

        return Model.from_text(self.text, name)

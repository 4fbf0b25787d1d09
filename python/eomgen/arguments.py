# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of the arguments of calls. A value of a wrong type is an Error that names the argument.

``checked`` reads the annotations of a function: they are its contract, and each kind of annotation has one converter.
"""

from __future__ import annotations

import functools
import os
from typing import Any, Callable, Dict, List, Mapping, Optional, TypeVar

from .errors import ArgumentError, Error, warn

# A converter takes the name of the argument, its value, and the object whose method was called.
Converter = Callable[[str, Any, Any], Any]
Function = TypeVar("Function", bound=Callable[..., Any])


def shown(value: Any) -> str:
    """A value in a message."""
    text = repr(value)
    return text if len(text) <= 60 else text[:50] + " ..."


def wrong(name: str, value: Any, what: str, remedy: str) -> Error:
    """The Error for a value of a wrong type."""
    message = f"{name}: {shown(value)} is not {what}"
    return ArgumentError(f"error: {message}\n  remedy: {remedy}", "python", message=message, remedy=remedy)


def number(name: str, value: Any) -> float:
    """A number as a float. Text is none, even if it could be read as one."""
    if not isinstance(value, (str, bytes, bytearray)):
        try:
            return float(value)
        except (TypeError, ValueError, OverflowError):
            pass
    raise wrong(name, value, "a number", f"give a number in SI units, such as {name}=0.5")


def integer(name: str, value: Any, least: int = 0) -> int:
    """A whole number that is not below ``least``."""
    whole: Optional[int] = None
    try:
        whole = value.__index__()
    except (AttributeError, TypeError):
        if isinstance(value, float) and value.is_integer():
            whole = int(value)
    if whole is None or not least <= whole < 1 << 63:
        raise wrong(name, value, f"a whole number from {least} on", f"give one, such as {name}={max(least, 1)}")
    return whole


def integers(name: str, value: Any) -> List[int]:
    """A whole number, or a sequence of them."""
    try:
        entries = list(value)
    except TypeError:
        entries = [value]
    limit = 1 << 31
    try:
        found = [integer(name, entry, -limit) for entry in entries]
    except Error:
        found = [limit]
    if max(found, default=0) >= limit:
        raise wrong(name, value, "a whole number or a list of them", f"give whole numbers, such as {name}=[0, 1]")
    return found


def flag(name: str, value: Any) -> bool:
    """True or False, also of NumPy."""
    if isinstance(value, bool) or type(value).__name__ in ("bool_", "bool"):
        return bool(value)
    raise wrong(name, value, "a truth value", f"give {name}=True or {name}=False")


def text(name: str, value: Any) -> str:
    """Text."""
    if isinstance(value, str):
        return value
    raise wrong(name, value, "text", f'give text, such as {name}="{name}"')


def model_text(name: str, value: Any) -> str:
    """The text of a model file, or of a Definition."""
    if isinstance(value, str) or isinstance(getattr(value, "text", None), str):
        return str(value)
    raise wrong(name, value, "the text of a model", "give the text of a model file, or a Definition")


def names(name: str, value: Any) -> List[str]:
    """One name, or a sequence of names."""
    if isinstance(value, str):
        return [value]
    try:
        entries = [] if value is None else list(value)
    except TypeError:
        entries = [value]
    for entry in entries:
        if not isinstance(entry, str):
            raise wrong(name, value, "a list of names", f'give names, such as {name}=["a", "b"]')
    return entries


def path(name: str, value: Any) -> str:
    """The path of a file or folder."""
    try:
        found = os.fspath(value)
    except TypeError:
        found = None
    if not isinstance(found, str):
        raise wrong(name, value, "a path", f'give text or a pathlib.Path, such as {name}="pendulum.toml"')
    return found


def function(name: str, value: Any) -> Any:
    """A function, or None."""
    if value is None or callable(value):
        return value
    raise wrong(name, value, "a function", f"give a function, or leave {name} out")


def array(name: str, value: Any) -> Any:
    """Numbers as an array of float64."""
    import numpy as np

    try:
        # An array of complex numbers would lose its imaginary part.
        found = np.asarray(value)
        if found.dtype.kind in "biufO" and not isinstance(value, Mapping):
            return np.asarray(found, dtype=float)
    except (TypeError, ValueError, OverflowError):
        pass
    raise wrong(name, value, "an array of numbers", "give numbers, or a list or an array of numbers of equal rows")


def _entries(name: str, value: Any, remedy: str) -> Dict[Any, Any]:
    """Of a mapping, such as a dictionary or a table of pandas."""
    try:
        return dict(value)
    except (TypeError, ValueError):
        raise wrong(name, value, "a dictionary", remedy) from None


def value_of(model: Any, name: str, key: Any, value: Any) -> float:
    """The value of a name of the model in SI units: a number, or text with a unit as of ``--set``."""
    if isinstance(value, str):
        return float(model._core.number_of(text(f"a name in {name}", key), value, warn))
    try:
        return number(name, value)
    except Error:
        raise wrong(
            f"{name}[{key!r}]", value, "a number", 'give a number in SI units, or text with a unit, such as "50 cm"'
        ) from None


def values_by_name(model: Any, name: str, value: Any) -> Dict[str, float]:
    """Values by names of the model: numbers in SI units, or text with units."""
    entries = _entries(name, value, f'give names and values, such as {name}={{"m": 2.5}}')
    return {text(f"a name in {name}", key): value_of(model, name, key, entry) for key, entry in entries.items()}


def arrays_by_name(model: Any, name: str, value: Any) -> Dict[str, Any]:
    """Arrays by names of the model. Entries may be text with units."""
    import numpy as np

    found = {}
    for key, entry in _entries(name, value, f'give names and lists, such as {name}={{"m": [1, 2]}}').items():
        text(f"a name in {name}", key)
        if isinstance(entry, (str, list, tuple)):
            entries = [entry] if isinstance(entry, str) else entry
            entry = [value_of(model, name, key, v) if isinstance(v, str) else v for v in entries]
        found[key] = np.atleast_1d(array(f"{name}[{key!r}]", entry))
    return found


def _optional(convert: Converter) -> Converter:
    return lambda name, value, owner: None if value is None else convert(name, value, owner)


def _plain(convert: Callable[[str, Any], Any]) -> Converter:
    return lambda name, value, owner: convert(name, value)


def _values(name: str, value: Any, owner: Any) -> Any:
    model = owner if hasattr(owner, "from_text") else owner.model
    return None if value is None else values_by_name(model, name, value)


def _arrays(name: str, value: Any, owner: Any) -> Any:
    return None if value is None else arrays_by_name(owner, name, value)


_CONVERTERS: Dict[str, Converter] = {
    "float": _plain(number),
    "Optional[float]": _optional(_plain(number)),
    "int": _plain(integer),
    "Optional[int]": _optional(_plain(integer)),
    "bool": _plain(flag),
    "str": _plain(text),
    "str | Definition": _plain(model_text),
    "Optional[str]": _optional(_plain(text)),
    "Sequence[str] | str": _plain(names),
    "Sequence[str] | str | None": _optional(_plain(names)),
    "str | os.PathLike[str]": _plain(path),
    "str | os.PathLike[str] | None": _optional(_plain(path)),
    "Stage": _plain(function),
    "Progress": _plain(function),
    "Optional[Callable[[float, NDArray[Any]], None]]": _plain(function),
    "Values": _values,
    'Optional[Mapping[str, "float | str"]]': _values,
    "Optional[Mapping[str, ArrayLike]]": _arrays,
}
# Checked where they are used.
_OPEN = {"Any", "ArrayLike", "NDArray[Any]", "Model", "CompiledModel"}


def converters_of(called: Callable[..., Any]) -> Dict[str, Converter]:
    """The converters of the arguments of a function by their names."""
    found = {}
    for name, annotation in called.__annotations__.items():
        kind = annotation.strip("'\"")
        if name != "return" and kind not in _OPEN:
            found[name] = _CONVERTERS[kind]  # a KeyError: a new kind of argument needs a converter
    return found


def checked(called: Function) -> Function:
    """A method whose arguments are converted, or refused with an Error that names them."""
    converters = converters_of(called)
    positional = called.__code__.co_varnames[1 : called.__code__.co_argcount]

    @functools.wraps(called)
    def call(self: Any, *arguments: Any, **keywords: Any) -> Any:
        given = [
            converters[name](name, value, self) if name in converters else value
            for name, value in zip(positional, arguments)
        ]
        for name, value in keywords.items():
            if name in converters:
                keywords[name] = converters[name](name, value, self)
        return called(self, *given, *arguments[len(given) :], **keywords)

    return call  # type: ignore[return-value]

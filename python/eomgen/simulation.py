# SPDX-License-Identifier: GPL-3.0-or-later
"""A motion that a program advances in pieces: the loop of a digital controller."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Optional

from . import _core
from .arguments import array, checked, number, text, values_by_name, wrong
from .errors import input_error

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from .compiled import CompiledModel


class Simulation(_core.Simulation):
    """A motion that starts at the start of a scene and is advanced in pieces.

    >>> simulation = eomgen.Simulation(compiled, rtol=1e-8)
    >>> for k in range(2000):
    ...     simulation.set_inputs(control(simulation.t, simulation.state()))  # held for 1 ms
    ...     simulation.advance(1e-3 * (k + 1))

    Contacts, charts and the size of steps continue from one advance to the next. No error is estimated: ``Model.run``
    does that. One thread at a time may use a simulation.
    """

    @checked
    def __init__(
        self,
        model: "CompiledModel",
        *,
        parameters: Any = None,
        rtol: Optional[float] = None,
        atol: Optional[float] = None,
        step: Optional[float] = None,
        max_step: Optional[float] = None,
        solver: Optional[str] = None,
        every: Optional[float] = None,
        max_steps: int = 0,
    ) -> None:
        """``parameters`` replaces values and initial values of the compiled model, as of ``Model.run``. ``step`` (fixed), ``max_step`` and
        ``every`` (interval of rows; None: no rows) are in s. ``max_steps``: of one advance; 0 is the solver's default.
        """
        if not isinstance(model, _core.CompiledModel):
            raise wrong("model", model, "a CompiledModel", "give the result of model.compile()")
        options = {
            "parameters": values_by_name(model.model, "parameters", parameters or {}),
            "rtol": rtol,
            "atol": atol,
            "step": step,
            "max_step": max_step,
            "solver": solver,
            "every": every,
            "max_steps": max_steps,
        }
        super().__init__(model, options)
        self._model = model

    def __reduce__(self) -> Any:
        raise TypeError("a Simulation cannot be pickled: pickle its CompiledModel, t and state()")

    def __repr__(self) -> str:
        return f"<eomgen.Simulation {self._model.model.name}, t = {self.t:g} s>"

    @property
    def model(self) -> "CompiledModel":
        """The compiled model."""
        return self._model

    def set_input(self, name: str, value: "float | Callable[[float], float]") -> None:
        """Holds an input from here on, or makes it a function of time in s.

        The function should be smooth within one advance, because its kinks are not known.
        """
        self._set_input(text("name", name), value if callable(value) else number("value", value))

    def control(self, t: float, inputs: "Callable[[float, NDArray[Any]], ArrayLike]", every: float) -> Any:
        """Advances until t in s under a sampled controller, and returns the last Advance.

        ``inputs(t, x)`` is called every ``every`` seconds from here on and returns (U,), which is held until the next
        call. Ends early at an event that stops the scene.
        """
        t, every = number("t", t), number("every", every)
        if not callable(inputs):
            raise wrong("inputs", inputs, "a function", "give a function of (t, x) that returns (U,)")
        if not every > 0:
            raise input_error("the interval of a controller is not positive", "give a number of seconds")
        start, k = self.t, 0
        while True:
            self.set_inputs(inputs(self.t, self.state()))
            k += 1
            end = self.advance(min(start + k * every, t))
            if end.outcome != "done" or self.t >= t:
                return end

    def follow(self, t: float, times: "ArrayLike", inputs: "ArrayLike") -> Any:
        """Advances until t in s under inputs from a table, and returns the last Advance.

        ``times``: (K,) in s, increasing. ``inputs``: (K, U), interpolated linearly; the first and the last row hold
        before and after. Pieces end at the times of the table. Ends early at an event that stops the scene.
        """
        import numpy as np

        names = self._model.input_names
        t, at, table = number("t", t), array("times", times), array("inputs", inputs)
        if table.ndim == 1 and at.ndim == 1 and len(at) > 0 and len(table) % len(at) == 0:
            table = table.reshape(len(at), -1)
        if at.ndim != 1 or len(at) == 0 or np.any(np.diff(at) <= 0) or table.shape != (len(at), len(names)):
            raise input_error(
                f"the table of inputs has the shapes {at.shape} and {table.shape}",
                f"give increasing times (K,) and inputs (K, {len(names)})",
            )
        while True:
            place = int(np.searchsorted(at, self.t, side="right"))
            if place == 0 or place == len(at):
                self.set_inputs(table[min(place, len(at) - 1)])
                until = min(t, at[0]) if place == 0 else t
            else:
                until = min(t, at[place])
                first, last = at[place - 1], at[place]
                for i, name in enumerate(names):
                    self.set_input(name, _line(first, last, table[place - 1, i], table[place, i]))
            end = self.advance(until)
            if end.outcome != "done" or self.t >= t:
                return end


def _line(first: float, last: float, start: float, end: float) -> "Callable[[float], float]":
    slope = float(end - start) / float(last - first)
    return lambda t: start + slope * (t - first)

# SPDX-License-Identifier: GPL-3.0-or-later
"""Linear systems of control theory about a state of a CompiledModel.

``tuple(system)`` is (A, B, C, D), so ``control.ss(*system)`` and ``scipy.signal.StateSpace(*system)`` take one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterator, List, Mapping, NamedTuple, Optional, Sequence

from .arguments import array, checked, value_of
from .errors import Error, input_error
from .records import Record

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from .compiled import CompiledModel


class TransferFunction(NamedTuple):
    """Transfer functions G(s) = num/den from each input to each output; of z for a system in discrete time.

    ``num``: (outputs, inputs, N + 1), ``den``: (N + 1,), highest power first. ``den[0]`` is 1.
    """

    num: "NDArray[Any]"
    den: "NDArray[Any]"


class StateSpace(Record):
    """Linear system about a state: dx' = A dx + B du, dy = C dx + D du, with dx = x - ``x``, du = u - ``u``.

    ``states``, ``inputs``, ``outputs``: names of the entries. ``x``, ``u``, ``y``: the state, inputs and outputs about
    which it is linear, ``rate``: dx/dt there, 0 for an equilibrium. ``period``: 0.0, or in s for discrete time, where
    A dx + B du is the next dx.
    """

    A: "NDArray[Any]"
    B: "NDArray[Any]"
    C: "NDArray[Any]"
    D: "NDArray[Any]"
    states: List[str]
    inputs: List[str]
    outputs: List[str]
    x: "NDArray[Any]"
    u: "NDArray[Any]"
    y: "NDArray[Any]"
    rate: "NDArray[Any]"
    period: float

    def __iter__(self) -> "Iterator[NDArray[Any]]":
        return iter((self.A, self.B, self.C, self.D))

    def poles(self) -> "NDArray[Any]":
        """Eigenvalues of A, in 1/s for continuous time: (N,)."""
        import numpy as np

        return np.linalg.eigvals(self.A)

    def transfer_function(self) -> TransferFunction:
        """C (s 1 - A)^-1 B + D as quotients of polynomials.

        Coefficients of large systems are ill-conditioned: use the matrices, or ``frequency_response``, where possible.
        """
        import numpy as np

        den = np.real(np.poly(self.A))
        num = np.empty((len(self.outputs), len(self.inputs), len(den)))
        for i, c in enumerate(self.C):
            for j in range(len(self.inputs)):
                # det(s 1 - A + b c) = det(s 1 - A) (1 + c (s 1 - A)^-1 b)
                closed = np.real(np.poly(self.A - np.outer(self.B[:, j], c)))
                num[i, j] = closed - den + self.D[i, j] * den
        return TransferFunction(num, den)

    def frequency_response(self, omega: "ArrayLike") -> "NDArray[Any]":
        """G(i omega), or G(exp(i omega period)): (outputs, inputs, K) complex numbers for K frequencies in rad/s."""
        import numpy as np

        w = np.atleast_1d(array("omega", omega))
        points = np.exp(1j * w * self.period) if self.period > 0 else 1j * w
        unit = np.eye(len(self.A))
        values = [self.C @ np.linalg.solve(s * unit - self.A, self.B) + self.D for s in points]
        return np.moveaxis(np.array(values), 0, -1)

    @checked
    def discretize(self, period: float) -> "StateSpace":
        """The same system from sample to sample, with inputs that are held between samples: exact. ``period`` in s."""
        import numpy as np

        if self.period > 0:
            raise input_error("this system is in discrete time", "discretise the system in continuous time")
        if not (np.isfinite(period) and period > 0):
            raise input_error(f"the period {period} is not positive", "give the sampling period in s")
        n, k = self.B.shape
        both = np.zeros((n + k, n + k))
        both[:n, :n], both[:n, n:] = self.A, self.B
        held = matrix_exponential(period * both)
        values = dict(self.__dict__)
        values.update(A=held[:n, :n], B=held[:n, n:], period=float(period))
        return StateSpace(**values)


class Trim(Record):
    """Inputs that hold a state: all accelerations, and rates of states of first order, vanish.

    ``inputs``: (U,). ``state``: (N,), with the states of first order that belong to it. ``residual``: the largest rate
    that remains. ``unique``: False if other inputs hold it too; then these are the smallest.
    """

    inputs: "NDArray[Any]"
    state: "NDArray[Any]"
    residual: float
    unique: bool


class DiscreteStep(NamedTuple):
    """The state after a period with held inputs, (N,), and its derivatives by state, (N, N), and by inputs, (N, U)."""

    x: "NDArray[Any]"
    A: "NDArray[Any]"
    B: "NDArray[Any]"


def matrix_exponential(matrix: "NDArray[Any]") -> "NDArray[Any]":
    """exp of a matrix: its series of degree 18 for a matrix of norm 1/2 at most, squared back."""
    import numpy as np

    norm = np.abs(matrix).sum(axis=0).max(initial=0.0)
    squarings = max(0, int(np.ceil(np.log2(2 * norm)))) if norm > 0 else 0
    scaled = matrix / 2.0**squarings
    result = term = np.eye(len(matrix))
    for k in range(1, 19):
        term = term @ scaled / k
        result = result + term
    for _ in range(squarings):
        result = result @ result
    return result


def _require_free(model: "CompiledModel", instead: str) -> None:
    if model.constraint_names:
        raise input_error(
            f"constraints with multipliers hold the states of {model.model.name}: "
            f"{', '.join(model.constraint_names)}",
            instead,
        )


def _state_of(model: "CompiledModel", x: Any) -> "NDArray[Any]":
    """A copy."""
    if x is None:
        return model.start.copy()
    state: Any = model.state(x) if isinstance(x, Mapping) else array("x", x).copy()
    if state.shape != (len(model.state_names),):
        raise input_error(f"x has the shape {state.shape}", f"give ({len(model.state_names)},), or names and values")
    return state  # type: ignore[no-any-return]


def _inputs_of(model: "CompiledModel", t: float, inputs: Any, argument: str = "inputs") -> "NDArray[Any]":
    import numpy as np

    if inputs is None:
        return np.asarray(model.input_values(t), dtype=float)
    names = model.input_names
    if isinstance(inputs, Mapping):
        u = np.asarray(model.input_values(t), dtype=float)
        for name, value in inputs.items():
            if name not in names:
                raise input_error(f"there is no input '{name}'", f"inputs: {', '.join(names) or 'none'}")
            u[names.index(name)] = value_of(model.model, argument, name, value)
        return u
    u = np.atleast_1d(array(argument, inputs))
    if u.shape != (len(names),):
        raise input_error(f"{u.size} inputs are given, and there are {len(names)}", "give one number for each input")
    return u


def _output_rows(model: "CompiledModel", names: List[str], t: float, x: Any, u: Any) -> Any:
    """Values, C and D of outputs: rows of states are exact, others are extrapolated differences."""
    import numpy as np

    states, known = model.state_names, model.output_names
    for name in names:
        if name not in known and name not in states:
            raise input_error(
                f"the output '{name}' was not compiled",
                f"model.compile(outputs=['{name}']) compiles it beside the states",
            )
    C, D = np.zeros((len(names), len(x))), np.zeros((len(names), len(u)))
    y = np.empty(len(names))
    others = [i for i, name in enumerate(names) if name not in states]
    for i, name in enumerate(names):
        if name in states:
            y[i] = x[states.index(name)]
            C[i, states.index(name)] = 1
    if not others:
        return y, C, D
    places = [known.index(names[i]) for i in others]
    y[others] = model.outputs(t, x, u)[places]
    both = np.concatenate([x, u])
    n = len(x)

    def at(moved: Any) -> Any:
        return model.outputs(t, moved[:n], moved[n:])[places]

    for j in range(len(both)):
        # Central differences with h and h/2, extrapolated: the error is of order h^4 and rounding/h.
        h = 1e-3 * max(1.0, abs(both[j]))
        slopes = []
        for size in (h, h / 2, h / 4):
            step = np.zeros(len(both))
            step[j] = size
            slopes.append((at(both + step) - at(both - step)) / (2 * size))
        first, second = [(4 * b - a) / 3 for a, b in zip(slopes, slopes[1:])]
        slope = (16 * second - first) / 15
        (C if j < n else D)[others, j if j < n else j - n] = slope
    return y, C, D


def linearize(
    model: "CompiledModel", x: Any, inputs: Any, outputs: "Sequence[str] | str | None", t: Optional[float], mode: Any
) -> StateSpace:
    """``CompiledModel.linearize``."""
    import numpy as np

    _require_free(model, "model.linearize() gives A and B on the manifold of the constraints")
    at = model.span[0] if t is None else t
    state = _state_of(model, x)
    u = _inputs_of(model, at, inputs)
    names = model.state_names if outputs is None else [outputs] if isinstance(outputs, str) else list(outputs)
    B = model.jac_u(at, state, u, mode=mode) if len(u) > 0 else np.zeros((len(state), 0))
    y, C, D = _output_rows(model, names, at, state, u)
    return StateSpace(
        A=model.jac(at, state, u, mode=mode),
        B=B,
        C=C,
        D=D,
        states=model.state_names,
        inputs=model.input_names,
        outputs=names,
        x=np.array(state),
        u=u,
        y=y,
        rate=model.rhs(at, state, u, mode=mode),
        period=0.0,
    )


def trim(
    model: "CompiledModel",
    x: Any,
    inputs: "Sequence[str] | str | None",
    guess: Any,
    t: Optional[float],
    tolerance: float,
) -> Trim:
    """``CompiledModel.trim``."""
    import numpy as np

    _require_free(model, "give the inputs that hold it in model.equilibria(), on the manifold of the constraints")
    if not model.input_names:
        raise input_error(f"{model.model.name} has no inputs that could hold a state", "declare them in [inputs]")
    at = model.span[0] if t is None else t
    state = _state_of(model, x)
    names = model.input_names
    chosen = list(names) if inputs is None else [inputs] if isinstance(inputs, str) else list(inputs)
    for name in chosen:
        if name not in names:
            raise input_error(f"there is no input '{name}'", f"inputs: {', '.join(names)}")
    places = [names.index(name) for name in chosen]
    n = model.coordinate_count
    first_order = list(range(2 * n, len(state)))
    u = _inputs_of(model, at, guess, "guess")
    rows = list(range(n, len(state)))
    scale = max(1.0, float(np.abs(model.rhs(at, state, u)[rows]).max()))
    rank = 0
    for _ in range(50):
        rate = model.rhs(at, state, u)[rows]
        slopes = np.hstack([model.jac_u(at, state, u)[:, places], model.jac(at, state, u)[:, first_order]])[rows]
        change, _, rank, _ = np.linalg.lstsq(slopes, -rate, rcond=None)
        u[places] += change[: len(places)]
        state[first_order] += change[len(places) :]
        if np.abs(change).max(initial=0.0) <= 1e-14 * max(1.0, np.abs(u).max(), np.abs(state).max()):
            break
    remaining = np.abs(model.rhs(at, state, u)[rows])
    residual = float(remaining.max())
    if not residual <= tolerance * scale:
        moving = [model.state_names[rows[i]] for i in np.flatnonzero(~(remaining <= tolerance * scale))]
        message = f"{', '.join(chosen)} cannot hold this state: {', '.join(moving)} would change"
        remedy = "choose another state, or further inputs"
        raise Error(f"error: {message}\n  remedy: {remedy}", "trim", message=message, remedy=remedy, kind="numerical")
    return Trim(inputs=u, state=state, residual=residual, unique=int(rank) == len(places) + len(first_order))


def discretize(
    model: "CompiledModel", period: float, x: Any, inputs: Any, t: Optional[float], rtol: float
) -> DiscreteStep:
    """``CompiledModel.discretize``."""
    import numpy as np

    _require_free(model, "discretise a model whose constraints are eliminated")
    if not (np.isfinite(period) and period > 0):
        raise input_error(f"the period {period} is not positive", "give the sampling period in s")
    begin = model.span[0] if t is None else t
    state = _state_of(model, x)
    u = _inputs_of(model, begin, inputs)
    n, k = len(state), len(u)

    def rates(at: float, now: Any) -> Any:
        """Of the state, and of its derivatives by the start and by the inputs."""
        y, slopes = now[:, 0], now[:, 1:]
        J = model.jac(at, y, u)
        forced = J @ slopes
        if k > 0:
            forced[:, n:] += model.jac_u(at, y, u)
        return np.column_stack([model.rhs(at, y, u), forced])

    def integrate(steps: int) -> Any:
        h = period / steps
        now = np.column_stack([state, np.eye(n), np.zeros((n, k))])
        for i in range(steps):
            at = begin + i * h
            k1 = rates(at, now)
            k2 = rates(at + h / 2, now + h / 2 * k1)
            k3 = rates(at + h / 2, now + h / 2 * k2)
            k4 = rates(at + h, now + h * k3)
            now = now + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        return now

    steps, coarse = 2, integrate(1)
    while True:
        fine = integrate(steps)
        better = fine + (fine - coarse) / 15  # of order 5
        if np.abs(better - fine).max() <= rtol * max(1.0, np.abs(fine).max()):
            return DiscreteStep(better[:, 0], better[:, 1 : n + 1], better[:, n + 1 :])
        if steps >= 1 << 16 or not np.isfinite(fine).all():
            message = f"the step of {period} s cannot be computed to {rtol} in {steps} parts"
            remedy = "choose a shorter period, or a larger rtol"
            report = f"error: {message}\n  remedy: {remedy}"
            raise Error(report, "discretize", message=message, remedy=remedy, kind="numerical")
        coarse, steps = fine, 2 * steps

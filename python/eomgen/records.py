# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of the calls of a Model. Values are in SI units. All records can be pickled and compared."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Dict, Iterator, List, NamedTuple, Optional, Sequence

from .arguments import checked

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Record:
    """Values with names."""

    def __init__(self, **values: Any) -> None:
        self.__dict__.update(values)

    def __repr__(self) -> str:
        entries = []
        for name, value in self.__dict__.items():
            text = repr(value)
            entries.append(f"{name}={text if len(text) < 80 else text[:60] + ' ...'}")
        return f"{type(self).__name__}({', '.join(entries)})"

    def __eq__(self, other: object) -> bool:
        if type(self) is not type(other):
            return NotImplemented
        import numpy as np

        mine, others = self.__dict__, other.__dict__
        return mine.keys() == others.keys() and all(
            np.array_equal(mine[name], others[name], equal_nan=mine[name].dtype.kind in "fc")
            if isinstance(mine[name], np.ndarray)
            else mine[name] == others[name]
            for name in mine
        )

    __hash__ = None  # type: ignore[assignment]


class LeftOut(NamedTuple):
    """A result that was skipped, and why."""

    what: str
    why: str


class ContactImpulse(NamedTuple):
    """The impulse of one contact during an impact, in N s. ``friction``: along the directions of slip. ``work`` in J."""

    contact: str
    normal: float
    friction: List[float]
    work: float


class Event(NamedTuple):
    """An event of a motion, such as an impact. ``t`` in s. ``work``: the change of the energy in J by an impulse, an
    impact or a reset. ``impulses``: of all contacts that took part in an impact."""

    t: float
    kind: str
    name: str
    work: float = 0.0
    impulses: Sequence[ContactImpulse] = ()


class Quantity(NamedTuple):
    """A name with its SI unit; "" if it is unknown or a pure number. ``value``: a number, a formula, or ""."""

    name: str
    unit: str
    value: str = ""


class Formula(Record):
    """A formula in text, LaTeX and MathML. Jupyter shows it typeset."""

    key: str
    name: str
    coordinate: str
    role: str
    text: str
    latex: str
    mathml: str

    def __str__(self) -> str:
        return self.text

    def _repr_latex_(self) -> str:
        return f"$\\displaystyle {self.latex}$"


class Multiplier(Record):
    """A Lagrange multiplier: ``name``, ``latex``, its ``constraint`` and its ``meaning`` in words."""

    name: str
    latex: str
    constraint: str
    meaning: str


class Equations(Record):
    """Equations of motion in display form."""

    approach: str
    formulas: List[Formula]
    multipliers: List[Multiplier]
    left_out: List[LeftOut]
    interrupted: bool

    def __init__(self, **values: Any) -> None:
        super().__init__(**values)
        self.formulas = [Formula(**f) for f in values["formulas"]]
        self.multipliers = [Multiplier(**m) for m in values["multipliers"]]
        self.left_out = [LeftOut(*entry) for entry in values["left_out"]]

    def __iter__(self) -> Iterator[Formula]:
        return iter(self.formulas)

    def __len__(self) -> int:
        return len(self.formulas)

    def __getitem__(self, key: str) -> List[Formula]:
        """The formulas of one key: "equations", "explicit", "constraints", "reactions", .."""
        return [formula for formula in self.formulas if formula.key == key]

    def text(self, key: Optional[str] = None) -> str:
        """The formulas, of one key or all of them, one a line."""
        return "\n".join(f.text for f in self.formulas if key is None or f.key == key)

    def latex(self, key: Optional[str] = None) -> str:
        """The same in LaTeX."""
        return "\n".join(f.latex for f in self.formulas if key is None or f.key == key)

    def __str__(self) -> str:
        return self.text()

    def _repr_latex_(self) -> str:
        lines = " \\\\\n".join(f.latex for f in self.formulas)
        return f"$$\\begin{{array}}{{l}}\n{lines}\n\\end{{array}}$$"


class Constraint(Record):
    """Classification of a constraint: ``integrable`` is "yes", "no" or "unknown"."""

    name: str
    kind: str
    integrable: str
    integral: Optional[str]
    redundant: bool
    treatment: str
    reason: str


class ForceClass(Record):
    """Classification of a force: ``conservative`` is "yes", "no" or "unknown"."""

    name: str
    conservative: str
    potential: Optional[Formula]
    reason: str


class ConservedQuantity(Record):
    """A quantity that is constant along every motion. ``proven``: symbolically, otherwise by numbers only.
    ``where_zero``: parameters that must be 0 for it, as they are; usually none."""

    name: str
    title: str
    expression: Formula
    proven: bool
    where_zero: List[str]


class Examination(Record):
    """Structure of a model: degrees of freedom, classes of constraints and forces, conserved quantities."""

    coordinates: List[Quantity]
    eliminated: List[str]
    parameters: List[Quantity]
    inputs: List[Quantity]
    degrees_of_freedom: int
    constraints: List[Constraint]
    forces: List[ForceClass]
    conserved: List[ConservedQuantity]
    singular: List[Formula]
    left_out: List[LeftOut]

    def __init__(self, **values: Any) -> None:
        super().__init__(**values)
        for name in ("coordinates", "parameters", "inputs"):
            setattr(self, name, [Quantity(*q) for q in values[name]])
        self.constraints = [Constraint(**c) for c in values["constraints"]]
        self.forces = [
            ForceClass(**{**f, "potential": f["potential"] and Formula(**f["potential"])}) for f in values["forces"]
        ]
        self.conserved = [
            ConservedQuantity(**{**c, "expression": Formula(**c["expression"])}) for c in values["conserved"]
        ]
        self.singular = [Formula(**f) for f in values["singular"]]
        self.left_out = [LeftOut(*entry) for entry in values["left_out"]]


class Comparison(Record):
    """Two derivations that were compared, or a derivation with code generated from it."""

    a: str
    b: str
    shares_code: bool
    max_relative_difference: float
    tolerance: float
    passed: bool


class Certificate(Record):
    """Verdict of a verification with all comparisons. True if it passed."""

    passed: bool
    points: int
    digits: int
    comparisons: List[Comparison]
    left_out: List[LeftOut]
    summary: str
    interrupted: bool

    def __init__(self, **values: Any) -> None:
        super().__init__(**values)
        self.comparisons = [Comparison(**c) for c in values["comparisons"]]
        self.left_out = [LeftOut(*entry) for entry in values["left_out"]]

    def __bool__(self) -> bool:
        return self.passed

    def __str__(self) -> str:
        return self.summary


class Sources(Record):
    """Emitted source files: ``files`` maps names to texts, or to bytes for an archive (target "fmu").

    ``flops``: operations of the right-hand side.
    """

    files: "Dict[str, str | bytes]"
    formulation: str
    approach: str
    form: str
    flops: int
    certificate: str
    single_precision_error: float

    @checked
    def write(self, folder: "str | os.PathLike[str]" = ".") -> List[str]:
        """Writes the files into a folder, which is made if needed, and returns their paths."""
        os.makedirs(folder, exist_ok=True)
        paths = []
        for name, content in self.files.items():
            paths.append(os.path.join(folder, name))
            with open(paths[-1], "wb") as file:
                file.write(content if isinstance(content, bytes) else content.encode("utf-8"))
        return paths


class Invariant(Record):
    """A conserved quantity and its largest relative drift in a run."""

    name: str
    initial: float
    max_relative_drift: float


class Table(Record):
    """Columns over time. ``table["theta"]`` is a column."""

    columns: List[str]
    times: "NDArray[Any]"
    rows: "NDArray[Any]"

    def __getitem__(self, column: str) -> "NDArray[Any]":
        """The values of a column: K numbers, at ``times``."""
        if column == "t":
            return self.times
        try:
            return self.rows[:, self.columns.index(column)]
        except ValueError:
            raise KeyError(f"there is no column '{column}'; there are: {', '.join(self.columns)}") from None

    def plot(self, *columns: str) -> Any:
        """Plots columns over time, by default all of them, with Matplotlib, and returns the axes."""
        from importlib import import_module

        plt: Any = import_module("matplotlib.pyplot")
        _, axes = plt.subplots()
        for column in columns or self.columns:
            axes.plot(self.times, self[column], label=column)
        axes.set_xlabel("t [s]")
        axes.legend()
        return axes

    def svg(self, *columns: str) -> str:
        """Columns over time, by default all of them, as the text of an SVG picture. It needs no other package."""
        from . import _core

        names = list(columns or self.columns)
        units = {self.__dict__.get("units", {}).get(name, "") for name in names}
        label = units.pop() if len(units) == 1 else ""
        return _core.line_plot(names, self.times.tolist(), [self[name].tolist() for name in names], label)


class Motion(Table):
    """A motion of a scene.

    ``times``: K, in s. ``rows``: K x C, one column for each of ``columns``, in the units of ``units``. ``final``: the
    values at the time ``t`` that was reached. ``error_estimate``: the estimated absolute error of each state there,
    and "max"; None if none was made. ``estimate_note``: why the estimate is unreliable, or None. ``outcome``: "done",
    "stopped_by_event", "interrupted", or the name of a failure. ``power_balance``: the largest imbalance of energy
    and work, relative to the energies exchanged. ``constraint_drift``: the largest violation of a constraint.
    """

    outcome: str
    detail: str
    solver: str
    solver_reason: str
    tier: str
    tier_reason: str
    t: float
    units: Dict[str, str]
    final: Dict[str, float]
    error_estimate: Optional[Dict[str, float]]
    estimate_note: Optional[str]
    invariants: List[Invariant]
    power_balance: float
    constraint_drift: float
    steps: int
    rhs_evaluations: int
    events: List[Event]
    certificate: str

    def __init__(self, **values: Any) -> None:
        super().__init__(**values)
        self.invariants = [Invariant(**i) for i in values["invariants"]]
        self.events = list(values["events"])

    @property
    def is_complete(self) -> bool:
        """Whether the run reached its end or an event that stops the scene."""
        return self.outcome in ("done", "stopped_by_event")

    def __str__(self) -> str:
        lines = [f"{self.outcome} at t = {self.t:.15g}" + (f": {self.detail}" if self.detail else "")]
        estimate = self.error_estimate or {}
        for name, value in self.final.items():
            error = f"  +- {estimate[name]:.1e}" if name in estimate else ""
            lines.append(f"  {name:<20} {value:>22.15g}{error}  {self.units.get(name, '')}".rstrip())
        return "\n".join(lines)


class InverseDynamics(Table):
    """Forces that prescribed motions require. ``times``: K, in s. ``rows``: K x C. ``forces``: their columns."""

    outcome: str
    detail: str
    certificate: str
    forces: List[str]


class Sweep(Record):
    """Runs of one scene with other values. ``sweep["theta"]`` are ends, ``sweep.given("theta")`` are starts.

    ``points``: K x P, values of ``parameters``. ``final``: K x C, the values of ``columns`` at the end of each run;
    NaN where a run failed. ``errors``: K, the largest estimated error of a state of each run, or None. ``outcomes``: K
    names; "refused" where the library refused the values, with the reason in ``details``. ``t``: K, times that were
    reached, in s.
    """

    parameters: List[str]
    points: "NDArray[Any]"
    columns: List[str]
    units: Dict[str, str]
    final: "NDArray[Any]"
    errors: "Optional[NDArray[Any]]"
    outcomes: List[str]
    details: List[str]
    t: "NDArray[Any]"

    def __getitem__(self, name: str) -> "NDArray[Any]":
        """The values of a column at the ends: (K,)."""
        if name not in self.columns:
            raise KeyError(f"there is no column '{name}'; there are: {', '.join(self.columns)}")
        return self.final[:, self.columns.index(name)]

    def given(self, name: str) -> "NDArray[Any]":
        """The values of a parameter or of an initial value: (K,)."""
        if name not in self.parameters:
            raise KeyError(f"'{name}' was not varied; these were: {', '.join(self.parameters)}")
        return self.points[:, self.parameters.index(name)]

    def __len__(self) -> int:
        return len(self.outcomes)

    @property
    def failed(self) -> "NDArray[Any]":
        """The numbers of runs that did not reach their end."""
        import numpy as np

        complete = ("done", "stopped_by_event")
        return np.flatnonzero([outcome not in complete for outcome in self.outcomes])


class Linearization(Record):
    """y' = A y + B u and o = C y + D u about a state, in independent coordinates and speeds.

    ``A``: n x n, ``B``: n x k, ``C``: m x n, ``D``: m x k, in the order of ``states``, ``inputs`` and ``outputs``.
    ``output_values``: the outputs at the state.
    ``eigenvalues``: n complex numbers in 1/s. ``kind``: "equilibrium", "steady motion" or "motion".
    """

    kind: str
    states: List[str]
    inputs: List[str]
    A: "NDArray[Any]"
    B: "NDArray[Any]"
    outputs: List[str]
    output_values: "NDArray[Any]"
    C: "NDArray[Any]"
    D: "NDArray[Any]"
    eigenvalues: "NDArray[Any]"
    structural_zeros: int
    certificate: str


class SteadyMotion(Record):
    """An equilibrium or a steady motion with its stability: "stable", "unknown" or "unstable"."""

    kind: str
    state: Dict[str, float]
    stability: str
    reason: str
    eigenvalues: "NDArray[Any]"
    family_dimension: int


class SteadyMotions(Record):
    """Equilibria and steady motions that were found, and the outputs that the search held."""

    motions: List[SteadyMotion]
    held: Dict[str, float]
    interrupted: bool
    certificate: str

    def __init__(self, **values: Any) -> None:
        super().__init__(**values)
        self.motions = [SteadyMotion(**m) for m in values["motions"]]

    def __iter__(self) -> Iterator[SteadyMotion]:
        return iter(self.motions)

    def __len__(self) -> int:
        return len(self.motions)

    def __getitem__(self, place: int) -> SteadyMotion:
        return self.motions[place]


class BenchmarkRow(Record):
    """One run of one solver: ``error`` of the final state against ``seconds``."""

    solver: str
    rtol: float
    step: float
    error: float
    seconds: float
    steps: int
    rhs_evaluations: int
    outcome: str


class Benchmark(Record):
    """Error against run time of every eligible solver."""

    rows: List[BenchmarkRow]
    left_out: List[LeftOut]
    reference_digits: int
    advice: str
    conclusive: bool

    def __init__(self, **values: Any) -> None:
        super().__init__(**values)
        self.rows = [BenchmarkRow(**row) for row in values["rows"]]
        self.left_out = [LeftOut(*entry) for entry in values["left_out"]]


class StressRow(Record):
    """One solver on one variation: ``verdict`` is "pass", "reported" or "undetected"."""

    test: str
    solver: str
    verdict: str
    error: float
    estimate: float
    outcome: str
    note: str


class StressTest(Record):
    """Verdicts of solvers on stiff and extreme variations of a scene."""

    rows: List[StressRow]
    left_out: List[LeftOut]
    passed: int
    reported: int
    undetected: int

    def __init__(self, **values: Any) -> None:
        super().__init__(**values)
        self.rows = [StressRow(**row) for row in values["rows"]]
        self.left_out = [LeftOut(*entry) for entry in values["left_out"]]

# SPDX-License-Identifier: GPL-3.0-or-later
"""The mechanical system and all analyses of it."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Callable, List, Mapping, Optional, Sequence, Tuple

from . import _core
from .arguments import checked, converters_of
from .compiled import CompiledModel
from .errors import input_error, warn
from .records import (
    Benchmark,
    Certificate,
    Equations,
    Examination,
    InverseDynamics,
    Linearization,
    Motion,
    Record,
    Sources,
    SteadyMotions,
    StressTest,
    Sweep,
)

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from .definition import Definition
    from .derivation import Derivation, SympyEquations

Stage = Optional[Callable[[str], None]]
Progress = Optional[Callable[[float], Optional[bool]]]
Values = Optional[Mapping[str, "float | str"]]


def _callbacks(on_stage: Stage, on_progress: Progress) -> _core.Callbacks:
    return _core.Callbacks(on_stage, on_progress, warn)


class ReaderWarning(Record):
    """A warning of the model reader with its place in the file, counted from 1, and its remedy."""

    file: str
    line: int
    column: int
    source_line: str
    message: str
    remedy: str
    report: str

    def __str__(self) -> str:
        return self.report.rstrip("\n")


class Model:
    """A model that was read and checked. It does not change, and any thread may use it.

    All calls release the GIL. Derivations wait for one another; integrations do not. Ctrl-C ends every call with
    KeyboardInterrupt. Calls take callbacks: ``on_stage(name)`` at each stage, ``on_progress(fraction)`` during long
    ones. If ``on_progress`` returns False, the call ends: ``run``, ``sweep``, ``equilibria`` and ``verify`` return
    partial results, which say so, and others raise Interrupted. Errors are eomgen.Error with the place in the model.
    """

    __slots__ = ("_core",)

    @checked
    def __init__(self, text: "str | Definition", name: str = "model", folder: "str | os.PathLike[str]" = "") -> None:
        """Reads a model from text in the format of model files. ``name``: of the model, and of the file in errors.

        ``folder``: of CSV files that the text names; without it the text may name none.
        """
        self._core = _core.Model.from_text(text, name, folder)

    @classmethod
    @checked
    def from_file(cls, path: "str | os.PathLike[str]") -> "Model":
        """Reads a model file. Raises Error if it is not a valid model."""
        model = cls.__new__(cls)
        model._core = _core.Model.from_file(path)
        return model

    @classmethod
    @checked
    def from_urdf(
        cls,
        path: "str | os.PathLike[str]",
        *,
        floating: bool = False,
        attitude: str = "euler",
        friction: str = "smooth",
        actuators: str = "transmissions",
        stops: "Sequence[str] | str" = (),
        parameters: bool = False,
        exact_angles: bool = False,
        name: Optional[str] = None,
    ) -> "Model":
        """Reads a robot file (URDF or MJCF) as a model: ``eomgen import``. ``text`` is the model file.

        ``floating``: the root link moves. ``attitude``: of free links, "euler" or "euler_parameters". ``friction``:
        "smooth", "dry" or "none". ``actuators``: joints with an input, "transmissions", "all" or "none". ``stops``:
        joints whose limits are end stops. ``parameters``: masses, centres, tensors as parameters. What has no meaning
        in a model is a ModelWarning with its line.
        """
        found = _core.import_robot(
            path, floating, attitude, friction, actuators, list(stops), parameters, exact_angles
        )
        for what, why, count, line in found["left_out"]:
            text = f"{path}:{line}: '{what}' is not in the model ({count} times): {why}"
            warn(text)
        base = os.path.splitext(os.path.basename(path))[0]
        return cls(found["text"], name or base)

    @classmethod
    @checked
    def from_mjcf(cls, path: "str | os.PathLike[str]", **options: Any) -> "Model":
        """Reads a robot file of MuJoCo (MJCF). Options are those of from_urdf; the file states what is free."""
        return cls.from_urdf(path, **options)

    @classmethod
    @checked
    def from_text(cls, text: "str | Definition", name: str = "model", folder: "str | os.PathLike[str]" = "") -> "Model":
        """Reads a model from text in the format of model files. ``folder``: of CSV files that the text names."""
        return cls(text, name, folder)

    def __reduce__(self) -> Any:
        folder = self._core.folder()
        return (type(self), (self.text, self.name, os.path.abspath(folder) if folder else ""))

    def __repr__(self) -> str:
        title = f": {self.title}" if self.title else ""
        return f"<eomgen.Model {self.name}{title}>"

    @property
    def name(self) -> str:
        """The base name of the file, or ``name`` of from_text."""
        return self._core.id()

    @property
    def title(self) -> str:
        """The title of the model, or ""."""
        return self._core.title()

    @property
    def text(self) -> str:
        """The text of the model file."""
        return self._core.text()

    @property
    def coordinates(self) -> List[str]:
        """Names of the coordinates, with those that constraints eliminate."""
        return self._core.coordinates()

    @property
    def parameters(self) -> List[str]:
        """Names of the parameters. ``check().parameters`` has units and values."""
        return self._core.parameters()

    @property
    def inputs(self) -> List[str]:
        """Names of the inputs."""
        return self._core.inputs()

    @property
    def scenes(self) -> List[str]:
        """Names of the scenes."""
        return self._core.scenes()

    @property
    def warnings(self) -> List[ReaderWarning]:
        """Warnings of the model reader."""
        return [ReaderWarning(**w) for w in self._core.warnings()]

    @checked
    def check(self, *, on_stage: Stage = None) -> Examination:
        """Classifies the model: degrees of freedom, constraints, forces, conserved quantities, singular sets."""
        return Examination(**self._core.check(_callbacks(on_stage, None)))

    @checked
    def derive(
        self,
        approach: str = "auto",
        show: "Sequence[str] | str | None" = None,
        *,
        on_stage: Stage = None,
    ) -> Equations:
        """Derives the equations of motion in display form, as text, LaTeX and MathML.

        ``approach``: "I" (constraint forces appear), "II" (constraints are eliminated first) or "auto". ``show``: kinds
        of formulas, as in ``eomgen derive --show``; by default "equations", "constraints", "reactions", "friction".
        """
        return Equations(**self._core.derive(approach, show, _callbacks(on_stage, None)))

    @checked
    def derivation(self, approach: str = "II", *, on_stage: Stage = None) -> "Derivation":
        """Derives the equations of motion as data: M qddot = f + A^T lambda. "auto" means approach II."""
        from .derivation import Derivation

        return Derivation(**self._core.derivation(approach, _callbacks(on_stage, None)))

    @checked
    def to_sympy(self, approach: str = "II", *, functions_of_time: bool = False) -> "SympyEquations":
        """The equations of motion as expressions of SymPy: ``derivation(approach).to_sympy()``."""
        return self.derivation(approach).to_sympy(functions_of_time)

    @checked
    def document(self, *, seed: int = 1, on_stage: Stage = None) -> str:
        """Returns the whole derivation as a LaTeX document, checked against the independent oracle."""
        return self._core.document(seed, _callbacks(on_stage, None))

    @checked
    def verify(
        self,
        *,
        digits: int = 50,
        points: int = 20,
        compile: bool = True,
        seed: int = 1,
        on_stage: Stage = None,
        on_progress: Progress = None,
    ) -> Certificate:
        """Checks all formulations against the independent oracle in multiple precision.

        ``digits``: of the arithmetic, 20 to 300. ``points``: random states. ``compile``: also checks the emitted code,
        which needs a C compiler. A failed check is a result (``passed`` is False), not an error.
        """
        callbacks = _callbacks(on_stage, on_progress)
        return Certificate(**self._core.verify(digits, points, compile, seed, callbacks))

    @checked
    def emit(
        self,
        target: str = "cpp",
        *,
        functions: "Sequence[str] | str" = (),
        outputs: "Sequence[str] | str" = (),
        fixed: "Sequence[str] | str" = (),
        approach: str = "auto",
        form: str = "auto",
        real: str = "double",
        seed: int = 1,
        on_stage: Stage = None,
    ) -> Sources:
        """Generates verified source code, under the MIT licence.

        ``target``: one of eomgen.targets(). ``functions``: beside the right-hand side: "jac", "mass", .. ``fixed``:
        parameters that are replaced by their numbers. ``real``: "double" or "float".
        """
        callbacks = _callbacks(on_stage, None)
        found = self._core.emit(
            target, approach, form, list(functions), list(outputs), list(fixed), real, seed, callbacks
        )
        return Sources(**found)

    @checked
    def run(
        self,
        scene: str = "default",
        parameters: Values = None,
        *,
        t_end: Optional[float] = None,
        rtol: Optional[float] = None,
        atol: Optional[float] = None,
        step: Optional[float] = None,
        max_step: Optional[float] = None,
        every: Optional[float] = None,
        solver: Optional[str] = None,
        outputs: "Sequence[str] | str" = (),
        approach: str = "auto",
        form: str = "auto",
        tier: str = "auto",
        max_steps: int = 0,
        error_estimate: bool = True,
        estimate: str = "bounded",
        charts: bool = True,
        seed: int = 1,
        row: "Optional[Callable[[float, NDArray[Any]], None]]" = None,
        on_stage: Stage = None,
        on_progress: Progress = None,
    ) -> Motion:
        """Integrates a scene and estimates the error of the result.

        ``parameters`` replaces values of parameters and constant inputs, and initial values of coordinates, rates and
        states: numbers in SI units, or text with a unit, "50 cm". ``t_end``, ``step``
        (fixed), ``max_step`` and ``every`` (interval of rows) are in s. ``outputs``: columns beside the coordinates;
        "all": every output. ``solver``: one of eomgen.solvers(), or "auto". ``tier``: "jit" (machine code in memory),
        "compiled" (the C compiler) or "auto". ``max_steps``: 0 is the solver's default. ``estimate``: "bounded"
        (about three times the steps of the run) or "full" (as many as tighter runs need). ``row(t, values)`` receives
        the rows instead of the result. A run that fails numerically returns its outcome and raises nothing.
        """
        options = {
            "scene": scene,
            "parameters": parameters,
            "t_end": t_end,
            "rtol": rtol,
            "atol": atol,
            "step": step,
            "max_step": max_step,
            "every": every,
            "solver": solver,
            "outputs": list(outputs),
            "approach": approach,
            "form": form,
            "tier": tier,
            "max_steps": max_steps,
            "error_estimate": error_estimate,
            "estimate": estimate,
            "charts": charts,
            "seed": seed,
        }
        return Motion(**self._core.run(options, row, _callbacks(on_stage, on_progress)))

    @checked
    def compile(
        self,
        scene: str = "default",
        parameters: Values = None,
        *,
        functions: "Sequence[str] | str | None" = None,
        outputs: "Sequence[str] | str" = (),
        approach: str = "auto",
        form: str = "auto",
        tier: str = "auto",
        solver: Optional[str] = None,
        charts: bool = True,
        seed: int = 1,
        on_stage: Stage = None,
    ) -> CompiledModel:
        """Compiles the equations as functions of numbers, with the numbers of a scene.

        ``parameters`` replaces values of parameters and initial values. ``functions``: beside "rhs" and "outputs", of
        "jac", "jac_p", "jac_u", "jvp", "vjp", "adjoint", "hvp", "inverse", "regressor", "coriolis", "gravity", "mass",
        "momenta", "momentum", "constraints", "reactions", "events", "energy_gradients", "frames", "taylor", and
        "momenta_jac", "outputs_jac", "reactions_jac", each also with "_p" and "_u"; by default "jac", "mass", and for a
        model with constraints "constraints" and "reactions". ``solver``: of simulations.
        """
        options = {
            "scene": scene,
            "parameters": parameters,
            "functions": functions,
            "outputs": list(outputs),
            "approach": approach,
            "form": form,
            "tier": tier,
            "solver": solver,
            "charts": charts,
            "seed": seed,
        }
        return CompiledModel(self, options, _callbacks(on_stage, None))

    @checked
    def sweep(
        self,
        points: "Optional[Mapping[str, ArrayLike]]" = None,
        *,
        grid: "Optional[Mapping[str, ArrayLike]]" = None,
        jobs: Optional[int] = None,
        on_progress: Progress = None,
        **options: Any,
    ) -> Sweep:
        """Runs a scene for many values of parameters and initial values, in threads.

        ``points``: arrays of the same length K; run k takes the k-th value of each. ``grid``: arrays whose combinations
        are the runs, the last one varying fastest; with ``points`` each point goes with every combination. ``jobs``:
        threads, by default one for each processor. ``options``: those of ``run``.
        """
        names, values = _sweep_points(points or {}, grid or {})  # type: ignore[arg-type]
        known = {
            "scene", "parameters", "t_end", "rtol", "atol", "step", "max_step", "solver", "outputs", "approach", "form",
            "tier", "max_steps", "error_estimate", "estimate", "charts", "seed",
        }  # fmt: skip
        for name in options:
            if name not in known:
                raise TypeError(f"sweep() has no option '{name}'; it takes points, grid, jobs, on_progress and of run() "
                                f"{', '.join(sorted(known))}")  # fmt: skip
        converters = converters_of(type(self).run)
        options = {name: converters[name](name, value, self) for name, value in options.items()}
        found = self._core.sweep(options, names, values, jobs or os.cpu_count() or 1, _callbacks(None, on_progress))
        return Sweep(**found)

    @checked
    def inverse(
        self,
        scene: str = "default",
        parameters: Values = None,
        *,
        t_end: Optional[float] = None,
        every: Optional[float] = None,
        rtol: Optional[float] = None,
        atol: Optional[float] = None,
        constraints: "Sequence[str] | str" = (),
        seed: int = 1,
        on_stage: Stage = None,
        on_progress: Progress = None,
    ) -> InverseDynamics:
        """Computes the forces that prescribed motions require, in N and N*m, over time.

        ``constraints``: those whose forces are wanted, by default all that prescribe a coordinate.
        """
        callbacks = _callbacks(on_stage, on_progress)
        values = parameters or {}
        found = self._core.inverse(scene, values, t_end, every, rtol, atol, list(constraints), seed, callbacks)
        return InverseDynamics(**found)

    @checked
    def linearize(
        self,
        scene: str = "default",
        parameters: Values = None,
        *,
        at: Optional[float] = None,
        outputs: "Sequence[str] | str | None" = None,
        seed: int = 1,
        on_stage: Stage = None,
    ) -> Linearization:
        """Linearises the equations about a state of a scene: its start, or the state that its run reaches at ``at``, in s.

        ``outputs``: names for C and D; without them those of the scene that have a slope there.
        """
        callbacks = _callbacks(on_stage, None)
        values = parameters or {}
        return Linearization(**self._core.linearize(scene, values, at, seed, outputs or [], callbacks))

    @checked
    def equilibria(
        self,
        scene: str = "default",
        parameters: Values = None,
        *,
        hold: Values = None,
        starts: int = 300,
        seed: int = 1,
        on_stage: Stage = None,
        on_progress: Progress = None,
    ) -> SteadyMotions:
        """Searches equilibria and steady motions and classifies their stability.

        ``hold``: outputs and the values at which they are held; by default the conserved momenta at the start.
        ``starts``: initial guesses of the search.
        """
        callbacks = _callbacks(on_stage, on_progress)
        found = self._core.equilibria(scene, parameters or {}, hold or {}, starts, seed, callbacks)
        return SteadyMotions(**found)

    @checked
    def bench(
        self,
        scene: str = "default",
        parameters: Values = None,
        *,
        t_end: Optional[float] = None,
        solvers: "Sequence[str] | str" = (),
        max_seconds: float = 10,
        other_libraries: bool = False,
        seed: int = 1,
        on_stage: Stage = None,
    ) -> Benchmark:
        """Measures the error and the run time of solvers against a reference solution.

        ``max_seconds``: the limit of a run.
        """
        callbacks = _callbacks(on_stage, None)
        values, names = parameters or {}, list(solvers)
        return Benchmark(
            **self._core.bench(scene, values, t_end, names, max_seconds, other_libraries, seed, callbacks)
        )

    @checked
    def stress(
        self,
        scene: str = "default",
        parameters: Values = None,
        *,
        t_end: Optional[float] = None,
        solvers: "Sequence[str] | str" = (),
        max_seconds: float = 60,
        max_steps: int = 20000,
        quick: bool = False,
        seed: int = 1,
        on_stage: Stage = None,
    ) -> StressTest:
        """Runs solvers on stiff and extreme variations of a scene. ``quick``: few variations of each kind."""
        callbacks = _callbacks(on_stage, None)
        values, names = parameters or {}, list(solvers)
        found = self._core.stress(scene, values, t_end, names, max_seconds, max_steps, quick, seed, callbacks)
        return StressTest(**found)

    @checked
    def report(
        self,
        path: "str | os.PathLike[str] | None" = None,
        scene: str = "default",
        parameters: Values = None,
        *,
        t_end: Optional[float] = None,
        solver: Optional[str] = None,
    ) -> "Report":
        """Makes one self-contained page: equations, verification, a run, plots, an animation.

        Jupyter shows it inline. ``path``: also writes it there. It calls the program eomgen.
        """
        import tempfile

        from .program import call_program

        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, self.name + ".toml"), "w", encoding="utf-8") as file:
                file.write(self.text)
            arguments = ["report", self.name + ".toml", "--out", "page.html", "--scene", scene]
            for name, value in (parameters or {}).items():
                arguments += ["--set", f"{name}={value!r}"]
            if t_end is not None:
                arguments += ["--t-end", repr(t_end)]
            if solver is not None:
                arguments += ["--solver", solver]
            call_program(arguments, folder)
            with open(os.path.join(folder, "page.html"), encoding="utf-8") as file:
                page = Report(html=file.read())
        if path is not None:
            page.write(path)
        return page


class Report(Record):
    """A page of HTML that needs no other file and no network. Jupyter shows it inline."""

    html: str

    @checked
    def write(self, path: "str | os.PathLike[str]") -> None:
        """Writes the page to a file."""
        with open(path, "w", encoding="utf-8") as file:
            file.write(self.html)

    def _repr_html_(self) -> str:
        import html

        return f'<iframe srcdoc="{html.escape(self.html)}" width="100%" height="700" style="border: 0"></iframe>'


def _sweep_points(
    columns: "Mapping[str, NDArray[Any]]", axes: "Mapping[str, NDArray[Any]]"
) -> "Tuple[List[str], NDArray[Any]]":
    """Names, and K x P values."""
    import numpy as np

    if not columns and not axes:
        raise input_error("a sweep has no points", "give points={'m': [1, 2]} or grid={'m': [1, 2], 'k': [3, 4]}")
    for name, values in {**columns, **axes}.items():
        if values.ndim != 1 or values.size == 0:
            raise input_error(f"the values of '{name}' are no list of numbers", "give a list of at least one number")
    both = sorted(columns.keys() & axes.keys())
    if both:
        raise input_error(f"'{both[0]}' is in points and in grid", "name it once")
    lengths = {name: len(values) for name, values in columns.items()}
    if len(set(lengths.values())) > 1:
        raise input_error(f"the lengths of points differ: {lengths}", "give as many values of each name")
    count = next(iter(lengths.values()), 1)
    sizes = [count, *(len(values) for values in axes.values())]
    places = np.indices(sizes).reshape(len(sizes), -1)
    table = [values[places[0]] for values in columns.values()]
    table += [values[place] for values, place in zip(axes.values(), places[1:])]
    return [*columns, *axes], np.column_stack(table)

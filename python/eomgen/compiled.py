# SPDX-License-Identifier: GPL-3.0-or-later
"""Compiled equations of motion as functions of numbers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from . import _core, control
from .arguments import checked, integer, number, value_of, values_by_name
from .control import DiscreteStep, StateSpace, TransferFunction, Trim
from .records import Quantity

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .model import Model
    from .simulation import Simulation


class SceneValues(NamedTuple):
    """Numbers of a scene: its span in s, parameters (P,), and the state at its start (N,)."""

    t_start: float
    t_end: float
    parameters: "NDArray[Any]"
    state: "NDArray[Any]"


class Frame(NamedTuple):
    """The motion of a body, particle or point along the fixed axes: ``compiled.frames(t, x)``.

    ``position``: (3,) in m. ``rotation``: (3, 3), whose columns are the axes of the body; the identity for particles
    and for points that no body carries. ``jacobian`` J: (6, n), and ``bias``: (6,). The first three rows are linear
    and the others angular: velocity = J qdot + the part of prescribed motions, acceleration = J qddot + bias.
    """

    position: "NDArray[Any]"
    rotation: "NDArray[Any]"
    jacobian: "NDArray[Any]"
    bias: "NDArray[Any]"


class StepJacobian(NamedTuple):
    """The end of a step and its derivatives: ``compiled.step_jac(t, h, x)``. K states give arrays with K in front.

    ``x1``: (N,). ``A``: dx1/dx, (N, N). ``B``: dx1/d(inputs), (N, U); None unless "jac_u" was compiled. ``P``:
    dx1/d(parameters), (N, P), each parameter by itself; None unless "jac_p" was compiled. ``h``, ``t``: dx1/dh and
    dx1/dt, (N,). For "variational2" these functions are "momenta_jac_u" and "momenta_jac_p".
    """

    x1: "NDArray[Any]"
    A: "NDArray[Any]"
    B: "Optional[NDArray[Any]]"
    P: "Optional[NDArray[Any]]"
    h: "NDArray[Any]"
    t: "NDArray[Any]"


class CompiledModel(_core.CompiledModel):
    """Verified and compiled equations with the numbers of one scene: ``model.compile()``.

    n free coordinates; N = 2 n + states of first order; P parameters; U inputs; m constraints with multipliers; Y
    outputs. Its functions take t in s and x, (N,) or K of them, (K, N), in SI units. They release the GIL, take no
    lock, and any number of threads may call them. For SciPy:

    >>> solve_ivp(compiled.rhs, compiled.span, compiled.start, method="Radau", jac=compiled.jac)

    A function that was not compiled raises Error, which names it: ``model.compile(functions=["jac_u"])``.
    """

    def __init__(self, model: "Model", options: Dict[str, Any], callbacks: _core.Callbacks) -> None:
        super().__init__(model._core, options, callbacks)
        self._model = model
        self._options = options

    def __reduce__(self) -> Any:
        return (_compile, (self._model, self._options))

    def __repr__(self) -> str:
        return f"<eomgen.CompiledModel {self._model.name}, scene {self.scene}, {len(self.state_names)} states>"

    @property
    def model(self) -> "Model":
        """The model."""
        return self._model

    @property
    def scene(self) -> str:
        """The name of the scene."""
        return self._scene()

    @property
    def states(self) -> List[Quantity]:
        """N names with units: coordinates, rates, states of first order."""
        return [Quantity(*q) for q in self._states()]

    @property
    def state_names(self) -> List[str]:
        """N names."""
        return [name for name, _ in self._states()]

    @property
    def parameter_names(self) -> List[str]:
        """P names."""
        return [name for name, _ in self._parameters()]

    @property
    def input_names(self) -> List[str]:
        """U names."""
        return [name for name, _ in self._inputs()]

    @property
    def output_names(self) -> List[str]:
        """Y names: every coordinate and its rate first."""
        return [name for name, _ in self._outputs()]

    @property
    def constraint_names(self) -> List[str]:
        """m labels of the constraints with multipliers."""
        return self._constraints()

    @property
    def reaction_names(self) -> List[str]:
        """Labels of all constraints, in the order of reactions()."""
        return self._reactions()

    @property
    def event_names(self) -> List[str]:
        """Names of the events of the model, the first values of events()."""
        return self._events()

    @property
    def frame_names(self) -> List[str]:
        """Names of the bodies, particles and points of frames(); empty unless "frames" was compiled."""
        return self._frame_names()

    @property
    def inertial_parameter_names(self) -> List[str]:
        """Names of the inertial parameters of regressor(); empty unless "regressor" was compiled."""
        return self._inertial_parameter_names()

    @property
    def units(self) -> Dict[str, str]:
        """SI units of states, parameters, inputs and outputs by name; "" if unknown or a pure number."""
        return {name: unit for group in (self._outputs(), self._states(), self._parameters(), self._inputs()) for name, unit in group}

    @property
    def coordinate_count(self) -> int:
        """n."""
        return self._coordinate_count()

    @property
    def certificate(self) -> str:
        """The verification in one sentence."""
        return self._certificate()

    @property
    def tier(self) -> str:
        """ "jit" (machine code in memory) or "compiled" (a C compiler)."""
        return self._tier()

    @property
    def span(self) -> Tuple[float, float]:
        """The start and the end of the scene in s."""
        return self._values()[:2]

    @property
    def start(self) -> "NDArray[Any]":
        """The state at the start of the scene: (N,)."""
        return self._values()[3]

    @property
    def parameters(self) -> "NDArray[Any]":
        """The parameters of the scene: (P,)."""
        return self._values()[2]

    @checked
    def values(self, parameters: 'Optional[Mapping[str, "float | str"]]' = None) -> SceneValues:
        """The numbers of the scene with other parameters and initial values.

        ``parameters``: as of ``Model.run``. Parameters that depend on others follow, and the start satisfies the
        constraints.
        """
        return SceneValues(*(self._scene_values(parameters) if parameters else self._values()))

    def input_values(self, t: float) -> "NDArray[Any]":
        """The inputs of the scene at t in s: (U,)."""
        return self._input_values(number("t", t))

    def state(self, values: 'Optional[Mapping[str, "float | str"]]' = None, **more: "float | str") -> "NDArray[Any]":
        """A state from names: (N,). The others are 0. Constraints are not solved; ``values()`` does that.

        A value is a number in SI units, or text with a unit, "30 deg".
        """
        import numpy as np

        names = self.state_names
        x = np.zeros(len(names))
        given: Dict[str, Any] = {**values_by_name(self._model, "values", values or {}), **more}
        for name, value in given.items():
            if name not in names:
                raise KeyError(f"there is no state '{name}'; there are: {', '.join(names)}")
            x[names.index(name)] = value_of(self._model, "values", name, value)
        return x

    def taylor(
        self, t: float, x: "NDArray[Any]", order: int, inputs: Any = None, parameters: Any = None, mode: Any = None
    ) -> "NDArray[Any]":
        """Coefficients of the power series of the motion at constant inputs: (order + 1, N)."""
        return self._taylor(number("t", t), x, integer("order", order), inputs, parameters, mode)

    @staticmethod
    def step_methods() -> List[str]:
        """The methods of ``step``: explicit ones of order 4, 5, 5, 8; implicit ones of order 2 (midpoint, variational)."""
        return _core.CompiledModel._step_methods()

    def step(
        self, t: Any, h: Any, x: Any, inputs: Any = None, parameters: Any = None, mode: Any = None, method: str = "rk4"
    ) -> "NDArray[Any]":
        """The state after one step of a fixed-step method: (N,), or (K, N) of K states.

        Arguments as of rhs. ``h`` in s: a number or (K,), may be negative. ``method``: one of ``step_methods()``;
        "midpoint" needs "jac", "variational2" needs "momenta" and "momenta_jac". Inputs are held over the step. Contacts and kinks stay in ``mode``, events are ignored,
        and no constraint is projected: a Simulation does that.
        """
        return self._step(t, h, x, inputs, parameters, mode, method, False)[0]

    def step_jac(
        self, t: Any, h: Any, x: Any, inputs: Any = None, parameters: Any = None, mode: Any = None, method: str = "rk4"
    ) -> StepJacobian:
        """The same with its derivatives, which are exact for the method. Needs "jac", or the functions of the method.

        Derivatives of a motion follow by the chain rule: S = step.A @ S + step.P.
        """
        return StepJacobian(*self._step(t, h, x, inputs, parameters, mode, method, True))

    def frames(self, t: Any, x: "NDArray[Any]", parameters: Any = None, mode: Any = None) -> Dict[str, Frame]:
        """Poses, Jacobians and bias accelerations of bodies, particles and points by name.

        Arguments as of rhs. K states give arrays with K in front. Needs "frames".
        """
        import numpy as np

        pose, tangents, bias = self._frames(t, x, None, parameters, mode)
        n, ahead = self.coordinate_count, pose.shape[:-1]
        frames = {}
        for k, name in enumerate(self.frame_names):
            axes = pose[..., 12 * k + 3 : 12 * k + 12].reshape(ahead + (3, 3))
            frames[name] = Frame(
                pose[..., 12 * k : 12 * k + 3],
                np.swapaxes(axes, -1, -2),
                tangents[..., n * k : n * k + n],
                bias[..., 6 * k : 6 * k + 6],
            )
        return frames

    @checked
    def linearize(
        self,
        x: Any = None,
        inputs: Any = None,
        *,
        outputs: "Sequence[str] | str | None" = None,
        t: Optional[float] = None,
        mode: Any = None,
    ) -> StateSpace:
        """Linearises about a state: dx' = A dx + B du, dy = C dx + D du.

        ``x``: (N,), or names and values as in ``state()``; by default the start. ``inputs``: (U,), or names and values;
        by default those of the scene. ``outputs``: names; by default the states. A, B are exact (``jac``, ``jac_u``),
        and so are rows of C, D of states; rows of other outputs are extrapolated differences, good to about ten digits.
        For models without constraints with multipliers; ``model.linearize`` linearises on their manifold.
        """
        return control.linearize(self, x, inputs, outputs, t, mode)

    @checked
    def transfer_function(
        self,
        x: Any = None,
        inputs: Any = None,
        *,
        outputs: "Sequence[str] | str | None" = None,
        t: Optional[float] = None,
    ) -> TransferFunction:
        """The transfer functions from the inputs to outputs about a state: ``linearize(..).transfer_function()``."""
        return control.linearize(self, x, inputs, outputs, t, None).transfer_function()

    @checked
    def trim(
        self,
        x: Any = None,
        inputs: "Sequence[str] | str | None" = None,
        *,
        guess: Any = None,
        t: Optional[float] = None,
        tolerance: float = 1e-9,
    ) -> Trim:
        """Finds the inputs that hold a state: its accelerations vanish.

        ``x``: as in ``linearize``; rates that are not 0 give a steady motion. ``inputs``: names of those that may
        change, by default all; the others keep ``guess``, by default the values of the scene. States of first order
        follow. Raises Error, which names the coordinates, if these inputs cannot hold the state. Needs "jac_u".
        """
        return control.trim(self, x, inputs, guess, t, tolerance)

    @checked
    def discretize(
        self, period: float, x: Any = None, inputs: Any = None, *, t: Optional[float] = None, rtol: float = 1e-10
    ) -> DiscreteStep:
        """The nonlinear step from sample to sample, with held inputs, and its derivatives. ``period`` in s.

        ``rtol``: of the step, whose parts are halved until it is met. Inputs, kinks and contacts do not change within a
        step. ``linearize(..).discretize(period)`` discretises the linear system instead. Needs "jac_u" if there are
        inputs.
        """
        return control.discretize(self, period, x, inputs, t, rtol)

    def simulate(self, **options: Any) -> "Simulation":
        """A Simulation of these equations, with its options."""
        from .simulation import Simulation

        return Simulation(self, **options)


def _compile(model: "Model", options: Dict[str, Any]) -> CompiledModel:
    return CompiledModel(model, options, _core.Callbacks(None, None, None))

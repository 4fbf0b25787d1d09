# SPDX-License-Identifier: GPL-3.0-or-later
"""Equations of motion of mechanical systems: derivation, verification, integration, code.

>>> import eomgen
>>> model = eomgen.Model.from_file("pendulum.toml")
>>> print(model.derive())
>>> motion = model.run(t_end=10)
>>> motion["theta"]

Quantities are in SI units everywhere, angles in radians. Arrays are NumPy arrays of float64.
"""

from ._core import solvers, targets
from ._core import version as __version__
from .compiled import CompiledModel, StepJacobian
from .control import DiscreteStep, StateSpace, TransferFunction, Trim
from .definition import (
    Body,
    Chain,
    Constraint,
    Definition,
    Event,
    Force,
    Frame,
    Joint,
    Particle,
    Point,
    Sample,
    State,
)
from .errors import Error, Interrupted, ModelWarning
from .expressions import Expression, if_, quantity
from .model import Model
from .simulation import Simulation

__all__ = [
    "Body",
    "Chain",
    "CompiledModel",
    "Constraint",
    "Definition",
    "DiscreteStep",
    "Error",
    "Event",
    "Expression",
    "Force",
    "Frame",
    "Interrupted",
    "Joint",
    "Model",
    "ModelWarning",
    "Particle",
    "Point",
    "Sample",
    "Simulation",
    "State",
    "StateSpace",
    "StepJacobian",
    "TransferFunction",
    "Trim",
    "if_",
    "quantity",
    "solvers",
    "targets",
]

"""What a user adds to a step: constraints and costs in SI units with CVXPY, and private rises.

CVXPY itself is not needed to say what an extension is;
:mod:`~quasistatic_ref.optional.extensions.by_cvxpy` builds its symbols and solves with it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.errors import InputError, StepDataError, check_kind
from quasistatic_ref.numbers.arrays import Array, Indices, checked_array, freeze_copies
from quasistatic_ref.step.data import Extra
from quasistatic_ref.text.module_on_demand import ModuleOnDemand
from quasistatic_ref.text.plain import Plain

if TYPE_CHECKING:
    import cvxpy as cp
else:
    cp = ModuleOnDemand("cvxpy")


def none(symbols: object) -> tuple[()]:
    """No constraints or costs of a user."""
    return ()


@dataclass(frozen=True, eq=False)
class Symbols:
    """What an extension may use: CVXPY expressions in SI units, whatever units the problem has.

    An extension's function gets them; their constructor checks nothing.

    Parameters
    ----------
    delta_q, delta_q_a, delta_q_u : cvxpy.Expression
        The unknowns [m, rad].
    delta_q_bar_a : cvxpy.Expression
        Desired change of the actuated coordinates [m, rad].
    slack : tuple of cvxpy.Expression
        One expression for each row index i of the cone: phi + [J'(n~ + d~_i)]' delta_q [m] of the
        contacts that have row i. In the ellipsoid, the gap phi + J_n delta_q alone.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> def lifted(symbols: qr.Symbols):
    ...     return [symbols.delta_q_u[2] >= 1e-3]
    >>> round(float(qr.solve_step(step, extension=qr.Extension(lifted)).delta_q[2]), 9)
    0.001
    """

    delta_q: cp.Expression
    delta_q_a: cp.Expression
    delta_q_u: cp.Expression
    delta_q_bar_a: cp.Expression
    slack: tuple[cp.Expression, ...]


@dataclass(frozen=True, eq=False)
class Rises(Plain):
    """Un-actuated coordinates that exist within one step alone and start it at 0.

    Whatever slides lifts its rise against a load, which is friction, (R40). The first rises lie on
    coordinates, r >= |delta_q_i|; each of the others adds to the gap of a contact.

    Parameters
    ----------
    loads : ndarray, shape (p,)
        Forces that press them down, >= 0 [N, or N m on an angle].
    masses : ndarray, shape (p,)
        > 0 [kg, kg m^2].
    coordinates : ndarray of int, shape (c,)
        Entries of delta_q, of the first c rises.
    contacts : ndarray of int, shape (p - c,)
        Numbers of contacts, of the others.

    Raises
    ------
    StepDataError
        If a shape or a sign is wrong.
    """

    loads: Array
    masses: Array
    coordinates: Indices = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    contacts: Indices = field(default_factory=lambda: np.zeros(0, dtype=np.int64))

    def __post_init__(self) -> None:
        for name in ("coordinates", "contacts"):
            object.__setattr__(self, name, np.array(getattr(self, name), dtype=np.int64))
        p = len(self.coordinates) + len(self.contacts)
        for name in ("loads", "masses"):
            array = checked_array(getattr(self, name), f"rises.{name}", (p,))
            object.__setattr__(self, name, array)
        freeze_copies(self, "coordinates", "contacts")
        if not (self.masses > 0).all():
            problem = "must be greater than 0"
            raise StepDataError(problem, field="rises.masses", value=self.masses.tolist())
        if (self.loads < 0).any():
            problem = "must be >= 0: friction holds, it does not push"
            raise StepDataError(problem, field="rises.loads", value=self.loads.tolist())

    def __len__(self) -> int:
        return len(self.loads)


NO_RISES = Rises(np.zeros(0), np.zeros(0))


@dataclass(frozen=True, eq=False)
class Extension:
    """Constraints and costs of a user's own, and private rises.

    Parameters
    ----------
    terms : callable
        Symbols -> constraints and scalar costs, in any order. A cost is added to (13), whose unit
        is h times an energy [N m s]; parameters and further variables are the user's own.
    without_stiffness : bool
        Whether the costs take the place of the impedance (1): K_q and tau_k are then zero.
    rises : Rises
        No symbol holds their displacements.
    rows : Extra, optional
        Linear inequalities of delta_q as numbers, which need no CVXPY.

    Raises
    ------
    InputError
        If an argument is of another type.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> limit = qr.Extension(lambda s: [s.delta_q[2] <= 1e-5])
    >>> bool(qr.solve_step(step, extension=limit).delta_q[2] <= 1e-5)
    True
    """

    terms: Callable[[Symbols], Sequence[cp.Constraint | cp.Expression]] = none
    without_stiffness: bool = False
    rises: Rises = NO_RISES
    rows: Extra | None = None

    def __post_init__(self) -> None:
        if not callable(self.terms):
            problem = "must be a function of the symbols"
            raise InputError(problem, field="extension.terms", value=type(self.terms).__name__)
        field = "extension.without_stiffness"
        check_kind(self.without_stiffness, bool, field, "True or False")
        check_kind(self.rises, Rises, "extension.rises", "Rises")
        check_kind(self.rows, Extra | None, "extension.rows", "an Extra")

    @property
    def same_for_all_loads(self) -> bool:
        """Whether it is rows and rises alone: terms may use the step's loads and targets."""
        return self.terms is none


def checked_extension(extension: object) -> Extension:
    """The extension itself; InputError if it is something else."""
    if not isinstance(extension, Extension):
        problem = "must be an Extension"
        raise InputError(problem, field="extension", value=type(extension).__name__)
    return extension

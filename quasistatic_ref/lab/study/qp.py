"""One problem of a study: a quadratic program in float64, and its exact answer.

The problem is the four arrays as they are: somebody who reads them from a file has the same
numbers, and the exact answer belongs to these, not to the step that they were rounded from.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from quasistatic_ref.solve.reply import step_of
from quasistatic_ref.solve.units import Units, natural_units
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.standard_form import StandardForm

UNITS = ("raw", "natural")
ARRAYS = ("H", "g", "A", "b")


@dataclass(frozen=True, eq=False)
class Facts:
    """What is known of a problem besides its numbers.

    Parameters
    ----------
    id : str
        ``family/detail/number``.
    family : str
    contacts : int
    mass_ratio : float
        Largest diagonal entry of the mass matrix's translations over the smallest [-].
    h : float
        Time step [s].
    k : int
        Closest points per pair or cloud; 0 where nothing was selected.
    """

    id: str
    family: str
    contacts: int
    mass_ratio: float
    h: float
    k: int

    def record(self) -> dict[str, Any]:
        """Plain numbers for a file."""
        return dict(self.__dict__)


@dataclass(frozen=True, eq=False)
class Answer:
    """The exact answer, correctly rounded, or an enclosure of it.

    Parameters
    ----------
    delta_q : ndarray, shape (n,)
    net : ndarray, shape (n,)
        A'lam [N s, N m s].
    bound : float
        ||delta_q - delta_q*||_H / ||H^-1 g||_H is at most that [-]; 0.0 where only the rounding of
        each entry is between.
    """

    delta_q: Array
    net: Array
    bound: float


@dataclass(frozen=True, eq=False)
class Problem:
    """A quadratic program min 1/2 x'Hx - g'x, A x >= b in SI units, and its answer.

    Parameters
    ----------
    facts : Facts
    form : StandardForm
    answer : Answer
    """

    facts: Facts
    form: StandardForm
    answer: Answer

    @property
    def id(self) -> str:
        """Its name."""
        return self.facts.id


def in_units(form: StandardForm, units: Units) -> StandardForm:
    """The same problem in other units, without loss: they are powers of two."""
    S, ell, rho = units.coordinate, units.length, units.size
    return StandardForm(
        H=form.H * np.outer(S, S),
        g=form.g * S / rho,
        A=form.A * (S / ell),
        b=form.b / (rho * ell),
    )


def units_of(form: StandardForm) -> Units:
    """Natural units of a problem."""
    return natural_units(step_of(form))


def condition(form: StandardForm) -> float:
    """Condition number of H, in the units that it is given in [-]."""
    return float(np.linalg.cond(form.H))

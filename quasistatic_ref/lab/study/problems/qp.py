"""One problem of a study: a quadratic program in float64, and its exact answer.

The problem is the four arrays as they are: a reader of the file has the same
numbers, and the exact answer belongs to these, not to the step that they were rounded from.
"""

from dataclasses import dataclass

import numpy as np

from quasistatic_ref.solve.units import Units, natural_units
from quasistatic_ref.step.data import Array, Contacts, Extra, StepData
from quasistatic_ref.step.standard_form import StandardForm

UNITS = ("raw", "natural")
INFEASIBLE = "infeasible"
"""The kind of answer that is a Farkas vector."""


@dataclass(frozen=True, eq=False)
class Facts:
    """What is known of a problem in addition to its numbers.

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


@dataclass(frozen=True, eq=False)
class Truth:
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
class NoSolution:
    """The answer to a problem that has none.

    Parameters
    ----------
    farkas : ndarray, shape (m,)
        y >= 0 with A'y = 0 and b'y > 0, correctly rounded [-]: 0 = y'A x >= y'b > 0.
    """

    farkas: Array


Answer = Truth | NoSolution


def kind_of(answer: Answer) -> str:
    """What ``problems.jsonl`` calls an answer: exact, an enclosure, or infeasible."""
    if isinstance(answer, NoSolution):
        return INFEASIBLE
    return "enclosure" if answer.bound else "exact"


@dataclass(frozen=True, eq=False)
class Problem:
    """A quadratic program min 1/2 x'Hx - g'x, A x >= b in SI units, and its answer.

    Parameters
    ----------
    facts : Facts
    form : StandardForm
    answer : Truth or NoSolution
    """

    facts: Facts
    form: StandardForm
    answer: Answer

    @property
    def id(self) -> str:
        """Its name."""
        return self.facts.id


def step_of(form: StandardForm) -> StepData:
    """The step whose standard form is a given quadratic program: h = 1, K_q = H, rows as extra."""
    n, m = len(form.g), len(form.b)
    nothing, frames = np.zeros(0), np.zeros((0, 3))
    return StepData(
        h=1.0,
        K_q=form.H,
        M_u=np.zeros((0, 0)),
        tau_a=form.g,
        tau_u=nothing,
        delta_q_bar_a=np.zeros(n),
        contacts=Contacts((), nothing, frames, frames, frames, np.zeros((0, 4, n)), nothing,
                          nothing, np.zeros(0, dtype=np.int64)),
        extra=Extra(tuple(f"row {i}" for i in range(m)), form.A, form.b),
    )  # fmt: skip


def units_of(form: StandardForm) -> Units:
    """Natural units of a problem."""
    return natural_units(step_of(form))


def condition(form: StandardForm) -> float:
    """Condition number of H, in the units that it is given in [-]."""
    return float(np.linalg.cond(form.H))

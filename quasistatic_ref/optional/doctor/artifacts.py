"""How far a run is from physics: its drag, its quasi-dynamic number and its boundary layer."""

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.model.system import System
from quasistatic_ref.optional.doctor.start import free_bases
from quasistatic_ref.step.data import Array, StepData
from quasistatic_ref.tolerances import BEARS


class Drag(NamedTuple):
    """Spurious drag on a free body, and what its contacts can bear by friction.

    Parameters
    ----------
    body : str
    drag : float
        ||M_u delta_q_u / h^2|| of its translation [N].
    bears : float
        Sum of mu_v f_n of its contacts [N]; where they bear nothing by friction, its weight.
    touched, rubs : bool
        Whether its contacts press at all, and whether they bear anything by friction.
    """

    body: str
    drag: float
    bears: float
    touched: bool
    rubs: bool

    @property
    def share(self) -> float | None:
        """The quotient (R13) [-], 1 in free fall; None where float64 has no number for it."""
        return _quotient(self.drag, self.bears)


def drags(system: System, step: StepData, delta_q: Array, wrench: Array, g: float) -> list[Drag]:
    """The drag on each floating base that is not actuated.

    Parameters
    ----------
    system : System
    step : StepData
    delta_q : ndarray, shape (n_v,)
    wrench : ndarray, shape (n_c, 4)
        Of its contacts [N, N m]: those of this delta_q, or of a step with another M_u.
    g : float
        Length of gravity [m/s^2].
    """
    momentum = step.momentum(delta_q)
    found = []
    presses = _carried(step, np.ones(len(wrench)), wrench[:, 2])
    friction = _carried(step, step.contacts.mu_v, wrench[:, 2])
    for body, base in free_bases(system).items():
        x = base.v.start
        drag = _quotient(np.linalg.norm(momentum[x - step.n_a : x - step.n_a + 3]), step.h**2)
        if drag is not None:
            touched = bool(presses[x] > BEARS * drag)
            rubs = bool(friction[x] > BEARS * drag)
            bears = float(friction[x]) if rubs else system.mass(body) * g
            found.append(Drag(body, drag, bears, touched, rubs))
    return found


def largest_share(found: Iterable[Drag]) -> float | None:
    """The largest share of some drags; None where none has any."""
    return max((x.share for x in found if x.share is not None), default=None)


def _quotient(over: Any, under: Any) -> float | None:
    """Quotient of two numbers >= 0; None where it is beyond the range of float64, or 0/0.

    A friction coefficient may be as small as 5e-324: a product with it underflows to 0, a quotient
    by it overflows.
    """
    with np.errstate(all="ignore"):
        found = float(np.divide(over, under))
    return found if np.isfinite(found) else None


def _carried(step: StepData, factor: Array, f_n: Array) -> Array:
    """For each coordinate that translates a base: sum of factor f_n [N] over its body's contacts.

    Shape (n_v,); other entries mean nothing. A coordinate that translates a base moves the points
    of its body's contacts by one metre per metre, and others not at all.
    """
    bears = factor * np.where(f_n > BEARS * f_n.max(initial=0.0), f_n, 0.0)
    contact, coordinate, J = step.contacts.entries()
    moved = np.linalg.norm(J[:, :3], axis=1) > 0.5  # it is 1 or 0, but for rounding
    carried = np.bincount(coordinate[moved], bears[contact[moved]], step.n_v)
    return carried.astype(np.float64)


def quasi_dynamic_number(system: System, step: StepData, delta_q: Array, g: float) -> float | None:
    """Pi = v / (mu_v g h) of one step: the drag m v / h over the friction mu_v m g.

    mu_v m g is the friction of a body that rests by its own weight, not of a body that is held. v
    is the speed of the fastest un-actuated floating base, mu_v the least of the contacts that rub.

    Parameters
    ----------
    system : System
    step : StepData
    delta_q : ndarray, shape (n_v,)
    g : float
        Length of gravity [m/s^2].

    Returns
    -------
    float or None
        None where nothing floats, nothing rubs or nothing weighs, or where float64 has no number
        for it, as with a mu_v of 1e-323.
    """
    bases = [base.v.start for base in free_bases(system).values()]
    rough = step.contacts.mu_v[step.contacts.mu_v > 0]
    if not (bases and rough.size and g > 0):
        return None
    moved = max(float(np.linalg.norm(delta_q[start : start + 3])) for start in bases)
    v = _quotient(moved, step.h)
    return None if v is None else _quotient(v, float(rough.min()) * g * step.h)


def gap_after(phi: Array, solution: StepSolution, n_v: int) -> Array:
    """Gap phi + n'J delta_q [m] of each contact after the step, to first order, shape (n_c,).

    Of delta_q count the first n_v coordinates: private rises are not in the gap. phi, shape (n_c,),
    is the distance [m], which Coulomb's law raises in the step.
    """
    contacts = solution.step.contacts
    delta_q = solution.delta_q.copy()
    delta_q[n_v:] = 0.0
    motion = contacts.motion(delta_q)[:, :3]
    return np.asarray(phi + np.sum(contacts.n * motion, axis=1))


def boundary_layer(gap: Array, solution: StepSolution) -> float:
    """Largest gap [m] that a contact with load has after the step; 0 without load.

    Parameters
    ----------
    gap : ndarray, shape (n_c,)
        Of :func:`gap_after` [m].
    solution : StepSolution
    """
    force = solution.wrench[:, 2]
    loaded = force > BEARS * force.max(initial=0.0)
    return max(0.0, float(gap[loaded].max(initial=0.0)))

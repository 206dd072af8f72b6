"""How far a run is from physics: its drag, its quasi-dynamic number and its boundary layer.

They are measured of several steps of a simulator at once, along the first axis.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.numbers.ordered import dot
from quasistatic_ref.optional.doctor.start import free_bases
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import BEARS

LIGHT = 1e-3
"""Force that is none, over the weight of a scene's bodies or its largest load [-]."""
BORNE = 0.1
"""Normal forces over the weight of a body below which they do not bear it [-]."""


def drag_share(
    system: System,
    steps: Sequence[StepData],
    delta_q: Sequence[Array] | Array,
    wrench: Array,
    g: float,
) -> Array:
    """Spurious drag over what contacts can bear by friction, (R13), of the body with the most.

    The drag on a free body is ||M_u delta_q_u / h^2|| of its translation. Its contacts can bear the
    sum of mu_v f_n; where they bear nothing by friction, or press with less than a tenth of its
    weight, its weight counts.

    Parameters
    ----------
    system : System
    steps : sequence of StepData
        One, whose M_u all of them have; or each.
    delta_q : sequence of ndarray, each of shape (n_v,)
    wrench : ndarray, shape (steps, n_c, 4)
        Of their contacts [N, N m]: those of this delta_q, or of steps with another M_u.
    g : float
        Length of gravity [m/s^2].

    Returns
    -------
    ndarray, shape (steps,)
        [-], 1 in free fall; NaN where float64 has no number for it, or nothing floats freely.
    """
    first = steps[0]
    bases = free_bases(system)
    end = max((base.v.stop for base in bases.values()), default=first.n_a) - first.n_a
    if len(steps) == 1:
        momentum = first.momentum(np.asarray(delta_q))
    else:
        each = zip(steps, delta_q, strict=True)
        momentum = np.array([step.momentum(v)[:end] for step, v in each])  # no private rises
    presses = _loads(wrench)
    rubs = first.contacts.mu_v * presses
    largest = np.full(len(delta_q), np.nan)
    for body, base in bases.items():
        x = base.v.start
        of_body = moved(first.contacts, x)
        drag = _quotient(_lengths(momentum[:, x - first.n_a : x - first.n_a + 3]), first.h**2)
        friction = _sums(rubs[:, of_body])
        weight = system.mass(body) * g
        rubbed = (friction > BEARS * drag) & (_sums(presses[:, of_body]) >= BORNE * weight)
        share = _quotient(drag, np.where(rubbed, friction, weight))
        largest = np.fmax(largest, share)
    return largest


def _quotient(over: ArrayLike, under: ArrayLike) -> Array:
    """Quotients of numbers >= 0; NaN where they are beyond the range of float64, or 0/0.

    A friction coefficient may be as small as 5e-324: a product with it underflows to 0, a quotient
    by it overflows.
    """
    with np.errstate(all="ignore"):
        quotients = np.divide(over, under)
    return np.where(np.isfinite(quotients), quotients, np.nan)


def _lengths(vectors: Array) -> Array:
    """Lengths of vectors, shape (steps, 3), as ``np.linalg.norm`` has that of one."""
    with np.errstate(all="ignore"):
        return np.asarray(np.sqrt(np.vecdot(vectors, vectors)))


def _loads(wrench: Array) -> Array:
    """f_n [N] of the contacts with load, 0 of the others, shape (steps, n_c)."""
    f_n = wrench[:, :, 2]
    return np.where(pressing(f_n), f_n, 0.0)


def pressing(normal: Array) -> Mask:
    """Which contacts bear more than noise of the largest force, shape (..., n_c), as `normal`.

    Parameters
    ----------
    normal : ndarray, shape (..., n_c)
        Normal forces [N].
    """
    return np.asarray(normal > BEARS * normal.max(axis=-1, initial=0.0, keepdims=True))


def moved(contacts: Contacts, x: int) -> Mask:
    """Whether the coordinate x, which translates a base, moves each contact, shape (n_c,).

    It moves the points of its body's contacts by one metre per metre, and others not at all: the
    same in all steps.
    """
    column = contacts.J[:, :3, x]
    return np.asarray(np.linalg.norm(column, axis=1) > 0.5)  # it is 1 or 0, but for rounding


def _sums(loads: Array) -> Array:
    """Sums over contacts, shape (steps,), in their order."""
    return np.add.accumulate(loads, axis=1)[:, -1] if loads.shape[1] else np.zeros(len(loads))


def quasi_dynamic_number(system: System, step: StepData, delta_q: Array, g: float) -> Array:
    """Pi = v / (mu_v g h) of each step: the drag m v / h over the friction mu_v m g.

    mu_v m g is the friction of a body that rests by its own weight, not of a body that is held. v
    is the speed of the fastest un-actuated floating base, mu_v the least of the contacts that rub.

    Parameters
    ----------
    system : System
    step : StepData
        One of them.
    delta_q : ndarray, shape (steps, n_v)
    g : float
        Length of gravity [m/s^2].

    Returns
    -------
    ndarray, shape (steps,)
        NaN where nothing floats, nothing rubs or nothing weighs, or where float64 has no number
        for it, as with a mu_v of 1e-323.
    """
    bases = [base.v.start for base in free_bases(system).values()]
    rough = step.contacts.mu_v[step.contacts.mu_v > 0]
    if not (bases and rough.size and g > 0):
        return np.full(len(delta_q), np.nan)
    moved = np.max([_lengths(delta_q[:, start : start + 3]) for start in bases], axis=0)
    return _quotient(_quotient(moved, step.h), float(rough.min()) * g * step.h)


def gap_after(phi: Array, n: Array, motion: Array) -> Array:
    """Gap phi + n'J delta_q [m] of each contact after its step, to first order, (steps, n_c).

    Parameters
    ----------
    phi, n : ndarray, shapes (steps, n_c) and (steps, n_c, 3)
        The distance [m], which Coulomb's law raises in the step, and the normal.
    motion : ndarray, shape (steps, n_c, 4)
        J delta_q [m, rad]: private rises are not in the gap.
    """
    return phi + dot(n, motion[:, :, :3])


def boundary_layer(gap: Array, wrench: Array) -> Array:
    """Largest gap [m] that a contact with load has after each step, (steps,); 0 without load.

    Parameters
    ----------
    gap : ndarray, shape (steps, n_c)
        Of :func:`gap_after` [m].
    wrench : ndarray, shape (steps, n_c, 4)
        [N, N m].
    """
    return np.asarray(gap.max(axis=1, where=pressing(wrench[:, :, 2]), initial=0.0))

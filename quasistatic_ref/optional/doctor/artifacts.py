"""How far a run is from physics: its quasi-dynamic number and its boundary layer.

They are measured of several steps of a simulator at once, along the first axis.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.numbers.ordered import dot
from quasistatic_ref.optional.doctor.start import free_bases
from quasistatic_ref.optional.doctor.tolerances import BEARS
from quasistatic_ref.step.data import StepData

LIGHT = 1e-3
"""Force that is none, over the weight of a scene's bodies or its largest load [-]."""


def quotient(over: ArrayLike, under: ArrayLike, none: float = 0.0) -> Array:
    """Quotients; `none` where they are beyond the range of float64, or 0/0.

    A friction coefficient may be as small as 5e-324: a product with it underflows to 0, a quotient
    by it overflows.
    """
    with np.errstate(all="ignore"):
        quotients = np.divide(over, under)
    return np.where(np.isfinite(quotients), quotients, none)


def _lengths(vectors: Array) -> Array:
    """Lengths of vectors, shape (steps, 3), as ``np.linalg.norm`` has that of one."""
    with np.errstate(all="ignore"):
        return np.asarray(np.sqrt(np.vecdot(vectors, vectors)))


def pressing(normal: Array) -> Mask:
    """Which contacts bear more than noise of the largest force, shape (..., n_c), as `normal`.

    Parameters
    ----------
    normal : ndarray, shape (..., n_c)
        Normal forces [N].
    """
    return np.asarray(normal > BEARS * normal.max(axis=-1, initial=0.0, keepdims=True))


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
    speed = quotient(moved, step.h, np.nan)
    return quotient(speed, float(rough.min()) * g * step.h, np.nan)


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


def gives(steps: Sequence[StepData]) -> Array:
    """How far springs let contacts give way along their normals, shape (steps, n_c) [m/N].

    Parameters
    ----------
    steps : sequence of StepData
        Of one simulator.
    """
    first = steps[0]
    n_a = first.n_a
    if not n_a:
        return np.zeros((len(steps), first.contacts.n_c))
    n = np.array([step.contacts.n for step in steps])
    J_a = np.array([step.contacts.J[:, :3, :n_a] for step in steps])
    J_n = np.einsum("scx,scxv->scv", n, J_a)
    yields = np.linalg.solve(first.K_q, J_n.reshape(-1, n_a).T).T.reshape(J_n.shape)
    return np.asarray(np.vecdot(J_n, yields))

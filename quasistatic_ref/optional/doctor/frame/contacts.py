"""Which contacts of a run touch and press, and how they slip."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.numbers.ordered import dot
from quasistatic_ref.optional.doctor.frame.tolerances import BEARS, NEAR
from quasistatic_ref.optional.friction import slip_norm
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.contacts import friction_coefficients

if TYPE_CHECKING:
    from quasistatic_ref.simulate.record.trajectory import Trajectory

TOUCHES: Final = 1e-9
"""Slack of a row of a contact that touches, at most [m]: certified steps leave rounding, 1e-16, and
a spring of 1e5 N/m presses 1e-9 m with 0.1 mN."""


def motion_of_contacts(run: Trajectory) -> Array | None:
    """Motions J delta_q of contacts, shape (steps, n_c, 4) [m, m, m, rad], if recorded."""
    if "motion" in run.arrays or "J" not in run.arrays:
        return run.arrays.get("motion")
    delta_q = run["delta_q"]
    return np.asarray(np.einsum("kciv,kv->kci", run["J"][..., : delta_q.shape[1]], delta_q))


def touching(run: Trajectory, motion: Array | None, sliding: Array | None = None) -> Mask:
    """Mask of the contacts that touch, shape (steps, n_c): one of their rows has no slack.

    Then phi + n'J delta_q is the least that their slip allows, which is unique. Of a motion J
    delta_q, shape (steps, n_c, 4) [m, m, m, rad]; without it those that press. `sliding` is the
    rise that the slip asks for, shape (steps, n_c) [m], where it is known.
    """
    touch = _bears(run)
    if motion is None:
        return touch
    if sliding is None:
        sliding = slip_norm(contact_mu(run) * contact_slips(run, motion), run.header.cone)
    rises = run.header.law == CONVEX
    slack = gap_after(run["phi"], run["n"], motion) - rises * sliding
    touch &= slack <= NEAR
    if cone(run.header.cone).polyhedral:
        touch |= slack <= TOUCHES
    return touch


def _bears(run: Trajectory) -> Mask:
    """Which contacts have a positive multiplier, shape (steps, n_c).

    It is positive where it is a share of the largest; of an answer without a proof multipliers are
    noise in a step in which nothing presses, and count next to a small slack only.
    """
    counts = cone(run.header.cone).counts(run["rows"])
    of_rows = np.maximum(run["lam"][:, : counts.sum()], 0.0)
    return pressing(np.maximum.reduceat(of_rows, np.cumsum(counts) - counts, axis=1))


def pressing(normal: Array) -> Mask:
    """Whether each contact's force is more than rounding, shape (..., n_c), as `normal`.

    Parameters
    ----------
    normal : ndarray, shape (..., n_c)
        Normal forces [N].
    """
    return np.asarray(normal > BEARS * normal.max(axis=-1, initial=0.0, keepdims=True))


def contact_slips(run: Trajectory, motion: Array) -> Array:
    """Slips along d1 and d2 [m], and turns of what has torsion [rad], (steps, n_c, 3).

    They are of a motion, J delta_q, shape (steps, n_c, 4) [m, m, m, rad].
    """
    d1, d2 = (np.vecdot(motion[:, :, :3], run[axis]) for axis in ("d1", "d2"))
    return np.stack([d1, d2, np.where(run["rows"] == 6, motion[:, :, 3], 0.0)], axis=2)


def contact_mu(run: Trajectory) -> Array:
    """Coefficients (mu_v, mu_v, mu_omega) of contacts, 0 where unused, (n_c, 3) [-, -, m]."""
    return friction_coefficients(run["mu_v"], run["mu_omega"], run["rows"])


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

"""How far a run is from physics: its quasi-dynamic number and its boundary layer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.numbers.arrays import Array, without_warnings
from quasistatic_ref.numbers.ordered import norm
from quasistatic_ref.optional.doctor.frame.contacts import pressing
from quasistatic_ref.step.contacts import spread, stacked
from quasistatic_ref.step.data import StepData

if TYPE_CHECKING:
    from quasistatic_ref.model.joints.joint import Joint
    from quasistatic_ref.optional.doctor.frame.run import Run

LIGHT = 1e-3
"""Share of a scene's weight or largest load [-] below which a force counts as zero."""


def quotient(over: ArrayLike, under: ArrayLike, none: float = 0.0) -> Array:
    """Quotients, of the shape of both [any unit]; `none` [its unit] where float64 has none.

    A friction coefficient may be as small as 5e-324: a product with it underflows to 0, a quotient
    by it overflows.
    """
    with np.errstate(all="ignore"):
        quotients = np.divide(over, under)
    return np.where(np.isfinite(quotients), quotients, none)


def quasi_dynamic_number(run: Run) -> float | None:
    """The largest Pi of its free bodies: the drag m v / h over the friction sum mu_v N.

    N are the normal forces on a body, whether its weight or a grip presses. Of each body the steps
    count in which its contacts can bear half of the most friction that they can bear in the run.
    None where nothing is free, nothing rubs or nothing presses, or where float64 has no number for
    it, as with a mu_v of 1e-323.
    """
    known: list[float] = []
    for name, base in run.free_bases.items():
        of_body = run.of_body(name)
        friction = run["wrench"][:, of_body, 2] @ run["mu_v"][of_body]
        Pi = quotient(without_warnings(norm, drag(run, base)), friction, np.nan)
        Pi = Pi[friction >= friction.max() / 2]
        known += Pi[np.isfinite(Pi)].tolist()
    return max(known, default=None)


def drag(run: Run, base: Joint) -> Array:
    """The drag M v / h on a free body in each step, shape (steps, 3) [N].

    Along its own axes; 0 where float64 has no number for it, as with an h of 1e-308 s.
    """
    at = base.v.start - run.system.n_a
    momentum = run.noted("momentum")[:, at : at + 3]
    return quotient(quotient(momentum, run.h), run.h)


def boundary_layer(run: Run) -> float:
    """Largest gap [m] that a contact with load has after a step; 0 without load."""
    return float(np.nanmax(run.gap, where=pressing(run["wrench"][:, :, 2]), initial=0.0))


def gives(steps: Sequence[StepData]) -> Array:
    """How much springs let contacts yield along their normals, shape (steps, n_c) [m/N].

    Parameters
    ----------
    steps : sequence of StepData
        Of one simulator.
    """
    first = steps[0]
    n_a = first.n_a
    if not n_a:
        return np.zeros((len(steps), first.contacts.n_c))
    contacts = stacked([step.contacts for step in steps])
    J_a = spread(contacts.own[:, :3], np.minimum(contacts.column, n_a), n_a)
    J_n = np.einsum("cx,cxv->cv", contacts.n, J_a).reshape(len(steps), first.contacts.n_c, n_a)
    yields = np.linalg.solve(first.K_q, J_n.reshape(-1, n_a).T).T.reshape(J_n.shape)
    return np.asarray(np.vecdot(J_n, yields))

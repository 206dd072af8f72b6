"""A run in words: what ``repr`` and a notebook show of a trajectory."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.optional.show.show import Page, Row, counted, number
from quasistatic_ref.optional.show.step_words import CONTACT

if TYPE_CHECKING:
    from collections.abc import Sequence

    from quasistatic_ref.simulate.trajectory import Trajectory
    from quasistatic_ref.step.data import Array

BEARING = 1e-3
"""A contact bears load above this share of the largest normal force [-]."""
FORCE = ("f_d1 [N]", "f_d2 [N]", "f_n [N]", "tau_n [N m]")


def bearing_first(rows: Sequence[Row], f_n: Array) -> list[Row]:
    """Rows of contacts: first those that bear load, then the others, each in their order.

    Parameters
    ----------
    rows : sequence of Row
    f_n : ndarray, shape (n_c,)
        Normal forces [N].
    """
    idle = f_n <= BEARING * f_n.max(initial=0.0)
    return [rows[j] for j in np.argsort(idle, kind="stable")]


def trajectory_page(trajectory: Trajectory) -> Page:
    """A run: how far it went, what of it is proved, and its contacts in the last step."""
    from quasistatic_ref.simulate.trajectory import certified  # which needs pinocchio

    header = trajectory.header
    steps = trajectory.steps
    ended = "complete" if trajectory.failed is None else "ended early"
    title = (
        f"Trajectory: {counted(steps, 'step')} of {header['h']:g} s, {ended}; "
        f"{counted(trajectory['q'].shape[-1], 'entry')} of q, "
        f"{counted(np.size(trajectory['mu_v']), 'contact')}"
    )
    facts = [] if trajectory.failed is None else [f"why it ended: {trajectory.failed}"]
    facts += [
        f"{certified(trajectory)}; backend {header.get('backend')}, cone {header.get('cone')}, "
        f"record {header['record']}",
        f"largest quasi-dynamic number {number(header.get('quasi_dynamic_number'))}, largest "
        f"boundary layer {number(header.get('largest_boundary_layer'))} m",
        f"arrays: {', '.join(trajectory.arrays)}",
    ]
    facts += [f"finding: {finding}" for finding in trajectory.findings]
    n_c = np.size(trajectory["mu_v"])
    shapes = {"phi": (), "wrench": (4,)}
    fits = (trajectory[key].shape == (steps, n_c, *last) for key, last in shapes.items())
    if not (steps and all(fits)):  # no steps, or a file that another program wrote
        return title, facts, (), ()
    names = header["contacts"][-1] if header["contacts"] else ()
    names = names if len(names) == n_c else range(n_c)
    try:
        forces = trajectory.step_forces(steps - 1)
    except InputError:  # of a light record: those of the proof
        forces = trajectory["wrench"][-1]
    rows = [
        (str(name), number(phi), *map(number, of_contact))
        for name, phi, of_contact in zip(names, trajectory["phi"][-1], forces, strict=True)
    ]
    shown = bearing_first(rows, forces[:, 2])
    return title, facts, ("contact, last step", CONTACT[1], *FORCE), shown

"""A run in words: what ``repr`` and a notebook show of a trajectory."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.optional.show.loads import bearing, shown_forces
from quasistatic_ref.optional.show.show import Page, number
from quasistatic_ref.optional.show.step_words import CONTACT
from quasistatic_ref.text.quoting import counted

if TYPE_CHECKING:
    from quasistatic_ref.simulate.record.trajectory import Trajectory

FORCE = ("f_d1 [N]", "f_d2 [N]", "f_n [N]", "tau_n [N m]")


def trajectory_page(trajectory: Trajectory) -> Page:
    """A run in words: its length, its proved steps, and the contacts of its last step.

    Contacts that bear load come first.
    """
    from quasistatic_ref.simulate.record.trajectory import certified  # which needs pinocchio

    header = trajectory.header
    steps = trajectory.steps
    n_c = np.size(trajectory["mu_v"])
    ended = "complete" if trajectory.failed is None else "ended early"
    title = (
        f"Trajectory: {counted(steps, 'step')} of {header.h:g} s, {ended}; "
        f"{counted(trajectory['q'].shape[-1], 'entry')} of q, "
        f"{counted(n_c, 'contact')}"
    )
    facts = [] if trajectory.failed is None else [f"why it ended: {trajectory.failed}"]
    facts += [
        f"{certified(trajectory)}; backend {header.backend}, cone {header.cone}, "
        f"record {header.record}",
        f"largest quasi-dynamic number {number(header.quasi_dynamic_number)}, largest "
        f"boundary layer {number(header.largest_boundary_layer)} m",
        f"arrays: {', '.join(trajectory.arrays)}",
    ]
    facts += [f"finding: {finding}" for finding in trajectory.findings]
    per_contact = steps, n_c
    if not (
        steps  # or a file that another program wrote
        and trajectory["phi"].shape == per_contact
        and trajectory["wrench"].shape == (*per_contact, 4)
    ):
        return title, facts, (), ()
    last = header.contacts[-1] if header.contacts else ()
    names = last if len(last) == n_c else range(n_c)
    forces = shown_forces(trajectory, steps - 1)
    rows = [
        (str(name), number(phi), *map(number, of_contact))
        for name, phi, of_contact in zip(names, trajectory["phi"][-1], forces, strict=True)
    ]
    bears_first = np.argsort(~bearing(forces[:, 2]), kind="stable")
    columns = "contact, last step", CONTACT[1], *FORCE
    return title, facts, columns, [rows[j] for j in bears_first]

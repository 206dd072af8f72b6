"""A scenario and a run in words: what ``repr`` and a notebook show of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from quasistatic_ref.optional.show.loads import bearing, shown_forces
from quasistatic_ref.optional.show.show import Page, number
from quasistatic_ref.optional.show.step_words import CONTACT
from quasistatic_ref.quoting import counted

if TYPE_CHECKING:
    from quasistatic_ref.files.scenario.scenario import Scenario
    from quasistatic_ref.numbers.arrays import Array
    from quasistatic_ref.simulate.record.trajectory import Trajectory

RESOLVED: Final = 1e-12
"""Share of the largest number [-] below which others of its kind are rounding, or a solver's."""


def resolved(x: Array, largest: float | None = None) -> Array:
    """Numbers of one kind, of any shape [any unit], 0 where they are rounding of the largest."""
    scale = np.abs(x).max(initial=0.0) if largest is None else largest
    return np.where(np.abs(x) > RESOLVED * scale, x, 0.0)


PAIR = ("contact pair", "alpha", "beta", "mu_v", "mu_omega [m]", "contacts", "rows of each")


def scenario_page(scenario: Scenario) -> Page:
    """A scenario in words: what moves, how it is solved, and its contact pairs."""
    system = scenario.system
    facts = [
        f"bodies: {', '.join(scenario.bodies)}",
        f"{counted(system.n_v, 'coordinate')} ({system.n_a} actuated)",
        f"backend {scenario.backend}, cone {scenario.cone}, law {scenario.law}, "
        f"certify {scenario.certify}, record {scenario.record}",
    ]
    rows = [
        (
            pair.name, pair.alpha.name, pair.beta.name, number(pair.mu_v), number(pair.mu_omega),
            str(pair.n_c), str(pair.rows),
        )
        for pair in scenario.pairs
    ]  # fmt: skip
    return repr(scenario), facts, PAIR, rows


def trajectory_page(trajectory: Trajectory) -> Page:
    """A run in words: its length, its proved steps, and the contacts of its last step.

    Contacts that bear load come first. A run that does not know the forces of single contacts, as
    a light record, shows none.
    """
    from quasistatic_ref.simulate.record.trajectory import certified  # which needs pinocchio

    header = trajectory.header
    steps = trajectory.steps
    n_c = np.size(trajectory["mu_v"])
    Pi = header.quasi_dynamic_number
    if Pi is not None:
        Pi = float(resolved(np.asarray(Pi), 1.0))
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
        f"largest quasi-dynamic number {number(Pi)}, largest boundary layer "
        f"{number(header.largest_boundary_layer)} m",
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
    names = last if len(last) == n_c else header.slots
    shown = shown_forces(trajectory, steps - 1)
    forces = resolved(shown.wrench)
    gaps = resolved(trajectory["phi"][-1], np.abs(trajectory["alpha"][-1]).max(initial=0.0))
    columns: tuple[str, ...] = ("contact, last step", CONTACT[1])
    numbers = gaps[:, None]
    if shown.known:
        columns += shown.columns
        numbers = np.column_stack([gaps, forces])
    rows = [
        (str(name), *map(number, of_contact))
        for name, of_contact in zip(names, numbers, strict=True)
    ]
    bears_first = np.argsort(~bearing(forces[:, 2]), kind="stable")
    return title, facts, columns, [rows[j] for j in bears_first]

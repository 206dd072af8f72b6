"""Whether the bodies of a scene would stay, if targets and loads stayed as they are.

The groups of a scene are asked one by one (:mod:`~quasistatic_ref.optional.stands.slow`). What is
said of a body is what a clamp on this body alone would bear, all else being as it is. Bodies that
press on each other without slipping have one verdict.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.certify.groups import Group, coupled_groups, group_step
from quasistatic_ref.errors import InputError
from quasistatic_ref.optional.stands.bodies import bodies_of
from quasistatic_ref.optional.stands.slow import STRAIGHT, SlowGroup, as_polygon
from quasistatic_ref.parts import part
from quasistatic_ref.simulate.standing import Standing, Standings

if TYPE_CHECKING:
    from quasistatic_ref.numbers.arrays import Indices, Mask
    from quasistatic_ref.simulate.simulator import Simulator
    from quasistatic_ref.solve.solver import Solver
    from quasistatic_ref.step.data import StepData
    from quasistatic_ref.step.extension import Posed

SLOW = 1.0
"""T [s] that is asked first, or so many h if that is longer:"""
IN_STEPS = 100.0
OWN_TERMS = "the user's own costs or constraints are not asked"


def stands(
    simulator: Simulator,
    q: ArrayLike,
    target: ArrayLike,
    force: ArrayLike | None,
    certify: str,
    soon: bool = False,
    only: Mask | None = None,
) -> Standings:
    """Whether each body would stay at q, if a target and a force stayed as they are.

    Parameters
    ----------
    simulator : Simulator
    q : array_like, shape (n_q,)
    target : array_like, shape (n_q_a,)
    force : array_like, shape (n_v,), or None
        Beside gravity [N, N m].
    certify : str
        ``"full"``: the ends of all iterations are proved; ``"off"``.
    soon : bool
        Whether it is asked what bodies lack at once, and not whether they come to rest.
    only : ndarray of bool, shape (n_c,), optional
        Contacts that may bear; by default all.

    Raises
    ------
    InputError
        If `certify` is none of these.
    """
    if certify not in ("full", "off"):
        raise InputError("must be full or off", field="certify", value=certify)
    q = simulator.system.checked(q)
    here = simulator.system.at(q)
    points = simulator.closest_points(here.kinematics)
    step = simulator.step_data(here, target, force, points)
    whole = True
    if simulator.extension is not None:
        posed: Posed = part("posed")
        step, whole = posed(step, simulator.extension(q))
    bodies, label = bodies_of(simulator, step, here)
    rows = {body: Standing(body.name, None, reason=OWN_TERMS) for body in bodies}
    if whole:
        T = None if soon else max(SLOW, IN_STEPS * simulator.h)
        g = float(np.linalg.norm(simulator.gravity))
        solvers: list[Solver] = []
        for group, slow in _groups(_near(simulator, step, only), label):
            of = [body for body in bodies if body.coordinates[0] in group.coordinates]
            if of:
                answers = SlowGroup(group, slow, of, g, solvers, certify).rows(T)
                rows |= zip(of, answers, strict=True)
    kind = as_polygon(step.cone)
    return Standings(tuple(rows.values()), kind if kind == step.cone else f"{step.cone} ({kind})")


def _near(simulator: Simulator, step: StepData, only: Mask | None) -> StepData:
    """A step with the contacts and stops that are near: within a tenth of what they belong to."""
    reach = STRAIGHT * np.array([pair.size or 1.0 for pair in simulator.pairs])
    near = step.contacts.phi <= np.repeat(reach, [pair.n_c for pair in simulator.pairs])
    contacts = np.flatnonzero(near if only is None else near & only)
    stops = np.flatnonzero(-step.extra.b <= reach.min(initial=STRAIGHT))
    every = np.arange(step.n_v)
    return step.with_fields(
        contacts=step.contacts.some(contacts, every), extra=step.extra.of(stops, every)
    )


def _groups(step: StepData, label: Indices) -> Iterator[tuple[Group, StepData]]:
    """The groups of a step: all coordinates of a body, of one label, are in one."""
    i, j = step.coupled_entries
    of_H = np.append(i, label), np.append(j, np.arange(step.n_v))
    row, column = np.nonzero(step.extra.A)
    of_step = step.contacts.couplings, of_H, step.counts, step.n_v
    for group in coupled_groups(*of_step, (row, column), len(step.extra.names)):
        yield group, group_step(step, group)

"""Whether the bodies of a scene would stay, if targets and loads stayed as they are.

The groups of a scene are asked one by one (:mod:`~quasistatic_ref.optional.stands.slow`). What is
said of a body is what a clamp on this body alone would bear, all else being as it is. Bodies that
press on each other without slipping have one verdict.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.certify.groups import Group, group_step, groups_of
from quasistatic_ref.errors import InputError
from quasistatic_ref.optional.stands.bodies import COUNTS, Body, bodies, coupled_joints
from quasistatic_ref.optional.stands.slow import STRAIGHT, Answer, SlowGroup, as_polygon
from quasistatic_ref.parts import part
from quasistatic_ref.simulate.standing import Standing, Standings

if TYPE_CHECKING:
    from quasistatic_ref.numbers.arrays import Array, Mask
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
    kind = as_polygon(step.cone)
    every = bodies(simulator, coupled_joints(simulator, q))
    if not whole:
        answers = dict.fromkeys(every, Answer(None, reason=OWN_TERMS))
    else:
        answers = _answers(simulator, step, every, certify, soon, only)
    R = here.kinematics.R
    rows = (_row(body, answers[body], R[body.links][0]) for body in every)
    named = kind if kind == step.cone else f"{step.cone} ({kind})"
    return Standings(tuple(rows), named)


def _answers(
    simulator: Simulator,
    step: StepData,
    every: tuple[Body, ...],
    certify: str,
    soon: bool,
    only: Mask | None,
) -> dict[Body, Answer]:
    sizes = np.array([pair.size or 1.0 for pair in simulator.pairs])
    pair_of = np.repeat(np.arange(len(sizes)), [pair.n_c for pair in simulator.pairs])
    is_near = step.contacts.phi <= STRAIGHT * sizes[pair_of]
    near = np.flatnonzero(is_near if only is None else is_near & only)
    coordinates = np.arange(step.n_v)
    lengths = [c.unit == "m" for c in simulator.system.coordinates]
    lengths += [True] * (step.n_v - len(lengths))
    slides = step.extra.A[:, lengths].any(axis=1)
    reach = STRAIGHT * np.where(slides, sizes.min(initial=1.0), 1.0)
    stops = np.flatnonzero(-step.extra.b <= reach)
    step = step.with_fields(
        contacts=step.contacts.some(near, coordinates), extra=step.extra.of(stops, coordinates)
    )
    T = None if soon else max(SLOW, IN_STEPS * simulator.h)
    g = float(np.linalg.norm(simulator.gravity))
    solvers: list[Solver] = []
    answers: dict[Body, Answer] = {}
    for group in _groups(step, every):
        of = [body for body in every if body.coordinates[0] in group.coordinates]
        if of:
            pairs = pair_of[near[group.contacts]]
            slow = SlowGroup(group, group_step(step, group), of, pairs, g, solvers, certify)
            answers |= slow.answers(T)
    return answers


def _groups(step: StepData, every: tuple[Body, ...]) -> tuple[Group, ...]:
    """The groups of a step: all coordinates of a body are in one."""
    contact, of_contact = step.contacts.moved
    row, of_row = np.nonzero(step.extra.A)
    i, j = step.coupled_entries
    n_c = step.contacts.n_c
    n_rows = n_c + len(step.extra.names)
    first = [np.full(len(body.coordinates), body.coordinates[0]) for body in every]
    i = np.concatenate([i, *first]).astype(np.int64)
    j = np.concatenate([j, *(body.coordinates for body in every)]).astype(np.int64)
    coupling = np.concatenate([contact, n_c + row, n_rows + i])
    coordinate = np.concatenate([of_contact, of_row, j])
    return groups_of(coupling, coordinate, (n_rows + step.n_v, step.n_v), step.counts)


def _row(body: Body, answer: Answer, R: Array) -> Standing:
    lack = answer.lacks
    if lack is None:
        return Standing(body.name, answer.stands, held_with=answer.with_it, reason=answer.reason)
    forces = lack.turning < 1 - COUNTS
    turns = lack.turning > COUNTS
    r = lack.r
    if body.free:
        r = R @ (r[:3] if forces else r[3:])
    return Standing(
        body.name,
        False,
        lack.force if forces else 0.0,
        lack.torque if turns else 0.0,
        tuple((r / np.linalg.norm(r)).tolist()),
        answer.with_it,
    )

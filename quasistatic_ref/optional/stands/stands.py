"""Whether the bodies of a scene would stay, if targets and loads stayed as they are.

The groups of a scene are asked one by one (:mod:`~quasistatic_ref.optional.stands.slow`). What is
said of a body is what a clamp on this body alone would bear, all else being as it is. Bodies that
press on each other without slipping have one verdict.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.certify.groups import Group, coupled_groups, group_step
from quasistatic_ref.errors import InputError
from quasistatic_ref.optional.stands.bodies import Body, bodies_of
from quasistatic_ref.optional.stands.slow import FACETS, STRAIGHT, SlowGroup
from quasistatic_ref.parts import part
from quasistatic_ref.simulate.form_step import form_step
from quasistatic_ref.simulate.standing import Standing, Standings
from quasistatic_ref.step.cones import cone

if TYPE_CHECKING:
    from quasistatic_ref.numbers.arrays import Array, Indices, Mask
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
    step = form_step(simulator.plan, here, target, force, points)
    whole = True
    if simulator.extension is not None:
        posed: Posed = part("posed")
        step, whole = posed(step, simulator.extension(q))
    bodies, label = bodies_of(simulator, step, here)
    rows = {body: Standing(body.name, None, reason=OWN_TERMS) for body in bodies}
    if whole:
        T = None if soon else max(SLOW, IN_STEPS * simulator.h)
        solvers: list[Solver] = []
        deep = _deep_contacts(simulator, step, only)
        for group, slow in _groups(_near(simulator, step, only), label):
            of = [body for body in bodies if body.coordinates[0] in group.coordinates]
            if of:
                rows |= zip(of, _answers(group, slow, of, solvers, certify, T), strict=True)
        for body in bodies:
            inside = deep & step.contacts.J[:, :, body.coordinates].any(axis=(1, 2))
            if inside.any():
                depth = 1e3 * float(-step.contacts.phi[inside].min())
                why = (
                    f"begins {depth:.3g} mm inside of what it touches, and is asked on its surface"
                )
                rows[body] = replace(rows[body], reason=why)
    return Standings(tuple(rows.values()), step.cone)


def _answers(
    group: Group,
    slow: StepData,
    of: list[Body],
    solvers: list[Solver],
    certify: str,
    T: float | None,
) -> list[Standing]:
    """The rows of a group's bodies: in a round cone, of which what stands in a polygon inside."""
    by_cone = partial(SlowGroup, group, bodies=of, solvers=solvers, certify=certify)
    if cone(slow.cone).polyhedral:
        return by_cone(part=slow).rows(T)
    inside = by_cone(part=slow.with_fields(cone=FACETS)).rows(T)
    if all(row.stands for row in inside):
        return inside
    in_cone = by_cone(part=slow).rows(T)
    return [one if one.stands else other for one, other in zip(inside, in_cone, strict=True)]


def _near(simulator: Simulator, step: StepData, only: Mask | None) -> StepData:
    """A step with the contacts and stops that are near: within a tenth of what they belong to.

    Gaps are at least 0: what begins inside of something would be pushed out of it, and friction
    would bear a share of that.
    """
    reach = _reach(simulator)
    near = step.contacts.phi <= reach
    contacts = np.flatnonzero(near if only is None else near & only)
    stops = np.flatnonzero(-step.extra.b <= reach.min(initial=STRAIGHT))
    every = np.arange(step.n_v)
    some = step.contacts.some(contacts, every)
    some = some.raised(np.maximum(-some.phi, 0.0))
    return step.with_fields(contacts=some, extra=step.extra.of(stops, every))


def _reach(simulator: Simulator) -> Array:
    """A tenth of the size of what each contact belongs to, shape (n_c,) [m]."""
    sizes = [pair.size or 1.0 for pair in simulator.pairs]
    return STRAIGHT * np.repeat(sizes, [pair.n_c for pair in simulator.pairs])


def _deep_contacts(simulator: Simulator, step: StepData, only: Mask | None) -> Mask:
    """The contacts that may bear and are deeper than they reach, shape (n_c,)."""
    deep = -step.contacts.phi > _reach(simulator)
    return np.asarray(deep if only is None else deep & only)


def _groups(step: StepData, label: Indices) -> Iterator[tuple[Group, StepData]]:
    """The groups of a step: all coordinates of a body, of one label, are in one."""
    i, j = step.coupled_entries
    of_H = np.append(i, label), np.append(j, np.arange(step.n_v))
    row, column = np.nonzero(step.extra.A)
    of_step = step.contacts.couplings, of_H, step.counts, step.n_v
    for group in coupled_groups(*of_step, (row, column), len(step.extra.names)):
        yield group, group_step(step, group)

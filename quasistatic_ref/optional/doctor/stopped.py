r"""What bodies lack if targets and loads stop after a step: the scene is asked whether it stays.

One slow step by Coulomb's law (:mod:`~quasistatic_ref.optional.doctor.slow`) has the contacts that
a straight step may reach. What then neither slips nor moves far is held. Where the loads of a body
are not borne, its motion goes with T^2, while that of what lands is less than some of its sizes.
So what is missing is

.. math:: r = -M_u\,\delta q_u / T^2.

What comes to rest, but not on a straight way, goes a straight way first, and is asked again.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.optional.doctor.scenes import Scene
from quasistatic_ref.optional.doctor.slow import SAME
from quasistatic_ref.optional.doctor.undecided import NO_ANSWER, TOO_MANY, failure

if TYPE_CHECKING:
    from quasistatic_ref.numbers.arrays import Mask
    from quasistatic_ref.optional.doctor.bodies import Body, Missing
    from quasistatic_ref.optional.doctor.run import Run

ROUNDS = 12
"""Straight ways of a scene that comes to rest."""


def missing(
    run: Run,
    k: int,
    bodies: Collection[Body],
    cone: str | None = None,
    contacts: Mask | bool = True,
) -> dict[Body, Missing | str]:
    """What bodies lack if targets and loads stop after step k, or why that is not known.

    Parameters
    ----------
    run : Run
    k : int
    bodies : collection of Body
    cone, contacts
        As of :class:`Scene`.
    """
    lacks: dict[Body, Missing | str] = {}
    first: dict[Body, Missing] = {}
    every = run.bodies_of
    left = np.array([*(body in bodies for body in every), False])
    q = run["q"][k + 1]
    straight = 1.0
    foreseen = None
    for _ in range(ROUNDS):
        try:
            scene = Scene(run, k, q, run.gap[k], None, cone, contacts)
        except QuasistaticError as error:  # no normal, or no float64
            return lacks | dict.fromkeys((every[i] for i in np.flatnonzero(left)), failure(error))
        if foreseen is not None:
            as_foreseen = (np.abs(scene.every.phi - foreseen) <= SAME * run.sizes).all()
            straight = 3 * straight if as_foreseen else 1.0
        way = np.zeros(scene.step.n_v)
        goes_on = np.zeros_like(left)
        for slow in scene.parts:
            of = np.unique(slow.group_of[left[slow.body_of]])
            if not of.size:
                continue
            if slow.large:
                lacks |= dict.fromkeys((every[i] for i in slow.bodies_in(of)), TOO_MANY)
                continue
            rung = slow.slowly(of)
            moves = ~slow.held(rung, of, straight)
            of = of[moves]
            rung = rung.some(moves)
            falls, starts, known = slow.falling(rung, of)
            lost = np.flatnonzero(~known)
            leaves, starts[lost] = slow.leaving(of[lost])
            falls |= np.isin(slow.group_of, of[lost[leaves]]) & (slow.body_of < len(every))
            open_ones = slow.bodies_in(of[lost[~leaves]])
            lacks |= dict.fromkeys((every[i] for i in open_ones), NO_ANSWER)
            for m in np.flatnonzero(falls).tolist():
                lack = slow.missing(m, of, starts, every)
                if lack.amount > slow.least[m]:
                    lacks[every[slow.body_of[m]]] = lack
            far = slow.moves(rung.delta_q, of)
            goes = known & ~np.isin(of, slow.group_of[falls]) & (far > straight)
            to = rung.delta_q[goes] * (straight / far[goes])[:, None]
            of = of[goes]
            way[slow.groups.coordinates[of]] = to
            goes_on[slow.bodies_in(of)] = True
            starts = slow.first(of)
            for m in slow.members_of(of).tolist():
                first.setdefault(every[slow.body_of[m]], slow.missing(m, of, starts, every))
        left &= goes_on
        if not left.any():
            return lacks
        motion = scene.every.motion(way)[:, :3]
        foreseen = scene.every.phi + np.vecdot(scene.every.n, motion)
        q = run.system.integrate(q, way[: run.system.n_v])
    return lacks | {every[i]: first[every[i]] for i in np.flatnonzero(left)}  # it goes on and on

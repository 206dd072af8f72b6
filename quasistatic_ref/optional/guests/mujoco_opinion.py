"""What MuJoCo says of the contacts of a state, and the second opinion on it."""

from __future__ import annotations

import copy
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.contact.distance import in_world
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.contact.solids.solid_pair import solid_pair
from quasistatic_ref.optional.guests import touches
from quasistatic_ref.optional.guests.compared import WINDOW, Mover, MujocoAnswer
from quasistatic_ref.optional.guests.fates import kind_of
from quasistatic_ref.optional.guests.findings import APART, Named
from quasistatic_ref.optional.guests.mujoco import step_with
from quasistatic_ref.optional.guests.mujoco_state import MujocoState, awake, mujoco_state
from quasistatic_ref.optional.guests.opinion import Opinion, opinion_of
from quasistatic_ref.optional.guests.places import KINDS_OF_GEOMS, candidates, geom_kind, placed
from quasistatic_ref.optional.guests.settled import run, velocities
from quasistatic_ref.optional.guests.state_step import Coordinates
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import CREEP, DEEP, PIERCES

if TYPE_CHECKING:
    from mujoco import MjData, MjModel


DRAG = "dampers: their forces at the present velocity are loads"


def second_opinion(
    model: MjModel, data: MjData, tolerance: float = CREEP, start: MjData | None = None
) -> Opinion:
    """What MuJoCo says of the contacts of a state, and what rigid bodies with that friction do.

    Parameters
    ----------
    model : mujoco.MjModel
    data : mujoco.MjData
        Neither is changed. A state that has settled says most.
    tolerance : float
        Speed up to which a contact holds [m/s].
    start : mujoco.MjData, optional
        The state that it has settled from: bodies that begin in each other are found there, since
        MuJoCo throws them apart.

    Returns
    -------
    Opinion
        It prints as tables and sentences.

    Raises
    ------
    InputError
        If `tolerance` is not positive.
    ModelError
        As of ``mujoco_step``, and if MuJoCo's simulation is unstable.
    ContactError
        Naming a pair of bodies in each other without a normal.

    Examples
    --------
    >>> import mujoco
    >>> box = '<body name="box" pos="0 0 .05"><freejoint/><geom type="box" size=".05 .05 .05"/>'
    >>> floor = '<geom name="floor" type="plane" size="1 1 1"/>'
    >>> text = f"<mujoco><worldbody>{floor}{box}</body></worldbody></mujoco>"
    >>> model = mujoco.MjModel.from_xml_string(text)
    >>> opinion = qr.second_opinion(model, mujoco.MjData(model))
    >>> opinion.findings, round(opinion.contacts[0].exact.normal, 4)  # a quarter of 1 kg [N]
    ((), 2.4525)
    """
    state = mujoco_state(model, data)
    state.run()
    active = awake(model)
    now = copy.copy(data)
    state.mujoco.mj_forward(active, now)
    moves = copy.copy(now)
    if data.ntree_awake < model.ntree:  # what has slept moves as before after a while
        run(active, moves, WINDOW)
    mean, later = velocities(active, moves, WINDOW)
    rest = state.data
    drag = now.qfrc_passive + now.qfrc_actuator - rest.qfrc_passive - rest.qfrc_actuator
    theirs = MujocoAnswer(
        contacts=tuple(touches.contacts(state)),
        wrenches=touches.forces(state, now),
        movers=tuple(_mover(state, b) for b in np.flatnonzero(model.body_jntnum).tolist()),
        M=state.M,
        gravity=model.opt.gravity,
        v=now.qvel,
        acceleration=now.qacc,
        mean=mean,
        later=later,
    )

    def step_of(h: float) -> tuple[StepData, Coordinates]:
        """The step of the state under what its dampers bear at its velocity."""
        step, coordinates = step_with(model, data, h, "closed", drag)
        left_out = (*coordinates.left_out, *([DRAG] if drag.any() else []))
        return step, replace(coordinates, left_out=left_out)

    overlaps = [*_unlisted(state)]
    if start is not None:
        first = mujoco_state(model, start)
        first.run()
        overlaps += _misplaced(first)
    return opinion_of(theirs, step_of, model, tolerance, overlaps)


def _mover(state: MujocoState, b: int) -> Mover:
    """A body by its number, with all that is welded to it."""
    model = state.model
    welded = np.flatnonzero(model.body_weldid == b)
    geoms = np.flatnonzero(np.isin(model.geom_bodyid, welded))
    mass = float(model.body_mass[welded].sum())
    centre = (
        model.body_mass[welded] @ state.data.xipos[welded] / mass if mass else state.data.xpos[b]
    )
    linear = np.zeros((3, model.nv))
    angular = np.zeros((3, model.nv))
    state.mujoco.mj_jac(model, state.data, linear, angular, centre, b)
    free = (
        kind_of(state, "jnt_type", model.body_jntadr[b]) == "FREE"
        and len(welded) == np.isin(model.body_rootid, b).sum()
    )
    far = np.linalg.norm(state.data.geom_xpos[geoms] - centre, axis=1)
    size = float((far + model.geom_rbound[geoms]).max(initial=0.0))
    return Mover(state.called("body", b), mass, size, bool(free), linear, angular)


class _Overlap(NamedTuple):
    """Two geoms in each other.

    Parameters
    ----------
    geoms : tuple of int
        By their numbers.
    depth : float
        [m].
    """

    geoms: tuple[int, int]
    depth: float


def _unlisted(state: MujocoState) -> Iterator[Named]:
    """Findings on geoms that are deep in each other, and that MuJoCo lists no contact of."""
    listed = {tuple(sorted(touch.geom.tolist())) for touch in state.data.contact}
    for overlap in _overlaps(state):
        if overlap.geoms not in listed and overlap.depth > DEEP:
            yield _penetrates(state, overlap, "now, without a contact of MuJoCo's")


def _misplaced(state: MujocoState) -> Iterator[Named]:
    """Findings on geoms that start so deep in each other that they cannot be meant to be there."""
    radii = state.model.geom_rbound
    for overlap in _overlaps(state):
        least = min(radii[g] for g in overlap.geoms if radii[g] > 0)
        if overlap.depth > PIERCES * least:
            yield _penetrates(state, overlap, "at the start")


def _penetrates(state: MujocoState, overlap: _Overlap, when: str) -> Named:
    """The finding about two geoms, whatever MuJoCo makes of them."""
    a, b = overlap.geoms
    body, other = touches.mover_name(state, a), touches.mover_name(state, b)
    if body == "world":
        body, other = other, body
    depth = 1e3 * overlap.depth
    geoms = f"{state.called('geom', a)}/{state.called('geom', b)}"
    cause = f"{geoms}: {body} and {other} overlap by {depth:.3g} mm {when}"
    return body, Finding("penetrates", True, APART, cause, {"depth_mm": depth})


def _overlaps(state: MujocoState) -> Iterator[_Overlap]:
    """All pairs of geoms that MuJoCo's filters let touch, and that are in each other."""
    R = state.data.xmat.reshape(-1, 3, 3)
    for touch in candidates(state):
        a, b = sorted(touch.geom.tolist())
        if {geom_kind(state, a), geom_kind(state, b)} <= {*KINDS_OF_GEOMS}:
            sides = (placed(state, a), placed(state, b))
            pair = ContactPair(f"{a}/{b}", *sides, 0.0, 0.0, rows=4, k=1)
            phi = solid_pair(pair.name, *in_world(pair, R, state.data.xpos)).phi
            if phi < 0:
                yield _Overlap((a, b), -phi)

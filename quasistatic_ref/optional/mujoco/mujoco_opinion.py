"""What MuJoCo says of the contacts of a state, and the second opinion on it."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.numbers.arrays import Array, positive_number
from quasistatic_ref.optional.mujoco import touches
from quasistatic_ref.optional.mujoco.compared import WINDOW, Compared, Mover, MujocoAnswer
from quasistatic_ref.optional.mujoco.fates import kind_of
from quasistatic_ref.optional.mujoco.findings import findings, moving, not_unique
from quasistatic_ref.optional.mujoco.mujoco import step_with
from quasistatic_ref.optional.mujoco.mujoco_state import MujocoState, awake, mujoco_state
from quasistatic_ref.optional.mujoco.opinion import MOVES, Opinion
from quasistatic_ref.optional.mujoco.overlaps import misplaced, unlisted
from quasistatic_ref.optional.mujoco.settled import run, velocities, window
from quasistatic_ref.parts import is_there, part
from quasistatic_ref.solve.backends import DAQP
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.solution import StepSolution
from quasistatic_ref.text.module_on_demand import ModuleOnDemand
from quasistatic_ref.tolerances import ACCURACY, CREEP

if TYPE_CHECKING:
    import mujoco
else:
    mujoco = ModuleOnDemand("mujoco")

SHORT = 0.01
"""Time step for forces of what slides, over MuJoCo's [-]: springs give way by 1e-4 as much."""
OWN = 1e-9
"""Difference of s from its own slip's norm, over the longest motion [-], of a fixed point."""
FELL_BACK = "no solution of Coulomb's law was found: forces are those of the convex step"
DRAG = "dampers: their forces at the present velocity are loads"


def mujoco_opinion(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    tolerance: float = CREEP,
    start: mujoco.MjData | None = None,
) -> Opinion:
    """MuJoCo's forces and motions at the contacts of a state, next to those of an exact step.

    Parameters
    ----------
    model : mujoco.MjModel
    data : mujoco.MjData
        Neither is changed. MuJoCo is looked at in the 0.1 s from this state on. A state that has
        settled says most.
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
    >>> opinion = qr.mujoco_opinion(model, mujoco.MjData(model))
    >>> opinion.findings, round(opinion.contacts[0].exact.normal, 4)  # a quarter of 1 kg [N]
    ((), 2.4525)
    """
    tolerance = positive_number(tolerance, "tolerance")
    mujoco_state(model, data).run()  # refuses what is no state
    seen = window(model, data, WINDOW)
    data = seen.data
    g = float(np.linalg.norm(model.opt.gravity))
    near = seen.near(model, g * WINDOW**2 / 8) if seen.hops else model  # as high as a hop may be
    state = mujoco_state(near, data, seen.hops)
    state.run()
    now = copy.copy(data)
    state.mujoco.mj_forward(awake(near), now)
    theirs = _answer(state, data, now, seen.hops)
    rest = state.data
    drag = now.qfrc_passive + now.qfrc_actuator - rest.qfrc_passive - rest.qfrc_actuator
    h = float(model.opt.timestep)
    step, coordinates = step_with(near, data, h, "closed", drag, seen.hops)
    T = coordinates.T
    answer = solve_step(step)
    exact = T @ answer.delta_q / h
    fell_back = False
    both = Compared(theirs, answer, exact / h, exact)
    contacts = tuple(both.contacts())
    if any(c.exact and max(c.exact.slip, c.mu_omega * c.exact.spin) > tolerance for c in contacts):
        sliding = step_with(near, data, h * SHORT, "closed", drag, seen.hops)[0]
        short, fell_back = _sliding(sliding)
        both = Compared(theirs, short, T @ short.delta_q / (h * SHORT) ** 2, exact)
        contacts = tuple(both.contacts())
    bodies = tuple(both.bodies())
    weight = float(model.body_mass.sum()) * g
    every = [*findings(contacts, bodies, weight, tolerance, model), *unlisted(state)]
    if start is not None:
        first = mujoco_state(model, start)
        first.run()
        every += misplaced(first)
    left_out = [*not_unique(contacts, bodies, weight), *coordinates.left_out]
    if drag.any():
        left_out.append(DRAG)
    if fell_back:
        left_out.insert(0, FELL_BACK)
    named = {body for body, one in every if one.name != "penetrates"}
    every += [one for one in moving(theirs.movers, theirs.mean) if one[0] not in named]
    slow = [body.name for body in bodies if body.fastest(body.theirs) > tolerance]
    slow += [m.name for m in theirs.movers if m.free and m.fastest(theirs.mean) > tolerance]
    if {*slow} - {body for body, _ in every}:
        still = f"{MOVES}{', '.join(dict.fromkeys(slow))}; a state at rest says more"
        left_out.insert(0, still)
    return Opinion(
        h, tolerance, answer.certificate.kind, contacts, bodies, tuple(one for _, one in every),
        tuple(left_out),
    )  # fmt: skip


def _sliding(step: StepData) -> tuple[StepSolution, bool]:
    """A step in which something slides: by Coulomb's law, where nothing lifts off as it slides.

    Its end is proved, not the way to it. Where that has no answer, the convex step, from which
    things lift off by a part of their way; and whether that is so.
    """
    of: Callable[..., Any] = part("coulomb_from")
    polyhedral = cone(step.cone).polyhedral
    solver = solver_for(step, DAQP if polyhedral and is_there("daqp_solver") else None)
    start = np.zeros(step.contacts.n_c)
    with suppress(QuasistaticError):
        way = of(step, start, solver, ACCURACY, "off", OWN)
        end = of(step, way.s if way.converged else start, solver, ACCURACY, "full", OWN)
        if end.converged:
            return end, False
    return solve_step(step), True


def _answer(
    state: MujocoState,
    data: mujoco.MjData,
    now: mujoco.MjData,
    hops: Mapping[tuple[int, int], Array],
) -> MujocoAnswer:
    """MuJoCo's forces in a state: at rest, as the user has it, and `now`, by ``mj_forward``.

    Of what hops they are means, as of :class:`Window`.
    """
    model = state.model
    active = awake(model)
    moves = copy.copy(now)
    if data.ntree_awake < model.ntree:  # what has slept moves as before after a while
        run(active, moves, WINDOW)
    mean, later = velocities(active, moves, WINDOW)
    return MujocoAnswer(
        contacts=tuple(touches.contacts(state)),
        wrenches=touches.forces(state, now, hops),
        movers=tuple(_mover(state, b) for b in np.flatnonzero(model.body_jntnum).tolist()),
        M=state.M,
        gravity=model.opt.gravity,
        v=now.qvel,
        acceleration=now.qacc,
        mean=mean,
        later=later,
    )


def _mover(state: MujocoState, b: int) -> Mover:
    """The body of a number, with all bodies welded to it."""
    model = state.model
    welded = np.flatnonzero(model.body_weldid == b)
    geoms = np.flatnonzero(np.isin(model.geom_bodyid, welded))
    mass = float(model.body_mass[welded].sum())
    centre = (
        model.body_mass[welded] @ state.data.xipos[welded] / mass if mass else state.data.xpos[b]
    )
    linear, angular = state.jacobian(centre, b)
    free = (
        kind_of(state, "jnt_type", model.body_jntadr[b]) == "FREE"
        and len(welded) == np.isin(model.body_rootid, b).sum()
    )
    far = np.linalg.norm(state.data.geom_xpos[geoms] - centre, axis=1)
    size = float((far + model.geom_rbound[geoms]).max(initial=0.0))
    return Mover(state.called("body", b), mass, size, bool(free), linear, angular)

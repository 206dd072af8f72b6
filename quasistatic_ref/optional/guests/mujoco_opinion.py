"""What MuJoCo says of the contacts of a state, and the second opinion on it."""

from __future__ import annotations

import copy
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.optional.guests import touches
from quasistatic_ref.optional.guests.compared import WINDOW, Mover, Said, Touch
from quasistatic_ref.optional.guests.fates import kind_of
from quasistatic_ref.optional.guests.findings import Words
from quasistatic_ref.optional.guests.mujoco import mujoco_step
from quasistatic_ref.optional.guests.opinion import Opinion, opinion_of
from quasistatic_ref.optional.guests.settled import velocities
from quasistatic_ref.optional.guests.still import Still, still
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import CREEP

if TYPE_CHECKING:
    from mujoco import MjContact, MjData, MjModel


def second_opinion(model: MjModel, data: MjData, tolerance: float = CREEP) -> Opinion:
    """What MuJoCo says of the contacts of a state, and what rigid bodies with that friction do.

    Parameters
    ----------
    model : mujoco.MjModel
    data : mujoco.MjData
        Neither is changed. A state that has settled says most.
    tolerance : float
        Speed up to which a contact holds [m/s].

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
    state = still(model, data)
    state.run()
    now = copy.copy(data)
    state.mujoco.mj_forward(model, now)
    mean, later = velocities(model, now, WINDOW)
    said = Said(
        touches=tuple(_touch(state, now, name, touch) for name, touch in touches.found(state)),
        movers=tuple(_mover(state, b) for b in np.unique(model.body_weldid).tolist() if b),
        M=state.M,
        gravity=model.opt.gravity,
        v=now.qvel,
        acceleration=now.qacc,
        mean=mean,
        later=later,
    )

    def reasons(step: StepData) -> dict[str, str]:
        """What keeps deep contacts where they are."""
        return {name: reason for name, _, reason in touches.deep(state, step)}

    step_of = partial(mujoco_step, model, data)
    weight = float(model.body_mass.sum() * np.linalg.norm(model.opt.gravity))
    return opinion_of(
        said, step_of, float(model.opt.timestep), tolerance, _words(model), weight, reasons
    )


def _words(model: MjModel) -> Words:
    return Words(
        engine="MuJoCo",
        yields="MuJoCo documents that its friction yields to any force",
        slower=f'option: cone="elliptic" with impratio above {model.opt.impratio:g}, '
        "or noslip_iterations",
        stronger="geom: friction, or what presses the bodies together",
        spins="geom: condim 4 and the second number of friction",
        rests="what MuJoCo has and a step has not: rolling friction, the damping of joints",
        apart="geom or body: size and pos, or contact/exclude for bodies that may overlap",
    )


def _touch(state: Still, data: MjData, name: str, touch: MjContact) -> Touch:
    """A contact of MuJoCo's, with the force that it has in the state itself."""
    return Touch(
        name=name,
        bodies=(_body(state, touch.geom[0]), _body(state, touch.geom[1])),
        depth=-touches.gap(touch),
        mu_v=float(touch.friction[0]) if touch.dim > 1 else 0.0,
        mu_omega=float(touch.friction[2]) if touch.dim > 3 else 0.0,
        of_step=(name,),
        J=touches.jacobian(state, touch)[None],
        tangents=touch.frame[3:].reshape(1, 2, 3),
        wrench=touches.forces(state, data)[touches.number(name)],
    )


def _body(state: Still, geom: int) -> str:
    """The name of the body that a geom moves with."""
    number = state.model.body_weldid[state.model.geom_bodyid[geom]]
    return state.called("body", number) if number else "world"


def _mover(state: Still, b: int) -> Mover:
    """A body by its number, with all that is welded to it."""
    model = state.model
    own = np.flatnonzero(model.body_weldid == b)
    geoms = np.flatnonzero(np.isin(model.geom_bodyid, own))
    mass = float(model.body_mass[own].sum())
    centre = model.body_mass[own] @ state.data.xipos[own] / mass if mass else state.data.xpos[b]
    linear = np.zeros((3, model.nv))
    angular = np.zeros((3, model.nv))
    state.mujoco.mj_jac(model, state.data, linear, angular, centre, b)
    free = (
        kind_of(state, "jnt_type", model.body_jntadr[b]) == "FREE"
        and len(own) == np.isin(model.body_rootid, b).sum()
    )
    far = np.linalg.norm(state.data.geom_xpos[geoms] - centre, axis=1)
    size = float((far + model.geom_rbound[geoms]).max(initial=0.0))
    return Mover(state.called("body", b), mass, size, bool(free), linear, angular)

"""The shapes that were loaded of an MJCF model, compared with MuJoCo's geoms."""

from __future__ import annotations

from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np
import pinocchio as pin

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.body import Body
from quasistatic_ref.model.joints.axis_joint import AxisJoint
from quasistatic_ref.model.kinematics import Kinematics
from quasistatic_ref.model.system import System
from quasistatic_ref.optional.mjcf.geoms import FREE, geom_support, touching
from quasistatic_ref.optional.mjcf.names import Names
from quasistatic_ref.shapes.placed_shape import PlacedShape
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.tolerances import LOADED

if TYPE_CHECKING:
    from mujoco import MjData, MjModel

DIRECTIONS = 128
"""Directions in which shapes are compared."""


def check_shapes(text: str, base: str, model: MjModel, names: Names) -> None:
    """Compare each shape with MuJoCo's geom: where it is, and how far it reaches.

    Both at the file's pose and at one without symmetries.

    Parameters
    ----------
    text : str
        The URDF.
    base : str
        As the body's.
    model : mujoco.MjModel
    names : Names
        What the URDF calls its bodies and joints.

    Raises
    ------
    ModelError
        Naming the geom that differs, or what a URDF cannot say.
    """
    mujoco: ModuleType = import_module("mujoco")
    data = mujoco.MjData(model)
    try:
        system = System([Body("mjcf", text, base, "all")])
    except ModelError as error:
        error.file = None  # it is about the file of which the text was made
        raise
    numbers = [
        system.links.index(f"mjcf/{names.bodies[i]}") for i in model.geom_bodyid[touching(model)]
    ]
    # Shapes come link by link, those of a link as its geoms do.
    geoms = np.flatnonzero(touching(model))[np.argsort(numbers, kind="stable")]
    directions = spread_directions(DIRECTIONS)
    for step in (0.0, 0.1):
        delta_q: Array = step * np.arange(3.0, 3.0 + system.n_v)
        kinematics = system.kinematics(system.integrate(system.q_start, delta_q))
        data.qpos[:] = _qpos(system, model, names, delta_q, kinematics)
        mujoco.mj_kinematics(model, data)
        for placed, g in zip(system.shapes, geoms.tolist(), strict=True):
            off = _difference(placed, kinematics, model, data, g, directions)
            if off > LOADED:
                problem = f"is another shape, or elsewhere, than MuJoCo has it (by {off:.1g})"
                raise ModelError(problem, field=f"geom[{names.geoms[g]}]")


def _difference(
    placed: PlacedShape,
    kinematics: Kinematics,
    model: MjModel,
    data: MjData,
    g: int,
    directions: Array,
) -> float:
    """Largest difference of a shape from a geom, relative to 1 m or to where and how large it is.

    Of the places of their frames, of their axes, and of how far they reach along `directions` of
    these frames, shape (N, 3) [-].
    """
    R = kinematics.R[placed.link] @ placed.R
    t = kinematics.R[placed.link] @ placed.t + kinematics.t[placed.link]
    reach = placed.shape.support_value(directions)
    off = max(
        np.abs(t - data.geom_xpos[g]).max() / (1 + np.abs(t).max()),
        np.abs(R - data.geom_xmat[g].reshape(3, 3)).max(),
        np.abs(reach - geom_support(model, g, directions)).max() / (1 + np.abs(reach).max()),
    )
    return float(off)


def _qpos(
    system: System, model: MjModel, names: Names, delta_q: Array, kinematics: Kinematics
) -> Array:
    """MuJoCo's position where the system is, delta_q from its start."""
    qpos = np.array(model.qpos0)
    if model.njnt and model.jnt_type[0] == FREE:
        root = system.link("mjcf")
        x, y, z, w = pin.Quaternion(kinematics.R[root]).coeffs()
        qpos[:7] = [*kinematics.t[root], w, x, y, z]
    for joint in system.joints:
        own = joint.name.partition("/")[2]
        if own not in names.joints:  # the base
            continue
        at = model.jnt_qposadr[names.joints.index(own)]
        if isinstance(joint, AxisJoint):
            qpos[at] += delta_q[joint.v][0]
        else:
            x, y, z, w = joint.moved([0.0, 0.0, 0.0, 1.0], delta_q[joint.v].tolist())
            qpos[at : at + 4] = [w, x, y, z]
    return qpos


def spread_directions(count: int) -> Array:
    """Directions spread evenly over the sphere, on a spiral, shape (count, 3) [-]."""
    z = 1 - (2 * np.arange(count) + 1) / count
    angle = np.pi * (3 - np.sqrt(5)) * np.arange(count)
    r = np.sqrt(1 - z**2)
    return np.column_stack([r * np.cos(angle), r * np.sin(angle), z])

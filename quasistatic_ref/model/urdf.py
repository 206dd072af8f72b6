"""A URDF loaded through pinocchio, and compared with what its file says.

urdfdom reports trouble to standard error and carries on without the collision shape, the
inertia or the joint that it could not read. So every link's pose, every mass and every shape
is worked out twice, from the file alone and from what was loaded; a difference is an error.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.shapes import PlacedShape
from quasistatic_ref.model.urdf_file import FileLink, UrdfFile, urdf_file
from quasistatic_ref.model.urdf_tree import link_poses, rigid_groups
from quasistatic_ref.tolerances import LOADED

Array = NDArray[np.float64]
BASE = "base"
"""Name of the joint of a floating base."""


@dataclass(frozen=True, eq=False)
class Urdf:
    """A URDF that was loaded as written.

    Parameters
    ----------
    file : UrdfFile
        What it says.
    floating : bool
        Whether its root link floats (joint ``base``) or is fixed.
    model : pinocchio.Model
        Its kinematics and inertias.
    links : tuple of str
        Its links, the root first, parents before children.
    shapes : tuple of PlacedShape
        Its collision shapes; `link` counts in `links`, names are ``left_finger#0``.
    """

    file: UrdfFile
    floating: bool
    model: Any
    links: tuple[str, ...]
    shapes: tuple[PlacedShape, ...]


def loaded_urdf(
    path: str | Path, *, floating: bool = False, package_dirs: Sequence[str | Path] = ()
) -> Urdf:
    """One URDF, loaded and compared with its file.

    Parameters
    ----------
    path : str or Path
    floating : bool
        Put a six-dimensional joint named ``base`` under the root link.
    package_dirs : sequence of str or Path
        Where ``package://`` addresses are looked for.

    Raises
    ------
    ModelError
        If the file is not usable, or anything in it was not loaded as written.
    """
    file = urdf_file(path)
    try:
        _check_moving_masses(file, floating)
        model, geometry = _loaded(file, floating, package_dirs)
        _check_names(file, model, floating)
        _check_poses(file, model)
        _check_inertias(file, model)
        links = (file.root, *(joint.child for joint in file.joints))
        shapes = _checked_shapes(file, model, geometry, links)
    except ModelError as error:
        raise error.in_file(file.path) from None
    return Urdf(file, floating, model, links, shapes)


def body_frame(model: Any, link: str) -> int:
    """Number of a link's frame; a joint's frame may have the same name."""
    return int(model.getFrameId(link, pin.FrameType.BODY))


def _check_moving_masses(file: UrdfFile, floating: bool) -> None:
    if floating and any(joint.name == BASE for joint in file.joints):
        problem = "this name is taken by the floating base; rename the joint"
        raise ModelError(problem, field=f"joint[{BASE}]")
    group = rigid_groups(file.root, file.joints)
    mover = {joint.child: f"joint {joint.name!r}" for joint in file.joints}
    for first in dict.fromkeys(group.values()):
        moves = mover.get(first, "the floating base" if floating else None)
        if moves and not any(file.links[link].mass for link in group if group[link] == first):
            problem = f"is missing, but {moves} moves this link: every moving link needs a mass"
            raise ModelError(problem, field=f"link[{first}].inertial")


def _loaded(file: UrdfFile, floating: bool, package_dirs: Sequence[str | Path]) -> tuple[Any, Any]:
    # From the text, not the path: what is loaded is what was read and checked.
    root = (pin.JointModelFreeFlyer(), BASE) if floating else ()
    try:
        model = pin.buildModelFromXML(file.text, *root, mimic=True)
        geometry = pin.buildGeomFromUrdfString(
            model,
            file.text,
            pin.GeometryType.COLLISION,
            package_dirs=[str(folder) for folder in package_dirs],
        )
    except (ValueError, RuntimeError) as error:
        reason = " ".join(str(error).split())
        if "not in the kinematic tree" in reason:
            reason = (
                "a mimic joint is met before the joint that it mimics; joints of one link are "
                "visited in alphabetical order, so rename one of the two"
            )
        elif "valid URDF" in reason:
            reason = "its URDF parser refuses it, for the reason printed on standard error"
        raise ModelError(f"pinocchio cannot load it: {reason}") from None
    return model, geometry


def _check_names(file: UrdfFile, model: Any, floating: bool) -> None:
    frames = [frame.name for frame in model.frames if frame.type == pin.FrameType.BODY]
    said = {
        "links": (sorted(file.links), sorted(frames)),
        "joints": (
            sorted([j.name for j in file.joints if j.kind != "fixed"] + [BASE] * floating),
            sorted(list(model.names)[1:]),
        ),
    }
    for what, (written, loaded) in said.items():
        if written != loaded:
            raise ModelError(f"differ from those loaded, {loaded}", field=what, value=written)


def _check_poses(file: UrdfFile, model: Any) -> None:
    """Compare every link's pose at position zero and at one without symmetries."""
    moving = [joint for joint in file.joints if joint.kind != "fixed" and joint.mimic is None]
    data = model.createData()
    for step in (0.0, 0.1):
        positions = {joint.name: step * (k + 3) for k, joint in enumerate(moving)}
        delta_q = np.zeros(model.nv)
        for name, position in positions.items():
            delta_q[model.joints[model.getJointId(name)].idx_v] = position
        q = pin.integrate(model, pin.neutral(model), delta_q)
        pin.framesForwardKinematics(model, data, q)
        poses = link_poses(file.root, file.joints, positions)
        for link, (R, t) in poses.items():
            placement = data.oMf[body_frame(model, link)]
            off = np.abs(placement.translation - t).max() > LOADED * (1 + np.abs(t).max())
            if off or np.abs(placement.rotation - R).max() > LOADED:
                problem = "its joint's origin, axis or mimic was not loaded as written"
                raise ModelError(problem, field=f"link[{link}]")


def _check_inertias(file: UrdfFile, model: Any) -> None:
    """Compare the spatial inertia of each rigid group, about the frame of its first link."""
    group = rigid_groups(file.root, file.joints)
    zero = {joint.name: 0.0 for joint in file.joints}
    poses = {
        name: pin.SE3(*pose) for name, pose in link_poses(file.root, file.joints, zero).items()
    }
    for first in dict.fromkeys(group.values()):
        written = np.zeros((6, 6))
        for link, other in group.items():
            if other == first:
                inertia = _spatial_inertia(file.links[link])
                written += poses[first].actInv(poses[link]).act(inertia).matrix()
        joint = model.frames[body_frame(model, first)].parentJoint
        loaded = model.inertias[joint].matrix()
        if np.abs(written - loaded).max() > LOADED * np.abs(written).max():
            problem = f"mass, centre or inertia was not loaded as written ({loaded[0, 0]:g} kg)"
            raise ModelError(problem, field=f"link[{first}].inertial", value=float(written[0, 0]))


def _spatial_inertia(link: FileLink) -> Any:
    return pin.Inertia(link.mass, link.com, link.inertia)


def _checked_shapes(
    file: UrdfFile, model: Any, geometry: Any, links: tuple[str, ...]
) -> tuple[PlacedShape, ...]:
    """Every collision shape in the frame of its link, as loaded."""
    shapes = []
    for number, link in enumerate(links):
        said, frame = file.links[link].collisions, body_frame(model, link)
        loaded = [shape for shape in geometry.geometryObjects if shape.parentFrame == frame]
        where = f"link[{link}].collision"
        if len(loaded) != len(said):
            capsules = any(shape.coal.__class__.__name__ == "Capsule" for shape, _, _ in said)
            hint = '; <capsule> needs <robot version="1.1"> or 1.2' if capsules else ""
            problem = (
                f"only {len(loaded)} of the shapes written were loaded, "
                f"for the reason printed on standard error{hint}"
            )
            raise ModelError(problem, field=where, value=len(said))
        for count, ((shape, R, t), given) in enumerate(zip(said, loaded, strict=True)):
            placement = model.frames[frame].placement.actInv(given.placement)
            off = np.abs(placement.translation - t).max() > LOADED * (1 + np.abs(t).max())
            off |= np.abs(placement.rotation - R).max() > LOADED
            if off or given.geometry != shape.coal or not (given.meshScale == 1).all():
                problem = "was not loaded as written"
                raise ModelError(problem, field=f"{where}[{count}]", value=shape)
            name = f"{link}#{count}"
            at = (placement.rotation, placement.translation)
            shapes.append(PlacedShape(name, number, *at, shape))
    return tuple(shapes)

"""A pinocchio Model with its GeometryModel as a tree.

Links are the Model's BODY frames. In pinocchio a joint moves one rigid body, to which fixed joints
have welded others: the first BODY frame at the joint's origin gets the inertia of all of them, the
others have no mass and are welded to it. Where no BODY frame is at the origin of a joint, a link of
the joint's name is. Shapes belong to the BODY frame that is their ``parentFrame``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from hashlib import sha256
from pathlib import Path
from typing import Any, Final

import coal
import numpy as np
import pinocchio as pin

from quasistatic_ref.errors import ModelError, about_field, check_kind
from quasistatic_ref.files.mesh_files import hull_words
from quasistatic_ref.files.trees import checked_tree, is_own_name
from quasistatic_ref.model.body import FIXED
from quasistatic_ref.model.inertia import inertia_defect
from quasistatic_ref.model.tree import (
    MOST_COORDINATES,
    Defect,
    LinkShape,
    Mimic,
    Tree,
    TreeJoint,
    TreeLink,
)
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.convex_mesh import convex_hull, hull_of_mesh
from quasistatic_ref.shapes.placed_shape import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Shape,
    Sphere,
)
from quasistatic_ref.text.plain import bits
from quasistatic_ref.tolerances import ORTHONORMAL

MODEL: Final = Path("<pinocchio Model>")
"""In the place of a file's path."""

BASES: Final = {
    "JointModelFreeFlyer": "floating",
    "JointModelPlanar": "planar",
    "JointModelSpherical": "ball",
}
"""Kinds of bases, by the class of the root joint."""

KINDS: Final = {
    **{f"JointModelR{axis}": "revolute" for axis in "XYZ"},
    **{f"JointModelP{axis}": "prismatic" for axis in "XYZ"},
    **{f"JointModelRUB{axis}": "continuous" for axis in "XYZ"},
    "JointModelRevoluteUnaligned": "revolute",
    "JointModelPrismaticUnaligned": "prismatic",
    "JointModelRevoluteUnboundedUnaligned": "continuous",
    "JointModelSpherical": "ball",
}
"""Kinds of joints, by their class."""

MIMIC: Final = "JointModelMimic"

SHAPES: Final[dict[type, Callable[[Any], Shape]]] = {
    coal.Box: lambda box: Box(box.halfSide),
    coal.Sphere: lambda ball: Sphere(ball.radius),
    coal.Capsule: lambda rod: Capsule(rod.radius, rod.halfLength),
    coal.Cylinder: lambda can: Cylinder(can.radius, can.halfLength),
    coal.Cone: lambda cone: Cone(cone.radius, cone.halfLength),
    coal.Ellipsoid: lambda ellipsoid: Ellipsoid(ellipsoid.radii),
}
"""Shapes by their class in coal; meshes are taken for their hulls."""

NO_URDF: Final = (
    'is made of a pinocchio Model and has no URDF: its visual meshes are not drawn, and "urdf" '
    "is refused as its joint_friction and joint_limits"
)

UNUSED: Final = ("armature", "rotorInertia", "damping", "friction")
"""Fields of a Model that this model has no place for."""


def described_model(model: pin.Model, geometry: pin.GeometryModel | None) -> tuple[Tree, str]:
    """The tree of a Model, and the kind of its base.

    Parameters
    ----------
    model : pinocchio.Model
    geometry : pinocchio.GeometryModel or None
        Its collision shapes.

    Raises
    ------
    InputError
        If these are something else.
    ModelError
        If the Model has a joint or a shape that this model does not know, or a number in it is not
        finite.
    """
    wanted = "a pinocchio.Model, as pin.buildModelFromUrdf makes it"
    if isinstance(model, pin.RobotWrapper):
        wanted = "a pinocchio.Model: robot.model, and robot.collision_model as geometry"
    check_kind(model, pin.Model, "model", wanted)
    wanted = "a pinocchio.GeometryModel, as pin.buildGeomFromUrdf makes it"
    check_kind(geometry, pin.GeometryModel | None, "geometry", wanted)
    if model.nv > MOST_COORDINATES:
        problem = f"has more than {MOST_COORDINATES} coordinates; fix some of its joints"
        raise ModelError(problem, field="model.nv", value=model.nv)
    root, base = _root(model)
    carriers, welded = _links_of_joints(model, root)
    notes: list[str] = []
    joints: list[TreeJoint] = []
    inertias: dict[str, pin.Inertia] = {}
    for joint, link in carriers.items():
        inertias[link] = model.inertias[joint]
        if joint != root:
            joints.append(_joint(model, joint, carriers))
        for name, placement in welded[joint].items():
            inertias[name] = pin.Inertia.Zero()
            joints.append(_weld(link, name, placement))
    shapes = _shapes(model, carriers, list(inertias), geometry, notes)
    links = {name: _link(name, inertia, shapes[name]) for name, inertia in inertias.items()}
    checked_tree(links, joints)
    content = sha256(repr(bits((tuple(links.values()), tuple(joints)))).encode()).hexdigest()
    text = f"pinocchio Model {model.name!r}, sha256 {content}"
    notes.insert(0, NO_URDF)
    ignored = tuple(f"model.{field}" for field in UNUSED if np.any(getattr(model, field)))
    one_mass = [(carriers[joint], *names) for joint, names in welded.items() if names]
    every = tuple(name for names in one_mass for name in names)
    return Tree(MODEL, text, links, tuple(joints), ignored, tuple(notes), every), base


def _root(model: pin.Model) -> tuple[int, str]:
    """The joint whose link is the root, 0 where the world carries it, and the kind of the base."""
    if model.njoints == 1:
        return 0, FIXED
    kind = BASES.get(model.joints[1].shortname())
    moves_all = all(model.parents[joint] for joint in range(2, model.njoints))
    on_world = any(frame.parentJoint == 0 for frame in model.frames if _is_link(frame))
    if kind is None or not moves_all or on_world or not _is_identity(model.jointPlacements[1]):
        return 0, FIXED
    return 1, kind


def _is_link(frame: pin.Frame) -> bool:
    return bool(frame.type == pin.FrameType.BODY)


def _is_identity(placement: pin.SE3) -> bool:
    return bool((placement.homogeneous == np.eye(4)).all())


def _links_of_joints(
    model: pin.Model, root: int
) -> tuple[dict[int, str], dict[int, dict[str, pin.SE3]]]:
    """The link at each joint's origin, and the poses of the links welded to that link."""
    carriers = {}
    welded = {}
    for joint in range(root, model.njoints):
        frames = [f for f in model.frames if _is_link(f) and f.parentJoint == joint]
        at_origin = next((f.name for f in frames if _is_identity(f.placement)), None)
        carriers[joint] = at_origin or model.names[joint]
        welded[joint] = {f.name: f.placement for f in frames if f.name != at_origin}
    names = [*carriers.values(), *(name for frames in welded.values() for name in frames)]
    for name in names:
        if names.count(name) > 1:
            problem = (
                "is the name of two links, or of a joint without a BODY frame, too; rename one"
            )
            raise ModelError(problem, field=f"frame[{name}]")
    return carriers, welded


def _link(name: str, inertia: pin.Inertia, shapes: Sequence[LinkShape]) -> TreeLink:
    """A link with its own inertia and the shapes that are its."""
    where = f"link[{name}].inertia"
    _check_finite(where, inertia.mass, inertia.lever, inertia.inertia)
    if inertia.mass < 0:
        raise ModelError("must not have a negative mass", field=where, value=inertia.mass)
    defect: Defect | None = None
    if inertia.mass:
        defect = inertia_defect(inertia.inertia)
    elif inertia.inertia.any():
        defect = ("mass", "must be greater than 0", inertia.mass)
    return TreeLink(
        name=name,
        mass=inertia.mass,
        com=np.array(inertia.lever),
        inertia=np.array(inertia.inertia),
        shapes=tuple(shapes),
        defect=defect,
    )


def _joint(model: pin.Model, joint: int, carriers: dict[int, str]) -> TreeJoint:
    """A joint that moves."""
    name = model.names[joint]
    where = f"joint[{name}]"
    kind, axis, mimic = _motion(model, joint, where)
    R, t = _pose(f"{where}.placement", model.jointPlacements[joint])
    limits = None
    effort = np.inf
    if kind != "ball":
        i = model.idx_qs[joint]
        bounds = float(model.lowerPositionLimit[i]), float(model.upperPositionLimit[i])
        # Pinocchio has 0 and 0 where a URDF gives no bounds.
        unbounded = bounds == (0.0, 0.0) or not np.isfinite(bounds).any()
        limits = None if unbounded or bounds[0] > bounds[1] else bounds
        effort = float(model.upperEffortLimit[model.idx_vs[joint]]) or np.inf
    parent = carriers[model.parents[joint]]
    return TreeJoint(name, kind, parent, carriers[joint], R, t, axis, mimic, limits, effort)


def _motion(model: pin.Model, joint: int, where: str) -> tuple[str, Array, Mimic | None]:
    """Kind of a joint, its axis (3,) [-], and what it mimics."""
    here = model.joints[joint]
    name = here.shortname()
    kind = KINDS.get(name, "")
    if not kind and name != MIMIC:
        problem = (
            f"is a {name}; known are joints of one axis, spherical ones and mimics: make it "
            "joints of one axis, each on a body without mass that the one before it carries"
        )
        if name in BASES:
            problem = (
                f"is a {name} that is not at the world's origin, or does not carry all of the "
                "Model: make what it moves a Model, and a body, of its own"
            )
        raise ModelError(problem, field=where)
    if kind == "ball":
        return kind, np.array([1.0, 0.0, 0.0]), None
    data = here.createData()
    here.calc(data, pin.neutral(model))
    twist = np.ravel(data.S)  # of the moved body, for a unit of the joint's, or its leader's, speed
    mimic = None
    if name == MIMIC:
        leader = model.mimicked_joints[list(model.mimicking_joints).index(joint)]
        follower = here.extract()
        mimic = Mimic(model.names[leader], float(follower.scaling), float(follower.offset))
        if not mimic.multiplier:
            problem = "must not be 0, which leaves the axis open; fix the joint"
            raise ModelError(problem, field=f"{where}.mimic.multiplier", value=mimic.multiplier)
        twist = twist / mimic.multiplier
        turns = "continuous" if model.nqs[leader] == 2 else "revolute"
        kind = "prismatic" if twist[:3].any() else turns
    return kind, twist[:3] if kind == "prismatic" else twist[3:], mimic


def _weld(parent: str, link: str, placement: pin.SE3) -> TreeJoint:
    """What holds a link that moves with another."""
    R, t = _pose(f"frame[{link}].placement", placement)
    return TreeJoint(f"weld of {link}", FIXED, parent, link, R, t, np.array([1.0, 0.0, 0.0]), None)


def _shapes(
    model: pin.Model,
    carriers: dict[int, str],
    links: Sequence[str],
    geometry: pin.GeometryModel | None,
    notes: list[str],
) -> dict[str, list[LinkShape]]:
    """The shapes of each link; what becomes of meshes is noted."""
    shapes: dict[str, list[LinkShape]] = {link: [] for link in links}
    every = [] if geometry is None else list(geometry.geometryObjects)
    names = [*links, *(each.name for each in every)]
    for each in every:
        where = f"geometry[{each.name}]"
        if each.parentJoint not in carriers:
            problem = "stands still in the world: give it as a shape of the scene, not of the body"
            raise ModelError(problem, field=where)
        link, placement = carriers[each.parentJoint], each.placement
        if each.parentFrame < model.nframes and _is_link(model.frames[each.parentFrame]):
            frame = model.frames[each.parentFrame]
            link, placement = frame.name, frame.placement.actInv(placement)
        if each.disableCollision:
            notes.append(f"{where}: left out, since its collisions are disabled")
            continue
        R, t = _pose(f"{where}.placement", placement)
        number = len(shapes[link])
        with about_field(where):
            shape = _shape(each.name, each.geometry, notes)
        # The names of a GeometryModel that is made of a URDF are not the user's.
        is_own = each.name != f"{link}_{number}" and is_own_name(each.name, names)
        name = each.name if is_own else f"{link}#{number}"
        shapes[link].append(LinkShape(name, shape, R, t))
    return shapes


def _shape(name: str, geometry: coal.CollisionGeometry, notes: list[str]) -> Shape:
    """A shape of coal's, of a mesh its hull; ModelError of any other."""
    if getattr(geometry, "getSweptSphereRadius", float)():
        raise ModelError("has a swept-sphere radius, which is not known here; set it to 0")
    for kind, made in SHAPES.items():
        if isinstance(geometry, kind):
            return made(geometry)
    if isinstance(geometry, coal.BVHModelBase):
        triangles = map(geometry.tri_indices, range(geometry.num_tris))
        corners = np.array([(t[0], t[1], t[2]) for t in triangles], dtype=np.int64).reshape(-1, 3)
        # All vertices: of a file of several meshes, coal's triangles have the numbers of the first.
        hull = hull_of_mesh(np.array(geometry.vertices()), corners)
    elif isinstance(geometry, coal.ConvexBase):
        hull = convex_hull(np.array(list(geometry.points())))
    else:
        known = ", ".join(kind.__name__ for kind in SHAPES)
        raise ModelError(f"is a {type(geometry).__name__}; known are {known} and meshes")
    notes.append(hull_words(name, hull))
    return hull


def _pose(where: str, placement: pin.SE3) -> tuple[Array, Array]:
    """R (3, 3) and t (3,) of a placement [-, m]; ModelError if that is none."""
    R, t = np.array(placement.rotation), np.array(placement.translation)
    _check_finite(where, R, t)
    if not np.abs(R.T @ R - np.eye(3)).max() <= ORTHONORMAL or np.linalg.det(R) < 0:
        problem = "must have a rotation R with R'R = 1 and det R = 1"
        raise ModelError(problem, field=where, value=R.tolist())
    return R, t


def _check_finite(where: str, *values: Array | float) -> None:
    if not all(np.isfinite(value).all() for value in values):
        raise ModelError("must hold finite numbers", field=where)

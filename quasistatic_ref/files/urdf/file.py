"""What a URDF file says, checked on its own: a tree of links and joints."""

from collections.abc import Sequence
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.files.mesh_files import mesh_path
from quasistatic_ref.files.trees import checked_tree
from quasistatic_ref.files.urdf.geometry import GEOMETRIES, written_shape
from quasistatic_ref.files.urdf.order import visiting_order
from quasistatic_ref.files.urdf.shapes import Collision, link_shapes
from quasistatic_ref.files.urdf.xml import Tag
from quasistatic_ref.files.xml_text import xml_root
from quasistatic_ref.model.inertia import inertia_defect
from quasistatic_ref.model.joints import JOINTS
from quasistatic_ref.model.tree import (
    MOST_COORDINATES,
    NO_INERTIA,
    Defect,
    Mimic,
    Tree,
    TreeJoint,
    TreeLink,
)
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import length, product
from quasistatic_ref.text.content import text_read

TEXT: Final = Path("<robot>")
"""In the place of its path, of a text."""
SAME_MOMENT = {"iyx": "ixy", "izx": "ixz", "izy": "iyz"}
"""Attributes that some exporters write beside URDF's own."""
_MOVING = tuple(JOINTS)
MOST_LINKS = 1000
"""Most links in a file: a model of them takes time with the square of their number."""
MOST_SHAPES = 1000
"""Most shapes that touch."""
LARGEST_FILE = 16 * 2**20
"""Largest URDF [bytes]; those of humanoids have 0.2 MiB."""
_ROBOT = ("name", "version")
_TURNING = ("revolute", "prismatic")
_VERSIONS = ("1.0", "1.1", "1.2")
MOMENTS: Final = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


class UrdfText(NamedTuple):
    """The text of a URDF.

    Parameters
    ----------
    path : Path
        Its file; ``<robot>``, in the working folder, of a text that was given in place of a file.
    text : str
    """

    path: Path
    text: str

    def mesh_path(self, uri: str, package_dirs: Sequence[str | Path]) -> Path:
        """The file that a mesh's URI means; ModelError as of :func:`.mesh_files.mesh_path`."""
        return mesh_path(uri, self.path.parent, package_dirs, is_of_file=self.path != TEXT)


def urdf_text(source: str | PathLike[str]) -> UrdfText:
    """The text of a URDF file, or a string that is a URDF: one that begins with ``<``.

    Raises
    ------
    ModelError
        If the file is missing, or no text.
    """
    if isinstance(source, str) and source.lstrip().startswith("<"):
        return UrdfText(TEXT, source)
    path = Path(source)
    return UrdfText(path, text_read(path, ModelError, LARGEST_FILE))


def urdf_tree(
    source: str | PathLike[str],
    package_dirs: Sequence[str | Path] = (),
    missing: list[str] | None = None,
) -> Tree:
    """The tree of a URDF file, or of a string that is a URDF.

    pinocchio's own reader reports trouble to standard error and carries on without the collision
    shape, the inertia or the joint that it could not read.

    Parameters
    ----------
    source : str or Path
        As of :func:`urdf_text`.
    package_dirs : sequence of str or Path
        Where ``package://`` URIs are looked for.
    missing : list of str, optional
        Sentences on meshes that are not there are added to it, whose shapes are left out; by
        default they are refused.

    Raises
    ------
    ModelError
        If it is missing or malformed, contradicts itself, or says something that the model
        has no place for; the message names the file, the element and the value.
    """
    urdf = urdf_text(source)
    with about_file(urdf.path):
        return _tree(urdf, package_dirs, missing)


def _tree(urdf: UrdfText, package_dirs: Sequence[str | Path], missing: list[str] | None) -> Tree:
    robot = xml_root(urdf.text)
    if robot.tag != "robot":
        is_mujoco = robot.tag == "mujoco"
        remedy = "; a MuJoCo scene is run whole: quasistatic-ref run FILE.xml" if is_mujoco else ""
        raise ModelError(f"must be <robot>{remedy}", field="root element", value=robot.tag)
    version = robot.get("version", "1.0")
    if version not in _VERSIONS:
        problem = f"must be one of {', '.join(_VERSIONS)}"
        raise ModelError(problem, field="robot.version", value=version)
    top = Tag(robot, "robot")
    top.text("name")
    if "xmlns" in robot.attrib:
        top.notes.append(f"its elements are read without their namespace, {robot.attrib['xmlns']}")
    top.pass_over("link", "joint", attributes=_ROBOT)
    links: dict[str, TreeLink] = {}
    collisions: dict[str, list[Collision]] = {}
    _check_count(len(robot.findall("link")), MOST_LINKS, "links")
    _check_count(len(robot.findall("link/collision")), MOST_SHAPES, "collisions")
    for tag in top.named("link"):
        link = _link(tag)
        if link.name in links:
            raise ModelError("is the name of two links; rename one", field=f"link[{link.name}]")
        links[link.name] = link
        collisions[link.name] = _collisions(tag)
    if not links:
        raise ModelError("has no <link>; add one", field="robot")
    needed = version != "1.2"  # which made limits optional
    joints = _followers([_joint(tag, needed) for tag in top.named("joint")], top.notes)
    moving = [joint.kind for joint in joints if joint.kind != "fixed"]
    coordinates = sum(3 if kind == "ball" else 1 for kind in moving)
    if coordinates > MOST_COORDINATES:
        problem = f"has joints of more than {MOST_COORDINATES} coordinates; fix some of them"
        raise ModelError(problem, field="robot", value=coordinates)
    root, from_root = checked_tree(links, joints)
    order = [root, *(joint.child for joint in from_root)]
    in_q = visiting_order(root, from_root)
    shapes = link_shapes(
        {link: collisions[link] for link in order},
        lambda uri: urdf.mesh_path(uri, package_dirs),
        top.notes,
        missing,
    )
    return Tree(
        path=urdf.path,
        text=urdf.text,
        links={link: replace(links[link], shapes=shapes[link]) for link in order},
        joints=tuple(in_q),
        ignored=tuple(top.unread),
        notes=tuple(top.notes),
    )


def _check_count(count: int, most: int, what: str) -> None:
    if count > most:
        problem = f"holds more than {most} {what}; leave some out"
        raise ModelError(problem, field="robot", value=count)


def _link(link: Tag) -> TreeLink:
    """A link, but for its shapes."""
    link.pass_over("inertial", "collision", attributes=("name",))
    mass, com, inertia, defect, digit = _inertial(link)
    return TreeLink(link.text("name"), mass, com, inertia, (), defect, digit)


def _collisions(link: Tag) -> list[Collision]:
    collisions = []
    for number, each in enumerate(link.element.findall("collision")):
        collision = link.inner(each, f"{link.where}.collision[{number}]")
        collision.pass_over("origin", "geometry", attributes=("name",))
        R, t = collision.frame()
        shape = written_shape(collision)
        collision.child("geometry").pass_over(*GEOMETRIES)
        if shape is None:
            link.notes.append(f"{collision.where}: left out, since its shape has no size")
            continue
        collisions.append(Collision(each.get("name"), collision.where, shape, R, t))
    return collisions


def _inertial(link: Tag) -> tuple[float, Array, Array, Defect | None, float]:
    """Mass [kg], centre of mass (3,) [m], inertia (3, 3) [kg m^2] along the link's axes; digit."""
    inertial = link.perhaps("inertial")
    if inertial is None:
        return 0.0, np.zeros(3), np.zeros((3, 3)), None, 0.0
    inertial.pass_over("origin", "mass", "inertia")
    R, com = inertial.frame()
    mass = inertial.child("mass", "value").number("value")
    if mass < 0:
        raise ModelError("must not be negative", field=f"{inertial.where}.mass", value=mass)
    moments = inertial.perhaps("inertia", *MOMENTS, *SAME_MOMENT)
    if moments is None:
        return mass, com, np.zeros((3, 3)), NO_INERTIA, 0.0
    xx, yy, zz, xy, xz, yz = (moments.number(name) for name in MOMENTS)
    for twin, name in SAME_MOMENT.items():
        moment = moments.number(name)
        if moments.number(twin, moment) != moment:
            problem = f"must equal {name}, the same moment"
            raise ModelError(problem, field=f"{moments.where}.{twin}", value=moments.text(twin))
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    written = {"ixx": xx, "iyy": yy, "izz": zz}
    digit = min((_last_digit(moments.text(name).strip()) for name in written if written[name]),
                default=0.0)  # fmt: skip
    defect = inertia_defect(inertia, digit)
    if not mass > 0:
        defect = ("mass", "must be greater than 0", mass)
    turned = product(R, product(inertia, R.T))
    return mass, com, np.triu(turned) + np.triu(turned, 1).T, defect, digit


def _last_digit(number: str) -> float:
    """A unit of the last digit of a decimal number, whatever its exponent: 0.001 of 1.250."""
    digits, _, exponent = number.lower().partition("e")
    decimals = len(digits.partition(".")[2])
    return float(f"1e{int(exponent or 0) - decimals}")


def _joint(joint: Tag, limits_needed: bool) -> TreeJoint:
    kind = joint.text("type")
    if kind != "fixed" and kind not in _MOVING:
        problem = f"this type is not supported; use {', '.join(_MOVING)} or fixed"
        if kind == "floating":
            problem += ', or base = "floating" where the whole body floats'
        elif kind == "planar":
            problem += ', or base = "planar" where the whole body glides on a plane'
        raise ModelError(problem, field=f"{joint.where}.type", value=kind)
    joint.pass_over(
        "origin", "parent", "child", "axis", "mimic", "dynamics", attributes=("name", "type")
    )
    dynamics = joint.perhaps("dynamics")
    if dynamics is not None:  # a scenario may read the friction
        dynamics.pass_over()
    R, t = joint.frame()
    parent, child = (joint.child(end, "link").text("link") for end in ("parent", "child"))
    axis = np.array([1.0, 0.0, 0.0])  # what URDF says where nothing is written
    written = joint.perhaps("axis")
    if written is not None and kind in ("fixed", "ball"):
        joint.unread.append(written.where)
    elif written is not None:
        written.only("xyz")
        axis = written.numbers("xyz", 3)
        size = length(axis)
        if not size > 0:
            raise ModelError("must not be zero", field=f"{written.where}.xyz", value=axis.tolist())
        axis = axis / size
    limits, effort = _limits(joint, limits_needed and kind in _TURNING, kind in _TURNING)
    mimic = _mimic(joint)
    if kind == "fixed" and mimic is not None:
        joint.unread.append(f"{joint.where}.mimic")
        mimic = None
    return TreeJoint(joint.text("name"), kind, parent, child, R, t, axis, mimic, limits, effort)


def _followers(joints: list[TreeJoint], notes: list[str]) -> list[TreeJoint]:
    """The joints: one that would follow a joint that is not there moves by itself.

    A continuous one that follows one that is not is a revolute one.
    """
    kinds = {joint.name: joint.kind for joint in joints}
    followers = []
    for joint in joints:
        leader = kinds.get(joint.mimic.of) if joint.mimic is not None else None
        if joint.mimic is not None and leader is None:
            notes.append(
                f"joint[{joint.name}]: moves by itself, as the joint that it mimics, "
                f"{joint.mimic.of}, is not there"
            )
            joint = replace(joint, mimic=None)
        if joint.kind == "continuous" and leader in _TURNING:
            notes.append(f"joint[{joint.name}]: revolute, as it mimics a joint with bounds")
            joint = replace(joint, kind="revolute")
        followers.append(joint)
    return followers


_ENDLESS = ("continuous", "ball")
"""Types of joints whose positions have no bounds."""


def _limits(joint: Tag, needed: bool, bounded: bool) -> tuple[tuple[float, float] | None, float]:
    """Bounds of a joint's position [m, rad], if it has any, and its largest effort [N, N m]."""
    limit = joint.perhaps("limit")
    bounds = None
    effort = 0.0
    if limit is None and needed:
        problem = "is missing: URDF requires effort and velocity, although they are not used"
        raise ModelError(problem, field=f"{joint.where}.limit")
    if limit is not None:
        required = None if needed else 0.0
        effort = limit.number("effort", required, np.inf)
        limit.number("velocity", required, np.inf)
        bounds = limit.position_limits()
        if bounds is not None and joint.text("type") in _ENDLESS:
            joint.unread.append(f"{limit.where}.bounds")
        missing = [name for name in ("lower", "upper") if name not in limit.element.attrib]
        if bounded and bounds is None:
            limit.notes.append(f"{limit.where}: has no bounds, and limits no position")
        elif bounded and missing:
            limit.notes.append(f"{limit.where}: has no {missing[0]} bound, which is 0 then")
        elif bounded and bounds == (0.0, 0.0):
            limit.notes.append(f"{limit.where}: both bounds are 0, which hold the joint there")
    return bounds if bounds is not None and bounds[0] <= bounds[1] else None, effort or np.inf


def _mimic(joint: Tag) -> Mimic | None:
    mimic = joint.perhaps("mimic", "joint", "multiplier", "offset")
    if mimic is None:
        return None
    multiplier = mimic.number("multiplier", 1.0)
    offset = mimic.number("offset", 0.0)
    return Mimic(mimic.text("joint"), multiplier, offset)

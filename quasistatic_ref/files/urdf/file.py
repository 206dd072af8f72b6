"""What a URDF file says, checked on its own, before any library has read it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.files.content import text_read
from quasistatic_ref.files.mesh_files import mesh_path
from quasistatic_ref.files.urdf.xml import Tag
from quasistatic_ref.files.xml_text import xml_root
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.quoting import counted, suggestion
from quasistatic_ref.model.joints import JOINTS
from quasistatic_ref.model.urdf.tree import FileJoint, Mimic, checked_tree, visiting_order
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.ordered import length, product
from quasistatic_ref.shapes.placed_shape import Box, Capsule, Cylinder, Shape, Sphere

TEXT: Final = Path("<robot>")
"""In the place of its path, of a text."""
INERTIA_TRIANGLE: Final = 1e-6
"""How far the largest principal moment of inertia may exceed the sum of the other two, relative.

A flat plate has equality; six printed digits break it by up to 1e-6."""

SAME_MOMENT = {"iyx": "ixy", "izx": "ixz", "izy": "iyz"}
"""Attributes that some exporters write beside URDF's own."""
_MOVING = tuple(JOINTS)
MOST_LINKS = 1000
"""Most links in a file: a model of them takes time with the square of their number."""
MOST_SHAPES = 1000
"""Most shapes that touch."""
MOST_COORDINATES = 250
"""Most coordinates of the joints of a file: pinocchio takes memory with the cube of their number,
1 GiB for these; a humanoid has 60."""
LARGEST_FILE = 16 * 2**20
"""Largest URDF [bytes]; those of humanoids have 0.2 MiB."""
_ROBOT = ("name", "version")
_TURNING = ("revolute", "prismatic")
_VERSIONS = ("1.0", "1.1", "1.2")
_GEOMETRIES = {
    "box": ("size",),
    "sphere": ("radius",),
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
    "mesh": ("filename", "scale"),
}
"""Shape -> its attributes."""
_SOLIDS: dict[str, Callable[..., Shape]] = {
    "box": Box,
    "sphere": Sphere,
    "cylinder": Cylinder,
    "capsule": Capsule,
}


Defect = tuple[str, str, object]
"""What is wrong with an inertia: ``"mass"`` or ``"inertia"``, the problem, the value."""


MOMENTS: Final = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
NO_INERTIA: Final[Defect] = ("inertia", "is missing", None)
"""Of a link with a mass alone."""


@dataclass(frozen=True, eq=False)
class FileMesh:
    """A mesh as written: its URI, and the `scale` of each coordinate, shape (3,) [-]."""

    uri: str
    scale: Array


FileShape = Shape | FileMesh
"""A shape as written."""


class FileCollision(NamedTuple):
    """A collision shape as written.

    Parameters
    ----------
    name : str or None
    shape : FileShape
    R, t : ndarray, shapes (3, 3) and (3,)
        Its frame in the link's [-, m].
    """

    name: str | None
    shape: FileShape
    R: Array
    t: Array


@dataclass(frozen=True, eq=False)
class FileLink(Plain):
    """A link as written.

    Parameters
    ----------
    name : str
    mass : float
        [kg]; 0 without an ``inertial``.
    com : ndarray, shape (3,)
        Centre of mass in the link's frame [m].
    inertia : ndarray, shape (3, 3)
        About the centre of mass, along the link's axes [kg m^2].
    collisions : tuple of FileCollision
    defect : Defect or None
        Why no rigid body has this inertia; an error where an un-actuated joint moves the link.
    digit : float
        A unit of the last digit of its moments, as printed [kg m^2].
    """

    name: str
    mass: float
    com: Array
    inertia: Array
    collisions: tuple[FileCollision, ...]
    defect: Defect | None
    digit: float


@dataclass(frozen=True, eq=False, repr=False)
class UrdfFile(Plain):
    """A URDF file as written, or what one would say.

    Parameters
    ----------
    path : Path
        ``<robot>``, in the working folder, of a text that was given in place of a file.
    text : str
        The whole file; of what is no file a digest.
    root : str
        Name of the root link.
    links : dict of str to FileLink, in file order
    joints : tuple of FileJoint
        Parents before children.
    ignored : tuple of str
        Elements and attributes that the model does not use, e.g. ``link[base].visual``.
    notes : tuple of str
        What was left out or taken in another way than it is written.
    """

    path: Path
    text: str
    root: str
    links: dict[str, FileLink]
    joints: tuple[FileJoint, ...]
    ignored: tuple[str, ...]
    notes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.path}: {counted(len(self.links), 'link')}>"

    def in_order(self) -> Sequence[FileJoint]:
        """All joints, those that move in the order in which q has them."""
        return visiting_order(self.root, self.joints)

    def mesh_path(self, uri: str, package_dirs: Sequence[str | Path]) -> Path:
        """The file that a mesh's URI means; ModelError as of :func:`.mesh_files.mesh_path`."""
        return mesh_path(uri, self.path.parent, package_dirs, is_of_file=self.path != TEXT)


def urdf_file(source: str | Path | UrdfFile) -> UrdfFile:
    """Content of a URDF file, or of a string that is a URDF: one that begins with ``<``.

    What is content already is returned.

    Raises
    ------
    ModelError
        If it is missing or malformed, contradicts itself, or says something that the model
        has no place for; the message names the file, the element and the value.
    """
    if isinstance(source, UrdfFile):
        return source
    if isinstance(source, str) and source.lstrip().startswith("<"):
        path = TEXT
        text = source
    else:
        path = Path(source)
        text = text_read(path, ModelError, LARGEST_FILE)
    with about_file(path):
        return _content(path, text)


def _content(path: Path, text: str) -> UrdfFile:
    robot = xml_root(text)
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
    links: dict[str, FileLink] = {}
    _check_count(len(robot.findall("link")), MOST_LINKS, "links")
    _check_count(len(robot.findall("link/collision")), MOST_SHAPES, "collisions")
    for tag in top.named("link"):
        link = _link(tag)
        if link.name in links:
            raise ModelError("is the name of two links; rename one", field=f"link[{link.name}]")
        links[link.name] = link
    if not links:
        raise ModelError("has no <link>", field="robot")
    needed = version != "1.2"  # which made limits optional
    joints = _followers([_joint(tag, needed) for tag in top.named("joint")], top.notes)
    moving = [joint.kind for joint in joints if joint.kind != "fixed"]
    coordinates = sum(3 if kind == "ball" else 1 for kind in moving)
    if coordinates > MOST_COORDINATES:
        problem = f"has joints of more than {MOST_COORDINATES} coordinates; fix some of them"
        raise ModelError(problem, field="robot", value=coordinates)
    root, ordered = checked_tree(links, joints)
    return UrdfFile(path, text, root, links, ordered, tuple(top.unread), tuple(top.notes))


def _check_count(count: int, most: int, what: str) -> None:
    if count > most:
        raise ModelError(f"holds more than {most} {what}", field="robot", value=count)


def _link(link: Tag) -> FileLink:
    link.pass_over("inertial", "collision", attributes=("name",))
    mass, com, inertia, defect, digit = _inertial(link)
    collisions = []
    for number, each in enumerate(link.element.findall("collision")):
        collision = link.inner(each, f"{link.where}.collision[{number}]")
        collision.pass_over("origin", "geometry", attributes=("name",))
        R, t = collision.frame()
        shape = written_shape(collision)
        collision.child("geometry").pass_over(*_GEOMETRIES)
        if shape is None:
            link.notes.append(f"{collision.where}: left out, since its shape has no size")
            continue
        collisions.append(FileCollision(each.get("name"), shape, R, t))
    return FileLink(link.text("name"), mass, com, inertia, tuple(collisions), defect, digit)


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


def inertia_defect(inertia: Array, digit: float = 0.0) -> Defect | None:
    """What makes an inertia (3, 3) about a centre of mass that of no body, or None.

    The largest moment may exceed the sum of the others by rounding: by a unit of the last printed
    digit [kg m^2], up to a tenth of it.
    """
    principal = np.linalg.eigvalsh(inertia)
    written = inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]].tolist()
    order = "(ixx iyy izz ixy ixz iyz)"
    if not principal[0] > 0:
        problem = f"must be positive definite {order}"
        if principal[0] >= -INERTIA_TRIANGLE * abs(principal[2]):
            problem += (
                "; with a radius r write m r^2/2 about the axis of a rod or disk, m r^2/4 about "
                "the diameters of a disk, 2 m r^2/5 for a point mass"
            )
        return "inertia", problem, written
    rounding = min(digit, principal[2] / 10) * (1 + INERTIA_TRIANGLE)
    if principal[2] > (principal[0] + principal[1]) * (1 + INERTIA_TRIANGLE) + rounding:
        problem = "is impossible: the largest principal moment exceeds the sum of the others"
        return "inertia", f"{problem} {order}", written
    return None


def written_shape(collision: Tag) -> FileShape | None:
    """The shape of a collision or visual element; None if one of its sizes is 0.

    Of a mesh's scale the first three numbers count; the others are taken away, and noted.

    Raises
    ------
    ModelError
        If it has none, more than one, or one that is not known.
    """
    geometry = collision.child("geometry")
    tags = [child.tag for child in geometry.element]
    if len(tags) != 1:
        raise ModelError("must contain exactly one shape", field=geometry.where, value=tags)
    kind = tags[0]
    shape = geometry.inner(geometry.element[0], f"{collision.where}.{kind}")
    if kind not in _GEOMETRIES:
        raise ModelError(f"is not a shape{suggestion(kind, _GEOMETRIES)}", field=shape.where)
    shape.only(*_GEOMETRIES[kind])
    if kind == "mesh":
        scales = shape.element.get("scale", "").split()
        if len(scales) > 3:
            shape.notes.append(
                f"{shape.where}.scale: of its {len(scales)} numbers the first three count"
            )
            shape.element.set("scale", " ".join(scales[:3]))
        scale = shape.numbers("scale", 3, default=1.0)
        if not (scale != 0).all():
            return None
        return FileMesh(shape.expanded("filename").strip(), scale)
    sizes = {
        name: shape.numbers(name, 3) if name == "size" else shape.number(name)
        for name in _GEOMETRIES[kind]
    }
    if np.min([*sizes.values()]) == 0 and not (kind == "capsule" and sizes["radius"] > 0):
        return None
    try:
        return _SOLIDS[kind](**sizes)
    except ModelError as error:  # about a size
        name = str(error.field)
        error.field = f"{shape.where}.{name}"
        error.value = shape.text(name)
        raise


def _joint(joint: Tag, limits_needed: bool) -> FileJoint:
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
    return FileJoint(joint.text("name"), kind, parent, child, R, t, axis, mimic, limits, effort)


def _followers(joints: list[FileJoint], notes: list[str]) -> list[FileJoint]:
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

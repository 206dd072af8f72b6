"""What a URDF file says, checked on its own, before any library has read it."""

from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.formats.files import bytes_read, text_of
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.model.joints import JOINTS
from quasistatic_ref.model.urdf.urdf_tree import FileJoint, Mimic, checked_tree
from quasistatic_ref.model.urdf.urdf_xml import Tag, xml_root
from quasistatic_ref.shapes.placed_shape import Box, Capsule, Cylinder, Shape, Sphere
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.ordered import product
from quasistatic_ref.tolerances import INERTIA_TRIANGLE

_MOVING = tuple(JOINTS)
MOST_LINKS = 1000
"""Most links in a file: urdfdom recurses from link to link, and ends the process at long chains."""
MOST_SHAPES = 1000
"""Most shapes that touch: pinocchio takes time with the cube of their number, 1.5 s for these."""
MOST_COORDINATES = 250
"""Most coordinates of the joints of a file: pinocchio takes memory with the cube of their number,
1 GiB for these; a humanoid has 60."""
LARGEST_FILE = 16 * 2**20
"""Largest URDF [bytes]; those of humanoids have 0.2 MiB."""
_ROBOT = ("name", "version")
_VERSIONS = ("1.0", "1.1", "1.2")
_GEOMETRIES = {
    "box": ("size",),
    "sphere": ("radius",),
    "cylinder": ("radius", "length"),
    "capsule": ("radius", "length"),
    "mesh": ("filename", "scale"),
}
"""Shape -> its attributes."""


Defect = tuple[str, str, object]
"""What is wrong with an inertia: ``"mass"`` or ``"inertia"``, the problem, the value."""


@dataclass(frozen=True, eq=False)
class FileMesh:
    """A mesh as written: its URI, and the `scale` of each coordinate, shape (3,) [-]."""

    uri: str
    scale: Array


FileShape = Shape | FileMesh
"""A shape as written."""


@dataclass(frozen=True, eq=False)
class FileLink:
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
    collisions : tuple of (FileShape, R (3, 3), t (3,))
        Each shape and its frame in the link's [m].
    named : tuple of (str or None)
        The name of each, where its ``collision`` has one.
    defect : Defect or None
        Why no rigid body has this inertia; an error where an un-actuated joint moves the link.
    """

    name: str
    mass: float
    com: Array
    inertia: Array
    collisions: tuple[tuple[FileShape, Array, Array], ...]
    defect: Defect | None = None
    named: tuple[str | None, ...] = ()


@dataclass(frozen=True, eq=False)
class UrdfFile:
    """A URDF file as written.

    Parameters
    ----------
    path : Path
        ``<robot>``, in the working folder, of a text that was given in place of a file.
    text : str
        The whole file.
    root : str
        Name of the root link.
    links : dict of str to FileLink, in file order
    joints : tuple of FileJoint
        Parents before children.
    ignored : tuple of str
        Elements and attributes that the model does not use, e.g. ``link[base].visual``.
    """

    path: Path
    text: str
    root: str
    links: dict[str, FileLink]
    joints: tuple[FileJoint, ...]
    ignored: tuple[str, ...]


def urdf_file(given: str | Path) -> UrdfFile:
    """Content of a URDF file, or of a string that is a URDF: one that begins with ``<``.

    Raises
    ------
    ModelError
        If it is missing or malformed, contradicts itself, or says something that the model
        has no place for; the message names the file, the element and the value.
    """
    if isinstance(given, str) and given.lstrip().startswith("<"):
        path = Path("<robot>")
        text = given
    else:
        path = Path(given)
        text = text_of(bytes_read(path, ModelError, LARGEST_FILE), path, ModelError)
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
    ignored = Tag(robot, "robot").ignored("link", "joint", attributes=_ROBOT)
    links: dict[str, FileLink] = {}
    counts = {
        "links": (len(robot.findall("link")), MOST_LINKS),
        "collisions": (len(robot.findall("link/collision")), MOST_SHAPES),
    }
    for what, (count, most) in counts.items():
        if count > most:
            raise ModelError(f"holds more than {most} {what}", field="robot", value=count)
    for element in robot.findall("link"):
        link = _link(element, ignored)
        if link.name in links:
            raise ModelError("is the name of two links; rename one", field=f"link[{link.name}]")
        links[link.name] = link
    joints = [_joint(element, ignored) for element in robot.findall("joint")]
    moving = [JOINTS[joint.kind] for joint in joints if joint.kind in JOINTS]
    coordinates = sum(len(getattr(kind, "twist", "1")) for kind in moving)
    if coordinates > MOST_COORDINATES:
        problem = f"has joints of more than {MOST_COORDINATES} coordinates; fix some of them"
        raise ModelError(problem, field="robot", value=coordinates)
    root, ordered = checked_tree(links, joints)
    return UrdfFile(path, text, root, links, ordered, tuple(ignored))


def _link(element: Element, ignored: list[str]) -> FileLink:
    name = Tag(element, "link").text("name")
    link = Tag(element, f"link[{name}]")
    ignored += link.ignored("inertial", "collision", attributes=("name",))
    mass, com, inertia, defect = _inertial(link, ignored)
    collisions = []
    for number, each in enumerate(element.findall("collision")):
        collision = Tag(each, f"{link.where}.collision[{number}]")
        ignored += collision.ignored("origin", "geometry", attributes=("name",))
        R, t = collision.frame()
        collisions.append((written_shape(collision), R, t))
        ignored += collision.child("geometry").ignored(*_GEOMETRIES)
    named = tuple(each.get("name") for each in element.findall("collision"))
    return FileLink(name, mass, com, inertia, tuple(collisions), defect, named)


def _inertial(link: Tag, ignored: list[str]) -> tuple[float, Array, Array, Defect | None]:
    """Mass [kg], centre of mass (3,) [m], inertia (3, 3) [kg m^2] along the link's axes."""
    inertial = link.perhaps("inertial")
    if inertial is None:
        return 0.0, np.zeros(3), np.zeros((3, 3)), None
    ignored += inertial.ignored("origin", "mass", "inertia")
    R, com = inertial.frame()
    mass = inertial.child("mass", "value").number("value")
    if mass < 0:
        raise ModelError("must not be negative", field=f"{inertial.where}.mass", value=mass)
    names = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
    moments = inertial.child("inertia", *names)
    xx, yy, zz, xy, xz, yz = (moments.number(name) for name in names)
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    defect = inertia_defect(inertia)
    if not mass > 0:
        defect = ("mass", "must be greater than 0", mass)
    return mass, com, product(product(R, inertia), R.T), defect


def inertia_defect(inertia: Array) -> Defect | None:
    """What makes an inertia (3, 3) about a centre of mass that of no body, or None."""
    principal = np.linalg.eigvalsh(inertia)
    written = inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]].tolist()
    order = "(ixx iyy izz ixy ixz iyz)"
    if not principal[0] > 0:
        return "inertia", f"must be positive definite {order}", written
    if principal[2] > (principal[0] + principal[1]) * (1 + INERTIA_TRIANGLE):
        problem = "is impossible: the largest principal moment exceeds the sum of the others"
        return "inertia", f"{problem} {order}", written
    return None


def written_shape(collision: Tag) -> FileShape:
    """The shape of a collision or visual element.

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
    shape = Tag(geometry.element[0], f"{collision.where}.{tags[0]}")
    if kind not in _GEOMETRIES:
        raise ModelError(f"is not a shape{suggestion(kind, _GEOMETRIES)}", field=shape.where)
    shape.only(*_GEOMETRIES[kind])
    if kind == "mesh":
        scale = shape.numbers("scale", 3, default=1.0)
        if not (scale != 0).all():
            raise ModelError("must not be zero", field=f"{shape.where}.scale", value=scale.tolist())
        return FileMesh(shape.text("filename").strip(), scale)
    try:
        if kind == "box":
            return Box(shape.numbers("size", 3) / 2)
        radius = shape.number("radius")
        if kind == "sphere":
            return Sphere(radius)
        return (Capsule if kind == "capsule" else Cylinder)(radius, shape.number("length") / 2)
    except ModelError as error:
        written = {"half_extents": "size", "radius": "radius", "half_length": "length"}
        if error.field in written:  # about a size: name it as the file does
            name = written[error.field]
            error.field = f"{shape.where}.{name}"
            error.value = shape.element.get(name)
        raise


def _joint(element: Element, ignored: list[str]) -> FileJoint:
    name = Tag(element, "joint").text("name")
    joint = Tag(element, f"joint[{name}]")
    kind = joint.text("type")
    if kind != "fixed" and kind not in _MOVING:
        problem = f"this type is not supported; use {', '.join(_MOVING)} or fixed"
        if kind == "floating":
            problem += ', or base = "floating" where the whole body floats'
        raise ModelError(problem, field=f"{joint.where}.type", value=kind)
    read = ("origin", "parent", "child", "axis", "mimic", "dynamics")
    ignored += joint.ignored(*read, attributes=("name", "type"))
    dynamics = joint.perhaps("dynamics")
    if dynamics is not None:  # a scenario may read the friction
        ignored += dynamics.ignored()
    R, t = joint.frame()
    parent, child = (joint.child(end, "link").text("link") for end in ("parent", "child"))
    axis = np.array([1.0, 0.0, 0.0])  # what URDF says where nothing is written
    written = joint.perhaps("axis")
    if written is not None and kind in ("fixed", "ball"):
        ignored.append(written.where)
    elif written is not None:
        written.only("xyz")
        axis = written.numbers("xyz", 3)
        length = float(np.hypot.reduce(axis))
        if not length > 0:
            raise ModelError("must not be zero", field=f"{written.where}.xyz", value=axis.tolist())
        axis = axis / length
    _check_limit(joint, needed=kind in ("revolute", "prismatic"))
    mimic = _mimic(joint)
    if kind == "fixed" and mimic is not None:
        ignored.append(f"{joint.where}.mimic")
        mimic = None
    return FileJoint(name, kind, parent, child, R, t, axis, mimic)


def _check_limit(joint: Tag, *, needed: bool) -> None:
    """Limits are no part of the model, but urdfdom refuses a joint without good ones."""
    limit = joint.perhaps("limit")
    if limit is None and needed:
        problem = "is missing: URDF requires effort and velocity, although they are not used"
        raise ModelError(problem, field=f"{joint.where}.limit")
    if limit is not None:
        for name in ("effort", "velocity", "lower", "upper"):
            limit.number(name, 0.0 if name in ("lower", "upper") else None, most=np.inf)


def _mimic(joint: Tag) -> Mimic | None:
    mimic = joint.perhaps("mimic", "joint", "multiplier", "offset")
    if mimic is None:
        return None
    multiplier = mimic.number("multiplier", 1.0)
    offset = mimic.number("offset", 0.0)
    return Mimic(mimic.text("joint"), multiplier, offset)

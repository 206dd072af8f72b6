"""What a URDF file says, checked on its own, before any library has read it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from quasistatic_ref.errors import ModelError, about_file, suggestion
from quasistatic_ref.files import bytes_read, text_of
from quasistatic_ref.model.shapes import Box, Capsule, Cylinder, Solid, Sphere
from quasistatic_ref.model.urdf_tree import FileJoint, Mimic, checked_tree
from quasistatic_ref.model.urdf_xml import (
    at_most_one,
    attribute,
    exactly_one,
    frame,
    ignored_children,
    numbers,
    only_attributes,
    xml_root,
)
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.tolerances import INERTIA_TRIANGLE

_MOVING = ("revolute", "continuous", "prismatic")
MOST_LINKS = 1000
"""Most links in a file: urdfdom recurses from link to link, and ends the process where the
stack does."""
LARGEST_FILE = 16 * 2**20
"""Largest URDF [bytes]; those of humanoids have 0.2 MiB."""
_VERSIONS = ("1.0", "1.1", "1.2")
_GEOMETRIES = ("box", "sphere", "cylinder", "capsule", "mesh")


Defect = tuple[str, str, object]
"""What is wrong with an inertia: ``"mass"`` or ``"inertia"``, the problem, the value."""


@dataclass(frozen=True, eq=False)
class FileMesh:
    """A mesh as written: its address, and the `scale` of each coordinate, shape (3,) [-]."""

    address: str
    scale: Array


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
    collisions : tuple of (Solid or FileMesh, R (3, 3), t (3,))
        Each shape and its frame in the link's [m].
    defect : Defect or None
        What makes its inertia that of no body; it only matters where something un-actuated
        moves the link.
    """

    name: str
    mass: float
    com: Array
    inertia: Array
    collisions: tuple[tuple[Solid | FileMesh, Array, Array], ...]
    defect: Defect | None = None


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
        Elements that the model does not use, e.g. ``link[base].visual``.
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
        path, text = Path("<robot>"), given
    else:
        path = Path(given)
        text = text_of(bytes_read(path, ModelError, LARGEST_FILE), path, ModelError)
    with about_file(path):
        return _content(path, text)


def _content(path: Path, text: str) -> UrdfFile:
    robot = xml_root(text)
    if robot.tag != "robot":
        raise ModelError("must be <robot>", field="root element", value=robot.tag)
    version = robot.get("version", "1.0")
    if version not in _VERSIONS:
        problem = f"must be one of {', '.join(_VERSIONS)}"
        raise ModelError(problem, field="robot.version", value=version)
    ignored = ignored_children(robot, "robot", ("link", "joint"))
    links: dict[str, FileLink] = {}
    if len(robot.findall("link")) > MOST_LINKS:
        problem = f"holds more than {MOST_LINKS} links"
        raise ModelError(problem, field="robot", value=len(robot.findall("link")))
    for element in robot.findall("link"):
        link = _link(element, ignored)
        if link.name in links:
            raise ModelError("is the name of two links", field=f"link[{link.name}]")
        links[link.name] = link
    joints = [_joint(element, ignored) for element in robot.findall("joint")]
    root, ordered = checked_tree(links, joints)
    return UrdfFile(path, text, root, links, ordered, tuple(ignored))


def _link(element: Element, ignored: list[str]) -> FileLink:
    name = attribute(element, "link", "name")
    where = f"link[{name}]"
    ignored += ignored_children(element, where, ("inertial", "collision"))
    mass, com, inertia, defect = _inertial(element, where, ignored)
    collisions = []
    for number, collision in enumerate(element.findall("collision")):
        at = f"{where}.collision[{number}]"
        ignored += ignored_children(collision, at, ("origin", "geometry"))
        R, t = frame(collision, at)
        collisions.append((_geometry(exactly_one(collision, at, "geometry"), at), R, t))
    return FileLink(name, mass, com, inertia, tuple(collisions), defect)


def _inertial(
    link: Element, where: str, ignored: list[str]
) -> tuple[float, Array, Array, Defect | None]:
    """Mass [kg], centre of mass (3,) [m], inertia (3, 3) [kg m^2] along the link's axes."""
    element = at_most_one(link, where, "inertial")
    if element is None:
        return 0.0, np.zeros(3), np.zeros((3, 3)), None
    where = f"{where}.inertial"
    ignored += ignored_children(element, where, ("origin", "mass", "inertia"))
    R, com = frame(element, where)
    child = exactly_one(element, where, "mass")
    only_attributes(child, f"{where}.mass", ("value",))
    mass = float(numbers(child, f"{where}.mass", "value", 1)[0])
    if mass < 0:
        raise ModelError("must not be negative", field=f"{where}.mass", value=mass)
    child = exactly_one(element, where, "inertia")
    names = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
    only_attributes(child, f"{where}.inertia", names)
    xx, yy, zz, xy, xz, yz = (
        float(numbers(child, f"{where}.inertia", name, 1)[0]) for name in names
    )
    inertia = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    defect = inertia_defect(inertia)
    if not mass > 0:
        defect = ("mass", "must be greater than 0", mass)
    return mass, com, R @ inertia @ R.T, defect


def inertia_defect(inertia: Array) -> Defect | None:
    """What makes an inertia (3, 3) about a centre of mass that of no body, or None."""
    principal = np.linalg.eigvalsh(inertia)
    written = inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]].tolist()
    order = "(ixx iyy izz ixy ixz iyz)"
    if not principal[0] > 0:
        return "inertia", f"must be positive definite {order}", written
    if principal[2] > (principal[0] + principal[1]) * (1 + INERTIA_TRIANGLE):
        problem = "is that of no body: the largest principal moment exceeds the sum of the others"
        return "inertia", f"{problem} {order}", written
    return None


def _geometry(element: Element, where: str) -> Solid | FileMesh:
    if len(element) != 1:
        tags = [child.tag for child in element]
        raise ModelError("must hold exactly one shape", field=f"{where}.geometry", value=tags)
    child = element[0]
    where = f"{where}.{child.tag}"
    if child.tag == "mesh":
        only_attributes(child, where, ("filename", "scale"))
        scale = numbers(child, where, "scale", 3, default=1.0)
        if not (scale != 0).all():
            raise ModelError("must not be zero", field=f"{where}.scale", value=scale.tolist())
        return FileMesh(attribute(child, where, "filename").strip(), scale)
    if child.tag not in _GEOMETRIES:
        raise ModelError(f"is not a shape{suggestion(child.tag, _GEOMETRIES)}", field=where)
    written = {"half_extents": "size", "radius": "radius", "half_length": "length"}
    try:
        if child.tag == "box":
            only_attributes(child, where, ("size",))
            return Box(numbers(child, where, "size", 3) / 2)
        if child.tag == "sphere":
            only_attributes(child, where, ("radius",))
            return Sphere(float(numbers(child, where, "radius", 1)[0]))
        only_attributes(child, where, ("radius", "length"))
        kind = Capsule if child.tag == "capsule" else Cylinder
        radius, length = (float(numbers(child, where, n, 1)[0]) for n in ("radius", "length"))
        return kind(radius, length / 2)
    except ModelError as error:
        if error.field in written:  # about a size: name it as the file does
            name = written[error.field]
            error.field, error.value = f"{where}.{name}", child.get(name)
        raise


def _joint(element: Element, ignored: list[str]) -> FileJoint:
    name = attribute(element, "joint", "name")
    where = f"joint[{name}]"
    kind = attribute(element, where, "type")
    if kind != "fixed" and kind not in _MOVING:
        problem = f"this type is not supported; use {', '.join(_MOVING)} or fixed"
        if kind == "floating":
            problem += ', or base = "floating" where the whole body floats'
        raise ModelError(problem, field=f"{where}.type", value=kind)
    read = ("origin", "parent", "child", "axis", "mimic")
    ignored += ignored_children(element, where, read)
    R, t = frame(element, where)
    ends = []
    for tag in ("parent", "child"):
        end = exactly_one(element, where, tag)
        only_attributes(end, f"{where}.{tag}", ("link",))
        ends.append(attribute(end, f"{where}.{tag}", "link"))
    axis = np.array([1.0, 0.0, 0.0])  # what URDF says where nothing is written
    child = at_most_one(element, where, "axis")
    if child is not None and kind != "fixed":
        only_attributes(child, f"{where}.axis", ("xyz",))
        axis = numbers(child, f"{where}.axis", "xyz", 3)
        length = float(np.hypot.reduce(axis))
        if not length > 0:
            raise ModelError("must not be zero", field=f"{where}.axis.xyz", value=axis.tolist())
        axis = axis / length
    _check_limit(element, where, needed=kind in ("revolute", "prismatic"))
    mimic = _mimic(element, where)
    if kind == "fixed" and mimic is not None:
        ignored.append(f"{where}.mimic")
        mimic = None
    return FileJoint(name, kind, ends[0], ends[1], R, t, axis, mimic)


def _check_limit(joint: Element, where: str, *, needed: bool) -> None:
    """Limits are no part of the model, but urdfdom refuses a joint without good ones."""
    limit = at_most_one(joint, where, "limit")
    if limit is None:
        if needed:
            problem = (
                "is missing: URDF asks for effort and velocity, though the model has no limits"
            )
            raise ModelError(problem, field=f"{where}.limit")
        return
    for name in ("effort", "velocity", "lower", "upper"):
        default = 0.0 if name in ("lower", "upper") else None
        numbers(limit, f"{where}.limit", name, 1, default, most=np.inf)


def _mimic(joint: Element, where: str) -> Mimic | None:
    child = at_most_one(joint, where, "mimic")
    if child is None:
        return None
    where = f"{where}.mimic"
    only_attributes(child, where, ("joint", "multiplier", "offset"))
    multiplier = float(numbers(child, where, "multiplier", 1, default=1.0)[0])
    offset = float(numbers(child, where, "offset", 1, default=0.0)[0])
    return Mimic(attribute(child, where, "joint"), multiplier, offset)

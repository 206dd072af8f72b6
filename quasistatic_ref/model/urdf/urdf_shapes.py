"""The collision shapes of a URDF as pinocchio loaded them, compared with what its file says."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from xml.etree.ElementTree import SubElement, tostring

import numpy as np
import pinocchio as pin

from quasistatic_ref.errors import ModelError, about_field
from quasistatic_ref.formats.together import once
from quasistatic_ref.model.readers.mesh_files import (
    hull_note,
    hull_of_loaded,
    loaded_mesh,
)
from quasistatic_ref.model.readers.xml_text import xml_root
from quasistatic_ref.model.urdf.urdf_file import MOMENTS, FileMesh, UrdfFile, written_shape
from quasistatic_ref.model.urdf.urdf_xml import Tag
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.placed_shape import Capsule, PlacedShape, Sphere
from quasistatic_ref.tolerances import LOADED

READ = {
    "robot": ("link", "joint"),
    "link": ("inertial", "collision"),
    "joint": ("origin", "parent", "child", "axis", "mimic", "dynamics", "limit"),
}
"""Element -> those in it that are read."""
IN_PLACE = Sphere(1.0)
"""What pinocchio is given in place of a mesh: where it puts that is compared, the mesh is ours."""


def resolved_text(file: UrdfFile, package_dirs: Sequence[str | Path]) -> str:
    """The file's text without what the model ignores, such as visuals, and in URDF 1.1.

    <collision_checking> goes too, by which pinocchio takes a shape for another than the one
    written. The URI of a collision mesh is replaced by the file that it means.

    Raises
    ------
    ModelError
        If a mesh is not to be found where it may be, or is too large.
    """
    robot = xml_root(file.text)
    for tag, read in READ.items():
        for element in [robot] if tag == "robot" else robot.findall(tag):
            for ignored in [child for child in element if child.tag not in read]:
                element.remove(ignored)
    for element in robot.iter():
        for name in [name for name in element.attrib if ":" in name or name == "xmlns"]:
            del element.attrib[name]
        if "quat_xyzw" in element.attrib:
            element.set("rpy", " ".join(map(repr, Tag(element, "origin").rpy().tolist())))
            del element.attrib["quat_xyzw"]
    joints = {joint.name: joint for joint in file.joints}
    for joint in robot.findall("joint"):
        written = joints[joint.get("name", "")]
        joint.set("type", written.kind)
        for mimic in joint.findall("mimic"):
            if written.mimic is None:
                joint.remove(mimic)
        limit = joint.find("limit")
        if limit is None and written.kind in ("revolute", "prismatic"):
            limit = SubElement(joint, "limit")
        if limit is not None:
            limit.set("effort", limit.get("effort", "0"))
            limit.set("velocity", limit.get("velocity", "0"))
    for link in robot.findall("link"):
        for inertial in link.findall("inertial"):
            if inertial.find("inertia") is None:
                SubElement(inertial, "inertia", dict.fromkeys(MOMENTS, "0"))
        for collision in link.findall("collision"):
            if written_shape(Tag(collision, "collision"), []) is None:
                link.remove(collision)
        for count, collision in enumerate(link.findall("collision")):
            for mesh in collision.findall("geometry/mesh"):
                with about_field(f"link[{link.get('name')}].collision[{count}].mesh.filename"):
                    uri = mesh.get("filename", "")
                    mesh.set("filename", str(file.mesh_path(uri, package_dirs)))
    return tostring(robot, encoding="unicode")


def with_spheres(text: str) -> str:
    """A URDF's text with a sphere in place of each mesh."""
    robot = xml_root(text)
    for geometry in robot.findall("link/collision/geometry"):
        if geometry.find("mesh") is not None:
            geometry.clear()
            SubElement(geometry, "sphere", radius=f"{IN_PLACE.radius!r}")
    return tostring(robot, encoding="unicode")


def checked_shapes(
    file: UrdfFile,
    model: pin.Model,
    geometry: pin.GeometryModel,
    links: Sequence[str],
    frames: Sequence[int],
    package_dirs: Sequence[str | Path],
) -> tuple[tuple[PlacedShape, ...], tuple[str, ...]]:
    """Every collision shape in the frame of its link, as loaded; and notes on its meshes.

    Raises
    ------
    ModelError
        If shapes are missing, or differ from what the file says, or a mesh cannot be read.
    """
    shapes = []
    notes = []
    names = [link.name for link in file.links.values()]
    names += [one.name for link in file.links.values() for one in link.collisions if one.name]
    for number, (link, frame) in enumerate(zip(links, frames, strict=True)):
        collisions = file.links[link].collisions
        loaded = [shape for shape in geometry.geometryObjects if shape.parentFrame == frame]
        where = f"link[{link}].collision"
        if len(loaded) != len(collisions):
            capsules = any(isinstance(written.shape, Capsule) for written in collisions)
            hint = '; <capsule> needs <robot version="1.1"> or 1.2' if capsules else ""
            problem = (
                f"only {len(loaded)} of its shapes were loaded, "
                f"for the reason printed on standard error{hint}"
            )
            raise ModelError(problem, field=where, value=len(collisions))
        for count, (written, of_pinocchio) in enumerate(zip(collisions, loaded, strict=True)):
            shape = written.shape
            placement = model.frames[frame].placement.actInv(of_pinocchio.placement)
            solid = IN_PLACE if isinstance(shape, FileMesh) else shape
            same = (of_pinocchio.meshScale == 1).all() and of_pinocchio.geometry == solid.coal
            if not (same and same_pose(placement, written.R, written.t)):
                problem = "was not loaded as written"
                raise ModelError(problem, field=f"{where}[{count}]", value=shape)
            name = f"{link}#{count}"
            if written.name and _usable(written.name, names):
                name = written.name
            if isinstance(shape, FileMesh):
                with about_field(f"{where}[{count}].mesh"):
                    path = file.mesh_path(shape.uri, package_dirs)
                    mesh = once(("mesh", path), partial(loaded_mesh, path))
                if not len(mesh.vertices):
                    notes.append(f"{name}: left out, since {shape.uri} is empty")
                    continue
                scale = shape.scale
                key = ("hull", path, scale.tobytes())
                try:
                    hull = once(key, partial(hull_of_loaded, mesh, scale))
                except ModelError:  # there are too few of them, or all lie in one plane
                    notes.append(f"{name}: left out, since the hull of {shape.uri} has no volume")
                    continue
                notes.append(hull_note(name, hull, mesh))
                shape = hull
            shapes.append(
                PlacedShape(name, number, placement.rotation, placement.translation, shape)
            )
    return tuple(shapes), tuple(notes)


def _usable(name: str, every: Sequence[str]) -> bool:
    """Whether a collision's name means nothing else among the links and shapes of its file."""
    return every.count(name) == 1 and not any(c in "/#*?[" or c.isspace() for c in name)


def same_pose(placement: pin.SE3, R: Array, t: Array) -> bool:
    """Whether pinocchio's placement is that of a file, (3, 3) and (3,) [m], but for rounding."""
    off = np.abs(placement.translation - t).max() > LOADED * (1 + np.abs(t).max())
    return not (off or np.abs(placement.rotation - R).max() > LOADED)

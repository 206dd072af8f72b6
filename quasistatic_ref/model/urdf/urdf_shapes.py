"""The collision shapes of a URDF as pinocchio loaded them, compared with what its file says."""

from collections.abc import Sequence
from pathlib import Path
from xml.etree.ElementTree import tostring

import numpy as np
import pinocchio as pin

from quasistatic_ref.errors import ModelError, about_field
from quasistatic_ref.model.readers.mesh_files import hull_note, hull_of_loaded, mesh_path
from quasistatic_ref.model.urdf.urdf_file import FileMesh, UrdfFile
from quasistatic_ref.model.urdf.urdf_xml import xml_root
from quasistatic_ref.shapes.convex_mesh import ConvexMesh
from quasistatic_ref.shapes.placed_shape import PlacedShape, Shape
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.tolerances import LOADED


def resolved_text(file: UrdfFile, package_dirs: Sequence[str | Path]) -> str:
    """What pinocchio is given: the file's text without what the model ignores in its links.

    Visuals are left out, and so is <collision_checking>, by which pinocchio takes a shape for
    another than the one written. The URI of a collision mesh is replaced by the file that
    it means: pinocchio would read a relative path from the working folder, and follow any.

    Raises
    ------
    ModelError
        If a mesh is not to be found where it may be, or they are too large.
    """
    robot = xml_root(file.text)
    for link in robot.findall("link"):
        for ignored in [child for child in link if child.tag not in ("inertial", "collision")]:
            link.remove(ignored)
        for count, collision in enumerate(link.findall("collision")):
            for mesh in collision.findall("geometry/mesh"):
                with about_field(f"link[{link.get('name')}].collision[{count}].mesh.filename"):
                    uri = mesh.get("filename", "")
                    mesh.set("filename", str(mesh_path(uri, file.path.parent, package_dirs)))
    return tostring(robot, encoding="unicode")


def checked_shapes(
    file: UrdfFile,
    model: pin.Model,
    geometry: pin.GeometryModel,
    links: Sequence[str],
    frames: Sequence[int],
) -> tuple[tuple[PlacedShape, ...], tuple[str, ...]]:
    """Every collision shape in the frame of its link, as loaded; and notes on its meshes.

    Raises
    ------
    ModelError
        If shapes are missing, or differ from what the file says.
    """
    shapes = []
    notes = []
    every = [name for link in file.links.values() for name in (link.name, *link.named)]
    for number, (link, frame) in enumerate(zip(links, frames, strict=True)):
        collisions = file.links[link].collisions
        loaded = [shape for shape in geometry.geometryObjects if shape.parentFrame == frame]
        where = f"link[{link}].collision"
        if len(loaded) != len(collisions):
            capsules = any(type(shape).__name__ == "Capsule" for shape, _, _ in collisions)
            hint = '; <capsule> needs <robot version="1.1"> or 1.2' if capsules else ""
            problem = (
                f"only {len(loaded)} of its shapes were loaded, "
                f"for the reason printed on standard error{hint}"
            )
            raise ModelError(problem, field=where, value=len(collisions))
        for count, ((shape, R, t), of_pinocchio) in enumerate(zip(collisions, loaded, strict=True)):
            placement = model.frames[frame].placement.actInv(of_pinocchio.placement)
            same = same_pose(placement, R, t)
            solid = _solid(shape, of_pinocchio, f"{where}[{count}]") if same else None
            if solid is None:
                problem = "was not loaded as written"
                raise ModelError(problem, field=f"{where}[{count}]", value=shape)
            given_name = file.links[link].named[count]
            name = given_name if given_name and _usable(given_name, every) else f"{link}#{count}"
            if isinstance(solid, ConvexMesh):
                notes.append(hull_note(name, solid))
            shapes.append(
                PlacedShape(name, number, placement.rotation, placement.translation, solid)
            )
    return tuple(shapes), tuple(notes)


def _usable(name: str, every: Sequence[str | None]) -> bool:
    """Whether a collision's name means nothing else among the links and shapes of its file."""
    return every.count(name) == 1 and not any(c in "/#*?[" or c.isspace() for c in name)


def same_pose(placement: pin.SE3, R: Array, t: Array) -> bool:
    """Whether pinocchio's placement is that of a file, (3, 3) and (3,) [m], but for rounding."""
    off = np.abs(placement.translation - t).max() > LOADED * (1 + np.abs(t).max())
    return not (off or np.abs(placement.rotation - R).max() > LOADED)


def _solid(shape: Shape | FileMesh, given: pin.GeometryObject, where: str) -> Shape | None:
    """The shape, or None where another one was loaded."""
    if not isinstance(shape, FileMesh):
        same = (given.meshScale == 1).all() and given.geometry == shape.coal
        return shape if same else None
    if not hasattr(given.geometry, "tri_indices") or (given.meshScale != shape.scale).any():
        return None
    with about_field(f"{where}.mesh.vertices"):
        return hull_of_loaded(given.geometry)

"""The collision shapes of a URDF, each in the frame of its link; of a mesh its convex hull."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

import pinocchio as pin

from quasistatic_ref.errors import ModelError, about_field
from quasistatic_ref.files.mesh_files import hull_note, hull_of_loaded, loaded_mesh
from quasistatic_ref.files.urdf.file import FileMesh, UrdfFile
from quasistatic_ref.formats.together import once
from quasistatic_ref.shapes.placed_shape import PlacedShape


def placed_shapes(
    file: UrdfFile,
    links: Sequence[str],
    frames: Sequence[pin.SE3],
    package_dirs: Sequence[str | Path],
) -> tuple[tuple[PlacedShape, ...], tuple[str, ...]]:
    """Every collision shape in the frame of its link, and notes on its meshes.

    Parameters
    ----------
    file : UrdfFile
    links : sequence of str
    frames : sequence of pinocchio.SE3
        The frame of each link in that of the joint that moves it.
    package_dirs : sequence of str or Path

    Raises
    ------
    ModelError
        If a mesh cannot be read.
    """
    shapes = []
    notes = []
    names = [link.name for link in file.links.values()]
    names += [one.name for link in file.links.values() for one in link.collisions if one.name]
    for number, (link, frame) in enumerate(zip(links, frames, strict=True)):
        for count, written in enumerate(file.links[link].collisions):
            where = f"link[{link}].collision[{count}].mesh"
            shape = written.shape
            name = f"{link}#{count}"
            if written.name and _usable(written.name, names):
                name = written.name
            if isinstance(shape, FileMesh):
                with about_field(f"{where}.filename"):
                    path = file.mesh_path(shape.uri, package_dirs)
                with about_field(where):
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
            # There and back: with the last bits of runs that are recorded.
            placement = frame.actInv(frame * pin.SE3(written.R, written.t))
            shapes.append(
                PlacedShape(name, number, placement.rotation, placement.translation, shape)
            )
    return tuple(shapes), tuple(notes)


def _usable(name: str, every: Sequence[str]) -> bool:
    """Whether a collision's name means nothing else among the links and shapes of its file."""
    return every.count(name) == 1 and not any(c in "/#*?[" or c.isspace() for c in name)

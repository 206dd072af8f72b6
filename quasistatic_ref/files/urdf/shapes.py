"""The collision shapes of a URDF's links; of a mesh its convex hull."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

from quasistatic_ref.errors import ModelError, about_field
from quasistatic_ref.files.mesh_files import MissingMesh, hull_note, hull_of_loaded, loaded_mesh
from quasistatic_ref.files.trees import is_own_name
from quasistatic_ref.files.urdf.geometry import FileMesh, FileShape
from quasistatic_ref.model.tree import LinkShape
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.shapes.shape import Shape
from quasistatic_ref.text.together import once


class Collision(NamedTuple):
    """A collision element as written.

    Parameters
    ----------
    name : str or None
    where : str
        In messages.
    shape : FileShape
    R, t : ndarray, shapes (3, 3) and (3,)
        Its frame in the link's [-, m].
    """

    name: str | None
    where: str
    shape: FileShape
    R: Array
    t: Array


def link_shapes(
    collisions: Mapping[str, Sequence[Collision]],
    mesh_path: Callable[[str], Path],
    notes: list[str],
    missing: list[str] | None = None,
) -> dict[str, tuple[LinkShape, ...]]:
    """The shapes of each link.

    Parameters
    ----------
    collisions : mapping of str to sequence of Collision
        Those of each link.
    mesh_path : callable
        The file that a mesh's URI means.
    notes : list of str
        What becomes of meshes is added to it.
    missing : list of str, optional
        Why a mesh is not there is added to it, and its shape is left out; else it is refused.

    Raises
    ------
    ModelError
        If a mesh cannot be read.
    """
    labels = [one.name for of_link in collisions.values() for one in of_link if one.name]
    names = [*collisions, *labels]
    shapes: dict[str, tuple[LinkShape, ...]] = {}
    for link, of_link in collisions.items():
        shapes[link] = ()
        for number, one in enumerate(of_link):
            is_own = one.name is not None and is_own_name(one.name, names)
            name = str(one.name) if is_own else f"{link}#{number}"
            shape: Shape | None
            if isinstance(one.shape, FileMesh):
                try:
                    shape, note = _hull(name, one.where, one.shape, mesh_path)
                    notes.append(note)
                except MissingMesh as error:
                    if missing is None:
                        raise
                    missing.append(str(error))
                    continue
            else:
                shape = one.shape
            if shape is not None:
                shapes[link] += (LinkShape(name, shape, one.R, one.t),)
    return shapes


def _hull(
    name: str, where: str, written: FileMesh, mesh_path: Callable[[str], Path]
) -> tuple[Shape | None, str]:
    """The hull of a mesh, None where it has none, and what became of the mesh."""
    with about_field(f"{where}.mesh.filename"):
        path = mesh_path(written.uri)
    with about_field(f"{where}.mesh"):
        mesh = once(("mesh", path), partial(loaded_mesh, path))
    if not len(mesh.vertices):
        return None, f"{name}: left out, since {written.uri} is empty"
    key = ("hull", path, written.scale.tobytes())
    try:
        hull = once(key, partial(hull_of_loaded, mesh, written.scale))
    except ModelError:  # there are too few of them, or all lie in one plane
        return None, f"{name}: left out, since the hull of {written.uri} has no volume"
    return hull, hull_note(name, hull, mesh)

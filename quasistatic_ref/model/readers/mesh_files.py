"""Mesh files: which file a URI means, what it holds, and the convex hull of that."""

import importlib.util
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.shapes.convex_mesh import ConvexMesh, convex_hull, hull_of_mesh

MESHES = (".stl", ".obj", ".dae", ".ply", ".off", ".glb", ".gltf", ".3mf")
WITH_UNITS = (".dae", ".3mf")
"""Files that say in which unit their coordinates are; the others are in metres."""
PACKAGE = "package://"
LARGEST_MESH = 16 * 2**20
"""Largest mesh [bytes]."""


MOST_ABOVE = 8
"""Folders above a file in which its package is looked for, where no repository bounds them."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """What a mesh file holds, all of its objects where it places them.

    Parameters
    ----------
    vertices : ndarray, shape (V, 3)
        [m].
    triangles : ndarray of int, shape (T, 3)
        Numbers of their vertices; none in a file of points alone.
    """

    vertices: Array
    triangles: Indices


def mesh_path(uri: str, folder: Path, package_dirs: Sequence[str | Path] = ()) -> Path:
    """The file that a mesh's URI means.

    Parameters
    ----------
    uri : str
        ``package://NAME/PATH``, looked for as NAME/PATH in each of the package folders and in the
        folders above `folder`, up to that of its repository, then as PATH in those that are called
        NAME, then as PATH in each; or a path relative to `folder`.
    folder : Path
        Of the file that the URI stands in.
    package_dirs : sequence of str or Path

    Raises
    ------
    ModelError
        If there is no such file, its kind is unknown, or it lies neither in `folder` nor in
        a folder that it was looked for in after symbolic links are resolved: what is loaded is
        never a surprise. Or if it is too large.
    """
    if Path(uri).suffix.lower() not in MESHES:
        hint = suggestion(Path(uri).suffix.lower(), MESHES)
        raise ModelError(f"is not a known kind of mesh{hint}", value=uri)
    packages = [Path(folder_name) for folder_name in package_dirs]
    if uri.startswith(PACKAGE):
        inside = uri.removeprefix(PACKAGE).lstrip("/")
        name, _, below = inside.partition("/")
        above = _repository(folder.resolve())
        places = [package / inside for package in [*packages, *above]]
        places += [parent / below for parent in above if parent.name == name]
        places += [parent / below for parent in above]
        packages += above
    elif "://" in uri:
        raise ModelError("must be package://NAME/PATH or a relative path", value=uri)
    else:
        places = [folder / uri]
    try:
        path = next((place.resolve() for place in places if place.is_file()), None)
    except (OSError, ValueError, RuntimeError):  # a NUL, a name too long, a ring of links
        path = None
    if path is None:
        where = ", ".join(str(package) for package in packages) or str(folder.resolve())
        hint = "; --root FOLDER names another" if uri.startswith(PACKAGE) else ""
        raise ModelError(f"no such file (looked for in {where}{hint})", value=uri)
    if not any(path.is_relative_to(allowed.resolve()) for allowed in [folder, *packages]):
        problem = (
            f"leads to {path}, outside the folder of this file and of package_dirs; "
            "move the mesh, or name its folder: --root FOLDER, or package_dirs of the body"
        )
        raise ModelError(problem, value=uri)
    size = path.stat().st_size
    if size > LARGEST_MESH:
        problem = f"is larger than {LARGEST_MESH / 2**20:g} MiB; take a simpler mesh"
        raise ModelError(problem, value=uri)
    return path


def _repository(folder: Path) -> list[Path]:
    """A folder and those above it, up to that of its repository, but for the root of all."""
    above = [folder, *folder.parents][:MOST_ABOVE]
    above = [each for each in above if each != each.parent]
    top = [i for i, each in enumerate(above) if (each / ".git").exists()]
    return above[: top[0] + 1] if top else above


def loaded_mesh(path: Path, *, finite: bool = True) -> Mesh:
    """What a mesh file holds, as trimesh reads it.

    Every object stands where the nodes of the file place it, in metres. A COLLADA file's ``Y_UP``
    is not applied, as pinocchio, MuJoCo and Drake do not apply it to a link's mesh. Without
    `finite`, vertices may be NaN or infinite.

    Raises
    ------
    ModelError
        If the file cannot be read, or a coordinate in it is not finite.
    """
    import trimesh  # takes as long as a short run

    with about_file(path):
        if path.suffix.lower() == ".dae" and importlib.util.find_spec("collada") is None:
            raise ModelError("needs pycollada: pip install 'quasistatic-ref[dae]'")
        try:
            with warnings.catch_warnings(), np.errstate(all="ignore"):
                warnings.simplefilter("ignore")  # each file that is not usable ends in an error
                if path.suffix.lower() == ".dae":
                    _check_collada(path)
                scene = trimesh.load_scene(
                    path, process=False, maintain_order=True, skip_materials=True
                )
                mesh = _joined(scene.dump())
        except Exception as error:
            # Each format's reader raises its own kinds of errors.
            reason = " ".join(str(error).split()) or type(error).__name__
            raise ModelError(f"cannot be read as a mesh: {reason}") from None
        numbers = mesh.triangles
        if numbers.min(initial=0) < 0 or numbers.max(initial=-1) >= len(mesh.vertices):
            raise ModelError("must be numbers of vertices", field="triangles")
        if path.suffix.lower() in WITH_UNITS and scene.units is not None:
            metres = trimesh.units.unit_conversion(scene.units, "meters")
            mesh = replace(mesh, vertices=metres * mesh.vertices)
        if finite and not np.isfinite(mesh.vertices).all():
            raise ModelError("must be finite numbers", field="vertices")
        return mesh


def _check_collada(path: Path) -> None:
    """An error of pycollada's where a geometry is malformed, which trimesh leaves out."""
    from collada import Collada
    from collada.common import DaeBrokenRefError, DaeUnsupportedError

    Collada(str(path), ignore=[DaeUnsupportedError, DaeBrokenRefError])  # such as of images


def _joined(placed: Sequence[Any]) -> Mesh:
    """All objects as one; lines have no vertices that count."""
    vertices = [np.zeros((0, 3))]
    triangles = [np.zeros((0, 3), dtype=np.int64)]
    count = 0
    for part in placed:
        if type(part).__name__ not in ("Trimesh", "PointCloud"):
            continue
        faces = np.asarray(getattr(part, "faces", ()), dtype=np.int64).reshape(-1, 3)
        triangles.append(faces + count)
        vertices.append(np.asarray(part.vertices, dtype=np.float64).reshape(-1, 3))
        count += len(part.vertices)
    return Mesh(np.concatenate(vertices), np.concatenate(triangles))


def mesh_hull(path: Path, scale: Array) -> ConvexMesh:
    """Convex hull of a mesh file, each coordinate multiplied by its scale, shape (3,) [-].

    Raises
    ------
    ModelError
        If the file cannot be read, or its vertices have no volume.
    """
    with about_file(path):
        return hull_of_loaded(loaded_mesh(path), scale)


def hull_of_loaded(mesh: Mesh, scale: Array) -> ConvexMesh:
    """Convex hull of all vertices, times `scale`, (3,) [-]; points alone are their own hull.

    Raises
    ------
    ModelError
        If there are fewer than four, or they have no volume.
    """
    if not len(mesh.vertices):
        raise ModelError("is empty: the mesh has no vertices", field="vertices")
    if len(mesh.vertices) < 4:
        raise ModelError("must be at least four", field="vertices", value=len(mesh.vertices))
    if not len(mesh.triangles):
        return convex_hull(np.unique(mesh.vertices * scale, axis=0))
    return hull_of_mesh(mesh.vertices * scale, mesh.triangles)


def hull_note(name: str, hull: ConvexMesh, mesh: Mesh) -> str:
    """What became of a mesh, as one line."""
    corners = f"{len(hull.vertices)} corners"
    if not len(mesh.triangles):
        return f"{name}: a mesh of points alone, whose convex hull is taken, {corners}"
    if hull.is_convex:
        return f"{name}: convex mesh, {corners}"
    more = 100 * hull.excess
    return (
        f"{name}: mesh replaced by its convex hull, {corners}; "
        f"it is not convex (by {more:.2g} %), so a contact with it must say hull = true"
    )

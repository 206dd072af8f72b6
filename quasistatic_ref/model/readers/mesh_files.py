"""Mesh files: which file a URI means, and the convex hull of what it holds."""

from collections.abc import Callable, Sequence
from pathlib import Path

import coal
import numpy as np

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.parts import Slot
from quasistatic_ref.shapes.convex_mesh import ConvexMesh, hull_of_mesh
from quasistatic_ref.step.arrays import Array, Indices

MESHES = (".stl", ".obj", ".dae")
PACKAGE = "package://"
CHECK_DAE: Slot[Callable[[Path], None]] = Slot("readers.dae")
LARGEST_MESH = 16 * 2**20
"""Largest mesh [bytes]."""


def mesh_path(uri: str, folder: Path, package_dirs: Sequence[str | Path] = ()) -> Path:
    """The file that a mesh's URI means.

    Parameters
    ----------
    uri : str
        ``package://NAME/PATH``, looked for as NAME/PATH in each of the package folders, or a
        path relative to `folder`.
    folder : Path
        Of the file that the URI stands in.
    package_dirs : sequence of str or Path

    Raises
    ------
    ModelError
        If there is no such file, its kind is unknown, or it lies neither in `folder` nor in one of
        the package folders after symbolic links are resolved: what is loaded is never a surprise.
        Or if it is too large, alone or with what is read together with it, or a COLLADA file that
        would take a mesh library's memory.
    """
    if Path(uri).suffix.lower() not in MESHES:
        hint = suggestion(Path(uri).suffix.lower(), MESHES)
        raise ModelError(f"is not a known kind of mesh{hint}", value=uri)
    packages = [Path(given) for given in package_dirs]
    if uri.startswith(PACKAGE):
        if not packages:
            problem = "needs package_dirs (--root FOLDER), which contain package:// files"
            raise ModelError(problem, value=uri)
        inside = uri.removeprefix(PACKAGE).lstrip("/")
        places = [package / inside for package in packages]
    elif "://" in uri:
        raise ModelError("must be package://NAME/PATH or a relative path", value=uri)
    else:
        places = [folder / uri]
    try:
        path = next((place.resolve() for place in places if place.is_file()), None)
    except (OSError, ValueError, RuntimeError):  # a NUL, a name too long, a ring of links
        path = None
    if path is None:
        where = ", ".join(str(package) for package in packages) or str(folder)
        raise ModelError(f"no such file (looked for in {where})", value=uri)
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
    if path.suffix.lower() == ".dae":
        CHECK_DAE.needed("a .dae mesh")(path)
    return path


def mesh_hull(path: Path, scale: Array) -> ConvexMesh:
    """Convex hull of a mesh file, each coordinate multiplied by its scale, shape (3,) [-].

    Raises
    ------
    ModelError
        If coal cannot read the file, or its vertices have no volume.
    """
    with about_file(path):
        return hull_of_loaded(loaded_mesh(path, scale))


def loaded_mesh(path: Path, scale: Array) -> coal.BVHModelBase:
    """A mesh file as coal loads it, coordinates times `scale`, (3,) [-]; or ModelError."""
    try:
        return coal.MeshLoader().load(str(path), scale)
    except (ValueError, RuntimeError) as error:
        lines = [line.strip() for line in str(error).splitlines() if line.strip()]
        reason = lines[-2] if len(lines) > 1 else "".join(lines)
        raise ModelError(f"cannot be read as a mesh: {reason}", file=path) from None


def triangles_of(geometry: coal.BVHModelBase) -> Indices:
    """Numbers of the vertices of its triangles, shape (T, 3)."""
    corners = (geometry.tri_indices(i) for i in range(geometry.num_tris))
    return np.array([(c[0], c[1], c[2]) for c in corners], dtype=np.int64)


def hull_of_loaded(geometry: coal.BVHModelBase) -> ConvexMesh:
    """Convex hull of a mesh as coal loaded it; ModelError if it is too small."""
    if geometry.num_vertices < 4 or geometry.num_tris < 1:
        problem = "must be at least four, with at least one triangle"
        raise ModelError(problem, field="vertices", value=int(geometry.num_vertices))
    return hull_of_mesh(np.array(geometry.vertices()), triangles_of(geometry))


def hull_note(name: str, mesh: ConvexMesh) -> str:
    """What became of a mesh, as one line."""
    if mesh.is_convex:
        return f"{name}: convex mesh, {len(mesh.vertices)} corners"
    more = 100 * mesh.excess
    return (
        f"{name}: mesh replaced by its convex hull, {len(mesh.vertices)} corners; "
        f"it is not convex (by {more:.2g} %), so a contact with it must say hull = true"
    )

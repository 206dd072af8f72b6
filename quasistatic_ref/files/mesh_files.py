"""Mesh files: which file a URI means, what it holds, and the convex hull of that."""

import shlex
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.files.mesh import Mesh
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.parts import part
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.shapes.convex_mesh import ConvexMesh, convex_hull, hull_of_mesh

FileMesh = Callable[[Path, str], Mesh]
"""A file and its extension, as ``.stl`` -> what it holds."""
MESHES = (".stl", ".obj", ".off", ".ply", ".gltf", ".glb", ".dae")
"""Extensions of files that ``optional/mesh_formats`` reads."""
PACKAGE = "package://"
MODEL = "model://"
"""Gazebo's word for a package, which URDFs of iCubs have."""
FILE = "file://"
LARGEST_MESH = 16 * 2**20
"""Largest mesh [bytes]."""


MOST_ABOVE = 8
"""Folders above a file in which its package is looked for, where no repository bounds them."""


class MissingMesh(ModelError):
    """A mesh that a file names is not there."""


def mesh_path(
    uri: str, folder: Path, package_dirs: Sequence[str | Path] = (), *, is_of_file: bool = True
) -> Path:
    """The file that a mesh's URI means.

    Parameters
    ----------
    uri : str
        ``package://NAME/PATH``, or ``model://NAME/PATH``, looked for as NAME/PATH in each of the
        package folders and in the folders above `folder`, up to that of its repository, then as
        PATH in those that are called NAME, then as PATH in each; or a path relative to `folder`,
        with ``file://`` before it or without, which is also looked for in the package folders, as
        pinocchio does, and in the folder above.
    folder : Path
        Of the file that the URI stands in.
    package_dirs : sequence of str or Path
        Where a mesh is looked for, and where it may lie.
    is_of_file : bool
        False of a text, which has no folder of its own.

    Raises
    ------
    MissingMesh
        If there is no such file.
    ModelError
        If its kind is unknown, it is too large, or it lies, once symbolic links are resolved,
        neither in `folder`, in a package folder nor in one of :func:`readable_folders`: what is
        loaded is never a surprise.
    """
    if Path(uri).suffix.lower() not in MESHES:
        hint = suggestion(Path(uri).suffix.lower(), MESHES)
        raise ModelError(f"is not a known kind of mesh{hint}", value=uri)
    packages = [Path(folder_name) for folder_name in package_dirs]
    allowed = [folder, *packages]
    is_of_package = uri.startswith((PACKAGE, MODEL))
    if is_of_package:
        inside = uri.removeprefix(PACKAGE).removeprefix(MODEL).lstrip("/")
        name, _, below = inside.partition("/")
        above = _repository(folder.resolve())
        places = [package / inside for package in [*packages, *above]]
        places += [parent / below for parent in above if parent.name == name]
        places += [parent / below for parent in above]
        packages += above
        allowed += folders_of_package(name, folder.resolve())
    elif "://" in uri.removeprefix(FILE):
        raise ModelError(
            "must be package://NAME/PATH, model://NAME/PATH or a relative path", value=uri
        )
    else:
        relative = uri.removeprefix(FILE)
        places = [package / relative for package in [folder, *packages]]
        if is_of_file:
            places.append(folder.resolve().parent / relative)
            allowed += readable_folders(relative, folder.resolve())
    try:
        path = next((place.resolve() for place in places if place.is_file()), None)
    except (OSError, ValueError, RuntimeError):  # a NUL, a name too long, a ring of links
        path = None
    if path is None:
        where = ", ".join(str(package) for package in packages) or str(folder.resolve())
        remedy = "put the mesh there, or write its path from there"
        if is_of_package:
            remedy = "--root FOLDER names another"
        raise MissingMesh(f"no such file (looked for in {where}; {remedy})", value=uri)
    if not any(path.is_relative_to(each.resolve()) for each in allowed):
        problem = (
            f"leads to {path}, outside the folder of this file and of package_dirs; move the "
            f"mesh, or name its folder: {root_option(uri, path)}, or package_dirs of the body"
        )
        raise ModelError(problem, value=uri)
    size = path.stat().st_size
    if size > LARGEST_MESH:
        problem = f"is larger than {LARGEST_MESH / 2**20:g} MiB; take a simpler mesh"
        raise ModelError(problem, value=uri)
    return path


def readable_folders(uri: str, folder: Path) -> list[Path]:
    """Where a relative URI of a file may lead besides its `folder`, an absolute path.

    It is the package of that, or its repository; and the folder beside it that the URI names, as
    ../NAME/ or, from the folder above, as NAME/.
    """
    match Path(uri).parts:
        case ("..", name, *_, _) | (name, *_, _):
            return _packages(folder) + _beside(folder, name)
    return _packages(folder)


def folders_of_package(name: str, folder: Path) -> list[Path]:
    """Where ``package://NAME/...`` of a file may lead besides its `folder`, an absolute path.

    It is the package of that, or its repository; the folder above, if that is called NAME; and NAME
    beside one of these.
    """
    packages = _packages(folder)
    above = [folder.parent] if folder.parent.name == name else []
    return packages + above + [b for each in [folder, *packages] for b in _beside(each, name)]


def _packages(folder: Path) -> list[Path]:
    """Of a folder and those above it: the packages (``package.xml``), and the repository."""
    marks = ("package.xml", ".git")
    return [each for each in _repository(folder) if any((each / mark).exists() for mark in marks)]


def _beside(folder: Path, name: str) -> list[Path]:
    """The folder of a name beside another; none if it is a link, or the name leads elsewhere."""
    beside = folder.parent / name
    leads_elsewhere = Path(name).name != name or name in ("", "..")  # as "." and "/" do
    return [] if leads_elsewhere or beside.is_symlink() else [beside]


def root_option(uri: str, path: Path) -> str:
    """The option ``--root FOLDER`` for the command line with which a URI leads to a path."""
    below = [part for part in Path(uri).parts if part != ".."]
    inside = not Path(uri).is_absolute() and path.parts[-len(below) :] == tuple(below)
    folder = path.parents[max(len(below) - 2, 0)] if inside else path.parent
    return f"--root {shlex.quote(str(folder))}"


def _repository(folder: Path) -> list[Path]:
    """A folder and those above it, up to that of its repository, but for the root of all."""
    above = [folder, *folder.parents][:MOST_ABOVE]
    above = [each for each in above if each != each.parent]
    top = [i for i, each in enumerate(above) if (each / ".git").exists()]
    return above[: top[0] + 1] if top else above


def loaded_mesh(path: Path, *, finite: bool = True) -> Mesh:
    """What a mesh file holds.

    Every object stands where the nodes of the file place it, in metres. A COLLADA file's ``Y_UP``
    is not applied, as pinocchio, MuJoCo and Drake do not apply it to a link's mesh, nor that of
    glTF. Vertices that are NaN are left out where no triangle uses them; without `finite`, vertices
    are as in the file, NaN or infinite.

    Raises
    ------
    ModelError
        If the file cannot be read, a count in it is not that of what it holds, or a coordinate is
        infinite, or NaN and of a triangle.
    """
    with about_file(path):
        kind = path.suffix.lower()
        file_mesh: FileMesh = part("file_mesh", f"a {kind} mesh")
        mesh = file_mesh(path, kind)
        return mesh.seen() if finite else mesh


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
    """Convex hull of the corners of all triangles, times `scale`, (3,) [-], or of points alone.

    Raises
    ------
    ModelError
        If there are fewer than four, or they have no volume.
    """
    corners = mesh.corners
    if not len(corners):
        raise ModelError("is empty: the mesh has no vertices", field="vertices")
    if len(corners) < 4:
        raise ModelError("must be at least four", field="vertices", value=len(corners))
    if not len(mesh.triangles):
        return convex_hull(np.unique(corners * scale, axis=0))
    numbers = np.unique(mesh.triangles, return_inverse=True)[1].reshape(-1, 3)
    return hull_of_mesh(corners * scale, numbers)


def hull_note(name: str, hull: ConvexMesh, mesh: Mesh) -> str:
    """What became of a mesh, as one line."""
    unused = len(mesh.vertices) - len(mesh.corners)
    more = f"; vertices that no triangle uses are left out: {unused}" if unused else ""
    more += f"; {mesh.note}" if mesh.note else ""
    if not len(mesh.triangles):
        corners = f"{len(hull.vertices)} corners"
        return f"{name}: a mesh of points alone, whose convex hull is taken, {corners}{more}"
    return hull_words(name, hull) + more


def hull_words(name: str, hull: ConvexMesh) -> str:
    """What became of a mesh with triangles, as one line."""
    corners = f"{len(hull.vertices)} corners"
    if hull.is_convex:
        return f"{name}: convex mesh, {corners}"
    percent = 100 * hull.excess
    return (
        f"{name}: mesh replaced by its convex hull, {corners}; it is not convex "
        f"(by {percent:.2g} %), so a contact with it must say hull = true"
    )

"""Point clouds from files: texts of columns, vertices of meshes, PCD, npy and npz.

Positions only; colours, normals and faces are not part of the model. Coordinates are taken as
written, in metres. A line or a vertex that cannot be read is an error; only what is NaN, as pixels
that a camera did not see are, is left out.
"""

import re
from array import array
from collections.abc import Callable
from pathlib import Path

import numpy as np

from quasistatic_ref.errors import InputError, ModelError, about_field, about_file
from quasistatic_ref.files.content import text_read
from quasistatic_ref.files.mesh_files import loaded_mesh
from quasistatic_ref.files.text import check_equal, check_points, number_or_nan, point_lines
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.parts import part
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.text.quoting import suggestion
from quasistatic_ref.tolerances import LARGE

FilePoints = Callable[[Path], Array]
"""A file -> its points, shape (N, 3) [m]."""
SEPARATOR = re.compile(r"\s*[,;]\s*|\s+")


def point_cloud(path: str | Path) -> PointCloud:
    """Point cloud read from a file, by its extension.

    Parameters
    ----------
    path : str or Path
        ``.xyz``, ``.csv``, ``.txt``, ``.pts``: three numbers a line, and further columns, separated
        by spaces, commas, semicolons or tabs; ``#`` starts a comment. A header may name columns x,
        y and z among others; a first line of one whole number is the number of points.
        ``.ply``, ``.off``, ``.obj``: the vertices. ``.pcd``: the fields x, y and z, with pypcd4.
        ``.npy``: an array of shape (N, 3); ``.npz``: its one array, or the one named ``points``.

    Returns
    -------
    PointCloud
        Points in file order, shape (N, 3) [m]; a repeated one counts once. Points that are not
        numbers, which depth cameras did not see, are left out.

    Raises
    ------
    ModelError
        If the extension is unknown, or the file is missing, empty or malformed; it names the
        file, the line or vertex, and the value.
    """
    return PointCloud(seen_points(path)[0])


def seen_points(path: str | Path) -> tuple[Array, int]:
    """The points of a file, shape (N, 3) [m], and how many are left out since they are NaN.

    Raises
    ------
    ModelError
        As of :func:`point_cloud`.
    """
    path = Path(path)
    kind = path.suffix.lower()
    if kind not in KINDS:
        problem = f"is not a known kind of point cloud{suggestion(kind, KINDS)}"
        raise ModelError(problem, file=path, field="extension", value=path.suffix)
    try:
        with about_file(path):
            points = _points(path, kind)
            seen = np.asarray(~np.isnan(points).any(axis=1))
            if not seen.any():
                raise ModelError("must contain at least one point", field="points")
            _check(points, seen)
            return points[seen], int(np.count_nonzero(~seen))
    except InputError as error:  # NumPy's files raise others
        raise ModelError(
            error.problem, field=error.field, value=error.value, file=error.file
        ) from None


def _check(points: Array, seen: Mask) -> None:
    for wrong, problem in (
        (np.isinf(points), "must be finite numbers"),
        (np.abs(points) > LARGE, f"its coordinates must be at most {LARGE:g} m"),
    ):
        bad = np.flatnonzero(wrong.any(axis=1) & seen)
        if bad.size:
            value = points[bad[0]].tolist()
            raise ModelError(problem, field=f"point {bad[0]}", value=value)


def _of_text(path: Path) -> Array:
    """Points of a text of columns."""
    columns = [0, 1, 2]
    width = stated = None
    numbers = array("d")
    points: Array | None = None
    lines = point_lines(text_read(path, ModelError))
    for number, line in enumerate(lines, start=1):
        text = line.split("#", 1)[0].strip()
        words = [word.strip().strip('"') for word in SEPARATOR.split(text)]
        if not text:
            continue
        if width is None and stated is None and len(words) == 1 and words[0].isdecimal():
            stated = int(words[0])
            continue
        if width is None:
            width = len(words)
            header = [word.lower() for word in words]
            if any(name in header for name in "xyz"):
                columns = [_column(header, name, number) for name in "xyz"]
                continue
        if len(words) < 3:
            problem = "must be three numbers, x y z"
            raise ModelError(problem, field=f"line {number}", value=line)
        if not numbers and (table := _table(lines[number - 1 :], text)) is not None:
            points = table[:, columns]
            break
        if len(words) != width:
            raise ModelError(f"must have {width} columns", field=f"line {number}", value=line)
        with about_field(f"line {number}"):
            numbers.extend(number_or_nan(words[c]) for c in columns)
    if points is None:
        points = np.array(numbers).reshape(-1, 3)
    check_points(len(points))
    check_equal("points", len(points), len(points) if stated is None else stated)
    return points


def _table(lines: list[str], first: str) -> Array | None:
    """Numbers in equal columns, which NumPy reads at once; None where a line is something else."""
    separator = next((mark for mark in ",;" if mark in first), None)
    try:
        table = np.loadtxt(lines, delimiter=separator, ndmin=2)
    except ValueError:
        return None
    return None if np.isinf(table).any() else table


def _column(header: list[str], name: str, number: int) -> int:
    if header.count(name) != 1:
        problem = f"must name the column {name} once"
        raise ModelError(problem, field=f"line {number}", value=",".join(header))
    return header.index(name)


def _of_mesh(path: Path) -> Array:
    """Vertices of a mesh file."""
    points = loaded_mesh(path, finite=False).vertices
    check_points(len(points))
    return points


TEXTS = (".xyz", ".csv", ".txt", ".pts")
"""Extensions of texts of columns."""
VERTICES = (".off", ".obj")
"""Extensions of files whose vertices are taken."""
OF_PART = (".ply", ".pcd", ".npy", ".npz")
"""Extensions of files that ``optional/mesh_formats`` reads."""
KINDS = (*TEXTS, *VERTICES, *OF_PART)


def _points(path: Path, kind: str) -> Array:
    if kind in TEXTS:
        return _of_text(path)
    if kind in VERTICES:
        return _of_mesh(path)
    file_points: FilePoints = part("file_points", f"a {kind} cloud")
    return file_points(path)

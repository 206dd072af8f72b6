"""Point clouds from files: texts of columns, vertices of meshes, PCD, npy and npz.

Positions only; colours, normals and faces are not part of the model. Coordinates are taken as
written. A line or a vertex that cannot be read is an error; only what is NaN, as pixels
that a camera did not see are, is left out.
"""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from quasistatic_ref.errors import InputError, ModelError, about_file
from quasistatic_ref.files.mesh_files import loaded_mesh
from quasistatic_ref.files.point_text import text_points
from quasistatic_ref.files.text import check_points
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.parts import part
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.text.content import text_read
from quasistatic_ref.tolerances import LARGE

FilePoints = Callable[[Path], Array]
"""A file -> its points, shape (N, 3) [m]."""


class SeenPoints(NamedTuple):
    """The points of a file.

    Parameters
    ----------
    points : ndarray, shape (N, 3)
        [`unit`; metres where the file states none].
    unseen : int
        How many are left out since they are NaN.
    unit : str or None
        That the names of their columns state, ``m`` or another.
    """

    points: Array
    unseen: int
    unit: str | None


def point_cloud(path: str | Path) -> PointCloud:
    """Point cloud read from a file, by its extension.

    Parameters
    ----------
    path : str or Path
        ``.xyz``, ``.csv``, ``.txt``, ``.pts``: three numbers a line, and further columns, separated
        by spaces and tabs, commas or semicolons; ``#`` starts a comment. A header, separated as
        the lines are, may name columns x, y and z among others, as ``X [m]`` with their unit; a
        first line of one whole number is the number of points.
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
        If the extension is unknown, or the file is missing, empty or malformed, leaves open
        which columns are x, y and z, or names another unit than metres; it names the file, the
        line or vertex, and the value.
    """
    seen = seen_points(path)
    if seen.unit not in (None, "m"):
        problem = "must be metres; `quasistatic-ref body FILE` makes a body in metres of it"
        raise ModelError(problem, file=path, field="unit", value=seen.unit)
    return PointCloud(seen.points)


def seen_points(path: str | Path) -> SeenPoints:
    """The points of a file, without those that are NaN.

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
            points, unit = _points(path, kind)
            seen = np.asarray(~np.isnan(points).any(axis=1))
            if not seen.any():
                raise ModelError("must contain at least one point", field="points")
            _check(points, seen)
            return SeenPoints(points[seen], int(np.count_nonzero(~seen)), unit)
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


def _points(path: Path, kind: str) -> tuple[Array, str | None]:
    if kind in TEXTS:
        return text_points(text_read(path, ModelError))
    if kind in VERTICES:
        return _of_mesh(path), None
    file_points: FilePoints = part("file_points", f"a {kind} cloud")
    return file_points(path), None

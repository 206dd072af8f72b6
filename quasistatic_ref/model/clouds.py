"""Point clouds from files: xyz, csv, ply and pcd (ascii and binary), obj, npy and npz.

Positions only; colours, normals and faces are not part of the model. Coordinates are taken as
written, in metres. A line or a vertex that cannot be read is an error, never left out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import InputError, ModelError, suggestion
from quasistatic_ref.files import bytes_read, text_of
from quasistatic_ref.model.pcd import pcd_points
from quasistatic_ref.model.ply import ply_points
from quasistatic_ref.model.shapes import PointCloud
from quasistatic_ref.model.text import decimal
from quasistatic_ref.npz import npy_array, npz_arrays
from quasistatic_ref.tolerances import LARGE


def point_cloud(path: str | Path) -> PointCloud:
    """Point cloud read from a file, by its extension.

    Parameters
    ----------
    path : str or Path
        ``.xyz``: three numbers a line, separated by spaces, ``#`` starts a comment.
        ``.csv``: three columns, or a header that names columns x, y and z among others.
        ``.ply``: the element ``vertex``. ``.obj``: the lines ``v``. ``.pcd``: the fields x, y and
        z. ``.npy``: an array of shape (N, 3); ``.npz``: its one array, or the one named ``points``.

    Returns
    -------
    PointCloud
        Points in file order, shape (N, 3) [m].

    Raises
    ------
    ModelError
        If the extension is unknown, or the file is missing, empty or malformed; it names the
        file, the line or vertex, and the value.
    """
    path = Path(path)
    points_of = _READERS.get(path.suffix.lower())
    if points_of is None:
        problem = f"is not a known kind of point cloud{suggestion(path.suffix.lower(), _READERS)}"
        raise ModelError(problem, file=path, field="extension", value=path.suffix)
    content = bytes_read(path, ModelError)
    try:
        points = np.array(points_of(content, path), dtype=np.float64).reshape(-1, 3)
        _check_size(points)
        return PointCloud(points)
    except ModelError as error:
        raise error.in_file(path) from None
    except InputError as error:  # of NumPy's files
        raise ModelError(
            error.problem, field=error.field, value=error.value, file=error.file or path
        ) from None


def _check_size(points: NDArray[np.float64]) -> None:
    far = np.flatnonzero((np.abs(points) > LARGE).any(axis=1))
    if far.size:
        problem = f"its coordinates must be at most {LARGE:g} m"
        raise ModelError(problem, field=f"point {far[0]}", value=points[far[0]].tolist())


def _xyz(content: bytes, path: Path) -> list[list[float]]:
    points = []
    for number, line in enumerate(text_of(content, path, ModelError).splitlines(), start=1):
        words = line.split("#", 1)[0].split()
        if words:
            points.append(_point(words, number))
    return points


def _csv(content: bytes, path: Path) -> list[list[float]]:
    points: list[list[float]] = []
    columns: list[int] | None = None
    width = 3
    for number, line in enumerate(text_of(content, path, ModelError).splitlines(), start=1):
        words = [word.strip().strip('"') for word in line.split(",")]
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        if columns is None:
            columns = [0, 1, 2]
            header = [word.lower() for word in words]
            if any(name in header for name in "xyz"):
                columns, width = [_column(header, name, number) for name in "xyz"], len(words)
                continue
        if len(words) != width:
            raise ModelError(f"must have {width} columns", field=f"line {number}", value=line)
        points.append(_point([words[c] for c in columns], number))
    return points


def _column(header: list[str], name: str, number: int) -> int:
    if header.count(name) != 1:
        problem = f"must name the column {name} once"
        raise ModelError(problem, field=f"line {number}", value=",".join(header))
    return header.index(name)


def _obj(content: bytes, path: Path) -> list[list[float]]:
    points = []
    for number, line in enumerate(text_of(content, path, ModelError).splitlines(), start=1):
        words = line.split("#", 1)[0].split()
        if words and words[0] == "v":
            # A vertex may carry a weight or a colour after its position.
            if len(words) not in (4, 5, 7, 8):
                raise ModelError("must be v x y z", field=f"line {number}", value=line)
            points.append(_point(words[1:4], number))
    return points


def _ply(content: bytes, path: Path) -> NDArray[np.float64]:
    return ply_points(content)


def _pcd(content: bytes, path: Path) -> NDArray[np.float64]:
    return pcd_points(content)


def _npy(content: bytes, path: Path) -> NDArray[np.float64]:
    return _numbers(npy_array(path), "its array")


def _npz(content: bytes, path: Path) -> NDArray[np.float64]:
    arrays = npz_arrays(path, "a file of NumPy's arrays")
    name = "points" if "points" in arrays else next(iter(arrays), "")
    if name != "points" and len(arrays) != 1:
        problem = "must hold one array, or one that is named points"
        raise ModelError(problem, field="its arrays", value=list(arrays))
    return _numbers(arrays[name], name)


def _numbers(array: NDArray[Any], name: str) -> NDArray[np.float64]:
    if array.dtype.kind not in "fiu" or array.ndim != 2 or array.shape[1] != 3:
        given = f"{array.dtype} of shape {array.shape}"
        raise ModelError("must hold numbers of shape (N, 3)", field=name, value=given)
    points = array.astype(np.float64)
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if bad.size:
        value = points[bad[0]].tolist()
        raise ModelError("must be finite numbers", field=f"point {bad[0]}", value=value)
    return points


def _point(words: Sequence[str], number: int) -> list[float]:
    if len(words) != 3:
        problem = "must be three numbers, x y z"
        raise ModelError(problem, field=f"line {number}", value=" ".join(words))
    try:
        return [decimal(word) for word in words]
    except ModelError as error:
        error.field = f"line {number}"
        raise


_Reader = Callable[[bytes, Path], list[list[float]] | NDArray[np.float64]]
_READERS: dict[str, _Reader] = {
    ".xyz": _xyz, ".csv": _csv, ".ply": _ply, ".obj": _obj, ".pcd": _pcd, ".npy": _npy,
    ".npz": _npz,
}  # fmt: skip

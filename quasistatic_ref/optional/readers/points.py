"""Points of clouds in further formats, by the extensions of their files."""

import io
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.formats.files import bytes_read
from quasistatic_ref.formats.npz import array_of, npz_arrays, readable
from quasistatic_ref.model.readers.mesh_files import loaded_mesh
from quasistatic_ref.model.readers.text import check_points
from quasistatic_ref.optional.readers.pcd import pcd_points
from quasistatic_ref.optional.readers.ply import ply_points
from quasistatic_ref.optional.readers.point_table import LARGEST_HEADER
from quasistatic_ref.parts import needed_package
from quasistatic_ref.step.arrays import Array


def _ply(path: Path) -> Array:
    content = bytes_read(path, ModelError)
    points = ply_points(content)
    if points is None:
        points = loaded_mesh(path, finite=False).vertices
        check_points(len(points), "points")
        count = re.search(rb"^element\s+vertex\s+(\d+)", content[:LARGEST_HEADER], re.MULTILINE)
        if count is None or int(count[1]) != len(points):
            problem = f"must contain {int(count[1]) if count else 'some'} vertices"
            raise ModelError(problem, field="body", value=len(points))
    return points


def _las(path: Path) -> Array:
    laspy = needed_package("laspy", "las", "a .las cloud")
    with about_file(path):
        try:
            with laspy.open(path) as reader:
                check_points(reader.header.point_count, "points")
                points = reader.read().xyz
        except (laspy.errors.LaspyException, ValueError, OSError, OverflowError) as error:
            raise ModelError(f"cannot be read as LAS: {error}") from None
    return np.asarray(points, dtype=np.float64)


def _npz(path: Path) -> Array:
    arrays = npz_arrays(path, "a file of NumPy's arrays")
    name = "points" if "points" in arrays else next(iter(arrays), "")
    if name != "points" and len(arrays) != 1:
        problem = "must contain one array, or one that is named points"
        raise ModelError(problem, field="its arrays", value=list(arrays))
    return _of_array(arrays[name], name)


def _npy(path: Path) -> Array:
    with readable(path, "is not an array of NumPy"):
        content = bytes_read(path)
        array = array_of(io.BytesIO(content), len(content), "it")
    return _of_array(array, "its array")


def _of_array(array: NDArray[Any], name: str) -> Array:
    if array.dtype.kind not in "fiu" or array.ndim != 2 or array.shape[1] != 3:
        given = f"{array.dtype} of shape {array.shape}"
        raise ModelError("must contain numbers of shape (N, 3)", field=name, value=given)
    check_points(len(array), "points")
    return array.astype(np.float64)


POINTS: Final[dict[str, Callable[[Path], Array]]] = {
    ".ply": _ply,
    ".pcd": lambda path: pcd_points(bytes_read(path, ModelError)),
    ".las": _las,
    ".npy": _npy,
    ".npz": _npz,
}
"""Extension -> the points of such a file, shape (N, 3) [m]."""

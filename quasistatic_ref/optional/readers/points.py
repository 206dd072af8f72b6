"""Points of clouds in further formats, each by a library: trimesh, pypcd4, laspy."""

import io
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import InputError, ModelError, about_file
from quasistatic_ref.formats.files import bytes_read
from quasistatic_ref.formats.npz import array_of, npz_arrays, readable
from quasistatic_ref.model.readers.mesh_files import loaded_mesh
from quasistatic_ref.model.readers.text import check_points
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.parts import needed_package

LARGEST_HEADER = 2**20
"""Bytes in which the number of a file's points must stand."""


def file_points(path: Path) -> Array:
    """The points of a file of one of the KINDS, shape (N, 3) [m].

    Raises
    ------
    ModelError
        If it cannot be read, or holds fewer points than it says, or more than a cloud may have.
    """
    kind = path.suffix.lower()
    with about_file(path):
        try:
            points = KINDS[kind](path)
        except InputError:
            raise
        except Exception as error:  # each library raises its own kinds
            reason = " ".join(str(error).split()) or type(error).__name__
            raise ModelError(f"cannot be read as {kind[1:].upper()}: {reason}") from None
        if points.dtype.kind not in "fiu" or points.ndim != 2 or points.shape[1] != 3:
            shape = f"{points.dtype} of shape {points.shape}"
            raise ModelError("must contain numbers of shape (N, 3)", field="points", value=shape)
        check_points(len(points))
        return points.astype(np.float64)


def _counted(points: Array, content: bytes, line: bytes) -> Array:
    """The points, if they are as many as a line of the file's header says."""
    header_count = re.search(line + rb"[ \t]+(\d+)", content[:LARGEST_HEADER], re.MULTILINE)
    if header_count is not None and int(header_count[1]) != len(points):
        raise ModelError(f"must be {int(header_count[1])}", field="points", value=len(points))
    return points


def _ply(path: Path) -> Array:
    content = bytes_read(path, ModelError)
    return _counted(loaded_mesh(path, finite=False).vertices, content, rb"^element[ \t]+vertex")


def _pcd(path: Path) -> Array:
    pypcd4 = needed_package("pypcd4", "pcd", "a .pcd cloud")
    pydantic = needed_package("pydantic", "pcd", "a .pcd cloud")  # which pypcd4 has errors of
    content = bytes_read(path, ModelError)
    fields = re.search(rb"^FIELDS(.*)$", content[:LARGEST_HEADER], re.MULTILINE)
    if fields is not None and b"\nCOUNT" not in content[:LARGEST_HEADER]:  # each is one number then
        ones = b"\nCOUNT" + b" 1" * len(fields[1].split()) + b"\nDATA"
        content = content.replace(b"\nDATA", ones, 1)
    try:
        cloud = pypcd4.PointCloud.from_fileobj(io.BytesIO(content))
    except pydantic.ValidationError as error:
        names = ", ".join(str(one["loc"][0]).upper() for one in error.errors())
        raise ModelError("lacks or misstates these lines", field="header", value=names) from None
    return _counted(cloud.numpy(("x", "y", "z")), content, rb"^POINTS")


def _las(path: Path) -> Array:
    laspy = needed_package("laspy", "las", "a .las cloud")
    with laspy.open(path) as reader:
        check_points(reader.header.point_count)
        return np.asarray(reader.read().xyz)


def _npz(path: Path) -> NDArray[Any]:
    arrays = npz_arrays(path, "a file of NumPy's arrays")
    name = "points" if "points" in arrays else next(iter(arrays), "")
    if name != "points" and len(arrays) != 1:
        problem = "must contain one array, or one that is named points"
        raise ModelError(problem, field="its arrays", value=list(arrays))
    return arrays[name]


def _npy(path: Path) -> NDArray[Any]:
    with readable(path, "is not an array of NumPy"):
        content = bytes_read(path)
        return array_of(io.BytesIO(content), len(content), "it")


KINDS: Final[dict[str, Callable[[Path], NDArray[Any]]]] = {
    ".ply": _ply,
    ".pcd": _pcd,
    ".las": _las,
    ".npy": _npy,
    ".npz": _npz,
}
"""Extension -> the points of such a file."""

"""Points of clouds in further formats, each by a library: trimesh, pypcd4."""

import io
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import ModelError, about_file
from quasistatic_ref.files.mesh_files import loaded_mesh
from quasistatic_ref.files.npz import array_of, npz_arrays, readable
from quasistatic_ref.files.text import check_equal, check_points
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.mesh_formats.files import check_unpacked, malformed
from quasistatic_ref.parts import needed_package
from quasistatic_ref.text.content import bytes_read

LARGEST_HEADER = 2**20
"""Bytes in which the header of a PCD ends."""
PCD_LINES = ("FIELDS", "SIZE", "COUNT", "WIDTH", "HEIGHT", "POINTS", "TYPE", "DATA")
"""What it must have."""


def file_points(path: Path) -> Array:
    """The points of a file of one of the KINDS, shape (N, 3) [m].

    Raises
    ------
    ModelError
        If it cannot be read, or holds fewer points than it says, or more than a cloud may have.
    """
    kind = path.suffix.lower()
    with about_file(path):
        with malformed(kind[1:].upper()):
            points = KINDS[kind](path)
        if points.dtype.kind not in "fiu" or points.ndim != 2 or points.shape[1] != 3:
            shape = f"{points.dtype} of shape {points.shape}"
            raise ModelError("must contain numbers of shape (N, 3)", field="points", value=shape)
        check_points(len(points))
        return points.astype(np.float64)


def _ply(path: Path) -> Array:
    return loaded_mesh(path, finite=False).vertices


def _pcd(path: Path) -> Array:
    pypcd4 = needed_package("pypcd4", "pcd", "a .pcd cloud")
    content = bytes_read(path, ModelError)
    if b"\nCOUNT" not in content[:LARGEST_HEADER]:  # each field is one number then
        fields = re.search(rb"^FIELDS(.*)$", content[:LARGEST_HEADER], re.MULTILINE)
        ones = b"\nCOUNT" + b" 1" * len(fields[1].split() if fields else ())
        content = content.replace(b"\nDATA", ones + b"\nDATA", 1)
    _check_pcd(content)
    cloud = pypcd4.PointCloud.from_fileobj(io.BytesIO(content))
    points: Array = cloud.numpy(("x", "y", "z"))
    return points


def _check_pcd(content: bytes) -> None:
    """Check the counts in the header of a PCD against the data that follow."""
    line = re.search(rb"^DATA[ \t]+(\w+)[ \t]*\r?\n", content[:LARGEST_HEADER], re.MULTILINE)
    end = len(content) if line is None else line.end()
    header = dict(re.findall(rb"^([A-Z]+)[ \t]+(.*?)\r?$", content[:end], re.MULTILINE))
    if missing := [name for name in PCD_LINES if name.encode() not in header]:
        raise ModelError("lacks these lines; add them", field="header", value=missing)
    sizes, counts, *shape, (stated,) = [
        [int(word) for word in header[name.encode()].split()] for name in PCD_LINES[1:6]
    ]
    width, height = (int(one[0]) for one in shape)
    check_points(stated)
    if not (0 < stated == width * height):
        raise ModelError("must be WIDTH times HEIGHT, and not 0", field="POINTS", value=stated)
    row = sum(size * count for size, count in zip(sizes, counts, strict=True))
    body = content[end:]
    if header[b"DATA"] == b"ascii":
        check_equal("numbers", len(body.split()), stated * sum(counts))
        return
    if header[b"DATA"] != b"binary":
        packed, unpacked = np.frombuffer(body[:8].ljust(8, b"\0"), "<u4").tolist()
        check_unpacked(unpacked)
        check_equal("unpacked bytes", unpacked, stated * row)
        row, stated, body = 1, packed, body[8:]
    if len(body) < stated * row:
        raise ModelError(f"must be {stated}", field="points", value=len(body) // row)


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
    ".npy": _npy,
    ".npz": _npz,
}
"""Extension -> the points of such a file."""

"""Vertex positions of a PLY file, ascii or binary little endian."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.text import ascii_points

_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1",
    "short": "<i2", "int16": "<i2", "ushort": "<u2", "uint16": "<u2",
    "int": "<i4", "int32": "<i4", "uint": "<u4", "uint32": "<u4",
    "float": "<f4", "float32": "<f4", "double": "<f8", "float64": "<f8",
}  # fmt: skip
_FORMATS = ("ascii", "binary_little_endian")


@dataclass(frozen=True)
class Header:
    """What the header says of the vertices.

    Parameters
    ----------
    format : str
        ``"ascii"`` or ``"binary_little_endian"``.
    count : int
        Number of vertices.
    columns : tuple of (str, str)
        Name and NumPy type of each property of a vertex.
    body : bytes
        What follows the header.
    line : int
        Line number at which the body starts.
    """

    format: str
    count: int
    columns: tuple[tuple[str, str], ...]
    body: bytes
    line: int


def ply_points(content: bytes) -> NDArray[np.float64]:
    """Vertex positions of a PLY file.

    Parameters
    ----------
    content : bytes
        The whole file. Its first element must be ``vertex``, as in nearly every file.

    Returns
    -------
    ndarray, shape (N, 3)
        x, y, z [m].

    Raises
    ------
    ModelError
        If the header or a vertex is malformed, not finite, or missing.
    """
    header = _header(content)
    names = [name for name, _ in header.columns]
    for name in "xyz":
        if names.count(name) != 1:
            problem = f"must have one property {name}"
            raise ModelError(problem, field="element vertex", value=names)
    if header.format == "ascii":
        columns, width = [names.index(name) for name in "xyz"], len(names)
        lines = ascii_points(header.body, header.line, columns, width, header.count)
        if len(lines) < header.count:
            raise ModelError(f"must hold {header.count} vertices", field="body", value=len(lines))
        return lines
    vertex = np.dtype(list(header.columns))
    held = len(header.body) // vertex.itemsize
    if held < header.count:
        raise ModelError(f"must hold {header.count} vertices", field="body", value=held)
    table = np.frombuffer(header.body, dtype=vertex, count=header.count)
    points = np.stack([table[name].astype(np.float64) for name in "xyz"], axis=1)
    bad = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if bad.size:
        value = points[bad[0]].tolist()
        raise ModelError("must be finite numbers", field=f"vertex {bad[0]}", value=value)
    return points


def _header(content: bytes) -> Header:
    """Header of a PLY file; refuses what this reader cannot place."""
    kind, count, columns, elements = "", 0, [], 0
    start, number = 0, 0
    while True:
        end = content.find(b"\n", start)
        if end < 0:
            raise ModelError("must end with end_header", field="header")
        words = content[start:end].decode("ascii", errors="replace").split()
        start, number = end + 1, number + 1
        where = f"line {number}"
        match words:
            case ["ply"] if number == 1:
                pass
            case _ if number == 1:
                raise ModelError("must be the word ply", field=where, value=" ".join(words))
            case ["end_header"]:
                break
            case ["format", name, "1.0"] if name in _FORMATS:
                kind = name
            case ["comment" | "obj_info", *_] | []:
                pass
            case ["element", name, digits] if digits.isdigit() and len(digits) < 19:
                elements += 1
                if elements == 1:
                    if name != "vertex":
                        raise ModelError("must be element vertex", field=where, value=name)
                    count = int(digits)
            case ["property", "list", *_] if elements > 1:
                pass
            case ["property", type_, name] if elements >= 1 and type_ in _TYPES:
                if elements == 1:
                    columns.append((name, _TYPES[type_]))
            case _:
                problem = f"is not understood (formats: {', '.join(_FORMATS)})"
                raise ModelError(problem, field=where, value=" ".join(words))
    if not kind:
        raise ModelError("must name a format", field="header")
    if not columns:
        raise ModelError("must have an element vertex with properties", field="header")
    if len({name for name, _ in columns}) != len(columns):
        raise ModelError("must name each property once", field="element vertex", value=columns)
    return Header(kind, count, tuple(columns), content[start:], number + 1)

"""Meshes in STL, OBJ, OFF and PLY, read whole: each count that a file states is compared.

Readers of others pass over what they do not know, and take a file that was cut off for a whole one.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Final

import numpy as np
from numpy.lib.recfunctions import unstructured_to_structured
from numpy.typing import NDArray

from quasistatic_ref.errors import ModelError, about_field
from quasistatic_ref.model.readers.mesh import Mesh
from quasistatic_ref.model.readers.text import check_equal, number_or_nan
from quasistatic_ref.numbers.arrays import Array, Indices

LARGEST_HEADER = 2**20
"""Bytes in which the header of a PLY ends."""
HEADER = 84
"""Bytes of a binary STL before its triangles; the last four are their number."""
FACET = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")])
"""A triangle of a binary STL."""
STL_WORDS = {
    "solid": "s",
    "facet": "f",
    "outer": "o",
    "vertex": "v",
    "endloop": "l",
    "endfacet": "e",
    "endsolid": "d",
}
"""First words of the lines of an STL in text, each as a letter."""
SOLIDS = re.compile("(?:s(?:fovvvle)*+d)+")
"""Their order."""
OBJ_UNREAD = (
    *("vt", "vn", "vp", "o", "g", "s", "usemtl", "mtllib", "usemap", "maplib", "mg", "l", "p"),
    *("lod", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj"),
)
"""First words of lines of an OBJ that add nothing to its surface."""
PLY_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2",
    "ushort": "u2", "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4",
    "int64": "i8", "uint64": "u8", "float": "f4", "float32": "f4", "double": "f8", "float64": "f8",
}  # fmt: skip
"""Kinds of numbers of a PLY."""
PLY_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


def text_of_mesh(content: bytes) -> str:
    """Text in UTF-8, or else in Latin-1, in which every byte is a letter."""
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def _lines(content: bytes) -> list[str]:
    """Lines as editors count them; ``splitlines`` also parts at letters of Latin-1."""
    return re.split("\r\n|\r|\n", text_of_mesh(content))


def _point(words: list[str], number: int, most: int = 3) -> list[float]:
    """The first three of the numbers in a line."""
    with about_field(f"line {number}"):
        numbers = [number_or_nan(word) for word in words]
        if not 3 <= len(numbers) <= most:
            raise ModelError("must be a point, x y z", value=" ".join(words))
        return numbers[:3]


def _numbers(words: list[str], number: int) -> list[int]:
    """Whole numbers in a line."""
    if not all(re.fullmatch(r"-?\d+", word, re.ASCII) for word in words):
        raise ModelError("must be whole numbers", field=f"line {number}", value=" ".join(words))
    return [int(word) for word in words]


def _face(corners: list[int], number: int) -> list[int]:
    if len(corners) < 3:
        problem = "must be a face of three corners or more"
        raise ModelError(problem, field=f"line {number}", value=corners)
    return corners


def _fans(faces: Sequence[Sequence[int]]) -> Indices:
    """Triangles, (T, 3), of faces of any number of corners, as a fan around the first of each."""
    triangles = [(a, b, c) for a, *rest in faces for b, c in pairwise(rest)]
    return np.array(triangles, dtype=np.int64).reshape(-1, 3)


def _points(points: list[list[float]]) -> Array:
    return np.array(points, dtype=np.float64).reshape(-1, 3)


def _stl(content: bytes) -> Mesh:
    """An STL, binary or text."""
    count = int.from_bytes(content[HEADER - 4 : HEADER], "little")
    if len(content) == HEADER + count * FACET.itemsize:
        corners = np.frombuffer(content, FACET, offset=HEADER)["corners"].astype(np.float64)
    else:
        corners = _stl_text(content)
    return Mesh(corners.reshape(-1, 3), np.arange(corners.size // 3).reshape(-1, 3))


def _stl_text(content: bytes) -> Array:
    if content.lstrip()[:5].lower() != b"solid":
        problem = "must begin with solid, or hold 50 bytes for each of its triangles after 84 bytes"
        raise ModelError(problem)
    points = []
    letters = ""
    for number, line in enumerate(_lines(content), start=1):
        first, *words = line.split() or [""]
        if first.lower() == "vertex":
            points.append(_point(words, number))
        if first.lower() not in ("", *STL_WORDS):
            problem = f"must begin with one of {', '.join(STL_WORDS)}"
            raise ModelError(problem, field=f"line {number}", value=line)
        letters += STL_WORDS.get(first.lower(), "")
    if not SOLIDS.fullmatch(letters):
        problem = "is cut off or not in order: each solid has an endsolid, each facet 3 corners"
        raise ModelError(problem)
    return _points(points)


def _obj(content: bytes) -> Mesh:
    """An OBJ: its points and faces."""
    points: list[list[float]] = []
    faces = []
    lines = _lines(re.sub(rb"\\\r?\n", b" ", content))
    for number, line in enumerate(lines, start=1):
        first, *words = line.partition("#")[0].split() or [""]
        if first == "v":
            points.append(_point(words, number, 7))
        elif first == "f":
            corners = _numbers([word.partition("/")[0] for word in words], number)
            # Those below zero are counted back from the last point so far; none is number zero.
            ahead = [c - 1 if c > 0 else len(points) + c if c else -1 for c in corners]
            # Two corners are a line, which some write as a face.
            faces.append(ahead if len(ahead) == 2 else _face(ahead, number))
        elif first and first not in OBJ_UNREAD:
            problem = "is a line of an OBJ that is not read"
            raise ModelError(problem, field=f"line {number}", value=line)
    return Mesh(_points(points), _fans(faces))


def _off(content: bytes) -> Mesh:
    """An OFF: of each line of a point, and of a face, the first numbers."""
    stripped = [line.partition("#")[0].strip() for line in _lines(content)]
    lines = [(number, line) for number, line in enumerate(stripped, start=1) if line]
    header = re.fullmatch(r"(?:ST)?C?N?OFF\s*(\d.*)?", lines[0][1] if lines else "")
    if header is None:
        raise ModelError("must begin with OFF", field="line 1")
    body = [(1, header[1]), *lines[1:]] if header[1] else lines[1:]
    if not body:
        raise ModelError("is cut off after OFF")
    number, line = body[0]
    counts = _numbers(line.split(), number)
    if len(counts) < 2 or len(body) - 1 != sum(counts[:2]):
        problem = f"must be the number of points and of faces, of {len(body) - 1} lines"
        raise ModelError(problem, field=f"line {number}", value=line)
    n = 1 + counts[0]
    points = [_point(line.split(), number, len(line)) for number, line in body[1:n]]
    faces = []
    for number, line in body[n:]:
        words = line.split()
        (corners,) = _numbers(words[:1], number)
        face = _numbers(words[1 : 1 + max(0, corners)], number)
        if len(face) != corners:
            problem = f"must have {corners} corners"
            raise ModelError(problem, field=f"line {number}", value=line)
        faces.append(_face(face, number))
    return Mesh(_points(points), _fans(faces))


@dataclass
class _Element:
    """An element that the header of a PLY announces.

    Parameters
    ----------
    name : str
    count : int
    properties : list of (str, dtype, dtype or None)
        Name, kind, and of a list the kind of its length.
    """

    name: str
    count: int
    properties: list[tuple[str, np.dtype[Any], np.dtype[Any] | None]]


class _PlyBody:
    """The numbers of a PLY after its header, taken in order."""

    def __init__(self, content: bytes, is_text: bool) -> None:
        words = content.decode("latin-1").split() if is_text else []
        self.numbers = np.array([number_or_nan(word) for word in words]) if is_text else None
        self.content = content
        self.at = 0

    @property
    def left(self) -> bytes | Array:
        """What was not taken."""
        return self.content[self.at :] if self.numbers is None else self.numbers[self.at :]

    def take(self, kind: np.dtype[Any], count: int) -> NDArray[Any]:
        """Numbers of one kind, or rows of several; fewer where the file ends."""
        size = kind.itemsize if self.numbers is None else len(kind.names or "1")
        count = min(count, len(self.left) // size)
        start = self.at
        self.at += count * size
        if self.numbers is None:
            return np.frombuffer(self.content, kind, count, start)
        taken = self.numbers[start : self.at]
        if kind.names is None:
            if kind.kind != "f" and (taken % 1).any():
                raise ModelError("must be whole numbers", field="list", value=taken.tolist())
            return taken
        return unstructured_to_structured(taken.reshape(count, size), kind)

    def rows(self, element: _Element) -> dict[str, Any]:
        """Of each property, one value for each time that the element comes, or one list."""
        columns: dict[str, list[Any]] = {name: [] for name, *_ in element.properties}
        if all(length is None for *_, length in element.properties):
            fields = [(name, kind) for name, kind, _ in element.properties]
            table = self.take(np.dtype(fields), element.count)
            check_equal(element.name, len(table), element.count)
            return {name: table[name] for name, _ in fields}
        for number in range(element.count):
            for name, kind, length in element.properties:
                counts = self.take(length, 1).tolist() if length is not None else [1]
                if not counts:
                    check_equal(element.name, number, element.count)
                values = self.take(kind, max(0, int(counts[0]))).tolist()
                check_equal(f"{element.name}[{number}].{name}", len(values), counts[0])
                columns[name].append(values if length is not None else values[0])
        return columns


def _ply(content: bytes) -> Mesh:
    """A PLY, text or binary: its vertices and faces."""
    head = re.match(rb"ply\s.*?\nend_header[ \t]*\r?\n", content[:LARGEST_HEADER], re.DOTALL)
    if head is None:
        raise ModelError("must begin with ply, and have an end_header")
    order, elements = _ply_header(_lines(head[0])[1:-2])
    body = _PlyBody(content[head.end() :], order == "")
    read = {element.name: body.rows(element) for element in elements}
    if order == "":  # each entry has a line
        filled = sum(1 for line in _lines(content[head.end() :]) if line.strip())
        check_equal("lines", filled, sum(element.count for element in elements))
    if bytes(body.left).strip():
        raise ModelError("holds more than its header says")
    vertices = read.get("vertex", {"x": (), "y": (), "z": ()})
    points = np.stack([np.asarray(vertices[axis], dtype=np.float64) for axis in "xyz"], axis=1)
    faces = read.get("face", {"vertex_indices": ()})
    lists = ("vertex_indices", "vertex_index")
    named = [name for name in lists if name in faces]
    others = [name for name, columns in read.items() if name != "face" and {*lists} & {*columns}]
    if len(named) != 1 or others:
        raise ModelError("must be faces with a list vertex_indices", field="face")
    corners = [_face([int(c) for c in face], number) for number, face in enumerate(faces[named[0]])]
    return Mesh(points, _fans(corners))


def _ply_header(lines: list[str]) -> tuple[str, list[_Element]]:
    """The order of bytes, as NumPy names it and none of text, and what follows the header."""
    order = None
    elements: list[_Element] = []
    for number, line in enumerate(lines, start=2):
        match line.split():
            case ["format", word, "1.0"] if word in PLY_ORDERS:
                order = PLY_ORDERS[word]
            case ["element", name, count] if order is not None and count.isdecimal():
                elements.append(_Element(name, int(count), []))
            case ["property", kind, name] if elements and kind in PLY_TYPES:
                elements[-1].properties.append((name, np.dtype(f"{order}{PLY_TYPES[kind]}"), None))
            case ["property", "list", length, kind, name] if (
                elements and kind in PLY_TYPES and length in PLY_TYPES
            ):
                kinds = [np.dtype(f"{order}{PLY_TYPES[word]}") for word in (kind, length)]
                elements[-1].properties.append((name, kinds[0], kinds[1]))
            case ["comment" | "obj_info", *_] | []:
                pass
            case _:
                problem = "is not a line of a header of PLY"
                raise ModelError(problem, field=f"line {number}", value=line)
    if order is None:
        raise ModelError("must state its format", field="line 2")
    names = [element.name for element in elements]
    if len(set(names)) < len(names):
        raise ModelError("must name each element once", field="header", value=names)
    return order, [element for element in elements if element.count]


TEXTS: Final[dict[str, Callable[[bytes], Mesh]]] = {
    ".stl": _stl,
    ".obj": _obj,
    ".off": _off,
    ".ply": _ply,
}
"""Extension -> the mesh that such a file holds."""

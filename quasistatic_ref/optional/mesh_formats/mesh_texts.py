"""Meshes in STL, OBJ, OFF and PLY, read whole: each count that a file states is compared.

Readers of others pass over what they do not know, and take a file that was cut off for a whole one.
"""

import re
from array import array
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import islice
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import ModelError, about_field
from quasistatic_ref.files.mesh import Mesh
from quasistatic_ref.files.text import check_equal, check_lines, number_or_nan
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.mesh_formats.polygons import triangles_of_faces

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
FACE_LISTS = ("vertex_indices", "vertex_index")
"""Names of the list of a face's corners; other elements that have one, as grids, are no faces."""
PLY_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


def text_of_mesh(content: bytes) -> str:
    """Text in UTF-8, or else in Latin-1, in which every byte is a letter."""
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("latin-1")


def _lines(content: bytes) -> list[str]:
    """Lines of a text file, parted at line feeds and carriage returns only."""
    lines = re.split("\r\n|\r|\n", text_of_mesh(content))
    check_lines(lines)
    return lines


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


class _Faces:
    """Faces of any number of corners, in arrays: lists of small lists take ten times as much."""

    def __init__(self) -> None:
        self._corners = array("q")
        self._sizes = array("q")

    def add(self, corners: Sequence[int], field: str) -> None:
        """Add a face; ModelError about the field if it has fewer than three corners."""
        if len(corners) < 3:
            problem = "must be a face of three corners or more"
            raise ModelError(problem, field=field, value=list(corners))
        self._corners.extend(corners)
        self._sizes.append(len(corners))

    def mesh(self, vertices: Array) -> Mesh:
        """The mesh of the faces between vertices, shape (V, 3)."""
        corners = np.array(self._corners)
        return Mesh(vertices, triangles_of_faces(vertices, corners, np.array(self._sizes)))


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
    points = array("d")
    letters = ""
    for number, line in enumerate(_lines(content), start=1):
        first, *words = line.split() or [""]
        if first.lower() == "vertex":
            points.extend(_point(words, number))
        if first.lower() not in ("", *STL_WORDS):
            problem = f"must begin with one of {', '.join(STL_WORDS)}"
            raise ModelError(problem, field=f"line {number}", value=line)
        letters += STL_WORDS.get(first.lower(), "")
    if not SOLIDS.fullmatch(letters):
        problem = "is cut off or not in order: each solid has an endsolid, each facet 3 corners"
        raise ModelError(problem)
    return np.array(points)


def _obj(content: bytes) -> Mesh:
    """An OBJ: its points and faces."""
    points = array("d")
    faces = _Faces()
    lines = _lines(re.sub(rb"\\\r?\n", b" ", content))
    for number, line in enumerate(lines, start=1):
        first, *words = line.partition("#")[0].split() or [""]
        if first == "v":
            points.extend(_point(words, number, 7))
        elif first == "f":
            corners = _numbers([word.partition("/")[0] for word in words], number)
            n = len(points) // 3
            # Those below zero are counted back from the last point so far; none is number zero.
            ahead = [c - 1 if c > 0 else n + c if c else -1 for c in corners]
            if len(ahead) != 2:  # a line, which some write as a face
                faces.add(ahead, f"line {number}")
        elif first and first not in OBJ_UNREAD:
            problem = "is a line of an OBJ that is not read; leave it out"
            raise ModelError(problem, field=f"line {number}", value=line)
    return faces.mesh(np.array(points).reshape(-1, 3))


def _off(content: bytes) -> Mesh:
    """An OFF: of each line of a point, and of a face, the first numbers."""
    lines = _lines(content)
    left = _numbered(lines)
    number, line = next(left, (1, ""))
    header = re.fullmatch(r"(?:ST)?C?N?OFF\s*(\d.*)?", line)
    if header is None:
        raise ModelError("must begin with OFF", field="line 1")
    number, line = (number, header[1]) if header[1] else next(left, (number, ""))
    if not line:
        raise ModelError("is cut off after OFF; export it again")
    counts = _numbers(line.split(), number)
    follow = sum(1 for _ in _numbered(lines)) - (1 if header[1] else 2)
    if len(counts) < 2 or follow != sum(counts[:2]):
        problem = f"must be the number of points and of faces, of {follow} lines"
        raise ModelError(problem, field=f"line {number}", value=line)
    points = array("d")
    for number, line in islice(left, max(0, counts[0])):
        points.extend(_point(line.split(), number, len(line)))
    faces = _Faces()
    for number, line in left:
        words = line.split()
        (corners,) = _numbers(words[:1], number)
        face = _numbers(words[1 : 1 + max(0, corners)], number)
        if len(face) != corners:
            problem = f"must have {corners} corners"
            raise ModelError(problem, field=f"line {number}", value=line)
        faces.add(face, f"line {number}")
    return faces.mesh(np.array(points).reshape(-1, 3))


def _numbered(lines: Sequence[str]) -> Iterator[tuple[int, str]]:
    """Lines with content, without comments, and their numbers from 1 on."""
    for number, line in enumerate(lines, start=1):
        if stripped := line.partition("#")[0].strip():
            yield number, stripped


_Properties = list[tuple[str, np.dtype[Any], np.dtype[Any] | None]]
"""Name and kind of each property of an element of a PLY, and of a list the kind of its length."""


def _ply(content: bytes) -> Mesh:
    """A PLY, text or binary: its vertices and faces."""
    head = re.match(rb"ply\s.*?\nend_header[ \t]*\r?\n", content[:LARGEST_HEADER], re.DOTALL)
    if head is None:
        raise ModelError("must begin with ply, and have an end_header")
    is_text, elements = _ply_header(_lines(head[0])[1:-2])
    body = content[head.end() :]
    if is_text:  # each entry has a line
        lines = [line for line in _lines(body) if line.strip()]
        words = (word for line in lines for word in line.split())
        body = np.fromiter(map(number_or_nan, words), np.float64).tobytes()
    read = _PlyBody(body)
    points = np.zeros((0, 3))
    corners = sizes = np.zeros(0, np.int64)
    for name, count, properties in elements:
        table = read.entries(name, count, properties)
        if name == "vertex":
            points = np.stack([np.asarray(table[axis], np.float64) for axis in "xyz"], axis=1)
        if name == "face":
            lists = [table[one] for one in FACE_LISTS if one in table]
            if len(lists) != 1:
                problem = f"must be faces with a list {FACE_LISTS[0]}"
                raise ModelError(problem, field="face")
            if (lists[0] % 1).any():
                raise ModelError("must be whole numbers", field="face")
            corners = lists[0].astype(np.int64)
            sizes = read.sizes
    if is_text:
        check_equal("lines", len(lines), sum(count for _, count, _ in elements))
    if read.left:
        raise ModelError("holds more than its header says; export it again")
    return Mesh(points, triangles_of_faces(points, corners, sizes))


class _PlyBody:
    """The body of a PLY file, read element by element.

    Parameters
    ----------
    body : bytes

    Attributes
    ----------
    sizes : ndarray of int
        How many corners each face has.
    """

    def __init__(self, body: bytes) -> None:
        self._body = body
        self._at = 0
        self.sizes = np.zeros(0, np.int64)

    @property
    def left(self) -> bytes:
        """The unread rest of the body, without spaces."""
        return self._body[self._at :].strip()

    def _taken(self, kind: np.dtype[Any], count: int, what: str) -> NDArray[Any]:
        start = self._at
        check_equal(what, min(count, (len(self._body) - start) // kind.itemsize), count)
        self._at += count * kind.itemsize
        return np.frombuffer(self._body, kind, count, start)

    def entries(self, name: str, count: int, properties: _Properties) -> Mapping[str, NDArray[Any]]:
        """The numbers of each property; of lists all entries, one after the other.

        Of an element that is neither vertex nor face, which is passed over, nothing.
        """
        if all(length is None for *_, length in properties):
            fields = [(one, kind) for one, kind, _ in properties]
            taken = self._taken(np.dtype(fields), count, name)
            return {one: taken[one] for one, _ in fields}
        is_wanted = name in ("vertex", "face")
        parts: dict[str, list[bytes]] = {one: [] for one, *_ in properties}
        sizes = array("q")
        body = self._body
        for number in range(count):
            if self._at == len(body):
                check_equal(name, number, count)
            for one, kind, length in properties:
                size = 1
                if length is not None:
                    size = self._size(length, f"{name}[{number}].{one}")
                start = self._at
                end = start + size * kind.itemsize
                if end > len(body):
                    self._taken(kind, size, f"{name}[{number}].{one}")
                self._at = end
                if is_wanted:
                    parts[one].append(body[start:end])
                if name == "face" and one in FACE_LISTS:
                    if size < 3:
                        problem = "must be a face of three corners or more"
                        raise ModelError(problem, field=f"face[{number}]", value=size)
                    sizes.append(size)
        self.sizes = np.array(sizes)
        kinds = {one: kind for one, kind, _ in properties}
        return {one: np.frombuffer(b"".join(each), kinds[one]) for one, each in parts.items()}

    def _size(self, kind: np.dtype[Any], what: str) -> int:
        """How many entries a list has."""
        (size,) = self._taken(kind, 1, what).tolist()
        if size % 1:
            raise ModelError("must have a whole number of entries", field=what, value=size)
        return max(0, int(size))


def _ply_header(lines: list[str]) -> tuple[bool, list[tuple[str, int, _Properties]]]:
    """Whether a PLY is text, and its elements with their counts and properties."""
    kinds: dict[str, np.dtype[Any]] = {}
    is_text = False
    elements: list[tuple[str, int, _Properties]] = []
    for number, line in enumerate(lines, start=2):
        match line.split():
            case ["format", word, "1.0"] if word in PLY_ORDERS:
                is_text = word == "ascii"
                kinds = {
                    name: np.dtype("f8" if is_text else PLY_ORDERS[word] + kind)
                    for name, kind in PLY_TYPES.items()
                }
            case ["element", name, count] if kinds and count.isdecimal():
                elements.append((name, int(count), []))
            case ["property", kind, name] if elements and kind in kinds:
                elements[-1][2].append((name, kinds[kind], None))
            case ["property", "list", length, kind, name] if elements and {kind, length} <= {
                *kinds
            }:
                elements[-1][2].append((name, kinds[kind], kinds[length]))
            case ["comment" | "obj_info", *_] | []:
                pass
            case _:
                problem = "is not a line of a header of PLY; export it again"
                raise ModelError(problem, field=f"line {number}", value=line)
    if not kinds:
        raise ModelError("must state its format", field="line 2")
    names = [name for name, *_ in elements]
    if len(set(names)) < len(names):
        raise ModelError("must name each element once", field="header", value=names)
    return is_text, [element for element in elements if element[1]]


TEXTS: Final[dict[str, Callable[[bytes], Mesh]]] = {
    ".stl": _stl,
    ".obj": _obj,
    ".off": _off,
    ".ply": _ply,
}
"""Extension -> the mesh that such a file holds."""

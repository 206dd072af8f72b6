"""Meshes in STL, OBJ, OFF and PLY, read whole: each count that a file states is compared.

Readers of others pass over what they do not know, and take a file that was cut off for a whole one.
"""

import re
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any, Final

import numpy as np
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


_Properties = list[tuple[str, np.dtype[Any], np.dtype[Any] | None]]
"""Name and kind of each property of an element of a PLY, and of a list the kind of its length."""


def _ply(content: bytes) -> Mesh:
    """A PLY, text or binary: its vertices and faces."""
    head = re.match(rb"ply\s.*?\nend_header[ \t]*\r?\n", content[:LARGEST_HEADER], re.DOTALL)
    if head is None:
        raise ModelError("must begin with ply, and have an end_header")
    is_text, elements = _ply_header(_lines(head[0])[1:-2])
    body = content[head.end() :]
    lines = [line for line in _lines(body) if line.strip()] if is_text else []
    if is_text:
        body = np.array([number_or_nan(word) for word in " ".join(lines).split()]).tobytes()
    read, left = _ply_entries(body, elements)
    if is_text:  # each entry has a line
        check_equal("lines", len(lines), sum(count for _, count, _ in elements))
    if left.strip():
        raise ModelError("holds more than its header says")
    vertices = read.get("vertex", {"x": (), "y": (), "z": ()})
    points = np.stack([np.asarray(vertices[axis], dtype=np.float64) for axis in "xyz"], axis=1)
    lists = ("vertex_indices", "vertex_index")
    named = [
        (name, one) for name, _, properties in elements for one, *_ in properties if one in lists
    ]
    if "face" not in read and not named:
        return Mesh(points, _fans(()))
    if [name for name, _ in named] != ["face"]:
        raise ModelError("must be faces with a list vertex_indices", field="face")
    corners = read["face"][named[0][1]]
    if any(corner % 1 for face in corners for corner in face):
        raise ModelError("must be whole numbers", field="face")
    return Mesh(points, _fans([_face(face, number) for number, face in enumerate(corners)]))


def _ply_entries(
    body: bytes, elements: list[tuple[str, int, _Properties]]
) -> tuple[dict[str, Any], bytes]:
    """Of each element, by the names of its properties, the numbers or lists; and what is left."""
    at = 0

    def taken(kind: np.dtype[Any], count: int, what: str) -> NDArray[Any]:
        nonlocal at
        start = at
        check_equal(what, min(count, (len(body) - start) // kind.itemsize), count)
        at += count * kind.itemsize
        return np.frombuffer(body, kind, count, start)

    read: dict[str, Any] = {}
    for name, count, properties in elements:
        if all(length is None for *_, length in properties):
            fields = [(one, kind) for one, kind, _ in properties]
            read[name] = taken(np.dtype(fields), count, name)
            continue
        columns: dict[str, list[Any]] = {one: [] for one, *_ in properties}
        for number in range(count):
            if at == len(body):
                check_equal(name, number, count)
            for one, kind, length in properties:
                what = f"{name}[{number}].{one}"
                (size,) = (1,) if length is None else taken(length, 1, what).tolist()
                if size % 1:
                    raise ModelError("must have a whole number of entries", field=what, value=size)
                values = taken(kind, max(0, int(size)), what).tolist()
                columns[one].append(values[0] if length is None else values)
        read[name] = columns
    return read, body[at:]


def _ply_header(lines: list[str]) -> tuple[bool, list[tuple[str, int, _Properties]]]:
    """Whether it is text, whose numbers are all taken as float64, and what follows the header."""
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
                problem = "is not a line of a header of PLY"
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

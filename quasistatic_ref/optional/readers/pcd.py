"""Point positions of a PCD file (Point Cloud Library, versions .5 to .7).

The viewpoint is where the sensor stood; the points are taken as written.
"""

import math
from collections.abc import Sequence

import numpy as np

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.readers.text import check_points
from quasistatic_ref.optional.readers.point_table import PointTable, header_lines, table_points
from quasistatic_ref.step.arrays import Array

_SIZES = {"F": ("4", "8"), "I": ("1", "2", "4", "8"), "U": ("1", "2", "4", "8")}
"""The sizes of each type, which NumPy has by the same letter [bytes]."""
_WORDS = (
    "VERSION", "FIELDS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA",
)  # fmt: skip
MOST_COLUMNS = 1000


def pcd_points(content: bytes) -> Array:
    """Point positions of a PCD file.

    Parameters
    ----------
    content : bytes
        The whole file.

    Returns
    -------
    ndarray, shape (N, 3)
        x, y, z [m].

    Raises
    ------
    ModelError
        If the header or a point is malformed or missing.
    """
    table = _table(content)
    names = table.names
    for name in "xyz":
        if names.count(name) != 1 or table.columns[names.index(name)][2] != 1:
            raise ModelError(f"must name {name} once, with one entry", field="FIELDS", value=names)
    return table_points(table, "DATA", "points")


def _table(content: bytes) -> PointTable:
    header: dict[str, list[str]] = {}
    for number, words, start in header_lines(content, "a line DATA"):
        if not words or words[0].startswith("#"):
            continue
        if words[0] not in _WORDS or words[0] in header:
            problem = f"must begin with one of {', '.join(_WORDS)}, each given once"
            raise ModelError(problem, field=f"line {number}", value=" ".join(words))
        header[words[0]] = words[1:]
        if words[0] == "DATA":
            body = content[start:]
            break
    data = " ".join(header["DATA"])
    if data not in ("ascii", "binary", "binary_compressed"):
        raise ModelError("must be ascii, binary or binary_compressed", field="DATA", value=data)
    columns = _columns(header)
    count = _count(header)
    if data == "binary_compressed":
        body = _point_by_point(body, columns, count)
    return PointTable(columns, count, data == "ascii", body, number + 1)


def _point_by_point(body: bytes, columns: Sequence[tuple[str, str, int]], count: int) -> bytes:
    """The points of a compressed body, which holds one column after the other."""
    check_points(count, "points")
    point = np.dtype([(f"{i}", kind, (n,)) for i, (_, kind, n) in enumerate(columns)])
    packed, size = (int.from_bytes(body[i : i + 4], "little") for i in (0, 4))
    if size != count * point.itemsize or len(body) < 8 + packed:
        problem = f"must be {count} points, {count * point.itemsize} bytes, when unpacked"
        raise ModelError(problem, field="DATA", value=size)
    content = unpacked(body[8 : 8 + packed], size)
    rows = np.empty(count, point)
    start = 0
    for i, (_, kind, n) in enumerate(columns):
        entries = np.frombuffer(content, kind, count * n, start)
        rows[f"{i}"] = entries.reshape(count, n)
        start += entries.nbytes
    return rows.tobytes()


def unpacked(packed: bytes, size: int) -> bytes:
    """Bytes that LZF packed, `size` of them.

    A byte below 32 is followed by one more literal bytes than it says. Any other begins a copy of
    what was unpacked before: its upper three bits are the length less two, and where these are 7,
    the next byte is added; its lower five and the next byte are the distance back, less one.

    Raises
    ------
    ModelError
        If they are not so many, or a copy begins before the first.
    """
    content = bytearray()
    i = 0
    try:
        while i < len(packed) and len(content) <= size:
            first = packed[i]
            i += 1
            if first < 32:
                content += packed[i : i + first + 1]
                i += first + 1
                continue
            length = first >> 5
            if length == 7:
                length += packed[i]
                i += 1
            back = ((first & 31) << 8) + packed[i] + 1
            i += 1
            chunk = content[-back:] if back <= len(content) else b""
            repeats = -(-(length + 2) // len(chunk))
            content += (chunk * repeats)[: length + 2]
    except (IndexError, ZeroDivisionError):
        content.clear()
    if len(content) != size:
        raise ModelError(f"cannot be unpacked to {size} bytes", field="DATA")
    return bytes(content)


def _columns(header: dict[str, list[str]]) -> tuple[tuple[str, str, int], ...]:
    names, sizes, types = (header.get(word, []) for word in ("FIELDS", "SIZE", "TYPE"))
    counts = header.get("COUNT", ["1"] * len(names))
    if not len(names) == len(sizes) == len(types) == len(counts) <= MOST_COLUMNS:
        problem = "must have as many entries as SIZE, TYPE and COUNT"
        raise ModelError(problem, field="FIELDS", value=names)
    columns = []
    for name, size, kind, count in zip(names, sizes, types, counts, strict=True):
        if size not in _SIZES.get(kind, ()):
            raise ModelError("has an unknown SIZE and TYPE", field=name, value=f"{size} {kind}")
        columns.append((name, f"<{kind.lower()}{size}", _whole("COUNT", count)))
    if sum(n for _, _, n in columns) > MOST_COLUMNS:
        raise ModelError(f"must have at most {MOST_COLUMNS} entries", field="FIELDS")
    return tuple(columns)


def _count(header: dict[str, list[str]]) -> int:
    """The number of points, which POINTS and WIDTH times HEIGHT must agree on."""
    sizes = [_whole(word, *header[word]) for word in ("WIDTH", "HEIGHT") if word in header]
    given = [_whole("POINTS", *header["POINTS"])] if "POINTS" in header else []
    if len(sizes) == 2:
        given.append(math.prod(sizes))
    if not given or len(set(given)) > 1:
        raise ModelError("must be given, and be WIDTH times HEIGHT", field="POINTS", value=given)
    return given[0]


def _whole(field: str, *words: str) -> int:
    if len(words) != 1 or not (words[0].isascii() and words[0].isdigit()) or len(words[0]) > 18:
        raise ModelError("must be a whole number", field=field, value=" ".join(words))
    return int(words[0])

"""Vertex positions of a PLY file whose first element is the vertices."""

from quasistatic_ref.errors import ModelError
from quasistatic_ref.optional.readers.point_table import PointTable, header_lines, table_points
from quasistatic_ref.step.arrays import Array

_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1",
    "short": "<i2", "int16": "<i2", "ushort": "<u2", "uint16": "<u2",
    "int": "<i4", "int32": "<i4", "uint": "<u4", "uint32": "<u4",
    "float": "<f4", "float32": "<f4", "double": "<f8", "float64": "<f8",
}  # fmt: skip
_FORMATS = ("ascii", "binary_little_endian")


def ply_points(content: bytes) -> Array | None:
    """Vertex positions of a PLY file; None of one that is big endian or has others first.

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
        If the header or a vertex is malformed, not finite, or missing.
    """
    table = _table(content)
    if table is None:
        return None
    for name in "xyz":
        if table.names.count(name) != 1:
            problem = f"must have one property {name}"
            raise ModelError(problem, field="element vertex", value=table.names)
    return table_points(table, "body", "vertices")


def _table(content: bytes) -> PointTable | None:
    """The vertices as the header describes them; None where this reader cannot place them."""
    kind = ""
    count = 0
    columns = []
    elements = 0
    for number, words, start in header_lines(content, "end_header"):
        where = f"line {number}"
        match words:
            case ["ply"] if number == 1:
                pass
            case _ if number == 1:
                raise ModelError("must be the word ply", field=where, value=" ".join(words))
            case ["end_header"]:
                body = content[start:]
                break
            case ["format", name, "1.0"] if name in _FORMATS:
                kind = name
            case ["format", "binary_big_endian", "1.0"]:
                return None
            case ["comment" | "obj_info", *_] | []:
                pass
            case ["element", name, digits] if digits.isdigit() and len(digits) < 19:
                elements += 1
                if elements == 1:
                    if name != "vertex":
                        return None
                    count = int(digits)
            case ["property", "list", *_] if elements > 1:
                pass
            case ["property", "list", *_] if elements == 1:
                return None
            case ["property", type_, name] if elements >= 1 and type_ in _TYPES:
                if elements == 1:
                    columns.append((name, _TYPES[type_], 1))
            case _:
                problem = f"is not understood (formats: {', '.join(_FORMATS)})"
                raise ModelError(problem, field=where, value=" ".join(words))
    if not kind:
        raise ModelError("must name a format", field="header")
    if not columns:
        raise ModelError("must have an element vertex with properties", field="header")
    if len({name for name, _, _ in columns}) != len(columns):
        raise ModelError("must name each property once", field="element vertex", value=columns)
    return PointTable(tuple(columns), count, kind == "ascii", body, number + 1)

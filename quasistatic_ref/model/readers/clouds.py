"""Point clouds from files: xyz, csv, ply and pcd (ascii and binary), obj, npy and npz.

Positions only; colours, normals and faces are not part of the model. Coordinates are taken as
written, in metres. A line or a vertex that cannot be read is an error, never left out.
"""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import numpy as np

from quasistatic_ref.errors import InputError, ModelError, about_field, about_file
from quasistatic_ref.formats.files import bytes_read, text_of
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.model.readers.text import decimal, point_lines
from quasistatic_ref.parts import Slot
from quasistatic_ref.shapes.placed_shape import PointCloud
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.tolerances import LARGE

Lines = Iterator[tuple[int, str]]
"""Lines of a text with their numbers."""
Point = tuple[int, Sequence[str]]
"""The number of a point's line, and its words."""


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
        Points in file order, shape (N, 3) [m]; a repeated one counts once.

    Raises
    ------
    ModelError
        If the extension is unknown, or the file is missing, empty or malformed; it names the
        file, the line or vertex, and the value.
    """
    path = Path(path)
    kind = path.suffix.lower()
    if kind not in KINDS:
        problem = f"is not a known kind of point cloud{suggestion(kind, KINDS)}"
        raise ModelError(problem, file=path, field="extension", value=path.suffix)
    try:
        with about_file(path):
            return PointCloud(_checked(_points(path, kind)))
    except InputError as error:  # NumPy's files raise others
        raise ModelError(
            error.problem, field=error.field, value=error.value, file=error.file
        ) from None


def _checked(given: list[list[float]] | Array) -> Array:
    points = np.array(given, dtype=np.float64).reshape(-1, 3)
    for wrong, problem in (
        (~np.isfinite(points), "must be finite numbers"),
        (np.abs(points) > LARGE, f"its coordinates must be at most {LARGE:g} m"),
    ):
        bad = np.flatnonzero(wrong.any(axis=1))
        if bad.size:
            value = points[bad[0]].tolist()
            raise ModelError(problem, field=f"point {bad[0]}", value=value)
    return points


def _of_lines(path: Path, words_of: Callable[[Lines], Iterator[Point]]) -> list[list[float]]:
    """Points of a text: what the words of each are is a matter of its format."""
    lines = point_lines(text_of(bytes_read(path, ModelError), path, ModelError))
    return [_numbers(*point) for point in words_of(enumerate(lines, start=1))]


def _numbers(number: int, words: Sequence[str]) -> list[float]:
    if len(words) != 3:
        problem = "must be three numbers, x y z"
        raise ModelError(problem, field=f"line {number}", value=" ".join(words))
    with about_field(f"line {number}"):
        return [decimal(word) for word in words]


def _xyz(lines: Lines) -> Iterator[Point]:
    for number, line in lines:
        words = line.split("#", 1)[0].split()
        if words:
            yield number, words


def _csv(lines: Lines) -> Iterator[Point]:
    columns: list[int] | None = None
    width = 3
    for number, line in lines:
        words = [word.strip().strip('"') for word in line.split(",")]
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        if columns is None:
            columns = [0, 1, 2]
            header = [word.lower() for word in words]
            if any(name in header for name in "xyz"):
                columns = [_column(header, name, number) for name in "xyz"]
                width = len(words)
                continue
        if len(words) != width:
            raise ModelError(f"must have {width} columns", field=f"line {number}", value=line)
        yield number, [words[c] for c in columns]


def _column(header: list[str], name: str, number: int) -> int:
    if header.count(name) != 1:
        problem = f"must name the column {name} once"
        raise ModelError(problem, field=f"line {number}", value=",".join(header))
    return header.index(name)


def _obj(lines: Lines) -> Iterator[Point]:
    for number, line in lines:
        words = line.split("#", 1)[0].split()
        if words and words[0] == "v":
            # A vertex may carry a weight or a colour after its position.
            if len(words) not in (4, 5, 7, 8):
                raise ModelError("must be v x y z", field=f"line {number}", value=line)
            yield number, words[1:4]


WORDS_OF: dict[str, Callable[[Lines], Iterator[Point]]] = {
    ".xyz": _xyz,
    ".csv": _csv,
    ".obj": _obj,
}
"""Extension of a text file -> the words of each of its points."""
OF_PART = (".ply", ".pcd", ".npy", ".npz")
"""Extensions of files that ``optional/readers`` reads."""
POINTS_OF: Slot[dict[str, Callable[[Path], Array]]] = Slot("readers.points")
KINDS = (*WORDS_OF, *OF_PART)


def _points(path: Path, kind: str) -> list[list[float]] | Array:
    if kind in WORDS_OF:
        return _of_lines(path, WORDS_OF[kind])
    return POINTS_OF.needed(f"a {kind} cloud")[kind](path)

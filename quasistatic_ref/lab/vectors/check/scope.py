"""What a program says that it does: a file that ``check``, ``report`` and ``challenge`` read.

A program that does boxes in float32, and no Farkas vectors, is complete or not within that; what is
outside is not asked of it, and is not missing.
"""

from dataclasses import dataclass
from pathlib import Path

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import toml_read
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.lab.vectors.check.verdict import DIGITS
from quasistatic_ref.lab.vectors.distances.shapes import SHAPES
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers import LAYERS
from quasistatic_ref.lab.vectors.trees import nodes
from quasistatic_ref.step.cones import cone

FORMAT = "quasistatic-ref/scope"
ROUND = "ellipsoid"
"""The cone of cases with second-order cones in the place of a name."""


@dataclass(frozen=True)
class Scope:
    """What a program does.

    Parameters
    ----------
    name : str
        As a badge says it, e.g. ``boxes and half-spaces``.
    layers : tuple of str
    shapes, cones : tuple of str
        Kinds that occur in its cases.
    digits : float or None
        To which it is right; None: as far as float64.
    farkas : bool
        Whether it proves that a case has no solution.
    """

    name: str
    layers: tuple[str, ...] = LAYERS
    shapes: tuple[str, ...] | None = None
    cones: tuple[str, ...] | None = None
    digits: float | None = None
    farkas: bool = True

    def holds(self, layer: str, case: Json, record: Json) -> bool:
        """Whether a case is within it.

        Parameters
        ----------
        layer : str
        case : dict
            The input.
        record : dict
            What is expected.
        """
        kinds = {kind for path, kind in nodes(case) if path[-1:] == ("kind",)} & set(SHAPES)
        cones = {case["cone"]} if "cone" in case else set()
        cones |= {ROUND} if "second_order" in case else set()
        return (
            layer in self.layers
            and (self.shapes is None or kinds <= set(self.shapes))
            and (self.cones is None or cones <= set(self.cones))
            and (self.farkas or "farkas" not in record["output"])
        )


WHOLE = Scope("")
"""Everything."""


def scope_read(path: str | Path | None) -> Scope:
    """A scope, read; everything where there is no file.

    Raises
    ------
    InputError
        Naming file, field and value.
    """
    if path is None:
        return WHOLE
    try:
        top = TableReader(toml_read(Path(path)))
        top.check_format(FORMAT, 1)
        layers = top.words("layers", list(LAYERS))
        found = Scope(
            top.text("name"),
            tuple(name for name in LAYERS if name in layers),
            tuple(top.words("shapes")) if "shapes" in top else None,
            tuple(top.words("cones")) if "cones" in top else None,
            top.number("digits", above=0.0) if "digits" in top else None,
            top.boolean("farkas", True),
        )
        top.close()
        for field, given, known in (("layers", layers, LAYERS), ("shapes", found.shapes, SHAPES)):
            for one in given or ():
                if one not in known:
                    raise top.error_about(
                        field, f"holds an unknown one{suggestion(one, known)}", one
                    )
        for one in found.cones or ():
            cone(one)
        if found.digits is not None and found.digits > DIGITS:
            raise top.error_about("digits", f"must be at most {DIGITS:g}", found.digits)
    except InputError as error:
        raise error.in_file(path) from None
    return found

"""What a program says that it does: a file that ``check``, ``report`` and ``challenge`` read.

A program that does boxes in float32, and no Farkas vectors, is complete or not within that; what is
outside is not asked of it, and is not missing.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import toml_read
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.lab.vectors.check.verdict import DIGITS, Verdict
from quasistatic_ref.lab.vectors.distances.shapes import SHAPES
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers import LAYERS
from quasistatic_ref.lab.vectors.trees import nodes
from quasistatic_ref.step.cones import cone

FORMAT = "quasistatic-ref/scope"
ROUND = "ellipsoid"
"""The cone of cases with second-order cones in the place of a name."""
KINDS = tuple(SHAPES)
ROWS = (4, 6)
LAWS = ("relaxation", "coulomb")
COULOMB = ("distance", "selection", "jacobian", "integrate", "step")
"""Layers that do not know the law of friction; of steps contacts, H and g."""
COULOMB_STEP = ("contacts", "H", "g")
ARITHMETICS = ("float64", "float32")
LEAST, MOST = float(np.finfo(np.float32).tiny), float(np.finfo(np.float32).max)
"""Of float32."""


@dataclass(frozen=True)
class Scope:
    """What a program does.

    Parameters
    ----------
    name : str
        That its authors give it.
    layers : tuple of str
    shapes, cones : tuple of str or None
        Kinds that occur in its cases; None: all.
    pairs : tuple of (str, str) or None
        Pairs of kinds that it brings together, each in alphabetical order; None: all of `shapes`.
    rows : tuple of int
        4: contacts without torsional friction, 6: contacts with it.
    law : str
        ``"coulomb"``: steps have another answer, and only what leads to them is compared.
    arithmetic : str
        ``"float32"``: numbers beyond its range are outside.
    digits : float or None
        To which it is right; None: as far as float64.
    farkas : bool
        Whether it proves that a case has no solution.
    """

    name: str
    layers: tuple[str, ...] = LAYERS
    shapes: tuple[str, ...] | None = None
    cones: tuple[str, ...] | None = None
    pairs: tuple[tuple[str, str], ...] | None = None
    rows: tuple[int, ...] = ROWS
    law: str = LAWS[0]
    arithmetic: str = ARITHMETICS[0]
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
        kinds = {kind for path, kind in nodes(case) if path[-1:] == ("kind",)} & set(KINDS)
        cones = {case["cone"]} if "cone" in case else set()
        cones |= {ROUND} if "second_order" in case else set()
        rows = {rows for path, rows in nodes(case) if path[-1:] == ("rows",)}
        return (
            layer in self.layers
            and (self.shapes is None or kinds <= set(self.shapes))
            and (self.pairs is None or set(_pairs(layer, case)) <= set(self.pairs))
            and (self.cones is None or self.law == "coulomb" or cones <= set(self.cones))
            and rows <= set(self.rows)
            and (self.farkas or "farkas" not in record["output"])
            and (self.arithmetic == "float64" or _in_float32(case, record["output"]))
        )

    def part(self, layer: str, output: Json) -> Json:
        """What of an answer is compared."""
        if self.law != "coulomb" or layer != "step" or not isinstance(output, dict):
            return output
        return {name: value for name, value in output.items() if name in COULOMB_STEP}

    def of_part(self, layer: str, verdict: Verdict) -> Verdict:
        """The verdict on that part: what is not compared is not left out."""
        if self.law != "coulomb" or layer != "step":
            return verdict
        names = (name for name in verdict.without if name.partition(".")[0] in COULOMB_STEP)
        return replace(verdict, without=tuple(names))

    @property
    def words(self) -> str:
        """What it holds, as a badge says it; empty of everything.

        Examples
        --------
        >>> from quasistatic_ref.lab.vectors.check.scope import Scope
        >>> Scope("", shapes=("box", "halfspace"), rows=(4,), digits=4.0).words
        'box and halfspace, without torsion, to 4 digits'
        """
        said = []
        if self.pairs is not None:
            said.append(_listed_names([" on ".join(pair) for pair in self.pairs]))
        elif self.shapes is not None:
            said.append(_listed_names(self.shapes))
        if self.cones is not None:
            said.append(f"cone {_listed_names(self.cones)}")
        if self.rows != ROWS:
            said.append("without torsion" if self.rows == (4,) else "with torsion only")
        if self.law == "coulomb":
            said.append("Coulomb's law (kinematics, contacts, H and g)")
        if self.arithmetic != ARITHMETICS[0]:
            said.append(self.arithmetic)
        if self.digits is not None:
            said.append(f"to {self.digits:g} digits")
        if not self.farkas:
            said.append("no Farkas vectors")
        return ", ".join(said)


def _listed_names(names: tuple[str, ...] | list[str]) -> str:
    return " and ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


def _pairs(layer: str, case: Json) -> Iterator[tuple[str, str]]:
    """The kinds of shapes that a case brings together, each pair in alphabetical order."""
    if layer == "distance":
        yield _ordered(case["alpha"]["kind"], case["beta"]["kind"])
    for pair in case.get("pairs", ()):
        yield _ordered(*(case["shapes"][pair[side]]["shape"]["kind"] for side in ("alpha", "beta")))


def _ordered(one: str, other: str) -> tuple[str, str]:
    return (one, other) if one <= other else (other, one)


def _in_float32(case: Json, output: Json) -> bool:
    """Whether float32 holds a case; of its output what is tiny may be rounding."""
    asked, answered = (
        [abs(v) for _, v in nodes(value) if isinstance(v, int | float) and v]
        for value in (case, output)
    )
    return min(asked, default=1.0) >= LEAST and max(asked + answered, default=1.0) <= MOST


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
        law = top.text("law", LAWS[0], choices=LAWS)
        possible = COULOMB if law == "coulomb" else LAYERS
        layers = _known_names(top, "layers", LAYERS) if "layers" in top else possible
        for one in layers:
            if one not in possible:
                problem = f"cannot be compared under Coulomb's law; these can: {', '.join(COULOMB)}"
                raise top.error_about("layers", problem, one)
        found = Scope(
            top.text("name"),
            tuple(name for name in LAYERS if name in layers),
            shapes=_known_names(top, "shapes", KINDS) if "shapes" in top else None,
            cones=tuple(top.words("cones")) if "cones" in top else None,
            pairs=_pairs_read(top) if "pairs" in top else None,
            rows=_rows_read(top) if "rows" in top else ROWS,
            law=law,
            arithmetic=top.text("arithmetic", ARITHMETICS[0], choices=ARITHMETICS),
            digits=top.number("digits", above=0.0) if "digits" in top else None,
            farkas=top.boolean("farkas", True),
        )
        top.close()
        for one in found.cones or ():
            cone(one)
        if found.digits is not None and found.digits > DIGITS:
            raise top.error_about("digits", f"must be at most {DIGITS:g}", found.digits)
    except InputError as error:
        raise error.in_file(path) from None
    return found


def _known_names(top: TableReader, field: str, known: tuple[str, ...]) -> tuple[str, ...]:
    """Names of which each is known."""
    words = top.words(field)
    for one in words:
        if one not in known:
            raise top.error_about(field, f"holds an unknown one{suggestion(one, known)}", one)
    return tuple(words)


def _pairs_read(top: TableReader) -> tuple[tuple[str, str], ...]:
    found = []
    for words in top.words("pairs"):
        kinds = words.split("-")
        unknown = [kind for kind in kinds if kind not in KINDS]
        if len(kinds) != 2 or unknown:
            problem = 'holds no pair like "box-halfspace"' + suggestion((unknown or [""])[0], KINDS)
            raise top.error_about("pairs", problem, words)
        found.append(_ordered(*kinds))
    return tuple(found)


def _rows_read(top: TableReader) -> tuple[int, ...]:
    given = top.sequence("rows")
    if not given or any(one not in ROWS for one in given):
        raise top.error_about("rows", "must be [4], [6] or [4, 6]", given)
    return tuple(rows for rows in ROWS if rows in given)

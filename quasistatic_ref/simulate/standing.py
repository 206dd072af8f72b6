"""Whether the bodies of a scene stand: what ``stands`` answers."""

from collections.abc import Iterator
from dataclasses import dataclass

from quasistatic_ref.errors import MissingKey
from quasistatic_ref.quoting import aligned, nearest_name
from quasistatic_ref.text.plain import Plain

NOTHING_FREE = "nothing in this scene is free: all of its coordinates are actuated"
WORDS = {True: "yes", False: "no", None: "not decided"}


@dataclass(frozen=True, eq=False)
class Standing(Plain):
    """Whether one body stands, and what it lacks.

    Parameters
    ----------
    body : str
        Its name, or that of its first joint.
    stands : bool or None
        None where it is not decided.
    missing_N, missing_Nm : float
        What a clamp on this body alone would bear: of a free body force, and torque about its
        centre of mass; else along its joints that slide and that turn [N, N m].
    direction : tuple of float
        Of what is missing: of a free body's force in the world, or of its torque where that is all;
        else along its coordinates [-]. Empty where nothing is.
    held_with : tuple of str
        Other bodies that press on it without slipping, and move with it: their verdict is the same.
    reason : str
        Why it is not decided; or that it was asked otherwise than it begins.
    """

    body: str
    stands: bool | None
    missing_N: float = 0.0
    missing_Nm: float = 0.0
    direction: tuple[float, ...] = ()
    held_with: tuple[str, ...] = ()
    reason: str = ""

    @property
    def words(self) -> str:
        """What is missing, why that is not known, and what was taken otherwise than it is."""
        parts = {"N": self.missing_N, "N m": self.missing_Nm}
        missing = " and ".join(f"{x:.4g} {unit}" for unit, x in parts.items() if x)
        return "; ".join(filter(None, (missing, self.reason)))


@dataclass(frozen=True, eq=False)
class Standings(Plain):
    """Whether the bodies of a scene stand: a row a body; none where nothing is free.

    ``simulator.stands`` makes them; their constructor checks nothing.

    Parameters
    ----------
    rows : tuple of Standing
    cone : str
        The friction cone that was asked: a pyramid holds by its corners what a round cone does not.

    Examples
    --------
    >>> run = qr.load_scenario("block_incline", steps=2).run(progress=False)
    >>> standings: qr.Standings = run.stands(1)
    >>> [(row.body, row.stands, round(row.missing_N, 3)) for row in standings]
    [('rough', True, 0.0), ('smooth', False, 0.739)]
    """

    rows: tuple[Standing, ...]
    cone: str

    def __iter__(self) -> Iterator[Standing]:
        return iter(self.rows)

    def __len__(self) -> int:
        return len(self.rows)

    def __getitem__(self, body: str) -> Standing:
        by_name = {row.body: row for row in self.rows}
        if body not in by_name:
            raise MissingKey(f"is no body{nearest_name(body, by_name)}", field=body)
        return by_name[body]

    def __str__(self) -> str:
        if not self.rows:
            return NOTHING_FREE
        rows = [(row.body, WORDS[row.stands], row.words) for row in self.rows]
        return "\n".join(aligned([("body", "stands", f"missing, in the {self.cone}"), *rows]))

"""Where distances come from: the closed forms, or for points of clouds coal."""

from collections.abc import Callable
from typing import Final, Literal, get_args

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import InputError
from quasistatic_ref.parts import part
from quasistatic_ref.quoting import suggestion

CLOSED: Final = "closed"
COAL: Final = "coal"
Distances = Literal["closed", "coal"]
ChangedPairs = Callable[[tuple[ContactPair, ...]], tuple[ContactPair, ...]]
DISTANCES: tuple[Distances, ...] = get_args(Distances)


def measured_pairs(pairs: tuple[ContactPair, ...], distances: str) -> tuple[ContactPair, ...]:
    """Pairs that measure distances of clouds as `distances` says: closed forms, or coal.

    Raises
    ------
    InputError
        If that is unknown, or ``optional/curved`` is missing.
    ContactError
        If coal's distances are asked for, and a pair is none of a cloud and a solid for which they
        are right to rounding.
    """
    if not (isinstance(distances, str) and distances in DISTANCES):
        problem = f"is not a choice{suggestion(str(distances), DISTANCES)}"
        raise InputError(problem, field="distances", value=distances)
    if distances == CLOSED:
        return pairs
    pairs_by_coal: ChangedPairs = part("pairs_by_coal")
    return pairs_by_coal(pairs)

"""Why a step has no derivative, by name."""

from typing import Final, NamedTuple

from quasistatic_ref.step.data import Mask

WEAK = "weakly active row"
CONTRADICTION = "rows that would contradict each other"
ZERO_FRICTION = "friction of zero"
POINTS = "tie of points"
SURFACES = "tie of surfaces"
FEATURE = "feature change"
MANY = "closest points are not unique"
NO_NORMAL = "no normal at zero distance"
TANGENTS = "tangents switch axis"
RIM = "level rim"
HALF_TURN = "half a turn"
NEARLY = "nearly a kink"
CROSSING = "crossing of edges"

KINDS: Final = (
    WEAK, CONTRADICTION, ZERO_FRICTION, POINTS, SURFACES, FEATURE, MANY, NO_NORMAL, TANGENTS, RIM,
    HALF_TURN, NEARLY, CROSSING,
)  # fmt: skip
"""All of them, in one order."""

ONE_SIDED: Final = (WEAK, NEARLY)
"""Those with a derivative on each side."""

SMOOTH_POINTS: Final = (FEATURE, CROSSING)
"""Those of contacts whose points, normal and tangents do not jump."""

NO_KINK: Final = (*ONE_SIDED, ZERO_FRICTION)
"""Those that leave the distance to the next kink as it is."""


class Reason(NamedTuple):
    """One reason for which derivatives do not exist.

    Parameters
    ----------
    kind : str
        One of the names of this module.
    where : tuple of str
        Contacts, pairs or joints; of a row, the contact and the row.
    fields : tuple of str
        The derivatives that it concerns, as in ``("dq_dq",)``.
    sentence : str
    """

    kind: str
    where: tuple[str, ...]
    fields: tuple[str, ...]
    sentence: str

    def __str__(self) -> str:
        return self.sentence


class Obstacle(NamedTuple):
    """A reason, and the columns that do not exist for it.

    Parameters
    ----------
    reason : Reason
    columns : ndarray of bool, shape (P,)
    """

    reason: Reason
    columns: Mask

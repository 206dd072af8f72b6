"""Why a step has no derivative, by name."""

from typing import Final, NamedTuple

from quasistatic_ref.errors import QuasistaticError
from quasistatic_ref.numbers.arrays import Mask

WEAK = "weakly active row"
"""A row touches without load: a contact that is just reached, friction at its limit."""
CONTRADICTION = "rows that would contradict each other"
"""A change makes dependent rows contradict: a ladder that sticks at wall and floor."""
ZERO_FRICTION = "friction of zero"
"""The coefficient of a pair that touches is zero, and cannot become smaller."""
POINTS = "tie of points"
"""One of several equally near points is kept, another is not."""
SURFACES = "tie of surfaces"
"""Two ways out of penetration are equally short."""
FEATURE = "feature change"
"""A closest point or a normal is on the border of a face, an edge or a vertex."""
MANY = "closest points are not unique"
"""Parallel faces, edges along faces; a centre of curvature."""
NO_NORMAL = "no normal at zero distance"
"""Vertices or edges that just touch."""
TANGENTS = "tangents switch axis"
"""Two axes of the world are equally far from the normal, and the pyramid turns: a jump where the
contact slides. Whether it does is not looked at."""
RIM = "level rim"
"""All points of a rim are equally near to the other body."""
HALF_TURN = "half a turn"
"""The target is half a turn away, where (-) jumps."""
NEARLY = "nearly a kink"
"""A change smaller than `nearly` makes a row weakly active."""
CROSSING = "crossing of edges"
"""A contact is where edges or rims cross; a derivative exists, but is not computed."""

KINDS: Final = (
    WEAK, CONTRADICTION, ZERO_FRICTION, POINTS, SURFACES, FEATURE, MANY, NO_NORMAL, TANGENTS, RIM,
    HALF_TURN, NEARLY, CROSSING,
)  # fmt: skip
"""All of them, in one order."""

ONE_SIDED: Final = (WEAK, NEARLY)
"""Those with a derivative on each side."""

SMOOTH_POINTS: Final = (FEATURE, CROSSING)
"""Those of contacts whose points, normal and tangents do not jump."""


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


class NotDifferentiable(QuasistaticError):
    """A derivative is needed where a step has none.

    Parameters
    ----------
    reasons : tuple of Reason
        At least one.

    Examples
    --------
    >>> print(qr.NotDifferentiable(("row +d1 of floor bears no load",)))
    the step has no derivative here: row +d1 of floor bears no load
    """

    def __init__(self, reasons: tuple[object, ...]) -> None:
        self.reasons = reasons
        more = f" (and {len(reasons) - 1} more)" if len(reasons) > 1 else ""
        super().__init__(f"the step has no derivative here: {reasons[0]}{more}")

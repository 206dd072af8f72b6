"""Why a step has no derivative, in words."""

from typing import NamedTuple

from quasistatic_ref.errors import QuasistaticError


class Reason(NamedTuple):
    """Why derivatives do not exist: how the steps of the two sides differ.

    Parameters
    ----------
    fields : tuple of str
        The derivatives that it concerns, as in ``("dq_dq", "dq_dtau")``.
    rows : tuple of str
        Rows that have slack on one side only, as in ``"+d1 of floor/3"``.
    points : tuple of str
        Contacts that are there on one side only, as in ``"floor/3"``.
    sentence : str
    """

    fields: tuple[str, ...]
    rows: tuple[str, ...]
    points: tuple[str, ...]
    sentence: str

    def __str__(self) -> str:
        return self.sentence


class NotDifferentiable(QuasistaticError):
    """A derivative is needed where a step has none.

    Parameters
    ----------
    reasons : tuple of Reason
        At least one: the rows and the points that differ.

    Examples
    --------
    >>> print(qr.NotDifferentiable(("row +d1 of floor/0 has slack on one side only",)))
    the step has no derivative here: row +d1 of floor/0 has slack on one side only
    """

    def __init__(self, reasons: tuple[object, ...]) -> None:
        self.reasons = reasons
        more = f" (and {len(reasons) - 1} more)" if len(reasons) > 1 else ""
        super().__init__(f"the step has no derivative here: {reasons[0]}{more}")

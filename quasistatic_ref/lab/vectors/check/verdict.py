"""What the checker says of one answer."""

from dataclasses import asdict, dataclass, replace

import numpy as np

from quasistatic_ref.lab.vectors.trees import Json
from quasistatic_ref.quoting import one_line

PASSED = "passed"
ACCEPTABLE = "acceptable"
FAILED = "failed"
MISSING = "missing"
UNSUPPORTED = "unsupported"
"""The program says that it does not do this."""
DIGITS = 16.0
"""More correct digits than that float64 does not hold."""
CANCELLED = 1e3
"""Largest size of a field, in units of its tolerance, at which it is a difference of equals."""


@dataclass(frozen=True)
class Difference:
    """The worst number of one field.

    Parameters
    ----------
    field : str
        E.g. ``lam``, or ``contacts.phi``.
    place : str
        Which of its numbers, e.g. ``[3][0]``.
    error : float
        Distance from what is expected [the field's unit].
    tolerance : float
        How large it may be.
    digits : float
        Correct digits: -log10 of the error over the largest number of the field.
    """

    field: str
    place: str
    error: float
    tolerance: float
    digits: float

    @property
    def holds(self) -> bool:
        """Whether the error is within the tolerance."""
        return self.error <= self.tolerance

    @property
    def sentence(self) -> str:
        """What differs, and by how much."""
        return (
            f"{self.field}{self.place} is off by {self.error:.2g} "
            f"(tolerance {self.tolerance:.2g}, {self.digits:.1f} digits)"
        )


@dataclass(frozen=True)
class Verdict:
    """The verdict on one case.

    Parameters
    ----------
    id : str
    verdict : str
        One of PASSED, ACCEPTABLE, FAILED, MISSING, UNSUPPORTED.
    reason : str
        Why it is not simply passed; empty otherwise.
    field : str
        The first field that fails.
    digits : float or None
        Fewest correct digits of a field that was compared number by number.
    without : tuple of str
        Fields of a whole step that are not answered, of which nothing is said.
    extra : tuple of str
        Fields of the answer that its layer does not ask for, and that are not looked at.
    loose : bool
        Whether it is acceptable only because fewer digits than float64's are required.
    """

    id: str
    verdict: str
    reason: str = ""
    field: str = ""
    digits: float | None = None
    without: tuple[str, ...] = ()
    extra: tuple[str, ...] = ()
    loose: bool = False

    @property
    def record(self) -> dict[str, Json]:
        """The verdict as a JSON object."""
        return asdict(self) | {"digits": None if self.digits is None else round(self.digits, 2)}

    def named(self, id: str) -> "Verdict":
        """The verdict with the id of its case."""
        return replace(self, id=id)


def failure(field: str, reason: str, digits: float | None = None) -> Verdict:
    """A verdict that something is wrong, still without the id of its case.

    Names that it repeats are the answer's, and may hold any characters.
    """
    return Verdict("", FAILED, one_line(reason), one_line(field), digits)


def acceptance(reason: str, digits: float | None = None) -> Verdict:
    """A verdict that the answer is another right one."""
    return Verdict("", ACCEPTABLE, reason, "", digits)


def correct_digits(error: float, size: float, tolerance: float) -> float:
    """-log10 [-] of an error relative to the size of its field, 0 to 16.

    A field that is zero but for rounding, such as phi of bodies that just touch, has no digits of
    its own: it counts as right to the last where it is within the tolerance, which is that of
    float64 whatever is asked for.
    """
    if error == 0 or (error <= tolerance and size <= CANCELLED * tolerance):
        return DIGITS
    relative = max(error / size, 10.0**-DIGITS) if size > 0 else 1.0  # the quotient may underflow
    return float(np.clip(-np.log10(relative), 0.0, DIGITS)) + 0.0

"""What findings are called, and how they say lengths."""

import numpy as np

from quasistatic_ref.simulate.finding import Finding

SUBJECTS = {
    "typed": "unit-of-h unit-of-a-shape unit-of-mu-omega sizes-apart density centre-of-mass "
    "inertia no-friction-coefficient no-angle no-count",
    "start": "gravity unsupported-body initial-penetration starts-in-the-air starts-inside "
    "guided-friction too-few-points",
    "run": "unit-of-a-target target-without-effect target-beyond-a-limit force-beyond-a-limit "
    "joint-beyond-a-limit locked-guide sunk-contact crossed-margin rings leap free-fall "
    "failing-backend artifact flat-contact",
    "task": "lost-grip no-motion late-waypoints passes-through idle-contacts far-from-target",
}
"""What findings are of, and their names."""
NAMES = frozenset(" ".join(SUBJECTS.values()).split())
"""The names of findings, which a scene may ignore."""
NOTES = frozenset({"artifact", "flat-contact", "starts-inside"})
"""Those that are notes; others are grave, unless their check says that they are not."""
LONG = 999.5
"""Length that is said in metres, since three digits of it are 1e+03 [mm]."""


def finding(
    name: str, cause: str, remedy: str, of: str = "", grave: bool = True, /, **numbers: float
) -> Finding:
    """A finding by its name, what it says, what it is about, and its numbers [any unit].

    Parameters
    ----------
    name : str
        One of ``NAMES``.
    cause, remedy : str
    of : str
        What it is about.
    grave : bool
        Whether it is, unless it is one of ``NOTES``.
    **numbers : float
        By names that end in their unit.
    """
    return Finding(name, grave and name not in NOTES, remedy, cause, numbers, of)


def others(count: int, what: str = "") -> str:
    """How many more are as suspect as the one that is named."""
    return f" ({count} more{what} are as suspect)" if count else ""


def amount(x: float, unit: str) -> str:
    """A length [m] or an angle [rad], as its unit says."""
    return length(x) if unit == "m" else f"{np.degrees(x):.3g} deg"


def length(x: float) -> str:
    """A length [m] of a motion, to three digits: none below a hundredth of a millimetre."""
    return "0 mm" if abs(x) < 5e-6 else distance(x)


def distance(x: float, digits: int = 3) -> str:
    """A length [m] to some digits, however short it is: in millimetres up to 1 m.

    A remedy has four: what is moved so is less than 1 mm off, up to 10 m.
    """
    mm = 1e3 * abs(x)
    return f"{abs(x):.{digits}g} m" if mm >= LONG else f"{mm:.{digits}g} mm"

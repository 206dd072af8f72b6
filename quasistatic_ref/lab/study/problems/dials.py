"""The families of the set, each with its dial: the number that makes its problems harder."""

from typing import Any


def _dial(name: str, unit: str, first: float, most: float) -> dict[str, Any]:
    """Its name and unit; its easy end and its hard end, whichever is larger [the dial's unit]."""
    return {"name": name, "unit": unit, "first": first, "most": most}


SCENARIOS = "scenarios"
"""Steps of runs, which have no dial: the family that studies make problems of."""
DIALS = {
    "moving": _dial("steps between one problem and the next", "-", 1.0, 16.0),
    "time_step": _dial("h", "s", 0.1, 1e-4),
    "closest_points": _dial("k", "-", 1.0, 50.0),
    "ellipsoid": _dial("contacts", "-", 2.0, 12.0),
    "contacts": _dial("contacts", "-", 2, 200),
    "mass_ratio": _dial("ratio of masses", "-", 1, 1e9),
    "bodies": _dial("bodies", "-", 2, 10),
    "condition": _dial("condition of K_q", "-", 1, 1e12),
    "gaps": _dial("largest gap", "m", 1e-2, 1e-14),
    "friction": _dial("friction coefficient", "-", 1e-3, 1e3),
    "copies": _dial("copies of each contact", "-", 1, 16),
    "near_copies": _dial("difference of two contacts", "-", 1e-1, 1e-9),
    "narrow": _dial("clearance", "m", 1e-3, 1e-13),
    "capped_wedge": _dial("angle", "rad", 1e-1, 1e-8),
    "limits": _dial("clearance of a joint", "m, rad", 1e-2, 1e-13),
    "large": _dial("bodies", "-", 5, 50),
    "infeasible": _dial("overlap", "m", 1e-2, 1e-13),
    "jammed": _dial("overlap", "m", 1e-2, 1e-13),
}

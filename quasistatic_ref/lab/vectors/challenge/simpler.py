"""A failing case made smaller, by moves after each of which it fails in the same way.

Moves give inputs that are simpler than one: fewer contacts and bodies, poses that are none, fewer
digits. They need not be valid; an invalid one is not sent.
"""

from collections.abc import Callable, Iterator

import numpy as np

from quasistatic_ref.lab.vectors.challenge.removals import (
    fewer_bodies,
    fewer_coordinates,
    fewer_parts,
    replaced,
)
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.tables import ORIGIN, UPRIGHT
from quasistatic_ref.lab.vectors.trees import mapped, nodes

KEPT = ("rows", "k", "n", "d1", "d2", "actuated", "joint", "compliance")
"""Fields whose numbers are no lengths, or that change together."""
FRAME = ("n", "d1", "d2")
ONES = ("mu_v", "mu_omega", "mass", "h", "radius", "multiplier")
BUDGET = 250
"""At most so many inputs are tried."""


def in_digits(value: Json, digits: int) -> Json:
    """All numbers of a value with so many significant digits."""

    def rounded(x: Json) -> Json:
        return float(f"{x:.{digits}g}") + 0.0 if isinstance(x, float) else x

    return mapped(value, rounded, KEPT)


def rounded_case(name: str, case: Json) -> Json:
    """The same with numbers of one digit and frames along the axes; a whole step as it is."""
    if name in ("step", "derivative"):
        return case  # rounded, what nearly touches would not
    changed = in_digits(case, 1)
    for contact in changed.get("contacts", []):
        contact |= axes_of(contact)
    return changed


def axes_of(contact: Json) -> Json:
    """A frame along the axes, n along the nearest."""
    n = np.array(contact["n"])
    axis = int(np.abs(n).argmax())
    along = np.sign(n[axis]) * np.eye(3)[axis]
    d1 = np.eye(3)[int(np.abs(along).argmin())]
    frame = zip(FRAME, (along, d1, np.cross(along, d1)), strict=True)
    return {key: (value + 0.0).tolist() for key, value in frame}


def simpler_poses(case: Json) -> Iterator[Json]:
    """Each pose as that of the origin, or without its turn; each frame along the axes."""
    for path, value in nodes(case):
        if isinstance(value, dict) and "quaternion" in value:
            if value != ORIGIN:
                yield replaced(case, path, ORIGIN)
                yield replaced(case, (*path, "quaternion"), UPRIGHT)
        elif isinstance(value, dict) and set(FRAME) <= set(value):
            frame = axes_of(value)
            if any(frame[key] != value[key] for key in FRAME):
                yield replaced(case, path, {**value, **frame})


def simpler_fields(case: Json) -> Iterator[Json]:
    """Numbers that are one, a paper's cone, and points that are at the origin."""
    for path, value in nodes(case):
        if path and path[-1] in ONES and value != 1.0:
            yield replaced(case, path, 1.0)
    if "cone" in case and case["cone"] != "pyramid":
        yield {**case, "cone": "pyramid"}


def simpler_numbers(case: Json) -> Iterator[Json]:
    """All numbers, those of a list, or one: of few digits, or none."""
    for digits in (1, 2, 3):
        yield in_digits(case, digits)
    for path, value in nodes(case):
        if path and path[-1] not in KEPT and not set(path) & set(FRAME):
            if isinstance(value, list) and value and not isinstance(value[0], dict | str):
                yield replaced(case, path, mapped(value, lambda _: 0.0))
                for digits in (1, 2, 3):
                    yield replaced(case, path, in_digits(value, digits))
            elif isinstance(value, float) and value:
                for other in (0.0, in_digits(value, 1), in_digits(value, 2), in_digits(value, 3)):
                    yield replaced(case, path, other)


MOVES: tuple[Callable[[Json], Iterator[Json]], ...] = (
    fewer_parts,
    fewer_bodies,
    fewer_coordinates,
    simpler_poses,
    simpler_fields,
    simpler_numbers,
)
"""The greatest first."""


def shrunk(case: Json, fails: Callable[[Json], bool], budget: int = BUDGET) -> Json:
    """The smallest input that is found: no single move makes it smaller, or the budget is spent.

    Parameters
    ----------
    case : dict
        An input that fails.
    fails : callable
        Whether an input is valid and fails in the same way.
    budget : int
        How often `fails` may be called.
    """
    tried: set[str] = {repr(case)}
    again = True
    while again:
        again = False
        for move in MOVES:
            found = True
            while found:
                found = False
                for other in move(case):
                    key = repr(other)
                    if key in tried:
                        continue
                    if len(tried) > budget:
                        return case
                    tried.add(key)
                    if fails(other):
                        case = other
                        found = True
                        again = True
                        break
    return case

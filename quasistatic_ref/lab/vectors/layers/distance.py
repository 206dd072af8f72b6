"""Layer `distance`: shapes and poses -> phi, alpha, beta, n."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from quasistatic_ref.lab.vectors.distances.solid_pair import witnesses
from quasistatic_ref.lab.vectors.distances.witness import Witness
from quasistatic_ref.lab.vectors.exact.precision import Real, number, rounded_results
from quasistatic_ref.lab.vectors.expected import Expected, Json, Tolerance
from quasistatic_ref.lab.vectors.trees import mapped

CURVED = ("cylinder", "cone", "ellipsoid")
SIMPLE = ("sphere", "halfspace", "cloud")
"""Whatever meets these has its normal from one closed form."""

FIELDS = ("phi", "alpha", "beta", "n")
KEPT = ("kind", "vertices", "points")
"""Fields of a shape that stay: a hull's corners would become others, and a pose moves them."""
EPS = 2.0**-52

ROUNDINGS = 16.0
"""Units of rounding that are allowed whatever the condition: two products with rotations, a
normal, and the sum of the coordinates with margins."""

SHIFT = 4.0
"""Units of rounding by which lengths and poses are changed to see what becomes of the answer: a
rotation made from a quaternion is off by that much."""

CHANGES = 16
"""How many such changes are tried: of parallel faces, each leaves the nearest corner where it was
with a chance of 9/16 (two tilts, each the sum of two signs), and all of them with 1e-4."""

JUMP = 1e-4
"""A change of the points, relative to the size of the case, or of n, above which they have become
others: corners of faces that are parallel but for rounding. A point of capsules that cross at
1e-6 rad jumps too; an n that is the difference of points 1e-9 m apart moves by 1e-6."""


def expected(case_input: Json) -> Expected:
    """Closest points; of a cloud, lists over its points."""
    output, digits, unique = answer(case_input)
    tolerance, settled = _tolerance(case_input, output, unique)
    cloud = "cloud" in (case_input["alpha"]["kind"], case_input["beta"]["kind"])
    if not cloud:
        output, digits = ({key: value[0] for key, value in t.items()} for t in (output, digits))
    return Expected(output, digits, {"unique": all(unique) and settled}, tolerance)


def answer(case: dict[str, Any]) -> tuple[dict[str, Json], dict[str, Json], list[bool]]:
    """Output and digits, as lists over the points of a cloud or of one, and what is unique."""
    points: list[Witness] = []

    def fields() -> dict[str, Any]:
        points[:] = witnesses(case)
        return {key: [getattr(one, key) for one in points] for key in FIELDS}

    output, digits = rounded_results(fields)
    return output, digits, [one.unique for one in points]


def _tolerance(
    case: dict[str, Any], output: dict[str, Json], unique: list[bool]
) -> tuple[dict[str, Tolerance], bool]:
    """What a change of the input by its own rounding does to the answer, and twice as much.

    A field that the change turns to another of several answers is compared by the checker's
    rules for those, not by its value: such changes are left out. And whether there was none where
    the answer itself is unique.
    """
    shapes = case["alpha"], case["beta"]
    lengths = [value for shape in shapes for key, value in shape.items() if key != "kind"]
    places = [case["pose_alpha"]["xyz"], case["pose_beta"]["xyz"], output["alpha"], output["beta"]]
    size = max(abs(x) for x in _leaves([*lengths, *places]))
    moves = dict.fromkeys(FIELDS, 0.0)
    settled = True
    for seed in range(CHANGES):
        other, _, still = answer(_changed_case(case, _signs(seed), size))
        for k in range(len(unique)):
            change = {key: _distance(other[key][k], output[key][k]) for key in FIELDS}
            same = all(change[key] <= JUMP * (1.0 if key == "n" else size) for key in FIELDS)
            settled = settled and (same or not unique[k])
            for key in FIELDS if same and unique[k] and still[k] else ("phi",):
                moves[key] = max(moves[key], change[key])
    # Where neither solid's own normal is at hand, n is (beta - alpha) / phi, of the axes if
    # there is a capsule; its error carries over to a point of the capsule.
    thickness = sum(shape["radius"] for shape in shapes if shape["kind"] == "capsule")
    normal = 0.0
    kinds = {shape["kind"] for shape in shapes}
    if kinds.isdisjoint(SIMPLE) and not kinds.isdisjoint(CURVED):
        normal = SHIFT * EPS * size / (output["phi"][0] + thickness)
    tolerance = {}
    for key in FIELDS:
        scale = 1.0 if key == "n" else size
        floor = ROUNDINGS * EPS * scale
        what = "unit vectors" if key == "n" else f"lengths up to {size:.3g} m"
        reason = f"{ROUNDINGS:g} units of rounding of {what}"
        floor += normal * {"phi": 0.0, "n": 1.0}.get(key, thickness)
        if normal and key != "phi":
            reason += f", and the {normal:.2g} of an n that is a difference of near points"
        if 2 * moves[key] > floor:
            by = f"{moves[key]:.2g} by which poses off by {SHIFT:g} units move it"
            reason += f", and twice the {by}"
        tolerance[key] = Tolerance(floor + 2 * moves[key], reason)
    return tolerance, settled


def _changed_case(case: dict[str, Any], signs: Iterator[int], size: float) -> dict[str, Any]:
    """The case with every length and pose changed by some units of rounding, exactly."""
    unit = number(SHIFT * EPS)

    def moved(value: float, scale: float) -> Real:
        return number(value) + next(signs) * unit * number(scale)

    changed = dict(case)
    for side in ("alpha", "beta"):
        pose = case[f"pose_{side}"]
        longest = max(abs(x) for x in pose["quaternion"])
        changed[f"pose_{side}"] = {
            "xyz": [moved(x, size) for x in pose["xyz"]],
            "quaternion": [moved(x, longest) for x in pose["quaternion"]],
        }
        changed[side] = mapped(case[side], lambda x: moved(x, abs(x)), KEPT)
    return changed


def _signs(seed: int) -> Iterator[int]:
    """Signs without a pattern, the same everywhere (D. Knuth's MMIX generator)."""
    state = seed
    while True:
        state = (6364136223846793005 * state + 1442695040888963407) % (1 << 64)
        yield 1 if state >> 63 else -1


def _distance(first: Any, second: Any) -> float:
    """The largest difference of two numbers in the same place."""
    return float(np.abs(np.subtract(first, second)).max())


def _leaves(value: Any) -> list[float]:
    return [x for part in value for x in _leaves(part)] if isinstance(value, list) else [value]


def own(case_input: Json) -> Json:
    """The package's closest points."""
    from quasistatic_ref.lab.vectors.own.shapes import own_closest_points

    return own_closest_points(case_input)

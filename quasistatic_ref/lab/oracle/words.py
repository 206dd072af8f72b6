"""Words of a contact, and of two shapes that meet: what the parts of a scene have.

A word may be one of a kind, as ``joint under the contact: planar``.
"""

from collections.abc import Sequence

import numpy as np

from quasistatic_ref.lab.program.distance import core
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.tables import ORIGIN
from quasistatic_ref.step.arrays import Array

Words = frozenset[str]
Pose = tuple[Array, Array]
"""(R, t), as ``frame`` gives it."""
AXIS = 1e-9
"""Entry of a normal, or difference of heights [m], that is none."""


def pair_words(alpha: Json, beta: Json) -> set[str]:
    """Of a pair of shapes."""
    kinds = alpha["kind"], beta["kind"]
    return {f"pair: {' on '.join(kinds)}", *(f"shape: {kind}" for kind in kinds)}


def side_words(shapes: Sequence[Json], poses: Sequence[Pose], phi: float, n: Json) -> set[str]:
    """Of two shapes in the world, alpha's first: how they meet."""
    met = []
    for shape, pose, sign in zip(shapes, poses, (1.0, -1.0), strict=True):
        if found := core(shape, pose):
            heights = sign * found[0] @ n
            ends = int(np.count_nonzero(heights >= heights.max() - AXIS))
            met.append(("corner", "edge", "face")[min(ends, 3) - 1])
        elif shape["kind"] in ("cloud", "halfspace"):
            met.append(shape["kind"])
        else:
            entries = np.count_nonzero(np.abs(np.array(n) @ pose[0]) > AXIS)
            met.append(f"{shape['kind']} along {entries} of its axes")
    return {f"meeting: {' on '.join(met)}", "phi below 0" if phi < 0 else "phi above 0"}


def contact_words(case: Json, contact: Json, pair: Json) -> set[str]:
    """Of a contact of a pair: its rows, its shapes, the joints that carry its sides."""
    found = {f"rows: {pair['rows']}"} if "rows" in pair else set()
    if "phi" in contact:
        found.add("phi below 0" if contact["phi"] < 0 else "phi above 0")
    bodies = {body["name"]: body for body in case.get("mechanism", {}).get("bodies", [])}
    on = {side: contact.get(f"{side}_body") for side in ("alpha", "beta")}
    if "shapes" in case:
        shapes = {side: case["shapes"][pair[side]] for side in on}
        on = {side: shape["body"] for side, shape in shapes.items()}
        found |= pair_words(*(shape["shape"] for shape in shapes.values()))
        found |= {"k above 1"} if pair["k"] > 1 else set()
    for side, name in on.items():
        found |= {f"{side} on a body"} if name is not None else set()
        while name in bodies:
            body = bodies[name]
            name = body["parent"]
            found.add(f"joint under the contact: {body['joint']}")
            found |= {f"joint of a body under the contact: {body['joint']}"} if name else set()
            found |= {"a mimic under the contact"} if "mimic" in body else set()
            found |= {"a placement under the contact"} if body["placement"] != ORIGIN else set()
    return found

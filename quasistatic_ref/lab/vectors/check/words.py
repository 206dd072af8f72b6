"""Words of each number of an output: of its case, and of its place there.

A word may be one of a kind, as ``joint: planar``.
"""

from collections import defaultdict
from collections.abc import Iterator, Sequence

import numpy as np

from quasistatic_ref.lab.program.distance import core
from quasistatic_ref.lab.program.rotation import frame, rotation
from quasistatic_ref.lab.program.rows import cone_table
from quasistatic_ref.lab.vectors.check.compare import WRENCH, parts
from quasistatic_ref.lab.vectors.converters import UNITS, places
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.features import features
from quasistatic_ref.lab.vectors.tables import ORIGIN
from quasistatic_ref.lab.vectors.trees import Path, nodes
from quasistatic_ref.step.arrays import Array

Words = frozenset[str]
Pose = tuple[Array, Array]
"""(R, t), as ``frame`` gives it."""
SIDES = ("alpha", "beta")
AXES = {
    "J": ("contact", "row of J", "coordinate"),
    "A": ("row", "coordinate"),
    "H": ("coordinate", "coordinate"),
    "q": ("entry of q",),
    "q_next": ("entry of q",),
    "net": ("body", "component"),
    "wrench": ("contact", "component of a wrench"),
    "forces": ("contact", "component of a wrench"),
    **dict.fromkeys(("b", "lam", "slack"), ("row",)),
    **dict.fromkeys(("g", "delta_q", "A_lam"), ("coordinate",)),
    **dict.fromkeys(("phi", "index"), ("contact",)),
    **dict.fromkeys(("n", "d1", "d2", "alpha", "beta"), ("contact", "axis")),
}
"""What the indices of a number of a field are of."""
ELSEWHERE = ("cone", "floating base", "joint", "phi", "planar base", "rows")
"""Beginnings of features that are words of places, or kinds."""
AXIS = 1e-9
"""Entry of a normal, or difference of heights [m], that is none."""
TURNS = (1e-6, 1e-3, 0.1, 0.3, 1.0)
"""Sizes at which the words of a turn change [rad]."""


def words_of_numbers(case: Json, output: Json, field: str) -> Iterator[tuple[Path, Words]]:
    """The place of each number of a field, and its words; all words of the case without a field.

    Parameters
    ----------
    case, output : dict
        The input, and what is expected.
    field : str
        As ``parts`` names it.
    """
    own = frozenset(_of_case(case, output))
    axes = AXES.get(field.rpartition(".")[2], ())
    if "pose_alpha" in case and isinstance(output["phi"], float):
        own |= _of_sides(case, output["phi"], output["n"])
        axes = axes[1:]  # the contact is the case
    known = _of_places(case, output)
    if field not in parts(output):
        own = own.union(*(words for places in known.values() for words in places.values()))
    for path, value in nodes(parts(output).get(field)):
        if not isinstance(value, list | dict):
            here = (known[axis].get(i, ()) for axis, i in zip(axes, path, strict=False))
            yield path, own.union(*here)


def _of_case(case: Json, output: Json) -> set[str]:
    found = {name for name in features(case, output) if not name.startswith(ELSEWHERE)}
    found = {name for name in found if " on " not in name}
    if "cone" in case:
        found.add(f"cone: {case['cone'].partition('-')[0]}")
    if "pose_alpha" in case:
        found |= _of_pair(case["alpha"], case["beta"])
        for side in ("alpha", "beta"):
            turned = np.any(rotation(case[f"pose_{side}"]["quaternion"]) != np.eye(3))
            found |= {f"{side} turned"} if turned else set()
    return found


def _of_pair(alpha: Json, beta: Json) -> set[str]:
    """Of a pair of shapes."""
    kinds = alpha["kind"], beta["kind"]
    return {f"pair: {' on '.join(kinds)}", *(f"shape: {kind}" for kind in kinds)}


def _of_places(case: Json, output: Json) -> dict[str, dict[Json, set[str]]]:
    """Of each index, by what it is of."""
    found: dict[str, dict[Json, set[str]]] = defaultdict(dict)
    found["axis"] = {i: {f"along the world's axis: {name}"} for i, name in enumerate("xyz")}
    found["row of J"] = {i: {"slip", *words} for i, words in found["axis"].items()} | {3: {"spin"}}
    found["component"] = {i: {"force" if i < 3 else "torque"} for i in range(6)}
    found["component of a wrench"] = {i: {name} for i, name in enumerate(WRENCH)}
    if "mechanism" in case:
        for body, q, v in places(case["mechanism"]):
            turns = {"prismatic": 0, "floating": 3}.get(body["joint"], 1)
            at = q.start + UNITS.get(body["joint"], 1 - turns)
            words = _of_joint(case, body, v, turns)
            for axis, entries, first in (("coordinate", v, v.stop - turns), ("entry of q", q, at)):
                for i in range(entries.start, entries.stop):
                    part = "rotation" if i >= first else "shift"
                    found[axis][i] = words | {f"entries of a {part}"}
    if isinstance(output.get("phi"), list):
        for i, (phi, n) in enumerate(zip(output["phi"], output["n"], strict=True)):
            found["contact"][i] = _of_sides(case, phi, n)
    for j, contact in enumerate(case.get("contacts", output.get("contacts", []))):
        pair = next((p for p in case.get("pairs", []) if p["name"] == contact["pair"]), contact)
        own = found["contact"][j] = contact_words(case, contact, pair)
        for side in ("alpha", "beta"):
            words = found["body"].setdefault(contact.get(f"{side}_body"), set())
            words |= own | {f"{side} of a contact"}
        if "rows" in pair and case.get("cone", "ellipsoid") != "ellipsoid":
            for t in cone_table(case["cone"], pair["rows"], 1.0):
                names = [name for name, x in zip(("d1", "d2", "spin"), t, strict=True) if x]
                row = {f"{name} in the row" for name in names or ["n alone"]}
                found["row"][len(found["row"])] = own | row
    return found


def _of_sides(case: Json, phi: float, n: Json) -> set[str]:
    """Of two shapes of a case: how they meet."""
    shapes = [case[side] for side in SIDES]
    return side_words(shapes, [frame(case[f"pose_{side}"]) for side in SIDES], phi, n)


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


def _of_joint(case: Json, body: Json, v: slice, turns: int) -> set[str]:
    """Of all entries of a joint."""
    kind = f"{'actuated' if body.get('actuated') else 'un-actuated'} joint: {body['joint']}"
    found = {f"joint: {body['joint']}", kind}
    leaders = [other["mimic"]["of"] for other in case["mechanism"]["bodies"] if "mimic" in other]
    found |= {"a joint that another follows"} if body["name"] in leaders else set()
    if "delta_q" in case:
        size = np.linalg.norm(case["delta_q"][v][-turns:] if turns else [])
        found |= {f"a turn {'from' if size >= x else 'below'} {x} rad" for x in TURNS}
    return found


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
        found |= _of_pair(*(shape["shape"] for shape in shapes.values()))
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

"""Candidate contacts of a pair of shapes in the world, and those that are kept.

Of a cloud on a solid: every point. Of two solids: alpha's corners on beta, beta's corners on alpha,
crossings of the edges of boxes, and the closest pair, in that order; for one contact, the closest
pair alone. Corners whose normal is not about the closest pair's are none. The k of least signed
distance are kept, those that repeat an earlier one after all others, and so the closest pair where
k others are as near, and crossings where k corners are. Everything is decided on distances, points
and normals that are rounded to float64.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from operator import itemgetter

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.program.candidates import (
    FACING,
    FILLED,
    bearing,
    crossing_index,
    crossings,
    edges,
    lateness,
    most_candidates,
    ways,
)
from quasistatic_ref.lab.program.distance import corners
from quasistatic_ref.lab.program.rotation import frame
from quasistatic_ref.lab.vectors.distances.shapes import placed_shape
from quasistatic_ref.lab.vectors.distances.solid_pair import witnesses
from quasistatic_ref.lab.vectors.exact.precision import (
    IDENTITY,
    Vector,
    rounded_results,
    vector,
)
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers import layer
from quasistatic_ref.tolerances import REPEATED

FIELDS = ("phi", "alpha", "beta", "n")
TIED = 1e-12
"""Difference of distances [m] below which it is rounding that decides what is kept; and of normals
[-] that are one."""
LIMIT = 1e-6
"""Of cosines: so near to that of 0.25 rad rounding decides, too [-]."""


@dataclass(frozen=True)
class Chosen:
    """The contacts of one pair.

    Parameters
    ----------
    contacts : list of dict
        ``index``, ``phi``, ``alpha``, ``beta``, ``n``, in the order of their index.
    clear : bool
        Whether which ones they are does not hang on rounding.
    unique : bool
        Whether points and normals of all of them have no alternative.
    tolerance : dict of str to float
        Of each field.
    """

    contacts: list[Json]
    clear: bool
    unique: bool
    tolerance: dict[str, float]


def chosen_points(alpha: Json, beta: Json, pose_alpha: Json, pose_beta: Json, k: int) -> Chosen:
    """The contacts of a pair.

    Parameters
    ----------
    alpha, beta : dict
        Shapes.
    pose_alpha, pose_beta : dict
        In the world.
    k : int

    Raises
    ------
    InputError
        If k > 1 for a solid whose corners depend on where the other is.
    """
    case = {"alpha": alpha, "beta": beta, "pose_alpha": pose_alpha, "pose_beta": pose_beta}
    candidates = [one for part in parts(case, k) for one in _candidates(part)]
    index = list(range(len(candidates)))
    if k == 1 or "cloud" in (alpha["kind"], beta["kind"]):
        return _kept_candidates(candidates, index, k, corners=None)
    last = len(candidates) - 1
    nearest = candidates[last]
    candidates[:last] = [_bearing_corner(case, one, nearest) for one in candidates[:last]]
    if alpha["kind"] == beta["kind"] == "box":
        crossed = _crossings(case, nearest)
        candidates[last:last] = [one for _, one in crossed]
        index[last:last] = [int(crossing_index(last, k, *edges)) for edges, _ in crossed]
    cosines = np.array([one.numbers["n"] for one in candidates]) @ nearest.numbers["n"]
    about = np.flatnonzero(cosines >= FACING).tolist()
    found = _kept_candidates(
        [candidates[i] for i in about], [index[i] for i in about], k,
        corners=sum(index[i] < last for i in about), at_end=_is_vertex_at_edge(case, candidates),
    )  # fmt: skip
    far = {**nearest.numbers, "phi": FILLED}
    filling = range(min(k, most_candidates(alpha, beta, last)) - len(about))
    contacts = [*found.contacts, *({"index": last + 1 + i, **far} for i in filling)]
    clear = found.clear and bool(np.abs(cosines - FACING).min() > LIMIT)
    contacts.sort(key=itemgetter("index"))
    return replace(found, contacts=contacts, clear=clear)


def parts(case: Json, k: int) -> list[Json]:
    """The cases of the layer `distance` that the candidates of a pair come from, in their order."""
    if k == 1 or "cloud" in (case["alpha"]["kind"], case["beta"]["kind"]):
        return [case]
    corners = {side: _corners(case[side]) for side in ("alpha", "beta")}
    clouds = {s: {"kind": "cloud", "points": points} for s, points in corners.items() if points}
    return [*({**case, side: cloud} for side, cloud in clouds.items()), case]


def _corners(shape: Json) -> Json:
    if shape["kind"] not in ("box", "sphere", "halfspace", "ellipsoid"):
        problem = "has corners that no layer gives; use k = 1"
        raise InputError(problem, field="shape.kind", value=shape["kind"])
    return np.array(corners(shape)).tolist()


@dataclass(frozen=True)
class _Candidate:
    """One contact, and the case of the layer `distance` that has it for its only answer."""

    numbers: dict[str, Json]
    unique: bool
    case: Json


def _candidates(case: Json) -> list[_Candidate]:
    found, _ = rounded_results(
        lambda: [{**one.table(), "unique": one.unique} for one in witnesses(case)]
    )
    for side in ("alpha", "beta"):
        if case[side]["kind"] == "cloud":
            alone = [{"kind": "cloud", "points": [point]} for point in case[side]["points"]]
            return [
                _Candidate(numbers, numbers.pop("unique"), {**case, side: shape})
                for numbers, shape in zip(found, alone, strict=True)
            ]
    return [_Candidate(found[0], found[0].pop("unique"), case)]


def _bearing_corner(case: Json, own: _Candidate, nearest: _Candidate) -> _Candidate:
    """A corner as it bears with the pair's normal: which way is decided on rounded numbers."""
    side, other = ("alpha", "beta") if own.case["alpha"]["kind"] == "cloud" else ("beta", "alpha")
    out = 1 if other == "alpha" else -1
    R, t = frame(case[f"pose_{other}"])
    x = (np.array(own.numbers[side]) - t) @ R
    found = [
        way
        for way in ways(case[other], out * np.array(nearest.numbers["n"]) @ R)
        if bearing(case[other], x[None], way)[1][0]
    ]
    own_way = out * np.array(own.numbers["n"]) @ R
    if not found or np.abs(found[-1] - own_way).max() <= TIED:
        return own
    way = found[-1]

    def place() -> Json:
        box = placed_shape(case[other], case[f"pose_{other}"])
        corner = placed_shape(own.case[side], case[f"pose_{side}"])
        point = corner.world(corner.points[0])
        face = np.count_nonzero(way) == 1
        n = box.world_direction(vector(way)) if face else out * witnesses(case)[0].n
        reach = sum(
            half * abs(n @ box.world_direction(axis))
            for half, axis in zip(box.sizes, IDENTITY, strict=True)
        )
        phi = n @ (point - box.t) - reach
        foot = point - phi * n
        alpha, beta = (foot, point) if other == "alpha" else (point, foot)
        return {"phi": phi, "alpha": alpha, "beta": beta, "n": out * n}

    return _Candidate(rounded_results(place)[0], nearest.unique, nearest.case)


def _is_vertex_at_edge(case: Json, candidates: list[_Candidate]) -> bool:
    """Whether edges of two boxes may cross at an end: closest are a corner and no face."""
    nearest = candidates[-1].numbers
    axes = np.concatenate([frame(case[f"pose_{side}"])[0].T for side in ("alpha", "beta")])
    return bool(np.abs(axes @ nearest["n"]).max() < 1 - LIMIT) and any(
        np.abs(np.array(one.numbers["alpha"]) - nearest["alpha"]).max() <= REPEATED
        for one in candidates[:-1]
    )


def _crossings(case: Json, nearest: _Candidate) -> list[tuple[tuple[int, int], _Candidate]]:
    """Where edges of two boxes cross: which do is decided on rounded numbers, where is not."""
    poses = [frame(case[f"pose_{side}"]) for side in ("alpha", "beta")]
    at = [np.array(nearest.numbers[key]) for key in FIELDS]
    found = []
    for i, j, *_ in crossings(case["alpha"], poses[0], case["beta"], poses[1], at):

        def place(i: int = i, j: int = j) -> Json:
            n = witnesses(case)[0].n
            tail, head = _edge(case, "alpha", i)
            start, end = _edge(case, "beta", j)
            u = head - tail
            v = end - start
            w = start - tail
            steep = np.cross(u, v) @ n
            alpha = tail + np.cross(w, v) @ n / steep * u
            beta = start + np.cross(w, u) @ n / steep * v
            return {"phi": (beta - alpha) @ n, "alpha": alpha, "beta": beta, "n": n}

        found.append(((i, j), _Candidate(rounded_results(place)[0], nearest.unique, nearest.case)))
    return found


def _edge(case: Json, side: str, i: int) -> list[Vector]:
    """Ends of an edge of a box in the world, in exact numbers."""
    box = placed_shape(case[side], case[f"pose_{side}"])
    return [box.world(vector(end)) for end in edges(case[side])[0][i].tolist()]


def _kept_candidates(
    candidates: Sequence[_Candidate],
    index: Sequence[int],
    k: int,
    *,
    corners: int | None,
    at_end: bool = False,
) -> Chosen:
    phi, alpha, n = (
        np.array([one.numbers[key] for one in candidates]) for key in ("phi", "alpha", "n")
    )
    late = [False] * len(candidates)
    spare = False
    if corners is not None:
        late, spare = lateness(phi, alpha, n, k, REPEATED, corners)
    order = sorted(range(len(candidates)), key=lambda i: (late[i], phi[i], i))
    kept = sorted(order[:k], key=lambda i: index[i])
    rest = order[k:]
    last = order[len(kept) - 1]
    clear = not rest or late[rest[0]] != late[last] or phi[rest[0]] - phi[last] > TIED
    clear = clear and not (at_end and np.sum(~np.array(late)) < k)
    if corners is not None and len(candidates) > k and not candidates[-1].unique:
        # The closest pair may then be any point of an edge or a face, and no corner again.
        clear = clear and spare
    answers = [layer("distance").expected(candidates[i].case) for i in kept]
    return Chosen(
        contacts=[{"index": index[i], **candidates[i].numbers} for i in kept],
        clear=bool(clear),
        unique=all(answer.flags["unique"] for answer in answers),
        tolerance={
            name: max(answer.tolerance[name].absolute for answer in answers) for name in FIELDS
        },
    )

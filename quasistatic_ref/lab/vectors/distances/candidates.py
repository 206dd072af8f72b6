"""Candidate contacts of a pair of shapes in the world, and those that are kept.

Of a cloud on a solid: every point. Of two solids: alpha's corners on beta, beta's corners on alpha,
crossings of the edges of boxes, and the closest pair, in that order; for one contact, the closest
pair alone. Corners whose normal is not about the closest pair's are none. The k that rank first
are kept: distances are rounded to rank, those of equal rank go by their index, and those that
repeat an earlier one come after all others. The closest pair is none where others span it.
Everything is decided on distances, points and normals that are rounded to float64.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from operator import attrgetter, itemgetter

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.program.candidates import (
    FACING,
    FILLED,
    bearing,
    crossing_index,
    crossings,
    edges,
    gaps,
    is_spanned,
    most_candidates,
    repeats,
    smaller,
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
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import REPEATED

FIELDS = ("phi", "alpha", "beta", "n")
TIED = 1e-12
"""Where two distances differ by no more, rounding decides which is kept [m]. Normals that differ by
no more, in any component, are one [-]."""
LIMIT = 1e-6
"""Where a cosine is that near to cos 0.25, rounding decides whether there is a candidate [-]."""


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
    every = candidates(case, k)
    least = smaller(alpha, beta)
    if not every.of_two:
        return _kept_candidates(every.about, k, least)
    chosen = _kept_candidates(every.about, k, least, of_two=True)
    contacts = chosen.contacts + [{"index": one.index, **one.numbers} for one in every.filling]
    contacts.sort(key=itemgetter("index"))
    clear = chosen.clear and every.clear
    certain = [one for one in every.about if one not in every.doubtful]
    indices = [one["index"] for one in chosen.contacts]
    for crossed in ([], every.doubtful) if every.doubtful else ():
        kept = _kept_candidates([*certain, *crossed], k, least, of_two=True)
        clear = clear and indices == [one["index"] for one in kept.contacts]
    return replace(chosen, contacts=contacts, clear=clear)


@dataclass(frozen=True)
class Candidate:
    """One that may be a contact, and a case of the layer `distance`.

    Parameters
    ----------
    index : int
    numbers : dict
        ``phi``, ``alpha``, ``beta``, ``n``.
    unique : bool
        Whether alpha, beta and n have no alternative.
    case : dict
        Whose only answer this is, or the pair's, if it bears along another way.
    is_closest : bool
        Whether alpha and beta are closest points of the case.
    """

    index: int
    numbers: dict[str, Json]
    unique: bool
    case: Json
    is_closest: bool = True


@dataclass(frozen=True)
class Candidates:
    """Those of a pair.

    Parameters
    ----------
    about : list of Candidate
        Corners, crossings and, last, the closest pair, if they do not span it; or points of a
        cloud. Their normals are about the closest pair's.
    filling : list of Candidate
        The closest pair again, as often as it fills the number.
    of_two : bool
        Whether they are those of two solids, and not points of a cloud or the closest pair alone.
    clear : bool
        Whether rounding does not decide which normals are about the closest pair's, nor whether it
        is a candidate.
    doubtful : list of Candidate
        Crossings at an end of an edge: rounding decides whether they are candidates.
    """

    about: list[Candidate]
    filling: list[Candidate]
    of_two: bool = False
    clear: bool = True
    doubtful: Sequence[Candidate] = ()


def candidates(case: Json, k: int) -> Candidates:
    """The candidates of a pair, of which k are asked for.

    Parameters
    ----------
    case : dict
        ``alpha``, ``beta``, ``pose_alpha``, ``pose_beta``.
    k : int

    Raises
    ------
    InputError
        As in `chosen_points`.
    """
    alpha = case["alpha"]
    beta = case["beta"]
    every = [one for part in parts(case, k) for one in _candidates(part)]
    every = [replace(one, index=i) for i, one in enumerate(every)]
    if k == 1 or "cloud" in (alpha["kind"], beta["kind"]):
        return Candidates(every, [])
    *others, nearest = every
    last = nearest.index
    every = [_bearing_corner(case, one, nearest) for one in others]
    doubtful: list[Candidate] = []
    if alpha["kind"] == beta["kind"] == "box":
        crossed, doubtful = _crossings(case, nearest, k)
        every += crossed
    every.append(nearest)
    cosines = np.array([one.numbers["n"] for one in every]) @ nearest.numbers["n"]
    about = [every[i] for i in np.flatnonzero(cosines >= FACING).tolist()]
    least = smaller(alpha, beta)
    spanned = is_spanned(*_numbers(about), least)
    certain = [one for one in about if one not in doubtful]
    clear = np.abs(cosines - FACING).min() > LIMIT
    clear &= spanned == is_spanned(*_numbers(certain), least)
    about = about[:-1] if spanned else about
    far = {**nearest.numbers, "phi": FILLED}
    filling = range(min(k, most_candidates(alpha, beta, last)) - len(about))
    return Candidates(
        about,
        [replace(nearest, index=last + 1 + i, numbers=far) for i in filling],
        of_two=True,
        clear=bool(clear),
        doubtful=doubtful,
    )


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


def _candidates(case: Json) -> list[Candidate]:
    """Closest points of each point of a cloud, or of the two solids; their indices come later."""
    results, _ = rounded_results(
        lambda: [{**one.table(), "unique": one.unique} for one in witnesses(case)]
    )
    for side in ("alpha", "beta"):
        if case[side]["kind"] == "cloud":
            alone = [{"kind": "cloud", "points": [point]} for point in case[side]["points"]]
            return [
                Candidate(0, numbers, numbers.pop("unique"), {**case, side: shape})
                for numbers, shape in zip(results, alone, strict=True)
            ]
    return [Candidate(0, results[0], results[0].pop("unique"), case)]


def _bearing_corner(case: Json, corner: Candidate, nearest: Candidate) -> Candidate:
    """A corner as it bears with the pair's normal: which way is decided on rounded numbers."""
    side, other = (
        ("alpha", "beta") if corner.case["alpha"]["kind"] == "cloud" else ("beta", "alpha")
    )
    out = 1 if other == "alpha" else -1
    R, t = frame(case[f"pose_{other}"])
    x = (np.array(corner.numbers[side]) - t) @ R
    normals = [
        way
        for way in ways(case[other], out * np.array(nearest.numbers["n"]) @ R)
        if bearing(case[other], x[None], way)[1][0]
    ]
    corner_way = out * np.array(corner.numbers["n"]) @ R
    if not normals or np.abs(normals[-1] - corner_way).max() <= TIED:
        return corner
    way = normals[-1]

    def place() -> Json:
        box = placed_shape(case[other], case[f"pose_{other}"])
        solid = placed_shape(corner.case[side], case[f"pose_{side}"])
        point = solid.world(solid.points[0])
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

    return replace(nearest, index=corner.index, numbers=rounded_results(place)[0], is_closest=False)


def _crossings(case: Json, nearest: Candidate, k: int) -> tuple[list[Candidate], list[Candidate]]:
    """Where edges of two boxes cross, and where rounding decides whether they do.

    Which edges cross is decided on rounded numbers, where they do is not.
    """
    poses = [frame(case[f"pose_{side}"]) for side in ("alpha", "beta")]
    at = [np.array(nearest.numbers[key]) for key in FIELDS]

    def crossed(over: float) -> list[tuple[int, int]]:
        pairs = crossings(case["alpha"], poses[0], case["beta"], poses[1], at, over)
        return [(i, j) for i, j, *_ in pairs]

    def candidate(edges: tuple[int, int]) -> Candidate:
        def place() -> Json:
            n = witnesses(case)[0].n
            tail, head = _edge(case, "alpha", edges[0])
            start, end = _edge(case, "beta", edges[1])
            u = head - tail
            v = end - start
            w = start - tail
            steep = np.cross(u, v) @ n
            alpha = tail + np.cross(w, v) @ n / steep * u
            beta = start + np.cross(w, u) @ n / steep * v
            return {"phi": (beta - alpha) @ n, "alpha": alpha, "beta": beta, "n": n}

        numbers = rounded_results(place)[0]
        index = int(crossing_index(nearest.index, k, *edges))
        return replace(nearest, index=index, numbers=numbers, is_closest=False)

    certain = crossed(-REPEATED)
    doubtful = [edges for edges in crossed(REPEATED) if edges not in certain]
    return [*map(candidate, crossed(0.0))], [*map(candidate, doubtful)]


def _edge(case: Json, side: str, i: int) -> list[Vector]:
    """Ends of an edge of a box in the world, in exact numbers."""
    box = placed_shape(case[side], case[f"pose_{side}"])
    return [box.world(vector(end)) for end in edges(case[side])[0][i].tolist()]


def _numbers(some: Sequence[Candidate]) -> tuple[Array, Array, Array]:
    """Their phi, alpha and n."""
    phi, alpha, n = (np.array([one.numbers[key] for one in some]) for key in ("phi", "alpha", "n"))
    return phi, alpha, n


def _kept_candidates(
    some: Sequence[Candidate], k: int, least: float, *, of_two: bool = False
) -> Chosen:
    phi, alpha, n = _numbers(some)
    late = repeats(phi, alpha, n, REPEATED) if of_two else np.zeros(len(some), dtype=bool)

    def ranks(error: float) -> list[tuple[bool, float, int]]:
        rank = gaps(phi + error, least).tolist()
        return [(bool(late[i]), rank[i], one.index) for i, one in enumerate(some)]

    exact, nearer, farther = (ranks(error) for error in (0.0, -TIED, TIED))
    order = sorted(range(len(some)), key=exact.__getitem__)
    kept = sorted((some[i] for i in order[:k]), key=attrgetter("index"))
    clear = not order[k:] or max(farther[i] for i in order[:k]) < min(nearer[i] for i in order[k:])
    answers = [layer("distance").expected(one.case) for one in kept]
    return Chosen(
        contacts=[{"index": one.index, **one.numbers} for one in kept],
        clear=clear,
        unique=all(answer.flags["unique"] for answer in answers),
        tolerance={
            name: max(answer.tolerance[name].absolute for answer in answers) for name in FIELDS
        },
    )

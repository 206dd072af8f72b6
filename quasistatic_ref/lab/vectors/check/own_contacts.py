"""The contacts of an answer: whether they are as good as the nearest, and the step that they make.

Which of several points at the same distance are kept, where the closest points of parallel faces
lie, and along which axis d1 points where two of them are as far from n, is decided by rounding
in float64. So contacts are checked by what they have to be, the candidates being the plain
program's. J, A and b of these contacts are the plain program's, too; the optimum is exact.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from quasistatic_ref.lab.program.candidates import RANKED, candidates, gaps, k_first, smaller
from quasistatic_ref.lab.program.candidates import TIED as FACES
from quasistatic_ref.lab.program.distance import closest_points, corners
from quasistatic_ref.lab.program.layers import plain
from quasistatic_ref.lab.program.mechanism import kinematics
from quasistatic_ref.lab.program.step import entry_of, pose_in_world, step_at
from quasistatic_ref.lab.vectors.check.compare import tolerance_of
from quasistatic_ref.lab.vectors.check.valid_witness import Sides, each_solid, witness_problem
from quasistatic_ref.lab.vectors.layers.qp import exact_optimum
from quasistatic_ref.lab.vectors.trees import Json
from quasistatic_ref.numbers.arrays import Array

FIELDS = ("phi", "alpha", "beta", "n")
SAME_WAY = 1e-12
"""Normals that differ by no more, in any component, are one [-]."""
ROUNDING = 1e-12
"""Of a distance in float64, at most [m]."""
TIED = 1e-9
"""Components of n that are that near to each other may be exchanged by rounding, unless the n that
is answered has them equal: d1 is a function of it."""


def contacts_problem(case: Json, record: Json, contacts: Json) -> str | None:
    """What is wrong with the contacts of a step; None if they are as good as the expected ones.

    Parameters
    ----------
    case : dict
        Input of the layer ``step``.
    record : dict
        What is expected.
    contacts : list of dict
        As many as are expected, of the same pairs in the same order.
    """
    wanted = record["output"]["contacts"]
    allowed = max(tolerance_of(record["tolerance"], f"contacts.{name}") for name in FIELDS)
    if [c["pair"] for c in contacts] != [c["pair"] for c in wanted]:
        return "they are of other pairs"
    for one, other in pairwise(contacts):
        if one["pair"] == other["pair"] and one["index"] > other["index"]:
            return f"those of {one['pair']} do not stand in the order of index"
    rounding = 2 * (allowed if "negligible" in record else min(allowed, ROUNDING))
    at = kinematics(case["mechanism"], np.array(case["q"]))
    for pair in case["pairs"]:
        of_pair_contacts = [c for c in contacts if c["pair"] == pair["name"]]
        due = sorted(c["phi"] for c in wanted if c["pair"] == pair["name"])
        if len({c["index"] for c in of_pair_contacts}) < len(of_pair_contacts):
            return f"{pair['name']} names a candidate twice"
        depths = sorted(float(c["phi"]) for c in of_pair_contacts)
        if any(abs(one - other) > 2 * allowed for one, other in zip(depths, due, strict=True)):
            return f"the distances of {pair['name']} are others"
        entries = {side: case["shapes"][pair[side]] for side in ("alpha", "beta")}
        sides = {side: (e["shape"], pose_in_world(e, at)) for side, e in entries.items()}
        known = _known_candidates(sides, pair["k"])
        for contact in of_pair_contacts:
            if contact["index"] not in known:
                return f"{pair['name']} has no candidate {contact['index']}"
        indices = [contact["index"] for contact in of_pair_contacts]
        if problem := _rank_problem(sides, pair["k"], indices, rounding):
            return f"{pair['name']}: {problem}"
        for contact in of_pair_contacts:
            if problem := _contact_problem(known[contact["index"]], contact, allowed):
                others = (i for i, c in known.items() if not _contact_problem(c, contact, allowed))
                if (place := next(others, None)) is not None:
                    problem = f"its point is candidate {place}: candidates have a documented order"
                return f"{pair['name']}/{contact['index']}: {problem}"
    return None


def _rank_problem(sides: Sides, k: int, indices: list[int], rounding: float) -> str | None:
    """Which candidate should be kept by its rank and index, but where rounding decides a rank."""
    phi, _, _, _, index, late = candidates(*sides["alpha"], *sides["beta"], k)
    size = smaller(*(shape for shape, _ in sides.values()))
    rank = gaps(phi, size)
    if not size or np.any(np.abs(phi - RANKED * size * rank) + rounding >= RANKED * size / 2):
        return None
    due = index[k_first(rank, index, late, k)].tolist()
    missing = [i for i in due if i not in indices]
    return f"candidate {missing[0]} is as near, and of a lower index" if missing else None


@dataclass(frozen=True)
class Candidate:
    """A possible contact of a pair.

    Parameters
    ----------
    numbers : dict
        ``phi``, ``alpha``, ``beta`` and ``n``.
    closest : Sides, optional
        The two solids whose closest points it is; None if it bears along another way.
    """

    numbers: Json
    closest: Sides | None


def _known_candidates(sides: Sides, k: int) -> dict[int, Candidate]:
    """The candidates of a pair by their index."""
    *numbers, index, _ = candidates(*sides["alpha"], *sides["beta"], k)
    every = [dict(zip(FIELDS, values, strict=True)) for values in zip(*numbers, strict=True)]
    return {
        i: Candidate(one, _closest(sides, k, i, one))
        for i, one in zip(index.tolist(), every, strict=True)
    }


def _closest(sides: Sides, k: int, index: int, numbers: Json) -> Sides | None:
    """The two solids whose closest points a candidate is; None if a rule says along which way."""
    kinds = {shape["kind"] for shape, _ in sides.values()}
    cloud = "cloud" in kinds
    last = 0
    for side, (shape, pose) in sides.items():
        points = shape.get("points", ()) if cloud or k == 1 else corners(shape)
        if last <= index < last + len(points):
            point = {"kind": "cloud", "points": [points[index - last]]}
            alone = {**sides, side: (point, pose)}
            (solids,) = each_solid(alone)
            if cloud:
                in_faces = kinds & {"box", "convex"} and numbers["phi"] <= FACES
                return None if in_faces else solids
            *_, way = closest_points(*alone["alpha"], *alone["beta"])
            return solids if np.abs(way - numbers["n"]).max() <= SAME_WAY else None
        last += len(points)
    return sides if index < last + min(k, last + 9) else None


def _contact_problem(candidate: Candidate, contact: Json, allowed: float) -> str | None:
    alpha, beta, n, d1, d2 = (
        np.array(contact[name], dtype=np.float64) for name in ("alpha", "beta", "n", "d1", "d2")
    )
    for key in ("phi",) if candidate.closest else FIELDS:
        if np.abs(np.subtract(contact[key], candidate.numbers[key])).max() > 2 * allowed:
            return f"its {key} is another"
    if candidate.closest:
        gap = float((beta - alpha) @ n)  # also of what fills the number, whose phi is none
        problem = witness_problem(candidate.closest, gap, alpha, beta, n, 2 * allowed)
        if problem:
            return problem
    sizes = np.abs(n)
    near = np.flatnonzero(sizes <= sizes.min() + TIED)
    if (sizes[near] == sizes.min()).all():
        near = near[:1]
    if not any(np.abs(d1 - _tangent_along_axis(int(i), n)).max() <= 4 * allowed for i in near):
        return "d1 is not the projection of the axis farthest from n, the first of equals"
    return None if np.abs(d2 - np.cross(n, d1)).max() <= 4 * allowed else "d2 is not n x d1"


def _tangent_along_axis(axis: int, n: Array) -> Array:
    d = np.eye(3)[axis] - n[axis] * n
    return np.asarray(d / np.linalg.norm(d))


def record_from(case: Json, record: Json, contacts: Json) -> Json:
    """The expected output of a step with these contacts; H, g and tolerances stay the same."""
    at = kinematics(case["mechanism"], np.array(case["q"]))
    pairs = {pair["name"]: pair for pair in case["pairs"]}
    entries = [{**entry_of(case, pairs[contact["pair"]]), **contact} for contact in contacts]
    made = plain(step_at(case, at, entries, exact_optimum))
    kept = {key: record["output"][key] for key in ("H", "g")}
    return {**record, "output": {**made, **kept}}

"""The contacts of an answer: whether they are as good as the nearest, and the step that they make.

Which of several points at the same distance are kept, where the closest points of parallel faces
lie, and along which axis d1 points where two of them are as far from n, is decided by rounding
in float64. So contacts are checked by what they have to be, the candidates being the plain
program's. J, A and b of these contacts are the plain program's, too; the optimum is exact.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from quasistatic_ref.lab.program.candidates import (
    RANKED,
    candidates,
    gaps,
    k_first,
    smaller,
    without_repeats,
)
from quasistatic_ref.lab.program.candidates import TIED as FACES
from quasistatic_ref.lab.program.distance import closest_points, corners
from quasistatic_ref.lab.program.layers import plain
from quasistatic_ref.lab.program.mechanism import kinematics
from quasistatic_ref.lab.program.rotation import AXES, unit
from quasistatic_ref.lab.program.step import entry_of, sides_of, step_at
from quasistatic_ref.lab.vectors.check.compare import ROUNDING as ROUNDED
from quasistatic_ref.lab.vectors.check.compare import tolerance_of
from quasistatic_ref.lab.vectors.check.valid_witness import Sides, each_solid, witness_problem
from quasistatic_ref.lab.vectors.layers.qp import exact_optimum
from quasistatic_ref.lab.vectors.trees import Json

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
        As many as are expected, of the same pairs in the same order. Without `index`, each is the
        first candidate after the one before it that it can be.
    """
    wanted = record["output"]["contacts"]
    allowed = max(tolerance_of(record["tolerance"], f"contacts.{name}") for name in FIELDS)
    if [c["pair"] for c in contacts] != [c["pair"] for c in wanted]:
        return "they are of other pairs"
    for one, other in pairwise(contacts):
        indexed = "index" in one and "index" in other
        if indexed and one["pair"] == other["pair"] and one["index"] > other["index"]:
            return f"those of {one['pair']} do not stand in the order of index"
    tied = max(TIED, record.get("rounding", 0.0))
    rounding = 2 * (allowed if "negligible" in record else min(allowed, ROUNDING))
    at = kinematics(case["mechanism"], np.array(case["q"]))
    for pair in case["pairs"]:
        of_pair = [c for c in contacts if c["pair"] == pair["name"]]
        due = np.array(sorted(c["phi"] for c in wanted if c["pair"] == pair["name"]))
        off = np.abs(sorted(c["phi"] for c in of_pair) - due)
        if (off > 2 * allowed + ROUNDED * np.abs(due)).any():
            return f"the distances of {pair['name']} are others"
        sides: Sides = {
            side: (without_repeats(shape), pose)
            for side, (shape, pose) in sides_of(case, pair, at).items()
        }
        *columns, index, late = candidates(*sides["alpha"], *sides["beta"], pair["k"])
        every = [dict(zip(FIELDS, values, strict=True)) for values in zip(*columns, strict=True)]
        known = dict(zip(index.tolist(), every, strict=True))
        judged = _Judged(sides, pair["k"], known, allowed, tied)
        indices = [c["index"] for c in of_pair] if _indexed(of_pair) else judged.places(of_pair)
        if len({*indices}) < len(of_pair):
            return f"{pair['name']} names a candidate twice"
        unknown = [i for i in indices if i not in known]
        if unknown:
            return f"{pair['name']} has no candidate {unknown[0]}"
        size = smaller(*(shape for shape, _ in sides.values()))
        rank = gaps(columns[0], size)
        distance_from_half = RANKED * size / 2 - np.abs(columns[0] - RANKED * size * rank)
        if size and np.all(distance_from_half > rounding):  # rounding decides no rank
            first = index[k_first(rank, index, late, pair["k"])].tolist()
            missing = [i for i in first if i not in indices]
            if missing:
                return f"{pair['name']}: candidate {missing[0]} is as near, and of a lower index"
        for i, contact in zip(indices, of_pair, strict=True):
            if problem := judged.problem(i, contact):
                return f"{pair['name']}/{i}: {problem}"
    return None


def _indexed(contacts: Json) -> bool:
    return all("index" in contact for contact in contacts)


class _Judged(NamedTuple):
    """Contacts of a pair as candidates of it.

    Parameters
    ----------
    sides : Sides
    k : int
    known : dict of int to dict
        The candidates, by index.
    allowed, tied : float
        Tolerances of fields, and of the components of a normal [m, -].
    """

    sides: Sides
    k: int
    known: dict[int, Json]
    allowed: float
    tied: float

    def problem(self, i: int, contact: Json) -> str | None:
        """Why a contact is not the candidate i."""
        solids = _closest(self.sides, self.k, i, self.known[i])
        return _contact_problem(self.known[i], solids, contact, self.allowed, self.tied)

    def places(self, contacts: Json) -> list[int]:
        """The candidate that each contact can be, in ascending order; -1 where there is none."""
        left = sorted(self.known)
        indices = []
        for contact in contacts:
            while left and self.problem(left[0], contact):
                left.pop(0)
            indices.append(left.pop(0) if left else -1)
        return indices


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


def _contact_problem(
    candidate: Json, solids: Sides | None, contact: Json, allowed: float, tied: float
) -> str | None:
    alpha, beta, n, d1, d2 = (
        np.array(contact[name], dtype=np.float64) for name in ("alpha", "beta", "n", "d1", "d2")
    )
    for key in ("phi",) if solids else FIELDS:
        room = 2 * allowed + ROUNDED * np.abs(candidate[key]).max()
        if np.abs(np.subtract(contact[key], candidate[key])).max() > room:
            return f"its {key} is another"
    if solids:
        gap = float((beta - alpha) @ n)  # also of what fills the number, whose phi is none
        if problem := witness_problem(solids, gap, alpha, beta, n, 2 * allowed):
            return problem
    sizes = np.abs(n)
    near = np.flatnonzero(sizes <= sizes.min() + tied)
    if (sizes[near] == sizes.min()).all():
        near = near[:1]
    if not any(np.abs(d1 - unit(AXES[i] - n[i] * n)).max() <= 4 * allowed for i in near):
        return "d1 is not the projection of the axis farthest from n, the first of equals"
    return None if np.abs(d2 - np.cross(n, d1)).max() <= 4 * allowed else "d2 is not n x d1"


def record_from(case: Json, record: Json, contacts: Json) -> Json:
    """The expected output of a step with these contacts; H, g and tolerances stay the same."""
    at = kinematics(case["mechanism"], np.array(case["q"]))
    pairs = {pair["name"]: pair for pair in case["pairs"]}
    unnamed = {"index": 0}  # of one without; nothing follows from it
    entries = [
        {**entry_of(case, pairs[contact["pair"]]), **unnamed, **contact} for contact in contacts
    ]
    made = plain(step_at(case, at, entries, exact_optimum))
    kept = {key: record["output"][key] for key in ("H", "g")}
    return {**record, "output": {**made, **kept}}

"""Contacts of a step that are not the expected ones, but as good, and the step that they make.

Which of several points at the same distance are kept, where the closest points of parallel faces
lie, and along which axis d1 points where two of them are as far from n, is decided by rounding
in float64. Such contacts are checked by what they have to be; J, A, b and the answer are then
computed from them without rounding.
"""

from itertools import pairwise

import numpy as np

from quasistatic_ref.lab.vectors.check.compare import tolerance_of
from quasistatic_ref.lab.vectors.check.valid_witness import solid_cases, witness_problem
from quasistatic_ref.lab.vectors.distances.candidates import FIELDS, Candidate, candidates
from quasistatic_ref.lab.vectors.exact.compliant import compliant_forces
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.layers import layer
from quasistatic_ref.lab.vectors.layers.qp import matrices
from quasistatic_ref.lab.vectors.layers.step import of_pair, shape_pose, step_output, with_rows
from quasistatic_ref.step.data import Array

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
    allowed = max(
        tolerance_of(record["tolerance"], f"contacts.{name}")
        for name in ("phi", "alpha", "beta", "n")
    )
    if [c["pair"] for c in contacts] != [c["pair"] for c in wanted]:
        return "they are of other pairs"
    for one, other in pairwise(contacts):
        if one["pair"] == other["pair"] and one["index"] > other["index"]:
            return f"those of {one['pair']} do not stand in the order of index"
    for pair in case["pairs"]:
        of_pair_contacts = [c for c in contacts if c["pair"] == pair["name"]]
        due = sorted(c["phi"] for c in wanted if c["pair"] == pair["name"])
        if len({c["index"] for c in of_pair_contacts}) < len(of_pair_contacts):
            return f"{pair['name']} names a candidate twice"
        depths = sorted(float(c["phi"]) for c in of_pair_contacts)
        if any(abs(one - other) > 2 * allowed for one, other in zip(depths, due, strict=True)):
            return f"the distances of {pair['name']} are others"
        sides: dict[str, Json] = {}
        for side in ("alpha", "beta"):
            entry = case["shapes"][pair[side]]
            sides |= {side: entry["shape"], f"pose_{side}": shape_pose(case, entry)}
        of_sides = candidates(sides, pair["k"])
        known = {one.index: one for one in (*of_sides.about, *of_sides.filling)}
        for contact in of_pair_contacts:
            if contact["index"] not in known:
                return f"{pair['name']} has no candidate {contact['index']}"
            if problem := _contact_problem(known[contact["index"]], contact, allowed):
                others = (i for i, c in known.items() if not _contact_problem(c, contact, allowed))
                if (place := next(others, None)) is not None:
                    problem = f"its point is candidate {place}: candidates have a documented order"
                return f"{pair['name']}/{contact['index']}: {problem}"
    return None


def _contact_problem(candidate: Candidate, contact: Json, allowed: float) -> str | None:
    alpha, beta, n, d1, d2 = (
        np.array(contact[name], dtype=np.float64) for name in ("alpha", "beta", "n", "d1", "d2")
    )
    fixed = ["phi"] if candidate.is_closest else FIELDS
    for key in fixed:
        if np.abs(np.subtract(contact[key], candidate.numbers[key])).max() > 2 * allowed:
            return f"its {key} is another"
    if candidate.is_closest:
        gap = float((beta - alpha) @ n)  # also of what fills the number, whose phi is none
        (solids,) = solid_cases(candidate.case)
        if problem := witness_problem(solids, gap, alpha, beta, n, 2 * allowed):
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
    """What is expected of a step with these contacts: H, g and all tolerances stay."""
    pairs = {pair["name"]: pair for pair in case["pairs"]}
    whole = [{**of_pair(case, pairs[contact["pair"]]), **contact} for contact in contacts]
    entries, _, rows = with_rows(case, whole)
    qp_case = {key: record["output"][key] for key in ("H", "g")} | rows.output
    solved = layer("qp").expected(qp_case)
    output, _, _ = step_output(case, entries, qp_case, solved)
    if "forces" in record["output"]:
        forces, _ = compliant_forces(matrices(qp_case), case, entries, output["lam"])
        output["forces"] = forces
    unique = record["flags"]["unique_multipliers"] and solved.flags["unique_multipliers"]
    return {**record, "output": output, "flags": {**record["flags"], "unique_multipliers": unique}}

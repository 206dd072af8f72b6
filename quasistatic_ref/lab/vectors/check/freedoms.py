"""Answers that differ from the expected ones and are right all the same.

Each function takes a case, what is expected, the answer and the fields in which they differ
beyond tolerance, and says why that is a documented freedom, or what is wrong.
"""

from collections.abc import Callable, Mapping

import numpy as np

from quasistatic_ref.lab.program.candidates import selection
from quasistatic_ref.lab.program.rotation import frame
from quasistatic_ref.lab.vectors.check.compare import CONTACT, differences, tolerance_of
from quasistatic_ref.lab.vectors.check.multipliers import (
    multipliers_problem,
    program_rows,
    wrench_problem,
)
from quasistatic_ref.lab.vectors.check.own_contacts import contacts_problem, record_from
from quasistatic_ref.lab.vectors.check.valid_witness import each_solid, witness_problem
from quasistatic_ref.lab.vectors.check.verdict import Difference, Verdict, acceptance, failure
from quasistatic_ref.lab.vectors.converters import quaternion_places
from quasistatic_ref.lab.vectors.trees import Json

Failing = Mapping[str, Difference]
WITNESS = ("alpha", "beta", "n")
ANOTHER = 1e3
"""An error of more tolerances than that is another answer, and may be right."""


def plain_failure(failing: Failing) -> Verdict:
    """The first field that differs, by how much."""
    first = next(iter(failing.values()))
    return failure(first.field, first.sentence, first.digits)


def another_witness(case: Json, record: Json, answer: Json, failing: Failing) -> Verdict:
    """Other closest points, or another normal, that prove the same distance.

    Exactly, they may be unique and still be decided by the last bit of a pose: a face that is
    parallel to another but for 1e-18. Far from the expected ones they have to prove themselves;
    a little off them they are wrong where those are unique.
    """
    if "phi" in failing or (record["flags"].get("unique", True) and not _far(failing)):
        return plain_failure(failing)
    tolerance = max(tolerance_of(record["tolerance"], name) for name in ("phi", *WITNESS))
    phi = np.atleast_1d(np.array(record["output"]["phi"], dtype=np.float64))
    points = {name: np.array(answer[name], dtype=np.float64).reshape(-1, 3) for name in WITNESS}
    sides = {side: (case[side], frame(case[f"pose_{side}"])) for side in ("alpha", "beta")}
    for i, solid in enumerate(each_solid(sides)):
        alpha, beta, n = (points[name][i] for name in WITNESS)
        problem = witness_problem(solid, float(phi[i]), alpha, beta, n, tolerance)
        if problem:
            first = next(iter(failing.values()))
            sentence = f"{first.sentence}; nor is it another valid one: {problem}"
            return failure(first.field, sentence, first.digits)
    return acceptance("another witness of the same distance")


def _far(failing: Failing) -> bool:
    """Whether an answer is another one, and not the same with too large an error."""
    return any(d.error > ANOTHER * d.tolerance for d in failing.values())


def other_choice(case: Json, record: Json, answer: Json, failing: Failing) -> Verdict:
    """Other indices: right only to fewer digits, among distances that these do not tell apart."""
    unit = record.get("rounding", 0.0)
    every = selection({**case, "k": 2 * max(map(len, case["phi"]))})["indices"]
    for g, (phi, chosen, wanted) in enumerate(
        zip(case["phi"], answer["indices"], record["output"]["indices"], strict=True)
    ):
        last = max([len(phi) - 1, *wanted])  # places after those of phi fill the number
        for j, i in enumerate(chosen):
            if problem := _index_problem(i, last, every[g], chosen[:j]):
                return failure("indices", f"indices[{g}][{j}] is {i}: {problem}")
        allowed = unit * max(map(abs, phi), default=0.0)
        pairs = [(i, j) for i, j in zip(chosen, wanted, strict=True) if i != j]
        known = all(max(pair) < len(phi) for pair in pairs)
        if not known or any(abs(phi[i] - phi[j]) > allowed for i, j in pairs):
            return plain_failure(failing)
    if not unit:
        return failure("indices", "indices: equal distances stand in the order of their places")
    return acceptance("another choice among distances that are equal to so many digits")


def _index_problem(i: Json, last: int, every: list[int], before: list[Json]) -> str:
    """Why a chosen index is not allowed; empty if it is."""
    if not isinstance(i, int) or not 0 <= i <= last:
        return f"indices must be whole numbers from 0 to {last}"
    if i in before:
        return "it stands there twice"
    return "" if i in every else "its normal is more than 0.25 rad from the last one's"


def aligned(layer: str, case: Json, expected: Json, answer: Json) -> Json:
    """The answer with each quaternion's sign turned to that of the expected one."""
    field = {"integrate": "q", "step": "q_next"}.get(layer)
    if field is None or field not in expected:
        return answer
    wanted, q = (np.array(o[field], dtype=np.float64) for o in (expected, answer))
    for place in quaternion_places(case["mechanism"]):
        if q[place] @ wanted[place] < 0:
            q[place] = -q[place]
    return {**answer, field: q.tolist()}


def other_multipliers(case: Json, record: Json, answer: Json, failing: Failing) -> Verdict:
    """Other multipliers of a quadratic program that do the same."""
    rest = {name: d for name, d in failing.items() if name != "lam"}
    if rest or record["flags"].get("unique_multipliers", True):
        return plain_failure(failing)
    rows = program_rows(case, record["output"])
    conic = "second_order" in case
    if problem := multipliers_problem(rows, record, answer["lam"], conic=conic):
        return failure("lam", f"lam is another one, and {problem}")
    return acceptance("other multipliers with the same A'lam")


def step_by_definition(case: Json, record: Json, answer: Json, failing: Failing) -> Verdict:
    """Other contacts that are as good as the nearest, and what follows from them; any optimal lam.

    A and b follow from the answer's own contacts, delta_q is the optimum that they have, lam does
    what multipliers do, and the wrench is that of lam.
    """
    first = next(iter(failing.values()))
    if first.field.startswith("contacts."):
        contacts = answer["contacts"]
        wide = "negligible" in record  # tolerances that reach as far as another point of a face
        if not (wide or _far(failing)) or not {*CONTACT} - {"index", "J"} <= {*contacts[0]}:
            return plain_failure(failing)
        if problem := contacts_problem(case, record, contacts):
            sentence = f"{first.sentence}; nor are these other valid contacts: {problem}"
            return failure(first.field, sentence, first.digits)
        record = record_from(case, record, contacts)
    made = record["output"]
    if "farkas" in made and "delta_q" in answer:
        return failure("farkas", "of these contacts the case has no solution; farkas is missing")
    compared = differences(made, answer, record["tolerance"])
    loads = ("lam", "wrench")
    other = {name: d for name, d in compared.items() if not (d.holds or name in loads)}
    if other:
        return plain_failure(other)
    if "lam" in answer:
        if problem := multipliers_problem(made["A"], record, answer["lam"]):
            return failure("lam", f"lam is another one, and {problem}")
        if "wrench" in answer and (problem := wrench_problem(case, record, answer)):
            return failure("wrench", problem)
    elif "wrench" in failing:
        return failure("wrench", "wrench is another one, and the lam that it is of is not given")
    return acceptance("right by what follows from its own contacts and multipliers")


FREEDOMS: dict[str, Callable[[Json, Json, Json, Failing], Verdict]] = {
    "distance": another_witness,
    "selection": other_choice,
    "qp": other_multipliers,
    "step": step_by_definition,
}

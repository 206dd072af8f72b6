"""Whether multipliers that are not the expected ones do what multipliers have to do.

Where the rows that bear load depend on each other, lam is one of many. All of them are >= 0, have
the same A'lam, and vanish on rows with a slack.
"""

from fractions import Fraction

import numpy as np

from quasistatic_ref.lab.program.wrench import contact_wrench
from quasistatic_ref.lab.vectors.check.compare import number_problem, tolerance_of
from quasistatic_ref.lab.vectors.check.verdict import PASSED, Verdict, acceptance, failure
from quasistatic_ref.lab.vectors.layers.rows import by_contact
from quasistatic_ref.lab.vectors.trees import Json
from quasistatic_ref.numbers.arrays import Array

EPS = float(np.finfo(np.float64).eps)
NEGLIGIBLE = 1e-9
"""Largest multiplier, relative to the largest, on a row that has a slack, or below zero: a method
that reaches delta_q to rounding leaves 1e-14."""

NOISE = 1e-12
"""An entry of a Farkas vector, relative to the largest, that may be rounding."""


def program_rows(case: Json, output: Json) -> Json:
    """The rows that the multipliers of a case belong to: its own, its blocks', or a step's A."""
    if "second_order" in case:
        return [row for block in case["second_order"] for row in block["F"]]
    return case.get("A", output.get("A"))


def multipliers_problem(rows: Json, record: Json, lam: Json, *, conic: bool = False) -> str | None:
    """What is wrong with multipliers of a program; None if they are as good as the expected ones.

    Parameters
    ----------
    rows : list
        A [m][n_v].
    record : dict
        What is expected: A_lam, slack (or A, b, delta_q) and the tolerances.
    lam : list, length m
    conic : bool
        Whether each four of them are in a second-order cone.
    """
    output = record["output"]
    tolerance = record["tolerance"]
    A_lam = np.array(output["A_lam"])
    multipliers = np.array(lam, dtype=np.float64)
    A = np.array(rows, dtype=np.float64).reshape(len(multipliers), len(A_lam))
    largest = float(np.abs(multipliers).max(initial=0.0))
    sums = EPS * (len(A) + 2) * float((np.abs(A).T @ np.abs(multipliers)).max(initial=0.0))
    off = float(np.abs(A.T @ multipliers - A_lam).max(initial=0.0))
    if not off <= tolerance_of(tolerance, "A_lam") + 2 * sums < np.inf:
        return f"A'lam is off by {off:.2g}"
    share = record.get("negligible", NEGLIGIBLE)
    small = share * largest
    slack = _slack(A, output)
    # An energy that rounding leaves: a program on which nothing presses has no largest multiplier.
    work = tolerance_of(tolerance, "A_lam") * tolerance_of(tolerance, "delta_q")
    if conic:
        return _conic_problem(multipliers.reshape(-1, 4), slack.reshape(-1, 4), small, share, work)
    if (multipliers < -small).any():
        row = int(multipliers.argmin())
        return f"lam[{row}] is {multipliers[row]:.2g}, below 0"
    room = max(tolerance_of(tolerance, "slack"), tolerance_of(tolerance, "b"))
    room += (
        EPS * 4 * float(np.abs(A).max(initial=0.0)) * (1.0 + float(np.abs(slack).max(initial=0)))
    )
    pressing = (multipliers > small) & (slack > room) & (multipliers * slack > work)
    if pressing.any():
        row = int(np.where(pressing, multipliers, -1).argmax())
        return f"lam[{row}] is {multipliers[row]:.2g} on a row whose slack is {slack[row]:.2g}"
    return None


def _slack(A: Array, output: Json) -> Array:
    if "slack" in output:
        return np.array(output["slack"], dtype=np.float64)
    return np.asarray(A @ np.array(output["delta_q"]) - np.array(output["b"], dtype=np.float64))


def _conic_problem(lam: Array, z: Array, small: float, share: float, work: float) -> str | None:
    outside = np.linalg.norm(lam[:, 1:], axis=1) - lam[:, 0]
    if not (outside <= small).all():
        return f"lam of block {int(outside.argmax())} is outside its cone"
    product = np.abs(np.einsum("ji,ji->j", lam, z))
    size = np.linalg.norm(lam, axis=1) * np.linalg.norm(z, axis=1)
    if (product > max(share * float(size.max(initial=0.0)), work, 1e-300)).any():
        return f"lam of block {int(product.argmax())} is not complementary to F x + f"
    return None


def wrench_problem(case: Json, record: Json, answer: Json) -> str | None:
    """Whether the wrenches of a step belong to its own multipliers."""
    by_name = {pair["name"]: pair for pair in case["pairs"]}
    pairs = [by_name[contact["pair"]] for contact in record["output"]["contacts"]]
    parts = by_contact(answer["lam"], case["cone"], pairs)
    for j, (pair, lam) in enumerate(zip(pairs, parts, strict=True)):
        wrench = np.array(contact_wrench({**pair, "lam": lam}, case["cone"], case["h"]))
        size = float(np.abs(np.array(lam, dtype=np.float64) / case["h"]).sum())
        off = float(np.abs(wrench - np.array(answer["wrench"][j])).max())
        allowed = tolerance_of(record["tolerance"], "wrench") + 16 * EPS * size
        if not off <= allowed < np.inf:
            return f"wrench[{j}] is not what its lam makes: it is off by {off:.2g}"
    return None


def farkas_verdict(case: Json, record: Json, y: Json) -> Verdict:
    """Whether y proves that A x >= b has no solution.

    Fractions ``"p/q"`` are checked without rounding; float64 numbers too, and if they fail only by
    A'y = 0, by how small that is compared with |A|'y.
    """
    m = len(case["b"])
    if not isinstance(y, list) or len(y) != m:
        return failure("farkas", f"farkas must be a list of {m}")
    try:
        exact = [_fraction(value, i) for i, value in enumerate(y)]
    except ValueError as problem:
        return failure("farkas", str(problem))
    if any(value < 0 for value in exact):
        return failure("farkas", "farkas has a negative entry")
    room = 0.0 if isinstance(y[0], str) else tolerance_of(record["tolerance"], "farkas")
    if unproved := _proof_problem(case, exact, room):
        small = Fraction(NOISE) * max(exact)  # what rounding leaves in the place of a zero
        kept = [value if value > small else Fraction(0) for value in exact]
        if not room or _proof_problem(case, kept, room):
            return failure("farkas", unproved)
    if abs(max(exact) - 1) > tolerance_of(record["tolerance"], "farkas"):
        return failure("farkas", f"the largest entry must be 1, not {float(max(exact))!r}")
    expected = record["output"]["farkas"]
    same = all(float(value) == wanted for value, wanted in zip(exact, expected, strict=True))
    return Verdict("", PASSED) if same else acceptance("another Farkas vector")


def _proof_problem(case: Json, y: list[Fraction], room: float) -> str | None:
    """Why y >= 0 is no proof; A'y = 0 within `room` of |A|'y [-]."""
    support = [i for i, value in enumerate(y) if value]
    if not sum((y[i] * Fraction(case["b"][i]) for i in support), Fraction(0)) > 0:
        return "b'y is not positive"
    for v in range(len(case["g"])):
        terms = [y[i] * Fraction(case["A"][i][v]) for i in support]
        off = abs(sum(terms, Fraction(0)))
        size = sum(map(abs, terms), Fraction(0))
        if off > Fraction(room) * size:
            return f"A'y is not zero: entry {v} is {float(off):.2g}"
    return None


def _fraction(value: Json, i: int) -> Fraction:
    if isinstance(value, str):
        p, _, q = value.partition("/")
        if not (p.removeprefix("-").isdecimal() and (q or "1").isdecimal() and int(q or "1")):
            raise ValueError(f"farkas[{i}] must be a fraction 'p/q', not {value[:40]!r}")
        return Fraction(int(p), int(q or "1"))
    if problem := number_problem(value, f"farkas[{i}]"):
        raise ValueError(problem)
    return Fraction(value)

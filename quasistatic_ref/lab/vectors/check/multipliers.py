"""Whether multipliers that are not the expected ones do what multipliers have to do.

Where the rows that bear load depend on each other, lam is one of many. All of them are >= 0, have
the same A'lam, and vanish on rows with a slack.
"""

from fractions import Fraction
from operator import mul

import numpy as np

from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.exact.fractions import fractions_read
from quasistatic_ref.lab.made_steps.rigid import program_step
from quasistatic_ref.lab.program.wrench import contact_wrench
from quasistatic_ref.lab.vectors.check.compare import ROUNDING, number_problem, tolerance_of
from quasistatic_ref.lab.vectors.check.verdict import PASSED, Verdict, acceptance, failure
from quasistatic_ref.lab.vectors.layers.rows import by_contact
from quasistatic_ref.lab.vectors.trees import Json
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import nearest_fraction

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


def farkas_verdict(rows: Json, record: Json, y: Json) -> Verdict:
    """The verdict on y as a proof that A x >= b has no solution.

    Fractions ``"p/q"`` are checked without rounding. Of float64 numbers A'y may be as large as the
    tolerance allows, compared with |A|'y.
    """
    tolerance = tolerance_of(record["tolerance"], "farkas")
    b = np.array(rows["b"], dtype=np.float64)
    A = np.array(rows["A"], dtype=np.float64).reshape(len(b), -1)
    if not isinstance(y, list) or len(y) != len(b):
        return failure("farkas", f"farkas must be a list of {len(b)}")
    exact = all(isinstance(value, str) for value in y)
    if exact:
        n = A.shape[1]
        problem = farkas_refutation(program_step(np.eye(n), np.zeros(n), A, b), y)
    else:
        numbers = (number_problem(value, f"farkas[{i}]") for i, value in enumerate(y))
        problem = next(filter(None, numbers), None)
        unit = record.get("rounding", 0.0)
        problem = problem or _float_problem(A, b, np.array(y), tolerance, unit)
    if problem:
        return failure("farkas", problem)
    entries = [nearest_fraction(value) for value in fractions_read(y) or ()] if exact else y
    if abs(max(entries) - 1) > tolerance:
        return failure("farkas", f"the largest entry must be 1, not {max(entries)!r}")
    same = entries == record["output"]["farkas"]
    return Verdict("", PASSED) if same else acceptance("another Farkas vector")


def _float_problem(A: Array, b: Array, y: Array, room: float, unit: float) -> str | None:
    """Why y is no proof; A'y = 0 within `room` of |A|'y [-], with or without its noise.

    Where a column of A is zero but for rounding, to `unit` [-], so is its entry of A'y.
    """
    least = max(NOISE, unit) * y.max(initial=0.0)
    if (y < -least).any():
        return "farkas has a negative entry"
    for kept in (np.maximum(y, 0.0), np.where(y > least, y, 0.0)):
        contradiction = sum(map(mul, map(Fraction, b.tolist()), map(Fraction, kept.tolist())))
        with np.errstate(over="ignore", invalid="ignore"):  # such a y is too large, too
            off = np.abs(A.T @ kept)
            size = np.abs(A).T @ kept
            small = off <= room * size + max(ROUNDING, unit) * size.max(initial=0.0)
        if contradiction > 0 and small.all():
            return None
    return f"b'y is not positive, or A'y is not zero: its largest entry is {off.max():.2g}"

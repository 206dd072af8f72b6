"""All derivatives of a step, each digit proved by a second difference in another direction.

One more quotient is taken along a direction in which everything changes at once, with another eps.
Where q+ has a derivative it is the sum of the columns: whatever a column were wrong by would show.
Columns along which q+ is smooth need not add up where rows depend on each other; the rows decide
that.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from flint import fmpq

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.program.mechanism import slices
from quasistatic_ref.lab.vectors.exact.precision import Vector
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.unrounded.dependent import dependence_breaks
from quasistatic_ref.lab.vectors.unrounded.differences import Base, Quotient, quotient
from quasistatic_ref.lab.vectors.unrounded.grid import OTHER_STEP
from quasistatic_ref.lab.vectors.unrounded.moved_inputs import (
    with_force,
    with_number,
    with_q,
    with_target,
)
from quasistatic_ref.lab.vectors.unrounded.reasons import BEND, reasons, switches

PROVED = fmpq(1, 10**16)
"""Difference, relative to the largest number of the sum, at which 15 digits are proved."""
WEIGHTS = (7, 3, 1, 19)
"""Of coordinate i the direction has ((7 i i + 3 i + 1) mod 19 - 9) / 10."""
MOVE_ROWS = ("q", "mu_v", "mu_omega")
"""Of what the rows A are functions."""

Move = Callable[[Json, fmpq], Json]
"""A case with one coordinate or parameter changed by a number."""


@dataclass(frozen=True, eq=False)
class Derivatives:
    """What becomes of a step.

    Parameters
    ----------
    columns : dict of str to list of vector
        By the names of `moves`; empty where there is no derivative.
    reasons : list of dict
        Why there is none.
    switch : bool
        Whether some part changes its branch although q+ has a derivative.
    """

    columns: dict[str, list[Vector]]
    reasons: list[Json]
    switch: bool


def moves(one: Base) -> dict[str, list[Move]]:
    """Each coordinate and parameter of a case, by the name of what q+ is differentiated by.

    A coefficient of friction that is 0 cannot fall: where a pair has one, its name is missing.
    """
    case = one.at.case
    pairs = range(len(one.at.case["pairs"]))
    _, n_a, n = slices(case["mechanism"])
    masses = [k for k, body in enumerate(case["mechanism"]["bodies"]) if "mass" in body]
    found: dict[str, list[Move]] = {
        "q": [partial(with_q, way) for way in np.eye(n, dtype=int)],
        "q_bar_a": [partial(with_target, way) for way in np.eye(n_a, dtype=int)],
        "tau": [partial(with_force, way) for way in np.eye(n, dtype=int)],
        "mu_v": [partial(with_number, ("pairs", p, "mu_v")) for p in pairs],
        "mu_omega": [partial(with_number, ("pairs", p, "mu_omega")) for p in pairs],
        "K_q": [partial(with_number, ("K_q", j, j)) for j in range(n_a)],
        "h": [partial(with_number, ("h",))],
        "m": [partial(with_number, ("mechanism", "bodies", k, "mass")) for k in masses],
    }
    for name in ("mu_v", "mu_omega"):
        if not all(pair[name] > 0 for pair in case["pairs"]):
            del found[name]
    return found


def derivatives(one: Base) -> Derivatives:
    """The columns of every derivative, or why there are none.

    Raises
    ------
    InputError
        If a step nearby has no solution, or the digits cannot be proved.
    """
    case = one.at.case
    listed = moves(one)
    found: dict[str, list[Quotient]] = {
        name: [quotient(one, partial(move, case)) for move in listed[name]] for name in listed
    }
    smooth = all(q.bend < BEND for each in found.values() for q in each)
    of_rows = [q for name in MOVE_ROWS for q in found.get(name, [])]
    if not smooth or dependence_breaks(one, of_rows):
        return Derivatives({}, reasons(one, found["q"]), True)
    columns = {name: [q.column for q in each] for name, each in found.items()}
    off = max((_off(one, listed, columns, turn) for turn in (0, 5)), default=fmpq(0))
    if off > PROVED:
        problem = f"two ways to the same derivative differ by {float(off):.2g} of it"
        raise InputError(problem, field="q")
    return Derivatives(columns, [], switches(one, found["q"]))


def _off(
    one: Base, listed: dict[str, list[Move]], columns: dict[str, list[Vector]], turn: int
) -> fmpq:
    """How far the sum of all columns is from the quotient along their sum, relative."""
    flat: list[Move] = [move for name in listed for move in listed[name]]
    weights = [_weight(i + turn) for i in range(len(flat))]

    def everything(by: fmpq) -> Json:
        case = one.at.case
        for move, weight in zip(flat, weights, strict=True):
            case = move(case, weight * by)
        return case

    whole = quotient(one, everything, OTHER_STEP).column
    parts: Sequence[Vector] = [column for name in listed for column in columns[name]]
    total = np.array(weights) @ np.array(parts)
    size = max(abs(whole), default=fmpq(0))
    error = max(abs(whole - total), default=fmpq(0))
    return error / size if size else error


def _weight(i: int) -> fmpq:
    a, b, c, modulus = WEIGHTS
    return fmpq((a * i * i + b * i + c) % modulus - 9, 10)

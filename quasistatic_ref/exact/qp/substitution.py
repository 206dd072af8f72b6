r"""Whether each number of an optimum is right, by substitution.

From the rows that an answer names x and multipliers are formed in fractions, and put into the
program: :math:`P x + q = A_W^T y` in every coordinate, every row, every sign. Where P is convex on
what equations leave, they are those of an optimum. It is the one of least norm if
:math:`N^T (x - A_L^T \beta) = 0` with :math:`\beta \ge 0` of the signed rows L that are named,
where N spans all directions with A_W v = 0 and P v = A_W'm. What is given must be what these are,
each number rounded once. The linear solver is that of the search, and nothing else is.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, NamedTuple, cast

import numpy as np
from flint import fmpq, fmpq_mat, fmpz, fmpz_mat

from quasistatic_ref.errors import InputError
from quasistatic_ref.exact.fractions import fractions_read
from quasistatic_ref.exact.qp.block import Block, Convex, Unlucky, along, blocks_of
from quasistatic_ref.exact.qp.convexity import Indefinite, convex_cost
from quasistatic_ref.exact.qp.kkt import Solution, System
from quasistatic_ref.exact.qp.program import QuadraticProgram
from quasistatic_ref.exact.qp.uniqueness import multipliers_witness, optimum_witness
from quasistatic_ref.exact.verdict import Verdict, wrong_bits, wrong_claim
from quasistatic_ref.numbers.modulo import independent_rows
from quasistatic_ref.numbers.precision import check_arithmetic, nearest, nearest_fraction


class Refuted(Exception):
    """What is wrong with a claim, in words."""


class Point(NamedTuple):
    """An x with multipliers, in fractions.

    Parameters
    ----------
    X, d : list of fmpz, fmpz
        x times d > 0, and d.
    Y : dict of int to number
        Of each row of W its multiplier times d, the block's unit over that of the row.
    """

    X: list[fmpz]
    d: fmpz
    Y: dict[int, Any]


def optimum_verdict(problem: QuadraticProgram, claims: Mapping[str, Any]) -> Verdict:
    """Whether each number of an optimum is right."""
    check_arithmetic()
    try:
        _check(problem, claims)
    except Refuted as refuted:
        return Verdict(False, str(refuted))
    return Verdict(True)


def _check(problem: QuadraticProgram, claims: Mapping[str, Any]) -> None:
    names = problem.rows.names
    for field in ("active", "least_norm"):
        unknown = [name for name in claims[field] if name not in names]
        if unknown:
            raise Refuted(f"{field} names {unknown[0]!r}, which is no row of the program")
        if list(claims[field]) != [name for name in names if name in {*claims[field]}]:
            raise Refuted(f"{field} names a row twice, or in another order than the program")
    x, of_rows = np.zeros(len(problem.q)), np.zeros(len(names))
    constant = problem.exact.get("constant", {}).get(0, problem.constant)
    objective = fmpq(*constant.as_integer_ratio())
    unique, among_others = True, False
    direction = fractions_read(claims["direction"])
    if direction is None or len(direction) not in (0, len(x)):
        raise Refuted(f"direction is no list of {len(x)} fractions")
    for block in blocks_of(problem):
        point, N, W, tight = _point(block, [names[i] for i in block.rows], claims)
        x[block.coordinates] = [nearest(int(v), int(point.d)) for v in point.X]
        shares = [block.row(i).unit / block.unit / point.d for i in W]
        of_rows[block.rows[[*W]]] = [
            nearest_fraction(point.Y[i] * share) for i, share in zip(W, shares, strict=True)
        ]
        objective += _cost(block, point)
        unique &= _multipliers_unique(block, W, tight)
        among_others |= _leads_to_others(block, point, N, tight, direction)
    if direction and not among_others:
        raise Refuted("the direction is zero")
    right = {"x": x, **problem.multipliers(of_rows)}
    for name, numbers in right.items():
        if reason := wrong_bits(name, claims[name], numbers):
            raise Refuted(reason)
    obj = nearest_fraction(objective)
    for name, value in {"obj": obj, "multipliers_unique": unique}.items():
        if reason := wrong_claim(name, claims[name], value):
            raise Refuted(reason)
    error = abs(objective - fmpq(*obj.as_integer_ratio()))
    if not Fraction(int(error.p), int(error.q)) <= claims["obj_error"]:
        raise Refuted("obj_error is less than the error of obj")


def exact_point(
    problem: QuadraticProgram, claims: Mapping[str, Any]
) -> tuple[list[fmpq], dict[str, fmpq]]:
    """The exact x of an optimum, n fractions, and multipliers by the names of rows that bear.

    Those of G, lb and ub are positive; those of A belong to A x - b [any unit].

    Raises
    ------
    InputError
        If these do not hold an optimum.
    """
    x = [fmpq(0)] * len(problem.q)
    names = problem.rows.names
    multipliers: dict[str, fmpq] = {}
    for block in blocks_of(problem):
        try:
            point, _, W, _ = _point(block, [names[i] for i in block.rows], claims)
        except Refuted as refuted:
            raise InputError(f"the answer is not proved: {refuted}") from None
        for j, v in zip(block.coordinates.tolist(), point.X, strict=True):
            x[j] = fmpq(v, point.d)
        for i in W:
            y = fmpq(point.Y[i]) * block.row(i).unit / block.unit / point.d
            if y:
                multipliers[names[block.rows[i]]] = y
    return x, multipliers


def _point(
    block: Block, names: Sequence[str], claims: Mapping[str, Any]
) -> tuple[Point, list[list[fmpz]], list[int], list[int]]:
    """The optimum of least norm on the rows that are named, and directions to others of these.

    Then these rows, and the others without slack.
    """
    try:
        convex = convex_cost(block)
    except Indefinite:
        raise Refuted("P is not convex where something can move") from None
    W, least = (
        [i for i, name in enumerate(names) if name in claims[field]]
        for field in ("active", "least_norm")
    )
    e = block.equations
    if not block.are_independent(W):
        raise Refuted("the active rows are not independent")
    if len(block.held_equations) > sum(i < e for i in W):
        raise Refuted("active leaves out an equation that does not follow from it")
    point, N = block.lucky(lambda: _on_rows(block, convex, W, least))
    for i in W:
        if i >= e and point.Y[i] <= 0:
            raise Refuted(f"the multiplier of {names[i]} is {'negative' if point.Y[i] else 'zero'}")
    tight = []
    for i in range(block.m):
        slack = _slack(block, i, point.X, point.d)
        if slack < 0 or (slack and (i < e or i in point.Y)):
            raise Refuted(f"{names[i]} is violated by the minimiser on the active rows")
        if not slack and i not in point.Y:
            tight.append(i)
    return point, N, W, tight


def _on_rows(
    block: Block, convex: Convex, W: Sequence[int], L: Sequence[int]
) -> tuple[Point, list[list[fmpz]]]:
    """The point of rows W, and L, that is nearest to zero, and the directions that W leaves.

    The system has one solution for each value of its free coordinates, of which each direction
    moves another: there are no other directions than sums of these.
    """
    free = [] if convex.definite else block.free_coordinates(W, convex.P)
    system = System(block, W, free)
    solution = system.solved()
    N = solution.N
    if any(along(block.row(i).entries, v) for v in N for i in W):
        raise Unlucky
    for v, m in zip(N, solution.M, strict=True):
        left, _ = _left(block, system, [fmpz(0)] * block.n, v, fmpz(1), m)
        if any(left):  # P v is no A_W'm
            raise Unlucky
    if not N and L:
        raise Refuted("the rows of least norm are not needed")
    steps, D = _nearest_to_zero(block, solution, L) if N else ([], fmpz(1))
    X = [v * D for v in solution.X]
    Y: dict[int, Any] = {i: v * D for i, v in solution.Y.items()}
    for w, v, m in zip(steps, N, solution.M, strict=True):
        X = [u + w * k for u, k in zip(X, v, strict=True)]
        Y |= {i: Y[i] + w * k for i, k in m.items() if k}
    d = solution.d * D
    if any(_slack(block, i, X, d) for i in (*W, *L)):
        raise Refuted("the rows that are named do not hold x")
    left, of_bounds = _left(block, system, block.q, X, d, Y)
    if any(left):
        raise Refuted("the active rows leave a direction that lowers the cost")
    return Point(X, d, {**Y, **of_bounds}), N


def _left(
    block: Block,
    system: System,
    q: Sequence[fmpz],
    X: Sequence[fmpz],
    d: fmpz,
    Y: Mapping[int, Any],
) -> tuple[list[Any], dict[int, Any]]:
    """What rows leave of P x + q, n numbers times d, and the multipliers of bounds that take it."""
    left: list[Any] = [c * d + along(row, X) for c, row in zip(q, block.P, strict=True)]
    for i, y in Y.items():
        for j, v in block.row(i).entries.items():
            left[j] -= y * v
    of_bounds = {}
    for j, (i, _) in system.fixed.items():
        of_bounds[i] = left[j] * block.row(i).entries[j]
        left[j] = 0
    return left, of_bounds


def _slack(block: Block, i: int, X: Sequence[fmpz], d: fmpz) -> Any:
    """The slack of a row at X / d, times d and the row's unit."""
    entries, side, _ = block.row(i)
    return along(entries, X) + (side.p if side.q == 1 else side) * d


def _nearest_to_zero(block: Block, solution: Solution, L: Sequence[int]) -> tuple[list[fmpz], fmpz]:
    """The w over D of the point x + N w / d nearest to zero at which rows L hold as well."""
    N = solution.N
    along_N = [[along(block.row(i).entries, v) for v in N] for i in L]
    square = (fmpz_mat(N) * fmpz_mat(N).transpose()).tolist()
    matrix = [[*row, *(-line[k] for line in along_N)] for k, row in enumerate(square)]
    matrix += [[*line, *[fmpz(0)] * len(L)] for line in along_N]
    slacks = [fmpq(_slack(block, i, solution.X, solution.d)) for i in L]
    common = fmpz(1)
    for slack in slacks:
        common = common.lcm(slack.q)
    right = [-common * _product(v, solution.X) for v in N]
    right += [-(slack * common).p for slack in slacks]
    try:
        solved = fmpz_mat(matrix).solve(fmpz_mat(len(right), 1, right))
    except ZeroDivisionError:
        raise Refuted("the rows of least norm are not independent") from None
    numerators, denominator = cast("fmpq_mat", solved).numer_denom()
    numbers, D = numerators.entries(), denominator * common
    w, beta = numbers[: len(N)], dict(zip(L, numbers[len(N) :], strict=True))
    if any(v < 0 for i, v in beta.items() if i >= block.equations):
        raise Refuted("a row of least norm holds x from nothing")
    left = [v * D for v in solution.X]  # x - A_L'beta, times d D
    for step, v in zip(w, N, strict=True):
        left = [u + step * k for u, k in zip(left, v, strict=True)]
    for i, factor in beta.items():
        for j, entry in block.row(i).entries.items():
            left[j] -= factor * entry
    if any(_product(v, left) for v in N):
        raise Refuted("x is not the optimum of least norm")
    return w, D


def _product(u: Sequence[fmpz], v: Sequence[fmpz]) -> fmpz:
    return sum((a * b for a, b in zip(u, v, strict=True)), fmpz(0))


def _cost(block: Block, point: Point) -> fmpq:
    """The cost 1/2 x'Px + q'x of a block, from x alone."""
    X, d = point.X, point.d
    twice = 2 * d * _product(block.q, X)
    twice += sum((v * along(row, X) for v, row in zip(X, block.P, strict=True)), fmpz(0))
    return fmpq(twice, d * d) / (2 * block.unit)


def _multipliers_unique(block: Block, W: Sequence[int], tight: Sequence[int]) -> bool:
    """Whether the multipliers of a point are the only ones, by a witness that is substituted."""
    witness = block.lucky(lambda: multipliers_witness(block, W, tight))
    if not witness.unique:
        left, _ = block.combined({i: v * block.row(i).unit for i, v in witness.factors.items()})
        of_tight = {i: witness.factors.get(i, fmpq(0)) for i in tight}
        signs = (v >= 0 or i < block.equations for i, v in of_tight.items())
        holds = not left and all(signs) and any(of_tight.values())
    elif witness.direction:
        v = witness.direction
        holds = not any(along(block.row(i).entries, v) for i in W)
        holds &= all(along(block.row(i).entries, v) > 0 for i in tight)
    else:
        holds = block.are_independent([*W, *tight])
    if not holds:
        raise Refuted("whether multipliers are the only ones is not proved")
    return witness.unique


def _leads_to_others(
    block: Block,
    point: Point,
    N: Sequence[list[fmpz]],
    tight: Sequence[int],
    direction: Sequence[fmpq],
) -> bool:
    """Whether a direction leads from an optimum of a block to others.

    Without one, that there are no others, by a witness that is substituted.

    Raises
    ------
    Refuted
        If the direction leads to what is no optimum; or if there is none, but another optimum.
    """
    if direction:
        v = [direction[j] for j in block.coordinates.tolist()]
        if not any(v):
            return False
        slopes = [along(block.row(i).entries, v) for i in point.Y]
        ways = {i: along(block.row(i).entries, v) for i in tight}
        ends = any(way < 0 or (way and i < block.equations) for i, way in ways.items())
        bends = sum((a * along(row, v) for a, row in zip(v, block.P, strict=True)), fmpq(0))
        if any(slopes) or ends or bends:
            raise Refuted("the direction does not lead to other optima")
        return True
    witness = block.lucky(lambda: optimum_witness(block, N, tight))
    if not witness.unique:
        raise Refuted("direction is left out, though there are other optima")
    if N:
        rows = {i: [along(block.row(i).entries, v) for v in N] for i in witness.factors}
        totals = [
            sum((t * rows[i][k] for i, t in witness.factors.items()), fmpq(0))
            for k in range(len(N))
        ]
        holds = not any(totals) and all(t > 0 for t in witness.factors.values())
        if not (holds and len(independent_rows([*rows.values()])) == len(N)):
            raise Refuted("that x is the only optimum is not proved")
    return False

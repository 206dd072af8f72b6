"""Null spaces that live on few columns: proved where they do, and not said where they do not."""

import numpy as np
import pytest
from flint import fmpz, fmpz_mat

import quasistatic_ref as qr
from quasistatic_ref.exact import few_columns, minimiser
from quasistatic_ref.exact.program import implied, null_space


def rows_at_rest(rng, resting, moving, d):
    """Independent rows under which some columns rest and others move in d dimensions, shuffled."""
    k = resting + moving - d
    while True:
        on_moving = rng.integers(-3, 4, (moving - d, moving))
        if np.linalg.matrix_rank(on_moving) == moving - d:
            break
    rows = np.zeros((k, resting + moving), dtype=int)
    rows[:resting, :resting] = np.triu(rng.integers(1, 4, (resting, resting)))
    rows[:resting, resting:] = rng.integers(-1, 2, (resting, moving - d)) @ on_moving
    rows[resting:, resting:] = on_moving
    mixed = np.tril(rng.integers(-1, 2, (k, k)), -1) + np.eye(k, dtype=int)
    return whole(mixed @ rows[:, rng.permutation(resting + moving)])


def whole(rows):
    return [[fmpz(int(v)) for v in row] for row in rows]


def spans_the_same(small, rows, size):
    """Whether a null space is that of the rows, by elimination of all columns."""
    every = null_space(rows, size)
    full = fmpz_mat(size, small.basis.ncols())
    for i, j in enumerate(small.columns):
        for c in range(small.basis.ncols()):
            full[j, c] = small.basis[i, c]
    joined = [[*a, *b] for a, b in zip(every.tolist(), full.tolist(), strict=True)]
    return every.ncols() == full.ncols() == fmpz_mat(joined).rank()


@pytest.mark.parametrize("prime", [few_columns.PRIME, 101, 7])
def test_a_null_space_on_few_columns_is_that_of_all(monkeypatch, rng, prime):
    monkeypatch.setattr(few_columns, "PRIME", prime)
    proved = 0
    for _ in range(60):
        resting, moving = rng.integers(6, 20), rng.integers(2, 7)
        rows = rows_at_rest(rng, resting, moving, rng.integers(1, moving))
        small = few_columns.few_columns(rows, resting + moving)
        if small is None:
            continue
        proved += 1
        assert spans_the_same(small, rows, resting + moving)
        others = [*whole(rng.integers(-2, 3, (4, resting + moving))), rows[0]]
        assert small.vanish(others) == implied(rows, others)
    assert proved > (50 if prime > 101 else 0)


def test_what_moves_in_most_columns_is_left_to_others(rng):
    rows = whole(np.hstack([np.eye(20, dtype=int), rng.integers(1, 5, (20, 1))]))
    assert few_columns.few_columns(rows, 21) is None


def test_a_tower_at_rest_has_the_bits_of_elimination_in_all_columns(monkeypatch):
    boxes = [
        qr.Body.of_shape(
            f"b{i}",
            qr.Box((0.03, 0.03, 0.02)),
            mass=0.1,
            xyz=(0.001 * i, 0, 0.02 + 0.04 * i),
            rpy=(0, 0, 0.1 * i),
        )
        for i in range(5)
    ]
    system = qr.System(boxes)
    floor = qr.PlacedShape("floor", 0, np.eye(3), np.zeros(3), qr.HalfSpace((0, 0, 1), 0.0))
    below = [floor, *system.shapes]
    pairs = [
        qr.ContactPair(f"p{i}", below[i], shape, 0.5, 0.0, 4, 4)
        for i, shape in enumerate(system.shapes)
    ]
    asked = []

    def counted(rows, size, of=few_columns.few_columns):
        asked.append(of(rows, size))
        return asked[-1]

    answers = []
    monkeypatch.setattr(minimiser, "LARGE", 20)
    for ways in (counted, lambda rows, size: None):
        monkeypatch.setattr(minimiser, "few_columns", ways)
        step = qr.Simulator(system, pairs, h=0.05, K_q=np.zeros((0, 0))).step(system.q_start, [])
        solution = step.solution
        answers.append([step.q.tobytes(), solution.lam.tobytes(), solution.certificate])
    assert answers[0] == answers[1]
    assert any(small is not None for small in asked)

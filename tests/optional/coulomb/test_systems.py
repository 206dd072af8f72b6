"""Systems of inequalities: solutions that hold, and none where there is none."""

import numpy as np
import pytest

from quasistatic_ref.optional.coulomb.systems import System


def system(C, d, equal=()):
    """Inequalities C z >= d, of which some are equations."""
    C = np.array(C, dtype=object)
    which = np.isin(np.arange(len(C)), equal)
    return System(C, np.array(d, dtype=object), which, np.zeros(C.shape[1], dtype=int))


def test_the_shortest_solution_is_exact():
    # x + y = 1, x - y >= 1/3, scaled by 3: the shortest is (2/3, 1/3).
    point = system([[3, 3], [3, -3]], [3, 1], equal=[0]).solution()
    assert [str(x) for x in point] == ["2/3", "1/3"]


def test_a_contradiction_by_less_than_rounding_is_one():
    tiny = 1 << 200
    assert system([[tiny], [-tiny]], [tiny + 1, -tiny]).solution() is None
    assert system([[tiny], [-tiny]], [tiny, -tiny]).solution() == [1]


@pytest.mark.parametrize(
    ("C", "d", "equal", "moves"),
    [
        ([[1, 0], [0, 1]], [1, 0], [0], False),  # x = 1, y >= 0
        ([[1, -1], [0, 1]], [0, 0], [0], True),  # x = y >= 0
        ([[1, -1], [-1, -1]], [0, 0], [], True),  # x >= y, -x >= y: x = 0 at y = 0 alone
        ([[1, 0], [-1, 0]], [0, 0], [], False),  # 0 <= x <= 0, without an equation
    ],
)
def test_whether_the_first_entries_can_differ(C, d, equal, moves):
    some = system(C, d, equal)
    assert some.moves(some.solution(), 1) is moves

"""The committed study of clouds: every cell of its grid, and rows that are made again alike."""

import pytest

from quasistatic_ref.lab.clouds.rows import margin, rows, rows_with
from quasistatic_ref.lab.clouds.study import NONE, Cell, cells, row
from tests.closeness import assert_relative

NAMES = list(Cell.__dataclass_fields__)


def test_every_cell_of_the_grid_has_its_row():
    assert [Cell(*(one[name] for name in NAMES)) for one in rows()] == list(cells())
    assert len(rows()) == 30 * (16 * 2 + 5 + 2 * (5 + 4 + 4 + 4))


def test_a_grip_whose_numbers_are_known_has_the_margin_of_r14():
    """(R14): needed = l / (2 N / W - 1 / mu_v), W = m (g + v / h)."""
    for one in rows()[::97]:
        if one.get("needed") is None:
            continue
        weight = 0.2 * (9.81 + 0.04 / 2.2 / 0.01)
        needed = one["lever"] / (2 * one["squeeze"] / weight - 1 / 0.6)
        assert_relative(one["needed"], needed, 1e-4)
        assert_relative(margin(one) * needed, one["mu_omega"] + one["spread"], 1e-4)


@pytest.mark.parametrize("change", [NONE, "squeeze"])
def test_a_row_is_made_again_to_the_last_digit(change):
    known = rows_with(change=change, sampling="random", count=992, seed=3)[-1]
    assert row(Cell(*(known[name] for name in NAMES))) == known

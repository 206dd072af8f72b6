"""The committed study of clouds: its rows are whole, and are made again alike."""

import json
from collections import Counter

import pytest

from quasistatic_ref.lab.figures.clouds import margin, rows
from tests.closeness import assert_relative
from validation.make.clouds import SAMPLINGS, row_again


def test_every_cell_of_the_grid_has_its_thirty_seeds():
    cells = Counter(
        tuple(row[name] for name in ("sampling", "count", "change", "value", "mu_omega"))
        for row in rows()
    )
    assert set(cells.values()) == {30}
    # 16 densities and 17 changes with and without torsion; 5 values of mu_omega.
    assert len(cells) == 16 * 2 + 17 * 2 + 5
    assert {cell[:2] for cell in cells} == {
        (sampling, count) for sampling in SAMPLINGS for count in (200, 992, 10_000, 100_000)
    }


def test_a_grip_whose_numbers_are_known_has_the_margin_of_r14():
    """(R14): needed = l / (2 N / W - 1 / mu_v), W = m (g + v / h)."""
    for one in rows()[::97]:
        if one.get("needed") is None:
            continue
        weight = 0.2 * (9.81 + 0.04 / 2.2 / 0.01)
        needed = one["lever"] / (2 * one["squeeze"] / weight - 1 / 0.6)
        assert_relative(one["needed"], needed, 1e-4)
        assert_relative(margin(one) * needed, one["mu_omega"] + one["spread"], 1e-4)


@pytest.mark.parametrize(
    ("sampling", "change"),
    [
        ("random", "none"),
        pytest.param("farthest", "none", marks=pytest.mark.long),
        ("scan", "none"),
        pytest.param("random", "stiffness", marks=pytest.mark.long),
    ],
)
def test_a_row_is_made_again_to_the_last_digit(sampling, change):
    of = {"sampling": sampling, "change": change, "count": 992, "seed": 3}
    known = [row for row in rows() if of.items() <= row.items()][-1]
    assert json.dumps(row_again(known)) == json.dumps(known)


def test_vertices_of_a_mesh_that_is_divided_are_drawn_as_they_were():
    known = next(r for r in rows() if (r["sampling"], r["count"]) == ("vertices", 10_000))
    assert row_again(known) == known

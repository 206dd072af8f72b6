"""Of each drawn scene the findings are those that are right by hand."""

import numpy as np
import pytest

from quasistatic_ref import coulomb_step
from tests.optional.doctor.mistake_scenes import GRAVE
from tests.optional.doctor.drawn_scenes import (
    BOTH,
    BROKEN,
    HEALTHY,
    SEEDS,
    Draw,
    G,
    bar,
    gripped,
    pile,
    pressed_on_a_wall,
    rolls,
    slope,
)


def drawn(kinds):
    """Each kind with its seeds; README's line takes one of every other kind."""
    for i, kind in enumerate(kinds):
        for seed in range(SEEDS * i, SEEDS * (i + 1)):
            marks = () if seed % (2 * SEEDS) == 0 else pytest.mark.long
            yield pytest.param(kind, seed, id=f"{kind.__name__}-{seed}", marks=marks)


@pytest.mark.parametrize(
    ("kind", "seed"),
    [*drawn(HEALTHY), *drawn(BROKEN), (pressed_on_a_wall, 64), (rolls, 103), (rolls, 105)],
)
def test_what_is_said_is_right_by_hand(kind, seed):
    """No finding is missing or undeserved, no look is open, and numbers are right to 1 %.

    That forces of single contacts are uncertain is true where several share a load.
    """
    scenario, hand, also = kind(Draw(seed))
    run = scenario.run(progress=False)
    said = {found.name: found.numbers for found in run.findings}
    said.pop("uncertain-forces", None)
    assert "fixed point" not in run.header.not_looked_at
    assert all(found.grave is GRAVE[found.name] for found in run.findings)
    assert hand.keys() <= said.keys() <= hand.keys() | also
    for name, numbers in hand.items():
        seen = {key: said[name][key] for key in numbers}
        assert seen == pytest.approx(numbers, rel=0.01, abs=1e-9)


def near_its_threshold(d, kind, near):
    """A slope, a grip, a bar off its centre or a pile with `near` times what forces may bear."""
    if kind == "slope":
        _, bodies, shapes = slope(d, near * d.mu)
        return d.scene(bodies, {"c": ("slope", "b", d.mu, 4)}, 1, shapes=shapes)
    if kind == "pile":
        return d.scene(*pile(d, near), 1)
    if kind == "bar":
        _, *parts = bar(d, 1 / near)
        return d.scene(*parts, 1)
    N = d.m * G / (2 * d.mu * near)
    bodies = gripped(d, N, d.edge) | {"b": d.cube(0, 0, 0)}
    return d.scene(bodies, {"c": (BOTH, "b", d.mu, 1, 0.01)}, 1)


@pytest.mark.parametrize("kind", ["slope", "grip", "bar", "pile"])
@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(i, marks=pytest.mark.long) for i in range(1, 12))]
)
def test_r49_r_falls_with_t_squared_where_forces_bear_the_loads_and_else_stays(kind, seed):
    """Up to a third more or less of what they may bear."""
    d = Draw(seed)
    near = d.between(0.75, 1.33)
    scenario, *_ = near_its_threshold(d, kind, near)
    step = scenario.run(progress=False).step_data(0)
    lacks = []
    for T in (0.1, 0.3):
        slow = coulomb_step(step.replace(h=T), "daqp")
        assert slow.converged
        lacks.append(step.M_u @ slow.delta_q[step.n_a :] / T**2)
    before, after = np.linalg.norm(lacks, axis=1)
    falls = 1 / 9 if near < 1 else 1.0
    assert after == pytest.approx(falls * before, rel=0.05, abs=1e-12)

"""Contact forces by compliance in the ellipsoid: nearest points of the cone, Newton's method."""

import numpy as np
import pytest
from flint import arb, arb_mat, ctx

from quasistatic_ref.certify.minimiser import inner
from quasistatic_ref.lab.scenes.rigid import rigid_step
from quasistatic_ref.optional.ellipsoid.forces import (
    BITS,
    INSIDE,
    CompliantStep,
    compliant_forces,
    pushed,
)
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import Extra
from tests.tolerances import ROUNDING

CORNERS = [[x, y, -0.03] for x in (0.05, -0.05) for y in (0.05, -0.05)]
COMPLIANCE = 1e-5
"""Of each contact [m/N]."""
H = arb(2) ** -200
"""Of central differences: their error, of third order, is far above the precision of 640 bits."""
CLOSE = arb(2) ** -330
WALL = Extra(("ceiling", "wall"), -np.eye(6)[[2, 0]], np.array([-1.0, -1e-5]))
"""The block may move by 1 m along z, and by 1e-5 m along x."""


@pytest.fixture(autouse=True)
def precision():
    with ctx.workprec(BITS):
        yield


def block(push=9.0, extra=None):
    """A block of 1 kg on four corners, pushed at its bottom until it slides."""
    wrench = [push, 0.3 * push, -9.81, 0, -0.03 * push, 0.01 * push]
    frames = [np.eye(3)] * 4
    inertia = (0.002, 0.002, 0.003)
    args = {"mu_v": 0.5, "mu_omega": 0.01, "phi": 1e-6, "h": 0.01}
    step = rigid_step(1.0, inertia, wrench, CORNERS, frames, **args)
    return step.replace(cone="ellipsoid", extra=extra)


def column(values):
    return arb_mat(len(values), 1, [arb(v) for v in values])


def small(x, size=1):
    """Whether all entries are at most CLOSE, relative to a size."""
    return all(abs(v) < CLOSE * size for v in x.entries())


def optimum(step):
    """The program, the minimiser, its pushed contacts and the multipliers of the user's rows."""
    program = CompliantStep(step, COMPLIANCE)
    x = arb_mat(step.n_v, 1)
    x, y = program.on_active_rows(x, program.pushed(x))
    return program, x, program.pushed(x), y


ON_CIRCLE = (2.0, 3.0, 6.0)  # of length 7
NEAREST = {
    "within the cone": ((-8.0, *ON_CIRCLE), (8.0, -2.0, -3.0, -6.0)),
    "on its axis": ((-8.0, 0.0, 0.0, 0.0), (8.0, 0.0, 0.0, 0.0)),
    "behind the apex": ((8.0, *ON_CIRCLE), (0.0, 0.0, 0.0, 0.0)),
    "behind it, on the axis": ((8.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)),
    # (s_0 + length) / 2 along (1, the unit tangent): (1 + 7) / 2 = 4 and (-1 + 7) / 2 = 3.
    "beside it, ahead": ((-1.0, *ON_CIRCLE), (4.0, -8 / 7, -12 / 7, -24 / 7)),
    "beside it, behind": ((1.0, *ON_CIRCLE), (3.0, -6 / 7, -9 / 7, -18 / 7)),
}


@pytest.mark.parametrize(("z", "nearest"), NEAREST.values(), ids=NEAREST)
def test_a_contact_gives_way_to_the_nearest_point_of_the_cone(z, nearest):
    found = pushed(column(z))
    np.testing.assert_allclose([float(v) for v in found.s.entries()], nearest, rtol=ROUNDING)
    for k in range(4):
        way = column(np.eye(4)[k]) * H
        difference = pushed(column(z) + way).s - pushed(column(z) - way).s
        by_z = column([found.by_z[i, k] for i in range(4)])
        assert small(difference / (2 * H) - by_z)


def test_the_gradient_is_that_of_the_energy(rng):
    program = CompliantStep(block(), COMPLIANCE)
    for _ in range(5):
        x, way = (column(v) for v in rng.normal(scale=1e-3, size=(2, 6)).tolist())
        ahead, behind = x + way * H, x - way * H
        difference = program.energy(ahead, program.pushed(ahead)) - program.energy(
            behind, program.pushed(behind)
        )
        slope = inner(program.gradient(x, program.pushed(x)), way)
        assert abs(difference / (2 * H) - slope) < CLOSE


@pytest.mark.parametrize("extra", [None, WALL], ids=["free", "wall"])
def test_newton_s_step_squares_the_error(extra, rng):
    program, x, _, y = optimum(block(extra=extra))
    held = [1] if extra is not None else []
    way = column(rng.normal(scale=1e-40, size=6).tolist())
    near = (x + way).mid()
    found = program.newton(near, program.pushed(near), held)
    after = near + column(found.entries()[:6])
    # Curvatures are of size 1 / (1e-5 m)^2: (1e-40)^2 becomes at most 1e-65.
    assert all(abs(v) < arb(10) ** -60 for v in (after - x).entries())
    if held:
        assert abs(found[6, 0] - y[1, 0]) < arb(10) ** -30
        assert y[0, 0] == 0
        assert y[1, 0] > 0


def test_the_minimiser_has_no_gradient_but_that_of_the_rows_it_presses_on():
    program, x, give, y = optimum(block(extra=WALL))
    off = program.gradient(x, give) - program.E.transpose() * y
    assert small(off)
    gap = max(abs(gap[0, 0]) for gap in program.gap)
    assert abs((program.E * x - program.e)[1, 0] - INSIDE * gap) < INSIDE * gap / 1000
    free, x_free, give_free, none = optimum(block())
    assert small(free.gradient(x_free, give_free))
    assert none.nrows() == 0
    # The free block moves through the wall, and a wall that it leaves does not press.
    assert (program.E * x_free - program.e)[1, 0] < 0
    leaving, away, _, left = optimum(block(push=-9.0, extra=WALL))
    assert left[1, 0] == 0
    assert leaving.distance(away, left, leaving.H.inv()) < CLOSE


def test_few_iterations_suffice(monkeypatch):
    calls = []
    newton = CompliantStep.newton
    monkeypatch.setattr(
        CompliantStep, "newton", lambda *arguments: calls.append(1) or newton(*arguments)
    )
    for push in (0.0, 3.0, 9.0):
        step = block(push)
        at = solve_step(step)
        calls.clear()
        compliant_forces(step, COMPLIANCE, (at.delta_q, at.wrench))
        assert len(calls) <= 20


@pytest.mark.parametrize("extra", [None, WALL], ids=["free", "wall"])
def test_the_bound_of_the_distance_is_none_less_and_a_few_times_more(extra, rng):
    program, x, _, y = optimum(block(extra=extra))
    H_inv = program.H.inv()
    for size in (1e-9, 1e-20):
        way = column((size * np.array([-1.0, *rng.normal(size=5)])).tolist())  # off the wall
        true = program.squared(way)
        bound = program.distance(x + way, y, H_inv)
        assert true <= bound * bound
        near = program.distance(x + way / 1024, y, H_inv)
        assert near < bound / 16
    if extra is not None:
        through = x + column([1e-9, 0, 0, 0, 0, 0])
        assert not program.distance(through, y, H_inv) < arb("inf")
        assert not program.distance(x, -y, H_inv) < arb("inf")


def test_a_row_is_held_where_it_is_broken_or_met():
    # -x >= 0 and -x - y >= -1: terms of 1 and of 2, less the right side.
    rows = Extra(("a", "b"), [[-1.0, 0, 0, 0, 0, 0], [-1.0, -1.0, 0, 0, 0, 0]], [0.0, -1.0])
    program = CompliantStep(block(extra=rows), COMPLIANCE)
    for x, y, held in ((-1.0, 0.0, [False, False]), (1.0, 0.0, [True, True]),
                       (0.5, 0.5 - 1e-9, [True, False]), (0.5, 0.5 - 1e-15, [True, True]),
                       (-1.0, 2.5, [False, True]), (-100.0, 101 - 1e-11, [False, True]),
                       (-100.0, 101 - 1e-9, [False, False])):  # fmt: skip
        at = column([x, y, 0, 0, 0, 0])
        assert [program.tight(i, at) for i in range(2)] == held


def test_a_share_of_a_step_is_taken_that_lowers_the_energy():
    program, best, _, _ = optimum(block())
    x = arb_mat(6, 1)
    give = program.pushed(x)
    way = best - x
    assert program.share(x, give, way) == 1
    # The energy falls along 16 of these ways as far as it does along one, and rises beyond.
    share = program.share(x, give, way * 16)
    there = x + way * 16 * share
    assert share < 1 / 4
    assert program.energy(there, program.pushed(there)) < program.energy(x, give)

"""Programs in natural units (source/natural.c) and DAQP, called group by group."""

from types import SimpleNamespace

import numpy as np
import pytest

from quasistatic_ref import solve_step
from quasistatic_ref.certify.groups import Group
from quasistatic_ref.lab.bench.scenes import boxes
from quasistatic_ref.optional.fast.joined import Masses
from quasistatic_ref.optional.fast.program import NaturalProgram, Program, Workspace
from quasistatic_ref.optional.fast.solver import FastSolver
from quasistatic_ref.solve.solver import Reply
from quasistatic_ref.solve.units import units_of
from quasistatic_ref.step.standard_form import StandardForm
from tests.helpers import changed, error, planted_step
from tests.tolerances import ACTIVE_SET

HALF = np.sqrt(2.0)
"""Between 1 and 2, as near to one as to the other by its logarithm."""


def units(H, g, A, b):
    """Units by C, and by NumPy; and the program that C has written, if it has."""
    H, g, A, b = (np.array(values, dtype=np.float64) for values in (H, g, A, b))
    m, n = A.shape
    each = np.arange(m)
    program = Program([Group(np.arange(n), each, each[:0], each)])
    rows = {"g": g, "A": A, "b": b, "rows": np.ones(m, np.int64)}
    natural = NaturalProgram(
        SimpleNamespace(rows=rows, column=np.tile(np.arange(n), (m, 1))), program
    )
    natural.take(Masses(1.0, np.zeros((0, 0)), H))
    in_c = natural.units()
    if in_c is not None:
        natural.write(in_c)
    with np.errstate(all="ignore"):
        expected = units_of(StandardForm(H, g, A, b))
    return in_c, expected, program


DECIDED = {
    "rows of one length": ([3.0, 0.0], [[1.0, 0.0]], [-1.0]),
    "an even number of rows": ([3.0, 0.0], [[1.0, 0.0], [0.0, 5.0]], [-1.0, -1.0]),
    "rows of many lengths": (
        [3.0, 0.0],
        [[2.0**k, 0.0] for k in (6, 0, 10, 2, 8, 1, 4)],
        [-1.0] * 7,
    ),
    "rows of zeros and others": ([3.0, 0.0], [[0.0, 0.0], [0.0, 7.0], [0.0, 0.0]], [0.0] * 3),
    "rows of zeros alone": ([3.0, 0.0], [[0.0, 0.0]], [-1.0]),
    "penetration": ([1e-3, 0.0], [[4.0, 0.0]], [9.0]),
    "no load, and a gap": ([0.0, 0.0], [[4.0, 0.0]], [-9.0]),
    "nothing at all": ([0.0, 0.0], [[4.0, 0.0]], [0.0]),
}
OPEN = {
    "a row whose length is between two powers": ([3.0, 0.0], [[1.0, 1.0]], [-1.0]),
    "a load between two powers": ([1.0, 1.0], [[1.0, 0.0]], [-1.0]),
    "a load next to that": ([HALF, 1e-13], [[1.0, 0.0]], [-1.0]),
    "a load whose square vanishes": ([1e-200, 0.0], [[4.0, 0.0]], [-1.0]),
    "a push out between two powers": ([0.0, 0.0], [[1.0, 0.0]], [HALF]),
    "a number that is none": ([np.nan, 0.0], [[1.0, 0.0]], [-1.0]),
    "an infinite gap": ([1.0, 0.0], [[1.0, 0.0]], [-np.inf]),
    "a row that is too long": ([1.0, 0.0], [[1e200, 0.0]], [-1.0]),
    "a row that is too short": ([1.0, 0.0], [[1e-150, 0.0]], [-1.0]),
}


@pytest.mark.extra("fast")
@pytest.mark.parametrize("case", DECIDED.values(), ids=DECIDED)
def test_units_are_those_of_numpy(case):
    in_c, expected, program = units(np.diag([1.0, 16.0]), *case)
    assert (in_c.length, in_c.size) == (expected.length, expected.size)
    assert (in_c.coordinate == [1.0, 0.25]).all()
    g, A, b = map(np.array, case)
    S, ell, rho = in_c
    assert program.f.tobytes() == (g * (S / -rho)).tobytes()
    assert program.A.tobytes() == (A * (S / ell)).tobytes()
    assert program.b.tobytes() == (b * (1 / (rho * ell))).tobytes()


@pytest.mark.extra("fast")
@pytest.mark.parametrize("case", OPEN.values(), ids=OPEN)
def test_units_that_an_order_of_sums_may_decide_are_left_to_numpy(case):
    in_c, _, program = units(np.eye(2), *case)
    assert in_c is None
    assert not any(part.any() for part in (program.f, program.A, program.b))


def test_a_warm_start_that_fails_is_followed_by_a_cold_one(rng, monkeypatch):
    step, *_ = planted_step(rng)
    solver = FastSolver(step)
    right = solve_step(step, solver, certify="off").delta_q
    honest = Workspace._solved
    calls = []

    def solved(self, H, *, warm):
        calls.append(warm)
        return Reply(None, None, False, "at a loss") if warm else honest(self, H, warm=warm)

    monkeypatch.setattr(Workspace, "_solved", solved)
    again = solve_step(step, solver, certify="off").delta_q
    assert error(step, again, right) <= ACTIVE_SET
    assert calls == [True, False]


CORNERS = {
    "square": ([0.0, 1.0, 1.0], np.eye(3)),
    "nearly flat": (
        [-1.0, 1.0, 0.0],
        [[-(2.0**-16), -1.0, -1.0], [0.0, 1.0, 0.0], [0.0, 1.0, 1.0]],
    ),
}
"""Loads f and rows of walls A x >= 0; x = 0 is the answer, as f is A' of multipliers >= 0."""


def test_a_workspace_that_had_no_finite_answer_is_set_up_again():
    """DAQP has NaN in the second corner after the first, and would have it from then on."""
    f, A, b, H = np.zeros(3), np.zeros((3, 3)), np.zeros(3), np.eye(3)
    f[:], A[:] = CORNERS["square"]
    workspace = Workspace(H, f, A, b, {})
    for corner in ("square", "nearly flat", "square"):
        f[:], A[:] = CORNERS[corner]
        reply = workspace.reply(H)
        assert reply.solved
        assert np.abs(reply.answer[0]).max() < ACTIVE_SET


def test_a_step_that_couples_what_the_step_before_did_not_is_solved(rng):
    """J of a kept solver may have entries where it had zeros."""
    scene = boxes(2)
    step = scene.simulator("off", False).step(scene.q, np.zeros(0), scene.force).step
    solver = FastSolver(step)
    J = step.contacts.J.copy()
    J[0, 0, 6] = 0.5
    coupled = step.replace(contacts=changed(step.contacts, J=J))
    for one in (step, coupled):
        answer = solve_step(one, solver, certify="off").delta_q
        assert error(one, answer, solve_step(one, "none").delta_q) <= ACTIVE_SET

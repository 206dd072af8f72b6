"""Backends by their own interface: the program is CVXPY's, certified answers have its bits."""

import subprocess
import sys

import cvxpy as cp
import numpy as np
import pytest

from quasistatic_ref import BackendError, Extension, Extra, solve_step, standard_form
from quasistatic_ref.optional.fast.adapters.daqp import Daqp
from quasistatic_ref.optional.fast.native import NativeSolver
from quasistatic_ref.optional.fast.solver import FastSolver
from quasistatic_ref.solve.backends import installed
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.units import (
    DenseStepInBothUnits,
    natural_step,
    natural_units,
    within_reach,
)
from tests.helpers import changed, error, free_displacement, planted_step, random_step
from tests.tolerances import ACTIVE_SET

every_backend = pytest.mark.parametrize("backend", installed("native"))
FAR_AWAY = [1e-4, 50.0, 2e-4]
"""Gaps [m] of three contacts, of which one is out of reach."""


def some_step(rng, phi=None, rows=(6, 4, 6)):
    """A step with levers of a millimetre, and with a row of the user's own."""
    step = random_step(rng, rows=rows)
    contacts = changed(step.contacts, J=1e-3 * step.contacts.J)
    contacts = contacts if phi is None else changed(contacts, phi=phi)
    return step.replace(contacts=contacts, extra=Extra(("own",), 1e-3 * np.ones((1, 7)), [-1e-3]))


@every_backend
@pytest.mark.parametrize("far", [False, True])
def test_the_program_handed_over_is_the_standard_form_of_the_natural_step(backend, far, rng):
    # Written again, it holds nothing of the step before.
    solver = NativeSolver(some_step(rng), backend)
    solver.answer(DenseStepInBothUnits(some_step(rng)), 1e-9)
    step = some_step(rng, FAR_AWAY if far else None)
    assert natural_units(step).length != 1
    solver.answer(DenseStepInBothUnits(step), 1e-9)
    natural = natural_step(step, natural_units(step))
    if solver.adapter.NEAR:
        natural, _ = within_reach(natural)
    expected = standard_form(natural)
    program = solver.program
    for found, value in ((program.H, expected.H), (program.f, -expected.g),
                         (program.A, expected.A), (program.b, expected.b)):  # fmt: skip
        np.testing.assert_array_equal(found, value)


@every_backend
@pytest.mark.parametrize("far", [False, True])
def test_the_natural_form_stays_that_of_the_step_when_it_is_written(backend, far, rng):
    """In rows of C, as residuals read it; a program of that order is not copied."""
    step = some_step(rng, FAR_AWAY if far else None)
    both = DenseStepInBothUnits(step)
    solver = FastSolver(step, backend)
    out_of_reach = solver.write(both)
    expected = DenseStepInBothUnits(step).natural_form
    for found, value in zip(both.natural_form, expected, strict=True):
        np.testing.assert_array_equal(found, value)
    assert both.natural_form.A.flags.c_contiguous
    shared = both.natural_form.A is solver.program.A
    assert shared == (solver.adapter.ORDER == "C" and out_of_reach is None)
    if out_of_reach is not None:
        assert far
        np.testing.assert_array_equal(out_of_reach, [*np.repeat([0, 1, 0], step.counts), 0])


def test_only_a_step_of_the_same_layout_and_sizes_is_taken(rng):
    solver = NativeSolver(random_step(rng), "daqp")
    assert solver.fits(random_step(rng))
    assert not solver.fits(random_step(rng, rows=(4, 6, 6)))
    assert not solver.fits(random_step(rng, n_a=4, n_u=3))


def test_a_step_without_rows_needs_no_backend(rng):
    step = random_step(rng, rows=())
    answer = solve_step(step, NativeSolver(step, "daqp"), certify="off")
    assert error(step, answer.delta_q, free_displacement(step)) <= ACTIVE_SET


def test_a_start_from_the_answer_before_that_fails_is_followed_by_a_cold_one(rng, monkeypatch):
    step = planted_step(rng)[0]
    calls = []
    honest = Daqp.reply
    solver = NativeSolver(step, "daqp")
    right = solve_step(step, solver, certify="off").delta_q

    def reply(self, same_H, warm):
        calls.append((same_H, warm))
        return Reply(None, None, False, "at a loss") if warm else honest(self, same_H, warm)

    monkeypatch.setattr(Daqp, "reply", reply)
    found = solve_step(step, solver, certify="off").delta_q
    assert error(step, found, right) <= ACTIVE_SET
    assert calls == [(True, True), (False, False)]


def test_extensions_that_are_more_than_rows_need_cvxpy(rng):
    step = random_step(rng)
    curved = Extension(lambda s: [cp.norm(s.delta_q) <= 1.0])
    with pytest.raises(
        BackendError,
        match="takes linear constraints only; for a cost or a nonlinear constraint pass",
    ):
        solve_step(step, NativeSolver(step, "clarabel"), extension=curved)


NATIVE_RUN = """
import sys
from quasistatic_ref.cli.main import main
status = main(["run", "sphere_spin", "--fast", "--set", "steps=3", "--json", "--out", sys.argv[1]])
heavy = "cvxpy", "qpsolvers", "scipy", "matplotlib", "osqp", "piqp", "clarabel", "numba"
print(status, [name for name in heavy if name in sys.modules])
"""


@pytest.mark.extra("fast")
def test_a_fast_run_imports_neither_cvxpy_nor_what_it_does_not_call(tmp_path):
    """It takes less time than these packages take to be imported."""
    command = [sys.executable, "-c", NATIVE_RUN, str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.stdout.splitlines()[-1] == "0 []", done.stderr

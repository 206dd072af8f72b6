"""Backends by their own interface: the program is CVXPY's, certified answers have its bits."""

import subprocess
import sys

import cvxpy as cp
import numpy as np
import pytest

from quasistatic_ref.errors import BackendError
from quasistatic_ref.optional.fast.adapters.daqp import Daqp
from quasistatic_ref.optional.fast.native import NativeSolver
from quasistatic_ref.optional.fast.solver import FastSolver
from quasistatic_ref.solve.backends import installed
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.units import (
    DenseStepInBothUnits,
    natural_step,
    natural_units,
    phi_within_reach,
)
from quasistatic_ref.step.extension import Extension
from quasistatic_ref.step.standard_form import standard_form
from tests.helpers import changed, error, planted_step, random_step, unconstrained
from tests.tolerances import ACTIVE_SET, EXACT

every_backend = pytest.mark.parametrize("backend", installed("native"))


@every_backend
@pytest.mark.parametrize("far", [False, True])
def test_the_program_handed_over_is_the_standard_form_of_the_natural_step(backend, far, rng):
    # Written again, it holds nothing of the step before.
    solver = NativeSolver(random_step(rng), backend)
    solver.answer(DenseStepInBothUnits(random_step(rng)), 1e-9)
    step = random_step(rng)
    if far:
        step = step.replace(contacts=changed(step.contacts, phi=[1e-4, 50.0, 2e-4]))
    solver.answer(DenseStepInBothUnits(step), 1e-9)
    natural = natural_step(step, natural_units(step))
    if solver.adapter.NEAR:
        natural = natural.replace(contacts=changed(natural.contacts, phi=phi_within_reach(natural)))
    expected = standard_form(natural)
    program = solver.program
    for found, value in ((program.H, expected.H), (program.f, -expected.g),
                         (program.A, expected.A), (program.b, expected.b)):  # fmt: skip
        np.testing.assert_allclose(found, value, rtol=EXACT, atol=EXACT)


@every_backend
@pytest.mark.parametrize("far", [False, True])
def test_the_natural_form_stays_that_of_the_step_when_it_is_written(backend, far, rng):
    """In rows of C, as residuals read it; a program of that order is not copied."""
    step = random_step(rng)
    if far:
        step = step.replace(contacts=changed(step.contacts, phi=[1e-4, 50.0, 2e-4]))
    both = DenseStepInBothUnits(step)
    solver = FastSolver(step, backend)
    out_of_reach = solver.write(both)
    expected = DenseStepInBothUnits(step).natural_form
    for found, value in zip(both.natural_form, expected, strict=True):
        np.testing.assert_array_equal(found, value)
    assert both.natural_form.A.flags.c_contiguous
    shared = both.natural_form.A is solver.program.A
    assert shared == (solver.adapter.ORDER == "C" and out_of_reach is None)


def test_a_step_without_rows_needs_no_backend(rng):
    step = random_step(rng, rows=())
    answer = solve_step(step, NativeSolver(step, "daqp"), certify="off")
    assert error(step, answer.delta_q, unconstrained(step)) <= ACTIVE_SET


def test_a_start_from_the_answer_before_that_fails_is_followed_by_a_cold_one(rng, monkeypatch):
    step = planted_step(rng)[0]
    calls = []
    honest = Daqp.reply
    solver = NativeSolver(step, "daqp")
    right = solve_step(step, solver, certify="off").delta_q

    def reply(self, same_H, warm):
        calls.append(warm)
        return Reply(None, None, False, "at a loss") if warm else honest(self, same_H, warm)

    monkeypatch.setattr(Daqp, "reply", reply)
    found = solve_step(step, solver, certify="off").delta_q
    assert error(step, found, right) <= ACTIVE_SET
    assert calls == [True, False]


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


def test_a_fast_run_imports_neither_cvxpy_nor_what_it_does_not_call(tmp_path):
    """It takes less time than these packages take to be imported."""
    command = [sys.executable, "-c", NATIVE_RUN, str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.stdout.splitlines()[-1] == "0 []", done.stderr

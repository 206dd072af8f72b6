"""A sample of validation/make/attacks.py, and planted faults that it finds."""

from fractions import Fraction

import numpy as np
import pytest

from quasistatic_ref import solve_step
from quasistatic_ref.cli.certificate_words import in_words
from quasistatic_ref.cli.solution_files import solution_text
from quasistatic_ref.lab.scenes.contacts import no_contacts
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.optional.fast import solver as fast_solvers
from quasistatic_ref.solve.prover import Prover
from quasistatic_ref.solve.solver import solver_for
from quasistatic_ref.step.files import step_text
from validation.make.attacks import Attack, bounds, exact_answers, matrices
from validation.tools.verifier_files import verify_refusal


@pytest.fixture
def attack(tmp_path):
    return Attack("sample", tmp_path)


@pytest.mark.parametrize("family", ["all scales", "subnormal loads", "nearly singular"])
def test_nothing_is_wrong_in_a_sample(attack, family):
    exact_answers(attack, family, 2)
    bounds(attack, family, 2)
    assert attack.wrong == []
    assert attack.counts["bounded"] == 2


def test_no_nearly_singular_matrix_is_judged_wrongly(attack):
    matrices(attack, "M_u", 6)
    assert attack.wrong == []
    assert min(attack.counts["accepted"], attack.counts["refused"]) > 0


@pytest.mark.parametrize("tau", [1e-323, 1e-312])
def test_the_bound_of_a_subnormal_answer_is_of_the_answer_as_given(tmp_path, tau):
    """A mass of 3 kg in a second: x* = tau / 3, of which delta_q has few digits."""
    step = free_step(np.array([[3.0]]), np.array([tau]), no_contacts(1), 1.0)
    solution = solve_step(step, solver_for(step, "daqp", fast=True), certify="residual")
    error = abs(Fraction(solution.delta_q[0]) / (Fraction(tau) / 3) - 1)
    assert Fraction(solution.certificate.error_bound) >= error
    assert verify_refusal(tmp_path, step_text(step), solution_text(solution)) is None


def test_a_bound_above_one_is_no_useful_bound(monkeypatch):
    step = free_step(np.eye(1), np.ones(1), no_contacts(1), 1.0)
    monkeypatch.setattr(fast_solvers, "BOUNDED", -1.0)
    for bound, said in ((1.0, 1.0), (np.nextafter(1.0, 2.0), None), (3e276, None), (np.inf, None)):
        monkeypatch.setattr(Prover, "error_bound", lambda *_, bound=bound: bound)
        solver = solver_for(step, "daqp", fast=True)
        certificate = solve_step(step, solver, certify="residual").certificate
        assert certificate.error_bound == said
        assert ("no useful bound" in in_words(certificate)) == (said is None)

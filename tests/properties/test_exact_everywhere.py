"""A sample of validation/make/exact_everywhere.py: every backend ends at the same bits."""

import numpy as np
import pytest

from quasistatic_ref.certify.certificate import Verdict
from quasistatic_ref.certify.exact_step import exact_step
from quasistatic_ref.errors import StepInfeasible
from quasistatic_ref.scenario.scenario import load_scenario
from tests.helpers import sphere_on_floor
from tests.oracles.random_steps import mixed_step
from validation.make import exact_everywhere
from validation.make.exact_everywhere import BACKENDS, checked


@pytest.mark.parametrize("mu_omega", [0.003, 0.0])
def test_every_backend_ends_at_the_same_bits_of_a_grasp(mu_omega):
    """Approach, closing, squeeze and the first of the lift."""
    settings = ["steps=106", f"contacts.grip.mu_omega={mu_omega}", "solver.certify='residual'"]
    run = load_scenario("bunny_grasp", settings, fast=True).run(progress=False)
    checks = [checked(run.step_data(k)) for k in range(0, run.steps, 21)]
    assert [check.faults for check in checks] == [[]] * 6
    assert all(check.kinds == {"optimal"} for check in checks)
    # Each certificate once for each coordinate and direction.
    assert all(check.refusals == 2 * 13 * check.certificates > 0 for check in checks)
    assert all(set(check.digits) == set(BACKENDS[:-1]) for check in checks)


@pytest.mark.parametrize("block", range(4))
def test_every_backend_ends_at_the_same_bits_of_random_steps(block):
    for seed in range(100 + block, 120, 4):
        check = checked(mixed_step(seed))
        assert check.faults == [], seed
        assert len(check.kinds) == 1, seed
        assert (check.certificates > 0) == (check.kinds == {"optimal"}), seed


def test_infeasible_steps_are_so_for_every_backend():
    infeasible = []
    for step in map(mixed_step, range(1, 100)):
        try:
            exact_step(step)
        except StepInfeasible:
            infeasible.append(step)
    assert len(infeasible) >= 2
    for step in infeasible[:2]:
        check = checked(step)
        assert check.kinds == {"infeasible"}
        assert check.faults == []


def faults_of(monkeypatch, name, spoilt):
    monkeypatch.setattr(exact_everywhere, name, spoilt)
    return checked(sphere_on_floor(wrench=(0.5, 0.0, -3.0, 0.0, 0.0, 0.01))).faults


def test_a_backend_with_other_bits_is_noticed(monkeypatch):
    """One unit in the last place of one coordinate, from one backend."""

    def spoilt(step, backend, **options):
        solution = solve_step(step, backend, **options)
        if backend == "piqp":
            moved = solution.delta_q.copy()
            moved[2] = np.nextafter(moved[2], 1)
            object.__setattr__(solution, "delta_q", moved)
        return solution

    solve_step = exact_everywhere.solve_step
    faults = faults_of(monkeypatch, "solve_step", spoilt)
    assert any("piqp" in fault and "other bits" in fault for fault in faults)
    assert any("different bits" in fault for fault in faults)


def test_a_verification_that_accepts_everything_is_noticed(monkeypatch):
    faults = faults_of(monkeypatch, "verify", lambda *_: Verdict(True))
    assert sum("is accepted" in fault for fault in faults) >= 2 * 6


def test_a_verification_that_accepts_nothing_is_noticed(monkeypatch):
    faults = faults_of(monkeypatch, "verify", lambda *_: Verdict(False, "delta_q[0]"))
    assert any("refused" in fault for fault in faults)

"""The bound in float64 is never below the error, and each of its constants is needed."""

import numpy as np
from flint import fmpq_mat

from quasistatic_ref.certify.gap import fractions, free_energy
from quasistatic_ref.certify.rational import exact_form, fraction
from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.lab.scenes.grasps import grasp_step
from quasistatic_ref.optional.fast.guess.confirm import BallHessian
from quasistatic_ref.optional.large import rounded_bound
from quasistatic_ref.optional.large.bound import error_bound
from quasistatic_ref.optional.large.judged import bound_verdict
from quasistatic_ref.optional.large.rounded_bound import FloatBound
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.units import DenseStepInBothUnits, Units, in_natural, in_si, natural_step
from tests.helpers import point_on_floor
from tests.oracles.random_steps import any_step
from validation.make.confirmed_bits import CONES

FUZZED = 60
"""Random steps of a fuzz, with an answer each."""


def small_step(rng):
    """A step of few coordinates in any polyhedral cone, half of them in units far apart."""
    step = any_step(rng, *(int(v) for v in rng.integers((0, 1, 1), (3, 4, 4))), mass_ratio=1e4)
    step = step.replace(cone=str(rng.choice(CONES)))
    if rng.random() < 0.5:
        return step
    units = 2.0 ** rng.integers(-20, 21, step.n_v), 2.0 ** int(rng.integers(-20, 21)), 1.0
    return natural_step(step, Units(*units))


class Judged:
    """A step and an answer, with what the bound makes of it; x and lam in natural units."""

    def __init__(self, step, x, lam):
        self.step, both = step, DenseStepInBothUnits(step)
        self.form = both.natural_form
        self.units = both.units
        S, ell, rho = self.units
        self.x, self.y = x, np.maximum(lam, 0.0)
        hessian = BallHessian(step)
        self.bound = FloatBound(hessian.inverse, hessian.h, self.form.H, S)
        self.given = step, self.form, (ell, rho), x
        self.at = self.bound.rounded(*self.given, self.y)
        self.error = self.bound.error(*self.given, lam)

    def exact(self):
        """A x - b, H x - g - A'y and ||H^-1 g||_H^2 in natural units, without rounding."""
        S, ell, rho = self.units
        form = exact_form(self.step)
        delta_q, lam = in_si(self.x, self.y, self.units)
        x = fmpq_mat(form.n, 1, fractions(delta_q, form.x_unit))
        y = fmpq_mat(form.m, 1, fractions(lam, form.lam_unit))
        A = fmpq_mat(form.A)
        slack = A * x - fmpq_mat(form.b)
        balance = fmpq_mat(form.H) * x - fmpq_mat(form.g) - A.transpose() * y
        length = fraction(rho) * fraction(ell)
        size = fraction(rho)
        energy = 2 * free_energy(form) * form.net_unit * form.x_unit / size**2
        return (
            [s * form.slack_unit / length for s in slack.entries()],
            [
                r * form.net_unit * fraction(s) / size
                for r, s in zip(balance.entries(), S, strict=True)
            ],
            energy,
        )

    def within(self):
        """Whether slacks, balance and energy are as near to their exact values as is claimed."""
        slack, balance, energy = self.exact()
        at = self.at
        u = fraction(rounded_bound.U)
        off_slack = fraction(at.off_slack)
        return (
            all(abs(fraction(v) - e) <= off_slack + u * abs(fraction(v))
                for v, e in zip(at.slack, slack, strict=True)),
            all(abs(fraction(v) - e) <= fraction(off)
                for v, e, off in zip(at.balance, balance, at.off_balance, strict=True)),
            fraction(self.bound.energy(self.form.g, at.load)) <= energy,
        )  # fmt: skip


def some_answer(rng, step):
    """An answer that is nearly right, or anything."""
    both = DenseStepInBothUnits(step)
    n = step.n_v
    m = int(step.offsets[-1])
    x = rng.standard_normal(n)
    lam = rng.standard_normal(m) * (rng.random(m) < 0.3)
    try:
        answer = solve_step(step, "none")
    except StepNotSolved:
        return x, lam
    right = in_natural(answer.delta_q, answer.lam, both.units)
    size = rng.choice([0.0, 1e-14, 1e-9, 1e-3])
    return right[0] + size * x, right[1] + size * lam


def test_slacks_balance_and_energy_are_as_near_as_is_claimed():
    rng = np.random.default_rng(1)
    for _ in range(FUZZED):
        step = small_step(rng)
        assert all(Judged(step, *some_answer(rng, step)).within())


def test_no_answer_of_random_steps_has_a_false_bound():
    """What a file would say, of displacement and multipliers, is compared in fractions."""
    rng = np.random.default_rng(2)
    bounded = 0
    for _ in range(FUZZED):
        step = small_step(rng)
        judged = Judged(step, *some_answer(rng, step))
        if judged.error is not None and judged.error <= 1:
            delta_q, lam = in_si(judged.x, judged.y, judged.units)
            assert bound_verdict(step, delta_q, lam, judged.error)
            bounded += 1
    assert bounded > FUZZED / 3


def test_units_out_of_range_are_left_to_balls():
    step = point_on_floor(force=(4.0, 1.0, -2.943))
    answer = np.zeros(3), np.zeros(4)
    assert Judged(step, *answer).error is not None
    for units in ((2.0**110, 1.0, 1.0), (1.0, 2.0**220, 1.0), (1.0, 1.0, 2.0**110)):
        coordinate, *others = units
        far = natural_step(step, Units(np.full(3, coordinate), *others))
        assert Judged(far, *answer).error is None


def test_a_bound_that_is_too_large_is_tried_in_balls(monkeypatch):
    step = grasp_step(np.random.default_rng(4))
    quick = solve_step(step, "daqp", certify="residual", fast=True)
    monkeypatch.setattr("quasistatic_ref.optional.fast.solver.BOUNDED", 0.0)
    slow = solve_step(step, "daqp", certify="residual", fast=True)
    balls = error_bound(step, slow.delta_q, slow.lam).error
    assert slow.certificate.error_bound == balls < quick.certificate.error_bound < 1e-6

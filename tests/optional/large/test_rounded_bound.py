"""The bound in float64 is never below the error, and each of its constants is needed."""

import numpy as np

from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.lab.scenes.grasps import grasp_step
from quasistatic_ref.optional.fast.guess.confirm import BallHessian
from quasistatic_ref.optional.large.bound import error_bound
from quasistatic_ref.optional.large.judged import bound_verdict
from quasistatic_ref.optional.large.rounded_bound import FloatBound
from quasistatic_ref.solve.scaled import DenseStep
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.units import Units, from_natural, in_natural, to_natural
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
    return to_natural(step, Units(*units))


class Judged:
    """A step and an answer, with what the bound makes of it; x and lam in natural units."""

    def __init__(self, step, x, lam):
        self.step, scaled = step, DenseStep(step)
        self.form, self.units = scaled.natural_form, scaled.units
        S, ell, rho = self.units
        self.x, self.y = x, np.maximum(lam, 0.0)
        hessian = BallHessian(step)
        self.bound = FloatBound(hessian.inverse, hessian.h, self.form.H, S)
        self.error = self.bound.error(step, self.form, (ell, rho), x, lam)


def some_answer(rng, step):
    """An answer that is nearly right, or anything."""
    scaled = DenseStep(step)
    n, m = step.n_v, int(step.offsets[-1])
    x, lam = rng.standard_normal(n), rng.standard_normal(m) * (rng.random(m) < 0.3)
    try:
        answer = solve_step(step, "none")
    except StepNotSolved:
        return x, lam
    right = in_natural(answer.delta_q, answer.lam, scaled.units)
    size = rng.choice([0.0, 1e-14, 1e-9, 1e-3])
    return right[0] + size * x, right[1] + size * lam


def test_no_answer_of_random_steps_has_a_false_bound():
    """What a file would say, of displacement and multipliers, is compared in fractions."""
    rng, bounded = np.random.default_rng(2), 0
    for _ in range(FUZZED):
        step = small_step(rng)
        judged = Judged(step, *some_answer(rng, step))
        if judged.error is not None and judged.error <= 1:
            delta_q, lam = from_natural(judged.x, judged.y, judged.units)
            assert bound_verdict(step, delta_q, lam, judged.error)
            bounded += 1
    assert bounded > FUZZED / 3


def test_units_out_of_range_are_left_to_balls():
    step = point_on_floor(force=(4.0, 1.0, -2.943))
    answer = np.zeros(3), np.zeros(4)
    assert Judged(step, *answer).error is not None
    for units in ((2.0**110, 1.0, 1.0), (1.0, 2.0**220, 1.0), (1.0, 1.0, 2.0**110)):
        coordinate, *others = units
        far = to_natural(step, Units(np.full(3, coordinate), *others))
        assert Judged(far, *answer).error is None


def test_a_bound_that_is_too_large_is_tried_in_balls(monkeypatch):
    step = grasp_step(np.random.default_rng(4))
    quick = solve_step(step, "daqp", certify="residual", fast=True)
    monkeypatch.setattr("quasistatic_ref.optional.fast.solver.BOUNDED", 0.0)
    slow = solve_step(step, "daqp", certify="residual", fast=True)
    balls = error_bound(step, slow.delta_q, slow.lam).error
    assert slow.certificate.error_bound == balls < quick.certificate.error_bound < 1e-6

"""Steps of every kind end at the same bits from every warm start, and verification holds them."""

import numpy as np
import pytest

from quasistatic_ref.certify.certificate import exact_certificate, verify
from quasistatic_ref.certify.exact_step import exact_step
from quasistatic_ref.certify.farkas import farkas_refutation
from quasistatic_ref.certify.warm import warm_rows
from quasistatic_ref.errors import StepInfeasible, StepNotSolved
from quasistatic_ref.solve.solver import solver_for
from quasistatic_ref.step.standard_form import standard_form
from quasistatic_ref.tolerances import ACCURACY
from tests.oracles.random_steps import mixed_step

BACKENDS = ("clarabel", "osqp", "piqp", "daqp")


def warm_starts(step, seed):
    """None, all rows, every other row backwards, garbage, and what the backends find."""
    rng = np.random.default_rng(seed)
    form = standard_form(step)
    m = len(form.b)
    yield []
    yield range(m)
    yield range(m - 1, -1, -2)
    yield rng.integers(0, m, size=2 * m).tolist() if m else []
    for name in BACKENDS if m else ():
        solver = solver_for(step, name)
        scaled = solver.scaled(step)
        natural = standard_form(scaled.natural)
        try:
            answer = solver.answer(scaled, ACCURACY)
        except StepNotSolved:
            continue
        yield warm_rows(natural.A, answer.lam, natural.A @ answer.delta_q - natural.b)


def answer_from(step, warm):
    try:
        return exact_step(step, warm)
    except StepInfeasible as failure:
        return failure.farkas


@pytest.mark.parametrize("block", range(4))
def test_every_warm_start_ends_at_the_same_bits(block):
    for seed in range(block, 80, 4):
        step = mixed_step(seed)
        first, *others = (answer_from(step, warm) for warm in warm_starts(step, seed))
        if not hasattr(first, "delta_q"):
            for farkas in (first, *others):
                assert farkas_refutation(step, farkas.exact) is None
            continue
        for other in others:
            for name in ("delta_q", "net", "slack"):
                assert getattr(first, name).tobytes() == getattr(other, name).tobytes(), seed
            assert first.multipliers_unique == other.multipliers_unique, seed
            assert first.differentiable == other.differentiable, seed
            assert first.smallest_inactive_slack == other.smallest_inactive_slack, seed
            if first.multipliers_unique:
                assert first.lam.tobytes() == other.lam.tobytes(), seed
        for optimum in (first, others[-1]):
            claims = exact_certificate(step, optimum)
            verdict = verify(step, optimum.delta_q, claims.active, optimum.lam, claims)
            assert verdict, (seed, verdict.reason)


@pytest.mark.parametrize("seed", range(0, 40, 4))
def test_one_unit_in_the_last_place_is_refused_in_every_entry(seed):
    step = mixed_step(seed)
    optimum = answer_from(step, [])
    if not hasattr(optimum, "delta_q"):
        assert farkas_refutation(step, optimum.exact) is None
        return
    active = exact_certificate(step, optimum).active
    assert verify(step, optimum.delta_q, active)
    for v in range(step.n_v):
        for side in (-np.inf, np.inf):
            moved = optimum.delta_q.copy()
            moved[v] = np.nextafter(moved[v], side)
            verdict = verify(step, moved, active)
            assert not verdict
            assert f"delta_q[{v}]" in verdict.reason


def test_the_family_is_mixed():
    answers = [answer_from(mixed_step(seed), []) for seed in range(80)]
    optima = [a for a in answers if hasattr(a, "delta_q")]
    assert len(answers) - len(optima) >= 3
    assert len(optima) >= 50
    assert sum(not o.multipliers_unique for o in optima) >= 10
    assert sum(len(o.working_set) == 0 for o in optima) >= 3

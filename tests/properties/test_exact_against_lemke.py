"""A second exact check of `certify/optimum.py`, by Lemke's method, sharing no code with it.

Optima, multipliers and what is unique of them are fractions of another method. The drawn programs
have ties, rows that depend on each other, numbers far apart, and contradictions of one ulp.
"""

from collections import Counter

import numpy as np
import pytest

from quasistatic_ref.certify.degeneracy import form_degeneracy
from quasistatic_ref.certify.optimum import form_optimum
from quasistatic_ref.exact.active_set import Combination
from quasistatic_ref.exact.minimiser import Minimiser
from tests.made import bits
from tests.oracles.forms import exact_form_of
from tests.oracles.lemke import multipliers_near, only_multipliers, optimum
from tests.oracles.random_programs import random_program
from tests.oracles.rational_kkt import exact, refutation
from validation.check_solution import infeasible

PROGRAMS = 50


def drawn_program(seed):
    """H, g, A and b of min 1/2 x'Hx - g'x with A x >= b: an equation is two rows."""
    of = random_program(seed)
    one = np.eye(len(of["q"]))
    A = np.concatenate([-of["G"], of["A"], -of["A"], one, -one])
    b = np.concatenate([-of["h"], of["b"], -of["b"], of["lb"], -of["ub"]])
    some = np.isfinite(b)
    return of["P"], -of["q"], A[some], b[some]


def facts_of(A, b, x, lam):
    """Whether lam is unique and x differentiable, and the smallest slack that does not vanish.

    x is differentiable where each row without slack bears with some multipliers. With lam_i = 0,
    lam itself is as near to lam + e_i as any multipliers without row i.
    """
    slack = exact(A) @ x - exact(b)
    touch = slack == 0
    rows, at_rows = exact(A[touch]), lam[touch]
    pulls = exact(np.eye(len(rows)))
    free = (i for i, value in enumerate(at_rows) if not value)
    smooth = all(multipliers_near(at_rows + pulls[i], rows, at_rows)[i] for i in free)
    outside = slack[~touch] if smooth else [0]
    return only_multipliers(rows, (), at_rows), smooth, min(map(float, outside), default=None)


def test_the_exact_optimum_agrees_with_lemkes_method():
    kinds = Counter()
    for seed in range(PROGRAMS):
        H, g, A, b = drawn_program(seed)
        truth = optimum(exact(H), -exact(g), -exact(A), -exact(b))
        facts = None if truth is None else facts_of(A, b, *truth)
        kinds[facts and facts[:2]] += 1
        some = np.random.default_rng(seed).permutation(len(b)).tolist()
        for rows in ([], range(len(b)), some):
            form = exact_form_of(H, g, A, b)
            found = form_optimum(form, rows)
            if isinstance(found, Combination):
                y = [str(found.y.get(i, 0)) for i in range(len(b))]
                assert truth is None, seed
                assert infeasible(exact(A).tolist(), exact(b).tolist(), y), seed
                continue
            assert found.delta_q.tolist() == [*map(float, truth[0])], seed
            claims = {"x": found.delta_q, "net": found.net, "slack": slacks(form, found)}
            assert refutation(H, g, A, b, found.lam, **claims) is None, seed
            assert form_degeneracy(form, found.working_set) == facts, seed
            active = found.lam[found.lam != 0].tolist()
            assert found.smallest_active_multiplier == min(active, default=None), seed
            assert found.working_set == tuple(np.flatnonzero(found.lam).tolist()), seed
    assert len(kinds) >= 4
    assert min(kinds.values()) > 1


def slacks(form, found):
    """All slacks at an optimum, rounded."""
    minimiser = Minimiser(form, tuple(found.working_set))
    return minimiser.rounded(lambda point: form.slacks(range(form.m), point.z))


def answer_of(seed, precision):
    """The bits of an optimum and of its slacks, and what is unique; None where there is none."""
    form = exact_form_of(*drawn_program(seed), bits=precision)
    found = form_optimum(form)
    if isinstance(found, Combination):
        return None
    answer = found.delta_q, found.net, slacks(form, found)
    return bits(answer), form_degeneracy(form, found.working_set)


@pytest.mark.parametrize("precision", [2, 8])
def test_bits_do_not_depend_on_the_precision_of_the_balls(precision):
    """With balls that decide next to nothing every sign is taken from rational numbers."""
    for seed in range(0, 320, 5):
        assert answer_of(seed, precision) == answer_of(seed, None), seed

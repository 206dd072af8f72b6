"""A second exact check of `certify/optimum.py`, by enumeration, sharing no code with it.

Every subset of independent rows is solved in `fractions`; one whose multipliers and slacks are
>= 0 is the optimum, and if none is the problem is infeasible. Small integers make ties common.
"""

import random
from collections import Counter
from contextlib import suppress
from fractions import Fraction
from itertools import chain, combinations

import numpy as np
import pytest

from quasistatic_ref.certify.active_set import Combination
from quasistatic_ref.certify.degeneracy import form_degeneracy
from quasistatic_ref.certify.minimiser import Minimiser
from quasistatic_ref.certify.optimum import form_optimum
from tests.oracles.forms import exact_form_of
from tests.oracles.random_programs import random_program
from tests.oracles.rational_kkt import (
    exact,
    farkas_refutation,
    proved_optimum,
    refutation,
    solution,
)

PROBLEMS = 200


def subsets(rows, most):
    """Subsets of rows, the smallest first."""
    return chain(*(combinations(rows, k) for k in range(most + 1)))


class Enumeration:
    """All optimal working sets of min 1/2 x'Hx - g'x s.t. Ax >= b, by H, g, A and b."""

    def __init__(self, *program):
        _, g, A, b = program
        self.x = None
        self.vertices = []
        for W in subsets(range(len(b)), min(len(g), len(b))):
            with suppress(ArithmeticError):
                x, lam_w, self.slack = proved_optimum(program, W)
                assert self.x is None or (self.x == x).all()
                self.x = x
                lam = [Fraction(0)] * len(b)
                for i, v in zip(W, lam_w, strict=True):
                    lam[i] = v
                if lam not in self.vertices:
                    self.vertices.append(lam)
        if self.x is not None:
            self._degeneracy(A)

    def _degeneracy(self, A):
        """Rays of the set of optimal multipliers: circuits d >= 0 with A_Z'd = 0."""
        Z = np.flatnonzero(self.slack == 0).tolist()
        rays = []
        for first, *rest in list(subsets(Z, len(Z)))[1:]:
            with suppress(ArithmeticError):  # a_first = -sum d_i a_i, rest independent
                d = solution(A[rest] @ A[rest].T, -A[rest] @ A[first])
                if (d >= 0).all() and not (A[first] + d @ A[rest]).any():
                    rays.append({first, *(i for v, i in zip(d, rest, strict=True) if v)})
        supports = [{i for i, v in enumerate(lam) if v} for lam in self.vertices]
        strictly_active = set().union(*supports, *rays)
        self.unique = len(self.vertices) == 1 and not rays
        self.differentiable = strictly_active == set(Z)


def small_problem(seed):
    """H, g, A, b as floats: integers, sixteenths or full float64, n <= 4, m <= 8."""
    rng = random.Random(seed)
    n = rng.randint(1, 4)
    m = rng.randint(0, 8)
    number = rng.choice(
        [
            lambda: float(rng.randint(-2, 2)),
            lambda: rng.randint(-8, 8) / 16,
            lambda: rng.uniform(-1, 1),
        ]
    )
    L = [[number() if j < i else 0.0 for j in range(n)] for i in range(n)]
    H = np.array(L) @ np.array(L).T + np.diag([float(rng.choice([1, 1, 2])) for _ in range(n)])
    H = np.tril(H) + np.tril(H, -1).T
    if rng.random() < 0.4:
        H = np.eye(n)
    g = np.array([number() for _ in range(n)])
    A = [[number() for _ in range(n)] for _ in range(m)]
    b = [rng.choice([0.0, number(), -abs(number())]) for _ in range(m)]
    for i in range(1, m):
        kind = rng.random()
        j = rng.randrange(i)
        if kind < 0.15:  # a duplicate, scaled
            A[i] = [2 * a for a in A[j]]
            b[i] = 2 * b[j]
        elif kind < 0.25:  # an equation, if both hold
            A[i] = [-a for a in A[j]]
            b[i] = -b[j]
        elif kind < 0.3:  # the same direction, another offset: infeasible or idle
            A[i], b[i] = [-a for a in A[j]], -b[j] + rng.choice([-1.0, 1.0])
        elif kind < 0.4 and i >= 2:  # dependent on two rows
            k = rng.randrange(i)
            A[i] = [p + q for p, q in zip(A[j], A[k], strict=True)]
            b[i] = b[j] + b[k]
    return H, g, np.array(A).reshape(m, n), np.array(b)


def test_exact_optimum_agrees_with_the_enumeration_of_all_working_sets():
    kinds = Counter()
    for seed in range(PROBLEMS):
        H, g, A, b = problem = small_problem(seed)
        truth = Enumeration(*map(exact, problem))
        kinds["infeasible"] += truth.x is None
        kinds["ambiguous"] += truth.x is not None and not truth.unique
        kinds["kink"] += truth.x is not None and not truth.differentiable
        rng = random.Random(seed)
        for rows in ([], list(range(len(b))), [rng.randrange(len(b)) for _ in b]):
            form = exact_form_of(H, g, A, b)
            found = form_optimum(form, rows)
            assert isinstance(found, Combination) == (truth.x is None), seed
            if isinstance(found, Combination):
                y = {i: str(v) for i, v in found.y.items() if v}
                assert farkas_refutation(A, b, y) is None, seed
                continue
            assert found.delta_q.tolist() == [float(v) for v in truth.x], seed
            slack = exact_slack(form, found.working_set)
            answer = (found.delta_q, found.net, slack, found.lam)
            assert refutation(H, g, A, b, *answer) is None, seed
            facts = form_degeneracy(form, found.working_set)
            assert facts.multipliers_unique == truth.unique, seed
            assert facts.differentiable == truth.differentiable, seed
            outside = [s for s in truth.slack if s] if truth.differentiable else [Fraction(0)]
            assert facts.smallest_inactive_slack == min(map(float, outside), default=None), seed
            active = [v for v in found.lam.tolist() if v]
            assert found.smallest_active_multiplier == min(active, default=None), seed
            assert found.working_set == tuple(np.flatnonzero(found.lam).tolist()), seed
    assert min(kinds.values()) >= 5
    assert kinds["infeasible"] <= PROBLEMS / 2


def exact_slack(form, working_set):
    """All slacks at the minimiser on a working set, rounded."""
    minimiser = Minimiser(form, tuple(working_set))
    return minimiser.rounded(lambda point: form.slacks(range(form.m), point.z))


def bits_of(problem, bits):
    """The bits of an optimum and of its slacks, and what is unique; None where there is none."""
    form = exact_form_of(*problem, bits=bits)
    found = form_optimum(form)
    if isinstance(found, Combination):
        return None
    arrays = found.delta_q, found.net, exact_slack(form, found.working_set)
    return [array.tobytes() for array in arrays], form_degeneracy(form, found.working_set)


def middling_problem(seed):
    """H, g, A, b of a drawn program with so many rows that some enter and leave."""
    of = random_program(seed)
    one = np.eye(len(of["q"]))
    A = np.concatenate([-of["G"], of["A"], -of["A"], one, -one])
    b = np.concatenate([-of["h"], of["b"], -of["b"], of["lb"], -of["ub"]])
    some = np.isfinite(b)
    return of["P"], -of["q"], A[some], b[some]


@pytest.mark.parametrize("bits", [2, 8])
def test_bits_do_not_depend_on_the_precision_of_the_balls(bits):
    """With balls that decide next to nothing every sign is taken from rational numbers."""
    problems = [small_problem(seed) for seed in range(0, PROBLEMS, 5)]
    problems += [middling_problem(seed) for seed in range(0, 200, 5)]
    for problem in problems:
        assert bits_of(problem, bits) == bits_of(problem, None)

"""Derivatives of the optimum against central differences without rounding, and verdicts.

The differences are taken of optima in rational numbers, of problems that the checker
for sceptics forms, at parameters moved by 2^-80 of their size: their truncation is below 1e-40.
"""

from fractions import Fraction as F
from math import lcm

import numpy as np
import pytest
from flint import arb_mat, fmpz_mat

from quasistatic_ref import StepNotSolved, solve_step, standard_form
from quasistatic_ref.certify.active_set import Combination, dual_active_set
from quasistatic_ref.certify.form import MatrixForm
from quasistatic_ref.lab.scenes.contacts import repeated
from quasistatic_ref.optional.derivatives.step.load_rates import load_rates
from quasistatic_ref.optional.derivatives.step.optimum_rates import DataRates, Equations
from quasistatic_ref.optional.derivatives.step.touching import touching_rows
from quasistatic_ref.step.friction import frame_jacobian
from tests.closeness import assert_within
from tests.helpers import changed
from tests.oracles.random_steps import any_step
from tests.oracles.rational_kkt import exact, fractions
from tests.oracles.solution_truth import problem, record_of

TINY = F(1, 2**80)
OF_CONTACTS = ("phi", "mu_v", "mu_omega")
INSTANCES = 30
CONES = ("pyramid", "pyramid", "product", "frictionless")


def keys(step):
    """Every parameter of a step: its name, and which."""
    sizes = {"delta_q_bar_a": step.n_a, "tau_a": step.n_a, "tau_u": step.n_u, "K_q": step.n_a}
    sizes |= dict.fromkeys(OF_CONTACTS, step.contacts.n_c)
    return [("h", 0), *((name, i) for name, size in sizes.items() for i in range(size))]


def is_stuck(step, key):
    """Whether it is a coefficient of zero, which cannot fall, or a gap that no motion changes."""
    name, i = key
    if name == "phi":
        return not (step.contacts.n[i] @ step.contacts.J[i, :3]).any()
    return name in ("mu_v", "mu_omega") and not number(step, key)


def derivatives_of(step):
    """D delta_q by each parameter, (n_v, P) in the order of `keys`; which columns there are."""
    answer = solve_step(step, "none")
    x = answer.delta_q
    contacts = step.contacts
    n_c = contacts.n_c
    by = load_rates(step, x)
    load = np.hstack([by["h"], by["delta_q_bar_a"], by["tau"], by["K_q"]])
    before = load.shape[1]
    load = np.hstack([load, np.zeros((step.n_v, 3 * n_c))])

    parts = np.stack(frame_jacobian(contacts, contacts.J), axis=1)
    slips = parts * np.array([0, 1, 1, 0])[:, None]
    spins = parts * np.array([0, 0, 0, 1])[:, None] * contacts.torsion[:, None, None]
    one = np.eye(n_c)
    motion = np.zeros((n_c, 4, load.shape[1]))
    motion[:, 0, before : before + n_c] = one
    for at, J in ((before + n_c, slips), (before + 2 * n_c, spins)):
        motion[:, :, at : at + n_c] = (J @ x)[:, :, None] * one[:, None]

    def pull(y):
        exerted = [np.einsum("jiv,ji->vj", J, y) @ one for J in (slips, spins)]
        return np.hstack([np.zeros((step.n_v, before + n_c)), *exerted])

    terms = np.abs(motion).max(axis=(0, 1), initial=0.0)
    equations = Equations(touching_rows(answer, np.zeros(n_c)))
    found = equations.rates(DataRates(load, motion, terms, pull))
    none = np.zeros(load.shape[1], dtype=bool)
    return found.x, ~np.any([none, *found.contradicts.values(), *found.opens], axis=0)


def number(step, key):
    name, i = key
    values = getattr(step.contacts if name in OF_CONTACTS else step, name)
    return exact(np.diag(values) if name == "K_q" else np.atleast_1d(values))[i]


def changed_by(step, key, little):
    """What the checker reads of a step, with one number changed."""
    name, i = key
    record = record_of(step)
    if name in OF_CONTACTS:
        of, at = record["contacts"][i], name
    elif name == "K_q":
        of, at = record[name][i], i
    else:
        of, at = (record, name) if name == "h" else (record[name], i)
    of[at] = F(of[at]) + little
    return record


def optimum(record):
    """The exact optimum of what the checker reads, as fractions, or None."""
    H, g, A, b = problem(record)
    n_v = len(g)
    H, g = whole(H, g, n_v)
    A, b = whole(A, b, n_v)
    rows = arb_mat([[*a, -b_i] for a, b_i in zip(A.tolist(), b.entries(), strict=True)])
    end = dual_active_set(MatrixForm(arb_mat(H), arb_mat(g), rows), [])
    if isinstance(end, Combination):
        return None
    return fractions(end.fractions.exact_x)


def whole(matrix, column, n):
    """Fractions times their common denominator."""
    common = lcm(*(v.denominator for row in [*matrix, column] for v in row))
    entries = [int(v * common) for row in matrix for v in row]
    return fmpz_mat(len(matrix), n, entries), fmpz_mat(
        len(column), 1, [int(v * common) for v in column]
    )


def optima_around(step, key):
    """Optima at the parameter less a little, as it is, and plus a little; and that little."""
    little = TINY * (abs(number(step, key)) or 1)
    return [optimum(changed_by(step, key, s * little)) for s in (-1, 0, 1)], little


def random_step(rng):
    """Of any masses, contacts and cone."""
    n_a, n_u, n_c = (int(v) for v in rng.integers(0, 4, 3))
    step = any_step(rng, n_a, n_u + (n_a + n_u == 0), n_c)
    return step.replace(cone=CONES[rng.integers(4)])


def degenerate_step(rng):
    """Of small whole numbers, so that rows depend on each other and touch without load."""
    n_a, n_u, n_c = (int(v) for v in rng.integers(0, 4, 3))
    step = any_step(rng, n_a, n_u + (n_a + n_u == 0), n_c + 1)
    c = step.contacts
    phi = rng.choice([0, 0, 1 / 64], c.n_c)
    contacts = changed(c, J=np.round(c.J), phi=phi, mu_v=rng.choice([0.0, 0.5, 1.0], c.n_c))
    contacts = repeated(contacts, [*range(c.n_c), 0])
    loads = {name: rng.integers(-2, 3, len(getattr(step, name))) for name in ("tau_a", "tau_u")}
    return step.replace(
        contacts=contacts, K_q=np.eye(step.n_a), M_u=np.eye(step.n_u),
        delta_q_bar_a=np.zeros(step.n_a), cone=CONES[rng.integers(4)], **loads,
    )  # fmt: skip


@pytest.mark.parametrize("family", [random_step, degenerate_step])
def test_r25_r26_r27_r33_a_random_step_has_a_derivative_or_two_sides(family, rng):
    """To 1e-9 of what a free step shows; a gap moves a body about as far as itself.

    A derivative exists where none is refused; where one is, both sides differ, of H and g always.
    Where nothing drives a step, rows that press only against each other count as without load.
    """
    seen = set()
    for _ in range(INSTANCES):
        step = family(rng)
        H, g, _, _ = standard_form(step)
        if not g.any():
            continue
        try:
            closed_form, there = derivatives_of(step)
        except StepNotSolved:
            continue
        every = keys(step)
        free = np.abs(np.linalg.solve(H, g)).max() + np.abs(step.contacts.phi).max(initial=0.0)
        sizes = dict.fromkeys(("h", "K_q", "mu_v", "mu_omega"), free)
        sizes |= dict.fromkeys(("tau_a", "tau_u"), step.h * np.abs(np.linalg.inv(H)).max())
        for k in (*rng.permutation(np.flatnonzero(~there))[:2],
                  *rng.permutation(np.flatnonzero(there))[:4]):  # fmt: skip
            if is_stuck(step, every[k]):
                continue
            of_contact = every[k][0] in OF_CONTACTS
            (below, at, above), little = optima_around(step, every[k])
            if None in (below, above):
                assert not there[k]
                continue
            sides = np.array(
                [[float((v - u) / little) for u, v in zip(*pair, strict=True)]
                 for pair in ((below, at), (at, above))]
            )  # fmt: skip
            size = max(sizes.get(every[k][0], 1.0), np.abs(sides).max())
            kinked = np.ptp(sides, axis=0).max() > 1e-9 * size
            if there[k]:
                assert_within(sides, np.tile(closed_form[:, k], (2, 1)), 1e-9 * size)
            elif not of_contact:
                assert kinked
            seen.add((of_contact, bool(there[k]), bool(kinked)))
    smooth = {(True, True, False), (False, True, False)}
    kinks = {(True, False, True), (False, False, True)}
    assert seen >= (smooth if family is random_step else smooth | kinks)

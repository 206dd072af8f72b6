"""Derivatives of the exact optimum against central differences without rounding, and verdicts.

The differences are taken of optima in rational numbers, of problems formed by plain loops of
fractions, at parameters moved by 2^-80 of their size: their truncation is below 1e-40.
"""

from fractions import Fraction as F
from math import lcm
from types import SimpleNamespace

import numpy as np
import pytest
from flint import fmpq, fmpq_mat, fmpz_mat

from quasistatic_ref.certify.active_set import Farkas, dual_active_set
from quasistatic_ref.certify.certificate import exact_certificate
from quasistatic_ref.certify.exact import step_optimum
from quasistatic_ref.certify.rational import ExactForm, exact_form
from quasistatic_ref.errors import InputError, StepNotSolved
from quasistatic_ref.lab.scenes.contacts import repeated
from quasistatic_ref.optional.derivatives.step.sensitivity import _active, sensitivity
from quasistatic_ref.optional.derivatives.step.strictly_active import strictly_active
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import Extra
from tests.helpers import (
    changed,
    pinch,
    point_on_floor,
    sphere_on_floor,
)
from tests.oracles.random_steps import any_step
from tests.oracles.rational_kkt import exact
from tests.oracles.solution_truth import program
from tests.tolerances import EXACT, ROUNDING

TINY = F(1, 2**80)
OF_CONTACTS = ("phi", "mu_v", "mu_omega")
INSTANCES = 40
CONES = ("pyramid", "pyramid", "product", "frictionless")


def keys(step):
    """Every parameter of a step: its name, and which."""
    sizes = {"delta_q_bar_a": step.n_a, "tau_a": step.n_a, "tau_u": step.n_u, "K_q": step.n_a}
    sizes |= dict.fromkeys(OF_CONTACTS, step.contacts.n_c)
    return [("h", 0), *((name, i) for name, size in sizes.items() for i in range(size))]


def number(step, key):
    name, i = key
    values = getattr(step.contacts if name in OF_CONTACTS else step, name)
    return exact(np.diag(values) if name == "K_q" else np.atleast_1d(values))[i]


def changed_by(step, key, little):
    """What :func:`program` reads of a step, in fractions, with one number changed."""
    name, i = key
    c = step.contacts
    fields = {name: exact(getattr(step, name)) for name in ("K_q", "M_u", "tau_a", "tau_u")}
    fields |= {"h": F(step.h), "delta_q_bar_a": exact(step.delta_q_bar_a)}
    contacts = {name: exact(getattr(c, name)) for name in OF_CONTACTS}
    if name == "h":
        fields["h"] += little
    elif name == "K_q":
        fields["K_q"][i][i] += little
    else:
        (contacts if name in OF_CONTACTS else fields)[name][i] += little
    others = {name: getattr(c, name) for name in ("n_c", "rows", "J", "n", "d1", "d2")}
    return SimpleNamespace(
        n_a=step.n_a, n_v=step.n_v, cone=step.cone, extra=SimpleNamespace(A=[], b=[]),
        contacts=SimpleNamespace(**contacts, **others), **fields,
    )  # fmt: skip


def optimum(step, warm):
    """The exact optimum as fractions, or None."""
    H, g, A, b = program(step)
    H, g = whole(H, g, step.n_v)
    A, b = whole(A, b, step.n_v)
    end = dual_active_set(ExactForm(H, g, A, b, fmpq(1), fmpq(1), fmpq(1), fmpq(1)), warm)
    if isinstance(end, Farkas):
        return None
    solution = end.minimiser.rational
    d = int(solution.denominator)
    return [F(int(v), d) for v in solution.x]


def whole(matrix, column, n):
    """Fractions times their common denominator."""
    common = lcm(*(v.denominator for row in [*matrix, column] for v in row))
    entries = [int(v * common) for row in matrix for v in row]
    return fmpz_mat(len(matrix), n, entries), fmpz_mat(
        len(column), 1, [int(v * common) for v in column]
    )


def moved(step, key, warm, sides=(-1, 0, 1)):
    """Optima at the parameter less a little, as it is, and plus a little; and that little."""
    little = TINY * (abs(number(step, key)) or 1)
    return [optimum(changed_by(step, key, s * little), warm) for s in sides], little


def column(found, key):
    return getattr(found, key[0])[:, key[1]]


def said(step, key):
    name, i = key
    if name in OF_CONTACTS:
        return f"{name}[{step.contacts.name[i]}]"
    return {"h": "h", "K_q": f"K_q[{i}, {i}]"}.get(name, f"{name}[{i}]")


def test_r25_derivatives_agree_with_central_differences_on_50_random_steps():
    compared = refused = 0
    for seed in range(50):
        rng = np.random.default_rng(seed)
        n_a, n_u, n_c = (int(v) for v in rng.integers(0, 4, 3))
        step = any_step(rng, n_a, n_u + (n_a + n_u == 0), n_c).replace(cone=CONES[seed % 4])
        try:
            best = step_optimum(step)
        except StepNotSolved:
            continue
        found = sensitivity(step, exact_certificate(step, best))
        every = keys(step)
        assert found.tau_a.shape == (step.n_v, step.n_a)
        for k in rng.permutation(len(every))[:4]:
            key = every[k]
            if said(step, key) in found.why_not:
                assert np.isnan(column(found, key)).all()
                refused += 1
                continue
            (below, above), little = moved(step, key, best.working_set, (-1, 1))
            expected = [float((a - b) / (2 * little)) for a, b in zip(above, below, strict=True)]
            scale = max(map(abs, expected))
            np.testing.assert_allclose(
                column(found, key), expected, rtol=ROUNDING, atol=ROUNDING * scale
            )
            compared += 1
    assert compared > 50
    assert refused > 0


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


def rank(step, key, rows, more=0):
    """The rank of [A b] of some rows where a number is that much larger."""
    _, _, A, b = program(changed_by(step, key, more))
    equations = [[fmpq(v.numerator, v.denominator) for v in (*A[i], b[i])] for i in rows]
    return fmpq_mat(equations).rref()[1] if rows else 0


def test_r26_r27_verdicts_on_random_degenerate_steps(rng):
    """A derivative where none is refused; where one is, both sides differ, of H and g always.

    The rank of the rows of S grows at all other coefficients or at none, and that of all rows
    without slack does not grow where there is a derivative.
    """
    seen = set()
    grown = set()
    for _ in range(INSTANCES):
        step = degenerate_step(rng)
        try:
            best = step_optimum(step)
        except StepNotSolved:
            continue
        certificate = exact_certificate(step, best)
        found = sensitivity(step, certificate)
        active = _active(exact_form(step), best.working_set)
        refused = [key for key in keys(step) if said(step, key) in found.why_not]
        given = [key for key in keys(step) if said(step, key) not in found.why_not]
        for key in keys(step):
            if key[0] in ("mu_v", "mu_omega") and number(step, key):
                here = rank(step, key, active.strict)
                others = (s * number(step, key) for s in (F(-2, 3), 1))
                grows = {rank(step, key, active.strict, more) > here for more in others}
                assert len(grows) == 1
                grown |= grows
        for key in (*refused[:2], *(given[i] for i in rng.permutation(len(given))[:2])):
            of_contact = key[0] in OF_CONTACTS
            (below, at, above), little = moved(step, key, best.working_set)
            if None in (below, above):
                assert key in refused
                continue
            sides = np.array(
                [[float((v - u) / little) for u, v in zip(*pair, strict=True)]
                 for pair in ((below, at), (at, above))]
            )  # fmt: skip
            size = np.abs(sides).max()
            kinked = np.ptp(sides, axis=0).max() > ROUNDING * size
            if key in given:
                expected = np.broadcast_to(column(found, key), (2, step.n_v))
                np.testing.assert_allclose(sides, expected, rtol=0, atol=ROUNDING * size)
                tight = (*active.strict, *active.idle)
                assert not of_contact or rank(step, key, tight, 1) <= rank(step, key, tight)
            elif not of_contact:
                assert kinked
            seen.add((of_contact, key in refused, kinked))
    assert grown == {True, False}
    assert seen >= {(True, False, False), (True, True, True),
                    (False, False, False), (False, True, True)}  # fmt: skip


def found_at(step):
    return sensitivity(step, exact_certificate(step, step_optimum(step)))


def test_a_sticking_contact_with_dependent_rows_is_differentiable():
    step = sphere_on_floor(wrench=(0.1, 0, -3, 0, 0, 0.01))
    found = found_at(step)
    assert found.why_not == {}
    # It follows the floor, delta_z = -phi, however rough that is, and rolls with m + I / r^2.
    np.testing.assert_allclose(found.phi[:, 0], [0, 0, -1, 0, 0, 0], rtol=EXACT, atol=EXACT)
    for name in ("mu_v", "mu_omega"):
        np.testing.assert_allclose(getattr(found, name), 0.0, rtol=EXACT, atol=EXACT)
    rolled = 0.01**2 / (0.3 + 2e-4 / 0.04**2)
    np.testing.assert_allclose(found.tau_u[0, 0], rolled, rtol=ROUNDING, atol=0.0)
    np.testing.assert_allclose(found.tau_u[2], 0.0, rtol=EXACT, atol=EXACT)


def test_the_gap_of_one_of_two_equal_contacts_has_no_derivative():
    step = sphere_on_floor(wrench=(0.1, 0, -3, 0, 0, 0.01))
    step = step.replace(contacts=repeated(step.contacts, [0, 0]))
    found = found_at(step)
    assert set(found.why_not) == {"phi[c0]", "phi[c1]"}
    assert found.why_not["phi[c0]"] == "the equations of c0 and c1 would contradict each other"
    # One-sided differences: lowering one gap lets the other carry on, raising it lifts the body.
    (below, at, above), little = moved(step, ("phi", 0), ())
    assert float((above[2] - at[2]) / little) == 0.0
    assert float((at[2] - below[2]) / little) == -1.0


def test_a_contact_that_touches_without_load_holds_on_one_side_only():
    step = point_on_floor(force=(0.0, 0.0, 0.0))
    found = found_at(step)
    expected = "c0 touches without load: it holds on one side only"
    assert found.why_not["phi[c0]"] == expected
    assert found.why_not["tau_u[2]"] == expected
    assert "h" not in found.why_not  # nothing drives it, whatever h is
    (below, at, above), _ = moved(step, ("tau_u", 2), ())
    assert above[2] > at[2] == below[2]


def test_two_rows_that_press_only_against_each_other_are_strictly_active():
    """X >= 0 and -x >= 0 at x = 0 and no load: any equal multipliers of both are optimal.

    Neither is in the working set, and each alone would hold on one side only; together they pin x.
    """
    pair = Extra(("east", "west"), np.array([[1.0, 0, 0], [-1.0, 0, 0]]), np.zeros(2))
    step = point_on_floor(phi=1.0).replace(extra=pair)
    answer = solve_step(step)
    assert answer.certificate.active == ()
    assert answer.certificate.differentiable
    assert not answer.certificate.multipliers_unique
    form = exact_form(step)
    assert strictly_active(form, (), (4, 5)) == [4, 5]
    assert strictly_active(form, (), (4,)) == []
    found = found_at(step)
    assert not {"tau_u[0]", "h", "phi[c0]"} & set(found.why_not)
    np.testing.assert_allclose(found.tau_u[:, 0], 0.0, rtol=EXACT, atol=EXACT)


def test_at_the_limit_of_friction_a_push_has_no_derivative():
    # mu W = 1.5 exactly: rows stick without using all of their share.
    step = point_on_floor(0.3, 0.5, force=(1.5, 0.0, -3.0))
    far = changed(step.contacts, phi=[1.0])
    both = repeated(step.contacts, [0, 0])
    step = step.replace(contacts=changed(both, phi=[0.0, float(far.phi[0])]))
    found = found_at(step)
    assert "tau_u[0]" in found.why_not
    assert "c0" in found.why_not["tau_u[0]"]
    assert "phi[c1]" not in found.why_not
    np.testing.assert_allclose(found.phi[:, 1], 0.0, rtol=EXACT, atol=EXACT)


def test_a_coefficient_of_zero_cannot_be_smaller():
    step = point_on_floor(0.3, 0.0, force=(1.0, 0.0, -3.0))
    found = found_at(step)
    assert found.why_not["mu_v[c0]"] == "it is zero, cannot be smaller, and c0 touches"
    open_ = step.replace(contacts=changed(step.contacts, phi=[1.0]))
    assert found_at(open_).why_not == {}


def test_it_refuses_what_no_exact_certificate_in_a_polyhedral_cone_of_the_step_goes_with():
    step, other = (pinch(grip=grip, offset=0.2) for grip in (5.0, 6.0))
    for one, certify in ((step, "residual"), (step.replace(cone="ellipsoid"), "full")):
        with pytest.raises(InputError, match="needs an exact certificate in a polyhedral cone"):
            sensitivity(one, solve_step(one, certify=certify).certificate)
    with pytest.raises(InputError, match="certificate: is of another step; take that of the step"):
        sensitivity(step, solve_step(other).certificate)

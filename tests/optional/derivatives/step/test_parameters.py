"""Why a step has no derivative by a parameter, in closed form."""

import numpy as np
import pytest
from flint import fmpq

from quasistatic_ref.certify.rational import exact_form, fraction
from quasistatic_ref.lab.scenes.contacts import no_contacts
from quasistatic_ref.lab.scenes.rigid import free_step
from quasistatic_ref.optional.derivatives.step.parameters import Change
from quasistatic_ref.optional.derivatives.step.sensitivity import Active, _obstacle, sensitivity
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.step.data import Extra
from tests.certify.test_exact import resting_point
from tests.helpers import point_on_floor
from tests.tolerances import EXACT, ROUNDING


def found_at(step):
    return sensitivity(step, solve_step(step).certificate)


@pytest.mark.parametrize(("factor", "touches_on"), [(1.0, True), (0.5, False), (-1.0, False)])
def test_an_idle_row_that_moves_with_the_optimum_still_touches(factor, touches_on):
    """A x >= b, a = 0.3, at x = 0.7 / 3: it does by da if a dx = -da x, and by db if a dx = db."""
    a = 0.3
    x = fraction(0.7) / 3
    own = Extra(("row",), [[a]], [-1.0])
    step = free_step(3 * np.eye(1), [0.7], no_contacts(1), 1.0).replace(extra=own)
    form = exact_form(step)
    assert form.slack_unit != 1
    for da, db in ((fmpq(1), fmpq(0)), (fmpq(0), fmpq(1))):
        change = Change("", "", np.zeros(1, dtype=object), {0: np.array([da, db])})
        dx = fraction(factor) * np.array([db - da * x]) / fraction(a)
        said = _obstacle(step, form, Active((), (), (0,)), change, np.array([x]), dx)
        assert (said == "") == touches_on


def test_a_coefficient_that_would_break_a_dependence_of_rows_is_refused():
    """On a floor with mu = 1, pushed along x = y: z = x = y, both rows z - x and z - y press.

    A row of the user's own is their sum, 2 z - x - y >= 0: with any other mu it is none.
    """
    own = Extra(("sum",), [[-1.0, -1.0, 2.0]], [0.0])
    step = point_on_floor(m=1.0, mu_v=1.0, force=(4.0, 4.0, -1.0), h=1.0).replace(extra=own)
    assert "would contradict each other" in found_at(step).why_not["mu_v[c0]"]


def test_a_turning_body_off_its_slips_has_derivatives_by_slip():
    """Pressed and turned with mu_v = 0: the row -spin lifts it by mu = mu_omega times its turn.

    No row of a slip touches there, so that mu_v may grow from 0 and changes nothing. With H = I,
    g = h^2 (-2, 4) along (z, turn) and z = mu turn, (1 + mu^2) turn is h^2 (4 - 2 mu) = 1 - mu / 2.
    """
    mu = 0.25
    step = resting_point(mu_v=0.0, mu_omega=mu).replace(tau_u=[0.0, 0.0, -2.0, 4.0])
    answer = solve_step(step)
    assert answer.certificate.active == ((0, 5),)
    found = found_at(step)
    assert "mu_v[c0]" not in found.why_not
    np.testing.assert_allclose(found.mu_v[:, 0], np.zeros(4), rtol=EXACT, atol=EXACT)
    turn = (1 - mu / 2) / (1 + mu**2)
    d_turn = (-0.5 - 2 * mu * turn) / (1 + mu**2)
    expected = [0.0, 0.0, turn + mu * d_turn, d_turn]
    np.testing.assert_allclose(found.mu_omega[:, 0], expected, rtol=ROUNDING, atol=0.0)

"""The closed forms of `quasistatic-ref validate` hold: those that take about a second or less."""

import pytest

from quasistatic_ref.lab.claims.claim import HOLDS, finding
from quasistatic_ref.lab.claims.registry import BY_NAME

QUICK = (
    "free_impedance pressed_impedance free_fall approach spinning_sphere_step sliding_point "
    "incline_tipping flat_patch locked_guide spurious_couple inertia_and_time_step"
)


@pytest.mark.parametrize("name", QUICK.split())
def test_a_closed_form_holds(name):
    assert finding(BY_NAME[name]).verdict == HOLDS

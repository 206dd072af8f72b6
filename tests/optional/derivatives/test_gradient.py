"""At rows that touch without load: the derivative along a direction, and those of one side."""

import numpy as np
import pytest

from quasistatic_ref import InputError, Sphere, derivatives
from quasistatic_ref.optional.derivatives.step import reason
from tests.optional.derivatives.free_bodies import (
    FLOOR,
    NONE,
    H,
    falling_ball,
    free,
    one_sided_derivative,
    verdict,
)
from tests.oracles.differences import after
from tests.tolerances import DIFFERENCE_OF_STEPS


@pytest.mark.parametrize("way", [(0, 0, 1.0, 0, 0, 0), (0, 0, -1.0, 0, 0, 0), (1, 2, -3, 4, 5, 6)])
def test_along_a_direction_a_weak_row_holds_or_lets_go(way):
    simulator, q = falling_ball()
    found, _ = verdict(simulator, q)
    e = np.array(way)
    move = simulator.system.integrate
    there = one_sided_derivative(lambda t: after(simulator, found.result.q, move(q, t * e), NONE))
    assert np.abs(found.along(q=e) - there).max() <= DIFFERENCE_OF_STEPS * np.abs(e).max()
    push = one_sided_derivative(lambda t: after(simulator, found.result.q, q, NONE, t * e), 1e-4)
    assert np.abs(found.along(tau=e) - push).max() <= DIFFERENCE_OF_STEPS * H**2 / 0.3


def test_a_motion_along_the_floor_leaves_every_row_as_it_is():
    simulator, q = falling_ball()
    along = derivatives(simulator, q, NONE, towards={"q": np.eye(6)[0]})
    assert {why.kind for why in along.reasons} == {reason.WEAK}


def test_a_wrong_direction_is_refused():
    simulator, q = free(Sphere(0.05), (0, 0, 0.0501), FLOOR)
    with pytest.raises(InputError, match=r"towards\.q: must have shape"):
        derivatives(simulator, q, NONE, towards={"q": np.zeros(5)})
    found, _ = verdict(simulator, q)
    with pytest.raises(InputError, match="must be one of q,"):
        found.along(p=np.zeros(6))
    with pytest.raises(InputError, match=r"tau: must have shape \(6,\)"):
        found.along(tau=np.ones((1, 6)))
    for bad in (np.nan, np.inf):
        with pytest.raises(InputError, match="q: must contain finite"):
            found.along(q=np.full(6, bad))

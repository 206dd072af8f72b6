"""The paper's Figure 1 in closed form: two opposed points hold a bar off its centre of mass.

Each finger presses with N. Held still, each contact carries m g / 2 along a pyramid axis and half
of the torque m g l about the common normal. Both share the one octahedron of friction_rows:

    (m g / 2) / mu_v + (m g l / 2) / mu_omega <= N,   so   l <= mu_omega (2 N / (m g) - 1 / mu_v).
"""

import numpy as np
import pytest

from quasistatic_ref.solve.solve import solve_step
from tests.helpers import error, pinch
from tests.tolerances import MULTIPLIERS, STICKING

M, N, MU_V, MU_OMEGA = 0.2, 5.0, 0.5, 0.02
LIMIT = MU_OMEGA * (2 * N / (M * 9.81) - 1 / MU_V)


def held(offset, **changes):
    return pinch(
        **{"m": M, "grip": N, "mu_v": MU_V, "mu_omega": MU_OMEGA, "offset": offset} | changes
    )


@pytest.mark.parametrize("share", [0.0, 0.5, 0.99])
def test_inside_the_limit_nothing_moves_and_each_finger_carries_half(share):
    step = held(share * LIMIT)
    answer = solve_step(step)
    gap = error(step, answer.delta_q, np.zeros(8))
    np.testing.assert_allclose(gap, 0.0, rtol=0.0, atol=STICKING)
    np.testing.assert_allclose(answer.wrench[:, 2], [N, N], rtol=MULTIPLIERS, atol=0.0)
    # d1 = y, d2 = n x y, so up is +d2 at the left finger and -d2 at the right one.
    up = [answer.wrench[0, 1], -answer.wrench[1, 1]]
    np.testing.assert_allclose(sum(up), M * 9.81, rtol=MULTIPLIERS, atol=0.0)
    about_x = answer.wrench[0, 3] - answer.wrench[1, 3]
    np.testing.assert_allclose(
        about_x, -M * 9.81 * share * LIMIT, rtol=MULTIPLIERS, atol=MULTIPLIERS * N * MU_OMEGA
    )


@pytest.mark.parametrize("share", [1.01, 1.5])
def test_beyond_the_limit_the_bar_turns_down_about_the_fingers(share):
    turned = solve_step(held(share * LIMIT)).delta_q[5]
    scale = held(share * LIMIT).h ** 2 * M * 9.81 * LIMIT / 1e-4  # turned freely by that torque
    assert turned > 1e-3 * (share - 1) * scale


@pytest.mark.parametrize("offset", [0.001, 0.01])
def test_without_torsion_any_offset_turns_the_bar(offset):
    assert offset < LIMIT
    turned = solve_step(held(offset, mu_omega=0.0)).delta_q[5]
    stuck = solve_step(held(offset)).delta_q[5]
    assert turned > 1e-6
    np.testing.assert_allclose(stuck, 0.0, rtol=0.0, atol=STICKING * turned)

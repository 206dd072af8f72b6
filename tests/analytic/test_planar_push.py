"""A slider pushed on the plane, (R28) of docs/derivations.md, against its formulas as written.

`quasistatic-ref validate planar_push` sweeps steps against the closed form; here the closed form
is held against what it has to satisfy, and steps against laws that do not need it.
"""

import numpy as np
import pytest

from quasistatic_ref.lab.scenes.slider import push, push_step
from quasistatic_ref.solve.solve import solve_step
from tests.tolerances import ROUNDING

C = 0.025


@pytest.mark.parametrize("sticks", [True, False])
@pytest.mark.parametrize("seed", range(8))
def test_the_support_moves_along_the_normal_of_its_limit_surface(seed, sticks):
    rng = np.random.default_rng(seed)
    point = rng.uniform(0.01, 0.05, 2) * rng.choice([-1, 1], 2)
    turn = rng.uniform(0, 2 * np.pi)
    of = push(point, np.array([np.cos(turn), np.sin(turn)]), mu_v=0.4, c=C,
              Pi=10 ** rng.uniform(-1, 0.5), lifted=rng.random(), sticks=sticks)  # fmt: skip
    answer = solve_step(push_step(of), "clarabel")
    assert answer.certificate.kind == "enclosure"
    f_1, f_2, N, tau = answer.wrench[0]
    mu_omega = 0.4 * C
    on_it = (f_1**2 + f_2**2) / (0.4 * N) ** 2 + tau**2 / (mu_omega * N) ** 2
    np.testing.assert_allclose(on_it, 1.0, rtol=ROUNDING, atol=0.0)
    # The gradient of that, against which it slips; in lengths, at the radius c.
    gradient = -np.array([f_1, f_2, tau / C**2]) * [1, 1, C]
    motion = answer.delta_q[[2, 3, 5]] * [1, 1, C]
    unit = motion / np.linalg.norm(motion)
    np.testing.assert_allclose(gradient / np.linalg.norm(gradient), unit, rtol=0.0, atol=ROUNDING)

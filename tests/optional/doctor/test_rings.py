"""A link on a spring softer than its load's slope: docs/artifacts.md derives when it rests."""

import math

import pytest
from scipy.optimize import brentq

from tests.optional.rows import CASES, made

MOMENT = 0.1 * 9.81 * 0.1
"""m g l / 2 of a link of 0.1 kg and 0.2 m [N m]."""


@pytest.mark.parametrize(("over", "sign"), [(0.99, 1), (1.01, -1)])
def test_jumps_grow_from_k_0_0744_down(over, sign):
    """Where t tan t = 1, t = 0.8603, the load's slope is K where it rests."""
    K = MOMENT * math.sin(0.860334)
    assert pytest.approx(0.0744, rel=1e-3) == K
    rest = brentq(lambda t: K * over * t - MOMENT * math.cos(t), 0.0, 1.5)
    (row,) = (row for row in CASES if row["what"].startswith("K = 0.05"))
    off_rest = {"bodies.link.K_q.hinge": K * over, "bodies.link.positions": {"hinge": rest + 0.01}}
    off = abs(made(row, off_rest).run(progress=False).q[:, 0] - rest)
    assert sign * (off[-1] - off[0]) > 0.2 * off[0]

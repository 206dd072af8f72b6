"""A link on a spring softer than its load's slope: docs/artifacts.md derives when it rests."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import brentq

from quasistatic_ref.optional.doctor.steps.rings import ringing
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


@pytest.mark.parametrize(
    ("over", "steps", "soft"),
    [
        (0.97, 200, True),
        (1.03, 60, False),
        (1.03, 200, False),
        (1.01, 200, False),
        (1.2, 60, False),
    ],
)
def test_a_spring_is_soft_only_below_its_load_s_slope_at_rest(over, steps, soft):
    """Just above it the link comes to rest slowly, by some K_0 / K a step, and is not told."""
    K = MOMENT * math.sin(0.860334) * over
    rest = brentq(lambda t: K * t - MOMENT * math.cos(t), 0.0, 1.5)
    assert (MOMENT * math.sin(rest) > K) is soft
    (row,) = (row for row in CASES if row["what"].startswith("K = 0.05"))
    near = {"bodies.link.K_q.hinge": K, "bodies.link.positions": {"hinge": rest + 0.02}}
    said = made(row, near | {"steps": steps}).run(progress=False).findings
    assert [one.name for one in said] == ["rings"] * soft
    assert all("is softer than its load's slope" in one.cause for one in said)


class Jumps(dict):
    """The last jumps of one coordinate, by a factor a step, as `ringing` reads them."""

    system = SimpleNamespace(n_a=1)
    targets_move = np.zeros(40, dtype=bool)

    def __init__(self, factor):
        super().__init__(delta_q=(factor ** np.arange(40.0))[:, None])


@pytest.mark.parametrize("factor", [-0.9, -0.92, -0.93])
def test_what_is_less_than_half_after_ten_steps_comes_to_rest(factor):
    """Of these 0.35, 0.43 and 0.48 are left after ten steps; of the last 0.56 after eight."""
    assert abs(factor) ** 10 < 0.5
    assert ringing(Jumps(factor)) == {}


LEVER = """<mujoco><option gravity="0 0 -10"/><default><geom contype="0" conaffinity="0"/></default>
<worldbody><body name="bar"><joint name="h" type="hinge" axis="0 1 0" stiffness="{K}"/>
<geom type="capsule" fromto="0 0 0 .2 0 .2" size=".01" mass=".4"/></body>
<body name="m" pos=".2 0 {z}"><freejoint/><geom size=".02" mass=".5"/></body></worldbody>
<equality><connect body1="bar" body2="m" anchor=".2 0 .2"/></equality></mujoco>"""


@pytest.mark.parametrize(("K", "length"), [(600, 0.2), (600, 0.3), (60, 0.2)])
@pytest.mark.parametrize("over", [0.9, 1.1])
def test_what_hangs_rings_from_h_of_the_root_of_2_l_over_g_on(K, length, over):
    """A ball of radius r whose middle is d below its pin has l = (2 r^2 / 5 + d^2) / d."""
    h = over * math.sqrt(2 * (0.4 * 0.02**2 + length**2) / length / 10)
    case = {"mjcf": LEVER.format(K=K, z=0.2 - length), "folder": ".", "with": {"h": h, "steps": 24}}
    run = made(case).run(progress=False)
    assert bool(abs(run["delta_q"][-1]).max() > 1e-3) is (over > 1)
    said = [(one.name, one.remedy) for one in run.findings]
    assert said == [("rings", "take a smaller h")] * (over > 1)

"""A link on a spring softer than its load's slope: docs/artifacts.md derives when it rests."""

import math

import pytest
from scipy.optimize import brentq

from quasistatic_ref import load_scenario
from tests.files.urdf.urdf_texts import collision, joint, link, robot

MOMENT = 0.1 * 9.81 * 0.1
"""m g l / 2 of a link of 0.1 kg and 0.2 m [N m]."""
RESTS = {0.07: 0.8862, 0.05: 1.0226}
"""Rests by hand, K t = m g l / 2 cos t, at a K below 0.0744 N m/rad."""


def soft_link(K, start=0.0, **more):
    """A run of the link, from an angle [rad] below the horizontal."""
    at = '<origin xyz="0.1 0 0"/>'
    inertial = f'<inertial>{at}<mass value="0.1"/>'
    inertial += '<inertia ixx="1e-5" iyy="3e-4" izz="3e-4" ixy="0" ixz="0" iyz="0"/></inertial>'
    arm = link("arm", collision('<box size="0.2 0.02 0.02"/>', at), inertial=inertial)
    urdf = robot(link("post", inertial=""), arm, joint("j", "post", "arm", "revolute", "0 1 0"))
    urdf = urdf.replace('lower="-1" upper="1"', 'lower="-3" upper="3"')
    body = {"urdf": urdf, "actuated": ["j"], "K_q": {"j": K}, "positions": {"j": start}}
    body |= {"gravity_compensated": False, "targets": [{"t": 0, "j": 0.0}]} | more
    scene = {"h": 0.05, "steps": 60, "bodies": {"c": body}, "contacts": {}}
    return load_scenario(scene).run(progress=False)


@pytest.mark.parametrize("K", RESTS)
def test_a_link_that_rests_by_hand_jumps_to_and_fro(K):
    """It stays where it rests, but for rounding that each step multiplies by MOMENT sin(t) / K."""
    run = soft_link(K)
    (one,) = [one for one in run.findings if one.name == "rings"]
    assert one.grave
    assert one.cause.endswith(f"its spring, {K:g} N m/rad, is softer than its load's slope")
    rest = RESTS[K]
    assert pytest.approx(MOMENT * math.cos(rest), rel=2e-4) == K * rest
    assert soft_link(K, rest).q[1, 0] == pytest.approx(rest, abs=2e-4)


@pytest.mark.parametrize(("over", "sign"), [(0.99, 1), (1.01, -1)])
def test_jumps_grow_from_k_0_0744_down(over, sign):
    """Where t tan t = 1, t = 0.8603, the load's slope is K where it rests."""
    K = MOMENT * math.sin(0.860334)
    assert pytest.approx(0.0744, rel=1e-3) == K
    rest = brentq(lambda t: K * over * t - MOMENT * math.cos(t), 0.0, 1.5)
    off = abs(soft_link(K * over, rest + 0.01).q[:, 0] - rest)
    assert sign * (off[-1] - off[0]) > 0.2 * off[0]


def test_a_link_whose_weight_is_compensated_does_not_ring():
    assert "rings" not in {one.name for one in soft_link(0.05, gravity_compensated=True).findings}

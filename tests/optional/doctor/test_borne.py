"""Clamps, which lever arms make hold."""

import pytest

from tests.optional.doctor.words import TIP, block, free, of_shapes, scene

MU_V = 0.25
WEIGHT = 9.81
CLEARANCE = 1e-8
"""Of each side [m]: it counts as none."""
CLAMP = [(-0.03, 1.0), (0.03, 0.0)]
SLEEVE = [*CLAMP, (0.03, 1.0), (-0.03, 0.0)]


def scenario(reach, offset, balls=CLAMP, steps=3, mu_v=MU_V, cone="pyramid"):
    """Balls on both sides of a post, up to `offset` apart in height [m], a load `reach` out."""
    shapes = [(TIP, x, 0, z * offset, 0) for x, z in balls]
    shapes.append(('<box size="0.1 0.05 0.02"/>', reach, 0, 0, 0))
    clamp = free(of_shapes(shapes, 1, 0.01, (reach, 0, 0)), (0, 0, 0.4))
    post = {"post": {"box": {"size": [0.04 - 2 * CLEARANCE, 1, 2]}}}
    contacts = {f"on{i}": ("post", f"c/s{i}", mu_v, 1) for i in range(len(balls))}
    return scene({"c": clamp}, contacts, steps, shapes=post, cone=cone)


@pytest.mark.parametrize("cone", ["pyramid", "ellipsoid"])
@pytest.mark.parametrize("balls", [CLAMP, SLEEVE])
@pytest.mark.parametrize(("reach", "offset"), [(0.25, 0.1), (0.4, 0.15)])
def test_what_its_lever_arms_hold_has_no_finding(reach, offset, balls, cone):
    """It holds where 2 mu_v reach >= offset, a sleeve with clearance 0 as a clamp does."""
    run = scenario(reach, offset, balls, cone=cone).run(progress=False)
    assert [str(one) for one in run.findings] == []
    assert abs(run["q"][-1] - run["q"][0]).max() < 1e-6


@pytest.mark.parametrize(("reach", "offset"), [(0.1, 0.1), (0.3, 0.2)])
def test_a_clamp_that_falls_is_told_that_nothing_bears_it(reach, offset):
    run = scenario(reach, offset, steps=100).run(progress=False)
    (finding,) = run.findings
    assert finding.name == "free-fall"
    assert 0.09 < -run["q"][-1][2] + 0.4 < 0.099


def test_a_clamp_without_friction_falls_and_no_force_is_said_to_be_uncertain():
    run = scenario(0.1, 0.1, steps=20, mu_v=0.0).run(progress=False)
    assert [one.name for one in run.findings] == ["free-fall"]


def test_a_sleeve_whose_lever_arms_press_too_little_is_locked():
    """N = 9.81 N on both sides, so that friction could bear 4.9 N of 9.81 N."""
    guided, locked = scenario(0.1, 0.1, SLEEVE).run(progress=False).findings
    assert (guided.name, locked.name) == ("guided-friction", "locked-guide")
    assert locked.numbers["could_bear"] == pytest.approx(4.905, abs=2 * MU_V * WEIGHT * 0.2)
    assert "mu_v" not in guided.remedy + locked.remedy


def test_a_body_that_touches_what_cannot_bear_it_is_not_told_of_a_gap():
    """A box that touches a ceiling: its gap is rounding, and none."""
    box = free(block(1.0, (0.1, 0.1, 0.1)), (0, 0, 0.3))
    ceiling = {"ceiling": {"halfspace": {"normal": [0, 0, -1], "offset": -0.35}}}
    run = scene({"box": box}, {"on": ("ceiling", "box", 0.5, 4)}, 5, shapes=ceiling).run()
    (fall,) = [one for one in run.findings if one.name == "free-fall"]
    assert fall.remedy == "let what touches it at the start, on(ceiling, box/solid#0), bear it"

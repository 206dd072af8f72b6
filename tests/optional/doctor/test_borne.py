"""Clamps, which lever arms make hold."""

import pytest

import quasistatic_ref as qr


def clamp(reach, offset, mu_v=0.25, steps=3):
    """Two balls on opposite sides of a post, `offset` apart in height [m], a load `reach` out."""
    balls = "".join(
        f'<collision name="{name}"><origin xyz="{x} 0 {z}"/><geometry><sphere radius="0.01"/>'
        "</geometry></collision>"
        for name, x, z in (("upper", -0.03, offset), ("lower", 0.03, 0.0))
    )
    urdf = (
        f'<robot name="c"><link name="c"><inertial><origin xyz="{reach} 0 0"/><mass value="1"/>'
        '<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>'
        f'{balls}<collision name="load"><origin xyz="{reach} 0 0"/><geometry>'
        '<box size="0.1 0.05 0.02"/></geometry></collision></link></robot>'
    )
    on = {"alpha": "post", "mu_v": mu_v, "rows": 4}
    scene = {
        "h": 0.01,
        "steps": steps,
        "gravity": [0, 0, -9.81],
        "bodies": {"c": {"urdf": urdf, "base": "floating", "pose": {"xyz": [0, 0, 0.4]}}},
        "shapes": {"post": {"box": {"size": [0.04, 1, 2]}}},
        "contacts": {name: {**on, "beta": f"c/{name}"} for name in ("upper", "lower")},
    }
    return qr.load_scenario(scene).run(progress=False)


@pytest.mark.parametrize(("reach", "offset"), [(0.25, 0.1), (0.4, 0.15)])
def test_a_clamp_that_holds_has_no_finding(reach, offset):
    """It holds where 2 mu_v reach >= offset."""
    run = clamp(reach, offset)
    assert [str(one) for one in run.findings] == []
    assert abs(run["q"][-1] - run["q"][0]).max() < 1e-12

"""Models in which nothing can move, and bodies that no joint moves among others."""

import mujoco
import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref.errors import ModelError

BALL = '<geom size="0.1" mass="1"/>'
STILL = {
    "no joint": f"<body>{BALL}</body>",
    "a mocap body alone": f'<body mocap="true">{BALL}</body>',
    "geoms of the world": BALL,
    "a mocap body and one without a joint": f'<body mocap="true">{BALL}</body><body>{BALL}</body>',
}
WAYS = {
    "run": lambda model, data: qr.mujoco_scenario(model),
    "step": lambda model, data: qr.mujoco_step(model, data, 0.01),
    "opinion": qr.second_opinion,
}


@pytest.mark.parametrize("way", WAYS.values(), ids=WAYS)
@pytest.mark.parametrize("bodies", STILL.values(), ids=STILL)
def test_a_model_in_which_nothing_can_move_is_refused_in_a_sentence(bodies, way):
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{bodies}</worldbody></mujoco>")
    with pytest.raises(ModelError, match="model: has no joint that can move"):
        way(model, mujoco.MjData(model))


def test_a_mocap_body_is_none_that_moves():
    box = '<geom type="box" size="0.05 0.05 0.05"/>'
    free = f'<body name="box" pos="0 0 0.0499"><freejoint/>{box}</body>'
    table = (
        '<body name="table" mocap="true"><geom type="box" size="1 1 0.1" pos="0 0 -0.1"/></body>'
    )
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{table}{free}</worldbody></mujoco>")
    opinion = qr.second_opinion(model, mujoco.MjData(model))
    assert [body.name for body in opinion.bodies] == ["box"]
    weight = sum(contact.exact.normal for contact in opinion.contacts)
    assert weight == pytest.approx(9.81 * model.body_mass[model.body("box").id])


def test_a_sleeping_body_is_looked_at_as_if_awake():
    text = """<mujoco><option><flag sleep="enable"/></option><worldbody>
    <geom type="plane" size="1 1 1"/><body name="box" pos="0 0 0.05"><freejoint/>
    <geom type="box" size="0.05 0.05 0.05"/></body></worldbody></mujoco>"""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    for _ in range(3000):
        mujoco.mj_step(model, data)
    assert data.ntree_awake == 0
    assert len(qr.second_opinion(model, data).contacts) == 4
    assert np.isfinite(data.qpos).all()

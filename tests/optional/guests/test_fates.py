"""Each thing that a MuJoCo model or state can say has its fate in the table, and that fate."""

import mujoco
import numpy as np
import pytest

from quasistatic_ref.errors import InputError, ModelError
from quasistatic_ref.optional.guests import fates
from quasistatic_ref.optional.guests.mujoco import mujoco_step

SCENE = """<mujoco><option density="2" viscosity=".1" wind="3 1 0"/>
<worldbody><geom name="floor" type="plane" size="2 2 1" margin=".004" gap=".01"/>
<body name="box" pos="0 0 .047"><freejoint/><geom name="box" type="box" size=".05 .06 .05"
 pos="0 0 .001" friction=".4 .01 .001" condim="6" fluidshape="ellipsoid"/></body>
<body name="arm" pos="1 0 .5" euler="10 0 0">
<joint name="slide" type="slide" axis="1 0 0" stiffness="40" springref=".1" range="-1 1"
 damping="1" frictionloss=".2"/>
<geom name="rod" type="capsule" fromto="0 0 0 .3 0 0" size=".02" contype="0"/>
<body pos=".3 0 0" gravcomp=".3"><joint name="hinge" axis="0 1 0" range="-1 1" pos=".01 0 0"/>
<joint name="yaw" axis="0 0 1" armature=".1"/><geom name="tip" size=".05" pos=".1 0 0"/></body>
</body></worldbody>
<tendon><fixed name="cord" range="-1 1" stiffness="3" springlength=".1">
<joint joint="hinge" coef="1"/></fixed>
<fixed name="loose" armature=".1"><joint joint="yaw" coef="1"/></fixed></tendon>
<actuator><position name="servo" joint="slide" kp="90" ctrlrange="-1 1" forcerange="-99 99"/>
<motor name="pull" tendon="cord"/></actuator></mujoco>"""


def scene(text: str = SCENE):
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.ctrl[:] = 0.3
    return model, data


def answer(model, data):
    return mujoco_step(model, data, 0.01, "as is")


def known() -> set[str]:
    """All fields of a model and its options that are no numbers of elements or addresses."""
    model, _ = scene()
    found = set()
    for prefix, home in (("", model), ("opt.", model.opt)):
        for name in dir(home):
            value = getattr(home, name)
            values = isinstance(value, np.ndarray) and value.dtype.kind == "f"
            if not name.startswith("_") and not callable(value) and (values or prefix):
                found.add(prefix + name)
    seen = tuple(f"{family}_" for family in (*fates.SEEN.split(), "flex", "flexedge"))
    return {name for name in found if not name.startswith(seen)}


def test_each_field_of_mujocos_model_has_one_fate() -> None:
    listed = [*fates.USED.split(), *fates.WITHOUT_EFFECT.split(), *fates.REFUSED]
    assert len(listed) == len(set(listed))
    assert known() <= set(listed)
    model, _ = scene()
    names = set(dir(model)) | {f"opt.{name}" for name in dir(model.opt)}
    assert set(listed) <= names


def test_each_kind_and_each_part_of_the_state_has_one_fate() -> None:
    for enumeration, *kinds in fates.KINDS.values():
        members = {name.split("_", 1)[1] for name in getattr(mujoco, enumeration).__members__}
        listed = [kind for words in kinds for kind in words.split()]
        assert sorted(listed) == sorted(members)
    parts = [part for words in fates.STATE for part in words.split()]
    unions = {"PHYSICS", "FULLPHYSICS", "USER", "INTEGRATION"}
    members = {name.split("_", 1)[1] for name in mujoco.mjtState.__members__ if "_" in name}
    assert sorted(parts) == sorted(members - unions)


PRESENT = """
body_gravcomp body_inertia body_ipos body_mass body_pos body_subtreemass jnt_axis jnt_pos jnt_range
jnt_stiffness qpos_spring dof_armature dof_frictionloss
geom_friction geom_margin geom_pos geom_size geom_fluid
tendon_stiffness tendon_lengthspring tendon_range tendon_armature
actuator_biasprm actuator_gainprm actuator_gear opt.gravity opt.wind opt.density opt.viscosity
"""
"""Fields of numbers that are used, and of elements that this scene has; test_rest has others."""
WITHOUT = [name for name in fates.WITHOUT_EFFECT.split() if name not in ("stat", "vis")]


def changed(name: str):
    model, data = scene()
    home = model.opt if name.startswith("opt.") else model
    name = name.removeprefix("opt.")
    value = getattr(home, name)
    if isinstance(value, np.ndarray):
        if value.dtype.kind == "f":
            value[:] = value * 1.1 + (0.01 if name in ("qpos_spring", "opt.wind") else 0.0)
    elif isinstance(value, float):
        setattr(home, name, value * 1.1)
    return model, data


@pytest.mark.parametrize("name", PRESENT.split())
def test_a_field_that_is_used_changes_the_step(name: str) -> None:
    assert name in fates.USED.split()
    assert answer(*changed(name)) != answer(*scene())


@pytest.mark.parametrize("name", WITHOUT)
def test_a_field_without_effect_changes_no_bit(name: str) -> None:
    assert answer(*changed(name)) == answer(*scene())


@pytest.mark.parametrize("name", fates.REFUSED)
def test_a_field_that_must_be_zero_is_refused_by_name(name: str) -> None:
    model, data = scene()
    getattr(model, name)[:] = 1.0
    with pytest.raises(ModelError, match=name.partition("_")[2]):
        answer(model, data)


@pytest.mark.parametrize(
    ("field", "kind"),
    [(field, kind) for field, words in fates.KINDS.items() for kind in words[3].split()],
)
def test_a_kind_that_no_step_has_is_refused_by_name(field: str, kind: str) -> None:
    text = '<equality><joint joint1="hinge"/></equality></mujoco>'
    model, data = scene(SCENE.replace("</mujoco>", text))
    members = getattr(mujoco, fates.KINDS[field][0]).__members__
    (number,) = (int(m) for name, m in members.items() if name.split("_", 1)[1] == kind)
    getattr(model, field)[0] = number
    with pytest.raises(ModelError, match=field.partition("_")[2]):
        answer(model, data)


def test_what_is_left_out_is_said() -> None:
    model, data = scene()
    data.qvel[0] = 0.5
    _, coordinates = answer(model, data)
    assert any("rolling friction" in sentence for sentence in coordinates.left_out)
    assert any("penetrate by" in sentence for sentence in coordinates.left_out)
    assert any("joint[slide].stiffness" in sentence for sentence in coordinates.left_out)
    # v / (mu g h); the larger friction of the two geoms holds
    assert coordinates.quasi_dynamic_number == pytest.approx(0.5 / (1.0 * 9.81 * 0.01))
    assert coordinates.names[0] == "joint[slide]"
    assert coordinates.names[-1] == "friction of joint[slide]"


def test_what_no_step_can_say_is_refused_by_name() -> None:
    two = '<equality><connect body1="arm" anchor="0 0 0"/></equality></mujoco>'
    with pytest.raises(ModelError, match=r"equality\[0\]: its rows .* have rank"):
        mujoco_step(*scene(SCENE.replace("</mujoco>", two)), 0.01)
    pair = '<contact><pair geom1="floor" geom2="box" friction=".4 .5 .1 .1 .1"/></contact></mujoco>'
    with pytest.raises(ModelError, match="differs in its two directions"):
        mujoco_step(*scene(SCENE.replace("</mujoco>", pair)), 0.01)
    several = SCENE.replace('joint="slide" kp', 'tendon="two" kp').replace(
        "</tendon>",
        '<fixed name="two"><joint joint="slide" coef="1"/><joint joint="hinge" coef="1"/></fixed>'
        "</tendon>",
    )
    several = several.replace('stiffness="40"', "").replace('stiffness="3"', "")
    with pytest.raises(ModelError, match=r"actuator\[servo\].biasprm: acts on several joints"):
        mujoco_step(*scene(several), 0.01)
    with pytest.raises(InputError, match="depth"):
        mujoco_step(*scene(), 0.01, depth="deep")

"""Each thing that a MuJoCo model or state can say has its fate in the table, and that fate."""

import copy
from fnmatch import fnmatchcase
from functools import cache

import mujoco
import numpy as np
import pytest

from quasistatic_ref import ModelError, mujoco_step
from quasistatic_ref.optional.mujoco import fates

SCENE = """<mujoco>
<size memory="1M" nuser_body="1" nuser_jnt="1" nuser_geom="1" nuser_site="1" nuser_tendon="1"
 nuser_actuator="1"/>
<option density="2" viscosity=".1" wind="3 1 0" actuatorgroupdisable="1"/>
<asset><hfield name="hills" nrow="3" ncol="3" size="1 1 .1 .1" elevation="0 0 0 0 1 0 0 0 0"/>
<mesh name="wedge" vertex="0 0 0 .1 0 0 0 .1 0 0 0 .1" texcoord="0 0 1 0 0 1 1 1"/></asset>
<worldbody><geom name="floor" type="plane" size="2 2 1" margin=".004" gap=".01" adhesion=".1"/>
<geom name="hills" type="hfield" hfield="hills" pos="5 0 0"/>
<site name="anchor" pos="1 .3 .5"/><site name="slider" pos="3 0 .3" zaxis="1 0 0"/>
<body name="box" pos="0 0 .047"><freejoint/><geom name="box" type="box" size=".05 .06 .05"
 pos="0 0 .001" euler="1 0 0" friction=".4 .01 .001" condim="6" fluidshape="ellipsoid"/>
<geom size=".01" pos=".03 .02 0" contype="0"/>
<site name="thrust" pos=".1 0 0"/></body>
<body pos="5 .1 .1"><freejoint/><geom name="marble" size=".04" condim="4"/></body>
<body pos="-1 0 -.001"><freejoint/><geom name="wedge" type="mesh" mesh="wedge"/></body>
<body pos="1 1 .049"><freejoint/><geom name="puck" size=".05" contype="0" conaffinity="0"/></body>
<body pos="-1 -1 .06"><freejoint/><geom name="high" size=".05"/></body>
<body pos="1 -1 .059"><freejoint/><geom name="higher" size=".05" contype="0" conaffinity="0"/>
</body>
<body name="held" pos="-1 1 .5"><freejoint/><geom size=".05" euler="10 0 0"/></body>
<body name="still" mocap="true" pos="-1 1 .7"/>
<body pos="2 0 .5"><joint name="socket" type="ball" stiffness="3" range="0 1"/>
<geom size=".05" pos=".1 0 0"/></body>
<body pos="3 0 .5"><joint name="crank" axis="0 1 0" armature=".1"/><geom size=".05" pos=".1 0 0"/>
<site name="pin" pos=".1 0 0"/></body>
<body pos="4 0 .5" gravcomp=".3"><joint name="wheel" axis="0 1 0" actuatorgravcomp="true"
 actuatorfrcrange="-.1 .1"/><geom size=".05" pos=".1 0 0"/>
<body><joint name="spin" axis="0 0 1"/><geom size=".05" pos=".2 0 0"/></body></body>
<body name="arm" pos="1 0 .5" euler="10 0 0">
<joint name="slide" type="slide" axis="1 0 0" stiffness="40" springref=".1" range="-1 1"
 margin=".1" damping="1" frictionloss=".2"/>
<geom name="rod" type="capsule" fromto="0 0 0 .3 0 0" size=".02" contype="0"/>
<body pos=".3 0 0"><joint name="hinge" axis="0 1 0" range="-1 1" pos=".01 0 0"/>
<joint name="yaw" axis="0 0 1"/>
<geom name="tip" size=".05" pos=".1 0 0"/><site name="tip" pos=".1 0 .02"/></body>
</body></worldbody>
<contact>
<pair geom1="floor" geom2="puck" friction=".4 .4 .01 .01 .01" margin=".01" adhesion=".2"
 condim="4"/><pair geom1="floor" geom2="higher" gap=".01"/></contact>
<tendon><fixed name="cord" range="-1 1" stiffness="3" springlength=".1" margin=".1"
 actuatorfrcrange="-.25 .25" frictionloss=".1"><joint joint="hinge" coef="1"/></fixed>
<fixed name="loose" armature=".1"><joint joint="wheel" coef="1"/></fixed>
<spatial name="rope" range="0 2" stiffness="1"><site site="anchor"/><site site="tip"/></spatial>
</tendon>
<equality><weld body1="held" body2="still"/><joint joint1="crank" polycoef=".1 0 0 0 0"/>
<tendon tendon1="loose"/></equality>
<actuator><position name="servo" joint="slide" kp="90" forcerange="-9 9"/>
<motor name="pull" tendon="cord"/><motor name="more" tendon="cord"/>
<motor name="thrust" site="thrust" gear="1 0 0 0 0 0" ctrlrange="-.2 .2"/>
<motor name="parent" jointinparent="hinge"/><motor name="wheel" joint="wheel" armature=".2"/>
<motor name="crank" cranksite="pin" slidersite="slider" cranklength=".3"/>
<adhesion name="stick" body="box" ctrlrange="0 1" gain="5"/>
<general name="creep" joint="yaw" dyntype="integrator" biastype="affine" gainprm="5"
 biasprm="0 -5 0" actlimited="true" actrange="-.1 .1" actearly="true"/>
<general name="early" joint="hinge" dyntype="filter" dynprm=".1" actearly="true"/>
<motor name="late" joint="yaw" delay=".01" nsample="8"/>
<muscle name="muscle" joint="yaw" lengthrange="-1 2" range=".75 1.05"/></actuator></mujoco>"""
"""At least one of each element that a step uses, in a state in which it matters."""
UNTRIED = ("opt.sdf_initpoints", "opt.sdf_iterations")
"""Of contacts of geoms whose shape is a plugin."""
EACH = [name for name in fates.USED.split() if name not in UNTRIED]
WITHOUT = [name for name in fates.WITHOUT_EFFECT.split() if name not in ("stat", "vis")]
TURN = np.array([0.9, 0.3, 0.3, 0.1])
OTHERS = {
    "geom_condim": lambda value: 3,
    "pair_dim": lambda value: 3,
    "geom_gap": lambda value: 0.0,
    "pair_gap": lambda value: 0.0,
    "geom_rbound": lambda value: value * 1.1,
    "tendon_frictionloss": lambda value: value * 1.1,
    "opt.ccd_iterations": lambda value: 1,
    "geom_priority": lambda value: np.arange(len(value)),
    "opt.solver": lambda value: 0,
    "actuator_history": lambda value: value + np.array([0, 1]),
} | dict.fromkeys(("body_quat", "body_iquat", "geom_quat", "site_quat"), lambda value: TURN)
"""Other values of fields, where those of ``another`` change nothing, or none that is allowed."""


def another(value):
    """Another value of the same kind."""
    if not isinstance(value, np.ndarray):
        return value * 1.1 + 0.01 if isinstance(value, float) else value ^ 1
    if value.dtype.kind == "f":
        return value * 1.1 + 0.01
    return 1 - value if value.max(initial=0) <= 1 else value + 1


@cache
def model_of(text):
    return mujoco.MjModel.from_xml_string(text)


def scene(text=SCENE):
    model = copy.copy(model_of(text))
    data = mujoco.MjData(model)
    data.ctrl[:] = 0.3
    data.act[:] = 0.2
    data.history[-8:] = np.arange(8)
    data.xfrc_applied[:] = data.qfrc_applied[0] = 0.1
    data.time = 0.003
    return model, data


def answer(model, data):
    return mujoco_step(model, data, 0.01, "as is")


@cache
def unchanged_answer(overrides):
    model, data = scene()
    model.opt.enableflags |= overrides * mujoco.mjtEnableBit.mjENBL_OVERRIDE
    return answer(model, data)


def step_changes(name):
    """Whether another value of a field makes another step."""
    model, data = scene()
    overrides = name.startswith("opt.o_")
    model.opt.enableflags |= overrides * mujoco.mjtEnableBit.mjENBL_OVERRIDE
    home = model.opt if name.startswith("opt.") else model
    name_there = name.removeprefix("opt.")
    value = np.copy(getattr(home, name_there))
    if np.ndim(getattr(home, name_there)):
        getattr(home, name_there)[:] = OTHERS.get(name, another)(value)
    else:
        setattr(home, name_there, OTHERS.get(name, another)(getattr(home, name_there)))
    assert np.any(value != getattr(home, name_there))
    return bool(answer(model, data) != unchanged_answer(overrides))


def test_each_field_of_mujocos_model_has_one_fate():
    listed = [*fates.USED.split(), *fates.WITHOUT_EFFECT.split(), *fates.REFUSED, *fates.PLUGINS,
              *fates.KINDS]  # fmt: skip
    assert len(listed) == len(set(listed))
    model, _ = scene()
    seen = tuple(f"{family}_" for family in (*fates.SEEN.split(), "flex", "flexedge"))
    known = set()
    for prefix, home in (("", model), ("opt.", model.opt)):
        for name in dir(home):
            value = getattr(home, name)
            if name.startswith(("_", *seen)) or callable(value):
                continue
            real = isinstance(value, np.ndarray) and value.dtype.kind == "f"
            if prefix or real or not any(fnmatchcase(name, p) for p in fates.PLACES.split()):
                known.add(prefix + name)
    assert known <= set(listed)
    assert set(listed) <= set(dir(model)) | {f"opt.{name}" for name in dir(model.opt)}


def test_each_kind_and_each_part_of_the_state_has_one_fate():
    for enumeration, *kinds in fates.KINDS.values():
        members = {name.split("_", 1)[1] for name in getattr(mujoco, enumeration).__members__}
        listed = [kind for words in kinds for kind in words.split()]
        assert sorted(listed) == sorted(members)
    parts = [part for words in fates.STATE for part in words.split()]
    unions = {"PHYSICS", "FULLPHYSICS", "USER", "INTEGRATION"}
    members = {name.split("_", 1)[1] for name in mujoco.mjtState.__members__ if "_" in name}
    assert sorted(parts) == sorted(members - unions)


@pytest.mark.parametrize("name", EACH)
def test_a_field_that_is_used_changes_the_step(name):
    assert step_changes(name)


@pytest.mark.parametrize("name", WITHOUT)
def test_a_field_without_effect_changes_no_bit(name):
    assert not step_changes(name)


@pytest.mark.parametrize("part", " ".join(fates.STATE[:3]).split())
def test_a_part_of_the_state_changes_the_step_if_it_is_used(part):
    model, data = scene()
    spec = int(getattr(mujoco.mjtState, f"mjSTATE_{part}"))
    state = np.zeros(mujoco.mj_stateSize(model, spec))
    mujoco.mj_getState(model, data, state, spec)
    assert len(state) or part == "USERDATA"
    mujoco.mj_setState(model, data, 1 - state if part == "EQ_ACTIVE" else state + 0.01, spec)
    step, coordinates = answer(model, data)
    assert (step != unchanged_answer(False)[0]) is (part in fates.STATE[0])
    assert any(note.startswith("velocity: dropped") for note in coordinates.left_out) is (
        part == "QVEL"
    )


@pytest.mark.parametrize("name", [*fates.REFUSED, *fates.PLUGINS])
def test_a_field_that_must_be_zero_is_refused_by_name(name):
    model, data = scene()
    getattr(model, name)[:] = 1.0
    with pytest.raises(ModelError, match=name.partition("_")[2]):
        answer(model, data)


@pytest.mark.parametrize(
    ("field", "kind"),
    [(field, kind) for field, words in fates.KINDS.items() for kind in words[3].split()],
)
def test_a_kind_that_no_step_has_is_refused_by_name(field, kind):
    model, data = scene()
    members = getattr(mujoco, fates.KINDS[field][0]).__members__
    (number,) = (int(m) for name, m in members.items() if name.split("_", 1)[1] == kind)
    getattr(model, field)[0] = number
    with pytest.raises(ModelError, match=field.partition("_")[2]):
        answer(model, data)


def test_notes_name_each_force_that_is_left_out():
    model, data = scene()
    data.qvel[0] = 0.5
    _, coordinates = answer(model, data)
    notes = " ".join(coordinates.left_out)
    assert "contact[0: floor/box]: rolling friction" in notes
    assert "contact[0: floor/box]: its bodies penetrate by" in notes
    assert "joint[slide].stiffness: its coordinates are actuated" in notes
    assert "actuator[muscle]: its force stays as it is" in notes
    assert "actuator[creep]: its activation still changes" in notes
    assert "velocity: dropped; its largest component is 0.5" in notes
    # v / (mu g h); the larger friction of the two geoms holds
    assert coordinates.quasi_dynamic_number == pytest.approx(0.5 / (1.0 * 9.81 * 0.01))
    assert coordinates.names[3] == "joint[slide]"
    assert coordinates.names[-1] == "friction of tendon[cord]"


def of_scene(**changes):
    """The scene, with elements before the end of others."""
    text = SCENE
    for element, more in changes.items():
        text = text.replace(f"</{element}>", f"{more}</{element}>")
    return text


TWO = '<fixed name="two"><joint joint="crank" coef="1"/><joint joint="spin" coef="1"/></fixed>'
CLOTH = '<flexcomp type="grid" count="3 3 1" spacing=".1 .1 .1" name="cloth" pos="0 0 9"/>'


@pytest.mark.parametrize(
    ("text", "match"),
    [
        (of_scene(contact='<pair geom1="floor" geom2="box" friction=".4 .5 .1 .1 .1"/>'),
         r"contact\[.*/box\]\.friction: .*differs in its two directions"),
        (of_scene(tendon=TWO, actuator='<position name="both" tendon="two"/>'),
         r"actuator\[both\]\.biasprm: acts on several joints"),
        (of_scene(tendon=TWO.replace('"two"', '"two" frictionloss="1"')),
         r"tendon\[two\]\.frictionloss: rubs along several joints"),
        (of_scene(actuator='<general name="a" joint="crank" gaintype="affine" gainprm="1 1"/>'),
         r"actuator\[a\]\.gainprm: makes the gain depend"),
        (of_scene(actuator='<position name="up" joint="crank" kp="-9"/>'),
         r"actuator\[up\]\.biasprm: pushes away from its target"),
        (of_scene(worldbody=CLOTH), r"flex\[cloth\]: is not supported"),
        (SCENE.replace("1M", "50K"), "size.memory: does not hold all"),
        (SCENE.replace("1M", "20K"), "size.memory: .*out of memory"),
    ],
)  # fmt: skip
def test_an_element_that_no_step_has_is_refused_by_name(text, match):
    with pytest.raises(ModelError, match=match):
        answer(*scene(text))

"""A MuJoCo scene that runs."""

import json
import pickle

import mujoco
import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import (
    InputError,
    ModelError,
    QuasistaticError,
    System,
    load_trajectory,
    mujoco_scenario,
    mujoco_step,
)
from quasistatic_ref.optional.mujoco.drive import table_read
from tests.closeness import assert_close
from tests.optional.mujoco.models import model_of, posed
from tests.threads import words_of_two_threads

G, KP, RANGE, RUB, MASS = 9.81, 2000.0, 6.0, 0.1, 0.1
HAND = 0.3
"""Mass of the hand with its fingers [kg]."""
SCENE = f"""<mujoco><size memory="1M"/><default><default class="pad">
<geom type="box" size=".005 .01 .02" mass=".05" condim="4" friction=".8 .01" conaffinity="0"/>
</default></default><worldbody>
<geom name="floor" type="plane" size="1 1 .1" conaffinity="0"/>
<body name="hand" pos="0 0 .1"><joint name="lift" type="slide" axis="0 0 1" range="-.2 .3"/>
<geom size=".01" pos="0 0 .1" mass=".2" contype="0" conaffinity="0"/>
<body name="left" pos="-.05 0 0"><joint name="l" type="slide" axis="1 0 0" frictionloss="{RUB}"/>
<geom name="left" class="pad"/></body>
<body name="right" pos=".05 0 0"><joint name="r" type="slide" axis="-1 0 0"/>
<geom name="right" class="pad"/></body>
</body>
<body name="ball" pos="0 0 .1"><freejoint/>
<geom name="ball" size=".03" mass="{MASS}" contype="0"/></body>
<geom name="post" size=".07" conaffinity="0"/>
</worldbody>
<equality><joint joint1="r" joint2="l"/></equality>
<actuator><position name="up" joint="lift" kp="{KP}"/>
<position name="grip" joint="l" kp="400" forcerange="-{RANGE} {RANGE}"/></actuator>
<keyframe><key name="open" qpos="0 0 0 0 0 .1 1 0 0 0"/>
<key name="closed" qpos="0 0 0 0 0 .1 1 0 0 0" ctrl="0 .04"/>
<key name="raised" qpos="0 0 0 0 0 .1 1 0 0 0" ctrl=".05 .04"/></keyframe></mujoco>"""


def grasp(t):
    """Close for 0.06 s, lift for 0.1 s by 1 mm a step, and wait."""
    return {"grip": min(t, 0.06) / 0.06 * 0.04, "up": float(np.clip(t - 0.06, 0, 0.1) * 0.1)}


@pytest.fixture(scope="module")
def lifted():
    """The scene, and a run of it."""
    scene = mujoco_scenario(model_of(SCENE), targets=grasp, steps=24)
    return scene, scene.run()


def test_a_gripper_lifts_what_it_holds(lifted):
    """At the end its servo carries (hand + ball) g, and gives way by that over kp.

    Before it had let go of the post, that was hand g: the ball rises by 0.01 less the difference.
    """
    scene, run = lifted
    assert set(run.certificate.tolist()) == {"exact"}
    rise = scene.system.of(run.q[-1], "ball.z") - 0.1
    assert rise == pytest.approx(0.01 - MASS * G / KP, abs=2e-6)
    # Both fingers move by one coordinate: its force is that of both, but for joint friction.
    normal = run.pair_forces()["ball-hand(ball, left)"][-1, 0]
    assert abs(2 * abs(normal) - RANGE) <= RUB * (1 + 1e-6)


def test_the_step_is_that_of_the_state():
    """`mujoco_step` of the same state, whose gaps it takes as they are, has the same numbers."""
    text = SCENE.replace('<equality><joint joint1="r" joint2="l"/></equality>', "").replace(
        "</actuator>", '<position joint="r" kp="300"/></actuator>'
    )
    state = posed(text, ctrl=[0.01, 0.013, 0.02])
    state[1].qpos[1:3] = 0.0175
    scene = mujoco_scenario(*state)
    step = scene.simulator().step(scene.system.q_start, scene.target(0.01, scene.system.q_start))
    expected, _ = mujoco_step(*state, scene.h, depth="as is")
    for name in ("K_q", "M_u", "tau_a", "tau_u", "delta_q_bar_a"):
        assert_close(getattr(step.step, name), getattr(expected, name))
    mine, theirs = step.step.contacts, expected.contacts
    near = np.flatnonzero(mine.phi < 0)
    assert len(near) == len(theirs.phi) == 2
    near = near[np.lexsort(mine.n[near].round(3).T)]
    order = np.lexsort(theirs.n.round(3).T)
    for name in ("phi", "J", "rows"):
        assert_close(getattr(mine, name)[near], getattr(theirs, name)[order])


class Listening:
    """A system that notes which of its names are asked for."""

    def __init__(self, system):
        self.system = system
        self.names = set()

    def __getattr__(self, name):
        self.names.add(name)
        return getattr(self.system, name)


def test_a_step_asks_a_system_for_seven_names_and_no_others(lifted):
    scene, run = lifted
    simulator = scene.simulator()
    listening = Listening(scene.drive.system)
    vars(simulator)["system"] = listening
    simulator.step(run.q[0], run.q_bar_a[0])
    assert listening.names == {"n_a", "n_v", "links", "column_map", "mass_entries", "lock", "at"}
    assert not isinstance(scene.drive.system, System)


def test_a_copy_of_a_scene_in_another_process_takes_the_same_step(lifted):
    scene, run = lifted
    simulator = pickle.loads(pickle.dumps(scene.simulator()))
    assert simulator.step(run.q[0], run.q_bar_a[0]).q.tolist() == run.q[1].tolist()


def test_derivatives_of_a_scene_that_mujoco_moves_are_refused(lifted):
    scene, run = lifted
    with pytest.raises(InputError, match="system: has no derivatives where MuJoCo moves it"):
        qr.derivatives(scene.simulator(), run.q[0], run.q_bar_a[0])


BALL = '<body name="b"><joint name="j" type="hinge"/><geom size=".1"/>{}</body>'


@pytest.mark.parametrize(
    ("body", "rest", "field"),
    [
        ('<joint name="k"/>', '<equality><joint joint1="j" joint2="k" polycoef="0 0 1 0 0"/>'
         "</equality>", "polycoef"),
        ('<site name="s" pos=".1 0 0"/>', '<actuator><general biastype="affine" site="s" '
         'refsite="f" gear="1 0 0 0 0 0" biasprm="0 -1 0"/></actuator>', "biasprm"),
        ("", '<actuator><adhesion body="b" ctrlrange="0 1"/></actuator>', "actuator[0].body"),
        ("", '<tendon><fixed stiffness="1" springlength="0 1"><joint joint="j" coef="1"/></fixed>'
         "</tendon>", "springlength"),
    ],
)  # fmt: skip
def test_an_element_that_no_run_has_is_refused_before_the_first_step(body, rest, field):
    """By element and field."""
    text = BALL.format(body).replace("<geom", '<geom name="g"', 1)
    world = f'<worldbody><geom name="f" size=".1"/><site name="f"/>{text}</worldbody>'
    with pytest.raises(QuasistaticError) as refused:
        mujoco_scenario(model_of(f"<mujoco>{world}{rest}</mujoco>"))
    assert field in str(refused.value)


@pytest.mark.parametrize(
    ("table", "says"),
    [
        ("time,up\n0,1\n", "begin with a row"),
        *((f"t,up\n{rows}\n", "rows of 2 numbers") for rows in ("", "# none", "0,1,2")),
        ("t,up\n0,1\n0,2\n", "increase"),
        ("t,lift\n0,1\n", "no actuator"),
        ("t up\n0 1\n", "begin with a row of names, .* with commas"),
        ("t,up,up\n0,1,2\n", "targets: names a column twice; .* .got 'up'"),
        ('t;"up";up\n0;1;2\n', "targets: names a column twice; .* .got 'up'"),
        ("t,up,t\n0,1,0\n", "targets: names a column twice; .* .got 't'"),
        ("t;up\n0;0\n0,5;1\n", "targets, line 3: has a decimal comma; .* .got '0,5'"),
        ("t,up\n0;0\n1;1\n", "targets, line 2: must be separated by commas"),
        ('"t","up"\n"0","0,1"\n', "targets, line 2: has a decimal comma; .* .got '0,1'"),
        ("t,up\n0,0\n0,1,0,1\n", "rows of 2 numbers"),
    ],
)
def test_a_table_that_is_none_is_refused(table, says, tmp_path):
    """With the file's name."""
    path = tmp_path / "targets.csv"
    path.write_text(table)
    with pytest.raises(InputError, match=says):
        mujoco_scenario(model_of(SCENE), targets=path)


@pytest.mark.parametrize(
    "table",
    [
        't,"up"\n0,0\n"0.5","1"\n',
        "t;up\n0;0\n0.5;1\n",
        '"t" ; "up"\r\n0 ; 0 # rest\r\n0.5 ; 1\r\n',
    ],
)
def test_a_table_may_have_quotes_and_semicolons(table, tmp_path):
    """As spreadsheets write them."""
    path = tmp_path / "targets.csv"
    path.write_bytes(table.encode())
    names, times, values = table_read(path)
    assert names == ["up"]
    assert times.tolist() == [0.0, 0.5]
    assert values.tolist() == [[0.0], [1.0]]


@pytest.mark.parametrize(
    ("spoilt", "number", "field"),
    [
        ("opt.timestep", 0.0, "option.timestep"),
        ("opt.gravity", np.nan, "option.gravity"),
        ("jnt_stiffness", np.nan, "model.jnt_stiffness"),
        ("geom_size", np.inf, "model.geom_size"),
    ],
)
@pytest.mark.parametrize("asked", ["scene", "opinion"])
def test_numbers_that_no_step_can_take_are_refused_by_name(spoilt, number, field, asked):
    bad = model_of(SCENE)
    owner, _, name = spoilt.rpartition(".")
    owner = bad.opt if owner else bad
    if isinstance(getattr(owner, name), np.ndarray):
        getattr(owner, name).flat[0] = number
    else:
        setattr(owner, name, number)
    ask = mujoco_scenario if asked == "scene" else qr.mujoco_opinion
    with pytest.raises(ModelError, match=f"^{field}: must "):
        ask(bad, mujoco.MjData(bad))


def test_joints_without_servos_have_springs_and_fields_their_names():
    """A joint gives way by load / k; one with a servo takes no spring."""
    text = SCENE[: SCENE.index("<equality>")] + "</mujoco>"
    stiff = {"stiffness.lift": 1000.0, "stiffness.l": 1e6, "stiffness.r": 1e6}
    scene = mujoco_scenario(
        model_of(text), settings=stiff, targets=lambda t: {"lift": 0.01}, steps=1
    )
    run = scene.run()
    assert scene.system.of(run.q[-1], "hand/lift") == pytest.approx(0.01 - HAND * G / 1000)
    with pytest.raises(InputError, match="has a servo"):
        mujoco_scenario(model_of(SCENE), settings={"stiffness.lift": 1.0})
    with pytest.raises(InputError, match=r"targets: must be a file, names of keyframes or a"):
        mujoco_scenario(model_of(SCENE), targets=())
    with pytest.raises(InputError, match=r"gravity.*not for a MuJoCo scene"):
        mujoco_scenario(model_of(SCENE), gravity=[0, 0, -1])


@pytest.mark.usefixtures("compiled_here")
@pytest.mark.parametrize(
    ("setting", "problem"),
    [
        ("contacts.a.mu_v=3", "is not for a MuJoCo scene"),
        ("contacts.a.mu_v", "must be table.field=value"),
        ("solver.frob=1", "is unknown"),
        ("limits.reach=-1", "must "),
    ],
)
def test_a_setting_that_a_scene_has_not_is_blamed_itself(setting, problem, tmp_path, cli):
    """And not the file, in which it does not stand."""
    path = tmp_path / "scene.xml"
    path.write_text(SCENE)
    said = cli("run", path, "--set", setting, "--out", tmp_path, status=2).err
    assert said.startswith(f"quasistatic-ref: --set {setting}: {problem}")


@pytest.mark.extra("view")
def test_the_command_runs_a_scene(tmp_path, cli):
    """With keyframes, a table and a page."""
    path = tmp_path / "scene.xml"
    path.write_text(SCENE)
    asked = "--targets open,closed,raised --view --set steps=4 --out"
    assert "4 of 4 steps exact" in cli("run", path, asked, tmp_path).out
    assert (tmp_path / "scene.html").stat().st_size > 1000
    run = load_trajectory(tmp_path / "scene.npz")
    # Halfway the controls are those of "closed".
    assert run.q_bar_a[1, 0] == pytest.approx(0.0, abs=1e-12)
    assert run.q_bar_a[3, 0] == pytest.approx(0.05, abs=1e-12)
    cli("run bunny_grasp --targets x.csv", status=2)


@pytest.mark.long
def test_commands_begin_in_a_keyframe_and_go_where_targets_say(tmp_path, cli):
    """Open, the fingers hold nothing; with the controls of "closed" they hold the ball."""
    path = tmp_path / "scene.xml"
    high = SCENE.replace('name="raised" qpos="0 ', 'name="raised" qpos=".02 ')
    path.write_text(high.replace('<geom name="post" size=".07" conaffinity="0"/>', ""))
    cli("run", path, "--keyframe raised --quiet --set steps=1 --out", tmp_path)
    assert load_trajectory(tmp_path / "scene.npz").q[0, 0] == 0.02
    assert "did you mean" in cli("run", path, "--keyframe raise", status=2).err
    asked = "stands", path, "--fast --quiet --json --set steps=60 --every 60"
    for more, holds in (
        ("--keyframe open", False),
        ("--keyframe closed", True),
        ("--targets open,closed", True),
    ):
        (ball,) = json.loads(cli(*asked, more).out)["bodies"]
        assert (ball["body"], ball["stands"]) == ("ball", holds), more


def test_a_load_on_welded_bodies_acts_at_their_common_centre():
    """Two equal balls on a stick along x: from the first to the middle it is half the way L."""
    L = 0.2
    scene = mujoco_scenario(
        model_of(f"""<mujoco><worldbody>
        <geom type="plane" size="1 1 .1"/><body name="post"><geom size=".01"/></body>
        <body name="stick" pos="0 0 1"><freejoint/><geom size=".01" mass="1"/>
        <body name="end" pos="{L} 0 0"><geom size=".01" mass="1"/></body></body>
        </worldbody></mujoco>""")
    )
    system = scene.system
    of_both = system.load(system.q_start, "stick", force=(0, 0, 1))
    of_end = system.load(system.q_start, "stick/end", force=(0, 0, 1))
    assert_close(of_both, [0, 0, 1, 0, -L / 2, 0])
    assert_close(of_end, [0, 0, 1, 0, -L, 0])
    with pytest.raises(ModelError, match="name: has a fixed base"):
        system.load(system.q_start, "post", force=(0, 0, 1))


SUCTION = """<mujoco><worldbody><body name="hand" pos="0 0 0.5"><joint name="z" type="slide"
 axis="0 0 1"/><geom type="sphere" size="0.02" mass="0.1" contype="0" conaffinity="0"/></body>
<body name="box" pos="0 0 0.03"><freejoint/><geom type="box" size="0.04 0.04 0.03" mass="1"/></body>
</worldbody><equality><weld name="suck" body1="hand" body2="box"{}/></equality>
<actuator><position joint="z" kp="2000"/></actuator></mujoco>"""


@pytest.mark.parametrize(("relpose", "gap"), [("", 430), (' relpose="0 0 -0.04 1 0 0 0"', 0)])
def test_an_equality_that_the_first_state_violates_is_said_in_millimetres(relpose, gap):
    """The hand, which collides with nothing, is 430 mm lower than in the model's first state."""
    model, data = posed(SUCTION.format(relpose))
    data.qpos[0] = -0.43
    scene = qr.mujoco_scenario(model, data, steps=1)
    said = [note for note in scene.drive.system.notes if "violated" in note]
    start = ["equality[suck] is violated by 430 mm at the start, and the first step closes"]
    assert [note[: len(start[0])] for note in said] == start * bool(gap)


def test_threads_that_share_a_scene_change_nothing_of_each_other_s(lifted):
    """MuJoCo has one state, at which forces, masses, places and rows of each q are read in turn."""
    scene, run = lifted
    simulator = scene.simulator()
    states = [(run.q[k], run.q[k + 1][: scene.system.n_q_a]) for k in (2, 20)]
    words = words_of_two_threads(simulator, states, 0.02)
    assert words.keys() <= {"same", "refused"}
    assert words["same"] > words["refused"]


@pytest.mark.parametrize(
    ("kind", "size", "reach"),
    [
        ("box", [0.05, 0.05, 0.24], np.sqrt(0.05**2 + 0.05**2 + 0.24**2)),
        ("sphere", [0.09], 0.09),
        ("capsule", [0.05, 0.2], 0.05 + 0.2),
        ("cylinder", [0.3, 0.4], 0.5),
        ("ellipsoid", [0.05, 0.06, 0.3], 0.3),
    ],
)
def test_a_bound_that_is_smaller_than_its_geom_is_named_and_no_height_of_zero(kind, size, reach):
    """The geom is enlarged after it is compiled, up to a ball; each reach is by its formula."""
    ball = f'<body name="p" pos="0 0 {size[-1] + 0.02}"><freejoint/><geom size=".02"/></body>'
    geom = f'<geom name="t" type="{kind}" size=".05 .05 .05"/>'
    model = model_of(f"<mujoco><worldbody>{geom}{ball}</worldbody></mujoco>")
    small = model.geom_rbound[0]
    model.geom_size[0, : len(size)] = size
    scene = qr.mujoco_scenario(model, steps=2)
    (said,) = scene.drive.system.notes
    assert f"geom[t] reaches {1e3 * reach:.4g} mm far" in said
    assert f"its geom_rbound {1e3 * small:.4g} mm" in said
    assert not any("0 mm above" in one.cause for one in scene.findings())
    model.geom_rbound[0] = reach
    model.geom_aabb[0, 3:] = reach
    assert qr.mujoco_scenario(model, steps=2).drive.system.notes == ()

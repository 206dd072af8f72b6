"""Rows of which only rounding is left bear nothing: contacts, limits and equalities."""

import mujoco
import numpy as np
import pytest

import quasistatic_ref as qr
from quasistatic_ref import ModelError, mujoco_step
from quasistatic_ref.optional.mujoco.tolerances import FULL_RANK
from tests.optional.mujoco.models import GRAVITY, H, mjcf, moved, posed


def turned(seed, world, more="", options=""):
    """A scene whose world is turned about a random axis, with its gravity."""
    q = np.random.default_rng(seed).normal(size=4)
    q /= np.linalg.norm(q)
    gravity = np.zeros(3)
    mujoco.mju_rotVecQuat(gravity, np.array([0, 0, -GRAVITY]), q)
    text = " ".join(map(str, gravity.tolist()))
    quat = " ".join(map(str, q.tolist()))
    options = f'<size memory="1M"/><option gravity="{text}" {options}/>'
    model, data = posed(mjcf(f'<frame quat="{quat}">{world}</frame>', more, options))
    mujoco.mj_forward(model, data)
    return model, data


PENDULUM = """<geom name="post" type="capsule" fromto="0 0 0 0 0 -.1" size=".02" mass="0"/>
<site name="above" pos="0 .2 0"/><body name="arm"><joint name="pivot" {}/>
<geom name="arm" type="capsule" fromto="0 0 0 .2 0 0" size=".02" mass="0"/><site name="on_axis"
 pos="0 .05 0"/><geom type="box" size=".01 .01 .01" pos=".2 0 0" mass="2" contype="0"/>
</body>"""
"""An arm of 0.2 m that overlaps, at its pivot, with the post that it hangs on."""
I_YY = 2 * 0.2**2 + 2 * (0.02**2 + 0.02**2) / 12
FALL = H**2 * 2 * GRAVITY * 0.2 / I_YY
"""How far the arm turns in a step: h^2 m g l / I, the inertia of a box and m l^2 [rad]."""


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("joint", ['axis="0 1 0"', 'type="ball"'])
def test_a_contact_at_the_pivot_bears_nothing(seed, joint):
    """Both capsules have an end at the pivot: the contact's point is there, its lever rounding."""
    _, answer, notes = moved(*turned(seed, PENDULUM.format(joint)))
    assert np.linalg.norm(answer.delta_q) == pytest.approx(FALL, rel=1e-9)
    assert answer.wrench.sum() == 0.0
    assert "contact[0: post/arm]: left out: joints or equalities hold its bodies" in notes
    assert "contact[0: post/arm]: its bodies penetrate by 40 mm" in notes


@pytest.mark.parametrize("seed", range(3))
def test_a_limit_that_no_joint_moves_bears_nothing(seed):
    """Both ends of the tendon are on the axis; it is 0.15 m long, and may have 0.1 m."""
    more = (
        '<tendon><spatial name="cord" range="0 .1"><site site="above"/><site site="on_axis"/>'
        "</spatial></tendon>"
    )
    scene = PENDULUM.replace('mass="0"/>', 'mass="0" contype="0"/>').format('axis="0 1 0"')
    model, data = turned(seed, scene, more)
    one = moved(model, data)
    assert one.by[0] == pytest.approx(FALL, rel=1e-9)
    assert "limit of tendon[cord]: left out" in one.notes
    run = qr.mujoco_scenario(model, data, h=H, steps=1).run()
    assert run.q[1, 0] == pytest.approx(FALL, rel=1e-9)


LINK = """<body name="{0}" pos="{1} 0 0"><joint name="{0}" axis="0 1 0"/><inertial pos=".12 0 -.16"
 mass="1" diaginertia="1e-3 1e-3 1e-3"/>{2}</body>"""
COUPLER = """<body name="coupler" pos=".12 0 -.16"><joint name="coupler" axis="0 1 0"/>
<inertial pos=".1 0 0" mass="3" diaginertia="1e-3 1e-3 1e-3"/></body>"""
FOUR_BAR = LINK.format("left", 0, COUPLER) + LINK.format("right", 0.3, "")
"""A parallelogram with links of 0.2 m, masses of 1 kg at their ends, and a coupler of 3 kg."""


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("cone", ["pyramidal", "elliptic"])
def test_a_planar_four_bar_falls_in_a_turned_base(seed, cone):
    """Of the three rows of ``connect``, the one across the plane is rounding.

    The coupler does not turn, so that I = (1 + 1 + 3) l^2 + 2 * 1e-3, and the moment about the
    pivots is (1 + 1 + 3) g times the horizontal lever.
    """
    more = '<equality><connect body1="coupler" body2="right" anchor=".3 0 0"/></equality>'
    once = moved(*turned(seed, FOUR_BAR, more, f'cone="{cone}"'))
    turn = H**2 * 5 * GRAVITY * 0.12 / (5 * 0.2**2 + 2e-3)
    assert once.by == pytest.approx([turn, -turn, turn], rel=1e-9)
    assert "equality[0]: left out, in part" in once.notes
    more = more.replace("</equality>", more.removeprefix("<equality>"))
    twice = moved(*turned(seed, FOUR_BAR, more, f'cone="{cone}"'))
    assert twice.by == pytest.approx(once.by, rel=1e-12)
    assert "equality[1]: left out" in twice.notes


@pytest.mark.parametrize("seed", range(3))
def test_a_contact_at_the_anchor_of_an_equality_bears_nothing(seed):
    """A ball that is connected to the world where it touches a floor turns about that point.

    It is pushed by its weight and a torque; about the point, I = 2/5 m r^2 + m r^2.
    """
    world = (
        '<geom type="plane" size="1 1 1"/><body name="ball" pos="0 0 .0999"><freejoint/>'
        '<geom size=".1" mass="2"/></body>'
    )
    more = '<equality><connect body1="ball" anchor="0 0 -.1"/></equality>'
    model, data = turned(seed, world, more)
    torque = np.random.default_rng(seed).normal(size=3)
    across = data.geom_xmat[0].reshape(3, 3)[:, 2]
    torque -= across * (across @ torque)
    data.xfrc_applied[1, 3:] = torque
    one = moved(model, data)
    about = data.xmat[1].reshape(3, 3) @ one.by[3:]
    assert about == pytest.approx(H**2 * torque / (7 / 5 * 2 * 0.1**2), rel=1e-9)
    assert "contact[0: body[world]/body[ball]]: left out" in one.notes


@pytest.mark.parametrize(("share", "bears"), [(0.5, False), (2.0, True)])
def test_a_lever_counts_from_1e_9_of_its_terms(share, bears):
    """The wheel of radius r touches below the pivot, but for e; the centre of mass is at c.

    A turn moves the centre of mass by c, and everything else by c + r about it at most: the terms
    of a lever are 2 c + r. A lever e that counts bears the moment: N e = m g c.
    """
    c, r, m = 0.3, 0.1, 2.0
    e = share * FULL_RANK * (2 * c + r)
    world = f"""<geom type="plane" size="1 1 1"/><body pos="0 0 {r}">
    <joint axis="0 1 0" pos="{-e} 0 0"/><inertial pos="{c} 0 0" mass="{m}" diaginertia="1 1 1"/>
    <geom size="{r}"/></body>"""
    _, answer, notes = moved(*posed(mjcf(world)))
    forces = answer.wrench[:, 2]
    assert ("left out" in notes) is not bears
    assert forces.tolist() == (pytest.approx([m * GRAVITY * c / e], rel=1e-6) if bears else [])


@pytest.mark.parametrize("held", ["<limit/>", '<equality><tendon tendon1="t"/></equality>'])
@pytest.mark.parametrize(("share", "holds"), [(0.5, False), (2.0, True)])
def test_a_difference_counts_from_1e_9_of_its_terms(held, share, holds):
    """With x = (1 + e) y, the length x - y of a tendon is e y, a difference of terms 1 + e and 1.

    A row that counts stops the push F on y; else y moves by h^2 F / (m (1 + e)^2 + m).
    """
    e = share * FULL_RANK * 2
    m, push = 2.0, 3.0
    ball = f'<geom size=".1" mass="{m}" contype="0"/>'
    cart = '<body><joint name="{}" type="slide" axis="1 0 0"/>' + ball + "</body>"
    limit = 'range="-1 0"' if "limit" in held else ""
    rest = f"""<tendon><fixed name="t" {limit}><joint joint="x" coef="1"/>
    <joint joint="y" coef="-1"/></fixed></tendon><equality>
    <joint joint1="x" joint2="y" polycoef="0 {1 + e!r} 0 0 0"/></equality>"""
    world = cart.format("y") + cart.format("x")
    text = mjcf(world, rest + held.replace("<limit/>", ""))
    one = moved(*posed(text, qfrc_applied=[push, 0.0]))
    y = 0.0 if holds else H**2 * push / (m * (1 + e) ** 2 + m)
    assert one.by[0] == pytest.approx(y, rel=1e-12)
    assert ("left out" in one.notes) is not holds


@pytest.mark.parametrize("apart", [0.0, 1e-7, 0.2])
def test_equalities_that_contradict_each_other_are_refused_where_a_step_closes_them(apart):
    """Two equalities hold one slide at x and at x - apart, over 1e-9 of reach: both cannot be."""
    x = 0.1
    ball = '<joint name="s" type="slide" axis="1 0 0"/><geom size=".1"/>'
    free = '<body><freejoint/><geom size=".1" contype="0"/></body>'
    held = "".join(
        f'<joint name="{name}" joint1="s" polycoef="{at!r} 0 0 0 0"/>'
        for name, at in (("one", x), ("two", x - apart))
    )
    state = posed(mjcf(f"<body>{ball}</body>{free}", f"<equality>{held}</equality>"))
    mujoco_step(*state, H)  # as they stand both hold
    if apart:
        with pytest.raises(ModelError, match=r"equality\[two\]: contradicts other equalities"):
            mujoco_step(*state, H, "as is")
    else:
        assert moved(*state, "as is").by[0] == pytest.approx(x, rel=1e-12)


GEOM = '<geom size=".1"/>'
TIED = '<body><joint name="j"/><geom size=".1"/></body>'


@pytest.mark.parametrize(
    ("bodies", "words"),
    [
        (GEOM, "worldbody: has no joint that can move; add a body with one"),
        (f'<body name="b">{GEOM}</body>', r"worldbody: .*; put one into body\[b\]"),
        (f'<body mocap="true">{GEOM}</body>', "worldbody: .*; add a body with one"),
        (f'<body mocap="true">{GEOM}</body><body/>', r"worldbody: .*; put one into body\[2\]"),
        (TIED, r"equality\[0\]: leaves no joint that can move"),
    ],
)
def test_a_model_in_which_nothing_can_move_is_refused(bodies, words):
    tie = '<equality><joint joint1="j"/></equality>' if bodies == TIED else ""
    state = posed(mjcf(bodies, tie))
    for take in (lambda *of: mujoco_step(*of, H), qr.mujoco_scenario, qr.mujoco_opinion):
        with pytest.raises(ModelError, match=words):
            take(*state)

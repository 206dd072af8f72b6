"""What MuJoCo bears at rest, the exact model bears at rest, element by element.

MuJoCo runs a random model of each element until it rests. The step that begins there ends where it
begins: the error of delta_q = 0, in the one measure of errors, is that of a state which has almost
settled. Without the element it is about one.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import mujoco
import numpy as np
import pytest

from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.optional.guests.mujoco import mujoco_step
from quasistatic_ref.solve.solve import solve_step

H = 0.01
AT_REST = 1e-4
"""What has not settled after a second: it decays with 10 / s or more."""
COARSE, FINE = (2e-3, 0.99), (5e-4, 0.9995)
"""Time step [s] and impedance [-] of MuJoCo: its softness is about timestep^2 (1 - impedance)."""


class Case(NamedTuple):
    """A model, what is set in its state, and what takes its element away."""

    world: str
    without: Callable[[Any, Any], Any]
    given: dict[str, Any] = {}  # noqa: RUF012 a field's default, which nothing writes into
    more: str = ""
    gravity: str = "0 0 -9.81"
    default: str = ""


def zero(*names: str) -> Callable[[Any, Any], None]:
    """What sets fields of the model or the state to zero."""

    def zeroed(model: Any, data: Any) -> None:
        for name in names:
            (home,) = [part for part in (data, model, model.opt) if hasattr(part, name)]
            getattr(home, name)[:] = 0

    return zeroed


FLOOR = '<geom type="plane" size="2 2 .1"/>'
BALL = '<geom size=".1" mass="{a}"/>'
BOX = '<geom type="box" size=".05 .06 .04" mass="{a}"/>'
CART = '<body name="b"><joint name="x" type="slide" axis="1 0 0" damping="60" {}/>{}</body>'
SPRUNG = CART.format('stiffness="{k}"', BALL)
FREE = CART.format("", BALL)
OTHER = (
    '<body pos="0 1 0"><joint name="y" type="slide" axis="1 0 0" damping="60"/>' + BALL + "</body>"
)
FIXED = '<tendon><fixed name="t" {}><joint joint="x" coef="2"/></fixed></tendon>'
PAIR = (
    '<tendon><fixed name="t"><joint joint="x" coef="1"/><joint joint="y" coef="{b}"/></fixed>'
    "</tendon>"
)
ALONG = "{b} 0 0"


def on_floor(z: float, geom: str) -> str:
    return f'{FLOOR}<body name="b" pos="0 0 {z}"><freejoint/>{geom}</body>'


def act(text: str) -> str:
    return f"<actuator>{text}</actuator>"


CASES = {
    "condim 1": Case(
        on_floor(0.1, BALL), zero("geom_contype", "geom_conaffinity"), default='<geom condim="1"/>'
    ),
    "condim 3": Case(
        on_floor(0.04, BOX), lambda m, d: m.geom_friction.fill(0.05), gravity="{a} {b} -9.8",
        default='<geom friction=".5"/>',
    ),
    "condim 4": Case(
        on_floor(0.1, BALL), lambda m, d: m.geom_condim.fill(3),
        {"xfrc_applied": [[0] * 6, [0, 0, 0, 0, 0, 0.1]]},
        default='<geom friction=".5 .03 .001" condim="4"/>',
    ),
    "margin": Case(on_floor(0.12, BALL), zero("geom_margin"), default='<geom margin=".01"/>'),
    "contact pair": Case(
        on_floor(0.1, BALL).replace("<geom ", '<geom contype="0" name="f" ', 1).replace(
            "<geom size", '<geom contype="0" name="g" size'),
        zero("geom_size"), more='<contact><pair geom1="f" geom2="g"/></contact>',
    ),
    "adhesion": Case(
        '<geom type="plane" pos="0 0 1" zaxis="0 0 -1" size="1 1 1"/><body name="b" pos="0 0 .9">'
        "<freejoint/>" + BALL + "</body>", zero("actuator_gainprm"), {"ctrl": 1},
        act('<adhesion body="b" ctrlrange="0 1" gain="30"/>'),
    ),
    "servo": Case(
        FREE, zero("actuator_gainprm", "actuator_biasprm"), {"ctrl": 0.3},
        act('<position joint="x" kp="{k}" gear="2"/>'), ALONG,
    ),
    "ctrlrange": Case(
        FREE, zero("actuator_ctrllimited"), {"ctrl": 0.9},
        act('<position joint="x" kp="{k}" ctrlrange="-.1 .1"/>'), ALONG,
    ),
    "saturated servo": Case(
        SPRUNG, zero("actuator_forcelimited"), {"ctrl": 2},
        act('<position joint="x" kp="{k}" forcerange="-1 {a}"/>'),
    ),
    "actuatorfrcrange": Case(
        CART.format('actuatorfrcrange="-1 {a}" stiffness="{k}"', BALL),
        zero("jnt_actfrclimited"), {"ctrl": 2}, act('<motor joint="x"/>'),
    ),
    "tendon's actuatorfrcrange": Case(
        SPRUNG, zero("tendon_actfrclimited"), {"ctrl": 2}, FIXED.format('actuatorfrcrange="-1 {a}"')
        + act('<position tendon="t" kp="{k}"/>'),
    ),
    "motor": Case(SPRUNG, zero("ctrl"), {"ctrl": 2}, act('<motor joint="x" gear="{b}"/>')),
    "activation": Case(
        FREE, zero("act"), {"act": 0.2}, act('<intvelocity joint="x" kp="{k}"/>'), ALONG,
    ),
    "muscle": Case(
        SPRUNG, zero("act"), {"ctrl": 0.5},
        act('<muscle joint="x" force="20" lengthrange="-.5 .5"/>'),
    ),
    "servo of two joints": Case(
        FREE + OTHER, zero("actuator_gainprm", "actuator_biasprm"), {"ctrl": 0.3},
        PAIR + '<equality><joint joint1="x" joint2="y" polycoef="0 .7 0 0 0"/></equality>'
        + act('<position tendon="t" kp="{k}"/>'), ALONG,
    ),
    "joint spring": Case(
        CART.format('stiffness="{k}" springref=".1"', BALL), zero("jnt_stiffness"), gravity=ALONG
    ),
    "ball spring": Case(
        '<body><joint type="ball" stiffness="30" damping="2"/><geom pos=".1 0 0" size=".05" '
        'mass="{a}"/></body>', zero("jnt_stiffness"),
    ),
    "tendon spring": Case(
        FREE, zero("tendon_stiffness"), more=FIXED.format('stiffness="{k}" springlength=".1"'),
        gravity=ALONG,
    ),
    "gravcomp": Case(
        '<body gravcomp="1"><freejoint/>' + BALL + "</body>", zero("body_gravcomp"),
    ),
    "wind": Case(SPRUNG, zero("wind"), more='<option wind="9 {a} 0" density="2"/>'),
    "qfrc_applied": Case(SPRUNG, zero("qfrc_applied"), {"qfrc_applied": 30}),
    "xfrc_applied": Case(SPRUNG, zero("xfrc_applied"), {"xfrc_applied": 30}),
    "frictionloss": Case(
        CART.format('frictionloss="5"', BALL), zero("dof_frictionloss"), gravity=ALONG
    ),
    "friction of a tendon": Case(
        FREE, zero("tendon_frictionloss"), more=FIXED.format('frictionloss="5"'), gravity=ALONG
    ),
    "joint limit": Case(
        CART.format('range="-1 .005"', BALL), zero("jnt_limited"), gravity=ALONG
    ),
    "tendon limit": Case(
        FREE, zero("tendon_limited"), more=FIXED.format('range="-1 .01"'), gravity=ALONG
    ),
    "joint equality": Case(
        SPRUNG + OTHER, zero("eq_active"), gravity=ALONG,
        more='<equality><joint joint1="x" joint2="y" polycoef=".01 {b} .5 0 0"/></equality>',
    ),
    "tendon equality": Case(
        SPRUNG + OTHER, zero("eq_active"), gravity=ALONG,
        more=PAIR + '<equality><tendon tendon1="t"/></equality>',
    ),
    "connect": Case(
        '<body name="b"><freejoint/>' + BOX + "</body>", zero("eq_active"),
        more='<equality><connect body1="b" anchor="0 0 .1"/></equality>',
    ),
    "weld": Case(
        '<body name="b"><freejoint/>' + BOX + "</body>", zero("eq_active"),
        more='<equality><weld body1="b"/></equality>',
    ),
    "weld to a mocap body": Case(
        '<body name="m" mocap="true" pos=".1 0 0"/><body name="b"><freejoint/>' + BOX + "</body>",
        zero("eq_active"), more='<equality><weld body1="b" body2="m"/></equality>',
    ),
}  # fmt: skip


def settled(case: Case, cone: str, soft: tuple[float, float], seed: int) -> tuple[Any, Any]:
    """A random model of an element, and its state after a second."""
    a, b, k = np.random.default_rng(seed).uniform(1, 2, 3)
    timestep, impedance = soft
    how = f'="{2 * timestep} 1"', f'="{impedance} {impedance} .001"'
    rigid = "".join(f" solref{of}{how[0]} solimp{of}{how[1]}" for of in ("limit", "friction"))
    plain = f"solref{how[0]} solimp{how[1]}"
    default = (
        f"<default><geom {plain}/><pair {plain}/><equality {plain}/><joint {rigid}/>"
        f"<tendon {rigid}/></default>"
    )
    text = (
        f'<mujoco><option timestep="{timestep}" cone="{cone}" gravity="{case.gravity}"/>'
        f"{default}<default>{case.default}</default><worldbody>{case.world}</worldbody>{case.more}"
        "</mujoco>"
    )
    model = mujoco.MjModel.from_xml_string(text.format(a=a, b=b, k=1000 * k))
    data = mujoco.MjData(model)
    for name, value in case.given.items():
        getattr(data, name)[:] = value
    for _ in range(round(1 / timestep)):
        mujoco.mj_step(model, data)
    return model, data


def off(model: Any, data: Any, depth: str = "closed") -> float:
    """The error of delta_q = 0 in the step of a state, over that of the largest load alone [-]."""
    step, coordinates = mujoco_step(model, data, H, depth)
    norm = energy_norm(step.H)
    loads = (data.qfrc_bias, data.qfrc_spring, data.qfrc_actuator, data.qfrc_applied)
    alone = max(norm.of_impulse(H * coordinates.T.T @ load) for load in loads)
    return norm.of_displacement(solve_step(step).delta_q) / alone


def normal_forces(data: Any) -> float:
    """The sum of MuJoCo's normal forces [N]."""
    force = np.zeros(6)
    total = 0.0
    for i in range(data.ncon):
        mujoco.mj_contactForce(data.model, data, i, force)
        total += force[0]
    return total


RUBS = ("condim 3", "condim 4")
EACH = [(name, "pyramidal") for name in CASES] + [(name, "elliptic") for name in RUBS]


@pytest.mark.parametrize(("name", "cone"), EACH)
def test_what_rests_in_mujoco_rests(name: str, cone: str) -> None:
    case = CASES[name]
    model, data = settled(case, cone, FINE, seed=len(name))
    step, _ = mujoco_step(model, data, H)
    assert off(model, data) < AT_REST
    assert solve_step(step).forces[:, 2].sum() == pytest.approx(normal_forces(data), rel=1e-4)
    case.without(model, data)
    assert off(model, data) > 0.01


VIOLATED = ("condim", "margin", "contact pair", "limit", "joint eq", "tendon eq", "connect", "weld")
SOFT = [each for each in EACH if any(word in each[0] for word in VIOLATED)]


@pytest.mark.parametrize(("name", "cone"), SOFT)
def test_violations_vanish_with_softness(name: str, cone: str) -> None:
    """Depth is about acceleration times timestep^2 (1 - impedance): 320 times less."""
    coarse, fine = (
        off(*settled(CASES[name], cone, soft, seed=len(name)), "as is") for soft in (COARSE, FINE)
    )
    assert coarse > 1e-5
    assert fine < coarse / 100

"""What MuJoCo bears at rest, the exact model bears at rest, element by element.

Let f be MuJoCo's forces, which keep the cones, and rho what they leave of the loads without
velocity. With x = delta_q, and phi >= 0, the optimum has x'Hx <= g'x, feasibility is
a_i'x >= -phi_i, and g = h rho - h sum_i f_i a_i; so that, with c = h sum_i f_i phi_i,

    x'Hx <= h rho'x + c, and ||x||_H <= h ||rho||_{H^-1} + sqrt(c).

That holds in each state, moving or not. MuJoCo pushes where phi = 0 (with adhesion, a little
before); so that the step of a state at rest, where rho is zero, stays where it is.
"""

import copy
from collections.abc import Callable
from typing import Any, NamedTuple

import mujoco
import numpy as np
import pytest

from quasistatic_ref import mujoco_step, solve_step
from quasistatic_ref.certify.norm import energy_norm
from tests.optional.mujoco.models import H, posed

SEEDS = 0, pytest.param(1, marks=pytest.mark.long)
SETTLED = 1e-5
"""rho of a state at rest, over the largest load, in the norm of H^-1. This is all that is asked of
the random models, and no friction or damper is there to reach it: velocities are set to zero
whenever the kinetic energy falls, which leaves the states at rest what they are."""
MOST = 20_000
"""Time steps in which a model has to settle."""
ROUNDING = 1e-9
"""Relative error of forces: places are right to 1e-17 m, and depths are 1e-8 m and more."""
COARSE, FINE = (2e-3, 0.99), (5e-4, 0.9995)
"""Time step [s] and impedance d [-] of MuJoCo."""
RATIO = (COARSE[0] / FINE[0]) ** 2 * (1 - COARSE[1]) / (1 - FINE[1])
"""At rest a contact has the depth 4 timestep^2 (1 - d) a with ``solref="2 timestep, 1"``, where a
is the acceleration that its force would cause: so much more with the first two than with the
last."""


class Case(NamedTuple):
    """A model, what is set in its state, and what takes its element away."""

    world: str
    without: Callable[[Any, Any], Any]
    values: dict[str, Any] = {}  # noqa: RUF012 a field's default, which nothing writes into
    more: str = ""
    gravity: str = "0 0 -9.81"
    default: str = ""


def zero(*names):
    """What sets fields of the model or the state to zero."""

    def zeroed(model, data):
        for name in names:
            (home,) = [part for part in (data, model, model.opt) if hasattr(part, name)]
            getattr(home, name)[:] = 0

    return zeroed


FLOOR = '<geom type="plane" size="2 2 .1"/>'
BALL = '<geom size=".1" mass="{a}"/>'
BOX = '<geom type="box" size=".05 .06 .04" mass="{a}"/>'
CART = '<body name="b"><joint name="x" type="slide" axis="1 0 0" {}/>{}<site name="s"/></body>'
SPRUNG = CART.format('stiffness="{k}"', BALL)
PENDULUM = (
    '<body><joint name="x" {}/><geom pos=".1 0 0" size=".05" mass="{{a}}"/>'
    '<site name="s" pos=".1 0 0"/></body>'
)
CEILING = (
    '<geom type="plane" pos="0 0 1" zaxis="0 0 -1" size="1 1 1"/><body name="b" pos="0 0 .9">'
    "<freejoint/>" + BALL + "</body>"
)
CORD = (
    '<worldbody><site name="post" pos="-.3 0 0"/></worldbody><tendon><spatial name="t" {}>'
    '<site site="post"/><site site="s"/></spatial></tendon>'
)
FREE = CART.format("", BALL)
OTHER = '<body pos="0 1 0"><joint name="y" type="slide" axis="1 0 0"/>' + BALL + "</body>"
FIXED = '<tendon><fixed name="t" {}><joint joint="x" coef="2"/></fixed></tendon>'
PAIR = (
    '<tendon><fixed name="t"><joint joint="x" coef="1"/><joint joint="y" coef="{b}"/></fixed>'
    "</tendon>"
)
ALONG = "{b} 0 0"


def on_floor(z, geom):
    return f'{FLOOR}<body name="b" pos="0 0 {z}"><freejoint/>{geom}</body>'


def act(text):
    return f"<actuator>{text}</actuator>"


CASES = {
    "condim 1": Case(
        on_floor(0.1, BALL), zero("geom_contype", "geom_conaffinity"), default='<geom condim="1"/>'
    ),
    "condim 3": Case(
        on_floor(0.04, BOX), lambda m, d: m.geom_friction.fill(0.05), gravity="{u} {v} -9.8",
        default='<geom friction=".5"/>',
    ),
    "condim 4": Case(
        on_floor(0.1, BALL), lambda m, d: m.geom_condim.fill(3),
        {"xfrc_applied": [[0] * 6, [0, 0, 0, 0, 0, 0.1]]},
        default='<geom friction=".5 .2 .001" condim="4"/>',
    ),
    "condim 6": Case(
        on_floor(0.1, BALL), zero("geom_contype", "geom_conaffinity"), default='<geom condim="6"/>'
    ),
    "height field": Case(
        on_floor(0.1, BALL).replace('type="plane" size="2 2 .1"', 'type="hfield" hfield="f"'),
        zero("geom_contype", "geom_conaffinity"),
        more='<asset><hfield name="f" nrow="3" ncol="3" size="1 1 .1 .1" '
        'elevation="0 0 0 0 0 0 0 0 0"/></asset>',
    ),
    "adhesion of a geom": Case(
        CEILING.replace("size", 'adhesion="{w}" size', 1), zero("geom_adhesion"),
        default='<geom gap=".01"/>',
    ),
    "margin": Case(on_floor(0.12, BALL), zero("geom_margin"), default='<geom margin=".01"/>'),
    "adhesion": Case(
        CEILING, zero("actuator_gainprm"), {"ctrl": 1},
        act('<adhesion body="b" ctrlrange="0 1" gain="{w}"/>'),
    ),
    "exact filter, gain of a velocity": Case(
        SPRUNG, zero("ctrl", "act"), {"ctrl": 2},
        act('<general joint="x" dyntype="filterexact" dynprm=".02" gaintype="affine" '
            'gainprm="{b} 0 -3"/>'),
    ),
    "servo": Case(
        FREE, zero("actuator_gainprm", "actuator_biasprm"), {"ctrl": 0.3},
        act('<position joint="x" kp="{k}" gear="2"/>'), ALONG,
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
    "ball spring": Case(PENDULUM.format('type="ball" stiffness="{k}"'), zero("jnt_stiffness")),
    "ball limit": Case(PENDULUM.format('type="ball" range="0 20"'), zero("jnt_limited")),
    "spring of a spatial tendon": Case(
        FREE, zero("tendon_stiffness"), more=CORD.format('stiffness="{k}" springlength=".2"'),
        gravity=ALONG,
    ),
    "wind": Case(SPRUNG, zero("wind"), more='<option wind="9 {a} 0" density="2"/>'),
    "qfrc_applied": Case(SPRUNG, zero("qfrc_applied"), {"qfrc_applied": 30}),
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
    "weld to a mocap body": Case(
        '<body name="m" mocap="true" pos=".1 0 0"/><body name="b"><freejoint/>' + BOX + "</body>",
        zero("eq_active"), more='<equality><weld body1="b" body2="m"/></equality>',
    ),
}  # fmt: skip


def random_model(case, cone, soft, seed):
    """A random model of an element, and the state that is given for it."""
    random = np.random.default_rng(seed)
    a, k = 10.0 ** random.uniform([-1, 2], [1, 4])
    b = random.uniform(0.5, 2)
    u, v = random.uniform(-0.25, 0.25, 2)  # |u| + |v| <= mu_v = 0.5: it holds in the pyramid
    timestep, impedance = soft
    how = f'="{2 * timestep} 1"', f'="{impedance} {impedance} .001"'
    rigid = "".join(f" solref{of}{how[0]} solimp{of}{how[1]}" for of in ("limit", "friction"))
    plain = f"solref{how[0]} solimp{how[1]}"
    default = (
        f"<default><geom {plain}/><pair {plain}/><equality {plain}/><joint {rigid}/>"
        f"<tendon {rigid}/></default>"
    )
    text = (
        f'<mujoco><size memory="1M"/><option timestep="{timestep}" cone="{cone}" tolerance="0" '
        f'gravity="{case.gravity}"/>{default}<default>{case.default}</default>'
        f"<worldbody>{case.world}</worldbody>{case.more}</mujoco>"
    )
    text = text.format(a=a, b=b, k=k, u=9.8 * u, v=9.8 * v, w=20 * a)  # w: twice the weight
    return posed(text, **case.values)


def settle(model, data):
    """Let a state come to rest."""
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    before = 0.0
    for i in range(MOST):
        mujoco.mj_step(model, data)
        if i % 100 < 60 and data.energy[1] < before * (1 - 1e-6):
            data.qvel[:] = 0.0  # later, a creeping contact finds its speed
        before = data.energy[1]
        if i % 100 == 99:
            mujoco.mj_forward(model, data)
            smooth, load = without_velocity(model, data)
            if np.abs(smooth + data.qfrc_constraint).max() < SETTLED / 100 * load.max():
                return
    raise AssertionError(f"does not rest after {MOST} steps")


def without_velocity(model, data):
    """The sum of all loads of a state [N, N m], and their sizes, one by one."""
    rest = copy.copy(data)
    rest.qvel[:] = 0.0
    mujoco.mj_forward(model, rest)
    loads = (rest.qfrc_bias, rest.qfrc_spring, rest.qfrc_actuator, rest.qfrc_applied)
    return rest.qfrc_smooth, np.abs(loads)


def normal_forces(data):
    """MuJoCo's normal forces, without the adhesion that it takes off them [N]."""
    forces = np.zeros((data.ncon, 6))
    for i in range(data.ncon):
        mujoco.mj_contactForce(data.model, data, i, forces[i])
    return (forces[:, 0] + data.contact.adhesion).tolist()


class Moved(NamedTuple):
    """How far a step moves, both terms of its bound, and how far the largest load alone would."""

    x: float
    rho: float
    before: float
    load: float
    answer: Any


def step_size(model, data, depth="closed"):
    """The step of a state, in the norm of H."""
    step, coordinates = mujoco_step(model, data, H, depth)
    answer = solve_step(step, "none" if step.cone == "pyramid" else None)
    norm = energy_norm(step.H)
    smooth, loads = without_velocity(model, data)
    T = coordinates.T
    before = [force * max(touch.dist - touch.includemargin, 0.0)
              for force, touch in zip(normal_forces(data), data.contact, strict=True)]  # fmt: skip
    return Moved(
        x=norm.of_displacement(answer.delta_q),
        rho=norm.of_impulse(H * T.T @ (smooth + data.qfrc_constraint)),
        before=(H * sum(before)) ** 0.5,
        load=max(norm.of_impulse(H * T.T @ load) for load in loads),
        answer=answer,
    )


RUBS = ("condim 3", "condim 4")
EACH = [(name, "pyramidal") for name in CASES] + [(name, "elliptic") for name in RUBS]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("name", "cone"), EACH)
def test_a_body_that_rests_in_mujoco_rests(name, cone, seed):
    case = CASES[name]
    model, data = random_model(case, cone, FINE, seed)
    settle(model, data)
    late = step_size(model, data)
    assert late.rho < SETTLED * late.load
    assert late.x <= late.rho + late.before + ROUNDING * late.load
    if data.ncon:
        total = sum(normal_forces(data))
        assert late.answer.forces[:, 2].sum() == pytest.approx(total, rel=1e-4)
    if seed == 0:
        case.without(model, data)
        assert step_size(model, data).x > 0.01 * late.load


@pytest.mark.parametrize(("name", "cone"), EACH)
def test_a_body_that_moves_in_mujoco_keeps_the_bound(name, cone):
    model, data = random_model(CASES[name], cone, FINE, seed=0)
    for _ in range(10):
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    early = step_size(model, data)
    assert early.x <= early.rho + early.before + ROUNDING * early.load


VIOLATED = ("condim", "field", "margin", "limit", "joint eq", "tendon eq", "connect", "weld")
SOFT = [each for each in EACH if any(word in each[0] for word in VIOLATED)]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("name", "cone"), SOFT)
def test_violations_vanish_with_time_step_and_softness(name, cone, seed):
    """What one step closes is in proportion to the depth, so that nothing is left at zero."""
    closed = []
    for soft in (COARSE, FINE):
        model, data = random_model(CASES[name], cone, soft, seed)
        settle(model, data)
        as_is = step_size(model, data, "as is")
        closed.append(as_is.x / as_is.load)
    coarse, fine = closed
    assert coarse == pytest.approx(RATIO * fine, rel=0.1)

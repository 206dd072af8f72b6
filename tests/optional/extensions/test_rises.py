"""Private rises, (R40): drawers and planar bases that slide, against h^2 (F - f) / (m + m_r)."""

import tomllib

import cvxpy as cp
import numpy as np
import pytest

from quasistatic_ref import (
    Extension,
    InputError,
    ModelError,
    StepData,
    StepDataError,
    derivatives,
    load_scenario,
    load_trajectory,
    save_trajectory,
    solve_step,
)
from quasistatic_ref.optional.extensions.extension import Rises
from tests.closeness import assert_relative, assert_within
from tests.files.urdf.urdf_texts import collision, inertial, joint, link, mimic, robot
from tests.helpers import random_step
from tests.made import actuated_step, contacts_of, free_step, no_contacts
from tests.tolerances import CLOSED_FORM, ROUNDING

H = 0.01
G = 9.81
DRAWER = robot(
    link("cabinet", inertial=""),
    link("drawer"),
    joint("slide", "cabinet", "drawer", "prismatic", "1 0 0", '<dynamics friction="3.0"/>'),
)
"""2 kg that slide along x."""
L = robot(
    link(
        "l",
        collision('<box size="0.1 0.04 0.03"/>')
        + collision('<box size="0.04 0.06 0.03"/>', '<origin xyz="-0.03 0.05 0"/>'),
        inertial("0.5", ("1e-3",) * 3, '<origin xyz="0.01 0.02 0"/>'),
    )
)
"""An L of 0.5 kg whose straight side, y = -0.02, is 0.1 m long."""
DRAWN = f"""h = 0.01
steps = 4
[bodies.cabinet]
urdf = '{DRAWER}'
joint_friction = {{ slide = 3.0 }}
"""
PUSHED = f"""h = 0.01
steps = 4
[bodies.l]
urdf = '{L}'
base = "planar"
support = {{ mu_v = 0.4, mu_omega = 0.01 }}
[[bodies.l.wrenches]]
t = 0
force = [4.0, -2.0, 0]
[shapes.wall]
halfspace = {{ normal = [0, 1, 0], offset = -0.02 }}
[contacts.wall]
alpha = "wall"
beta = "l"
mu_v = 0.25
rows = 4
k = 4
"""


def scene(text):
    return load_scenario(tomllib.loads(text))


def step(scenario, *force):
    q = scenario.system.q_start
    return scenario.simulator().step(q, np.zeros(0), np.array(force)).solution


@pytest.mark.parametrize("force", [4.999, -6.0])
def test_a_joint_that_follows_adds_its_friction_by_its_multiplier(force):
    """The follower moves 2 delta_q against 1 N: beyond 3 N + 2 1 N both open.

    delta_q = h^2 (F - f) / (M + m_r), M = m + 2^2 m, m_r = 1e-6 M.
    """
    follows = mimic("slide", -2.0) + '<dynamics friction="1.0"/>'
    two = robot(
        link("cabinet", inertial=""),
        link("drawer"),
        link("lower"),
        joint("slide", "cabinet", "drawer", "prismatic", "1 0 0", '<dynamics friction="3.0"/>'),
        joint("under", "cabinet", "lower", "prismatic", "1 0 0", follows),
    )
    asked = scene(DRAWN.replace("{ slide = 3.0 }", '"urdf"').replace(DRAWER, two))
    assert asked.of_bodies.rises.loads.tolist() == [5.0]
    M = 2.0 + 2.0**2 * 2.0
    expected = np.sign(force) * H**2 * max(abs(force) - 5.0, 0.0) / (M + 1e-6 * M)
    assert_relative(step(asked, force).delta_q[0], expected)


def test_terms_of_an_extension_see_no_rise():
    """Two of them on a joint whose spring of 100 N/m 0.5 N of 1.5 would bend by 5 mm.

    A limit of 2 mm is of the joint alone; a cost c/2 |x|^2 leaves h (tau - f) / (h K + c) = 2.5 mm.
    """
    one = actuated_step([[100.0]], [1.5], [0.0], no_contacts(1), H)
    rises = Rises([1.0], [1e-6 * H**2 * 100.0], [0])
    limited = Extension(lambda s: [s.delta_q_a >= -1.0, s.delta_q_a <= 0.002], rises=rises)
    answer = solve_step(one, extension=limited)
    assert answer.certificate.kind == "exact"
    assert answer.delta_q.tolist() == [0.002, 0.002]  # of the joint, and of its rise
    cost = Extension(lambda s: [0.5 * cp.sum_squares(s.delta_q)], rises=rises)
    answer = solve_step(one, extension=cost)
    assert_relative(answer.delta_q, [0.0025, 0.0025], 1e-5)


def test_an_l_is_pushed_along_a_wall_on_its_support(tmp_path):
    """The force (F_x, -F_y) acts at the centre of mass, the wall has the friction w.

    From touch it lifts off by w delta_x, and
    delta_x = h^2 (F_x - mu m g - w F_y) / (m (1 + w^2) + m_r mu^2).
    It goes straight: the wall bears w 40 mm = 10 mm ahead of the centre of mass, where the side is.
    """
    m = 0.5
    mu = 0.4
    w = 0.25
    x = H**2 * (4.0 - mu * m * G - w * 2.0) / (m * (1 + w**2) + 1e-6 * m * mu**2)
    run = scene(PUSHED).run()
    expected = [x, w * x, 0.0]
    np.testing.assert_allclose(run["delta_q"][0], expected, rtol=ROUNDING, atol=ROUNDING * x)
    assert set(run["certificate"].tolist()) == {"exact"}
    assert run.header.contacts[0][-1] == "support of l/0"
    # It bears m g + m_r r / h^2, never more than m_r F / m above m g, on a plane that it is on.
    assert (run["phi"][:, -1] == 0.0).all()
    assert_relative(run["wrench"][:, -1, 2], m * G, 1e-6)
    # Nothing of the rise is in the records but the programs, which can be solved again.
    read = load_trajectory(save_trajectory(tmp_path / "run.npz", run))
    answer = solve_step(read.step_data(3), "daqp")
    assert answer.delta_q[:3].tolist() == read["delta_q"][3].tolist()
    assert run.header.largest_boundary_layer < 2 * w * x  # of the wall, not of the rise


@pytest.mark.parametrize(
    ("text", "field"),
    [
        (PUSHED, "support"),
        (DRAWN, "joint_friction"),
        (
            DRAWN.replace("joint_friction = { slide = 3.0 }", 'joint_limits = "urdf"'),
            "joint_limits",
        ),
    ],
)
def test_derivatives_name_the_field_that_has_none(text, field):
    scenario = scene(text)
    with pytest.raises(InputError, match=f"^{field}: has no derivative.* tables of bodies"):
        derivatives(scenario.simulator(), scenario.system.q_start, [])


def test_an_answer_with_a_support_is_read_by_the_names_of_bodies():
    scenario = scene(PUSHED)
    answer = step(scenario, 4.0, -2.0, 0.0).delta_q
    with pytest.raises(ModelError, match=r"^delta_q: .*take delta_q\[..., :3\]"):
        scenario.system.change_of(answer, "l")
    assert scenario.system.change_of(answer[:3], "l").tolist() == answer[:3].tolist()


def risen(step, *rises, **contacts):
    """The exact answer of a step with private rises."""
    return solve_step(step, "none", extension=Extension(rises=Rises(*rises, **contacts)))


def beyond(force, most):
    """What is left of a force once friction has taken its part."""
    return np.sign(force) * max(abs(force) - most, 0.0)


@pytest.mark.parametrize("share", [0.999, 1.001, 3.0])
@pytest.mark.parametrize("seed", range(3))
def test_r40_random_loads_slide_joints_that_are_not_held(seed, share):
    """h^2 (F -+ f) / (m + m_r) beyond f, or with h^2 K_q in place of m."""
    rng = np.random.default_rng(seed)
    h, m, m_r, f, K = 10 ** rng.uniform([-3, -2, -6, -2, 0], [-1, 2, 1, 2, 4])
    F = rng.choice([-1, 1]) * share * f
    step = StepData(h, [[K]], [[m]], [0.4 * F], [F], [0.6 * F / K], no_contacts(2))
    answer = risen(step, [f, f], [m_r, m_r], [0, 1])
    expected = h**2 * beyond(F, f) / (np.array([h**2 * K, m]) + m_r)
    near = CLOSED_FORM * h**2 * f / (min(m, h**2 * K) + m_r)
    assert_within(answer.delta_q, [*expected, *abs(expected)], near)
    assert share > 1 or not answer.delta_q.any()


@pytest.mark.parametrize("cone", ["pyramid", "product", "facets-8", "ellipsoid"])
@pytest.mark.parametrize("i", range(3))
@pytest.mark.parametrize("seed", range(3))
def test_r40_random_loads_slide_planar_bases_that_are_not_held(seed, i, cone):
    """N = m g + m_r r / h^2: along an axis h^2 (F -+ mu_v m g) / (m + m_r mu_v^2)."""
    rng = np.random.default_rng((seed, i))
    h, m, m_r, mu_v, mu_omega = 10 ** rng.uniform([-3, -2, -6, -1, -3], [-1, 2, 1, 0, -1])
    mu, own, weight = (mu_v, mu_v, mu_omega)[i], (m, m, 1e-3 * m)[i], m * G
    load, expected = np.zeros(3), np.zeros(4)
    load[i] = rng.choice([-1, 1]) * rng.choice([0.999, 1.001, 3.0]) * mu * weight
    J = np.zeros((1, 4, 3))
    J[0, [0, 1, 3], [0, 1, 2]] = 1.0
    contact = contacts_of(0.0, np.eye(3), J, mu_v, mu_omega, rows=6)
    step = free_step(np.diag([m, m, 1e-3 * m]), load, contact, h).replace(cone=cone)
    answer = risen(step, [weight], [m_r], contacts=[0])
    per_force = h**2 / (own + m_r * mu**2)
    slid = per_force * beyond(load[i], mu * weight)
    expected[[i, 3]] = slid, mu * abs(slid)
    assert_within(answer.delta_q, expected, CLOSED_FORM * per_force * mu * weight)
    assert_relative(answer.wrench[0, 2], weight + m_r * expected[3] / h**2, CLOSED_FORM)


def test_a_step_without_rises_is_itself_and_wrong_ones_are_refused(rng):
    one = random_step(rng)
    assert solve_step(one, extension=Extension()).step is one
    with pytest.raises(StepDataError, match=r"rises.loads: must be >= 0"):
        Rises([-1.0], [1.0], [0])
    with pytest.raises(StepDataError, match=r"rises.masses: must have shape \(1,\)"):
        Rises([1.0], [], [0])


TILTED = "pose = { rpy = [0.1, 0, 0] }\nsupport ="
REFUSED = {
    "an unknown joint": (
        DRAWN, "slide = 3.0", "slid = 3.0",
        r"cabinet.joint_friction.slid: .*did you mean 'slide'",
    ),
    "a support of what is fixed": (
        DRAWN, "joint_friction = { slide = 3.0 }", "support = { mu_v = 1 }",
        r"support: .*\"planar\"",
    ),
    "a tilted planar base": (
        PUSHED, "support =", TILTED,
        r'^bodies.l.pose.rpy: moves or turns by z, rx, ry, which.*or take base = "floating"',
    ),
    "no weight": (
        PUSHED, "h = 0.01", "h = 0.01\ngravity = [0, 0, 0]", "gravity that presses it down",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("text", "old", "new", "says"), REFUSED.values(), ids=REFUSED)
def test_a_rise_that_means_nothing_is_refused_by_name(text, old, new, says):
    with pytest.raises(InputError, match=says):
        scene(text.replace(old, new))

"""Where a step sticks over less than the first difference, and how right one-sided slopes are."""

from fractions import Fraction

import numpy as np
import pytest

from quasistatic_ref import Body, HalfSpace, Sphere, derivatives, load_scenario
from tests.closeness import assert_same, assert_within
from tests.optional.derivatives.free_bodies import BOX, FLOOR, NONE, free

G = 8.0
M = 0.5
RADIUS = 0.0625
MU = 0.5


def ball_on(ground, inertia, h, height, **contact):
    """A ball of mass M that touches a body or a half-space, gravity being G."""
    moments = " ".join(f'{axis}="{inertia}"' for axis in ("ixx", "iyy", "izz"))
    urdf = (
        f'<robot name="b"><link name="ball"><inertial><mass value="{M}"/>'
        f'<inertia {moments} ixy="0" ixz="0" iyz="0"/></inertial>'
        f'<collision><geometry><sphere radius="{RADIUS}"/></geometry></collision></link>'
        "</robot>"
    )
    is_plane = isinstance(ground, HalfSpace)
    body = {"urdf": Body("ball", urdf).urdf, "base": "floating", "pose": {"xyz": [0, 0, height]}}
    bodies = {"ball": body} | ({} if is_plane else {"ground": {"body": ground}})
    return load_scenario(
        {
            "h": h,
            "steps": 1,
            "gravity": [0, 0, -G],
            "bodies": bodies,
            "shapes": {"ground": ground} if is_plane else {},
            "contacts": {"c": {"alpha": "ground", "beta": "ball", "mu_v": MU, **contact}},
        }
    )


@pytest.mark.shared
@pytest.mark.parametrize("inertia", [2.0**-11, 2.0**-12, 2.0**-10])
@pytest.mark.parametrize("h", [2.0**-11, 2.0**-10, 2.0**-12])
@pytest.mark.parametrize("axis", [0, 1])
def test_a_ball_that_sticks_on_one_side_over_micrometres_has_no_derivative(axis, h, inertia):
    """On a fixed ball, at the edge of its cone: downhill it slips, uphill it rolls for a while.

    The load F = mu m g acts along x or y, with a torque that would not turn it.
    """
    hill = 0.9375
    ground = Body.of_shape("ground", Sphere(hill), mass=1.0, base="fixed")
    scene = ball_on(ground, inertia, h, RADIUS + hill, rows=4)
    load = np.zeros(6)
    load[axis] = MU * M * G
    load[3:] = np.cross([0, 0, RADIUS], -load[:3])
    found = derivatives(scene.simulator(), scene.system.q_start, NONE, load, by=("q", "tau"))
    assert np.isnan(found.dq_dq[:, axis]).all()
    assert all("slack" in reason.sentence for reason in found.reasons)
    assert {field for reason in found.reasons for field in reason.fields} == {"dq_dq", "dq_dtau"}


@pytest.mark.parametrize("mu", [1e-5, 1e-7, 1e-9, 1e-12])
@pytest.mark.parametrize("axis", [0, 1, 5])
def test_a_box_that_sticks_under_less_than_the_smallest_difference_has_no_slope(axis, mu):
    """It sticks under a force of mu m g, and about the vertical under the torque of its corners."""
    box = free(BOX, (0, 0, 0.05), FLOOR, k=4, mu=(mu, mu))
    found = derivatives(*box, NONE, by=("tau",))
    column = found.dq_dtau[:, axis]
    assert_within(found.dq_dtau[:, 2], np.zeros(6), 1e-12)  # it is pressed on the floor
    if mu > 1e-6:
        assert_within(column, np.zeros(6), 1e-12)
    else:
        assert np.isnan(column).all()
        assert any("here, and with slack nearby" in why.sentence for why in found.reasons)


@pytest.mark.parametrize(
    ("inertia", "mu_omega"), [(2.0**-11, 2.0**-7), (2.0**-11, 2.0**-5), (2.0**-13, 2.0**-6)]
)
def test_one_sided_slopes_have_ten_digits(inertia, mu_omega):
    """Of a ball at the edge of spin, d(angle)/d(mu_omega) = -h^2 m g / (I + m mu_omega^2)."""
    h = 2.0**-6
    scene = ball_on(HalfSpace((0, 0, 1), 0.0), inertia, h, RADIUS, mu_omega=mu_omega, rows=6)
    load = np.array([0, 0, 0, 0, 0, mu_omega * M * G])
    found = derivatives(scene.simulator(), scene.system.q_start, NONE, load, by=("mu_omega",))
    moment = Fraction(inertia) + Fraction(M) * Fraction(mu_omega) ** 2
    right = -(Fraction(h) ** 2) * Fraction(M) * Fraction(G) / moment
    below = found.by["mu_omega"].below[5, 0]
    assert abs(Fraction(float(below)) / right - 1) < Fraction(1, 10**10)
    assert abs(Fraction(float(found.along(mu_omega=[-1.0])[5])) / -right - 1) < Fraction(1, 10**10)
    assert np.isnan(found.dq_dmu_omega).all()


@pytest.mark.parametrize("name", ["mu_v", "mu_omega"])
def test_at_friction_of_zero_the_slope_is_that_from_above(name):
    """It is that of steps with a little friction; there is none below."""
    simulator, q = free(Sphere(0.05), (0, 0, 0.05), FLOOR, mu=(0.0, 0.0))
    load = np.array([0.1, 0, 0, 0, 0, 1e-3])
    found = derivatives(simulator, q, NONE, load, by=(name,))
    size = 1e-7
    ends = []
    for times in (1, 2):
        near = {"mu_v": 0.0, "mu_omega": 0.0} | {name: times * size}
        other, _ = free(Sphere(0.05), (0, 0, 0.05), FLOOR, mu=tuple(near.values()))
        ends.append(simulator.system.difference(found.result.q, other.step(q, NONE, load).q))
    expected = (4 * ends[0] - ends[1]) / (2 * size)
    assert_within(found.by[name].rate[:, 0], expected, 1e-6 * np.abs(expected).max())
    assert np.abs(expected).max() > 0
    assert_same(found.by[name].rate, found.by[name].above)
    assert np.isnan(found.by[name].below).all()

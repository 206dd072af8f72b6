"""Two fingers that hold a bar, and that lift it."""

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Comparison, comparison
from quasistatic_ref.lab.made_steps.contacts import GRAVITY, X, Y, contacts_of, point_jacobian
from quasistatic_ref.lab.made_steps.pinch import pinch_step
from quasistatic_ref.lab.thresholds import exact, grid, thresholds
from quasistatic_ref.step.data import StepData
from quasistatic_ref.tolerances import CLOSED_FORM

# The paper's Figure 1 in closed form: two fingertips hold a bar off its centre of mass.

M = 0.2
"""Mass of the bar [kg]."""


def held_bar(offset: float, grip: float, mu_v: float, mu_omega: float) -> StepData:
    """A bar that is held at an offset [m]."""
    return pinch_step(grip, offset, mu_v, mu_omega, m=M)


def pinch_evidence() -> list[Comparison]:
    """The offset at which a held bar begins to turn, and the fingers' forces, against (R14)."""
    sweep = grid([4.0, 10.0, 40.0], [0.4, 0.8], [0.005, 0.02])
    grip, mu_v, mu_omega = sweep.T
    expected = mu_omega * (2 * grip / (M * GRAVITY) - 1 / mu_v)
    measured = thresholds(held_bar, sweep, expected)
    steps = (held_bar(0.9 * limit, *of) for limit, of in zip(expected, sweep, strict=True))
    loads = [exact(step).wrench[:, 2] for step in steps]
    grips = np.stack([grip, grip], axis=1)
    return [
        comparison("offset that turns the bar [m]", measured, expected, CLOSED_FORM, expected),
        comparison("normal force of a finger [N]", loads, grips, CLOSED_FORM, grips),
    ]


PINCH = Claim(
    name="pinch",
    sentence="Two fingers that press with N hold a bar without any motion while the offset of its "
    "centre of mass is at most mu_omega (2 N / (m g) - 1 / mu_v).",
    where="docs/derivations.md (R14); the paper, Fig. 1",
    sweep="three grips, two mu_v, two mu_omega; each threshold by bisection on exact answers",
    reason="CLOSED_FORM, above the 1e-13 at which the bisection stops.",
    measure=pinch_evidence,
)

# A bar that two fingers lift by its end: the smallest time step with which they hold it.
#
# (R46), necessary: the fingers bear the load L = m (g + v / h) and the torque d L about their
# common normal. The pyramid of a corner bounds |f_1| + |f_2| by mu_v times its normal force, and
# either component has the arm a about the middle of the pad, so all corners together make at most
# the torque 2 mu_v N a. Sufficient: let the two corners of each pad on the side of the centre of
# mass press with F = L / (2 mu_v) together and push up with all their friction, and the other two
# press with N - F and push sideways, against each other, with up to all of theirs. The net force of
# a pad is L / 2, and its torque is anything from a L / 2 to mu_v N a, hence also d L / 2. By the
# condition F <= N, so no corner pulls. In Coulomb's cone the torque alone is bounded by sqrt(2)
# times as much.

MU_V = 0.6
K = 2000.0
"""Of a finger [N/m]."""
SQUEEZE = 10.0
"""Force of a finger [N]."""
HALF_WIDTH = 0.03
"""Of the bar along x [m]."""
PAD = 0.01
"""Half-width of a pad along y and z [m]."""
INERTIA = (7e-4, 9e-5, 7.3e-4)
"""Of the bar [kg m^2]."""


def lifting_step(speed: float, lever: float, h: float) -> StepData:
    """A step in which fingers lift a bar as fast as in the steps before.

    q_a: how far the left finger and the right one have closed, along +x and -x, and how far each
    has risen. q_u: the twist of the bar at its centre of mass, axes along the world's. Each finger
    touches at the four corners of its pad.

    Parameters
    ----------
    speed : float
        Of the bar and of the targets [m/s].
    lever : float
        Of the fingers along y, from the centre of mass [m].
    h : float
        [s].
    """
    n = np.repeat([X, -X], 4, axis=0)  # finger j closes along n
    corners = [[0.0, y, z] for y in (-PAD, PAD) for z in (-PAD, PAD)]
    J = np.zeros((8, 4, 10))
    J[:4, :3, 0] = -X
    J[4:, :3, 1] = X
    J[:4, 2, 2] = -1.0
    J[4:, 2, 3] = -1.0
    J[:, :, 4:] = point_jacobian(lever * Y - HALF_WIDTH * n + np.tile(corners, (2, 1)), n)
    lag = M * (GRAVITY + speed / h) / (2 * K)  # of the targets: weight and drag, half of it each
    frames = np.stack([np.tile(Y, (8, 1)), np.cross(n, Y), n], axis=1)
    return StepData(
        h=h,
        K_q=K * np.eye(4),
        M_u=np.diag([M, M, M, *INERTIA]),
        tau_a=np.zeros(4),
        tau_u=[0.0, 0.0, -M * GRAVITY, 0.0, 0.0, 0.0],
        delta_q_bar_a=[SQUEEZE / K, SQUEEZE / K, speed * h + lag, speed * h + lag],
        contacts=contacts_of(0.0, frames, J, MU_V),
    )


def lift_evidence() -> list[Comparison]:
    """The rate 1 / h of steps from which on the bar turns."""
    sweep = grid([0.001, 0.01, 0.1, 0.3], [0.02, 0.03, 0.04])
    speed, lever = sweep.T
    expected = (2 * MU_V * SQUEEZE * PAD / lever - M * GRAVITY) / (M * speed)

    def at_rate(rate: float, speed: float, lever: float) -> StepData:
        return lifting_step(speed, lever, 1 / rate)

    measured = thresholds(at_rate, sweep, expected, part=slice(7, None))
    held = (at_rate(rate / 1.1, *of) for rate, of in zip(expected, sweep, strict=True))
    risen = np.array([exact(step).delta_q[6] for step in held]) / (speed * 1.1 / expected)
    return [
        comparison(
            "rate of steps that turns the bar [1/s]", measured, expected, CLOSED_FORM, expected
        ),
        comparison("rise of a bar that is held, over v h [-]", risen, 1.0, CLOSED_FORM),
    ]


LIFT = Claim(
    name="lift",
    sentence="Two fingers with square pads of half-width a press with N each on a bar, at the "
    "distance d >= a from its centre of mass. They lift the bar at the speed v without "
    "turning it while m (g + v / h) <= 2 mu_v N a / d: at a given speed the time step must "
    "not be too small.",
    where="docs/derivations.md (R46)",
    sweep="four speeds, three levers; each threshold by bisection on exact answers",
    reason="CLOSED_FORM, above the 1e-13 at which the bisection stops.",
    measure=lift_evidence,
)

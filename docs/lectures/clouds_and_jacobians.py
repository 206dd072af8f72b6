"""Lesson 3: phi and J of a cloud, of two bodies, and the mass matrix

A body known by points touches the floor z = 0. Its twist is along and about its own axes.
"""

# %% setup
import numpy as np

import quasistatic_ref as qr

RNG = np.random.default_rng(3)
POINTS = RNG.uniform(-0.05, 0.05, (30, 3))
SYSTEM = qr.System(
    [qr.Body.of_shape("b", qr.Sphere(0.05), mass=0.5, xyz=(0.1, 0.2, 0.12), rpy=(0.3, -0.4, 0.5))]
)
POSE = SYSTEM.kinematics(SYSTEM.q_start)
R = POSE.R[1]
T = POSE.t[1]
FLOOR = qr.PlacedShape("floor", 0, np.eye(3), np.zeros(3), qr.HalfSpace((0, 0, 1), 0.0))
CLOUD = qr.PlacedShape("cloud", 1, np.eye(3), np.zeros(3), qr.PointCloud(POINTS))
PAIR = qr.ContactPair("floor", FLOOR, CLOUD, mu_v=0.5, mu_omega=0.0, rows=4, k=5)
SIMULATOR = qr.Simulator(SYSTEM, [PAIR], h=0.01, K_q=np.zeros((0, 0)))
FOUND = SIMULATOR.step(SYSTEM.q_start, np.zeros(0)).step.contacts
NUMBERS = [int(name.rsplit("/", 1)[1]) for name in FOUND.name]
SCENE = qr.load_scenario("bunny_grasp", ["steps=1"])  # its palm's axes are the world's
GRASP = SCENE.run(progress=False).step_data(0)

# %% task
"""phi of every point [m], for a body with the orientation R whose origin is at T."""


def gaps(points, R, T):
    return np.zeros(len(points))


# %% answer
def gaps(points, R, T):
    return (points @ R.T + T)[:, 2]


# %% check
check("phi", lambda: np.allclose(gaps(POINTS, R, T)[NUMBERS], FOUND.phi, rtol=1e-9))

# %% task
"""Numbers of the k points that become contacts, those with the least phi first."""


def nearest(phi, k):
    return np.zeros(k, dtype=int)


# %% answer
def nearest(phi, k):
    return np.argsort(phi, kind="stable")[:k]


# %% check
check("selection", lambda: nearest((POINTS @ R.T + T)[:, 2], 5).tolist() == NUMBERS)

# %% task
"""J of a point r of the body, shape (4, 6), Eq. (3): three rows along the world's axes, one about
the normal n."""


def jacobian(r, R, n):
    return np.zeros((4, 6))


# %% answer
def jacobian(r, R, n):
    J = np.zeros((4, 6))
    J[:3, :3] = R
    J[:3, 3:] = R @ np.cross(np.eye(3), r).T
    J[3, 3:] = n @ R
    return J


# %% check
check(
    "J",
    lambda: all(
        np.allclose(jacobian(POINTS[k], R, np.array([0, 0, 1.0])), J, atol=1e-12)
        for k, J in zip(NUMBERS, FOUND.J, strict=True)
    ),
)

# %% task
"""The grasp's coordinates are the palm's twist, the width, the bunny's twist. The width is the
opening of the fingers along y: each goes by half of it, the left one to +y. Its column in J for a
contact of the left finger, then of the right one, shape (2, 4). Fingers are alpha's bodies."""
WIDTH = np.zeros((2, 4))

# %% answer
WIDTH = np.array([[0, -0.5, 0, 0], [0, 0.5, 0, 0]])

# %% check
check("two bodies", lambda: np.allclose(GRASP.contacts.J[[5, 10], :, 6], WIDTH, atol=1e-12))

# %% task
"""M_u of a free body of mass m [kg], with its centre of mass at c in its frame [m] and its inertia
about this [kg m^2], shape (6, 6)."""


def mass_matrix(m, c, inertia):
    return np.eye(6)


# %% answer
def mass_matrix(m, c, inertia):
    C = np.cross(np.eye(3), c).T  # omega x c = C omega
    return np.block([[m * np.eye(3), m * C], [m * C.T, inertia + m * C.T @ C]])


# %% check
MASS, C_OF_MASS = 0.2, np.array([-0.00367084888, -0.0125927824, 0.052680309])  # bunny.urdf
INERTIA = 1e-6 * np.array(
    [
        [251.967737, -3.83968262, 79.9697697],
        [-3.83968262, 416.239415, -2.71989227],
        [79.9697697, -2.71989227, 321.749049],
    ]
)
check(
    "M_u",
    lambda: np.allclose(mass_matrix(MASS, C_OF_MASS, INERTIA), GRASP.M_u, rtol=0, atol=1e-12),
)

# %% task
"""(R16): what a square patch of four points at the radius a holds against a turn, over mu m g a,
when each d1 is an angle e off the slip [rad]."""


def share(e):
    return 0.0


# %% answer
def share(e):
    return max(abs(np.cos(e)), abs(np.sin(e)))


# %% check
def turns(e, torque):
    middle = np.pi / 2 * np.arange(4)
    corners = 0.03 * np.column_stack([np.cos(middle), np.sin(middle), np.zeros(4)])
    along = middle + np.pi / 2 + e
    d1 = np.column_stack([np.cos(along), np.sin(along), np.zeros(4)])
    up = np.tile([0, 0, 1.0], (4, 1))
    J = np.zeros((4, 4, 4))  # x, y, z and the turn about z
    J[:, :3, :3], J[:, :3, 3], J[:, 3, 3] = np.eye(3), np.cross(up, corners), 1
    contacts = qr.Contacts(
        tuple("abcd"),
        np.zeros(4),
        up,
        d1,
        np.cross(up, d1),
        J,
        np.full(4, 0.5),
        np.zeros(4),
        [4] * 4,
    )
    step = qr.StepData(
        h=0.01, K_q=np.zeros((0, 0)), M_u=np.diag([1, 1, 1, 1e-3]), tau_a=[],
        tau_u=[0, 0, -9.81, torque * 0.5 * 9.81 * 0.03], delta_q_bar_a=[], contacts=contacts,
    )  # fmt: skip
    return abs(qr.solve_step(step).delta_q[3]) > 1e-12


check(
    "patch",
    lambda: all(
        turns(e, 1.001 * share(e)) and not turns(e, 0.999 * share(e))
        for e in np.radians([0, 22.5, 45, 70])
    ),
)

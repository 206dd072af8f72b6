"""Random planar steps of one body: along x and z, and about y."""

import numpy as np

from tests.made import contacts_of, free_step

H = 0.01


def planar_step(rng, kind):
    """A step of a body with one to four contacts.

    Parameters
    ----------
    rng : Generator
    kind : str
        ``"floor"``: corners of a box on level ground, with exact ties; ``"anywhere"``: points and
        normals of any direction; ``"wedge"``: two normals that nearly or exactly face each other.
    """
    m = rng.uniform(0.2, 2.0)
    inertia = m * rng.uniform(0.001, 0.02)
    count = int(rng.integers(1, 5))
    mu = rng.uniform(0.1, 1.0) if rng.random() < 0.5 else rng.uniform(1.0, 5.0)
    angles = rng.uniform(0.0, 2 * np.pi, count)
    points = rng.uniform(-0.1, 0.1, (count, 2))
    phi = np.where(rng.random(count) < 0.7, 0.0, rng.uniform(0.0, 2e-4, count))
    force = m * rng.normal(size=3) * np.array([10.0, 10.0, 0.3])
    if kind == "floor":
        angles = np.full(count, np.pi / 2)
        points = np.array([[x, -0.05] for x in (-0.05, 0.05, 0.0, 0.025)])[:count]
        phi = np.where(rng.random(count) < 0.9, 0.0, 1e-5)
        force[1] = -9.81 * m
        force[0] = rng.uniform(0, 3) * mu * 9.81 * m
    if kind == "wedge":
        count = max(count, 2)
        angles = np.resize([np.pi / 2, -np.pi / 2], count) + rng.choice([0.0, 0.1]) * rng.normal()
        angles[1] += rng.choice([0.0, 0.5]) * rng.normal()
        points = np.resize(points, (count, 2))
        phi = np.zeros(count)
    return free_step(np.diag([m, m, inertia]), force, planar_contacts(phi, angles, points, mu), H)


def planar_contacts(phi, angles, points, mu):
    """Contacts of a body with a world of normals at some angles [rad], at points [m] of it."""
    frames, J = [], []
    for angle, (x, z) in zip(angles, points, strict=True):
        n_x, n_z = (float(np.round(a, 15)) + 0.0 for a in (np.cos(angle), np.sin(angle)))
        frames.append([[n_z, 0.0, -n_x], [0.0, 1.0, 0.0], [n_x, 0.0, n_z]])
        J.append([[1.0, 0.0, -z], [0.0, 0.0, 0.0], [0.0, 1.0, x], [0.0, 0.0, 0.0]])
    return contacts_of(phi, np.array(frames), np.array(J), mu)

"""Builders of steps, and the one definition of error, written without the package's formulas."""

import numpy as np

from quasistatic_ref.step.data import Contacts, StepData

REQUIRED = ("clarabel", "osqp", "piqp")
ROADS = (*REQUIRED, *(f"qpsolvers:{name}" for name in (*REQUIRED, "daqp")))
JUDGE = "daqp"
X, Y, Z = np.eye(3)


def cross_matrix(r):
    """[r]x, so that [r]x @ a = r x a."""
    return np.array([[0.0, -r[2], r[1]], [r[2], 0.0, -r[0]], [-r[1], r[0], 0.0]])


def contacts_of(phi, frames, J, mu_v, mu_omega, rows):
    """Contacts from frames [d1, d2, n], each 3 x 3 with these as its rows."""
    n_c = len(rows)
    frames = np.reshape(frames, (n_c, 3, 3))
    return Contacts(
        name=tuple(f"c{j}" for j in range(n_c)),
        phi=np.broadcast_to(phi, n_c),
        n=frames[:, 2],
        d1=frames[:, 0],
        d2=frames[:, 1],
        J=J,
        mu_v=np.broadcast_to(mu_v, n_c),
        mu_omega=np.broadcast_to(mu_omega, n_c),
        rows=np.array(rows, dtype=int),
    )


def no_contacts(n_v):
    """No contact at all."""
    return contacts_of(0.0, np.zeros((0, 3, 3)), np.zeros((0, 4, n_v)), 0.0, 0.0, ())


def changed(contacts, **changes):
    """A copy of contacts with some fields changed, validated anew."""
    names = ("name", "phi", "n", "d1", "d2", "J", "mu_v", "mu_omega", "rows")
    return Contacts(**{name: getattr(contacts, name) for name in names} | changes)


def reordered(contacts, order):
    """The contacts numbered in `order`, which may repeat some and drop others."""
    names = ("phi", "n", "d1", "d2", "J", "mu_v", "mu_omega", "rows")
    picked = {name: getattr(contacts, name)[list(order)] for name in names}
    return Contacts(name=tuple(f"c{j}" for j in range(len(order))), **picked)


def random_frame(rng):
    """A random right-handed orthonormal frame; its rows are d1, d2, n."""
    d1, a = rng.normal(size=(2, 3))
    d1 /= np.linalg.norm(d1)
    n = np.cross(d1, a)
    n /= np.linalg.norm(n)
    return np.stack([d1, np.cross(n, d1), n])


def random_stiffness(rng, size, scale):
    """A random symmetric positive definite matrix, condition at most some tens."""
    B = rng.normal(size=(size, size))
    S = scale * (B @ B.T / max(size, 1) + np.eye(size))
    return (S + S.T) / 2


def random_step(rng, n_a=3, n_u=4, rows=(6, 4, 6)):
    """A random step with phi >= 0, which is always feasible: standing still is allowed."""
    n_c, n_v = len(rows), n_a + n_u
    return StepData(
        h=0.01,
        K_q=random_stiffness(rng, n_a, 500.0),
        M_u=random_stiffness(rng, n_u, 0.2),
        tau_a=rng.normal(size=n_a),
        tau_u=rng.normal(size=n_u),
        delta_q_bar_a=1e-3 * rng.normal(size=n_a),
        contacts=contacts_of(
            phi=1e-4 * np.abs(rng.normal(size=n_c)),
            frames=np.array([random_frame(rng) for _ in rows]),
            J=rng.normal(size=(n_c, 4, n_v)),
            mu_v=rng.uniform(0.1, 1.0, n_c),
            mu_omega=rng.uniform(0.01, 0.1, n_c),
            rows=rows,
        ),
    )


def contact_row(contacts, j, i):
    """[J'(n~ + d~_i)]' of contact j by hand, i = 0 .. 5."""
    mu_v, mu_omega = contacts.mu_v[j], contacts.mu_omega[j]
    along = (contacts.d1[j], contacts.d2[j], -contacts.d1[j], -contacts.d2[j])
    point = contacts.n[j] + mu_v * along[i] if i < 4 else contacts.n[j]
    spin = (0, 0, 0, 0, mu_omega, -mu_omega)[i]
    row = []
    for k in range(contacts.J.shape[2]):
        entry = spin * contacts.J[j, 3, k]
        for r in range(3):
            entry += point[r] * contacts.J[j, r, k]
        row.append(entry)
    return np.array(row)


def planted_step(rng, n_a=3, n_u=4, rows=(6, 4, 6)):
    """A step made around its own optimum: the step, delta_q and lam.

    One row of each contact is made active and given a positive multiplier; the forces are those
    that balance it. H is positive definite, so this optimum is the only one.
    """
    step = random_step(rng, n_a, n_u, rows)
    delta_q = 1e-3 * rng.normal(size=n_a + n_u)
    phi, lam, push = [], [], np.zeros(n_a + n_u)
    for j, count in enumerate(rows):
        motion = [float(contact_row(step.contacts, j, i) @ delta_q) for i in range(count)]
        active = int(np.argmin(motion))
        lam_j = np.zeros(count)
        lam_j[active] = 0.01 * rng.uniform(0.5, 1.5)
        phi.append(-motion[active])
        lam.append(lam_j)
        push += lam_j[active] * contact_row(step.contacts, j, active)
    spring = step.K_q @ (delta_q[:n_a] - step.delta_q_bar_a)
    step = step.replace(
        tau_a=spring - push[:n_a] / step.h,
        tau_u=step.M_u @ delta_q[n_a:] / step.h**2 - push[n_a:] / step.h,
        contacts=changed(step.contacts, phi=np.array(phi)),
    )
    return step, delta_q, np.concatenate([np.zeros(0), *lam])


def point_on_floor(m=0.3, mu_v=0.5, phi=0.0, force=(0.0, 0.0, 0.0), h=0.01):
    """A point mass above a floor z = 0; delta_q is its displacement."""
    J = np.zeros((1, 4, 3))
    J[0, :3] = np.eye(3)
    return StepData(
        h=h,
        K_q=np.zeros((0, 0)),
        M_u=m * np.eye(3),
        tau_a=(),
        tau_u=force,
        delta_q_bar_a=(),
        contacts=contacts_of(phi, np.eye(3), J, mu_v, 0.0, (4,)),
    )


def sphere_on_floor(
    m=0.3,
    inertia=2e-4,
    radius=0.04,
    mu_v=0.5,
    mu_omega=0.02,
    phi=0.0,
    wrench=(0.0,) * 6,
    h=0.01,
    rows=6,
):
    """A sphere above a floor z = 0; delta_q is its twist at the centre, wrench its load."""
    J = np.zeros((1, 4, 6))
    J[0, :3, :3] = np.eye(3)
    J[0, :3, 3:] = -cross_matrix(-radius * Z)  # omega x r = -[r]x omega
    J[0, 3, 3:] = Z
    return StepData(
        h=h,
        K_q=np.zeros((0, 0)),
        M_u=np.diag([m, m, m, inertia, inertia, inertia]),
        tau_a=(),
        tau_u=wrench,
        delta_q_bar_a=(),
        contacts=contacts_of(phi, np.eye(3), J, mu_v, mu_omega, (rows,)),
    )


def pinch(m=0.2, grip=20.0, offset=0.01, mu_v=0.5, mu_omega=0.02, stiffness=1000.0, h=0.01):
    """A bar held by two fingers on the axis x, `offset` [m] along y from its centre of mass.

    q_a: how far the left finger (along +x) and the right one (along -x) have closed, touching;
    delta_q_bar_a = grip / stiffness presses each with `grip` [N]. q_u: the bar's twist at its
    centre. Gravity pulls along -z, a pyramid axis of both contacts.
    """
    half_width = 0.03
    frames, J = [], np.zeros((2, 4, 8))
    for j, side in enumerate((1.0, -1.0)):
        n = side * X
        r = np.array([-side * half_width, offset, 0.0])
        frames.append([Y, np.cross(n, Y), n])
        J[j, :3, j] = -n
        J[j, :3, 2:5] = np.eye(3)
        J[j, :3, 5:] = -cross_matrix(r)
        J[j, 3, 5:] = n
    return StepData(
        h=h,
        K_q=stiffness * np.eye(2),
        M_u=np.diag([m, m, m, 1e-4, 1e-4, 1e-4]),
        tau_a=np.zeros(2),
        tau_u=[0.0, 0.0, -9.81 * m, 0.0, 0.0, 0.0],
        delta_q_bar_a=[grip / stiffness, grip / stiffness],
        contacts=contacts_of(0.0, frames, J, mu_v, mu_omega, (6, 6)),
    )


def hessian(step):
    """H of (13), by blocks."""
    n_a, n_v = step.n_a, step.n_v
    H = np.zeros((n_v, n_v))
    H[:n_a, :n_a] = step.h * step.K_q
    H[n_a:, n_a:] = step.M_u / step.h
    return H


def unconstrained(step):
    """H^-1 g in closed form: delta_q_bar_a + K_q^-1 tau_a; h^2 M_u^-1 tau_u."""
    actuated = step.delta_q_bar_a + np.linalg.solve(step.K_q, step.tau_a)
    return np.concatenate([actuated, step.h**2 * np.linalg.solve(step.M_u, step.tau_u)])


def error(step, delta_q, truth):
    """||x - x*||_H / ||H^-1 g||_H."""
    H, free, gap = hessian(step), unconstrained(step), np.asarray(delta_q) - np.asarray(truth)
    return float(np.sqrt(gap @ H @ gap) / np.sqrt(free @ H @ free))

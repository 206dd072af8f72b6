"""One step of the model of Tracy and Manchester in plain CVXPY: ``python one_step.py``.

Numbers in the comments are those of the paper's equations. All quantities are in SI units, all
vectors in world axes. Actuated coordinates (motors) come first: delta_q = (delta_q_a, delta_q_u).
"""

import cvxpy as cp
import numpy as np


def jacobian(r, n):
    """J of one contact, shape (4, 6), between the fixed world (alpha) and a free body (beta).

    The body's coordinates are the translation and the rotation (world axes) about its centre of
    mass; r leads from there to the contact point, n points from the world into the body.
    """
    J = np.zeros((4, 6))
    for i in range(6):
        v, omega = np.split(np.eye(6)[i], 2)
        nu_beta = v + np.cross(omega, r)
        J[:, i] = np.append(nu_beta, n @ omega)  # Eqs. (2), (3); the world does not move
    return J


def rows(phi, n, d1, d2, J, mu_v, mu_omega):
    """A_j, shape (6, n_v), and b_j, shape (6,), of one contact: A_j delta_q >= b_j is Eq. (4)."""
    n_tilde = np.append(n, 0.0)
    along_d1 = np.append(mu_v * d1, 0.0)
    along_d2 = np.append(mu_v * d2, 0.0)
    about_n = np.append(np.zeros(3), mu_omega)
    d_tilde = [along_d1, along_d2]  # Eq. (5)
    d_tilde += [-along_d1, -along_d2]  # Eq. (6)
    d_tilde += [about_n, -about_n]  # Eq. (7)
    A_j = np.array([J.T @ (n_tilde + d) for d in d_tilde])  # Eq. (8)
    b_j = -phi * np.ones(6)  # Eq. (8)
    return A_j, b_j


def program(h, K_q, M_u, delta_q_bar_a, tau_a, tau_u, contacts):
    """H, g, A and b: minimise 1/2 delta_q' H delta_q - g' delta_q subject to A delta_q >= b.

    `contacts` is a list; each is a tuple of the arguments of `rows`.
    """
    tau_k = K_q @ delta_q_bar_a  # Eq. (1)
    no_coupling = np.zeros((len(K_q), len(M_u)))
    H = np.block([[h * K_q, no_coupling], [no_coupling.T, M_u / h]])
    g = h * np.append(tau_k + tau_a, tau_u)
    of_contacts = [rows(*contact) for contact in contacts]
    A = np.concatenate([A_j for A_j, _ in of_contacts])
    b = np.concatenate([b_j for _, b_j in of_contacts])
    return H, g, A, b


def step(h, *data):
    """delta_q, shape (n_v,), and lam, shape (m,) [N s], from the arguments of `program`."""
    H, g, A, b = program(h, *data)
    # A displacement may be as small as a solver's tolerance. So the unknown is delta_q / h^2, an
    # acceleration, and the energy is divided by h^3: multipliers are then forces, lam / h.
    acceleration = cp.Variable(len(g))
    delta_q = h**2 * acceleration
    no_row_is_violated = (A @ delta_q - b) / h**2 >= 0  # Eq. (10)
    energy = 0.5 * cp.quad_form(delta_q, H) - g @ delta_q
    problem = cp.Problem(cp.Minimize(energy / h**3), [no_row_is_violated])  # Eq. (13)
    tolerances = dict.fromkeys(("tol_gap_abs", "tol_gap_rel", "tol_feas"), 1e-12)
    problem.solve(solver=cp.CLARABEL, **tolerances)

    delta_q = delta_q.value
    lam = h * no_row_is_violated.dual_value
    assert np.allclose(H @ delta_q - g - A.T @ lam, 0)  # Eq. (9): impulses balance
    assert lam.min() > -1e-8  # Eq. (11): contacts push and do not pull
    assert np.allclose((A @ delta_q - b) * lam, 0)  # Eq. (12): only tight rows push
    return delta_q, lam


def free_step(M_u, tau_u, contact, h=0.01):
    """A step of one body that no motor drives."""
    nothing = np.zeros(0)
    return step(h, np.zeros((0, 0)), M_u, nothing, nothing, tau_u, [contact])


def block(push):
    """A block of 1 kg on a table, pushed along x [N]: delta_q = (dx, dy, dz, dtheta)."""
    d1, d2, n = np.eye(3)
    contact = (0.0, n, d1, d2, np.eye(4), 0.5, 0.02)  # phi, n, d1, d2, J, mu_v, mu_omega
    return free_step(np.diag([1, 1, 1, 1e-3]), np.array([push, 0, -9.81, 0]), contact)


def sphere(torque):
    """A sphere of 0.3 kg, radius 50 mm, on a floor, under a torque about z [N m]: section III-A."""
    d1, d2, n = np.eye(3)
    J = jacobian(-0.05 * n, n)
    inertia = 0.4 * 0.3 * 0.05**2
    M_u = np.diag([0.3] * 3 + [inertia] * 3)
    tau_u = np.array([0, 0, -0.3 * 9.81, 0, 0, torque])
    return free_step(M_u, tau_u, (0.0, n, d1, d2, J, 1.0, 0.01))


if __name__ == "__main__":
    for push in (3.0, 6.0):
        delta_q, lam = block(push)
        print(f"block, push of {push:g} N: delta_q =", (1e6 * delta_q).round(1) + 0.0, "um, urad")
        print(f"    normal force {lam.sum() / 0.01:.3f} N")
    for torque in (0.02, 0.04):  # the limit, mu_omega m g, is 0.0294 N m
        delta_q, lam = sphere(torque)
        print(f"sphere, torque of {torque} N m: turns by {1e3 * delta_q[5]:.3f} mrad", end="")
        print(f", rises by {1e6 * delta_q[2]:.1f} um")

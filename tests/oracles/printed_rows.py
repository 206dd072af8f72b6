"""What Eqs. (2) and (4) say, as printed, of systems and steps of tests."""

import numpy as np
from scipy.spatial.transform import Rotation

from quasistatic_ref.step.problem import paper_problem, set_values
from tests.helpers import random_step
from tests.tolerances import DIFFERENCE_STEP

LINKS = {
    "a free body on the world": ("world", "box/box"),
    "the world on a free body": ("box/box", "world"),
    "a chain on a floating base and a free body": ("arm/lower", "box/box"),
    "a prismatic joint's link and a mimic's": ("desk/slider", "arm/follower"),
    "a mimic's link, welded on, and the world": ("desk/tool", "world"),
    "two links of one chain": ("arm/upper", "arm/tool"),
}


def relative_velocity(scene, q, v, link_alpha, link_beta, alpha, beta, n):
    """f(q, v) of Eq. (2) from positions a little before and after q, moving at v."""
    here = scene.kinematics(q)
    before, after = (
        scene.kinematics(scene.integrate(q, way * DIFFERENCE_STEP * v)) for way in (-1, 1)
    )

    def of_side(link, point):
        """Velocity of a material point, and angular velocity."""
        local = here.R[link].T @ (point - here.t[link])
        one, two = (at.R[link] @ local + at.t[link] for at in (before, after))
        turned = Rotation.from_matrix(after.R[link] @ before.R[link].T).as_rotvec()
        return (two - one) / (2 * DIFFERENCE_STEP), turned / (2 * DIFFERENCE_STEP)

    (nu_a, omega_a), (nu_b, omega_b) = of_side(link_alpha, alpha), of_side(link_beta, beta)
    return [*(nu_b - nu_a), n @ (omega_b - omega_a)]


def problem_at(step, delta_q):
    """The problem of a step, with the values of its parameters and of its unknowns."""
    problem = paper_problem(step)
    set_values(problem, step)
    problem.a_a.value, problem.a_u.value = np.split(delta_q / step.h**2, [step.n_a])
    return problem


def left_hand_sides(step, delta_q):
    """The left-hand side of each row i of the contacts that have it, at a displacement."""
    # CVXPY keeps x >= 0 as 0 - x <= 0. Its x is the row over h^2.
    rows = problem_at(step, delta_q).contact_rows
    return [-(step.h**2) * constraint.expr.value for constraint in rows]


def added_to_the_gap(rng):
    """Contacts, their motion J delta_q, and what each row i adds to phi + n'J delta_q."""
    step = random_step(rng, rows=(6, 6, 6))
    delta_q = rng.normal(size=step.n_v)
    c = step.contacts
    motion = c.J @ delta_q
    return c, motion, np.array(left_hand_sides(step, delta_q)) - c.phi - along(c.n, motion)


def along(direction, motion):
    """The part of each contact's motion along a direction of its own."""
    return (direction * motion[:, :3]).sum(axis=1)

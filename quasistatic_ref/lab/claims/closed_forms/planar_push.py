"""A slider pushed on the plane under an ellipsoidal limit surface, slowly and less slowly."""

import numpy as np

from quasistatic_ref.certify.solution import StepSolution
from quasistatic_ref.lab.claims.claim import Claim, Evidence, comparison, within
from quasistatic_ref.lab.measures import exact, grid, slope
from quasistatic_ref.lab.scenes.slider import (
    GYRATION,
    RADII,
    SPEEDS,
    STIFFNESS,
    H,
    Push,
    push,
    push_step,
    rotated,
    sliding_motion,
    sticking_motion,
    turns,
)
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import CLOSED_FORM, FITTED

ENCLOSED = 1e-15
"""Largest error_bound: below the rounding of data and formulas that CLOSED_FORM is made for."""

SLOW_PUSHES = 1e-4 * 2.0 ** np.arange(4)
"""Quasi-dynamic numbers from which the quasi-static limit is extrapolated [-]."""

LIMIT = 1e-9
"""Largest distance of that limit from Lynch's motion [-]: a cubic leaves 64e-16 times the fourth
power of (rho / c)^2, up to 5e-13, and rounding of the slowest push, 1e-16 / 1e-4, a few times."""


def relative(solution: StepSolution, of: Push) -> Array:
    """Turn, x and y of the slider for an advance of 1, turn times the arm, shape (3,) [-]."""
    motion = solution.delta_q[[5, 2, 3]] / np.linalg.norm(solution.delta_q[:2])
    return motion * [np.linalg.norm(of.point), 1.0, 1.0]


def slow_pushes() -> tuple[Array, Array, Array]:
    """Sticking and sliding pushes ever slower.

    Returns
    -------
    measured : ndarray, shape (pushes, speeds, 3)
        Motions [-], as :func:`relative` gives them.
    limits, lynch : ndarray, shape (pushes, 3)
        What they tend to, and Lynch's [-].
    """
    found = []
    limits = []
    for angle, aside, c, sticks in grid([0.3, 2.0], [-0.7, 0.4], [0.02, 0.05], [1.0, 0.0]):
        point = rotated(np.array([0.04, 0.0]), angle)
        direction = rotated(-point / 0.04, aside)
        pushes = [
            push(point, direction, mu_v=0.4, c=c, Pi=Pi, lifted=1.0, sticks=bool(sticks))
            for Pi in SLOW_PUSHES
        ]
        found.append([relative(exact(push_step(of)), of) for of in pushes])
        motion = (sticking_motion if sticks else sliding_motion)(point, direction, c**2)
        limits.append(motion[[2, 0, 1]] * [0.04, 1, 1])
    measured = np.array(found)
    lynch = np.array(limits)
    cubic = np.polynomial.polynomial.polyfit(
        SLOW_PUSHES / SLOW_PUSHES[-1], np.moveaxis(measured, 1, 0).reshape(len(SLOW_PUSHES), -1), 3
    )
    return measured, cubic[0].reshape(lynch.shape), lynch


def evidence() -> Evidence:
    """Points, directions, coefficients and speeds; then the quasi-static limit."""
    sweep = grid(
        [0.3, 2.0], [0.01, 0.05], [-1.0, 0.4], [0.25, 0.6], [0.015, GYRATION], [0.01, 0.5],
        [0.0, 1.0], [1.0, 0.0],
    )  # fmt: skip
    pushes = [
        push(
            rotated(np.array([radius, 0.0]), angle), rotated(np.array([-1.0, 0.0]), angle + aside),
            mu_v=mu_v, c=c, Pi=Pi, lifted=lifted, sticks=bool(sticks),
        )
        for angle, radius, aside, mu_v, c, Pi, lifted, sticks in sweep
    ]  # fmt: skip
    answers = [exact(push_step(of)) for of in pushes]
    c = sweep[:, 4]
    # Turns and torques as lengths and forces at the radius c.
    moved = np.array([a.delta_q[[2, 3, 5]] for a in answers])
    moved[:, 2] *= c
    expected = np.array([of.motion for of in pushes])
    expected[:, 2] *= c
    size = np.linalg.norm(expected, axis=1)
    support = np.array([a.wrench[0, [0, 1, 3]] for a in answers])
    support[:, 2] /= c
    normal = np.array([of.friction for of in pushes])
    normal[:, 2] /= c
    load = np.array([of.load for of in pushes])
    rise = np.array([of.rise for of in pushes])
    gap = sweep[:, 3] * size
    bounds = np.array([a.certificate.error_bound for a in answers], dtype=np.float64)
    # The push is what the pusher's spring says.
    spring = np.array([
        STIFFNESS * (step.delta_q_bar_a - a.delta_q[:2])
        for step, a in zip(map(push_step, pushes), answers, strict=True)
    ])  # fmt: skip
    force = np.array([of.force for of in pushes])
    total = np.linalg.norm(force, axis=1)
    alike = c == GYRATION
    lynch = np.array([
        sticking_motion(of.point, a.delta_q[:2], GYRATION**2) if of.mu_pusher
        else sliding_motion(of.point, of.normal, GYRATION**2) * (of.normal @ a.delta_q[:2])
        for of, a in zip(pushes, answers, strict=True)
    ]) * [1.0, 1.0, GYRATION]  # fmt: skip
    slow, limit, quasi_static = slow_pushes()
    off = np.abs(slow - quasi_static[:, None])[..., 0]
    rates = [slope(SLOW_PUSHES, x) for x in off]
    ratios = {c: np.array(turns(c)) for c in RADII}
    law = [(1 + SPEEDS) / (1 + SPEEDS * (GYRATION / c) ** 2) for c in RADII]
    picture = {"Pi": SPEEDS, "turns": ratios, "rho": GYRATION, "h": H}
    along_normal = "support's force, along the normal of its limit surface [N]"
    at_any_speed = "motion where rho = c, Lynch's at every speed [m]"
    return Evidence.of(
        comparison("motion of the slider [m]", moved, expected, CLOSED_FORM, size[:, None]),
        comparison("rise [m]", [a.delta_q[4] for a in answers], rise, CLOSED_FORM, gap),
        comparison(along_normal, support, normal, CLOSED_FORM, load[:, None]),
        comparison("push [N]", spring, force, CLOSED_FORM, total[:, None]),
        comparison("load [N]", [a.wrench[0, 2] for a in answers], load, CLOSED_FORM, load),
        comparison("turn over Lynch's [-]", list(ratios.values()), law, CLOSED_FORM, law),
        comparison(at_any_speed, moved[alike], lynch[alike], CLOSED_FORM, size[alike, None]),
        comparison("exponent of the distance from Lynch's turn [-]", rates, 1.0, FITTED),
        comparison("motion for Pi to 0, Lynch's [-]", limit, quasi_static, LIMIT),
        within("error_bound [-]", bounds, 0.0, ENCLOSED),
        **picture,
    )


CLAIM = Claim(
    name="planar_push",
    sentence="A slider pushed on the plane moves along the normal of its ellipsoidal limit "
    "surface: as Lynch, Maekawa and Tanie say while the quasi-dynamic number Pi is small, and at "
    "any Pi with their c^2 replaced by (c^2 + Pi rho^2) / (1 + Pi).",
    where="docs/derivations.md (R28), in the ellipsoid; Lynch, Maekawa & Tanie (1992)",
    sweep="four points, two directions, two mu_v, two mu_omega / mu_v, two Pi, from the floor and "
    "in steady motion, with a pusher that sticks and one without friction; the limit from 16 more "
    "pushes at four Pi; turns at nine Pi for three mu_omega / mu_v",
    reason="CLOSED_FORM; FITTED for the rate; LIMIT for what is extrapolated to Pi = 0; ENCLOSED: "
    "what is proved of the answers has to be finer than all of these.",
    measure=evidence,
)

"""Where a push ends: its finger led along its path, each step solved and certified."""

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from quasistatic_ref.lab.reality.outline import rotation
from quasistatic_ref.lab.reality.push import FINGER, Pushed
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.coulomb.fixed_point import simulated_solution
from quasistatic_ref.simulate.law import COULOMB
from quasistatic_ref.solve.backends import DAQP, DEFAULT, Certify
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.step.cones import ELLIPSOID
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.solution import StepSolution
from quasistatic_ref.tolerances import ACCURACY


@dataclass(frozen=True, eq=False)
class Prediction:
    """Where a body ends, and how its steps were certified.

    Parameters
    ----------
    pose : ndarray, shape (3,)
        x, y [m], angle [rad] of the body's frame.
    kinds : dict of str to int
        How many steps have a certificate of each kind.
    error_bound : float or None
        The largest of all steps [-]; None if a step has none.
    sticks, slides : int
        Steps in which the finger touched without slipping, and slipping.
    """

    pose: Array
    kinds: dict[str, int]
    error_bound: float | None
    sticks: int
    slides: int


def prediction(of: Pushed, pose: Array, path: Array, certify: Certify = "full") -> Prediction:
    """A push from a pose, with the finger along a path of straight pieces.

    Until the finger touches the body lies still: the steps begin where the path first touches. A
    finger that starts inside of the outline is drawn back along the shortest way, and comes from
    there.

    Parameters
    ----------
    of : Pushed
    pose : ndarray, shape (3,)
        x, y [m], angle [rad] of the body's frame.
    path : ndarray, shape (n, 2)
        Of the finger's centre, world [m].
    certify : str
        As of :func:`~quasistatic_ref.solve.solve.solve_step`; Coulomb's law is certified in full.
    """
    R = rotation(pose[2])
    body = np.zeros(4)
    body[:2], body[3] = pose[:2] + R @ of.outline.centre, pose[2]
    kinds = Counter[str]()
    error = 0.0
    sticks = 0
    slides = 0
    solver: Solver | None = None
    targets = finger_waypoints(of, pose, path)
    finger = next(targets)
    for target in targets:
        step = of.step(finger, body, target)
        solver = solver_for_step(step, solver)
        if of.by.law == COULOMB:
            solution: StepSolution = simulated_solution(step, solver, ACCURACY)
        else:
            solution = solve_step(step, solver, certify=certify)
        finger = finger + solution.delta_q[:2]
        body = body + solution.delta_q[2:]
        kinds[solution.certificate.kind] += 1
        bound = solution.certificate.error_bound
        error = max(error, np.inf if bound is None else bound)
        loaded, slips = grip(step, solution)
        sticks = sticks + (loaded and not slips)
        slides = slides + (loaded and slips)
    R = rotation(body[3])
    end = np.append(body[:2] - R @ of.outline.centre, body[3])
    return Prediction(end, kinds, error if np.isfinite(error) else None, sticks, slides)


def solver_for_step(step: StepData, solver: Solver | None) -> Solver:
    """A solver for the step: the solver of the step before if it fits."""
    if solver is None or not solver.fits(step):
        return solver_for(step, DEFAULT if step.cone == ELLIPSOID else DAQP)
    return solver


SLIPS = 1e-3
"""Share of its advance by which a finger that slides slips at least [-]."""


def grip(step: StepData, solution: StepSolution) -> tuple[bool, bool]:
    """Whether the finger, the last contact, presses on the body, and whether it slips along it."""
    contacts = step.contacts
    slip = float(contacts.d1[-1] @ (contacts.J[-1, :3] @ solution.delta_q))
    advance = float(np.linalg.norm(solution.delta_q[:2]))
    return bool(solution.wrench[-1, 2] > 0), abs(slip) > SLIPS * advance


def finger_waypoints(of: Pushed, pose: Array, path: Array) -> Iterator[Array]:
    """Where the finger starts, and its targets from there to the end of its path.

    Each is of shape (2,) [m]. Steps of each straight piece are of equal length, at most
    ``of.by.advance``.

    Parameters
    ----------
    of : Pushed
    pose : ndarray, shape (3,)
        Of the body's frame [m, rad].
    path : ndarray, shape (n, 2)
        Of the finger [m].
    """
    R = rotation(pose[2])

    def gap(finger: Array) -> tuple[float, Array]:
        distance, _, normal = of.outline.closest(R.T @ (finger - pose[:2]))
        return distance - FINGER, R @ normal

    overlap, normal = gap(path[0])
    points = list(path)
    if overlap < 0:
        points.insert(0, path[0] + overlap * normal)
    else:
        points = from_contact(points, lambda finger: gap(finger)[0])
    yield points[0]
    for start, end in pairwise(points):
        length = float(np.linalg.norm(end - start))
        count = int(np.ceil(length / of.by.advance * (1 - SAME)))
        for k in range(count):
            yield start + (end - start) * ((k + 1) / count)


SAME = 1e-9
"""Relative rounding of a length that is so many steps long [-]."""

CLOSE = 1e-6
"""Distance at which a finger counts as touching [m]."""


def from_contact(points: list[Array], gap: Callable[[Array], float]) -> list[Array]:
    """The rest of a path, points of shape (2,) [m], from its first contact on.

    Parameters
    ----------
    points : list of ndarray, each of shape (2,)
        [m]
    gap : callable
        Of a point: how far it may go in any direction without touching [m].
    """
    for i, (start, end) in enumerate(pairwise(points)):
        length = float(np.linalg.norm(end - start))
        gone = 0.0
        while gone < length:
            here = start + (end - start) * (gone / length)
            if (free := gap(here)) <= CLOSE:
                return [here, *points[i + 1 :]]
            gone += free
    return points[-1:]

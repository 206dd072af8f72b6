r"""The same step by other laws: by Coulomb's, slowly, and in the round cone.

What a step's own forces say of equilibrium is spoilt by two artifacts of the model: what slides has
risen (the boundary layer), and inertia bears a part of the load (the drag M_u delta_q_u / h^2). So
the state, targets, loads and contacts of a step are kept, bodies come down from their layers, and
the step is solved once more. By Coulomb's law nothing rises: phi + s takes the place of phi, s
being the norm of a contact's own slip. With T >> h in the place of h the drag of a motion that is
asked for, d, is M_u d / T^2, and vanishes. What remains,

.. math:: r = -M_u\,\delta q_u / T^2,

is what no forces of Coulomb's law bear: minus the mass times the acceleration with which bodies
start. Loads are balanced where r falls faster than 1/T. The step is straight, so T grows no further
than until a contact moves by a tenth of its shape.

Only a converged s is a fixed point. T climbs from h by factors of three, so that s starts near its
own: what slides freely goes with T^2. Answers of floats lead there, and proved ones confirm the
last two T, unless nothing slips: without a slip the step is the convex one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.plain import field_values
from quasistatic_ref.numbers.arrays import Array, Indices, Mask, read_only
from quasistatic_ref.optional.doctor.artifacts import gives
from quasistatic_ref.optional.fixed_point import Iterate, fixed_point
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.contacts import Contacts
from quasistatic_ref.step.data import Extra, StepData
from quasistatic_ref.step.friction import frame_jacobian, slip_norm

SLOWLY = 10.0
"""T [s], or a thousand h if that is more: what nothing bears falls by 500 m."""
LITTLE = 1e-3
"""Force that is none, over a body's own load [-]."""
STRAIGHT = 0.1
"""Motion of a contact over the smaller shape [-], or its spin [rad], of a straight step."""
STICKS = 1e-9
"""Slip that is none, over the size of the smaller shape [-], or spin [rad]."""
CLOSE = {"floats": 1e-9, "proved": 1e-10, "round": 1e-6}
"""Residual of s over the longest motion of a contact, by how answers are found [-]."""
CREEPS = 1e-5, 1e-3
"""The same of a proved answer whose s creeps on, and what the stiffest spring then adds to the
largest force [-]. It is that of a scene whose gaps are off by the residual, a millionth of a shape
at most, so that loads are balanced in both or in neither. Forces may be one of many: where what is
pushed sticks to what pushes it, its friction may be any, and more or less load slides."""
NEARLY = 1e-4
"""Residual of s over the largest, from which on proved answers take it on [-]."""
NOISE = 1e-12
"""Slip that floats leave where a contact sticks [m]."""
MOST = {"floats": 60, "proved": 8, "round": 40}
"""Their iterates after which no fixed point is expected."""
AGREES = 0.01
"""Change of r that is none, where no T beyond it has a fixed point [-]."""
FEW = 16
"""Of floats, where s is not predicted by a smaller T."""
CUTS, ROUND = 20, 1e-8
"""Rounds of tangents to a round cone, and the part of a slip that they may leave [-]."""


class Answer(NamedTuple):
    """A step's optimum.

    Parameters
    ----------
    delta_q : ndarray, shape (n_v,)
    forces : ndarray, shape (n_c, 4)
        Along d1, d2 and n, and about n [N, N m].
    creeps : bool
        Whether these are one of many.
    """

    delta_q: Array
    forces: Array
    creeps: bool = False


class Solvers:
    """Solvers of steps of several kinds, which are kept.

    Attributes
    ----------
    proved : int
        Number of steps that were proved.
    """

    def __init__(self) -> None:
        self.proved = 0
        self._kept: list[Solver] = []

    def __call__(self, step: StepData, *, proved: bool, tangents: Tangents | None = None) -> Answer:
        """The optimum of a step, which a proof confirms or floats alone name.

        In a round cone there is no proof.

        QuasistaticError if there is none.
        """
        if not cone(step.cone).polyhedral:
            return self._round(step, tangents or Tangents(step.contacts.mu))
        self.proved += proved
        solution = solve_step(step, self._solver(step), certify="full" if proved else "off")
        return Answer(solution.delta_q, solution.wrench)

    def _solver(self, step: StepData) -> Solver:
        for solver in self._kept:
            if solver.fits(step):
                return solver
        try:
            solver = solver_for(step, fast=True)
        except InputError:  # no optional/fast
            solver = solver_for(step)
        self._kept = [solver, *self._kept[:7]]
        return solver

    def _round(self, step: StepData, tangents: Tangents) -> Answer:
        """The optimum in the ellipsoid, whose rows are tangents where contacts slip."""
        contacts = step.contacts
        J_n, *J_t = frame_jacobian(contacts, contacts.J)
        slips = contacts.mu[:, :, None] * np.stack(J_t, axis=1)
        own = len(step.extra.names)
        for _ in range(CUTS):
            at = tangents.at
            u = tangents.u
            extra = replace(
                step.extra,
                names=(*step.extra.names, *(f"tangent {i}" for i in range(len(at)))),
                A=np.vstack([step.extra.A, J_n[at] - np.einsum("ri,riv->rv", u, slips[at])]),
                b=np.concatenate([step.extra.b, -contacts.phi[at]]),
            )
            cut = step.replace(cone="frictionless", extra=extra)
            solution = solve_step(cut, self._solver(cut), certify="off")
            slip = slips @ solution.delta_q
            norm = np.linalg.norm(slip, axis=1)
            gap = contacts.phi + J_n @ solution.delta_q
            pushes = solution.lam_extra[own:] / step.h
            new = np.flatnonzero((norm > 0) & (norm - gap > ROUND * norm.max(initial=0.0)))
            kept = tangents.basic | (pushes > 0)
            tangents.at = np.concatenate([at[kept], new])
            tangents.u = np.vstack([u[kept], slip[new] / norm[new, None]])
            tangents.basic = np.pad(tangents.basic[kept], (0, len(new)))
            if not new.size:
                break
        forces = np.array(solution.wrench)
        np.add.at(forces[:, 2], at, pushes)
        for i, column in enumerate((0, 1, 3)):
            np.add.at(forces[:, column], at, -u[:, i] * pushes)
        forces[:, [0, 1, 3]] *= contacts.mu
        return Answer(solution.delta_q, forces)


class Tangents:
    """Rows that touch the round cones of contacts.

    Parameters
    ----------
    mu : ndarray, shape (n_c, 3)

    Attributes
    ----------
    at : ndarray of int, shape (k,)
        Contact of each.
    u : ndarray, shape (k, 3)
        Where it touches: gap >= u . (mu_v slip_1, mu_v slip_2, mu_omega spin) [-].
    basic : ndarray of bool, shape (k,)
        Whether it is one of those along the axes, which stay.
    """

    def __init__(self, mu: Array) -> None:
        contact, axis = np.nonzero(mu > 0)
        units = np.eye(3)[axis]
        self.at = np.concatenate([contact, contact])
        self.u = np.concatenate([units, -units])
        self.basic = np.ones(len(self.at), dtype=bool)


def slip_of(step: StepData, delta_q: Array) -> Array:
    """The norm of each contact's slip by delta_q, shape (n_v,), in the step's cone, (n_c,) [m]."""
    _, *J_t = frame_jacobian(step.contacts, step.contacts.J)
    scaled = step.contacts.mu * np.stack([J @ delta_q for J in J_t], axis=1)
    if not cone(step.cone).polyhedral:
        return np.asarray(np.linalg.norm(scaled, axis=1))
    return slip_norm(scaled, step.cone)


def by_coulomb(
    step: StepData, solvers: Solvers, start: Array, *, proved: bool, most: int | None = None
) -> Iterate[Answer]:
    """The step by Coulomb's law: phi is raised by the slip that comes of it.

    The iteration starts at start, shape (n_c,) [m], and has at most as many iterates.
    """
    J = np.abs(step.contacts.J)
    mu = step.contacts.mu
    tangents = Tangents(mu)
    kind = "proved" if proved else "floats"
    if not cone(step.cone).polyhedral:
        kind = "round"
    soft = gives(step)
    stiffness = (1 / soft[soft > 0]).max(initial=0.0)

    before = np.inf

    def at(s: Array) -> Iterate[Answer]:
        nonlocal before
        answer = solvers(_raised(step, s), proved=proved, tangents=tangents)
        slip = slip_of(step, answer.delta_q)
        moves = J @ np.abs(answer.delta_q)
        longest = (mu[:, 0] * moves[:, :3].sum(axis=1) + mu[:, 2] * moves[:, 3]).max(initial=0.0)
        residual = np.abs(slip - s).max(initial=0.0)
        limit = CLOSE[kind] * longest if proved else max(CLOSE[kind] * longest, NOISE)
        presses = answer.forces[:, 2].max(initial=0.0)
        slight = residual <= CREEPS[0] * longest and stiffness * residual <= CREEPS[1] * presses
        creeps = bool(proved and residual > limit and slight and residual > before / 2)
        before = residual
        converged = creeps or bool(residual <= limit)
        return Iterate(s, slip, residual, converged, answer._replace(creeps=creeps))

    found, _ = fixed_point(at, start, most or MOST[kind], leaps=True)
    return found


def _raised(step: StepData, s: Array) -> StepData:
    """A step with phi + s, shape (n_c,) [m], in the place of phi: nothing else of it changes."""
    contacts = step.contacts
    phi = read_only(contacts.phi + s)
    raised = Contacts.unchecked(**(field_values(contacts) | {"phi": phi}))
    return StepData.unchecked(**(field_values(step) | {"contacts": raised}))


class Rung(NamedTuple):
    """The step by Coulomb's law at one T.

    Parameters
    ----------
    T : float
        [s]
    answer : Answer
    s : ndarray, shape (n_c,)
        [m]
    moves : float
        The longest motion of a contact, over what is straight [-].
    """

    T: float
    answer: Answer
    s: Array
    moves: float


@dataclass(frozen=True, eq=False)
class Climb:
    """What came of a step that was taken more and more slowly.

    Parameters
    ----------
    rungs : list of Rung
        At most the last two T that have a fixed point.
    open : bool
        Whether they do not say how it goes on.
    """

    rungs: list[Rung]
    open: bool


def rung(step: StepData, T: float, solvers: Solvers, sizes: Array, start: Array) -> Rung | None:
    """The step by Coulomb's law at T [s], from floats; None where no fixed point is found.

    The iteration starts at start [m], and shapes have sizes [m], each of shape (n_c,).
    """
    at = by_coulomb(step.replace(h=T), solvers, start, proved=False)
    nearly = at.residual <= NEARLY * at.s.max(initial=0.0)
    if nearly and not at.converged and cone(step.cone).polyhedral:
        at = by_coulomb(step.replace(h=T), solvers, at.image, proved=True)
    return _rung(step, T, sizes, at)


def _rung(step: StepData, T: float, sizes: Array, at: Iterate[Answer]) -> Rung | None:
    if not at.converged:
        return None
    return Rung(T, at.of, at.image, _moves(step, at.of.delta_q, sizes))


def climb(step: StepData, solvers: Solvers, sizes: Array, first: Rung | None) -> Climb:
    """A step taken more and more slowly.

    Parameters
    ----------
    step : StepData
        Of one group.
    solvers : Solvers
    sizes : ndarray, shape (n_c,)
        Of the smaller shapes of its contacts [m].
    first : Rung or None
        The step by Coulomb's law at h.
    """
    end = max(SLOWLY, 1000 * step.h)
    nothing = np.zeros(step.contacts.n_c)
    s = nothing if first is None else first.s
    ends: list[Rung] = []
    for T in (end, end / 3):  # where targets alone move bodies, s is that of h
        at = by_coulomb(step.replace(h=T), solvers, s, proved=False, most=FEW)
        far = _rung(step, T, sizes, at)
        if far is None or far.moves > 1:
            break
        ends.insert(0, far)
        s = far.s
    if len(ends) == 2:
        if all(_sticks(one, sizes) for one in ends):
            return Climb(ends, False)
        climbed = _confirmed(step, solvers, sizes, ends, False)
        if not climbed.open:
            return climbed
    kept = [] if first is None else [first]
    straight = max(1.0, 2 * first.moves) if first else 1.0  # what moves far at h is asked for
    T = step.h
    lost = first is None
    while end > T:
        T = min(3 * T, end)
        found = rung(step, T, solvers, sizes, _ahead(kept, nothing))
        if found is None:
            lost = bool(kept)
            if lost:
                break
            continue
        lost = False
        if found.moves > straight and kept:
            T = _until(kept[-1], found, straight)
            found = rung(step, T, solvers, sizes, kept[-1].s) if T > 1.2 * kept[-1].T else None
            kept += [] if found is None else [found]
            break
        kept.append(found)
    return _confirmed(step, solvers, sizes, kept, lost)


def _ahead(kept: list[Rung], nothing: Array) -> Array:
    """Where the last two s lead."""
    if len(kept) < 2:
        return kept[-1].s if kept else nothing
    with np.errstate(all="ignore"):
        grows = np.nan_to_num(kept[-1].s / kept[-2].s, nan=1.0, posinf=9.0)
    return np.asarray(kept[-1].s * np.clip(grows, 0.0, 9.0))


def _until(one: Rung, other: Rung, straight: float) -> float:
    """T [s] at which motions that go with T^2 from one to the other are as long as is straight."""
    grows = (other.moves - one.moves) / (other.T**2 - one.T**2)
    return float(np.sqrt(one.T**2 + (straight - one.moves) / grows)) if grows > 0 else 0.0


def _confirmed(
    step: StepData, solvers: Solvers, sizes: Array, kept: list[Rung], lost: bool
) -> Climb:
    """The last two rungs that proved answers confirm."""
    sure: list[Rung] = []
    for one in kept[::-1]:
        if not _sticks(one, sizes):
            at = by_coulomb(step.replace(h=one.T), solvers, one.s, proved=True)
            proved = _rung(step, one.T, sizes, at)
            if proved is None:
                if lost:
                    break
                lost = True
                continue
            one = proved
        sure.insert(0, one)
        if len(sure) == 2:
            break
    if len(sure) < 2:
        return Climb(sure, True)
    if not lost:
        return Climb(sure, False)
    a, b = (x.answer.delta_q[step.n_a :] / x.T**2 for x in sure)
    off = np.sqrt((a - b) @ step.M_u @ (a - b))
    agrees = bool(off <= AGREES * np.sqrt(b @ step.M_u @ b))
    return Climb(sure, not agrees)


def _sticks(one: Rung, sizes: Array) -> bool:
    return bool((one.s <= STICKS * sizes).all())


def _moves(step: StepData, delta_q: Array, sizes: Array) -> float:
    """The longest motion of a contact of a step, over what is straight [-]."""
    motion = step.contacts.motion(delta_q)
    way = np.linalg.norm(motion[:, :3], axis=1) / sizes
    return float(np.maximum(way, np.abs(motion[:, 3])).max(initial=0.0) / STRAIGHT)


def landed(step: StepData, presses: Mask, delta_q: Array) -> StepData:
    """A step from where its bodies have come down from their layers, by the shortest way.

    Springs follow, what sticks in the run sticks, and nothing rubs: by Coulomb's law none rose.

    Parameters
    ----------
    step : StepData
    presses : ndarray of bool, shape (n_c,)
        Contacts that press in the run.
    delta_q : ndarray, shape (n_v,)
        The run's.
    """
    contacts = step.contacts
    if not (presses & (contacts.phi != 0)).any():
        return step
    J_n, *J_t = frame_jacobian(contacts, contacts.J)
    slips = np.hypot(*(J @ delta_q for J in J_t[:2]))
    sticks = presses & (slips <= STICKS)
    root = np.linalg.inv(np.linalg.cholesky(step.H)).T
    rows = np.vstack([1e3 * J_n[presses], *(J[sticks] for J in J_t[:2])])  # gaps first
    gaps = np.concatenate([-1e3 * contacts.phi[presses], np.zeros(2 * int(sticks.sum()))])
    down = root @ np.linalg.lstsq(rows @ root, gaps, rcond=1e-9)[0]
    extra: Extra = replace(step.extra, b=step.extra.b - step.extra.A @ down)
    return step.replace(
        contacts=contacts.raised(J_n @ down),
        delta_q_bar_a=step.delta_q_bar_a - down[: step.n_a],
        extra=extra,
    )


def missing(step: StepData, climbed: Climb, coordinates: Indices) -> Array:
    """What no forces bear of the loads on some un-actuated coordinates, shape (n,) [N, N m].

    Of a step that ends where it is no longer straight, what goes with 1/T^2 is left out.
    """
    one, other = climbed.rungs
    r_1, r_2 = (
        -(step.M_u @ x.answer.delta_q[step.n_a :])[coordinates] / x.T**2 for x in climbed.rungs
    )
    M = step.M_u[np.ix_(coordinates, coordinates)]
    left = (other.T**2 * r_2 - one.T**2 * r_1) / (other.T**2 - one.T**2)
    size_1, size_2, size_left, change = (
        float(np.sqrt(r @ np.linalg.solve(M, r))) for r in (r_1, r_2, left, r_2 - r_1)
    )
    ends = max(SLOWLY, 1000 * step.h) * (1 - 1e-9) <= other.T
    if size_2 * other.T >= size_1 * one.T:  # it does not fall
        return r_2 if ends or change > size_2 / 2 else np.asarray(left)
    nothing = ends or size_left <= STRAIGHT * size_2
    return np.zeros_like(r_2) if nothing else np.asarray(left)

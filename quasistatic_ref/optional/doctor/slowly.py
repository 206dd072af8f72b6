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

from functools import cached_property
from typing import NamedTuple

import numpy as np

from quasistatic_ref.certify.failures import StepNotSolved
from quasistatic_ref.numbers.arrays import Array, Indices, Mask, read_only, without_warnings
from quasistatic_ref.optional.doctor.artifacts import gives
from quasistatic_ref.optional.fixed_point import Iterate, fixed_point
from quasistatic_ref.optional.friction import slip_norm
from quasistatic_ref.parts import is_there
from quasistatic_ref.solve.choice import solver_for
from quasistatic_ref.solve.solve import solve_step
from quasistatic_ref.solve.solver import Solver
from quasistatic_ref.solve.units import ScaledStep, in_si
from quasistatic_ref.step.cones import ELLIPSOID, cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.friction import contact_wrenches, frame_jacobian
from quasistatic_ref.step.units import Units
from quasistatic_ref.tolerances import ACCURACY

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
ROUNDS = 2.0**12
"""Number that rounds what is added to it, a part of the size of its kind, to 1e-12 [-]."""
LARGE = 10_000
"""Entries of J, 4 n_c n_v, of a group whose proof counts as two; twice as many as three."""
CUTS, ROUND = 20, 1e-8
"""Rounds of tangents to a round cone, and the part of a slip that they may leave [-]."""


class Answer(NamedTuple):
    """A step's optimum.

    Parameters
    ----------
    delta_q : ndarray, shape (n_v,)
    forces : ndarray, shape (n_c, 4)
        Along d1, d2 and n, and about n [N, N m].
    proved : bool
    creeps : bool
        Whether these are one of many.
    """

    delta_q: Array
    forces: Array
    proved: bool = False
    creeps: bool = False


class Solvers:
    """Solvers of steps of several kinds, which are kept.

    Attributes
    ----------
    proved : int
        Number of steps that were proved, where a large group counts as several.
    """

    def __init__(self) -> None:
        self.proved = 0
        self._kept: list[Solver] = []

    def by_floats(self, step: StepData, units: Units) -> tuple[Array, Array]:
        """delta_q, (n_v,), and lam, (m,), of a step in some units, by a backend's word alone.

        StepNotSolved, or another QuasistaticError, if there are none.
        """
        scaled = ScaledStep(step, units)
        solver = self._solver(step)
        reply = solver.answer(scaled, ACCURACY)
        if not reply.solved:
            raise StepNotSolved(solver.name, reply.status, step, reply.accuracy)
        return in_si(*reply.answer, units)

    def by_proof(self, step: StepData) -> Answer:
        """The optimum of a step, which a proof confirms; QuasistaticError if there is none."""
        self.proved += 1 + step.contacts.J.size // LARGE
        solution = solve_step(step, self._solver(step))
        return Answer(solution.delta_q, solution.wrench, True)

    def _solver(self, step: StepData) -> Solver:
        for solver in self._kept:
            if solver.fits(step):
                return solver
        solver = solver_for(step, fast=is_there("fast"))
        self._kept = [solver, *self._kept[:7]]
        return solver


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


class Slow:
    """A step of one group at any T, by its own law and by Coulomb's.

    Parameters
    ----------
    step : StepData
    solvers : Solvers
    sizes : ndarray, shape (n_c,)
        Of the smaller shapes of its contacts [m].
    """

    def __init__(self, step: StepData, solvers: Solvers, sizes: Array) -> None:
        contacts = step.contacts
        self.step = step
        self.solvers = solvers
        self.sizes = sizes
        self._J_n, *J_t = frame_jacobian(contacts, contacts.J)
        self._slips = contacts.mu[:, :, None] * np.stack(J_t, axis=1)
        self._polyhedral = cone(step.cone).polyhedral
        self._of_T = ScaledStep(step)
        of, axis = np.nonzero(contacts.mu > 0)
        u = np.eye(3)[axis]
        self._axes = 2 * len(of)
        self._tangents = np.concatenate([of, of]), np.concatenate([u, -u])

    def answer(self, T: float, s: Array | None = None, proved: bool = False) -> Answer:
        """The step with T [s] in the place of h and phi + s, (n_c,) [m], in that of phi.

        A proof confirms it, or floats alone name it. In a round cone there is no proof.

        QuasistaticError if there is none.
        """
        return without_warnings(self._answer, T, s, proved)

    def _answer(self, T: float, s: Array | None, proved: bool) -> Answer:
        if self._of_T.step.h != T:
            self._of_T = ScaledStep(self.step.with_fields(h=T))
        step = self._of_T.step
        units = self._of_T.units
        if s is not None:
            phi = read_only(step.contacts.phi + s)
            step = step.with_fields(contacts=step.contacts.with_fields(phi=phi))
        if not self._polyhedral:
            return self._round(step, units)
        if proved:
            return self.solvers.by_proof(step)
        delta_q, lam = self.solvers.by_floats(step, units)
        of_contacts = lam[: step.offsets[-1]]
        return Answer(delta_q, contact_wrenches(step.contacts, of_contacts, T, step.cone))

    def _round(self, step: StepData, units: Units) -> Answer:
        """The optimum in the ellipsoid, whose rows are tangents where contacts slip.

        Each has a contact, `at`, and a direction u: gap >= u . (mu_v slip_1, mu_v slip_2, mu_omega
        spin). Those along the axes stay, others while they press.
        """
        contacts = step.contacts
        of_user = len(step.extra.names)
        at, u = self._tangents
        for _ in range(CUTS):
            extra = step.extra.with_fields(
                names=(*step.extra.names, *("tangent",) * len(at)),
                A=np.vstack(
                    [step.extra.A, self._J_n[at] - np.einsum("ri,riv->rv", u, self._slips[at])]
                ),
                b=np.concatenate([step.extra.b, -contacts.phi[at]]),
            )
            cut = step.with_fields(cone="frictionless", extra=extra)
            delta_q, lam = self.solvers.by_floats(cut, units)
            slip = self._slips @ delta_q
            norm = np.linalg.norm(slip, axis=1)
            gap = contacts.phi + self._J_n @ delta_q
            pushes = lam[contacts.n_c + of_user :] / step.h
            pressed = at, u
            new = np.flatnonzero((norm > 0) & (norm - gap > ROUND * norm.max(initial=0.0)))
            kept = (pushes > 0) | (np.arange(len(at)) < self._axes)
            at = np.concatenate([at[kept], new])
            u = np.vstack([u[kept], slip[new] / norm[new, None]])
            if not new.size:
                break
        self._tangents = at, u
        at, u = pressed
        forces = np.zeros((contacts.n_c, 4))
        forces[:, 2] = lam[: contacts.n_c] / step.h
        np.add.at(forces, at, pushes[:, None] * np.insert(-u, 2, 1.0, axis=1))
        forces[:, [0, 1, 3]] *= contacts.mu
        return Answer(delta_q, forces)

    def _by_coulomb(
        self, T: float, start: Array, proved: bool = False, most: int | None = None
    ) -> Iterate[Answer]:
        """The step by Coulomb's law at T [s]: phi is raised by the slip that comes of it.

        The iteration starts at start, shape (n_c,) [m], and has at most as many iterates.
        """
        contacts = self.step.contacts
        J = np.abs(contacts.J)
        mu = contacts.mu
        kind = ("proved" if proved else "floats") if self._polyhedral else "round"
        (soft,) = gives([self.step])
        stiffness = (1 / soft[soft > 0]).max(initial=0.0)
        before = np.inf

        def at(s: Array) -> Iterate[Answer]:
            nonlocal before
            answer = self.answer(T, s, proved)
            slip = slip_norm(self._slips @ answer.delta_q, self.step.cone)
            moves = J @ np.abs(answer.delta_q)
            ways = mu[:, 0] * moves[:, :3].sum(axis=1) + mu[:, 2] * moves[:, 3]
            longest = ways.max(initial=0.0)
            residual = np.abs(slip - s).max(initial=0.0)
            limit = CLOSE[kind] * longest if proved else max(CLOSE[kind] * longest, NOISE)
            presses = answer.forces[:, 2].max(initial=0.0)
            slight = residual <= CREEPS[0] * longest and stiffness * residual <= CREEPS[1] * presses
            creeps = bool(proved and residual > limit and slight and residual > before / 2)
            before = residual
            converged = creeps or bool(residual <= limit)
            return Iterate(s, slip, residual, converged, answer._replace(creeps=creeps))

        last, _ = fixed_point(at, start, most or MOST[kind], leaps=True)
        return last

    def rung(self, T: float, start: Array, *, sure: bool = True) -> Rung | None:
        """The step by Coulomb's law at T [s], from floats; None where no fixed point is found.

        The iteration starts at start, shape (n_c,) [m]. Where floats come near to one, proved
        answers lead to it, unless it has to be no surer.
        """
        at = self._by_coulomb(T, start)
        nearly = at.residual <= NEARLY * at.s.max(initial=0.0)
        if nearly and not at.converged and self._polyhedral:
            at = self._by_coulomb(T, at.image, proved=True) if sure else at._replace(converged=True)
        return self._rung(T, at)

    def _rung(self, T: float, at: Iterate[Answer]) -> Rung | None:
        if not at.converged:
            return None
        motion = self.step.contacts.motion(at.of.delta_q)
        way = np.linalg.norm(motion[:, :3], axis=1) / self.sizes
        moves = np.maximum(way, np.abs(motion[:, 3])).max(initial=0.0)
        return Rung(T, at.of, at.image, float(moves) / STRAIGHT)

    @cached_property
    def first(self) -> Rung | None:
        """The step by Coulomb's law at h."""
        return self.rung(self.step.h, np.zeros_like(self.sizes))

    @cached_property
    def climbed(self) -> list[Rung] | None:
        """The last two T that have a fixed point, of a step that is taken more and more slowly.

        None where they do not say how it goes on.
        """
        h = self.step.h
        first = self.first
        end = max(SLOWLY, 1000 * h)
        nothing = np.zeros_like(self.sizes)
        s = nothing if first is None else first.s
        ends: list[Rung] = []
        for T in (end, end / 3):  # where targets alone move bodies, s is that of h
            far = self._rung(T, self._by_coulomb(T, s, most=FEW))
            if far is None or far.moves > 1:
                break
            ends.insert(0, far)
            s = far.s
        if len(ends) == 2:
            confirmed = ends if all(map(self.sticks, ends)) else self._confirmed(ends, False)
            if confirmed:
                return confirmed
        kept = [] if first is None else [first]
        straight = max(1.0, 2 * first.moves) if first else 1.0  # what moves far at h is asked for
        T = h
        lost = False
        while end > T and not lost:
            T = min(3 * T, end)
            reached = self.rung(T, _ahead(kept, nothing), sure=False)
            if reached is None:
                lost = bool(kept)
            elif reached.moves > straight and kept:
                T = _until(kept[-1], reached, straight)
                reached = self.rung(T, kept[-1].s, sure=False) if T > 1.2 * kept[-1].T else None
                kept += [] if reached is None else [reached]
                break
            else:
                kept.append(reached)
        return self._confirmed(kept, lost)

    def _confirmed(self, kept: list[Rung], lost: bool) -> list[Rung] | None:
        """The last two rungs that proved answers confirm; where a later one is lost, they agree."""
        sure: list[Rung] = []
        for one in kept[::-1]:
            if not (one.answer.proved or self.sticks(one)):
                proved = self._rung(one.T, self._by_coulomb(one.T, one.s, proved=True))
                if proved is None:
                    if lost:
                        break
                    lost = True
                    continue
                one = proved
            sure.insert(0, one)
            if len(sure) == 2:
                break
        if len(sure) < 2 or not lost:
            return sure if len(sure) == 2 else None
        a, b = (x.answer.delta_q[self.step.n_a :] / x.T**2 for x in sure)
        off = np.sqrt((a - b) @ self.step.M_u @ (a - b))
        return sure if off <= AGREES * np.sqrt(b @ self.step.M_u @ b) else None

    def sticks(self, one: Rung) -> bool:
        """Whether nothing slips."""
        return bool((one.s <= STICKS * self.sizes).all())

    @cached_property
    def in_round(self) -> list[Rung] | None:
        """The same T in the round cone; None where one of them has no fixed point there."""
        slow = Slow(self.step.with_fields(cone=ELLIPSOID), self.solvers, self.sizes)
        rungs = [slow.rung(one.T, one.s) for one in self.climbed or ()]
        confirmed = [one for one in rungs if one is not None]
        return confirmed if len(confirmed) == len(rungs) else None


def alike(step: StepData, sizes: Array) -> bytes:
    """What steps of groups have in common whose answers are the same, up to rounding.

    Parameters
    ----------
    step : StepData
    sizes : ndarray, shape (n_c,)
        Of the smaller shapes of its contacts [m].
    """
    c = step.contacts
    extra = step.extra
    lengths = np.concatenate([step.delta_q_bar_a, c.phi, extra.b, sizes])
    loads = np.concatenate([step.tau_a, step.tau_u, [step.h]])
    data = (lengths, loads, step.K_q, step.M_u, c.n, c.d1, c.J, c.mu, extra.A, *(extra.cost or ()))
    powers = [2.0 ** np.frexp(np.abs(a).max(initial=0.0))[1] for a in data]
    rounded = [a / power + ROUNDS for a, power in zip(data, powers, strict=True)]
    return b"".join(a.tobytes() for a in (np.array(powers), *rounded))


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
    extra = step.extra.with_fields(b=step.extra.b - step.extra.A @ down)
    return step.replace(
        contacts=contacts.raised(J_n @ down),
        delta_q_bar_a=step.delta_q_bar_a - down[: step.n_a],
        extra=extra,
    )


def missing(step: StepData, rungs: list[Rung], coordinates: Indices) -> Array:
    """What no forces bear of the loads on some un-actuated coordinates, shape (n,) [N, N m].

    Of a step that ends where it is no longer straight, what goes with 1/T^2 is left out.
    """
    one, other = rungs
    r_1, r_2 = (-(step.M_u @ x.answer.delta_q[step.n_a :])[coordinates] / x.T**2 for x in rungs)
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

r"""Contact forces with one answer: those of the same step in which each contact gives way a little.

Optimal multipliers are not unique: four feet of a rigid block share its weight in many ways. With a
compliance c [m/N] at each contact there is one way. A contact's gap, slips and spin after the step
are four lengths z = B delta_q + (phi, 0, 0, 0), which its friction cone confines to a cone K. In
the step with compliance a private displacement s of four lengths is added to z, and \|s\|^2 / (2c)
to the energy:

.. math:: z + s \in K, \qquad p = s / c = (f_n, f_1/\mu_v, f_2/\mu_v, \tau_n/\mu_\omega) \in F.

F is the cone of the forces: what multipliers >= 0 of the rows of K combine to. This is a step again
(:func:`compliant_form`), in which s is un-actuated and has the inertia h^2 / c. Without s, it is a
step without contact rows, in which each contact pushes with the point of F nearest to -z:

.. math:: c\,p_j = \Pi_F(-z_j), \qquad H \delta q - g = h \sum_j B_j^T p_j.

On a face of F the nearest point is linear in z. Once the face of each contact is known, delta_q
solves a linear system. Newton's method guesses the faces in float64; that they are right is decided
by exact signs; and the forces of the exact solution are rounded correctly.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from math import lcm
from typing import Any, Final, NamedTuple

import numpy as np
from flint import fmpq, fmpq_mat

from quasistatic_ref.certify.active_set import Farkas, dual_active_set
from quasistatic_ref.certify.exact import nearest_numbers
from quasistatic_ref.certify.farkas import farkas_vector
from quasistatic_ref.certify.point import Point, ball_form
from quasistatic_ref.certify.rational import (
    Dyadic,
    ExactForm,
    block_diagonal,
    contact_motion,
    dyadic,
    exact_form,
    fraction,
    friction_rows,
    h_times_hessian,
    h_times_load,
    in_integers,
    joined,
    two_to,
)
from quasistatic_ref.errors import InputError, StepInfeasible
from quasistatic_ref.step.arrays import QUIET, Mask, finite, read_only
from quasistatic_ref.step.cones import CurvedCone, cone
from quasistatic_ref.step.data import Array, Contacts, StepData
from quasistatic_ref.step.friction import frame_jacobian, row_gaps
from quasistatic_ref.step.standard_form import load
from quasistatic_ref.tolerances import COMPLIANCE

GUESSES: Final = 30
"""Newton iterations in float64, at most."""
PROOFS: Final = 30
"""Newton iterations in exact numbers, at most: after them the step is solved as it is defined."""
STIFF: Final = 2.0**10
"""How much stiffer than a contact a user's row is in the guess. In the proof it is rigid."""
ROUNDING: Final = 2.0**-50
"""Of a sum of a few products in float64, relative to the sum of their sizes [-]."""
DESCENT: Final = 1e-4
"""Share of the descent that the slope promises with which a guess is content (Armijo)."""
LEAST: Final = 2.0**-30
"""Shortest part of a Newton step."""
WRENCH, P_OF_WRENCH = [1, 2, 0, 3], [2, 0, 1, 3]
"""Where (f_d1, f_d2, f_n, tau_n) stand in p, and p in these."""

Rows = tuple[int, ...]
"""The face of a contact: independent rows of its cone, whose combinations it is."""


@dataclass(frozen=True, eq=False)
class ContactForces:
    """The forces of a step's contacts.

    Parameters
    ----------
    wrench : ndarray, shape (n_c, 4)
        (f_d1, f_d2, f_n, tau_n) on beta's body [N, N m].
    delta_q : ndarray, shape (n_v,)
        Where the step with compliance ends [m, rad].
    """

    wrench: Array
    delta_q: Array

    def __post_init__(self) -> None:
        read_only(self.wrench)
        read_only(self.delta_q)


def contact_forces(
    step: StepData,
    compliance: float = COMPLIANCE,
    near: tuple[Array, Array] | None = None,
) -> ContactForces:
    """The forces of a step's contacts, each number rounded correctly.

    In the ellipsoid, whose forces are in general not rational, they are rounded from an enclosure.

    Parameters
    ----------
    step : StepData
    compliance : float
        Of each contact [m/N], > 0.
    near : (ndarray, ndarray), optional
        delta_q, shape (n_v,), and wrenches, shape (n_c, 4), of the step without compliance. They
        save time; the result does not depend on them.

    Returns
    -------
    ContactForces

    Raises
    ------
    InputError
        If the compliance is no positive number, or nothing can be proved in this thread.
    StepDataError
        If H, formed without rounding, is not positive definite.
    StepInfeasible
        If no displacement satisfies the user's own rows.
    """
    if not 0 < compliance < np.inf:
        problem = "must be a positive number of metres per newton"
        raise InputError(problem, field="compliance", value=compliance)
    kind = cone(step.cone)
    if isinstance(kind, CurvedCone):
        return kind.forces(step, compliance, near)
    faces, held = QUIET.copy().run(guessed_faces, step, compliance, near)
    proved = _proved(step, compliance, faces, held)
    return _defined(step, compliance) if proved is None else proved


def compliant_form(step: StepData, compliance: float) -> ExactForm:
    """The step with compliance: its coordinates are [delta_q; s], s of four lengths a contact [m].

    Parameters
    ----------
    step : StepData
        In a polyhedral cone.
    compliance : float
        [m/N].

    Returns
    -------
    ExactForm
        Rows as of :func:`~quasistatic_ref.certify.rational.exact_form`.
    """
    h, c, n_c = dyadic(step.h), dyadic(compliance), step.contacts.n_c
    # Eq. (13) with the energy |s|^2 / (2c), times h c
    H = block_diagonal(c * h_times_hessian(step), h * h * dyadic(np.eye(4 * n_c)))
    g = joined([c * h_times_load(step), dyadic(np.zeros(4 * n_c))])
    gives = np.zeros((n_c, *cone(step.cone).matrix.shape, n_c))
    gives[range(n_c), :, :, range(n_c)] = cone(step.cone).matrix
    gives = gives.transpose(0, 1, 3, 2)[step.mask].reshape(-1, 4 * n_c)
    of_contacts = friction_rows(step.contacts, step.cone)[step.mask]
    own = joined([dyadic(step.extra.A), dyadic(np.zeros((len(step.extra.b), 4 * n_c)))], axis=1)
    A = joined([joined([of_contacts, dyadic(gives)], axis=1), own])
    gaps = row_gaps(step.contacts, step.cone)[step.mask]
    b = joined([dyadic(-gaps), dyadic(step.extra.b)])
    return in_integers(H, g, A, b, fraction(step.h) * fraction(compliance))


def _defined(step: StepData, compliance: float) -> ContactForces:
    """The forces by the definition alone: every s is solved for."""
    form = compliant_form(step, compliance)
    end = dual_active_set(form)
    if isinstance(end, Farkas):
        raise StepInfeasible(step, farkas_vector(step, form, end))
    n, mu = step.n_v, scaled_by(step.contacts)
    units = [form.x_unit * fraction(m) / fraction(compliance) for m in mu.ravel().tolist()]
    units = [form.x_unit] * n + units
    numbers = nearest_numbers(
        end.point,
        lambda s: [u * v for u, v in zip(units, s.x, strict=True)],
        fmpq(1),
        range(form.n),
    )
    return ContactForces(numbers[n:].reshape(-1, 4)[:, WRENCH], numbers[:n])


def scaled_by(contacts: Contacts) -> Array:
    """(1, mu_v, mu_v, mu_omega) of each contact, shape (n_c, 4) [-, -, -, m]."""
    return np.concatenate([np.ones((contacts.n_c, 1)), contacts.mu], axis=1)


@dataclass(frozen=True, eq=False)
class Face:
    """A face of the cone of forces: where the point nearest to -z lies there, and where it is.

    Parameters
    ----------
    integers : ndarray of int, shape (R + 4, 4)
        Times z and over the denominator: R numbers that are >= 0 if the nearest point lies on this
        face (the multipliers of its rows, and the slacks of z + s in the others); and s.
    denominator : int
    floats : ndarray, shape (R + 4, 4)
        Their quotient.
    """

    integers: Any
    denominator: int
    floats: Array


@cache
def face(name: str, count: int, rows: Rows) -> Face:
    """The face that some independent rows of a cone span, of those that are its first `count`."""
    C = fmpq_mat(count, 4, [fraction(x) for x in cone(name).matrix[:count].ravel().tolist()])
    table = C.tolist()
    C_w = fmpq_mat(len(rows), 4, [x for i in rows for x in table[i]])
    multipliers = fmpq_mat(0, 4)
    if rows:
        multipliers = (C_w * C_w.transpose()).solve(-C_w)
    s = C_w.transpose() * multipliers
    conditions = (C + C * s).tolist()
    for i, multiplier in zip(rows, multipliers.tolist(), strict=True):
        conditions[i] = multiplier
    numerators, denominator = fmpq_mat(conditions + s.tolist()).numer_denom()
    integers = np.array([int(x) for x in numerators.entries()], dtype=object).reshape(-1, 4)
    floats = np.array([[float(fmpq(x) / denominator) for x in row] for row in numerators.tolist()])
    return Face(integers, int(denominator), floats)


@dataclass(frozen=True, eq=False)
class Candidate:
    """The optimum with compliance if the force of each contact lay on a given face.

    Parameters
    ----------
    point : Point
        The minimiser of a program in delta_q. Its rows are the conditions of the faces, contact by
        contact, then s times the coefficients of friction, then the user's own rows.
    own : int
        Where the user's own rows start.
    s_unit : fmpq
        s times the coefficients = s_unit * slack of its rows [m, m^2].
    """

    point: Point
    own: int
    s_unit: fmpq


class EliminatedStep:
    """The step with compliance in delta_q alone, without rounding.

    Parameters
    ----------
    step : StepData
        In a polyhedral cone.
    compliance : float
        [m/N].
    """

    def __init__(self, step: StepData, compliance: float) -> None:
        contacts, c = step.contacts, dyadic(compliance)
        self.step, self.h, self.compliance = step, dyadic(step.h), fraction(compliance)
        self.H, self.g = c * h_times_hessian(step), c * h_times_load(step)  # times h c
        self.mu = dyadic(scaled_by(contacts).reshape(-1, 1))
        mu = Dyadic(self.mu.m.reshape(-1, 4, 1), self.mu.e)
        gap = np.zeros((contacts.n_c, 4, 1))
        gap[:, 0, 0] = contacts.phi
        self.z = joined([mu * contact_motion(contacts), dyadic(gap)], axis=2)  # times [x; 1]
        self.own = joined([dyadic(step.extra.A), dyadic(-step.extra.b[:, None])], axis=1)

    def candidate(self, faces: Sequence[Rows], held: Sequence[int]) -> Candidate:
        """The optimum on the face of each contact; `held` are user's rows to start from.

        Raises
        ------
        StepInfeasible
            If no displacement satisfies the user's own rows.
        StepDataError
            If H, formed without rounding, is not positive definite.
        """
        step, n, z = self.step, self.step.n_v, self.z
        counts = step.counts.tolist()
        on = [face(step.cone, count, rows) for count, rows in zip(counts, faces, strict=True)]
        scale = lcm(*(f.denominator for f in on))
        linear = [(scale // f.denominator) * f.integers for f in on]
        of_z = [M @ z_j for M, z_j in zip(linear, z.m, strict=True)]
        conditions = Dyadic(np.concatenate([z.m[:0, 0], *(rows[:-4] for rows in of_z)]), z.e)
        s = Dyadic(np.concatenate([z.m[:0, 0], *(rows[-4:] for rows in of_z)]), z.e)
        B = Dyadic(z.m.reshape(-1, n + 1)[:, :n], z.e)
        # H x - g = h B'p with p = s / c, times h c and the scale
        push = self.h * self.h * (Dyadic(B.m.T, B.e) @ s)
        H = Dyadic(scale * self.H.m, self.H.e) - push[:, :n]
        g = Dyadic(scale * self.g.m, self.g.e) + push[:, n]
        rows = joined([conditions, self.mu * s, self.own])
        form = in_integers(H, g, rows[:, :n], -rows[:, n], fmpq(1))
        first_own = len(conditions.m) + len(s.m)
        working: tuple[int, ...] = ()
        if first_own < form.m:
            under = in_integers(H, g, self.own[:, :n], -self.own[:, n], fmpq(1))
            working = tuple(first_own + i for i in self._active(under, held))
        return Candidate(Point(form, ball_form(form), working), first_own, form.slack_unit / scale)

    def _active(self, under: ExactForm, held: Sequence[int]) -> tuple[int, ...]:
        """The working set of the user's own rows, which are those of a form."""
        end = dual_active_set(under, held)
        if not isinstance(end, Farkas):
            return end.point.working
        first = int(self.step.offsets[-1])
        proof = Farkas({first + i: y for i, y in end.y.items()})
        raise StepInfeasible(self.step, farkas_vector(self.step, exact_form(self.step), proof))

    def wrong_faces(self, found: Candidate) -> list[int]:
        """The contacts that break a condition of their face."""
        signs = np.array(found.point.decided_slack_signs[: self.step.offsets[-1]])
        broken = np.flatnonzero(signs < 0)
        return sorted({*(np.searchsorted(self.step.offsets, broken, side="right") - 1).tolist()})

    def motion(self, found: Candidate, j: int) -> list[fmpq]:
        """The z of a contact j [m], exact but for the 1e-90 of the balls in which it is."""
        unit = found.point.form.x_unit
        x = [unit * v for v in _coordinates(found.point)]
        terms = [*x, fmpq(1)]
        size = two_to(self.z.e)
        return [sum((size * b * v for b, v in zip(row, terms, strict=True)), fmpq(0))
                for row in self.z.m[j].tolist()]  # fmt: skip

    def forces(self, found: Candidate) -> ContactForces:
        """The forces of a candidate that is the optimum, rounded correctly."""
        point, n_c = found.point, self.step.contacts.n_c
        entries = range(found.own - 4 * n_c, found.own)
        p = nearest_numbers(point, lambda f: f.slack, found.s_unit / self.compliance, entries)
        x = nearest_numbers(point, lambda f: f.x, point.form.x_unit, range(self.step.n_v))
        return ContactForces(p.reshape(-1, 4)[:, WRENCH], x)


def _coordinates(point: Point) -> list[fmpq]:
    """The x of a point in its form's units: the midpoints of its balls, where there are any."""
    if point.balls is None:
        return [fmpq(v) / point.rational.denominator for v in point.rational.x]
    dyadics = [ball.mid().man_exp() for ball in point.balls.x]
    return [fmpq(m) * two_to(int(e)) for m, e in dyadics]


def _proved(
    step: StepData, compliance: float, faces: list[Rows], held: Sequence[int]
) -> ContactForces | None:
    """The forces, by Newton's method in exact numbers from some faces; None if it does not end."""
    program = EliminatedStep(step, compliance)
    for _ in range(PROOFS):
        found = program.candidate(faces, held)
        wrong = program.wrong_faces(found)
        if not wrong:
            return program.forces(found)
        for j in wrong:
            C = exact_numbers(cone(step.cone).matrix[: step.counts[j]])
            faces[j] = nearest_face(C, np.array(program.motion(found, j)), exact_multipliers)
    return None


def nearest_face(C: Any, z: Any, multipliers: Callable[[Any, Any], Any], zero: Any = 0) -> Rows:
    """The face on which the point nearest to -z lies, by the method of Lawson and Hanson (1974).

    Parameters
    ----------
    C : ndarray, shape (R, 4)
        Rows of the cone, in float64 or in fmpq, as z is.
    z : ndarray, shape (4,)
        [m].
    multipliers : callable
        (C_w, z) -> the lam that makes z + C_w' lam shortest, for independent rows C_w.
    zero : number
        Violations up to this are none [m].

    Returns
    -------
    tuple of int
        Independent rows, in increasing order.
    """
    lam = 0 * C[:, 0]
    rows: list[int] = []
    while len(rows) < 4:  # four independent rows: z + C'lam = 0
        violation = -(C @ (z + C.T @ lam))
        violation[rows] = zero
        most = int(np.argmax(violation))
        if not violation[most] > zero:
            break
        rows.append(most)
        new = multipliers(C[rows], z)
        while not (new > 0).all():
            falling = new <= 0
            old = lam[rows]
            share = min(old[falling] / (old[falling] - new[falling]))
            lam[rows] = old + share * (new - old)
            gone = [i for i, falls in zip(rows, falling, strict=True) if falls and lam[i] <= zero]
            lam[gone] = 0 * lam[gone]
            rows = [i for i in rows if i not in gone]
            new = multipliers(C[rows], z)
        lam[rows] = new
    return tuple(sorted(rows))


def exact_numbers(C: Array) -> Any:
    """The same numbers without rounding, as an array of fmpq of the same shape [-]."""
    return np.array([fraction(x) for x in C.ravel().tolist()], dtype=object).reshape(C.shape)


def exact_multipliers(C_w: Any, z: Any) -> Any:
    """The lam that makes z + C_w' lam shortest, in fmpq."""
    k = len(C_w)
    G = fmpq_mat(k, k, (C_w @ C_w.T).ravel().tolist())
    return np.array(G.solve(fmpq_mat(k, 1, (-(C_w @ z)).tolist())).entries(), dtype=object)


def float_multipliers(C_w: Array, z: Array) -> Array:
    """The same in float64."""
    return np.asarray(np.linalg.lstsq(C_w.T, -z)[0], dtype=np.float64)


class Place(NamedTuple):
    """A displacement, and what it means for the step with compliance.

    Parameters
    ----------
    x : ndarray, shape (n_v,)
        [m, rad].
    faces : list of tuple of int, length n_c
    s : ndarray, shape (n_c, 4, 4)
        s = S z on these faces [-].
    held : ndarray of bool
        Which of the user's own rows x breaks.
    energy : float
        The objective [N m s].
    gradient : ndarray, shape (n_v,)
        Of the objective [N s, N m s].
    settled : bool
        Whether faces and held are those from which Newton's method came to x.
    """

    x: Array
    faces: list[Rows]
    S: Array
    held: Mask
    energy: float
    gradient: Array
    settled: bool


class FloatStep:
    """The step with compliance in delta_q alone, in float64; a user's row gives way a little, too.

    Parameters
    ----------
    step : StepData
        In a polyhedral cone.
    compliance : float
        [m/N].
    """

    def __init__(self, step: StepData, compliance: float) -> None:
        contacts = step.contacts
        motion = np.stack(frame_jacobian(contacts, contacts.J), axis=1)
        self.step, self.compliance = step, compliance
        self.C, self.counts = cone(step.cone).matrix, step.counts.tolist()
        self.B = scaled_by(contacts)[:, :, None] * motion
        self.gap = np.zeros(self.B.shape[:2])
        self.gap[:, 0] = contacts.phi
        self.H, self.g = step.H, load(step)
        self.stiffness = step.h / compliance

    def place(
        self, x: Array, faces: Sequence[Rows], held: Mask, more: Array | float = 0.0
    ) -> Place:
        """Where x is, from faces that may be those of z + `more` [m]."""
        H, g, k, own = self.H, self.g, self.stiffness, self.step.extra
        z = self.B @ x + self.gap + more
        noise = ROUNDING * (np.abs(self.B) @ np.abs(x) + np.abs(self.gap) + np.abs(more))
        before, faces = faces, list(faces)
        wrong = [j for j, M in enumerate(self.linear(faces)) if outside(M[:-4], z[j], noise[j])]
        for j in wrong:
            C = self.C[: self.counts[j]]
            faces[j] = nearest_face(C, z[j], float_multipliers, 4 * float(noise[j].max()))
        S = np.array([M[-4:] for M in self.linear(faces)]).reshape(-1, 4, 4)
        s = np.einsum("cab,cb->ca", S, z)
        broken = np.minimum(own.A @ x - own.b, 0.0)
        energy = x @ H @ x / 2 - g @ x + k / 2 * (s.ravel() @ s.ravel() + STIFF * broken @ broken)
        push = np.einsum("cav,ca->v", self.B, s) - STIFF * broken @ own.A
        now = broken < 0
        settled = faces == before and bool((now == held).all())
        return Place(x, faces, S, now, float(energy), H @ x - g - k * push, settled)

    def linear(self, faces: Sequence[Rows]) -> list[Array]:
        """Of each contact the conditions of its face and s, times z."""
        return [
            face(self.step.cone, count, rows).floats
            for count, rows in zip(self.counts, faces, strict=True)
        ]

    def newton(self, at: Place) -> Array:
        """The minimiser of the energy as it is on the faces of a place, shape (n_v,) [m, rad]."""
        k, E, b = self.stiffness, self.step.extra.A[at.held], self.step.extra.b[at.held]
        push = np.einsum("cav,cab->vcb", self.B, at.S).reshape(len(self.g), -1)
        H = self.H - k * (push @ self.B.reshape(-1, len(self.g)) - STIFF * E.T @ E)
        g = self.g + k * (push @ self.gap.ravel() + STIFF * E.T @ b)
        return np.asarray(np.linalg.solve(H, g), dtype=np.float64)


def outside(conditions: Array, z: Array, noise: Array) -> bool:
    """Whether conditions z >= 0 are broken by more than the noise of z, shape (4,) [m]."""
    return bool((conditions @ z < -(np.abs(conditions) @ noise)).any())


def guessed_faces(
    step: StepData, compliance: float, near: tuple[Array, Array] | None
) -> tuple[list[Rows], list[int]]:
    """The face of each contact and the user's rows that are active: a guess, in float64.

    By Newton's method with backtracking: the energy is convex, and quadratic between faces.

    Parameters
    ----------
    step, compliance, near
        As of :func:`contact_forces`.

    Returns
    -------
    list of tuple of int, length n_c
    list of int
    """
    program, n_c = FloatStep(step, compliance), step.contacts.n_c
    x, give = np.zeros(step.n_v), np.zeros((n_c, 4))
    if near is not None:
        mu = scaled_by(step.contacts)
        x, wrench = near
        np.divide(-compliance * wrench[:, P_OF_WRENCH], mu, out=give, where=mu > 0)
    here = program.place(x, [()] * n_c, np.zeros(len(step.extra.b), dtype=np.bool_), give)
    for _ in range(GUESSES):
        way = program.newton(here) - here.x
        if not finite(way):
            break
        share = 1.0
        there = program.place(here.x + way, here.faces, here.held)
        while (
            not there.settled
            and share > LEAST
            and there.energy > here.energy + (DESCENT * share * (here.gradient @ way))
        ):
            share /= 2
            there = program.place(here.x + share * way, here.faces, here.held)
        here = there
        if here.settled:
            break
    return here.faces, np.flatnonzero(here.held).tolist()

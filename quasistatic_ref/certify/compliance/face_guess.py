"""The step with compliance in delta_q alone, in float64: a guess of the faces that forces lie on.

See :mod:`~quasistatic_ref.certify.compliance.forces`. Newton's method with backtracking: the energy
is convex, and quadratic as long as the faces stay.
"""

from typing import Final, NamedTuple

import numpy as np

from quasistatic_ref.certify.compliance.faces import (
    Rows,
    face,
    float_multipliers,
    nearest_face,
    rows_of,
)
from quasistatic_ref.step.arrays import Array, Mask, finite
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.friction import frame_jacobian, scaled_by
from quasistatic_ref.step.standard_form import linear_term

GUESSES: Final = 30
"""Newton iterations, at most; one to five do on the scenarios in models/."""
STIFF: Final = 2.0**10
"""How much stiffer than a contact a user's row is in the guess. In the proof it is rigid."""
ROUNDING: Final = 2.0**-50
"""Of a sum of a few products in float64, relative to the sum of their sizes [-]."""
DESCENT: Final = 1e-4
"""Share of the descent that the slope promises with which a step is content (Armijo)."""
LEAST: Final = 2.0**-30
"""Shortest part of a Newton step."""
P_OF_WRENCH = [2, 0, 1, 3]
"""Where the parts of p stand in a wrench."""


class Place(NamedTuple):
    """A displacement, and what it means for the step with compliance.

    Parameters
    ----------
    x : ndarray, shape (n_v,)
        [m, rad].
    faces : list of tuple of int, length n_c
    S : ndarray, shape (n_c, 4, 4)
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
        self.step = step
        self.compliance = compliance
        self.C = [rows_of(step.cone, count) for count in step.counts.tolist()]
        self.B = scaled_by(contacts)[:, :, None] * motion
        self.gap = np.zeros(self.B.shape[:2])
        self.gap[:, 0] = contacts.phi
        self.H = step.H
        self.g = linear_term(step)
        self.stiffness = step.h / compliance

    def place(self, x: Array, faces: list[Rows], held: Mask, more: Array | float = 0.0) -> Place:
        """Where x is, from faces that may be right for z + `more`, shape (n_c, 4) [m]."""
        H = self.H
        g = self.g
        k = self.stiffness
        own = self.step.extra
        z = self.B @ x + self.gap + more
        noise = ROUNDING * (np.abs(self.B) @ np.abs(x) + np.abs(self.gap) + np.abs(more))
        before = faces
        faces = list(faces)
        wrong = [j for j, M in enumerate(self.linear(faces)) if outside(M[:-4], z[j], noise[j])]
        for j in wrong:
            faces[j] = nearest_face(self.C[j], z[j], float_multipliers, 4 * float(noise[j].max()))
        S = np.array([M[-4:] for M in self.linear(faces)]).reshape(-1, 4, 4)
        s = np.einsum("cab,cb->ca", S, z)
        broken = np.minimum(own.A @ x - own.b, 0.0)
        energy = x @ H @ x / 2 - g @ x + k / 2 * (s.ravel() @ s.ravel() + STIFF * broken @ broken)
        push = np.einsum("cav,ca->v", self.B, s) - STIFF * broken @ own.A
        now = broken < 0
        settled = faces == before and bool((now == held).all())
        return Place(x, faces, S, now, float(energy), H @ x - g - k * push, settled)

    def linear(self, faces: list[Rows]) -> list[Array]:
        """Of each contact the conditions of its face and s, per z, shape (R + 4, 4) each."""
        return [
            face(self.step.cone, len(C), rows).floats for C, rows in zip(self.C, faces, strict=True)
        ]

    def newton(self, at: Place) -> Array:
        """The minimiser of the energy as it is on the faces of a place, shape (n_v,) [m, rad].

        NaN where the sum of H and contacts this stiff is singular in float64.
        """
        k = self.stiffness
        E = self.step.extra.A[at.held]
        b = self.step.extra.b[at.held]
        n = len(self.g)
        lengths = self.gap.size
        push = np.einsum("cav,cab->vcb", self.B, at.S).reshape(n, lengths)
        H = self.H - k * (push @ self.B.reshape(lengths, n) - STIFF * E.T @ E)
        g = self.g + k * (push @ self.gap.ravel() + STIFF * E.T @ b)
        try:
            return np.asarray(np.linalg.solve(H, g), dtype=np.float64)
        except np.linalg.LinAlgError:
            return np.full(len(g), np.nan)


def outside(conditions: Array, z: Array, noise: Array) -> bool:
    """Whether conditions z >= 0 are broken by more than the noise of z, shape (4,) [m]."""
    return bool((conditions @ z < -(np.abs(conditions) @ noise)).any())


def guessed_faces(
    step: StepData, compliance: float, near: tuple[Array, Array]
) -> tuple[list[Rows], list[int]]:
    """The face of each contact and the user's rows that are active: a guess, in float64.

    By Newton's method with backtracking: the energy is convex, and quadratic between faces.

    Parameters
    ----------
    step : StepData
        In a polyhedral cone.
    compliance : float
        [m/N].
    near : (ndarray, ndarray)
        delta_q, shape (n_v,), and wrenches, shape (n_c, 4) [N, N m], of the step without
        compliance.

    Returns
    -------
    list of tuple of int, length n_c
    list of int
    """
    program = FloatStep(step, compliance)
    mu = scaled_by(step.contacts)
    x, wrench = near
    give = np.divide(-compliance * wrench[:, P_OF_WRENCH], mu, out=0.0 * mu, where=mu > 0)
    here = program.place(x, [()] * len(mu), step.extra.A @ x < step.extra.b, give)
    for _ in range(GUESSES):
        way = program.newton(here) - here.x
        if not finite(way):
            break
        there = program.place(here.x + way, here.faces, here.held)
        if there.settled:
            return there.faces, np.flatnonzero(there.held).tolist()
        share = 1.0
        slope = here.gradient @ way
        while share > LEAST and there.energy > here.energy + DESCENT * share * slope:
            share /= 2
            there = program.place(here.x + share * way, here.faces, here.held)
        here = there
    return here.faces, np.flatnonzero(here.held).tolist()

r"""A guess, in float64, of the faces that forces lie on: where their exact method starts.

In delta_q alone, the step with compliance c (:mod:`~quasistatic_ref.optional.forces.forces`)
minimises a convex function. Its gradient is linear where each contact keeps its face:

.. math:: H x - g - \frac hc \sum_j B_j^T \Pi_F(-z_j), \qquad z_j = B_j x + (\phi_j, 0, 0, 0).

Newton's method finds the zero of the gradient on the faces at x, and goes towards it as far as the
function falls, until the faces are those there. Its first faces are those on which the forces of
the step without compliance lie. The user's own rows, which are rigid in the exact method, give way
here, too, but less.
"""

from functools import lru_cache
from typing import Final, NamedTuple

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.forces.faces import Face, Rows, face, rows_of
from quasistatic_ref.optional.friction import scaled_by
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.standard_form import frame_jacobian, linear_term

ROUNDING: Final = 2.0**-44
"""By how much a condition of a face may be missed, relative to the lengths z."""
STIFF: Final = 2.0**10
"""Stiffness of a user's row over that of a contact."""
SOFTER: Final = (1.0, *2.0 ** np.arange(30, -1, -6))
"""Compliances over that of the step [-]: mostly the first is all that is needed."""
STEPS: Final = 12
"""Steps of Newton's method with a compliance, at most: mostly one to four."""
SHORTEST: Final = 2.0**-20
"""Share of the way to the next zero, at least."""
FLAT: Final = 0.1
"""Slope that counts as a fall, over the slope where the way begins."""


class Pieces(NamedTuple):
    """The faces of all contacts, on which the gradient is one linear function.

    Parameters
    ----------
    faces : tuple of tuple of int
        The face of each contact.
    pressing : tuple of bool
        Which of the user's own rows press.
    """

    faces: tuple[Rows, ...]
    pressing: tuple[bool, ...]


def guessed_faces(step: StepData, compliance: float, wrench: Array) -> list[Rows]:
    """The face of each contact, in a polyhedral cone.

    Where float64 does not suffice, the guess is that no contact bears a load.

    Parameters
    ----------
    step : StepData
    compliance : float
        [m/N].
    wrench : ndarray, shape (n_c, 4)
        (f_d1, f_d2, f_n, tau_n) of the step without compliance [N, N m].

    Returns
    -------
    list of tuple of int, length n_c
    """
    try:
        return list(_Energy(step, compliance).least(wrench).faces)
    except (ValueError, ArithmeticError):  # of NumPy, of exact fractions
        return [()] * step.contacts.n_c


class _Energy:
    """The energy that the step with compliance minimises, as a function of delta_q."""

    def __init__(self, step: StepData, compliance: float) -> None:
        contacts = step.contacts
        self.step = step
        self.mu = scaled_by(contacts)
        J = np.stack(frame_jacobian(contacts, contacts.J), axis=1)
        self.B = self.mu[:, :, None] * J  # (n_c, 4, n_v)
        self.gap = np.zeros((contacts.n_c, 4))
        self.gap[:, 0] = contacts.phi
        self.H = step.H
        self.g = linear_term(step)
        self.k = step.h / compliance

    def least(self, wrench: Array) -> Pieces:
        """The faces of all contacts at the minimum.

        Parameters
        ----------
        wrench : ndarray, shape (n_c, 4)
            As of `guessed_faces`.

        Raises
        ------
        LinAlgError
            If float64 does not suffice.
        """
        p = wrench[:, [2, 0, 1, 3]] / np.where(self.mu > 0, self.mu, np.inf)
        at = self.pieces(-p, Pieces(((),) * len(p), (False,) * len(self.step.extra.b)))
        stiffness = self.k
        for softer in SOFTER:
            self.k = stiffness / softer
            at, settled = self.settled(at)
            if settled and softer == 1:
                break
        return at

    def settled(self, at: Pieces) -> tuple[Pieces, bool]:
        """The pieces at which Newton's method ends, and whether they hold the minimum."""
        x = self.zero(at)
        at = self.pieces_at(x, at)
        for _ in range(STEPS):
            way = self.zero(at) - x
            after = self.pieces_at(x + way, at)
            if after == at:
                return at, True
            steepest = FLAT * abs(way @ self.gradient(x, at))
            share = 1.0
            while share > SHORTEST and way @ self.gradient(x + share * way, after) > steepest:
                share /= 2
                after = self.pieces_at(x + share * way, after)
            x = x + share * way
            at = after
        return at, False

    def gradient(self, x: Array, at: Pieces) -> Array:
        """The linear function that the gradient is on some pieces, at x, shape (n_v,)."""
        z = self.B @ x + self.gap
        s = (self.onto(at) @ z[:, :, None]).ravel()
        extra = self.step.extra
        short = np.where(at.pressing, extra.A @ x - extra.b, 0.0)
        push = s @ self.B.reshape(self.gap.size, len(x)) - STIFF * short @ extra.A
        return self.H @ x - self.g - self.k * push

    def zero(self, at: Pieces) -> Array:
        """The delta_q (n_v,) at which the linear gradient of the given pieces is zero."""
        origin = np.zeros(self.step.n_v)
        B = self.B.reshape(self.gap.size, len(origin))
        s = (self.onto(at) @ self.B).reshape(B.shape)
        A = self.step.extra.A[list(at.pressing)]
        push = B.T @ s - STIFF * A.T @ A
        x = np.linalg.solve(self.H - self.k * push, -self.gradient(origin, at))
        return np.asarray(x)

    def pieces_at(self, x: Array, near: Pieces) -> Pieces:
        """The pieces at x; `near` decides where rounding would."""
        extra = self.step.extra
        pressing = tuple((extra.A @ x < extra.b).tolist())
        return self.pieces(self.B @ x + self.gap, near)._replace(pressing=pressing)

    def pieces(self, z: Array, near: Pieces) -> Pieces:
        """The pieces that the lengths z of the contacts, shape (n_c, 4), lie in."""
        faces = []
        for z_j, count, rows in zip(z, self.step.counts.tolist(), near.faces, strict=True):
            conditions = _floats(face(self.step.cone, count, rows))[:-4] @ z_j
            if (conditions < -ROUNDING * np.abs(z_j).max()).any():
                rows = nearest_rows(self.step.cone, count, z_j)
            faces.append(rows)
        return near._replace(faces=tuple(faces))

    def onto(self, at: Pieces) -> Array:
        """Matrices that project z onto the face of each contact, shape (n_c, 4, 4)."""
        counts = self.step.counts.tolist()
        on = [face(self.step.cone, n, f) for n, f in zip(counts, at.faces, strict=True)]
        faces = [_floats(each)[-4:] for each in on]
        return np.array(faces).reshape(-1, 4, 4)


@lru_cache(maxsize=4096)
def _floats(exact: Face) -> Array:
    """The numbers of a face in float64, shape (R + 4, 4)."""
    numbers = [float(v) for v in exact.linear.entries()]
    return np.array(numbers).reshape(-1, 4) / exact.denominator


def nearest_rows(name: str, count: int, z: Array) -> Rows:
    """The rows of the face on which the point nearest to -z lies: the method of Lawson and Hanson.

    Parameters
    ----------
    name : str
        A polyhedral cone.
    count : int
        Rows of the contact.
    z : ndarray, shape (4,)
        Its lengths [m, or times any positive number].
    """
    C = rows_of(name, count)
    least = ROUNDING * np.abs(z).max()
    multipliers = np.zeros(count)
    on = np.zeros(count, dtype=bool)
    for _ in range(3 * count):
        gain = np.where(on, -np.inf, C @ (-z - multipliers @ C))
        if gain.max() <= least:
            break
        on[gain.argmax()] = True
        ends = _combined(C, on, z)
        while (ends[on] <= 0).any():  # go as far as no multiplier is negative
            falls = on & (ends <= 0)
            share = multipliers[falls] / np.maximum(multipliers - ends, least)[falls]
            multipliers += share.min() * (ends - multipliers)
            on &= multipliers > least
            multipliers[~on] = 0.0
            ends = _combined(C, on, z)
        multipliers = ends
    return tuple(np.flatnonzero(multipliers > least).tolist())


def _combined(C: Array, on: Mask, z: Array) -> Array:
    """Multipliers, (R,), of the rows C (R, 4) that are `on` whose sum is nearest to -z, (4,)."""
    multipliers = np.zeros(len(C))
    multipliers[on] = np.linalg.lstsq(C[on].T, -z)[0]
    return multipliers

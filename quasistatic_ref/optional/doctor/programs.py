"""Convex steps of alike groups at any time step T in the place of h, all at once, in floats."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.optional.doctor.fixed_points import Iterates
from quasistatic_ref.optional.doctor.nearest import nearest
from quasistatic_ref.optional.friction import slip_norm
from quasistatic_ref.step.cones import cone

OWN = {True: (1e-8, 1e-10), False: (1e-6, 1e-9)}
"""Residual of an s that is its own: over the longest motion of a contact [-], or [m] if that is
more; in a polyhedral cone, and in a round one."""
CUTS = 20
"""Rounds of tangents to a round cone, at most."""
ROUND = 1e-8
"""Part of the longest motion of a contact that tangents may leave of its slip [-]."""
STILL = 1e-12
"""Length of a row that nothing moves, over the longest of its group [-]."""
AXES = np.concatenate([np.eye(3), -np.eye(3)])
"""Tangents to a round cone that always stand, in units of (mu_v, mu_v, mu_omega) [-]."""


class Alike(NamedTuple):
    """B groups of a scene of the same sizes, one upon the other.

    Parameters
    ----------
    coordinates : ndarray of int, shape (B, n)
        Of the scene, ascending.
    contacts : ndarray of int, shape (B, c)
        Of the run.
    bodies : ndarray of int, shape (B, n_u)
        Number of the body that each un-actuated coordinate is of.
    K_q, M_u : ndarray, shapes (B, n_a, n_a) and (B, n_u, n_u)
    load : ndarray, shape (B, n)
        tau_k + tau_a and tau_u [N, N m].
    phi, sizes : ndarray, shape (B, c)
        Distances, and sizes of the smaller shapes [m].
    frames : ndarray, shape (B, c, 4, n)
        J along d1, d2 and n, and about n: in the order of forces [m, rad].
    mu : ndarray, shape (B, c, 3)
        (mu_v, mu_v, mu_omega) [-, -, m].
    turns : ndarray of bool, shape (B, n)
        Un-actuated coordinates that are angles.
    A, b : ndarray, shapes (B, e, n) and (B, e)
        Further rows, A delta_q >= b.
    H, g : ndarray, shapes (B, n, n) and (B, n)
        Of a user's cost, as of ``Extra``.
    """

    coordinates: Indices
    contacts: Indices
    bodies: Indices
    K_q: Array
    M_u: Array
    load: Array
    phi: Array
    sizes: Array
    frames: Array
    mu: Array
    turns: Mask
    A: Array
    b: Array
    H: Array
    g: Array

    def some(self, of: Indices) -> Alike:
        """Some of the groups, shape (b,)."""
        return Alike._make(array[of] for array in self)

    def motion(self, delta_q: Array) -> Array:
        """J delta_q of contacts along d1, d2 and n, and about n, (B, c, 4) [m, m, m, rad]."""
        return np.asarray(np.einsum("bciv,bv->bci", self.frames, delta_q))

    @property
    def n_a(self) -> int:
        """Number of actuated coordinates of a group."""
        return int(self.K_q.shape[1])


class Program:
    """The convex steps of groups at one T of each, in coordinates x in which H is 1.

    Parameters
    ----------
    groups : Alike
    cone_name : str
    T : ndarray, shape (b,)
        [s]
    """

    def __init__(self, groups: Alike, cone_name: str, T: Array) -> None:
        n_a = groups.n_a
        self.groups = groups
        self.cone = cone_name
        self.T = T
        polyhedral = cone(cone_name).polyhedral
        self.round = not polyhedral
        self._own = OWN[polyhedral]
        H = groups.H.copy()
        H[:, :n_a, :n_a] += T[:, None, None] * groups.K_q
        H[:, n_a:, n_a:] += groups.M_u / T[:, None, None]
        unit = 1 / np.sqrt(np.diagonal(H, axis1=1, axis2=2))
        scaled = H * unit[:, :, None] * unit[:, None]
        self.sound = np.asarray(np.isfinite(scaled).all(axis=(1, 2)))
        scaled[~self.sound] = np.eye(H.shape[1])
        root = np.linalg.inv(np.linalg.cholesky(scaled)).swapaxes(1, 2)
        self.root = unit[:, :, None] * root  # delta_q = root x
        self.f = np.einsum("bvx,bv->bx", self.root, T[:, None] * groups.load + groups.g)
        slips = groups.mu[..., None] * groups.frames[:, :, [0, 1, 3]]
        self._reach = np.abs(slips)
        root = self.root[:, None]
        self._gaps = groups.frames[:, :, 2:3] @ root
        self._slips = slips @ root
        self._rows = groups.A @ self.root
        tangents = -AXES if self.round else cone(cone_name).matrix[:, 1:]
        self._tangents = np.tile(tangents, (*groups.phi.shape, 1, 1))

    def at(self, of: Indices, s: Array) -> Iterates:
        """The convex steps of some groups, (k,), with phi + s, (k, c) [m], as iterates."""
        delta_q, forces, solved = self.convex(of, s)
        slip = slip_norm(self._scaled_slips(of, delta_q), self.cone)
        residual = np.where(solved, np.abs(slip - s).max(axis=1, initial=0.0), np.inf)
        of_way, least = self._own
        own = residual <= np.maximum(of_way * self._longest(of, delta_q), least)
        return Iterates(s, slip, residual, np.asarray(own), delta_q, forces)

    def convex(self, of: Indices, s: Array) -> tuple[Array, Array, Mask]:
        """The convex steps of some groups, (k,), with phi + s.

        Parameters
        ----------
        of : ndarray of int, shape (k,)
        s : ndarray, shape (k, c)
            [m]

        Returns
        -------
        delta_q : ndarray, shape (k, n)
        forces : ndarray, shape (k, c, 4)
            [N, N m]
        solved : ndarray of bool, shape (k,)
            Where there is an answer.
        """
        delta_q = np.zeros((len(of), self.f.shape[1]))
        forces = np.zeros((*s.shape, 4))
        solved = self.sound[of].copy()
        left = np.flatnonzero(solved)
        for _ in range(CUTS):
            some = of[left]
            x, pushes, solved[left] = self._solved(some, s[left])
            delta_q[left] = np.einsum("bvx,bx->bv", self.root[some], x)
            of_slips = self.groups.mu[some] * np.einsum(
                "bct,bctu->bcu", pushes, self._tangents[some]
            )
            forces[left] = np.insert(of_slips, 2, pushes.sum(axis=2), axis=2)
            if not self.round:
                break
            left = left[self._cut(some, s[left], x, pushes, delta_q[left])]
            if not left.size:
                break
        return delta_q, forces, solved

    def _solved(self, of: Indices, s: Array) -> tuple[Array, Array, Mask]:
        """x, (k, n), what tangents press with, (k, c, t) [N], and where there is an answer, (k,).

        Rows have length one, and so has the largest of the numbers that ask for a motion.
        """
        groups = self.groups
        rows = self._gaps[of] + self._tangents[of] @ self._slips[of]
        k, c, t, n = rows.shape
        A = np.concatenate([rows.reshape(k, c * t, n), self._rows[of]], axis=1)
        b = np.concatenate([np.repeat(-groups.phi[of] - s, t, axis=1), groups.b[of]], axis=1)
        length = np.linalg.norm(A, axis=2)
        moves = length > STILL * length.max(axis=1, initial=0.0)[:, None]
        A = np.where(moves[:, :, None], A / length[:, :, None], 0.0)
        b = np.where(moves, b / length, -1.0)
        f = self.f[of]
        size = np.maximum(np.linalg.norm(f, axis=1), b.max(axis=1, initial=0.0))
        size = np.where(size > 0, size, 1.0)
        x = f / size[:, None]
        lam = np.zeros(b.shape)
        solved = np.isfinite(b).all(axis=1) & np.isfinite(A).all(axis=(1, 2))
        b = b / size[:, None]
        for i in np.flatnonzero(solved).tolist() if b.shape[1] else ():
            answer = nearest(x[i], A[i], b[i])
            solved[i] = answer is not None
            if answer is not None:
                x[i], lam[i] = answer
        x = x * size[:, None]
        solved &= np.isfinite(x).all(axis=1)
        pushes = np.where(moves, lam * size[:, None] / length, 0.0)[:, : c * t]
        return x, pushes.reshape(k, c, t) / self.T[of, None, None], solved

    def _cut(self, of: Indices, s: Array, x: Array, pushes: Array, delta_q: Array) -> Mask:
        """Add tangents where contacts slip beyond a round cone; which groups have new ones, (k,).

        Those along the axes stay, others while they press.
        """
        slip, gap = ((rows[of] @ x[:, None, :, None])[..., 0] for rows in (self._slips, self._gaps))
        norm = np.linalg.norm(slip, axis=2)
        over = norm - (self.groups.phi[of] + s + gap[..., 0])
        beyond = (norm > 0) & (over > ROUND * self._longest(of, delta_q)[:, None])
        axes, cuts = np.split(self._tangents[of], [len(AXES)], axis=2)
        new = np.where(beyond[..., None], -slip / norm[..., None], 0.0)
        kept = np.where(pushes[:, :, len(AXES) :, None] > 0, cuts, 0.0)
        cuts = np.concatenate([new[:, :, None], kept], axis=2)
        free = ~cuts.any(axis=3)
        cuts = np.take_along_axis(cuts, np.argsort(free, axis=2, kind="stable")[..., None], axis=2)
        cuts = cuts[:, :, : (~free).sum(axis=2).max(initial=0)]
        tangents = np.concatenate([axes, cuts], axis=2)
        wider = tangents.shape[2] - self._tangents.shape[2]
        if wider > 0:
            self._tangents = np.pad(self._tangents, [(0, 0), (0, 0), (0, wider), (0, 0)])
        self._tangents[of] = 0.0
        self._tangents[of, :, : tangents.shape[2]] = tangents
        return np.asarray(beyond.any(axis=1))

    def _scaled_slips(self, of: Indices, delta_q: Array) -> Array:
        """Slips and spins times mu, shape (k, c, 3) [m]."""
        groups = self.groups
        slips = np.einsum("bciv,bv->bci", groups.frames[of][:, :, [0, 1, 3]], delta_q)
        return np.asarray(groups.mu[of] * slips)

    def _longest(self, of: Indices, delta_q: Array) -> Array:
        """The sum of the sizes of a contact's motions, at the largest contact, shape (k,) [m]."""
        parts = np.einsum("bciv,bv->bc", self._reach[of], np.abs(delta_q))
        return np.asarray(parts.max(axis=1, initial=0.0))

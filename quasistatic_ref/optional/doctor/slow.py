r"""Steps of alike groups by Coulomb's law, at any time step T in the place of h, all at once.

By Coulomb's law nothing rises: phi + s takes the place of phi, s being the norm of a contact's own
slip. With T >> h the drag of a motion that is asked for, d, is M_u d / T^2, and vanishes. What is
left, r = -M_u delta_q_u / T^2, is what no forces of Coulomb's law bear.

Answers are those of floats. What decides is the residual of s: only an s that is its own slip's
norm is a fixed point. T climbs by factors of three, and s starts between those of two T: what lands
goes with T^0, and what slides freely with T^2.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.optional.doctor.artifacts import quotient
from quasistatic_ref.optional.doctor.fixed_points import Iterates, fixed_points
from quasistatic_ref.optional.doctor.nearest import nearest
from quasistatic_ref.optional.friction import slip_norm
from quasistatic_ref.step.cones import cone

SLOWLY = 10.0
"""T [s], or a thousand h if that is more: what nothing bears falls by 500 m."""
STRAIGHT = 0.1
"""Motion of a contact over the smaller shape [-], or turn [rad], of a straight step."""
FIRST = 0.01
"""Part of the smallest shape [-] that falls in the first T of a climb."""
FALLS = 9.81
"""Acceleration with which it does [m/s^2]: that of the earth, whatever a scene's is."""
FACTOR = 3.0
"""From one T to the next [-]."""
SAME = 1e-3
"""Change of r, and of a gap over the smaller shape, that is none [-]."""
OWN = {True: (1e-8, 1e-10), False: (1e-6, 1e-9)}
"""Residual of an s that is its own: over the longest motion of a contact [-], or [m] if that is
more; in a polyhedral cone, and in a round one."""
MOST = 40
"""Iterates after which no fixed point is expected at a T."""
FEW = 16
"""The same at the last T, where no smaller T has led."""
CUTS = 20
"""Rounds of tangents to a round cone, at most."""
ROUND = 1e-8
"""Part of the longest motion of a contact that tangents may leave of its slip [-]."""
NULL = 1e-9
"""Singular value that is none, over the largest [-]."""
STILL = 1e-12
"""Length of a row that nothing moves, over the longest of its group [-]."""
LITTLE = 1e-3
"""Force that is none, over a body's own load [-]."""
GROUP = 50_000
"""Most entries of J, 4 n_c n_v, of a group that is asked."""
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


class Rung(NamedTuple):
    """The step of b groups at one T of each.

    Parameters
    ----------
    T : ndarray, shape (b,)
        [s]
    found : ndarray of bool, shape (b,)
        Whether there is an answer.
    delta_q : ndarray, shape (b, n)
    forces : ndarray, shape (b, c, 4)
        Along d1, d2 and n, and about n [N, N m].
    s : ndarray, shape (b, c)
        [m]
    moves : ndarray, shape (b,)
        The longest motion over what is straight [-].
    """

    T: Array
    found: Mask
    delta_q: Array
    forces: Array
    s: Array
    moves: Array

    def some(self, of: Mask | Indices) -> Rung:
        """The same steps, of some of the groups alone."""
        return Rung._make(array[of] for array in self)

    def put(self, of: Indices, other: Rung) -> None:
        """Take over the steps of some of the groups."""
        for array, values in zip(self, other, strict=True):
            array[of] = values


class Climb:
    """How b groups move as their T climbs.

    Parameters
    ----------
    high : Rung
        The steps at the last T from s = 0, as far as they have an answer.
    slow : Slow
    of : ndarray of int, shape (b,)
        Which groups of it.

    Attributes
    ----------
    count : ndarray of int, shape (b,)
        Of the T that have an answer.
    before, last : Rung
        The last two of these.
    starts : ndarray, shape (b, n_u)
        The motion that goes with T^2, over T^2: of each body the first on which two T agree, else
        that up to the last T at which all is straight [m/s^2, rad/s^2].
    agree : ndarray of bool, shape (members,)
        Of which two T agree.
    """

    def __init__(self, high: Rung, slow: Slow, of: Indices) -> None:
        self.high = high
        self._slow = slow
        self._of = of
        self.count = np.zeros(len(of), dtype=np.int64)
        self.before = Rung._make(map(np.zeros_like, high))
        self.last = Rung._make(map(np.zeros_like, high))
        self.starts = np.zeros((len(of), slow.groups.M_u.shape[1]))
        self._starts = self.starts.copy()  # from the last T but one to the last
        self.agree = np.zeros(len(slow.mass), dtype=bool)

    def take(self, at: Indices, rung: Rung) -> None:
        """Take over the answers that some of the groups have at their next T."""
        self.count[at] += 1
        self.before.put(at, self.last.some(at))
        self.last.put(at, rung)
        at = at[self.count[at] > 1]
        slow = self._slow
        of = self._of[at]
        change = (self.last.delta_q - self.before.delta_q)[at, slow.groups.n_a :]
        square = self.last.T[at] ** 2 - self.before.T[at] ** 2
        starts = -change / square[:, None]
        first = self.count[at] == 2
        member = slow.member[of]
        again = np.isin(np.arange(len(slow.mass)), member[~first])
        size = slow.amounts(starts, of)
        differs = slow.amounts(starts - self._starts[at], of)
        agree = self.agree | (again & (differs <= SAME * size))
        takes = (first | (self.last.moves[at] <= 1))[:, None] | agree[member]
        takes &= ~self.agree[member]
        self.starts[at] = np.where(takes, starts, self.starts[at])
        self._starts[at] = starts
        self.agree = agree

    def ahead(self, T: Array) -> Array:
        """Where s is at T, (b,) [s], shape (b, c) [m]: it lands with T^0, and slides with T^2.

        It is sought between the last T that has an answer and the end's; without that, beyond the
        last two, and at most as far as what slides freely.
        """
        last = self.last
        T_2 = (T**2)[:, None]
        square, before, high = ((x.T**2)[:, None] for x in (last, self.before, self.high))
        between = last.s + (self.high.s - last.s) * quotient(T_2 - square, high - square)
        beyond = last.s + (last.s - self.before.s) * quotient(T_2 - square, square - before)
        beyond = np.minimum(beyond, last.s * quotient(T_2, square, 1.0))
        beyond = np.where((self.count > 1)[:, None], beyond, last.s)
        return np.asarray(np.where(self.high.found[:, None], between, beyond).clip(0.0))


class Slow:
    """Steps of alike groups at any T.

    Parameters
    ----------
    groups : Alike
    cone_name : str
    end : float
        The last T [s].
    bodies : ndarray, shape (3, bodies + 1)
        Masses [kg], sizes [m] and loads [N] of the bodies of the run, and of none.

    Attributes
    ----------
    member : ndarray of int, shape (B, n_u)
        Number of a body in a group, a member, of each un-actuated coordinate.
    group_of, body_of : ndarray of int, shape (members,)
        Its group and its body.
    mass, size, least : ndarray, shape (members,)
        Its mass [kg] and size [m], and the force that is none [N].
    """

    def __init__(self, groups: Alike, cone_name: str, end: float, bodies: Array) -> None:
        self.groups = groups
        self.cone = cone_name
        self.end = end
        self.every = np.arange(len(groups.coordinates))
        self._bodies = bodies
        count = bodies.shape[1]
        key = self.every[:, None] * count + groups.bodies
        members, member = np.unique(key, return_inverse=True)
        self.member = member.reshape(key.shape)
        self.group_of, self.body_of = np.divmod(members, count)
        self.mass, self.size, loads = bodies[:, self.body_of]
        self.least = LITTLE * loads

    @property
    def large(self) -> bool:
        """Whether a group is too large for its equilibrium to be checked."""
        return bool(self.groups.frames[0].size > GROUP)

    def amounts(self, motion: Array, of: Indices) -> Array:
        """Amounts of forces M_u `motion`, (b, n_u), on each member of some groups [kg its unit].

        A member is a body in a group. What is in none of these groups has 0.
        """
        M_u = self.groups.M_u[of]
        work = motion * np.einsum("bij,bj->bi", M_u, motion)
        of_member = np.bincount(self.member[of].ravel(), work.ravel(), len(self.mass))
        return np.asarray(np.sqrt(self.mass * np.maximum(of_member, 0.0)))

    def of_members(self, values: Array | Mask, of: Indices) -> Array:
        """The value that each member's group has, shape (members,).

        Parameters
        ----------
        values : ndarray, shape (b,)
            Of some groups [any unit]; others have 0.
        of : ndarray of int, shape (b,)
            Which groups these are.
        """
        every = np.zeros(len(self.every))
        every[of] = values
        return every[self.group_of]

    def members_of(self, of: Indices) -> Indices:
        """Numbers of the members of some groups, of no body excepted, ascending."""
        here = np.isin(self.group_of, of) & (self.mass > 0)
        return np.flatnonzero(here)

    def bodies_in(self, of: Indices) -> Indices:
        """Numbers of the bodies in some groups."""
        return self.body_of[self.members_of(of)]

    def all_of(self, members: Mask, of: Indices) -> Mask:
        """Whether something holds for all members of some groups, shape (b,)."""
        others = np.bincount(self.group_of[~members], minlength=len(self.every))
        return np.asarray(others[of] == 0)

    def rung(
        self, T: Array, start: Array, of: Indices, most: int = MOST, way: Array | None = None
    ) -> Rung:
        """The step of some groups, (b,), at T, (b,) [s], from s = start, (b, c) [m].

        Parameters
        ----------
        T, start, of
            As above.
        most : int
        way : ndarray, shape (b, n), optional
            A motion whose slips a round cone has tangents of [m, rad].
        """
        groups = self.groups.some(of)
        with np.errstate(all="ignore"):
            last = fixed_points(Program(groups, self.cone, T, way).at, start, most)
            motion = groups.motion(last.delta_q)[:, :, :3]
            ways = np.linalg.norm(motion, axis=2) / groups.sizes
            turns = np.abs(last.delta_q) * groups.turns
        far = np.maximum(ways.max(axis=1, initial=0.0), turns.max(axis=1, initial=0.0))
        return Rung(T, last.own, last.delta_q, last.forces, last.image, far / STRAIGHT)

    def level(self, of: Indices) -> Array:
        """No rise of any contact of some groups, shape (b, c) [m]."""
        return np.zeros((len(of), self.groups.phi.shape[1]))

    def last(self, of: Indices) -> Rung:
        """The step of some groups at the last T, from s = 0."""
        return self.rung(np.full(len(of), self.end), self.level(of), of, FEW)

    def convex(self, of: Indices) -> tuple[Array, Array, Mask]:
        """The convex step of some groups at the last T: by it, what slips rises.

        Returns
        -------
        delta_q : ndarray, shape (b, n)
        forces : ndarray, shape (b, c, 4)
            [N, N m]
        solved : ndarray of bool, shape (b,)
            Where there is an answer.
        """
        program = Program(self.groups.some(of), self.cone, np.full(len(of), self.end))
        return program.convex(np.arange(len(of)), self.level(of))

    def landed(self, h: float, touches: Mask) -> Slow:
        """The groups after their bodies have come down from their layers, by the shortest way.

        Springs follow, and nothing rubs on the way: by Coulomb's law none rose. Else what comes
        down along something that it sticks to would be held by it.

        Parameters
        ----------
        h : float
            Time step of the run [s].
        touches : ndarray of bool, shape (B, c)
            Which contacts come down.
        """
        groups = self.groups
        n_a = groups.n_a
        roots = Program(groups, self.cone, np.full(len(touches), h)).root
        down = np.zeros(groups.load.shape)
        for i in np.flatnonzero((touches & (groups.phi != 0)).any(axis=1)).tolist():
            on = touches[i]
            J_n = groups.frames[i, on, 2]
            x = np.linalg.lstsq(J_n @ roots[i], -groups.phi[i, on], rcond=NULL)[0]
            down[i] = roots[i] @ x
        load = groups.load.copy()
        load[:, :n_a] -= np.einsum("bij,bj->bi", groups.K_q, down[:, :n_a])
        phi = groups.phi + np.einsum("bcv,bv->bc", groups.frames[:, :, 2], down)
        b = groups.b - np.einsum("bev,bv->be", groups.A, down)
        landed = groups._replace(load=load, phi=phi, b=b)
        return Slow(landed, self.cone, self.end, self._bodies)

    def climb(self, of: Indices, high: Rung) -> Climb:
        """How some groups, (b,), move on the way to the last T.

        Parameters
        ----------
        of : ndarray of int, shape (b,)
        high : Rung
            Of :meth:`last`.
        """
        T = np.sqrt(FIRST * self.groups.sizes[of].min(axis=1, initial=1.0) / FALLS)
        T = np.minimum(T, self.end)
        climb = Climb(high, self, of)
        left = np.arange(len(of))
        while left.size:
            rung = self._next(climb, T, left, of)
            climb.take(left[rung.found], rung.some(rung.found))
            left = left[T[left] < self.end]
            T = np.minimum(FACTOR * T, self.end)
        return climb

    def _next(self, climb: Climb, T: Array, left: Indices, of: Indices) -> Rung:
        """The steps of the groups `of[left]`, each at its next T.

        At the last one s = 0 may have an answer; where it has none yet, more iterates may lead to
        it.
        """
        rung = climb.high.some(left)
        ends = T[left] >= self.end
        known = ends & rung.found
        start = climb.ahead(T)[left]
        way = np.where(climb.count[:, None] > 0, climb.last.delta_q, climb.high.delta_q)[left]
        at = np.flatnonzero(~known)
        if at.size:
            rung.put(at, self.rung(T[left[at]], start[at], of[left[at]], MOST, way[at]))
        at = np.flatnonzero(ends & ~rung.found)
        if at.size:
            rung.put(at, self.rung(T[left[at]], self.level(of[left[at]]), of[left[at]]))
        return rung


class Program:
    """The convex steps of groups at one T of each, in coordinates x in which H is 1.

    Parameters
    ----------
    groups : Alike
    cone_name : str
    T : ndarray, shape (b,)
        [s]
    way : ndarray, shape (b, n), optional
        A motion whose slips a round cone has tangents of [m, rad].
    """

    def __init__(self, groups: Alike, cone_name: str, T: Array, way: Array | None = None) -> None:
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
        if self.round and way is not None:
            slip = np.einsum("bciv,bv->bci", slips, way)
            tangent = -slip * quotient(1.0, np.linalg.norm(slip, axis=2))[:, :, None]
            self._tangents = np.concatenate([self._tangents, tangent[:, :, None]], axis=2)

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

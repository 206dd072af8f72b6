r"""Steps of alike groups by Coulomb's law, slowly: a long T takes the place of h, all at once.

By Coulomb's law nothing rises: phi + s takes the place of phi, s being the norm of a contact's own
slip. With T >> h the drag of a motion that is asked for, d, is M_u d / T^2, and vanishes. What is
left, r = -M_u delta_q_u / T^2, is what no forces of Coulomb's law bear.

Answers are those of floats. What decides is the residual of s: only an s that is its own slip's
norm is a fixed point. It is sought from s = 0. Where that fails, it is sought at smaller T first.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.numbers.arrays import Array, Indices, Mask
from quasistatic_ref.optional.doctor.artifacts import quotient
from quasistatic_ref.optional.doctor.fixed_points import fixed_points
from quasistatic_ref.optional.doctor.programs import Alike, Program

if TYPE_CHECKING:
    from quasistatic_ref.optional.doctor.bodies import Body, Missing

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
"""Change of an amount, and of a gap over the smaller shape, that is none [-]."""
MOST = 40
"""Iterates after which no fixed point is expected at a T."""
NULL = 1e-9
"""Singular value that is none, over the largest [-]."""
LITTLE = 1e-3
"""Force that is none, over a body's own load [-]."""
NOISE = 1e-6
"""Part of that which rounding leaves of a body that is held [-]."""
WAY = 300.0
"""Motion over what is straight [-] of which what is missing is read: that of 500 m has an s that is
its own only to micrometres, and stiff springs mind."""
CLIMB = 4
"""Short steps that are asked whether a group leaves, where the long one has no answer."""
ALIKE = 0.02
"""Difference of what a shorter and a longer way say is missing [-], up to which they agree."""
LONGER = (3.0, 9.0, 27.0)
"""Times T [-] that are asked as well where the way above says other than the long step."""
GROUP = 50_000
"""Most entries of J, 4 n_c n_v, of a group that is asked."""


class Rung(NamedTuple):
    """The step of b groups at some T.

    Parameters
    ----------
    found : ndarray of bool, shape (b,)
        Whether there is an answer.
    delta_q : ndarray, shape (b, n)
    forces : ndarray, shape (b, c, 4)
        Along d1, d2 and n, and about n [N, N m].
    s : ndarray, shape (b, c)
        [m]
    """

    found: Mask
    delta_q: Array
    forces: Array
    s: Array

    def some(self, of: Mask | Indices) -> Rung:
        """The same steps, of some of the groups alone."""
        return Rung._make(array[of] for array in self)

    def put(self, of: Indices, other: Rung) -> None:
        """Take over the steps of some of the groups."""
        for array, values in zip(self, other, strict=True):
            array[of] = values


class Slow:
    """Slow steps of alike groups, and what their bodies lack in them.

    A member is a body in a group.

    Parameters
    ----------
    groups : Alike
    cone_name : str
    T : float
        [s]
    bodies : ndarray, shape (3, bodies + 1)
        Masses [kg], sizes [m] and loads [N] of the bodies of the run, and of none.

    Attributes
    ----------
    member : ndarray of int, shape (B, n_u)
        Number of the member of each un-actuated coordinate.
    group_of, body_of : ndarray of int, shape (members,)
        Its group and its body.
    least : ndarray, shape (members,)
        The force that is none [N].
    """

    def __init__(self, groups: Alike, cone_name: str, T: float, bodies: Array) -> None:
        self.groups = groups
        self.cone = cone_name
        self.T = T
        self.every = np.arange(len(groups.coordinates))
        self._bodies = bodies
        count = bodies.shape[1]
        key = self.every[:, None] * count + groups.bodies
        members, member = np.unique(key, return_inverse=True)
        self.member = member.reshape(key.shape)
        self.group_of, self.body_of = np.divmod(members, count)
        self._mass, size, load = bodies[:, self.body_of]
        self.least = LITTLE * load
        self._short = self._mass * STRAIGHT * size

    @property
    def large(self) -> bool:
        """Whether a group is too large for its equilibrium to be checked."""
        return bool(self.groups.frames[0].size > GROUP)

    def amounts(self, starts: Array, of: Indices) -> Array:
        """Sizes of forces M_u starts on members of some groups, shape (members,) [N]; 0 on others.

        Parameters
        ----------
        starts : ndarray, shape (b, n_u)
            [m/s^2, rad/s^2]
        of : ndarray of int, shape (b,)
        """
        work = starts * np.einsum("bij,bj->bi", self.groups.M_u[of], starts)
        of_member = np.bincount(self.member[of].ravel(), work.ravel(), len(self._mass))
        return np.asarray(np.sqrt(self._mass * np.maximum(of_member, 0.0)))

    def held(self, rung: Rung, of: Indices, straight: float) -> Mask:
        """Which groups have a slow step in which nothing moves far, or lacks much, shape (b,).

        What is missing of a member is little, or that of a motion by less than a tenth of its size.

        Parameters
        ----------
        rung : Rung
        of : ndarray of int, shape (b,)
        straight : float
            How far they may move, over what is straight [-].
        """
        T = np.full(len(of), self.T)
        amounts = self.amounts(self._starts(rung.delta_q, T), of)
        lacks = np.flatnonzero(amounts > np.maximum(self.least, self._short / self.T**2))
        stays = ~np.isin(of, self.group_of[lacks])
        return np.asarray(rung.found & (self.moves(rung.delta_q, of) <= straight) & stays)

    def falling(self, rung: Rung, of: Indices) -> tuple[Mask, Array, Mask]:
        """What members of some groups lack, by steps at three T.

        Their motion is not bounded if it grows faster than T. What goes with T^2 is the difference
        of two T; of these the motion is WAY at most, and more where the slow step says otherwise: a
        soft spring still pushes there.

        Parameters
        ----------
        rung : Rung
            Their slow step.
        of : ndarray of int, shape (b,)

        Returns
        -------
        falls : ndarray of bool, shape (members,)
            Whether their motion is not bounded.
        starts : ndarray, shape (b, n_u)
            What goes with T^2, over T^2, turned round [m/s^2, rad/s^2].
        known : ndarray of bool, shape (b,)
            Whether that is known.
        """
        moves = self.moves(rung.delta_q, of)
        shorter = np.sqrt(np.minimum(1.0, quotient(WAY, moves, 1.0)))
        T = self.T * shorter
        s = rung.s * shorter[:, None] ** 2
        starts, first, known = self._between(T, s, of)
        end = np.full(len(of), self.T)
        long = self._starts(rung.delta_q, end)
        short = T.copy()
        for factor in LONGER:  # a soft spring pushes on for longer than that
            off = self.amounts(starts - long, of) > SAME * self.amounts(starts, of)
            doubtful = ~known | np.isin(of, self.group_of[off])
            at = np.flatnonzero(rung.found & (T < self.T) & doubtful)
            if not at.size:
                break
            more = np.minimum(factor * short[at], self.T)
            s_more = rung.s[at] * (more / self.T)[:, None] ** 2
            farther, shorter_ones, found = self._between(more, s_more, of[at])
            at = at[found]
            known[at] = True
            T[at] = more[found]
            starts[at] = farther[found]
            first.put(at, shorter_ones.some(found))
        lost = np.flatnonzero(~known)
        if lost.size:  # on a shorter way, inertia helps; what a spring adds there is not in `long`
            T[lost] /= FACTOR**2
            more, shorter_ones, found = self._between(T[lost], s[lost] / FACTOR**4, of[lost])
            first.put(lost, shorter_ones)
            starts[lost] = more
            off = self.amounts(more - long[lost], of[lost]) > ALIKE * self.amounts(more, of[lost])
            known[lost] = found & ~np.isin(of[lost], self.group_of[off])
        before = self.amounts(self._starts(first.delta_q, T / FACTOR) * T[:, None] / FACTOR, of)
        after = self.amounts(long * self.T, of)
        falls = (after >= before) & (after > NOISE * self.least * self.T)
        known &= rung.found
        falls &= np.isin(self.group_of, of[known]) & (self._mass > 0)
        return falls, starts, known | (rung.found & (moves <= WAY))

    def first(self, of: Indices) -> Array:
        """How some groups start to move at first, turned round, (b, n_u) [m/s^2, rad/s^2]."""
        return self._between(self._soon(of), self.level(of), of)[0]

    def leaving(self, of: Indices) -> tuple[Mask, Array]:
        """Which groups a short step moves farther than straight, and how they start to.

        Returns
        -------
        gone : ndarray of bool, shape (b,)
        starts : ndarray, shape (b, n_u)
            As of :meth:`falling` [m/s^2, rad/s^2].
        """
        T = self._soon(of)
        starts, _, known = self._between(FACTOR * T, self.level(of), of)
        s = self.level(of)
        gone = np.zeros(len(of), dtype=bool)
        for _ in range(CLIMB):
            rung = self.rung(T, s, of)
            gone |= rung.found & (self.moves(rung.delta_q, of) > 1)
            s = rung.s * FACTOR**2
            T = FACTOR * T
        return gone & known, starts

    def _between(self, T: Array, start: Array, of: Indices) -> tuple[Array, Rung, Mask]:
        """What goes with T^2 between two steps, the shorter one, and whether both are found."""
        last = self.rung(T, start, of)
        T_1 = T / FACTOR
        first = self.rung(T_1, last.s / FACTOR**2, of)
        starts = self._starts(last.delta_q - first.delta_q, np.sqrt(T**2 - T_1**2))
        return starts, first, last.found & first.found

    def _soon(self, of: Indices) -> Array:
        """T in which something falls by part of the smallest shape, shape (b,) [s]."""
        size = self.groups.sizes[of].min(axis=1, initial=1.0)
        return np.asarray(np.minimum(self.T, np.sqrt(FIRST * size / FALLS)))

    def missing(self, member: int, of: Indices, starts: Array, bodies: Sequence[Body]) -> Missing:
        """What a member of some groups lacks.

        Parameters
        ----------
        member : int
        of : ndarray of int, shape (b,)
        starts : ndarray, shape (b, n_u)
            As of :meth:`falling` [m/s^2, rad/s^2].
        bodies : sequence of Body
            Of the run.
        """
        g = self.group_of[member]
        at = np.flatnonzero(self.member[g] == member)
        M = self.groups.M_u[g][np.ix_(at, at)]
        return bodies[int(self.body_of[member])].missing(starts[np.searchsorted(of, g), at], M)

    def _starts(self, delta_q: Array, T: Array) -> Array:
        """-delta_q_u / T^2 of groups, shape (b, n_u) [m/s^2, rad/s^2]."""
        return np.asarray(-delta_q[:, self.groups.n_a :] / (T**2)[:, None])

    def members_of(self, of: Indices) -> Indices:
        """Numbers of the members of some groups, of no body excepted, ascending."""
        return np.flatnonzero(np.isin(self.group_of, of) & (self._mass > 0))

    def bodies_in(self, of: Indices) -> Indices:
        """Numbers of the bodies in some groups."""
        return self.body_of[self.members_of(of)]

    def moves(self, delta_q: Array, of: Indices) -> Array:
        """Longest motion of contacts, or turn, of groups over what is straight, shape (b,) [-]."""
        groups = self.groups.some(of)
        ways = np.linalg.norm(groups.motion(delta_q)[:, :, :3], axis=2) / groups.sizes
        turns = np.abs(delta_q) * groups.turns
        far = np.maximum(ways.max(axis=1, initial=0.0), turns.max(axis=1, initial=0.0))
        return np.asarray(far / STRAIGHT)

    def rung(self, T: Array, start: Array, of: Indices) -> Rung:
        """The step of some groups, (b,), at T, (b,) [s], from s = start, (b, c) [m]."""
        with np.errstate(all="ignore"):
            last = fixed_points(Program(self.groups.some(of), self.cone, T).at, start, MOST)
        return Rung(last.own, last.delta_q, last.forces, last.image)

    def level(self, of: Indices) -> Array:
        """No rise of any contact of some groups, shape (b, c) [m]."""
        return np.zeros((len(of), self.groups.phi.shape[1]))

    def slowly(self, of: Indices) -> Rung:
        """The slow step of some groups."""
        rung = self.rung(np.full(len(of), self.T), self.level(of), of)
        lost = np.flatnonzero(~rung.found)
        if lost.size:
            rung.put(lost, self._climbed(of[lost]))
        return rung

    def _climbed(self, of: Indices) -> Rung:
        """The slow step of some groups, to which steps of smaller T lead.

        What slides freely goes with T^2, and there s is sought.
        """
        T = float(self._soon(of).min())
        s = self.level(of)
        square = np.full((len(of), 1), T**2)
        while True:
            rung = self.rung(np.full(len(of), T), s * (T**2 / square), of)
            if T >= self.T:
                return rung
            on = rung.found[:, None]
            s = np.where(on, rung.s, s)
            square = np.where(on, T**2, square)
            T = min(FACTOR * T, self.T)

    def convex(self, of: Indices) -> tuple[Array, Array, Mask]:
        """The slow step of some groups by the convex law: by it, what slips rises.

        Returns
        -------
        delta_q : ndarray, shape (b, n)
        forces : ndarray, shape (b, c, 4)
            [N, N m]
        solved : ndarray of bool, shape (b,)
            Where there is an answer.
        """
        program = Program(self.groups.some(of), self.cone, np.full(len(of), self.T))
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
        return Slow(landed, self.cone, self.T, self._bodies)

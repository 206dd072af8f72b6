"""All solutions of a step under Coulomb's law in a polyhedral cone: none, one or several, proved.

Each contact of a solution is in a mode: it is open, and exerts nothing; or it is closed, and its
force is a combination of those rows of its cone along which friction does most work. These rows are
those of a face of the cone. With one mode for each contact the law is a system of linear
inequalities, and the solutions are those of finitely many systems. A search decides contact by
contact, and leaves out what is proved to have no solution. The page on both laws derives that it is
complete.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from flint import fmpq, fmpz

from quasistatic_ref.certify.form import StepForm
from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.formats.shown import Shown
from quasistatic_ref.optional.between import COULOMB_COUNT
from quasistatic_ref.optional.coulomb.cone_faces import Rows, faces
from quasistatic_ref.optional.coulomb.systems import Integers, System, in_integers, matrix
from quasistatic_ref.step.arrays import Array, Indices, read_only
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.groups import group_steps

NONE = "none"
ONE = "one"
SEVERAL = "several"
UNKNOWN = "unknown"

MOST_SYSTEMS = 5_000
"""Systems of a group that are looked at before nothing is said."""
MOST_CONTACTS = 8
"""Contacts of a group that may close: with more of them, nothing is looked at."""
MOST_ROWS = 16
"""Rows of a contact up to which the faces of its cone are listed."""


@dataclass(frozen=True, eq=False, repr=False)
class CoulombMode(Plain, Shown):
    """A solution of a group of contacts under Coulomb's law, or a convex set of solutions.

    Parameters
    ----------
    contacts : tuple of str
        Names of the group's contacts, then of the user's own rows.
    modes : tuple of str
        The mode of each: ``"open"``; ``"stick"``; ``"slide"`` and the rows of the cone that are
        most against its slip, such as ``"slide -d1 +spin"``; or ``"closed"``, without friction.
    coordinates : ndarray of int, shape (n,)
        The coordinates of the group.
    delta_q : ndarray, shape (n,)
        The solution [m, rad], correctly rounded; one of them where it is not isolated.
    isolated : bool
        Whether no other solution has these modes. Where one has, infinitely many have.
    """

    contacts: tuple[str, ...]
    modes: tuple[str, ...]
    coordinates: Indices
    delta_q: Array
    isolated: bool


@dataclass(frozen=True, eq=False, repr=False)
class CoulombSolutions(Plain, Shown):
    """How many displacements obey Coulomb's law, and which.

    Parameters
    ----------
    count : str
        ``"none"``, ``"one"`` or ``"several"``, each proved; or ``"unknown"``, which says nothing:
        the cone is curved, or there are too many modes.
    modes : tuple of tuple of CoulombMode
        The solutions of each independent group of contacts, of which those of the step are all
        combinations; empty where there are none or they are unknown.
    """

    count: str
    modes: tuple[tuple[CoulombMode, ...], ...] = ()

    def __str__(self) -> str:
        sets = [list(map(_in_words, modes)) for modes in self.modes]
        return f"{self.count}: " + "; and ".join(" or ".join(words) for words in sets)


def coulomb_solutions(step: StepData, most: int = MOST_SYSTEMS) -> CoulombSolutions:
    """All solutions of a step under Coulomb's law.

    Parameters
    ----------
    step : StepData
        SI units.
    most : int
        Systems of inequalities of each group that are looked at before its count is unknown.

    Returns
    -------
    CoulombSolutions

    Raises
    ------
    InputError
        If nothing can be proved in this thread: see :mod:`~quasistatic_ref.certify.arithmetic`.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> qr.coulomb_solutions(step).count
    'one'
    """
    if not cone(step.cone).polyhedral:
        return CoulombSolutions(UNKNOWN)
    modes: list[tuple[CoulombMode, ...]] = []
    unknown = False
    for group, group_step in group_steps(step):
        try:
            search = ModeSearch(group_step, most)
            pieces = search.distinct()
        except (TooMany, OverflowError):  # or integers that float64 does not hold
            unknown = True
            continue
        if not pieces:
            return CoulombSolutions(NONE)
        modes.append(tuple(search.mode(piece, group.coordinates) for piece in pieces))
    if unknown:
        return CoulombSolutions(UNKNOWN)
    single = all(len(of_group) == 1 and of_group[0].isolated for of_group in modes)
    return CoulombSolutions(ONE if single else SEVERAL, tuple(modes))


class TooMany(Exception):
    """More systems than are looked at."""


class Choice(NamedTuple):
    """What is decided of the mode of a contact.

    Parameters
    ----------
    loaded : tuple of int
        Rows whose multipliers may be positive: none of an open contact.
    closed : bool
        Whether the gap is zero; otherwise it is >= 0.
    face : tuple of int
        Rows along which the slip is least; empty where that is not decided.
    """

    loaded: Rows
    closed: bool
    face: Rows


OPEN = Choice((), closed=False, face=())


class Piece(NamedTuple):
    """A choice for each contact with a solution x, (n,) [units of the form]."""

    choices: tuple[Choice, ...]
    x: tuple[fmpq, ...]
    isolated: bool


class ModeSearch:
    """The modes of one group of contacts.

    Parameters
    ----------
    step : StepData
        Of the group; its cone is a polyhedron.
    most : int
    """

    def __init__(self, step: StepData, most: int) -> None:
        self.step = step
        self.most = most
        self.systems = 0
        self.form = form = StepForm(step)
        self.H, self.g, self.A, self.b, self.x_unit = in_integers(form)
        bounds = [*step.offsets.tolist(), *range(int(step.offsets[-1]) + 1, step.m + 1)]
        self.rows = [tuple(range(*ends)) for ends in pairwise(bounds)]
        if max(map(len, self.rows), default=0) > MOST_ROWS:
            raise TooMany
        self.faces = [
            [tuple(rows[i] for i in face) for face in faces(form.rows(rows))] for rows in self.rows
        ]
        # The sum of a contact's rows is its row J_n as often: slips cancel, since cones are even.
        self.A_n = [self.A[list(rows)].sum(axis=0) for rows in self.rows]
        self.b_n = [self.b[list(rows), 0].sum() for rows in self.rows]
        self.x_scale, self.lam_scale = self._scales()

    def distinct(self) -> list[Piece]:
        """The solutions: isolated ones once each, and none that belongs to a set that is listed.

        Raises
        ------
        TooMany
        """
        pieces: list[Piece] = []
        for piece in self.pieces():
            if not (piece.isolated and any(piece.x == other.x for other in pieces)):
                pieces.append(piece)
        sets = [piece for piece in pieces if not piece.isolated]
        return [
            piece
            for piece in pieces
            if not (piece.isolated and any(self._holds(other, piece.x) for other in sets))
        ]

    def pieces(self) -> Iterator[Piece]:
        """All choices of modes that have a solution, each with one.

        Raises
        ------
        TooMany
        """
        order = sorted(range(len(self.rows)), key=self._height)
        far = self._far()
        if far.count(False) > MOST_CONTACTS:
            raise TooMany
        start = [OPEN if far[j] else Choice(rows, False, ()) for j, rows in enumerate(self.rows)]
        ahead = [tuple(start)]
        while ahead:
            choices = ahead.pop()
            self.systems += 1
            if self.systems > self.most:
                raise TooMany
            system = self.system(choices)
            branch = self._branch(order, choices)
            if branch is None:
                point = system.solution()
                if point is not None:
                    isolated = not system.moves(point, self.form.n)
                    yield Piece(choices, tuple(point[: self.form.n]), isolated)
            elif system.guess[0] or system.solution() is not None:
                j, after = branch
                ahead += [(*choices[:j], choice, *choices[j + 1 :]) for choice in after]

    def _branch(
        self, order: Sequence[int], choices: Sequence[Choice]
    ) -> tuple[int, list[Choice]] | None:
        """A contact to decide on, and its choices: first which are closed, then their faces."""
        for j in order:
            if choices[j].loaded and not choices[j].closed:
                only = self.faces[j][0] if len(self.faces[j]) == 1 else ()
                return j, [OPEN, Choice(self.rows[j], True, only)]
        for j in order:
            if choices[j].closed and not choices[j].face:
                return j, [Choice(face, True, face) for face in self.faces[j]]
        return None

    def system(self, choices: Sequence[Choice]) -> System:
        """What the law says of x and of the multipliers y of loaded rows, with these choices."""
        n = self.form.n
        loaded = [i for choice in choices for i in choice.loaded]
        width = n + len(loaded)
        C = [np.concatenate([self.H, -self.A[loaded].T], axis=1)]  # H x - A'y = g
        d = [self.g[:, 0]]
        equal = [True] * n
        for j, (closed, face) in enumerate((c.closed, c.face) for c in choices):
            slips = []
            if face:
                slips = [i for i in self.rows[j] if i != face[0]]
            along = np.zeros((1 + len(slips), width), dtype=object)
            along[0, :n] = self.A_n[j]
            along[1:, :n] = self.A[slips] - self.A[list(face[:1])]
            C.append(along)
            d.append(np.array([self.b_n[j]] + [0] * len(slips), dtype=object))
            equal += [closed] + [i in face for i in slips]
        C.append(np.eye(width, dtype=int)[n:].astype(object))  # y >= 0
        d.append(np.zeros(len(loaded), dtype=object))
        equal += [False] * len(loaded)
        return System(
            C=np.concatenate(C),
            d=np.concatenate(d),
            equal=np.array(equal, dtype=bool),
            scale=np.concatenate([self.x_scale, self.lam_scale[loaded]]),
        )

    def mode(self, piece: Piece, coordinates: Indices) -> CoulombMode:
        """A piece in words and in SI units."""
        step = self.step
        delta_q = [float(Fraction(*_ratio(self.x_unit * x))) for x in piece.x]
        return CoulombMode(
            contacts=(*step.contacts.name, *step.extra.names),
            modes=tuple(self._word(j, piece) for j in range(len(self.rows))),
            coordinates=coordinates,
            delta_q=read_only(np.array(delta_q)),
            isolated=piece.isolated,
        )

    def _word(self, j: int, piece: Piece) -> str:
        """The mode of a contact: of an isolated solution its own, of a set that of all of it."""
        rows = self.rows[j]
        x = np.array(piece.x, dtype=object)
        face = piece.choices[j].face
        closed = piece.choices[j].closed
        if piece.isolated:
            motion = [self.A[i] @ x for i in rows]
            face = tuple(i for i, moved in zip(rows, motion, strict=True) if moved == min(motion))
            closed = self.A_n[j] @ x == self.b_n[j]
        if not closed:
            return "open"
        if len(self.faces[j]) == 1:
            return "closed"
        if face == rows:
            return "stick"
        names = cone(self.step.cone).row_names
        return " ".join(["slide", *(names[i - rows[0]] for i in face)])

    def _holds(self, piece: Piece, x: Sequence[fmpq]) -> bool:
        """Whether x is a solution in the modes of a piece."""
        system = self.system(piece.choices)
        n = self.form.n
        known = np.zeros((n, system.C.shape[1]), dtype=object)
        ratios = [_ratio(number) for number in x]
        known[range(n), range(n)] = [q for _, q in ratios]
        return system.with_equations(known, np.array([p for p, _ in ratios])).solution() is not None

    def _far(self) -> list[bool]:
        """Which contacts are open in all solutions, because no solution moves as far.

        Where standing still is allowed, forces of a solution do no work: x'Hx <= g'x. These x are
        the ball in the H norm that has 0 and x_0 = H^-1 g at opposite ends, and J_n x is at least
        J_n x_0 / 2 - |J_n| |x_0| / 2 in it, in the norms of H^-1 and H.
        """
        if any(b > 0 for b in self.b[:, 0]):
            return [False] * len(self.rows)
        by = matrix(np.column_stack([self.g[:, 0], *self.A_n]))
        moved = matrix(self.H).solve(by)  # x_0, and H^-1 J_n' of each contact
        half = [[moved[v, k] for v in range(self.form.n)] for k in range(len(self.rows) + 1)]
        square = _product(self.g[:, 0], half[0])
        far = []
        for J_n, b_n, H_J in zip(self.A_n, self.b_n, half[1:], strict=True):
            twice = _product(J_n, half[0]) - 2 * b_n
            far.append(bool(twice > 0 and twice * twice > _product(J_n, H_J) * square))
        return far

    def _scales(self) -> tuple[Indices, Indices]:
        """Exponents of sizes of x and of multipliers, in the units of the form."""
        H = np.diag(self.H).astype(np.float64)
        A = self.A.astype(np.float64)
        b = self.b[:, 0].astype(np.float64)
        pushed = np.sqrt((A * A / H).sum(axis=1))  # |a| in the norm of the inverse of H's diagonal
        pushed[pushed == 0] = 1.0
        free = np.linalg.norm(self.g[:, 0].astype(np.float64) / np.sqrt(H))
        length = max(free, float(np.abs(b / pushed).max(initial=0.0))) or 1.0
        return np.frexp(length / np.sqrt(H))[1], np.frexp(length / pushed)[1]

    def _height(self, j: int) -> float:
        """The gap of a contact before the step, over what moves it most easily."""
        first = self.rows[j][0]
        gap = -float(self.b_n[j]) / len(self.rows[j])
        return float(np.ldexp(gap, int(self.lam_scale[first])))


def _in_words(mode: CoulombMode) -> str:
    words = ", ".join(f"{n} {m}" for n, m in zip(mode.contacts, mode.modes, strict=True))
    return words if mode.isolated else f"{words} (a set of solutions)"


def _product(a: Integers, x: Sequence[fmpq]) -> fmpq:
    return sum((number * fmpz(i) for i, number in zip(a, x, strict=True)), fmpq(0))


def _ratio(number: fmpq) -> tuple[int, int]:
    return int(number.p), int(number.q)


COULOMB_COUNT.fill(lambda step, most: coulomb_solutions(step, most).count)

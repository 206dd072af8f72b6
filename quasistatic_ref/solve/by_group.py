"""Programs by group: where each number of a step stands in the matrices of its groups.

The groups of a run are those of its structure: which coordinates can move which contact, and which
entries of H can be nonzero. They are found once. A step's numbers may have zeros there by chance;
what is proved of it goes by the groups that its numbers have.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from quasistatic_ref.certify.groups import Groups, groups
from quasistatic_ref.certify.norm import EnergyNorm, energy_norm, norm_of_hessian
from quasistatic_ref.numbers.arrays import Array, Indices, all_finite, read_only
from quasistatic_ref.numbers.compiled import compiled
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.hessian import Hessian
from quasistatic_ref.step.standard_form import StandardForm, Units


class NaturalHessian(NamedTuple):
    """H of steps in their natural units, by groups.

    Parameters
    ----------
    unit : ndarray, shape (n_v,)
        Diagonal of S [m or rad, per (N m s)^0.5].
    own_unit : ndarray, shape (m_c, w)
        The same of the own columns of each contact's rows [m or rad, per (N m s)^0.5].
    blocks : list of ndarray, shape (n, n)
        H of each group in these units [-].
    inverse, column : ndarray and ndarray of int, shapes (n_v, w)
        Of each coordinate, group by group, a row of the L^-1 that measures how far an impulse moves
        its group, L L' = H, and which coordinates its columns are; n_v stands for none.
    """

    unit: Array
    own_unit: Array
    blocks: list[Array]
    inverse: Array
    column: Indices

    def free_lengths(self, g: Array) -> Array:
        """||H^-1 g||_H of impulses, (..., n_v) [N s, N m s]: shape (...) [(N m s)^0.5]."""
        if not g.shape[-1]:
            return np.zeros(g.shape[:-1])
        padded = np.concatenate([g, np.zeros((*g.shape[:-1], 1))], axis=-1)
        moved = self.inverse * padded[..., self.column]
        return np.asarray(np.hypot.reduce(np.add.accumulate(moved, axis=-1)[..., -1], axis=-1))


class GroupPrograms(NamedTuple):
    """min 1/2 x'Hx - g'x subject to A x >= b of each group, one after the other: natural units [-].

    Parameters
    ----------
    layout : GroupIndex
    blocks : list of ndarray, shape (n, n) [-]
        H of each group.
    g, A, b : ndarray
        Of all groups; A has a last place for what is in no group.
    """

    layout: GroupIndex
    blocks: list[Array]
    g: Array
    A: Array
    b: Array

    @property
    def finite(self) -> bool:
        """Whether all numbers are finite."""
        return all(map(all_finite, (self.g, self.A, self.b)))

    def joined(self, each: Sequence[Array]) -> Array:
        """A vector of the step, (n_v,), from `each` group's, (n,) [any unit]."""
        x = np.zeros(len(self.g))
        x[self.layout.coordinates] = np.concatenate(each)
        return x

    @property
    def forms(self) -> list[StandardForm]:
        """The matrices of each group: views."""
        return [
            StandardForm(H, self.g[n], self.A[s].reshape(m.stop - m.start, len(H)), self.b[m])
            for H, (n, s, m) in zip(self.blocks, self.layout.slices, strict=True)
        ]


class GroupIndex:
    """Where the numbers of steps of one structure stand, one group after the other.

    Parameters
    ----------
    every : Groups
    column : ndarray of int, shape (n_c, w)
        The own columns of each contact; n_v stands for none.
    counts : ndarray of int, shape (n_c,)
        Number of rows of each contact.
    n_v, e : int
        Numbers of coordinates, and of rows of a user's own.
    entries : int
        How many entries of H may be nonzero.

    Attributes
    ----------
    coordinates, rows : ndarray of int, shapes (n_v,) and (m,)
        Of all groups, one after the other.
    column : ndarray of int, shape (m_c, w)
        Of each row of the contacts its own columns.
    slices : list of (slice, slice, slice)
        Where g, A and b of each group stand.
    size : int
        How many numbers A has.
    place : ndarray of int, shape (m_c, w)
        Where the own columns of each row of the contacts stand in A.
    """

    def __init__(
        self, every: Groups, column: Indices, counts: Indices, n_v: int, e: int, entries: int
    ) -> None:
        self.groups = every
        self.entries = entries
        self.coordinates = np.concatenate([group.coordinates for group in every])
        self.rows = np.concatenate([group.rows for group in every])
        widths = np.array([len(group.coordinates) for group in every])
        heights = np.array([len(group.rows) for group in every])
        sizes = widths * heights
        self.slices = [*zip(*map(_slices, (widths, sizes, heights)), strict=True)]
        self.size = int(sizes.sum())
        number = np.arange(len(every))
        # Of each coordinate, and of none, and of each row: its group and its number in that.
        of_coordinate = np.full(n_v + 1, -1)
        within = np.zeros(n_v + 1, np.int64)
        of_row = np.zeros(len(self.rows), np.int64)
        start = np.zeros(len(self.rows), np.int64)
        of_coordinate[self.coordinates] = np.repeat(number, widths)
        within[self.coordinates] = _counted(widths)
        of_row[self.rows] = np.repeat(number, heights)
        start[self.rows] = np.repeat(widths, heights) * _counted(heights)
        start += (np.cumsum(sizes) - sizes)[of_row]

        def place(some: Indices, rows: slice) -> Indices:
            inside = of_coordinate[some] == of_row[rows, None]
            return np.where(inside, start[rows, None] + within[some], self.size)

        m_c = len(of_row) - e
        self.column = np.repeat(column, counts, axis=0)
        self.place = place(self.column, slice(0, m_c))
        self._place_extra = place(np.broadcast_to(np.arange(n_v), (e, n_v)), slice(m_c, None))

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != "write"}  # by C

    def natural_hessian(self, hessian: Hessian) -> NaturalHessian:
        """H without a user's cost in natural units; StepDataError as of the norm."""
        parts = [hessian.part(group.coordinates) for group in self.groups]
        with np.errstate(all="ignore"):  # of what is refused
            return self._natural([H.matrix for H in parts], [norm_of_hessian(H) for H in parts])

    def natural_hessian_of(self, step: StepData) -> NaturalHessian:
        """H of a step in natural units: formed once for all steps that share theirs."""
        if step.extra.cost is None:
            return step.hessian.once(self.natural_hessian)
        every = [step.H[np.ix_(c, c)] for c, *_ in self.groups]
        return self._natural(every, [energy_norm(H) for H in every])

    def _natural(self, every: list[Array], norms: list[EnergyNorm]) -> NaturalHessian:
        unit = np.zeros(len(self.coordinates))
        units = [coordinate_units(H.diagonal()) for H in every]
        unit[self.coordinates] = np.concatenate(units)
        blocks = [H * np.outer(S, S) for H, S in zip(every, units, strict=True)]
        n_v = len(unit)
        widest = max(map(len, every), default=0)
        inverse = np.zeros((n_v, widest))
        column = np.full((n_v, widest), n_v)
        end = 0
        for group, norm in zip(self.groups, norms, strict=True):
            start, end = end, end + len(group.coordinates)
            inverse[start:end, : end - start] = norm.inverse * norm.unit
            column[start:end, : end - start] = group.coordinates
        own_unit = read_only(np.append(unit, 0.0)[self.column])
        return NaturalHessian(read_only(unit), own_unit, blocks, inverse, column)

    def empty_programs(self, H: NaturalHessian) -> GroupPrograms:
        """Programs of steps with an H, of which nothing else is written."""
        A = np.zeros(self.size + 1)
        return GroupPrograms(self, H.blocks, np.empty(len(H.unit)), A, np.empty(len(self.rows)))

    @compiled
    def write(
        self,
        A: Array,
        b: Array,
        g: Array,
        A_extra: Array,
        units: Units,
        H: NaturalHessian,
        programs: GroupPrograms,
    ) -> tuple[GroupPrograms, bool]:
        """The groups' programs in natural units, written; and whether all numbers are finite.

        Parameters
        ----------
        A : ndarray, shape (m_c, w)
            Own columns of the contacts' rows [m].
        b, g : ndarray, shapes (m,) and (n_v,)
            Of the step.
        A_extra : ndarray, shape (e, n_v)
            Of a user's own rows [m, rad].
        units : Units
        H : NaturalHessian
            Of the step.
        programs : GroupPrograms
            Empty ones, or those of another step.
        """
        S, ell, rho = units
        programs.A[self.place] = A * (H.own_unit / ell)
        if len(A_extra):
            programs.A[self._place_extra] = A_extra * (S / ell)
        programs.g[:] = (g * S / rho)[self.coordinates]
        programs.b[:] = (b / (rho * ell))[self.rows]
        return programs, programs.finite


def layout_of(step: StepData) -> GroupIndex:
    """The layout of a step by the groups that its numbers have; one object for the same."""
    contacts = step.contacts
    column = contacts.column
    counts = step.counts
    sizes = step.n_v, len(step.extra.names), len(step.hessian.entries[0])
    return _layout(groups(step), column.tobytes(), column.shape, counts.tobytes(), *sizes)


@lru_cache(maxsize=32)
def _layout(
    every: Groups,
    column: bytes,
    shape: tuple[int, int],
    counts: bytes,
    n_v: int,
    e: int,
    entries: int,
) -> GroupIndex:
    columns = np.frombuffer(column, np.int64).reshape(shape)
    return GroupIndex(every, columns, np.frombuffer(counts, np.int64), n_v, e, entries)


def coordinate_units(diagonal: Array) -> Array:
    """Diagonal of S, shape (n_v,) [m or rad, per (N m s)^0.5], from the `diagonal` of H."""
    return powers_of_two(1 / np.sqrt(diagonal))


def powers_of_two(x: Array | float) -> Array:
    """The power of two next to each of positive numbers, in their shape."""
    return np.exp2(np.round(np.log2(x)))


def _slices(sizes: Indices) -> list[slice]:
    ends = np.cumsum(sizes).tolist()
    return [slice(end - size, end) for size, end in zip(sizes.tolist(), ends, strict=True)]


def _counted(sizes: Indices) -> Indices:
    """0, 1, ... of each of some ranges, one after the other."""
    return np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)

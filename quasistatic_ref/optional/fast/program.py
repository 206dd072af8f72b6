"""A step's program in natural units, group by group, and DAQP's workspace of each group."""

from collections.abc import Sequence
from typing import Any

import daqp
import numpy as np

from quasistatic_ref.certify.groups import Group
from quasistatic_ref.certify.norm import energy_norm
from quasistatic_ref.numbers.arrays import Array, all_finite, read_only
from quasistatic_ref.optional.compiled.library import Structure, library
from quasistatic_ref.optional.fast.joined import Masses
from quasistatic_ref.optional.fast.steps import Steps
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.solver import Reply
from quasistatic_ref.solve.units import coordinate_units
from quasistatic_ref.step.standard_form import StandardForm, Units

STATUS = {1: "optimal", 2: "soft optimal", -1: "infeasible", -2: "cycling", -3: "unbounded",
          -4: "iteration limit", -5: "not convex", -6: "overdetermined"}  # fmt: skip


class Program:
    """min 1/2 x'Hx + f'x subject to A x >= b of each group: arrays that are rewritten at each step.

    Parameters
    ----------
    groups : sequence of Group

    Attributes
    ----------
    coordinates, rows : ndarray of int, shapes (n_v,) and (m,)
        Of all groups, one after the other.
    widths, heights : ndarray of int
        How many of these each group has.
    f, A, b : ndarray
        Of all groups, one after the other; f = -g.
    parts : list of (ndarray, ndarray, ndarray)
        f (n,), A (m, n) and b (m,) of each group: views.
    within : list of Group
        Each group, counted in itself.
    """

    def __init__(self, groups: Sequence[Group]) -> None:
        self.groups = [*groups]
        self.within = [Group._make(np.arange(len(of)) for of in group) for group in groups]
        self.coordinates = np.concatenate([group.coordinates for group in groups])
        self.rows = np.concatenate([group.rows for group in groups])
        self.widths = np.array([len(group.coordinates) for group in groups])
        self.heights = np.array([len(group.rows) for group in groups])
        sizes = self.widths * self.heights
        self.f = np.zeros(len(self.coordinates))
        self.A = np.zeros(1 + sizes.sum())[:-1]  # there is a place for what is in no group
        self.b = np.zeros(len(self.rows))
        every_f = np.split(self.f, np.cumsum(self.widths)[:-1])
        every_A = np.split(self.A, np.cumsum(sizes)[:-1])
        every_b = np.split(self.b, np.cumsum(self.heights)[:-1])
        self.parts = [
            (f, A.reshape(len(b), len(f)), b)
            for f, A, b in zip(every_f, every_A, every_b, strict=True)
        ]

    def has_all_of(self, natural: StandardForm) -> bool:
        """Whether nothing couples two groups in matrices in natural units."""
        if len(self.groups) == 1:
            return True
        group_of = np.zeros(len(self.coordinates), np.int64)
        of_row = np.zeros(len(self.rows), np.int64)
        for i, group in enumerate(self.groups):
            group_of[group.coordinates] = i
            of_row[group.rows] = i
        within_H = group_of[:, None] == group_of
        within_A = of_row[:, None] == group_of
        return not (natural.H[~within_H].any() or natural.A[~within_A].any())

    def write(self, natural: StandardForm) -> None:
        """Write the program of a step from its matrices in natural units."""
        self.f[:] = -natural.g[self.coordinates]
        self.b[:] = natural.b[self.rows]
        for group, (_, A, _) in zip(self.groups, self.parts, strict=True):
            A[:] = natural.A[np.ix_(group.rows, group.coordinates)]

    def blocks(self, H: Array) -> list[Array]:
        """The blocks of H (n_v, n_v), one for each group, in natural units [-]."""
        every = [group.coordinates for group in self.groups]
        return [np.ascontiguousarray(H[np.ix_(i, i)]) for i in every]

    def joined(self, replies: Sequence[Reply]) -> Reply:
        """The reply to the whole program from the replies to its groups: solved if all are."""
        if len(replies) == 1:
            return replies[0]
        x = np.zeros(len(self.coordinates))
        lam = np.zeros(len(self.rows))
        x[self.coordinates] = np.concatenate([reply.x for reply in replies])
        lam[self.rows] = np.concatenate([reply.lam for reply in replies])
        worst = min(replies, key=lambda reply: reply.solved)
        iterations = sum(reply.iterations or 0 for reply in replies)
        seconds = sum(reply.seconds or 0.0 for reply in replies)
        return Reply(x, lam, worst.solved, worst.status, iterations, seconds)


class Workspace:
    """DAQP's workspace of one group, whose active set is kept.

    Parameters
    ----------
    H : ndarray, shape (n, n)
        Of the first step, in natural units [-], as all of these.
    f, A, b : ndarray, shapes (n,), (m, n) and (m,)
        Rewritten at each step [-].
    options : dict
        DAQP's own.
    """

    def __init__(self, H: Array, f: Array, A: Array, b: Array, options: Options) -> None:
        self._f = f
        self._A = A
        self._b = b
        self._cold = np.zeros(len(b), np.int32)
        self._warm = False
        self._options = options
        if len(b):
            self._set_up(H)

    def _set_up(self, H: Array) -> None:
        """Prepare a new workspace for the matrix H."""
        self._H = H
        self._model: Any = daqp.Model()
        self._model.settings = self._options
        above = np.full(len(self._b), np.inf)
        self._model.setup(H, self._f, self._A, above, self._b, self._cold)

    def reply(self, H: Array) -> Reply:
        """Solve the program as it stands: from the answer before, if there is one, then cold.

        A workspace that has had no finite answer may have none for ever: it is set up again.
        """
        if not len(self._b):
            x = np.asarray(np.linalg.solve(H, -self._f), dtype=np.float64)
            return Reply(x, np.zeros(0), True, "optimal", 0)
        reply = self._solved(H, warm=True) if self._warm else None
        if reply is None or not reply.solved:
            reply = self._solved(H, warm=False)
        if not all_finite(reply.answer[0]):
            self._set_up(H)
            reply = self._solved(H, warm=False)
        self._warm = reply.solved
        return reply

    def _solved(self, H: Array, *, warm: bool) -> Reply:
        changes: dict[str, Any] = {"f": self._f, "A": self._A, "blower": self._b}
        if not warm or H is not self._H:  # else DAQP keeps its factor, with the same bits
            changes["H"] = self._H = H
        if not warm:
            changes["sense"] = self._cold
        self._model.update(**changes)
        x, _, flag, info = self._model.solve()
        lam = 0.0 - info["lam"]  # those of lower bounds are negative
        status = STATUS.get(flag) or str(flag)
        return Reply(x, lam, flag == 1, status, info["iterations"], info["solve_time"])


class Workspaces:
    """The DAQP workspaces of all groups of a program.

    Parameters
    ----------
    program : Program
    blocks : list of ndarray, shape (n, n)
        H of each group in natural units [-].
    options : dict
        DAQP's own.
    """

    def __init__(self, program: Program, blocks: Sequence[Array], options: Options) -> None:
        self.program = program
        self._each = [
            Workspace(H, *part, options) for H, part in zip(blocks, program.parts, strict=True)
        ]

    def reply(self, blocks: Sequence[Array]) -> Reply:
        """Solve the program as it stands, with these `blocks` of H, each of shape (n, n) [-]."""
        both = zip(self._each, blocks, strict=True)
        return self.program.joined([one.reply(H) for one, H in both])


class NaturalProgram:
    """Writes the steps of a simulator into a program, in C.

    Parameters
    ----------
    steps : Steps
    program : Program
        Of their groups.

    Attributes
    ----------
    blocks : list of ndarray, shape (n, n)
        H of each group in natural units [-].
    masses : Masses or None
        Of which these were formed.
    """

    def __init__(self, steps: Steps, program: Program) -> None:
        self.program = program
        self.blocks: list[Array] = []
        self.masses: Masses | None = None
        self._coordinate = np.zeros(0)
        n = len(program.coordinates)
        m = len(program.rows)
        rows = steps.rows
        column = np.repeat(steps.column, rows["rows"], axis=0)
        within = np.zeros(n + 1, np.int64)
        start = np.zeros(m, np.int64)
        first = 0
        for group in program.groups:
            width = len(group.coordinates)
            within[group.coordinates] = np.arange(width)
            start[group.rows] = first + width * np.arange(len(group.rows))
            first += width * len(group.rows)
        there = column < n
        self._structure = Structure(
            "Natural",
            {
                "n": n, "m": m, "groups": len(program.groups), "columns": column.shape[1],
                "width": program.widths, "coordinate": program.coordinates, "row": program.rows,
                "column": np.where(there, column, 0),
                "place": np.where(there, start[:, None] + within[column], first),
                "g": rows["g"], "A": rows["A"], "b": rows["b"],
                "unit": np.zeros(n), "squared": np.zeros(n),
                "inverse": np.zeros(np.square(program.widths).sum()),
                "squares": np.zeros(m), "units": np.zeros(2),
                "f": program.f, "natural_A": program.A, "natural_b": program.b,
            },
        )  # fmt: skip

    def take(self, masses: Masses) -> None:
        """Set the matrix H of the steps that are written from now on."""
        groups = self.program.groups
        every = [masses.of(group.coordinates) for group in groups]
        units = [coordinate_units(np.diag(H)) for H in every]
        roots = [norm.inverse * norm.unit for norm in map(energy_norm, every)]
        structure = self._structure
        coordinates = self.program.coordinates
        structure["unit"][coordinates] = np.concatenate(units)
        structure["squared"][:] = np.square(structure["unit"])
        structure["inverse"][:] = np.concatenate([(root.T @ root).ravel() for root in roots])
        self._coordinate = read_only(structure["unit"].copy())
        self.blocks = [H * np.outer(S, S) for H, S in zip(every, units, strict=True)]
        self.masses = masses

    def units(self) -> Units | None:
        """The natural units of the step that was formed last.

        None where the rounding of a sum, which depends on its order, decides on a unit.
        """
        if not library().natural_units(self._structure.pointer):
            return None
        length, size = self._structure["units"].tolist()
        return Units(self._coordinate, length, size)

    def write(self, units: Units) -> None:
        """Write the step that was formed last into `program`, in natural `units` of this step."""
        self._structure["units"][:] = units.length, units.size
        library().natural_program(self._structure.pointer)

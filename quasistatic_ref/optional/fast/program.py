"""A step's program in natural units, group by group, and DAQP's workspace of each group."""

from collections.abc import Sequence
from typing import Any

import daqp
import numpy as np

from quasistatic_ref.optional.fast.library import Structure, library
from quasistatic_ref.optional.fast.steps import Steps
from quasistatic_ref.solve.backends import Options
from quasistatic_ref.solve.reply import Reply
from quasistatic_ref.solve.units import HessianInBothUnits, Units
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.groups import Group
from quasistatic_ref.step.standard_form import StandardForm

STATUS = {1: "optimal", 2: "soft optimal", -1: "infeasible", -2: "cycling", -3: "unbounded",
          -4: "iteration limit", -5: "not convex", -6: "overdetermined"}  # fmt: skip
MOST = 1024
"""Most coordinates for which ``OFF`` in natural.c is enough."""


class Program:
    """min 1/2 x'Hx + f'x subject to A x >= b of each group: arrays that are rewritten at each step.

    Parameters
    ----------
    groups : sequence of Group

    Attributes
    ----------
    f, A, b : ndarray
        Of all groups, one after the other; f = -g.
    parts : list of (ndarray, ndarray, ndarray)
        f (n,), A (m, n) and b (m,) of each group: views.
    """

    def __init__(self, groups: Sequence[Group]) -> None:
        self.groups = [*groups]
        widths = [len(group.coordinates) for group in groups]
        heights = [len(group.rows) for group in groups]
        self.coordinates = np.concatenate([group.coordinates for group in groups])
        self.rows = np.concatenate([group.rows for group in groups])
        sizes = [width * height for width, height in zip(widths, heights, strict=True)]
        self.f = np.zeros(sum(widths))
        self.A = np.zeros(sum(sizes))
        self.b = np.zeros(sum(heights))
        self.first_entry = np.cumsum([0, *sizes])
        self.parts = [
            (f, A.reshape(-1, width), b)
            for width, f, A, b in zip(
                widths,
                np.split(self.f, np.cumsum(widths)[:-1]),
                np.split(self.A, self.first_entry[1:-1]),
                np.split(self.b, np.cumsum(heights)[:-1]),
                strict=True,
            )
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

    def joined(self, replies: Sequence[Reply]) -> Reply:
        """The reply to all of it from those to its groups: solved if all of them are."""
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
    """DAQP's workspace of one group: H is factorised when it changes, the active set is kept.

    Parameters
    ----------
    H : ndarray, shape (n, n)
        In natural units [-], as all of these.
    f, A, b : ndarray, shapes (n,), (m, n) and (m,)
        Rewritten at each step [-].
    options : dict
        DAQP's own.
    """

    def __init__(self, H: Array, f: Array, A: Array, b: Array, options: Options) -> None:
        self._H = H
        self._f = f
        self._A = A
        self._b = b
        self._cold = np.zeros(len(b), np.int32)
        self._new_H = False
        self._warm = False
        if len(b):
            self._model: Any = daqp.Model()
            self._model.settings = options
            self._model.setup(H, f, A, np.full(len(b), np.inf), b, self._cold)

    def renew(self, H: Array) -> None:
        """Take another H, shape (n, n)."""
        self._H = H
        self._new_H = True

    def reply(self) -> Reply:
        """Solve the program as it stands: from the answer before, if there is one, then cold."""
        if not len(self._b):
            x = np.asarray(np.linalg.solve(self._H, -self._f), dtype=np.float64)
            return Reply(x, np.zeros(0), True, "optimal", 0)
        reply = self._solved(warm=True) if self._warm else None
        if reply is None or not reply.solved:
            reply = self._solved(warm=False)
        self._warm = reply.solved
        return reply

    def _solved(self, *, warm: bool) -> Reply:
        H = self._H if self._new_H else None
        sense = None if warm else self._cold
        self._model.update(H=H, f=self._f, A=self._A, blower=self._b, sense=sense)
        self._new_H = False
        x, _, flag, info = self._model.solve()
        lam = 0.0 - info["lam"]  # those of lower bounds are negative
        status = STATUS.get(flag) or str(flag)
        return Reply(x, lam, flag == 1, status, info["iterations"], info["solve_time"])


class Workspaces:
    """Those of all groups of a program.

    Parameters
    ----------
    program : Program
    hessian : HessianInBothUnits
    options : dict
        DAQP's own.
    """

    def __init__(self, program: Program, hessian: HessianInBothUnits, options: Options) -> None:
        self.program = program
        self._hessian = hessian
        blocks = self._blocks(hessian)
        self._each = [
            Workspace(H, *part, options) for H, part in zip(blocks, program.parts, strict=True)
        ]

    def _blocks(self, hessian: HessianInBothUnits) -> list[Array]:
        """The block of each group of H in natural units."""
        H = hessian.natural_H
        every = [group.coordinates for group in self.program.groups]
        return [np.ascontiguousarray(H[np.ix_(i, i)]) for i in every]

    def reply(self, hessian: HessianInBothUnits) -> Reply:
        """Solve the program as it stands, with that H."""
        if hessian is not self._hessian:
            self._hessian = hessian
            for one, H in zip(self._each, self._blocks(hessian), strict=True):
                one.renew(H)
        return self.program.joined([one.reply() for one in self._each])


class NaturalProgram:
    """Writes the steps of a simulator into a program, in C.

    Parameters
    ----------
    steps : Steps
    program : Program
        Of their groups.
    """

    def __init__(self, steps: Steps, program: Program) -> None:
        self.program = program
        layout = steps.template.row_layout
        kept = steps.kept
        n_c = len(layout.counts)
        n = len(program.coordinates)
        m = len(program.rows)
        place = np.zeros(n, np.int64)
        place[program.coordinates] = np.arange(n)
        row_place = np.zeros(m, np.int64)
        row_place[program.rows] = np.arange(m)
        fields = {name: np.zeros(n_c, np.int64) for name in ("first_entry", "first_row", "width")}
        column = np.zeros((n_c, kept.most_kept), np.int64)
        for group, start in zip(program.groups, program.first_entry, strict=False):
            width = len(group.coordinates)
            for c in group.contacts.tolist():
                row = int(layout.offsets[c])
                within = int(np.searchsorted(group.rows, row))
                columns = kept.coordinate[c, : kept.kept[c]]
                fields["first_entry"][c] = start + within * width
                fields["first_row"][c] = row_place[row] if layout.counts[c] else 0
                fields["width"][c] = width
                column[c, : kept.kept[c]] = np.searchsorted(group.coordinates, columns)
        self._of_hessian = {
            "unit": np.zeros(n),
            "squared": np.zeros(n),
            "inverse": np.zeros((n, n)),
        }
        self._units = np.zeros(2)
        self._hessian: HessianInBothUnits | None = None
        rows = steps.rows
        self._structure = Structure(
            "Natural",
            {
                "n": n, "m": m, "n_c": n_c, "most_kept": kept.most_kept, "rows": rows["rows"],
                "kept": kept.kept, "coordinate": rows["coordinate"], "place": place, **fields,
                "column": column, "g": rows["g"], "kept_A": rows["kept_A"], "b": rows["b"],
                **self._of_hessian, "squares": np.zeros(m), "units": self._units,
                "f": program.f, "natural_A": program.A, "natural_b": program.b,
            },
        )  # fmt: skip

    def write(self, hessian: HessianInBothUnits) -> Units | None:
        """Write the program of the step that was formed last, and return its natural units.

        None where the rounding of a sum, which depends on its order, decides on a unit.
        """
        compiled = library()
        pointer = self._structure.pointer
        if hessian is not self._hessian:
            self._hessian = hessian
            self._of_hessian["unit"][:] = hessian.coordinate
            self._of_hessian["squared"][:] = hessian.squared
            self._of_hessian["inverse"][:] = hessian.H_inverse
        if len(hessian.coordinate) > MOST or not compiled.natural_units(pointer):
            return None
        compiled.natural_program(pointer)
        length, size = self._units.tolist()
        return Units(hessian.coordinate, length, size)

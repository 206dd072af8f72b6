"""The point of least norm on a face of optima: a program in the few directions that are free."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property

from flint import arb, arb_mat, fmpq, fmpz

from quasistatic_ref.exact.active_set import Combination
from quasistatic_ref.exact.minimiser import Minimiser
from quasistatic_ref.exact.program import EXACT, MatrixProgram, whole_numbers
from quasistatic_ref.exact.qp.block import along, matrix_form
from quasistatic_ref.exact.qp.face import Face
from quasistatic_ref.exact.working_set import KktPoint
from quasistatic_ref.numbers.precision import working_precision


class LeastNorm:
    """min |x + N w|^2 over w: the point of a face nearest to zero that no other row forbids.

    Parameters
    ----------
    face : Face
        With free directions N.
    """

    def __init__(self, face: Face) -> None:
        self.face, block = face, face.block
        held = {*face.W}
        rows = [i for i in range(block.m) if i not in held]
        self.moved = {
            i: along_N
            for i in rows
            if any(along_N := [along(block.row(i).entries, n) for n in face.N])
        }
        still = {i: face.slack(i) for i in rows if i not in self.moved}
        self.possible = all(s >= 0 and (i >= block.equations or not s) for i, s in still.items())
        self.rows = [*self.moved]  # equations first

    @cached_property
    def form(self) -> MatrixProgram:
        """The program in w, each direction scaled to be near one, w times d of the face."""
        face, shift = self.face, int(self.face.d).bit_length()
        slack = {i: face.slack(i) for i in self.rows}
        with working_precision(EXACT):
            shares = [arb(2) ** -self._bits(n) for n in face.N]
            columns = [[arb(v) * s for v in n] for n, s in zip(face.N, shares, strict=True)]
            N = arb_mat(columns).transpose()
            x = arb_mat(len(face.X), 1, face.X) * arb(2) ** -shift
            rows = []
            for i in self.rows:
                common = slack[i].q if isinstance(slack[i], fmpq) else fmpz(1)
                entries = [arb(v * common) * s for v, s in zip(self.moved[i], shares, strict=True)]
                rows.append([*entries, arb((fmpq(slack[i]) * common).p) * arb(2) ** -shift])
            H, g = N.transpose() * N, -(N.transpose() * x)
        equations = sum(i < face.block.equations for i in self.rows)
        return matrix_form(H, g, rows, equations)

    @staticmethod
    def _bits(direction: Sequence[fmpz]) -> int:
        return max(int(abs(v)).bit_length() for v in direction)

    def optimum(
        self, strict: Callable[[MatrixProgram], Minimiser | Combination]
    ) -> tuple[Face, list[int]] | None:
        """The face at its point nearest to zero, and the rows that bear there; or None."""
        if not self.possible:
            return None
        end = strict(self.form)
        if isinstance(end, Combination):
            return None
        return self.at(end.fractions), [self.rows[t] for t in end.working]

    def at(self, point: KktPoint) -> Face:
        """The face at the point of some w."""
        face, shift = self.face, int(self.face.d).bit_length()
        with working_precision(EXACT):
            numbers = [
                v * arb(2) ** (shift - self._bits(n)) for v, n in zip(point.x, face.N, strict=True)
            ]
            *w, D = whole_numbers([*numbers, point.denominator])
        return face.at(w, D)

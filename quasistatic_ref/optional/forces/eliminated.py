"""The step with compliance in delta_q alone, without rounding: contact forces, proved.

See :mod:`~quasistatic_ref.optional.forces.forces`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import lcm
from typing import Final

import numpy as np
from flint import arb, arb_mat

from quasistatic_ref.certify.failures import StepInfeasible
from quasistatic_ref.certify.farkas import farkas_vector
from quasistatic_ref.certify.step_program import StepProgram
from quasistatic_ref.exact.active_set import Combination, dual_active_set
from quasistatic_ref.exact.minimiser import Minimiser
from quasistatic_ref.exact.program import EXACT, MatrixProgram, Row, columns
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.numbers.precision import working_precision
from quasistatic_ref.optional.forces.faces import Rows, face, nearest_face
from quasistatic_ref.optional.friction import scaled_by
from quasistatic_ref.step.data import StepData

PROOFS: Final = 30
"""Newton iterations in exact numbers, at most."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """The optimum with compliance if the force of each contact lay on a given face.

    Parameters
    ----------
    minimiser : Minimiser
        The minimiser of a program in delta_q. Its rows are the conditions of the faces, contact by
        contact, then the user's own rows.
    s : arb_mat
        Rows of [delta_q; 1]: s times the coefficients of friction and the scale, shape
        (4 n_c, n_v + 1) [m, m^2].
    scale : int
    """

    minimiser: Minimiser
    s: arb_mat
    scale: int


class EliminatedStep:
    """The step with compliance in delta_q alone, without rounding.

    Parameters
    ----------
    step : StepData
    compliance : float
        [m/N].
    """

    def __init__(self, step: StepData, compliance: float) -> None:
        self.step = step
        self.form = StepProgram(step)
        self.compliance = arb(compliance)
        self.z = [*map(self.form.motion, range(step.contacts.n_c))]
        self.extra_rows = self.form.exact_rows(range(int(step.offsets[-1]), step.m))

    def candidate(self, faces: Sequence[Rows]) -> Candidate:
        """The optimum on the face of each contact, in a polyhedral cone.

        Raises
        ------
        StepInfeasible
            If no displacement satisfies the user's own rows.
        """
        step = self.step
        n = step.n_v
        counts = step.counts.tolist()
        on = [face(step.cone, count, rows) for count, rows in zip(counts, faces, strict=True)]
        scale = lcm(*(f.denominator for f in on))
        conditions: list[Row] = []
        scaled_s: list[Row] = []
        with working_precision(EXACT):
            # H x - g = h B'p with p = s / c, times h c and the scale
            push = arb_mat(n, n + 1)
            for f, z_j, mu in zip(on, self.z, scaled_by(step.contacts).tolist(), strict=True):
                rows = (f.linear * z_j * (scale // f.denominator)).tolist()
                conditions += rows[:-4]
                push += columns(z_j.tolist(), slice(0, n)).transpose() * arb_mat(rows[-4:])
                scaled_s += [
                    [m * v for v in row] for m, row in zip(map(arb, mu), rows[-4:], strict=True)
                ]
            push *= self.form.h * self.form.h
            of_x, constant = _columns(push, n)
            stiff = self.compliance * scale
            H = self.form.H * stiff - of_x
            g = self.form.g * stiff + constant
        form = MatrixProgram(H, g, _matrix([*conditions, *self.extra_rows], n))
        working: tuple[int, ...] = ()
        if self.extra_rows:
            under = MatrixProgram(H, g, _matrix(self.extra_rows, n))
            working = tuple(len(conditions) + i for i in self._active(under))
        return Candidate(Minimiser(form, working), _matrix(scaled_s, n), scale)

    def _active(self, under: MatrixProgram) -> tuple[int, ...]:
        """The working set among the user's own rows."""
        end = dual_active_set(under)
        if not isinstance(end, Combination):
            return end.working
        extra_rows = np.arange(self.step.offsets[-1], self.step.m)
        raise StepInfeasible(self.step, farkas_vector(self.step, under, end, extra_rows))

    def wrong_faces(self, candidate: Candidate) -> list[int]:
        """The contacts that break a condition of their face."""
        broken = [i for i, sign in candidate.minimiser.slack_signs.items() if sign < 0]
        contacts = np.searchsorted(self.step.offsets, broken, side="right") - 1
        return sorted({*contacts.tolist()})

    def numbers(self, candidate: Candidate) -> tuple[Array, Array]:
        """The p, scaled to forces, shape (n_c, 4) [N, N m], and delta_q of a candidate, rounded."""
        minimiser = candidate.minimiser
        with working_precision(EXACT):
            unit = self.compliance * candidate.scale
        p = minimiser.rounded(lambda solution: (candidate.s * solution.z).entries(), unit)
        return p.reshape(-1, 4), minimiser.rounded(lambda solution: solution.x)


def _matrix(rows: Sequence[Row], n: int) -> arb_mat:
    """Rows of n + 1 numbers as a matrix."""
    return columns(rows, slice(0, n + 1))


def _columns(rows: arb_mat, n: int) -> tuple[arb_mat, arb_mat]:
    """The first n columns of a matrix, and the one after them."""
    table = rows.tolist()
    return columns(table, slice(0, n)), columns(table, slice(n, n + 1))


def eliminated_optimum(
    step: StepData, compliance: float, faces: list[Rows]
) -> tuple[Array, Array] | None:
    """The optimum with compliance, by Newton's method in exact numbers.

    Parameters
    ----------
    step : StepData
        In a polyhedral cone.
    compliance : float
        [m/N].
    faces : list of tuple of int, length n_c
        Where to start: nearly always the right ones.

    Returns
    -------
    (ndarray, ndarray) or None
        (f_n, f_d1, f_d2, tau_n) of each contact, shape (n_c, 4) [N, N m], and delta_q, shape
        (n_v,), each number rounded correctly; None if the method does not end soon.

    Raises
    ------
    StepInfeasible
        As :meth:`EliminatedStep.candidate`.
    """
    program = EliminatedStep(step, compliance)
    for _ in range(PROOFS):
        candidate = program.candidate(faces)
        wrong = program.wrong_faces(candidate)
        if not wrong:
            return program.numbers(candidate)
        point = candidate.minimiser.fractions.z
        for j in wrong:
            with working_precision(EXACT):
                z = program.z[j] * point
            faces[j] = nearest_face(step.cone, int(step.counts[j]), z)
    return None

"""The step with compliance in delta_q alone, without rounding: contact forces, proved.

See :mod:`~quasistatic_ref.optional.forces.forces`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from math import lcm
from typing import Final

import numpy as np
from flint import fmpq, fmpq_mat

from quasistatic_ref.certify.active_set import Farkas, dual_active_set
from quasistatic_ref.certify.farkas import farkas_vector
from quasistatic_ref.certify.minimiser import Minimiser, form_in_balls
from quasistatic_ref.certify.rational import (
    Dyadic,
    ExactForm,
    concatenated,
    contact_motion,
    dyadic,
    fraction,
    h_times_hessian,
    h_times_load,
    in_integers,
)
from quasistatic_ref.certify.rounding import nearest_numbers
from quasistatic_ref.errors import StepInfeasible
from quasistatic_ref.optional.forces.faces import Rows, face, nearest_face
from quasistatic_ref.step.arrays import Array
from quasistatic_ref.step.data import StepData
from quasistatic_ref.step.friction import scaled_by

PROOFS: Final = 30
"""Newton iterations in exact numbers, at most."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """The optimum with compliance if the force of each contact lay on a given face.

    Parameters
    ----------
    minimiser : Minimiser
        The minimiser of a program in delta_q. Its rows are the conditions of the faces, contact by
        contact, then s times the coefficients of friction, then the user's own rows.
    own : int
        Where the user's own rows start.
    s_unit : fmpq
        s times the coefficients = s_unit * slack of its rows [m, m^2].
    """

    minimiser: Minimiser
    own: int
    s_unit: fmpq


class EliminatedStep:
    """The step with compliance in delta_q alone, without rounding.

    Its z, shape (n_c, 4, n_v + 1), and the user's `own` rows are those of [delta_q; 1]; H and g
    are times h c.

    Parameters
    ----------
    step : StepData
    compliance : float
        [m/N].
    """

    def __init__(self, step: StepData, compliance: float) -> None:
        contacts = step.contacts
        c = dyadic(compliance)
        self.step = step
        self.h = dyadic(step.h)
        self.compliance = fraction(compliance)
        self.H = c * h_times_hessian(step)
        self.g = c * h_times_load(step)
        self.mu = dyadic(scaled_by(contacts).reshape(-1, 1))
        mu = Dyadic(self.mu.m.reshape(-1, 4, 1), self.mu.e)
        gap = np.zeros((contacts.n_c, 4, 1))
        gap[:, 0, 0] = contacts.phi
        self.z = concatenated([mu * contact_motion(contacts), dyadic(gap)], axis=2)
        self.own = concatenated([dyadic(step.extra.A), dyadic(-step.extra.b[:, None])], axis=1)

    def candidate(self, faces: Sequence[Rows]) -> Candidate:
        """The optimum on the face of each contact, in a polyhedral cone.

        Raises
        ------
        StepInfeasible
            If no displacement satisfies the user's own rows.
        StepDataError
            If H, formed without rounding, is not positive definite.
        """
        step = self.step
        n = step.n_v
        z = self.z
        counts = step.counts.tolist()
        on = [face(step.cone, count, rows) for count, rows in zip(counts, faces, strict=True)]
        scale = lcm(*(f.denominator for f in on))
        linear = [(scale // f.denominator) * f.integers for f in on]
        of_z = [M @ z_j for M, z_j in zip(linear, z.m, strict=True)]
        conditions = Dyadic(np.concatenate([z.m[:0, 0], *(rows[:-4] for rows in of_z)]), z.e)
        s = Dyadic(np.concatenate([z.m[:0, 0], *(rows[-4:] for rows in of_z)]), z.e)
        B = Dyadic(z.m.reshape(-1, n + 1)[:, :n], z.e)
        # H x - g = h B'p with p = s / c, times h c and the scale
        push = self.h * self.h * (Dyadic(B.m.T, B.e) @ s)
        H = Dyadic(scale * self.H.m, self.H.e) - push[:, :n]
        g = Dyadic(scale * self.g.m, self.g.e) + push[:, n]
        rows = concatenated([conditions, self.mu * s, self.own])
        form = in_integers(H, g, rows[:, :n], -rows[:, n], fmpq(1))
        first_own = len(conditions.m) + len(s.m)
        working: tuple[int, ...] = ()
        if first_own < form.m:
            under = in_integers(H, g, self.own[:, :n], -self.own[:, n], fmpq(1))
            working = tuple(first_own + i for i in self._active(under))
        return Candidate(
            Minimiser(form, form_in_balls(form), working), first_own, form.slack_unit / scale
        )

    def _active(self, under: ExactForm) -> tuple[int, ...]:
        """The working set of the user's own rows, which are those of a form."""
        end = dual_active_set(under)
        if not isinstance(end, Farkas):
            return end.minimiser.working
        own = np.arange(self.step.offsets[-1], self.step.m)
        raise StepInfeasible(self.step, farkas_vector(self.step, under, end, own))

    def wrong_faces(self, found: Candidate) -> list[int]:
        """The contacts that break a condition of their face."""
        signs = np.array(found.minimiser.exact_slack_signs[: self.step.offsets[-1]])
        broken = np.flatnonzero(signs < 0)
        return sorted({*(np.searchsorted(self.step.offsets, broken, side="right") - 1).tolist()})

    def numbers(self, found: Candidate) -> tuple[Array, Array]:
        """The p, scaled to forces, shape (n_c, 4) [N, N m], and delta_q of a candidate, rounded."""
        minimiser = found.minimiser
        n_c = self.step.contacts.n_c
        entries = range(found.own - 4 * n_c, found.own)
        p = nearest_numbers(minimiser, "slack", found.s_unit / self.compliance, entries)
        x = nearest_numbers(minimiser, "x", minimiser.form.x_unit, range(self.step.n_v))
        return p.reshape(-1, 4), x


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
    StepDataError, StepInfeasible
        As :meth:`EliminatedStep.candidate`.
    """
    program = EliminatedStep(step, compliance)
    for _ in range(PROOFS):
        found = program.candidate(faces)
        wrong = program.wrong_faces(found)
        if not wrong:
            return program.numbers(found)
        z = program.z @ _with_one(found.minimiser)
        for j in wrong:
            faces[j] = nearest_face(step.cone, int(step.counts[j]), z[j])
    return None


def _with_one(minimiser: Minimiser) -> Dyadic:
    """[delta_q; 1] of a minimiser, times a positive number, shape (n_v + 1,)."""
    exact = minimiser.rational
    unit = minimiser.form.x_unit
    terms = [*(unit * v for v in exact.x), fmpq(exact.denominator)]
    integers, _ = fmpq_mat(len(terms), 1, terms).numer_denom()
    return Dyadic(np.array([int(v) for v in integers.entries()], dtype=object), 0)

"""Proof that a step has no solution, for people, for files and for checking.

If y >= 0, A'y = 0 and b'y > 0, then A delta_q >= b would give 0 = y'A delta_q >= y'b > 0.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from flint import fmpq

from quasistatic_ref.certify.groups import row_owners
from quasistatic_ref.certify.step_program import StepProgram
from quasistatic_ref.errors import check_kind
from quasistatic_ref.exact.active_set import Combination
from quasistatic_ref.exact.fractions import fractions_read
from quasistatic_ref.exact.program import ExactProgram, fraction
from quasistatic_ref.numbers.arrays import Array, Indices
from quasistatic_ref.numbers.precision import nearest_fraction
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import StepData
from quasistatic_ref.text.plain import Plain


@dataclass(frozen=True, eq=False)
class FarkasVector(Plain):
    """The proof y, its largest entry being one.

    A ``StepInfeasible`` has it; its constructor checks nothing.

    Parameters
    ----------
    y : ndarray, shape (m,)
        Each entry rounded correctly [-]; contact-major, the user's own rows last.
    exact : tuple of str, length m
        The proof itself: each entry as ``"p/q"``, or ``"p"`` if q = 1.
    contradiction : float
        b'y [m] > 0, rounded.
    owners : dict of str to list of str
        The contacts with a positive entry of y, each with the names of these rows.

    Examples
    --------
    >>> step = qr.load_scenario("sphere_spin", steps=1).run(progress=False).step_data(0)
    >>> walls = qr.Extra(("left", "right"), [[1, 0, 0, 0, 0, 0], [-1, 0, 0, 0, 0, 0]], [1.0, 1.0])
    >>> try:
    ...     qr.solve_step(step.replace(extra=walls))
    ... except qr.StepInfeasible as error:
    ...     proof: qr.FarkasVector = error.farkas
    >>> proof.exact[-2:], proof.contradiction
    (('1', '1'), 2.0)
    """

    y: Array
    exact: tuple[str, ...]
    contradiction: float
    owners: dict[str, list[str]]

    @property
    def in_words(self) -> str:
        """Which contacts contradict each other, and by how much."""
        named = [f"{name} ({', '.join(rows)})" for name, rows in self.owners.items()]
        if len(named) == 1:
            return f"{named[0]} cannot be satisfied by any displacement"
        return f"{', '.join(named[:-1])} and {named[-1]} contradict each other"


def farkas_vector(
    step: StepData, form: ExactProgram, proof: Combination, rows: Indices
) -> FarkasVector:
    """The Farkas vector of a step, from a proof about the rows of one of its groups.

    Parameters
    ----------
    step : StepData
    form : ExactProgram
        That of a group of the step.
    proof : Combination
        About the rows of `form`.
    rows : ndarray of int, shape (form.m,)
        Which rows of the step these are.

    Returns
    -------
    FarkasVector
    """
    largest = max(proof.y.values())
    y = [fmpq(0)] * step.m
    for i, y_i in proof.y.items():
        y[int(rows[i])] = y_i / largest
    parts = (-y_i * fraction(form.exact_rows([i])[0][-1]) for i, y_i in proof.y.items())
    contradiction = sum(parts, fmpq(0)) / largest
    return FarkasVector(
        y=np.array([nearest_fraction(y_i) for y_i in y]),
        exact=tuple(str(y_i) for y_i in y),
        contradiction=nearest_fraction(contradiction),
        owners=row_owners(step, rows[sorted(proof.y)]),
    )


def farkas_refutation(step: StepData, exact: Sequence[str]) -> str | None:
    """What is wrong with a proof that a step has no solution; None if it holds.

    Parameters
    ----------
    step : StepData
    exact : sequence of str, length m
        y as fractions ``"p/q"``.

    Returns
    -------
    str or None
        A plain reason.
    """
    if not cone(step.cone).polyhedral:
        return "a Farkas vector proves nothing of a cone that is no polyhedron"
    check_kind(exact, Sequence, "farkas", "a list of fractions")
    form = StepProgram(step)
    if len(exact) != form.m:
        return f"the Farkas vector has {len(exact)} entries, the step {form.m} rows"
    y = fractions_read(exact)
    if y is None:
        return "the Farkas vector has entries that are no fractions"
    if any(y_i < 0 for y_i in y):
        return "the Farkas vector has a negative entry"
    sums = [fmpq(0)] * (form.n + 1)  # A'y and -b'y
    for i, y_i in enumerate(y):
        if y_i:
            (row,) = form.exact_rows([i])
            sums = [total + y_i * fraction(v) for total, v in zip(sums, row, strict=True)]
    if any(sums[:-1]):
        return "A'y is not zero"
    if not sums[-1] < 0:
        return "b'y is not positive"
    return None

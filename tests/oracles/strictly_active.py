"""Rows whose multiplier is positive in some optimal lam, decided exactly."""

from collections.abc import Sequence

from quasistatic_ref.certify.degeneracy import feasible
from quasistatic_ref.certify.form import ExactForm


def strictly_active(form: ExactForm, working: Sequence[int], unspanned: Sequence[int]) -> list[int]:
    """Those of the `unspanned` rows whose multiplier is positive in some optimal lam.

    By Motzkin's theorem a row e is not strictly active iff some v has A_W v = 0, A_E v >= 0 and
    a_e v > 0. (Rows that W spans are always strictly active.)

    Parameters
    ----------
    form : ExactForm
    working : sequence of int
        W: independent rows without slack, all multipliers positive.
    unspanned : sequence of int
        The other rows without slack that W does not span.

    Returns
    -------
    list of int
    """
    if len(unspanned) <= 1:
        return []
    moves = form.exact_rows(unspanned)
    alone = [[int(i == e) for i in unspanned] for e in unspanned]
    return [e for e, least in zip(unspanned, alone, strict=True)
            if not feasible(form, working, moves, least)]  # fmt: skip

"""Impulses in the ellipsoid, and whether they are inside of their cones as they stand."""

from collections.abc import Iterator, Sequence

from flint import arb, fmpq

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.gap import fractions, nearest_above
from quasistatic_ref.step.data import StepData

ONE = fmpq(1)


def cone_blocks(step: StepData) -> Iterator[tuple[str, range, list[fmpq]]]:
    """Name, rows and tangential coefficients of each contact, then of each of the user's rows.

    The coefficients are (mu_v, mu_v, mu_omega) without rounding; a row of the user's own has none.
    """
    names = [*step.contacts.name, *step.extra.names]
    mu = [fractions(row) for row in step.contacts.mu] + [[] for _ in step.extra.names]
    start = 0
    for name, c in zip(names, mu, strict=True):
        rows = range(start, start + 1 + len(c))
        start = rows.stop
        yield name, rows, c


def inside(first: fmpq, rest: Sequence[fmpq]) -> bool:
    """Whether first >= ||rest||, without rounding."""
    return first >= 0 and first * first >= sum((v * v for v in rest), fmpq(0))


def outside_of_cones(step: StepData, impulse: Sequence[fmpq]) -> str:
    """The name of a contact whose impulse is outside of its cone; empty if there is none.

    Parameters
    ----------
    step : StepData
    impulse : sequence of fmpq, length m
        (n, d1, d2, spin) of each contact, the user's own rows last [any unit].
    """
    for name, rows, c in cone_blocks(step):
        f_n, *f = [impulse[i] for i in rows]
        unable = any(v and not m for m, v in zip(c, f, strict=True))
        if unable or not inside(f_n, [v / m for m, v in zip(c, f, strict=True) if m]):
            return name
    return ""


def raised(step: StepData, lam: Array) -> Array:
    """Impulses with normal parts raised to their cones, where rounding had lowered them.

    Parameters
    ----------
    step : StepData
    lam : ndarray, shape (m,)

    Returns
    -------
    ndarray, shape (m,)
    """
    lam = lam.copy()
    for j, mu in enumerate(step.contacts.mu.tolist()):
        f_n, *f = lam[4 * j : 4 * j + 4].tolist()
        shares = [arb(v) / m for m, v in zip(mu, f, strict=True) if m]
        least = sum((v * v for v in shares), arb(0)).sqrt()
        if not arb(f_n) >= least:
            lam[4 * j] = nearest_above(least)
    return lam

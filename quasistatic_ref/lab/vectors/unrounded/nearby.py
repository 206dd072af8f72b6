"""Candidates of a pair of shapes without rounding, and the contacts that are kept of them.

What a step keeps is decided as in the layer ``step``, but on numbers of the grid, and distances
rank as they are. Of all
candidates at one configuration, a *pool* is those that a change of 1e-30 can bring among the kept
ones: distances change by no more than bodies move.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from flint import fmpq

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.program.candidates import is_spanned, repeats
from quasistatic_ref.lab.vectors.distances.candidates import parts
from quasistatic_ref.lab.vectors.distances.shapes import Placed
from quasistatic_ref.lab.vectors.distances.solid_pair import pair_witness, point_witness
from quasistatic_ref.lab.vectors.distances.witness import Witness
from quasistatic_ref.lab.vectors.exact.precision import Vector, number, vector
from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.unrounded.grid import is_small, on_grid, working_precision
from quasistatic_ref.lab.vectors.unrounded.world import World
from quasistatic_ref.tolerances import REPEATED

POOL = fmpq(1, 10**6)
"""Candidates that are farther than the kept ones by more [m] stay out."""
REPEATS = number(REPEATED)


class Touching(InputError):
    """Two solids meet whose normal is the difference of their closest points."""


@dataclass(frozen=True, eq=False)
class Near:
    """One candidate.

    Parameters
    ----------
    pair : int
        Number of its pair.
    index : int
        Its place among the candidates of the pair.
    phi : fmpq
        [m].
    alpha, beta, n : list of fmpq
        [m], [m], [-]; of the world.
    """

    pair: int
    index: int
    phi: fmpq
    alpha: Vector
    beta: Vector
    n: Vector


def candidates(at: World, pair: int, wanted: Sequence[int] | None = None) -> list[Near]:
    """Candidates of a pair in their order; of those wanted only, if they are named.

    Raises
    ------
    Touching
        If two solids meet of which one is curved and none is a ball or a half-space.
    """
    written = at.case["pairs"][pair]
    alpha, beta = (at.shape(written[side]) for side in ("alpha", "beta"))
    kinds = {s: at.case["shapes"][written[s]]["shape"] for s in ("alpha", "beta")}
    found: list[Near] = []
    with working_precision():
        first = 0
        for part in parts(kinds, written["k"]):
            points = _points(part)
            for k in range(len(points) or 1):
                if wanted is None or first + k in wanted:
                    one = _witness(part, alpha, beta, points[k] if points else None)
                    found.append(_near(pair, first + k, one))
            first += len(points) or 1
    return found


def _points(part: Json) -> Json:
    for side in ("alpha", "beta"):
        if part[side]["kind"] == "cloud":
            return part[side]["points"]
    return []


def _witness(part: Json, alpha: Placed, beta: Placed, point: Json | None) -> Witness:
    if point is None:
        try:
            return pair_witness(alpha, beta)
        except InputError as error:
            raise Touching("meet", field="pairs", value=error.value) from None
    if part["beta"]["kind"] == "cloud":
        return point_witness(alpha, on_grid(beta.world(vector(point))))
    return point_witness(beta, on_grid(alpha.world(vector(point)))).swapped()


def _near(pair: int, index: int, one: Witness) -> Near:
    return Near(pair, index, **{key: on_grid(value) for key, value in one.table().items()})


def ordered_candidates(
    found: Sequence[Near], *, least: float | None
) -> list[tuple[bool, fmpq, int]]:
    """Candidates from the first to be kept to the last: whether each comes late, phi, its place.

    Parameters
    ----------
    found : sequence of Near
        All candidates of a pair, or a pool of them, in their order.
    least : float or None
        Size of the smaller of two solids [m], of which some candidates may repeat others, and the
        closest pair be spanned; of a cloud None.
    """
    late = [False] * len(found)
    if least is not None:
        phi, alpha, n = (
            np.array([getattr(one, key) for one in found]) for key in ("phi", "alpha", "n")
        )
        late = repeats(phi, alpha, n, REPEATS).tolist()
        phi, alpha, n = (np.array(x, dtype=np.float64) for x in (phi, alpha, n))
        late[-1] |= is_spanned(phi, alpha, n, least)
    return sorted((late[i], found[i].phi, i) for i in range(len(found)))


def kept_candidates(found: Sequence[Near], k: int, *, least: float | None) -> list[Near]:
    """The k that a step keeps, by index; `least` [m] as in :func:`ordered_candidates`."""
    order = ordered_candidates(found, least=least)
    return [found[i] for i in sorted(i for _, _, i in order[:k])]


def pool(found: Sequence[Near], k: int, *, least: float | None) -> list[int]:
    """Indices of what a step nearby can keep; `least` [m] as in :func:`ordered_candidates`."""
    far = max(one.phi for one in kept_candidates(found, k, least=least)) + POOL
    return [one.index for one in found if one.phi <= far]


def tied_indices(found: Sequence[Near], k: int, *, least: float | None) -> list[int]:
    """Indices of candidates as near as one another of which some are kept and some are not.

    `least` [m] as in :func:`ordered_candidates`.
    """
    order = ordered_candidates(found, least=least)
    if len(order) <= k or order[k][0] != order[k - 1][0]:
        return []
    edge = order[k - 1][1]
    if not is_small(order[k][1] - edge):
        return []
    return sorted(found[i].index for late, phi, i in order
                  if late == order[k][0] and is_small(phi - edge))  # fmt: skip

"""Layer 2: of each group of signed distances the k smallest, ties broken by index.

Groups that have normals are candidates of two solids, the closest pair last: those whose normal is
not within 0.25 rad of its are left out, and places after the last one fill the number.
"""

from itertools import pairwise
from typing import Final

import numpy as np

from quasistatic_ref.lab.vectors.expected import Expected, Json, Tolerance

TURNED: Final = 0.9689124217106447
"""cos 0.25: no case is within 1e-6 of it."""


def expected(case_input: Json) -> Expected:
    """Indices of the k smallest of each group, smallest first; all of a group that has fewer.

    ``tie``: two equal distances meet in what is chosen, or at its end; another order among them
    is as good.
    """
    groups, k = case_input["phi"], case_input["k"]
    left = _left(case_input)
    orders = [
        [i for _, i in sorted((phi[i], i) for i in places)]
        for phi, places in zip(groups, left, strict=True)
    ]
    tie = any(
        phi[i] == phi[j]
        for phi, order in zip(groups, orders, strict=True)
        for i, j in pairwise(order[: k + 1])
    )
    chosen = [
        [*order, *range(len(phi), 2 * len(phi) - len(order))][:k]
        for phi, order in zip(groups, orders, strict=True)
    ]
    return Expected(
        output={"indices": chosen},
        flags={"tie": tie},
        tolerance={"indices": Tolerance(0.0, "whole numbers, from comparisons alone")},
    )


def _left(case_input: Json) -> list[list[int]]:
    """The places of each group that are candidates."""
    groups = case_input["phi"]
    if "normals" not in case_input:
        return [list(range(len(phi))) for phi in groups]
    return [
        [
            i
            for i, n in enumerate(own)
            if sum(x * y for x, y in zip(n, own[-1], strict=True)) >= TURNED
        ]
        for own in case_input["normals"]
    ]


def own(case_input: Json) -> Json:
    """The package's answer, from :func:`quasistatic_ref.contact.distance.closest`."""
    from quasistatic_ref.contact.distance import closest
    from quasistatic_ref.contact.patch import TURNED

    k, found = case_input["k"], []
    for g, phi in enumerate(case_input["phi"]):
        left = np.arange(len(phi))
        if "normals" in case_input:
            n = np.array(case_input["normals"][g])
            left = np.flatnonzero(n @ n[-1] >= TURNED)
        order = left[closest(np.array(phi)[left], k)].tolist()
        found.append([*order, *range(len(phi), 2 * len(phi) - len(left))][:k])
    return {"indices": found}

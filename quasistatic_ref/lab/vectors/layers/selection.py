"""Layer 2: of each group of signed distances the k smallest, ties broken by index.

Groups that have normals are candidates of two solids, the closest pair last: those whose normal is
not within 0.25 rad of its are left out, and places after the last one fill the number. No case is
within 1e-6 of cos 0.25, and comparisons are exact: so is the plain program in float64.
"""

from itertools import pairwise

import numpy as np

from quasistatic_ref.lab.program.candidates import selection
from quasistatic_ref.lab.vectors.expected import Expected, Json, Tolerance


def expected(case_input: Json) -> Expected:
    """Indices of the k smallest of each group, smallest first; all of a group that has fewer.

    ``tie``: two equal distances meet in what is chosen, or at its end; another order among them
    is as good.
    """
    one_more = selection({**case_input, "k": case_input["k"] + 1})["indices"]
    tie = any(
        phi[i] == phi[j]
        for phi, order in zip(case_input["phi"], one_more, strict=True)
        for i, j in pairwise(order)
        if j < len(phi)  # a place of the group, and none that fills the number
    )
    return Expected(
        output=selection(case_input),
        flags={"tie": tie},
        tolerance={"indices": Tolerance(0.0, "whole numbers, from comparisons alone")},
    )


def own(case_input: Json) -> Json:
    """The package's answer, from :func:`quasistatic_ref.contact.distance.closest`."""
    from quasistatic_ref.contact.ranks import closest
    from quasistatic_ref.contact.tied_faces import TURNED

    k = case_input["k"]
    indices = []
    for g, phi in enumerate(case_input["phi"]):
        left = np.arange(len(phi))
        if "normals" in case_input:
            n = np.array(case_input["normals"][g])
            left = np.flatnonzero(n @ n[-1] >= TURNED)
        order = left[closest(np.array(phi)[left], k)].tolist()
        indices.append([*order, *range(len(phi), 2 * len(phi) - len(left))][:k])
    return {"indices": indices}

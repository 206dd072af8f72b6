"""Layer 2: of each group of signed distances the k smallest, ties broken by index."""

from itertools import pairwise

import numpy as np

from quasistatic_ref.lab.vectors.expected import Expected, Json, Tolerance


def expected(case_input: Json) -> Expected:
    """Indices of the k smallest of each group, smallest first; all of a group that has fewer.

    ``tie``: two equal distances meet in what is chosen, or at its end; another order among them
    is as good.
    """
    groups, k = case_input["phi"], case_input["k"]
    orders = [[i for _, i in sorted(zip(phi, range(len(phi)), strict=True))] for phi in groups]
    tie = any(
        phi[i] == phi[j]
        for phi, order in zip(groups, orders, strict=True)
        for i, j in pairwise(order[: k + 1])
    )
    return Expected(
        output={"indices": [order[:k] for order in orders]},
        flags={"tie": tie},
        tolerance={"indices": Tolerance(0.0, "whole numbers, from comparisons alone")},
    )


def own(case_input: Json) -> Json:
    """The package's answer, from :func:`quasistatic_ref.contact.cloud.closest`."""
    from quasistatic_ref.contact.cloud import closest

    groups, k = case_input["phi"], case_input["k"]
    return {"indices": [closest(np.array(phi), k).tolist() for phi in groups]}

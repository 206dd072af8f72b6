"""Layer 2: of each group of signed distances the k smallest, ties broken by index.

Groups that have normals are candidates of two solids, the closest pair last: those whose normal is
not within 0.25 rad of its are left out, and places after the last one fill the number.
"""

import numpy as np

from quasistatic_ref.lab.vectors.trees import Json


def own(case_input: Json) -> Json:
    """The package's answer, from :func:`quasistatic_ref.contact.distance.closest`."""
    from quasistatic_ref.contact.normals import TURNED
    from quasistatic_ref.contact.ranks import closest

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

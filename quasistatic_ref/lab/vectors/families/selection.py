"""Inputs of the layer `selection`: ties of every kind, and fewer candidates than k."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.lab.vectors.families.by_hand import Case, by_hand


def selection_cases() -> Iterator[Case]:
    """Id, provenance and input of each case."""
    rng = np.random.default_rng(31)
    for name, corner in by_hand("selection").items():
        yield f"selection/corner/{name}", corner.pop("provenance"), corner
    for i in range(12):
        size, k = int(rng.integers(1, 60)), int(rng.integers(1, 9))
        groups = (1e-3 * rng.standard_normal((int(rng.integers(1, 4)), size))).tolist()
        why = "normal random distances of 1 mm"
        yield f"selection/random/{i}", why, {"phi": groups, "k": k}
    for i in range(10):
        size, k = int(rng.integers(5, 40)), int(rng.integers(1, 9))
        phi = (rng.integers(-3, 4, size) * 2.0**-10).tolist()
        why = "random multiples of 2^-10 from -3 to 3, so that most are tied"
        yield f"selection/tied/{i}", why, {"phi": [phi], "k": k}

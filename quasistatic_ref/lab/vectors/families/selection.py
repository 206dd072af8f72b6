"""Inputs of the layer `selection`: ties of every kind, and fewer candidates than are asked for."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.lab.vectors.expected import Json

Case = tuple[str, str, Json]


def selection_cases() -> Iterator[Case]:
    """Id, provenance and input of each case."""
    rng = np.random.default_rng(31)
    for name, groups, k, why in CORNERS:
        yield f"selection/corner/{name}", why, {"phi": groups, "k": k}
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


UP = float(np.nextafter(0.001, 1))
CORNERS: tuple[tuple[str, Json, int, str], ...] = (
    ("one", [[0.5]], 1, "a single candidate"),
    ("fewer_than_k", [[0.3, 0.1, 0.2]], 5, "three candidates, five asked for: all, in order"),
    ("exactly_k", [[0.3, 0.1, 0.2]], 3, "as many candidates as are asked for"),
    ("no_groups", [], 5, "no pair at all"),
    ("all_equal", [[0.25] * 8], 5, "all tied: the first five"),
    ("tie_at_the_end", [[0.1, 0.3, 0.2, 0.3, 0.3]], 3, "the last place is tied: the least index"),
    ("tie_inside", [[0.2, 0.1, 0.1, 0.3]], 3, "two tied among the chosen"),
    ("tie_beyond", [[0.2, 0.1, 0.3, 0.3]], 2, "a tie among those that are not chosen"),
    ("one_ulp", [[UP, 0.001, UP, 0.001]], 3, "ties that one unit in the last place separates"),
    ("signed", [[1e-3, -1e-3, 1e-4, -2e-3]], 2, "penetration counts as nearer: not |phi|"),
    ("deep_first", [[-1e-3, -1e-2, 0.0, 1e-6]], 3, "deepest first"),
    ("zeros", [[0.0, 0.0, 0.0]], 2, "three contacts that touch exactly"),
    ("subnormal", [[5e-324, 0.0, -5e-324]], 2, "the smallest numbers that there are"),
    ("large", [[1e300, 1e299, -1e300]], 2, "numbers whose squares overflow"),
    ("descending", [[float(v) for v in range(20, 0, -1)]], 5, "sorted the wrong way round"),
    ("groups", [[0.3, 0.1], [0.2, 0.2, 0.1], [0.5]], 2, "three pairs, each by itself"),
)

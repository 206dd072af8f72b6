"""What large steps cost: time by part and memory, against bodies and against contacts."""

import tracemalloc
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.lab.scenes.piles import Pile, pile
from quasistatic_ref.optional.fast.backends import DEFAULT_OF_LARGE
from quasistatic_ref.optional.large.sparse_contacts import SparseContacts
from quasistatic_ref.step.data import Array

CHAINS = (10, 20, 40, 80, 160)
"""Bodies in a row."""

CONTACTS = (2, 4, 8, 16, 32)
"""Contacts of each pair in a row of ROW bodies."""

ROW = 16
SHORT, FEW = 3, (1, 5, 25)
"""A row of SHORT bodies has five pairs: 5 contacts and more."""

PILES = ((2, 2, 2), (3, 3, 3), (5, 5, 4))
"""In three dimensions factors fill up: no exponent is promised."""

WARM_UP, STEPS, HEAP_STEPS = 2, 5, 50
"""Steps that are not timed, that are, and that are of a heap, whose slowest ones are listed."""


@dataclass(frozen=True)
class LargeStep:
    """One size.

    Parameters
    ----------
    shape : (int, int, int)
        Boxes along x, y and z.
    bodies, contacts, coordinates, rows : int
    sparse : bool
        Whether the steps were.
    seconds, tail : float
        Median and 99th percentile of a step [s].
    parts : dict of str to float
        Of its parts [s]: distances, rows, solve, integrate.
    megabytes : float
        Most that Python and NumPy held at once in a step, beyond what they keep [MB].
    """

    shape: tuple[int, int, int]
    bodies: int
    contacts: int
    coordinates: int
    rows: int
    sparse: bool
    seconds: float
    tail: float
    parts: dict[str, float]
    megabytes: float


def large_step(shape: tuple[int, int, int], k: int = 4, steps: int = STEPS) -> LargeStep:
    """Boxes pulled over a floor for a few steps, not certified, by the default of large steps.

    Parameters
    ----------
    shape : (int, int, int)
    k : int
        Contacts of each pair.
    steps : int
        How many are timed.
    """
    some = pile(shape, k, backend=DEFAULT_OF_LARGE)
    q, laps = some.q, []
    for _ in range(WARM_UP + steps):
        result = some.simulator.step(q, np.zeros(0), some.force)
        q = result.q
        laps.append(result.seconds)
    timed = laps[WARM_UP:]
    parts = {name: float(np.median([lap[name] for lap in timed])) for name in LAPS}
    return LargeStep(
        shape=shape,
        bodies=some.bodies,
        contacts=some.contacts,
        coordinates=result.step.n_v,
        rows=int(result.step.offsets[-1]),
        sparse=isinstance(result.step.contacts, SparseContacts),
        seconds=float(np.median([sum(lap.values()) for lap in timed])),
        tail=float(np.quantile([sum(lap.values()) for lap in timed], 0.99)),
        parts=parts,
        megabytes=_megabytes(some, q),
    )


LAPS = ("distances", "rows", "solve", "integrate")
"""The parts of a step of which nothing is proved."""


def table(title: str, steps: Sequence[LargeStep]) -> list[str]:
    """The lines of a table in Markdown."""
    columns = (
        title, "contacts", "coordinates", "rows", "sparse", "distances [ms]", "rows [ms]",
        "solve [ms]", "integrate [ms]", "step [ms]", "p99 [ms]", "memory [MB]",
    )  # fmt: skip
    rows = [
        (
            str(step.bodies) if step.shape[1:] == (1, 1) else " x ".join(map(str, step.shape)),
            *map(str, (step.contacts, step.coordinates, step.rows)),
            "yes" if step.sparse else "no",
            *(f"{1e3 * seconds:.2f}" for seconds in step.parts.values()),
            f"{1e3 * step.seconds:.1f}",
            f"{1e3 * step.tail:.1f}",
            f"{step.megabytes:.1f}",
        )
        for step in steps
    ]
    return markdown_table(columns, rows)


def _megabytes(some: Pile, q: Array) -> float:
    tracemalloc.start()
    some.simulator.step(q, np.zeros(0), some.force)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return most / 2**20

"""What the number of contacts and of bodies costs: rows of boxes, and heaps of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from quasistatic_ref.errors import StepNotSolved
from quasistatic_ref.step.data import Array
from quasistatic_ref.study.bench.timing import exponent, in_turn, microseconds
from quasistatic_ref.study.piles import Pile, pile

LARGE = 20
"""Bodies from which a size counts for the fitted exponents: below, overhead is most of the time."""


def sizes(
    shapes: Sequence[tuple[int, int, int]], steps: int, k: int = 4, backend: str = "clarabel"
) -> list[dict[str, Any]]:
    """Time of a step for each grid of boxes (nx, ny, nz), nothing certified, after the first."""
    return [_row(shape, steps, k, backend) for shape in shapes]


def fitted(rows: Sequence[dict[str, Any]], over: str) -> float | None:
    """Exponent of time over ``"bodies"`` or ``"contacts"``; None with fewer than two large rows."""
    large = [row for row in rows if row["bodies"] >= LARGE and "microseconds" in row]
    if len({row[over] for row in large}) < 2:
        return None
    return exponent([row[over] for row in large], [row["microseconds"] for row in large])


def _row(shape: tuple[int, int, int], steps: int, k: int, backend: str) -> dict[str, Any]:
    made = pile(shape, k, backend=backend)
    row: dict[str, Any] = {
        "boxes": list(shape), "bodies": made.bodies, "contacts": made.contacts,
        "coordinates": made.simulator.system.n_v, "backend": backend,
    }  # fmt: skip
    try:
        row["microseconds"] = microseconds(_times(made, steps))
        row["problem"] = type(made.simulator.problem).__name__
    except StepNotSolved as failure:
        row["failed"] = str(failure)
    return row


def _times(made: Pile, steps: int) -> Array:
    simulator, state = made.simulator, {"q": made.q}
    q_bar_a = made.q[: simulator.system.n_q_a]

    def step() -> None:
        state["q"] = simulator.step(state["q"], q_bar_a, made.force).q

    step()  # builds what is kept
    return in_turn([{"": step} for _ in range(steps)])[""]

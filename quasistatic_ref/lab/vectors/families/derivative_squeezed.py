"""Kinks that no single coordinate shows: a ball that two balls hold, exactly opposite each other.

Moved across by eps it has room, of second order, on both sides; a force across of the order eps
takes it back by half of eps, whatever the force. Nothing of this is seen where the ball is moved,
or pushed, alone.
"""

from collections.abc import Iterator

from quasistatic_ref.lab.vectors.expected import Json
from quasistatic_ref.lab.vectors.families import derivative_kinks as kinks
from quasistatic_ref.lab.vectors.families.by_hand import Case
from quasistatic_ref.lab.vectors.families.mechanisms import at


def squeezed_cases() -> Iterator[Case]:
    """Id, provenance and input of each case; they are fresh ones only, none of the vectors."""
    for number, (axis, held, radius, push) in enumerate(
        (
            (0, 0.25, 0.5, 1.0),
            (1, 0.25, 0.125, -2.0),
            (2, 0.0625, 0.25, 4.0),
            (0, 0.25, 0.5, 0.0),
            (1, 0.125, 0.0625, -0.5),
            (2, 0.5, 0.125, 0.0),
        )
    ):
        why = f"a ball between two balls, pushed towards one with {abs(push)} N"
        yield f"derivative/fresh/squeezed_{number}", why, squeezed(held, radius, push, axis=axis)


def squeezed(
    held: float, radius: float, push: float, *, axis: int = 0, cone: str = "frictionless"
) -> Json:
    """A free ball of 1/2 kg between two fixed ones, h = 1/8 s, without gravity.

    Parameters
    ----------
    held, radius : float
        Of the ball and of the fixed ones [m], sums of few powers of two.
    push : float
        Force on the ball along the axis [N].
    axis : int
        Of the world, on which the three centres are.
    cone : str
    """
    table = kinks.free({"kind": "sphere", "radius": held}, [0.0] * 3, cone=cone, gravity=[0.0] * 3)
    for name, side in (("below", -1.0), ("above", 1.0)):
        place = at(*_along(axis, side * (held + radius)))
        table = kinks.onto(table, name, {"kind": "sphere", "radius": radius}, place, rows=4)
    return kinks.pushed(table, _along(axis, push))


def _along(axis: int, length: float) -> list[float]:
    return [length if i == axis else 0.0 for i in range(3)]

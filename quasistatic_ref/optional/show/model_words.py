"""Bodies in words: what ``repr`` and a notebook show of a system."""

from typing import TYPE_CHECKING

from quasistatic_ref.optional.show.show import Page, Row, counted, number

if TYPE_CHECKING:
    from quasistatic_ref.model.system import System

BODY = ("body", "base", "actuated", "not actuated", "links", "shapes", "mass [kg]")


def system_page(system: "System") -> Page:
    """A system: of each body, its base, coordinates, links, shapes and mass."""
    names = [body.name for body in system.bodies]
    title = (
        f"System: {counted(len(names), 'body')}, {counted(system.n_v, 'coordinate')} "
        f"({system.n_a} actuated), {counted(system.n_q, 'entry')} of q"
    )
    actuated = [coordinate.joint for coordinate in system.coordinates if coordinate.actuated]
    free = [coordinate.joint for coordinate in system.coordinates if not coordinate.actuated]
    shapes = [shape.name for shape in system.shapes]
    rows: list[Row] = [
        (
            body.name,
            body.base,
            *(str(_own(body.name, those)) for those in (actuated, free, system.links, shapes)),
            number(system.mass(body.name)),
        )
        for body in system.bodies
    ]
    return title, [], BODY, rows


def _own(body: str, names: list[str] | tuple[str, ...]) -> int:
    """How many of these names are the body's."""
    return sum(name.startswith(f"{body}/") for name in names)

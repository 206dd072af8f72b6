"""What is known of the steps of a run that were asked: lacks of bodies, and the model's part."""

from __future__ import annotations

from typing import TYPE_CHECKING

from quasistatic_ref.optional.doctor.chosen import Chosen
from quasistatic_ref.optional.doctor.compared import compared
from quasistatic_ref.optional.doctor.stopped import SAME, missing
from quasistatic_ref.step.cones import ELLIPSOID, cone

if TYPE_CHECKING:
    from quasistatic_ref.optional.doctor.bodies import Body, Missing
    from quasistatic_ref.optional.doctor.run import Run


class Asked:
    """What is known of the steps of a run that were asked.

    Parameters
    ----------
    run : Run

    Attributes
    ----------
    lacks : dict of Body to (int, Missing)
        The step after which most is missing of a body, and what.
    round : dict of Body to Missing or None
        What is missing of it then in the ellipsoid, if anything, where that is known.
    unknown : set of str
        Bodies of which it is not known whether they lack anything.
    change : Change or None
        The largest by the model, of any pair.
    """

    def __init__(self, run: Run) -> None:
        chosen = Chosen(run)
        self.lacks: dict[Body, tuple[int, Missing]] = {}
        self.round: dict[Body, Missing | None] = {}
        unknown: set[Body] = set()
        for k, bodies in chosen.stops.items():
            for body, lack in missing(run, k, bodies).items():
                most = self.lacks.get(body)
                if lack is None:
                    unknown.add(body)
                elif most is None or lack.amount > (1 + SAME) * most[1].amount:
                    self.lacks[body] = k, lack
        self.unknown = {body.name for body in unknown - self.lacks.keys()}
        if has_corners(run.simulator.cone):
            for step in sorted({k for k, _ in self.lacks.values()}):
                bodies = [body for body, (k, _) in self.lacks.items() if k == step]
                there = missing(run, step, bodies, ELLIPSOID)
                for body in bodies:
                    if body not in there or there[body] is not None:
                        self.round[body] = there.get(body)
        changes = [change for k in chosen.compared for change in compared(run, k)]
        self.change = max(changes, key=lambda change: change.rank, default=None)

    def in_corners(self, body: Body) -> bool:
        """Whether the ellipsoid bears what a body lacks."""
        return body in self.round and self.round[body] is None


def has_corners(name: str) -> bool:
    """Whether a cone has another friction in one direction than in another."""
    return cone(name).polyhedral and name != "frictionless"

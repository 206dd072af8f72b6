"""What is known of the steps of a run that were asked: lacks of bodies, and the model's part."""

from __future__ import annotations

from typing import TYPE_CHECKING

from quasistatic_ref.optional.doctor.chosen import Chosen
from quasistatic_ref.optional.doctor.compared import Change, compared
from quasistatic_ref.optional.doctor.slow import SAME
from quasistatic_ref.optional.doctor.stopped import missing
from quasistatic_ref.optional.doctor.undecided import Undecided
from quasistatic_ref.step.cones import ELLIPSOID, cone

if TYPE_CHECKING:
    from quasistatic_ref.optional.doctor.bodies import Body, Missing
    from quasistatic_ref.optional.doctor.run import Run


class Asked:
    """The answers of the slow steps that were asked about a run's steps.

    Parameters
    ----------
    run : Run

    Attributes
    ----------
    lacks : dict of Body to (int, Missing)
        The step after which most is missing of a body, and what.
    round : dict of Body to Missing or None
        What is missing of it then in the ellipsoid, if anything, where that is known.
    unknown : dict of str to str
        Why it is not known whether bodies lack anything, by their names.
    unknown_round : dict of str to str
        The same of what they lack in the ellipsoid.
    change : Change or None
        The largest by the model, of any pair.
    unknown_changes : dict of str to str
        Why it is not known what the model changes, by the names of pairs.
    """

    def __init__(self, run: Run) -> None:
        chosen = Chosen(run)
        self.lacks: dict[Body, tuple[int, Missing]] = {}
        self.round: dict[Body, Missing | None] = {}
        unknown: dict[str, str] = {}
        for k, bodies in chosen.stops.items():
            for body, lack in missing(run, k, bodies).items():
                most = self.lacks.get(body)
                if isinstance(lack, str):
                    unknown[body.name] = lack
                elif most is None or lack.amount > (1 + SAME) * most[1].amount:
                    self.lacks[body] = k, lack
        known = {body.name for body in self.lacks}
        self.unknown = {name: why for name, why in unknown.items() if name not in known}
        self.unknown_round: dict[str, str] = {}
        if has_corners(run.simulator.cone):
            for step in sorted({k for k, _ in self.lacks.values()}):
                bodies = [body for body, (k, _) in self.lacks.items() if k == step]
                there = missing(run, step, bodies, ELLIPSOID)
                for body in bodies:
                    answer = there.get(body)
                    if isinstance(answer, str):
                        self.unknown_round[body.name] = answer
                    else:
                        self.round[body] = answer
        every = [change for k in chosen.compared for change in compared(run, k)]
        changes = [change for change in every if isinstance(change, Change)]
        self.change = max(changes, key=lambda change: change.rank, default=None)
        decided = {run.pairs[change.pair].name for change in changes}
        self.unknown_changes = {
            open_one.what: open_one.why
            for open_one in every
            if isinstance(open_one, Undecided) and open_one.what not in decided
        }

    def in_corners(self, body: Body) -> bool:
        """Whether the ellipsoid bears what a body lacks."""
        return body in self.round and self.round[body] is None


def has_corners(name: str) -> bool:
    """Whether a cone has another friction in one direction than in another."""
    return cone(name).polyhedral and name != "frictionless"

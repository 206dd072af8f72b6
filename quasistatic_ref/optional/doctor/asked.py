"""What a run is asked: of which steps, and the answers, lacks of bodies and the model's part.

Steps are chosen from numbers that every record has, of all bodies at once.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.optional.doctor.artifacts import quotient, ways_of
from quasistatic_ref.optional.doctor.bodies import COUNTS
from quasistatic_ref.optional.doctor.compared import SLID, Change, compared
from quasistatic_ref.optional.doctor.slow import LITTLE, SAME
from quasistatic_ref.optional.doctor.start import least
from quasistatic_ref.optional.doctor.stopped import missing
from quasistatic_ref.optional.doctor.undecided import Undecided
from quasistatic_ref.optional.friction import slip_norm
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.step.cones import ELLIPSOID, cone

if TYPE_CHECKING:
    from quasistatic_ref.numbers.arrays import Array, Mask
    from quasistatic_ref.optional.doctor.bodies import Body, Missing
    from quasistatic_ref.optional.doctor.run import Run

RISES = 0.03
"""What the layer under a body may add to its load without being asked [-]."""
ALIKE = 0.5
"""Part of the most of a number in a run that says as much [-]."""
LOOKS = 12
"""Steps that are asked either question, at most."""
LEVER = 0.25
"""Lever arm of a body's drag, over its size [-]."""


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
        here = cone(run.simulator.cone)
        if here.polyhedral and here.name != "frictionless":
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


class Chosen:
    """The steps of a run at which forces and motions are questioned.

    Parameters
    ----------
    run : Run

    Attributes
    ----------
    stops : dict of int to list of Body
        After which targets and loads stop, and of which bodies.
    compared : list of int
        That are compared with themselves, taken slowly.
    """

    def __init__(self, run: Run) -> None:
        self._run = run
        s = np.where(run.touches, slip_norm(run.scaled_slips, run.simulator.cone), 0.0)
        self._adds = quotient(s, run.noted("gives")) * (run.simulator.law == CONVEX)
        self._slips = np.where(run.touches, np.linalg.norm(run.slips[..., :2], axis=-1), 0.0)
        asks: dict[Body, Mask] = {}
        rows = [row for body in run.bodies_of for row in self._of_body(body, asks)]
        steps = _covering([row for row in rows if row.any()])
        self.stops = {k: [body for body in run.bodies_of if asks[body][k]] for k in steps}
        rows = [row for i in range(len(run.pairs)) for row in self._of_pair(i)]
        self.compared = _covering([row for row in rows if row.max() > COUNTS / 2])

    def _of_body(self, body: Body, asks: dict[Body, Mask]) -> list[Array]:
        """Scores of each step, (steps,) each; which steps the body is asked in goes into `asks`.

        What inertia bears of its load, by the pairs that touch, by whether targets move, and by
        which way the body goes, since what lands goes back; what has slipped so far that inertia
        may bear it; and what the layer may have added.
        """
        run = self._run
        of = body.contacts
        load = run.loads[body]
        drag = run.drags[body] / load
        drag = np.where(drag > LITTLE, drag, 0.0)
        layer = self._adds[:, of].max(axis=1, initial=0.0) / load
        layer = np.where(layer > RISES, layer, 0.0)
        slip = quotient(body.mass * self._slips[:, of].max(axis=1, initial=0.0), run.h**2 * load)
        slip = np.where((drag > 0) & (slip > LITTLE), slip, 0.0)
        asks[body] = np.asarray((drag > 0) | (layer > 0))
        near = [run.touches[:, run.pair_of == i].any(axis=1) for i in np.unique(run.pair_of[of])]
        _, of_set = np.unique([*near, run.targets_move], axis=1, return_inverse=True)
        sets = [drag * (of_set.ravel() == i) for i in range(of_set.max() + 1)]
        M = run.inertia(body)
        momentum = run.noted("momentum")[:, body.coordinates - run.system.n_a]
        most = momentum[[row.argmax() for row in sets]]
        ways = np.linalg.solve(M, most.T).T @ momentum.T
        both = [(row * (way >= 0), row * (way < 0)) for row, way in zip(sets, ways, strict=True)]
        return [*(row for rows in both for row in rows), slip, layer]

    def _of_pair(self, i: int) -> list[Array]:
        """Scores of each step in which a pair stays and targets move, (steps,) each.

        What drag, and the layer, may change of its largest force; and how far it slips and spins.
        """
        run = self._run
        pair = run.pairs[i]
        of = run.pair_of == i
        force = run.largest(of)
        touches = np.asarray(run.touches[:, of].any(axis=1))
        stays = touches & np.append(run.steps == 1, touches[:-1]) & run.targets_move
        if not stays.any():
            return []
        drag = np.zeros(run.steps)
        for body in run.near[pair.name]:
            turns = quotient(LEVER * body.size, pair.mu_omega) if pair.rows == 6 else 0.0
            drag = np.maximum(drag, run.drags[body] * max(1.0, float(turns)))
        layer = np.minimum(self._adds[:, of].max(axis=1, initial=0.0), force)
        scores = [stays * quotient(x, force) for x in (drag, layer)]
        added = (scores[0] > LITTLE) | (scores[1] > RISES)
        ways = ways_of(run.slid(i))
        far = run.ways(i) > SLID * np.array([least(pair), 1.0])
        largest = quotient(far, ways.max(axis=0))
        return [*scores, *(added[:, None] * ways * largest).T]


def _covering(rows: list[Array]) -> list[int]:
    """Few steps that cover the large entries of each row, and the first and last of these.

    One end of a fall may be in reach of what bears it.
    """
    if not rows:
        return []
    shares = np.array([np.floor(100 * row / row.max()) / 100 for row in rows])
    good = shares >= ALIKE
    last = good.shape[1] - 1
    ends = np.unique([good.argmax(axis=1), last - good[:, ::-1].argmax(axis=1)])
    left = np.vstack([shares * good, ends[:, None] == np.arange(good.shape[1])])
    steps: list[int] = []
    while len(left) and len(steps) < LOOKS:
        steps.append(int(left.sum(axis=0).argmax()))
        left = left[left[:, steps[-1]] == 0]
    return sorted(steps)

"""Artifacts of the model where they change what happens: drag, boundary layer, corners.

Each is measured by what it changes in documented steps of a run
(:mod:`~quasistatic_ref.optional.doctor.compared`). Of bodies that are not in equilibrium in a step
nothing else is said of that step: of another, in which their contacts bear them, it is.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.formats.quoting import listed
from quasistatic_ref.optional.doctor.compared import PairMotion, RunStep
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import SHORT
from quasistatic_ref.optional.doctor.unsupported import falls
from quasistatic_ref.simulate.finding import Finding

COUNTS = 0.1
"""Least difference that counts, over the larger of two numbers [-]."""
DISTANCE = "the step shows where to, not how far"


def out_of_balance(run: Run) -> Iterator[Finding]:
    """Free bodies whose loads no forces in the cones of their contacts bear.

    A body that falls until the end because its contacts bear nothing is in free fall.
    """
    falling = falls(run)
    for name, missing in run.compared.unbalanced.items():
        weight = run.system.mass(name) * run.g
        if name in falling and missing.force >= (1 - COUNTS) * weight:
            continue
        yield Finding(
            "not in equilibrium",
            False,
            f"give {name} what holds it, or do not read how far it moves",
            f"it is not in equilibrium: {missing} are missing in step {missing.k}; {DISTANCE}",
            {"missing_N": missing.force, "missing_Nm": missing.torque, "step": missing.k},
        )


def corners(run: Run) -> Iterator[Finding]:
    """Bodies and pairs that slip in the corners of the pyramid, and not in the ellipsoid.

    Of a pair that does not slip without its drag either, the drag is said: speed comes first.
    """
    names = run.compared.held_in_ellipsoid
    if names:
        k = min(names.values())
        is_not = "is not" if len(names) == 1 else "are not"
        yield Finding(
            "corners of the cone",
            False,
            'set cone = "ellipsoid"',
            f"{listed([*names])} {is_not} in equilibrium in the {run.simulator.cone} in step {k}, "
            "but in the ellipsoid, whose friction is the same in all directions",
            {"step": k},
        )
        return
    for at in run.compared.steps:
        if not at.slips_inside:
            continue
        by_drag = [change.pair for change in _changes(at, at.without_drag) if change.stops]
        for change in _changes(at, at.in_ellipsoid):
            if change.stops and change.pair not in by_drag:
                slips = {"slip_mm": 1e3 * change.here.way, "ellipsoid_mm": 1e3 * change.there.way}
                yield Finding(
                    "corners of the cone",
                    False,
                    'set cone = "ellipsoid"',
                    f"{change.pair.name} {change} in the ellipsoid, in step {at.k}",
                    {**slips, "step": at.k},
                )
                return


def drag(run: Run) -> Iterator[Finding]:
    """The pair whose force or slip changes most where bodies have a sixteenth of their drag.

    A pair that stops counts most. That it slips more says nothing: loads move a lighter body
    farther.
    """
    changes = [x for at in run.compared.steps for x in _changes(at, at.without_drag)]
    sizes = [1.0 if change.stops else change.of_force(run.light) for change in changes]
    if max(sizes, default=0.0) > COUNTS:
        change = changes[sizes.index(max(sizes))]
        here = change.here.normal
        there = change.there.normal
        does = f"{here:.3g} N, without it {there:.3g} N"
        if change.stops:
            does = f"it {change} without it"
        k = change.at.k
        yield Finding(
            "drag",
            False,
            "move more slowly, or take a larger h",
            f"the drag m v / h of the step counts in {change.pair.name}: {does}, in step {k}",
            {"normal_N": here, "without_drag_N": there, "step": k},
        )


def layer(run: Run) -> Iterator[Finding]:
    """The pair whose force or slip is most unlike that of Coulomb's law.

    Steps in which that law reaches no fixed point are counted, and say nothing.
    """
    unsettled = sum(at.by_coulomb is None for at in run.compared.steps)
    changes = [x for at in run.compared.steps for x in _changes(at, at.by_coulomb)]
    sizes = [max(change.of_layer_force, change.of_way) for change in changes]
    if max(sizes, default=0.0) > COUNTS:
        change = changes[sizes.index(max(sizes))]
        here = change.here
        there = change.there
        does = f"presses with {here.normal:.3g} N, where Coulomb's law allows {there.normal:.3g} N"
        if change.of_way > change.of_layer_force:
            does = f"slips by {1e3 * here.way:.3g} mm, where Coulomb's law allows "
            does += f"{1e3 * round(there.way, 9):.3g} mm"
        yield Finding(
            "boundary layer",
            False,
            'move more slowly, take a smaller h, or set law = "coulomb"',
            f"{change.pair.name} {does}, in step {change.at.k}: what slides rises by mu_v h v, "
            "against what presses it",
            {
                "normal_N": here.normal,
                "coulomb_N": there.normal,
                "slip_mm": 1e3 * here.way,
                "coulomb_mm": 1e3 * there.way,
                "steps_without_fixed_point": unsettled,
                "step": change.at.k,
            },
        )


class Change(NamedTuple):
    """What a pair does in a step of a run, and what it would do with one thing changed.

    Parameters
    ----------
    at : RunStep
    pair : ContactPair
    shortest : float
        A motion of the pair that is none [m].
    here, there : PairMotion
        In the run, and where one thing is changed.
    """

    at: RunStep
    pair: ContactPair
    shortest: float
    here: PairMotion
    there: PairMotion

    def of_force(self, nothing: float) -> float:
        """Difference of the normal forces over the larger [-]; 0 where it is `nothing` [N]."""
        off = abs(self.here.normal - self.there.normal)
        return off / max(self.here.normal, self.there.normal) if off > nothing else 0.0

    @property
    def of_layer_force(self) -> float:
        """The same [-]; what comes down from its layer makes no difference."""
        return self.of_force(max(self.at.run.light, self.at.comes_down(self.pair)))

    @property
    def of_way(self) -> float:
        """Largest difference of slips over the larger [-].

        It is 0 without friction or motion, and for what comes down from its layer.
        """
        off = float(np.linalg.norm(self.here.slip - self.there.slip, axis=1).max(initial=0.0))
        if self.pair.mu_v == 0 or off <= max(self.shortest, 2 * self.at.floats):
            return 0.0
        return off / max(self.here.way, self.there.way)

    @property
    def slips(self) -> bool:
        """Whether the pair slips in the run alone."""
        return self.here.way > self.shortest and self.there.way < COUNTS * self.here.way

    @property
    def stops(self) -> bool:
        """Whether a pair with friction slips or spins in the run alone."""
        turns = self.pair.rows == 6 and self.pair.mu_omega > 0
        spins = self.here.spin > SHORT and self.there.spin < COUNTS * self.here.spin
        return (turns and spins) or (self.pair.mu_v > 0 and self.slips)

    def __str__(self) -> str:
        """How far the pair slips or spins in the run, and where one thing is changed."""
        here = self.here
        there = self.there
        if self.slips:
            less = f"by {1e3 * there.way:.2g} mm" if there.way > self.shortest else "not"
            return f"slips by {1e3 * here.way:.2g} mm, and {less}"
        less = f"by {np.degrees(there.spin):.2g} degrees" if there.spin > SHORT else "not"
        return f"turns by {np.degrees(here.spin):.2g} degrees, and {less}"


def _changes(at: RunStep, changed: list[PairMotion] | None) -> Iterator[Change]:
    """The changes of pairs whose bodies are in equilibrium.

    Those are left out that press with less than a tenth of the largest force of the step: a pair
    that comes to touch, or ceases to, does so a step earlier or later.
    """
    if changed is None:
        return
    run = at.run
    largest = max((pair.normal for pair in at.as_it_is), default=0.0)
    each = zip(run.pairs, run.shortest.tolist(), at.as_it_is, changed, strict=True)
    for pair, shortest, here, there in each:
        bears = max(here.normal, there.normal) >= COUNTS * largest
        if bears and not run.bodies(pair) & at.moved.keys():
            yield Change(at, pair, shortest, here, there)

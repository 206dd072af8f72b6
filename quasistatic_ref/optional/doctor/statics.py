"""Findings of statics: what is missing, and what drag, boundary layer and corners change.

All of them compare one step by four laws (:mod:`~quasistatic_ref.optional.doctor.slowly`).
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.formats.quoting import listed
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.bodies import COUNTS, Body, Missing
from quasistatic_ref.optional.doctor.looks import (
    COULOMB,
    MODEL,
    ROUND,
    RUN,
    SLOW,
    Look,
    Looking,
    resultants,
)
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.slowly import LITTLE
from quasistatic_ref.optional.doctor.start import least, slices
from quasistatic_ref.optional.doctor.telling import amount, length
from quasistatic_ref.optional.doctor.unsupported import falls
from quasistatic_ref.simulate.finding import Finding

DISTANCE = "the step shows where to, not how far"
SLID = 0.01
"""Slip over the smaller shape, or spin [rad], of a run, or of as many steps like the one that is
looked at, from which it counts [-]."""
TORQUE = 2
"""Its number among normal force, friction and torque."""
INNER = 1e-6
"""Part of an inner load, of length 1, that is none in the resultants of a pair [-]."""


def out_of_balance(run: Run) -> Iterator[Finding]:
    """Bodies whose loads no forces of Coulomb's law bear, by the run's cone.

    A body that falls until the end because its contacts bear nothing is in free fall; one that
    settles by less than a tenth of its size has no finding.
    """
    every = run.looking
    lacks = {body: every.lacks(body.name) for body in run.bodies_of}
    falling = falls(run)
    for body, lacking in lacks.items():
        if not lacking or _in_corners(lacking, body):
            continue
        look, missing = max(lacking, key=lambda x: x[1].amount)
        weight = body.mass * run.g
        if body.name in falling and missing.force >= (1 - COUNTS) * weight:
            continue
        then = f"it starts with {missing.starts}; {DISTANCE}"
        if every.rests(body):
            if every.settles(body):
                continue
            drags = run.drags[body][look.k :] > LITTLE * run.loads[body][look.k :]
            steps = 1 + int(np.flatnonzero(drags).max(initial=0))
            way, turn = run.way(body, look.k)
            does = f"falls by {length(way)}"
            if turn > way / body.size:
                does = f"turns by {amount(turn, 'rad')}"
            then = f"from there it {does} in {steps} steps, then lies still"
        yield Finding(
            "not in equilibrium",
            False,
            f"give {body.name} what holds it, or do not read how far it moves",
            f"it is not in equilibrium: {missing} are missing in step {look.k}, and {then}",
            {
                "missing_N": missing.force,
                "missing_Nm": missing.torque,
                "starts_m_s2": missing.slides,
                "starts_rad_s2": missing.turns,
                "step": look.k,
            },
        )


def _in_corners(lacking: list[tuple[Look, Missing]], body: Body) -> bool:
    """Whether nothing is missing of a body in the round cone, wherever it is in the run's."""
    return all(ROUND in look.laws and body.name not in look.missing[ROUND] for look, _ in lacking)


def corners(run: Run) -> Iterator[Finding]:
    """Bodies and pairs that the corners of a cone treat otherwise than a round one.

    Bodies that are in equilibrium in the round cone alone come first; then those that lack another
    force there, and the pair whose forces differ most.
    """
    every = run.looking
    held: dict[str, int] = {}
    other: list[tuple[float, str, int, Missing, Missing]] = []
    for body in run.bodies_of:
        lacking = every.lacks(body.name)
        if lacking and _in_corners(lacking, body) and not every.settles(body):
            held[body.name] = lacking[0][0].k
        for look, here in lacking:
            if ROUND in look.laws and body.name in look.missing[ROUND]:
                there = look.missing[ROUND][body.name]
                off = float(np.linalg.norm(here.r - there.r))
                if off > COUNTS * np.linalg.norm(here.r):
                    other.append((off, body.name, look.k, here, there))
    if held:
        k = min(held.values())
        is_not = "is not" if len(held) == 1 else "are not"
        yield _corner(
            f"{listed([*held])} {is_not} in equilibrium in the {run.simulator.cone} in step {k}, "
            "but in the ellipsoid, whose friction is the same in all directions",
            {"step": k},
        )
        return
    if other:
        _, name, k, here, there = max(other, key=lambda x: x[0])
        yield _corner(
            f"{name} lacks {here} in the {run.simulator.cone}, and {there} in the ellipsoid, "
            f"in another direction or by another amount, in step {k}",
            {"missing_N": here.force, "ellipsoid_N": there.force, "step": k},
        )
        return
    change = _largest(run, SLOW, ROUND, lambda change: change.stops or change.share > COUNTS)
    if change is not None:
        yield _corner(
            f"{change.pair.name} {change.says('in the ellipsoid')}, in step {change.k}",
            {**change.numbers(), "ellipsoid_N": float(change.there.forces[0])},
        )


def _corner(cause: str, numbers: dict[str, float]) -> Finding:
    return Finding("corners of the cone", False, 'set cone = "ellipsoid"', cause, numbers)


def drag(run: Run) -> Iterator[Finding]:
    """The pair whose forces, or whose sticking, drag changes most."""
    if best := _largest(run, RUN, SLOW, lambda change: change.of_drag):
        yield Finding(
            "drag",
            False,
            "move more slowly, or take a larger h",
            f"the drag m v / h of the step counts in {best.pair.name}: it "
            f"{best.says('without it')}{best.parts()}, in step {best.k}",
            {"without_drag_N": float(best.there.forces[best.what]), **best.numbers()},
        )


def layer(run: Run) -> Iterator[Finding]:
    """The pair whose forces, or whose sticking, the boundary layer changes most."""
    best = _largest(run, RUN, COULOMB, lambda change: change.of_layer)
    if best is None:
        return
    rises = "slides rises by mu_v h v" if best.pair.mu_v > 0 else "spins rises by mu_omega h omega"
    here, there = best.amounts()
    does = (
        f"{('presses with', 'rubs with', 'bears')[best.what]} {here}, where Coulomb's law allows "
    )
    does += f"{there}{best.parts()}"
    if best.stops:
        does = best.says("by Coulomb's law")
    normal = float(best.there.forces[0])
    slip = float(best.there.moves[0])
    yield Finding(
        "boundary layer",
        False,
        'move more slowly, take a smaller h, or set law = "coulomb"',
        f"{best.pair.name} {does}, in step {best.k}: what {rises}, against what presses it",
        {**best.numbers(), "coulomb_N": normal, "coulomb_mm": 1e3 * slip},
    )


class Acts(NamedTuple):
    """What a pair does by a law.

    Parameters
    ----------
    forces : ndarray, shape (3,)
        Normal force, friction and torque [N, N, N m].
    moves : ndarray, shape (2,)
        The longest slip and spin of contacts that press [m, rad].
    """

    forces: Array
    moves: Array


class Change(NamedTuple):
    """What a pair does by one law, and by another.

    Parameters
    ----------
    k : int
    pair : ContactPair
    here, there : Acts
    what : int
        The force of which most changes.
    share : float
        How much, over the larger one [-].
    stops : bool
        Whether it slips or spins by the first law alone.
    of_drag, of_layer : bool
        Whether drag, or the layer, changes a tenth of it.
    drag, layer : float
        By how much [N, N, N m].
    """

    k: int
    pair: ContactPair
    here: Acts
    there: Acts
    what: int
    share: float
    stops: bool
    of_drag: bool
    of_layer: bool
    drag: float
    layer: float

    def numbers(self) -> dict[str, float]:
        """Of a finding."""
        return {
            "normal_N": float(self.here.forces[0]),
            "friction_N": float(self.here.forces[1]),
            "of_drag": self.drag,
            "of_layer": self.layer,
            "slip_mm": 1e3 * float(self.here.moves[0]),
            "step": self.k,
        }

    def amounts(self) -> list[str]:
        """The force by both laws."""
        unit = "N m" if self.what == TORQUE else "N"
        return [f"{acts.forces[self.what]:.3g} {unit}" for acts in (self.here, self.there)]

    def parts(self) -> str:
        """Both parts where both count."""
        if not (self.of_drag and self.of_layer) or self.stops:
            return ""
        return f" ({self.layer:+.3g} by the layer, {self.drag:+.3g} by drag)"

    def says(self, where: str) -> str:
        """What it does by each."""
        if self.stops:
            slip, spin = self.here.moves
            if slip >= least(self.pair) * spin and self.there.moves[0] < COUNTS * slip:
                return f"slips by {1e3 * slip:.2g} mm, and not {where}"
            return f"turns by {np.degrees(spin):.2g} degrees, and not {where}"
        here, there = self.amounts()
        words = ("has", "rubs with", "bears a torque of")
        return f"{words[self.what]} {here}, {where} {there}"


def _largest(run: Run, one: str, other: str, counts: Callable[[Change], bool]) -> Change | None:
    """The change of largest share, from one law to another, of those that count."""
    every = run.looking
    changes = (change for look in every.chosen for change in _changes(every, look, one, other))
    return max(filter(counts, changes), key=lambda change: change.share, default=None)


def _changes(every: Looking, look: Look, one: str, other: str) -> Iterator[Change]:
    """The changes of pairs, from one law to another, whose bodies are in equilibrium."""
    run = every.run
    k = look.k
    if one == RUN and run.steps > 1 and not k:
        return  # a run starts as it likes
    for i, (pair, of_pair) in enumerate(slices(run.pairs)):
        near = run.near[pair.name]
        if not look.live[of_pair].any() or any(
            body.name in look.missing[SLOW] or body.name in look.lost for body in near
        ):
            continue
        if k and not run.presses[k - 1, of_pair].any():
            continue  # it comes to press in this step
        by = {law: _acts(run, look, law, of_pair) for law in look.laws if look.knows(law, of_pair)}
        if not {one, other} <= by.keys():
            continue
        here = by[one]
        there = by[other]
        force = max(here.forces[:TORQUE].max(), there.forces[:TORQUE].max())
        if near and force <= COUNTS * min(run.loads[body][k] for body in near):
            continue  # it hardly bears them, as where they are being put down or lifted
        most = float(run["wrench"][:, of_pair, 2].sum(axis=1).max())
        rubs = max(force, most / 2)
        arm = rubs * pair.mu_omega if pair.rows == 6 else np.inf
        sizes = np.array([force if force > COUNTS * most else most, rubs, arm])
        known = (_sizes(look.inner[i]) <= INNER).all(axis=1) & (sizes > 0)
        shares = known * np.abs(here.forces - there.forces) / np.where(known, sizes, 1.0)
        what = int(shares.argmax())
        stops = _stops(run, pair, of_pair, here, there)
        stops &= bool(there.forces[0] > COUNTS * by[RUN].forces[0])
        of_drag, of_layer, drags, layers = _parts(by, what, sizes[what], stops)
        moves = bool(run.targets_move[k])
        settles = near and all(every.settles(body, k) for body in near)
        yield Change(
            k, pair, here, there, what, float(shares[what]), stops,
            of_drag and moves, of_layer and (moves or not settles), drags, layers,
        )  # fmt: skip


def _parts(
    by: dict[str, Acts], what: int, size: float, stops: bool
) -> tuple[bool, bool, float, float]:
    """Whether drag and layer count in a pair, and how much of a force they are.

    run = slow + drag + layer. Where the convex step has no layer slowly, the layer follows from
    drag, whose the whole difference is then; as it is where there is no Coulomb's law at h.
    """
    coulomb = by.get(COULOMB, by[RUN])
    layers = float(by[RUN].forces[what] - coulomb.forces[what])
    drags = float(coulomb.forces[what] - by[SLOW].forces[what])
    slowly = abs(by.get(MODEL, by[RUN]).forces[what] - by[SLOW].forces[what])
    if MODEL in by and abs(layers) > max(COUNTS * size, slowly / COUNTS):
        drags += layers
        layers = 0.0
    sticks = stops and bool(coulomb.moves.max() <= COUNTS * by[RUN].moves.max())
    of_drag = abs(drags) > COUNTS * size or (stops and not sticks)
    return of_drag, abs(layers) > COUNTS * size or sticks, drags, layers


def _sizes(resultants: Array) -> Array:
    """Normal force, friction and torque of resultants, shape (5, ...), shape (3, ...)."""
    normal, *rubs, torque = resultants
    return np.stack([np.abs(normal), np.linalg.norm(rubs, axis=0), np.abs(torque)])


def _acts(run: Run, look: Look, law: str, of_pair: slice) -> Acts:
    """What a pair does by a law."""
    forces, motion = (x[of_pair] for x in look.laws[law])
    axes = run.axes(look.k, of_pair)
    presses = forces[:, 2] > 1e-6 * forces[:, 2].max(initial=0.0)
    slips = np.hypot(*(np.vecdot(motion[:, :3], d) for d in axes))
    spins = np.where(run["rows"][of_pair] == 6, np.abs(motion[:, 3]), 0.0)
    moves = np.stack([slips, spins])[:, presses].max(axis=1, initial=0.0)
    return Acts(_sizes(resultants(axes, forces)), moves)


def _stops(run: Run, pair: ContactPair, of_pair: slice, here: Acts, there: Acts) -> bool:
    """Whether a pair with friction slips or spins by the first law alone, and far in the run."""
    way = np.where(run.presses[:, of_pair, None], np.abs(run.slips[:, of_pair]), 0.0).sum(axis=0)
    sizes = SLID * np.array([least(pair), 1.0])
    far = [(way[:, :2] > sizes[0]).any(), (way[:, 2] > sizes[1]).any()]
    rubs = [pair.mu_v > 0, pair.rows == 6 and pair.mu_omega > 0]
    ends = (here.moves * run.steps > sizes) & (there.moves < COUNTS * here.moves)
    return bool((np.array(far) & rubs & ends).any())

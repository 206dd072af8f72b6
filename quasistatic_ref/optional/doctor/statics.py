"""Findings of statics: what is missing, and what drag, boundary layer and corners change.

All of them compare one step by four laws (:mod:`~quasistatic_ref.optional.doctor.slowly`).
"""

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.formats.quoting import listed
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.doctor import chosen
from quasistatic_ref.optional.doctor.bodies import COUNTS, Body, Missing
from quasistatic_ref.optional.doctor.looks import COULOMB, MODEL, ROUND, RUN, SLOW, Look
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import least
from quasistatic_ref.optional.doctor.telling import amount, length
from quasistatic_ref.optional.doctor.unsupported import falls
from quasistatic_ref.simulate.finding import Finding

DISTANCE = "the step shows where to, not how far"
STILL = 0.01
"""What a body that lies still drags, over its own load [-]."""
SLID = 0.01
"""Slip over the smaller shape, or spin [rad], of a run, or of as many steps like the one that is
looked at, from which it counts [-]."""
QUANTITIES = ("normal", "friction", "torque")


class Statics:
    """What looks at a run's steps say.

    Parameters
    ----------
    run : Run
    """

    def __init__(self, run: Run) -> None:
        self.run = run
        self._rests: dict[str, bool] = {}
        self.left = chosen.looked(run)
        self.looks = [run.looking.looks[k] for k in sorted(run.looking.looks)]

    @property
    def open(self) -> set[str]:
        """Bodies that were asked, and of which no look has an answer."""
        lost = {name for look in self.looks for name in look.lost}
        return lost - {name for look in self.looks for name in look.bodies}

    @property
    def not_looked_at(self) -> str:
        """One line on bodies whose looks have no answer, and on steps beyond the budget."""
        lines = []
        if self.open:
            lines.append(f"equilibrium of {listed(sorted(self.open))}: no fixed point was found")
        if self.left:
            lines.append(f"{self.left} steps with other contacts: {chosen.PROVED} were proved")
        return "; ".join(lines)

    def lacks(self, name: str) -> list[tuple[Look, Missing]]:
        """The looks in which something is missing of a body."""
        return [
            (look, look.missing[SLOW][name]) for look in self.looks if name in look.missing[SLOW]
        ]

    def rests(self, body: Body) -> bool:
        """Whether a body lies still in the last step, and nothing is missing in it.

        What creeps, borne by its layer, hardly moves, but lacks something.
        """
        run = self.run
        if body.name not in self._rests:
            still = bool(run.drags(body)[-1] <= STILL * run.loads(body)[-1])
            if still and self.lacks(body.name):
                last = run.looking.at(run.steps - 1, {body.name})
                still = body.name not in {*last.missing[SLOW], *last.lost}
            self._rests[body.name] = still
        return self._rests[body.name]

    def settles(self, body: Body, first: int = 0) -> bool:
        """Whether a body moves little from a step on, and lies still at the end of the run."""
        return self.rests(body) and not self.run.gets_far(body, first)


def statics(run: Run) -> Statics:
    """The looks of a run, which it keeps."""
    if run.statics is None:
        run.statics = Statics(run)
    return run.statics


def out_of_balance(run: Run) -> Iterator[Finding]:
    """Bodies whose loads no forces of Coulomb's law bear, by the run's cone.

    A body that falls until the end because its contacts bear nothing is in free fall; one that
    settles by less than a tenth of its size has no finding.
    """
    every = statics(run)
    falling = falls(run)
    for body in run.bodies_of:
        found = every.lacks(body.name)
        if not found or _in_corners(found, body):
            continue
        look, missing = max(found, key=lambda x: x[1].amount)
        weight = body.mass * run.g
        if body.name in falling and missing.force >= (1 - COUNTS) * weight:
            continue
        then = f"it starts with {missing.starts}; {DISTANCE}"
        if every.rests(body):
            if every.settles(body):
                continue
            drags = run.drags(body)[look.k :] > chosen.LITTLE * run.loads(body)[look.k :]
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


def _in_corners(found: list[tuple[Look, Missing]], body: Body) -> bool:
    """Whether nothing is missing of a body in the round cone, wherever it is in the run's."""
    return all(ROUND in look.laws and body.name not in look.missing[ROUND] for look, _ in found)


def corners(run: Run) -> Iterator[Finding]:
    """Bodies and pairs that the corners of a cone treat otherwise than a round one.

    Bodies that are in equilibrium in the round cone alone come first; then those that lack another
    force there, and the pair whose forces differ most.
    """
    every = statics(run)
    held: dict[str, int] = {}
    other: list[tuple[float, str, int, Missing, Missing]] = []
    for body in run.bodies_of:
        found = every.lacks(body.name)
        if found and _in_corners(found, body) and not every.settles(body):
            held[body.name] = found[0][0].k
        for look, here in found:
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
    changes = [change for look in every.looks for change in _changes(every, look, SLOW, ROUND)]
    changes = [x for x in changes if x.counts]
    if changes:
        change = max(changes, key=lambda x: x.share)
        yield _corner(
            f"{change.pair.name} {change.says('in the ellipsoid')}, in step {change.look.k}",
            {
                **change.numbers(),
                "ellipsoid_N": change.there.get("normal", 0.0),
                "step": change.look.k,
            },
        )


def _corner(cause: str, numbers: dict[str, float]) -> Finding:
    return Finding("corners of the cone", False, 'set cone = "ellipsoid"', cause, numbers)


def drag(run: Run) -> Iterator[Finding]:
    """The pair whose forces, or whose sticking, drag changes most."""
    best = _largest(run, SLOW, lambda change: change.of_drag)
    if best is None:
        return
    pair = best.pair.name
    numbers = {"without_drag_N": best.there[best.what], **best.numbers(), "step": best.look.k}
    does = best.says("without it")
    yield Finding(
        "drag",
        False,
        "move more slowly, or take a larger h",
        f"the drag m v / h of the step counts in {pair}: it {does}{best.parts()}, in step "
        f"{best.look.k}",
        numbers,
    )


def layer(run: Run) -> Iterator[Finding]:
    """The pair whose forces, or whose sticking, the boundary layer changes most."""
    best = _largest(run, COULOMB, lambda change: change.of_layer)
    if best is None:
        return
    look = best.look
    of_pair = run.pair_of == run.pairs.index(best.pair)
    slides = bool((run.mu[of_pair, 0] > 0).any())
    rises = "slides rises by mu_v h v" if slides else "spins rises by mu_omega h omega"
    what = {"normal": "presses with", "friction": "rubs with", "torque": "bears"}[best.what]
    unit = "N m" if best.what == "torque" else "N"
    does = f"{what} {best.here[best.what]:.3g} {unit}, where Coulomb's law allows "
    does += f"{best.there[best.what]:.3g} {unit}{best.parts()}"
    if best.stops:
        does = best.says("by Coulomb's law")
    yield Finding(
        "boundary layer",
        False,
        'move more slowly, take a smaller h, or set law = "coulomb"',
        f"{best.pair.name} {does}, in step {look.k}: what {rises}, against what presses it",
        {
            **best.numbers(),
            "coulomb_N": best.there["normal"],
            "coulomb_mm": 1e3 * best.slips_there,
            "step": look.k,
        },
    )


class Change(NamedTuple):
    """What a pair does by one law, and by another.

    Parameters
    ----------
    run : Run
    look : Look
    pair : ContactPair
    here, there : dict of str to float
        Normal force, friction and torque [N, N, N m].
    slips_here, slips_there, spins_here, spins_there : float
        [m, rad]
    what : str
        The quantity of which most changes.
    share : float
        How much, over the larger one [-].
    stops : bool
        Whether it slips or spins by the first law alone.
    of_drag, of_layer : bool
        Whether drag, or the layer, changes a tenth of it.
    drag, layer : float
        By how much [N, N, N m].
    """

    look: Look
    pair: ContactPair
    here: dict[str, float]
    there: dict[str, float]
    slips_here: float
    slips_there: float
    spins_here: float
    spins_there: float
    what: str
    share: float
    stops: bool
    of_drag: bool
    of_layer: bool
    drag: float
    layer: float

    @property
    def counts(self) -> bool:
        """Whether anything changes by a tenth."""
        return self.stops or self.share > COUNTS

    def numbers(self) -> dict[str, float]:
        """Of a finding."""
        return {
            "normal_N": self.here["normal"],
            "friction_N": self.here["friction"],
            "of_drag": self.drag,
            "of_layer": self.layer,
            "slip_mm": 1e3 * self.slips_here,
        }

    def parts(self) -> str:
        """Both parts where both count."""
        if not (self.of_drag and self.of_layer) or self.stops:
            return ""
        return f" ({self.layer:+.3g} by the layer, {self.drag:+.3g} by drag)"

    def says(self, where: str) -> str:
        """What it does by each."""
        if self.stops:
            slides = self.slips_here >= least(self.pair) * self.spins_here
            if slides and self.slips_there < COUNTS * self.slips_here:
                return f"slips by {1e3 * self.slips_here:.2g} mm, and not {where}"
            return f"turns by {np.degrees(self.spins_here):.2g} degrees, and not {where}"
        unit = "N m" if self.what == "torque" else "N"
        words = {"normal": "has", "friction": "rubs with", "torque": "bears a torque of"}
        return (
            f"{words[self.what]} {self.here[self.what]:.3g} {unit}, {where} "
            f"{self.there[self.what]:.3g} {unit}"
        )


def _largest(run: Run, other: str, counts: Callable[[Change], bool]) -> Change | None:
    """The change of largest share, from the run to another law, of those that count."""
    every = statics(run)
    changes = (change for look in every.looks for change in _changes(every, look, RUN, other))
    return max(filter(counts, changes), key=lambda change: change.share, default=None)


def _changes(every: Statics, look: Look, one: str, other: str) -> Iterator[Change]:
    """The changes of pairs, from one law to another, whose bodies are in equilibrium."""
    run = every.run
    if other not in look.laws or one not in look.laws:
        return
    inner = look.undetermined if SLOW in look.laws else np.zeros((len(look.asked), 4, 0))
    for i, pair in enumerate(run.pairs):
        of_pair = run.pair_of == i
        at = of_pair & look.asked
        if (
            not (at & look.live).any()
            or not look.knows(other, of_pair)
            or not look.knows(one, of_pair)
        ):
            continue
        near = [body for body in run.bodies_of if body.contacts[of_pair].any()]
        if {b.name for b in near} & (look.missing[SLOW].keys() | look.lost):
            continue
        before = look.k - 1
        first = one == RUN and run.steps > 1  # of a run, which starts as it likes
        if (first and not look.k) or (look.k and not run.presses[before, of_pair].any()):
            continue  # it comes to press in this step
        here, there = _sums(run, look, one, of_pair), _sums(run, look, other, of_pair)
        known = _known(look, inner, of_pair)
        force = max(here["normal"], there["normal"], here["friction"], there["friction"])
        if near and force <= COUNTS * min(run.load(body, look.k) for body in near):
            continue  # it hardly bears them, as where they are being put down or lifted
        most = float(run["wrench"][:, of_pair, 2].sum(axis=1).max())
        rubs = max(force, most / 2)
        arm = rubs * pair.mu_omega if pair.rows == 6 else np.inf
        whole = force if force > COUNTS * most else most
        sizes = {"normal": whole, "friction": rubs, "torque": arm}
        shares = {
            name: abs(here[name] - there[name]) / sizes[name]
            if known[name] and sizes[name] > 0
            else 0.0
            for name in QUANTITIES
        }
        what = max(shares, key=lambda name: shares[name])
        share = shares[what]
        slips = [_slips(run, look, law, of_pair) for law in (one, other)]
        stops = _stops(run, look, pair, of_pair, slips, other)
        settles = near and all(every.settles(body, look.k) for body in near)
        of_drag, of_layer, drags, layers = _parts(run, look, of_pair, what, sizes[what], stops)
        moves = bool(run.targets_move[look.k])
        of_drag &= moves
        of_layer &= moves or not settles
        yield Change(
            look, pair, here, there, slips[0][0], slips[1][0], slips[0][1], slips[1][1],
            what, share, stops, of_drag, of_layer, drags, layers,
        )  # fmt: skip


def _parts(
    run: Run, look: Look, of_pair: Mask, what: str, size: float, stops: bool
) -> tuple[bool, bool, float, float]:
    """Whether drag and layer count in a pair, and how much of a quantity they are.

    run = slow + drag + layer. Where the convex step has no layer slowly, the layer follows from
    drag, whose the whole difference is then.
    """
    laws = [RUN, COULOMB, SLOW]
    if not all(look.knows(law, of_pair) for law in laws):
        if not look.knows(SLOW, of_pair):
            return False, False, 0.0, 0.0
        of_run, slow = (_sums(run, look, law, of_pair)[what] for law in (RUN, SLOW))
        counts = stops or abs(of_run - slow) > COUNTS * size
        return counts, False, of_run - slow, 0.0
    of_run, coulomb, slow = (_sums(run, look, law, of_pair)[what] for law in laws)
    layers = of_run - coulomb
    drags = coulomb - slow
    if look.knows(MODEL, of_pair) and abs(layers) > COUNTS * size:
        model = _sums(run, look, MODEL, of_pair)[what]
        if abs(model - slow) <= COUNTS * abs(layers):
            drags, layers = drags + layers, 0.0
    of_drag = abs(drags) > COUNTS * size
    of_layer = abs(layers) > COUNTS * size
    if stops:
        sticks = max(_slips(run, look, COULOMB, of_pair)) <= COUNTS * max(
            _slips(run, look, RUN, of_pair)
        )
        of_layer |= sticks
        of_drag |= not sticks
    return of_drag, of_layer, drags, layers


def _sums(run: Run, look: Look, law: str, of_pair: Mask) -> dict[str, float]:
    """Normal force, friction and torque of a pair [N, N, N m]."""
    forces = look.laws[law].forces[of_pair]
    contacts = look.step.contacts
    rubs = forces[:, :1] * contacts.d1[of_pair] + forces[:, 1:2] * contacts.d2[of_pair]
    return {
        "normal": float(forces[:, 2].sum()),
        "friction": float(np.linalg.norm(rubs.sum(axis=0))),
        "torque": abs(float(forces[:, 3].sum())),
    }


def _slips(run: Run, look: Look, law: str, of_pair: Mask) -> tuple[float, float]:
    """The longest slip [m] and spin [rad] of contacts of a pair that press."""
    forces, motion = (x[of_pair] for x in look.laws[law])
    contacts = look.step.contacts
    presses = forces[:, 2] > 1e-6 * forces[:, 2].max(initial=0.0)
    if not presses.any():
        return 0.0, 0.0
    d1, d2 = (np.vecdot(motion[:, :3], d[of_pair]) for d in (contacts.d1, contacts.d2))
    spins = np.where(contacts.torsion[of_pair], np.abs(motion[:, 3]), 0.0)
    return float(np.hypot(d1, d2)[presses].max()), float(spins[presses].max())


def _stops(
    run: Run,
    look: Look,
    pair: ContactPair,
    of_pair: Mask,
    slips: list[tuple[float, float]],
    other: str,
) -> bool:
    """Whether a pair with friction slips or spins by the first law alone, and far in the run."""
    way = np.where(run.presses[:, of_pair, None], np.abs(run.slips[:, of_pair]), 0.0).sum(axis=0)
    far = (way[:, :2] > SLID * run.sizes[of_pair][:, None]).any(), (way[:, 2] > SLID).any()
    rubs = pair.mu_v > 0, pair.rows == 6 and pair.mu_omega > 0
    (slip, spin), (slip_there, spin_there) = slips
    slides = slip * run.steps > SLID * least(pair) and slip_there < COUNTS * slip
    turns = spin * run.steps > SLID and spin_there < COUNTS * spin
    if not _presses(look, other, of_pair):
        return False
    return bool((far[0] and rubs[0] and slides) or (far[1] and rubs[1] and turns))


def _presses(look: Look, law: str, of_pair: Mask) -> bool:
    """Whether a pair presses by a law, with more than a tenth of what it does in the run."""
    here, there = (look.laws[x].forces[of_pair, 2].sum() for x in (RUN, law))
    return bool(there > COUNTS * here)


def _known(look: Look, inner: Array, of_pair: Mask) -> dict[str, bool]:
    """Which forces of a pair no inner load changes."""
    contacts = look.step.contacts
    z = inner[of_pair]
    rubs = np.einsum("cd,ci->cid", z[:, 0], contacts.d1[of_pair])
    rubs = rubs + np.einsum("cd,ci->cid", z[:, 1], contacts.d2[of_pair])
    resultants = {
        "normal": z[:, 2].sum(axis=0),
        "friction": rubs.sum(axis=0),
        "torque": z[:, 3].sum(axis=0),
    }
    return {name: bool(np.abs(x).max(initial=0.0) <= 1e-6) for name, x in resultants.items()}

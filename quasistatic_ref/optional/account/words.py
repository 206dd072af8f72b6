"""An account in words: its events, the lines of each pair, body and joint, and its JSON."""

from base64 import b64encode
from collections.abc import Iterable, Iterator
from html import escape
from typing import Any, NamedTuple

import numpy as np

from quasistatic_ref.formats.quoting import listed
from quasistatic_ref.model.joints.axis_joint import Prismatic
from quasistatic_ref.simulate.account import Account, Drive, Motion, PairAccount, Span
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import BRIEF, SLID, SPUN

PRINTED = 4
"""Bodies and joints of a short account."""
EVENTS = 12
"""Events of a short account."""


class Event(NamedTuple):
    """One event.

    Parameters
    ----------
    t : float
        End of the step in which it began [s].
    words : str
    """

    t: float
    words: str

    def __str__(self) -> str:
        return f"{self.t:.2f} s {self.words}"


def events(account: Account) -> list[Event]:
    """What began or ended, in its order; what happens to several pairs of a table at once is one.

    Parameters
    ----------
    account : Account
    """
    t = account.t
    last = len(t) - 1
    touch = []
    leave = []
    for pair in account.pairs:
        for span in pair.contact:
            if span.first:
                touch.append((span.first, f"{pair.table}: {{}} touch{{}} {pair.beta}", pair.alpha))
            if span.last < last:
                go = f"{pair.table}: {{}} let{{}} go of {pair.beta}"
                leave.append((span.last + 1, go, pair.alpha))
    found = [*_joined(touch, "es"), *_joined(leave, "s")]
    for pair in account.pairs:
        for span in pair.sliding:
            if slid(pair, span) >= SLID:
                way = f"slides {length(slid(pair, span))} along {pair.alpha}"
                found.append((span.first, f"{pair.beta} {way} {_until(span, t)}"))
        for span in pair.spinning:
            if turned(pair, span) >= SPUN:
                way = f"spins {degrees(turned(pair, span))} about the normal of {pair.alpha}"
                found.append((span.first, f"{pair.beta} {way} {_until(span, t)}"))
    found += [(span.first, stop.name) for stop in account.stops for span in stop.bears]
    said = [Event(float(t[k]), words) for k, words in found]
    return sorted([*said, *_waypoints(account)], key=lambda event: event.t)


def _waypoints(account: Account) -> Iterator[Event]:
    """The waypoints of each body, and how far the joint was from its own that was farthest."""
    t = account.t
    farthest: dict[tuple[float, str, str], tuple[float, str]] = {}
    for drive in account.drives:
        body, _, joint = drive.of.name.partition("/")
        for time in drive.waypoints:
            if len(t) and account.h / 2 < time < t[-1] + account.h / 2:
                error = float(drive.error[np.abs(t - time).argmin()])
                key = (time, body, drive.unit)
                farthest[key] = max(farthest.get(key, (-1.0, "")), (error, joint))
    for (time, body, unit), (error, joint) in farthest.items():
        off = f"{joint} within {amount(error, unit)} of its target"
        yield Event(time, f"{body} at its waypoint, {off}")


def _joined(events: Iterable[tuple[int, str, str]], one: str) -> Iterator[tuple[int, str]]:
    """Events of pairs, those of one table that are `BRIEF` steps apart at most joined.

    Each has its step, its words, and who does it; `one` is the ending of a verb of one.
    """
    every = sorted(events)
    while every:
        k, does, _ = every[0]
        own = [x for x in every if x[1] == does and x[0] <= k + BRIEF]
        every = [x for x in every if x not in own]
        names = list(dict.fromkeys(who for *_, who in own))
        yield k, does.format(listed(names), one if len(names) == 1 else "")


def lines(account: Account) -> Iterator[str]:
    """The account, a fact a line.

    Parameters
    ----------
    account : Account
    """
    for motion in account.motions:
        yield moved(motion)
        for other, held in motion.touched.items():
            yield f"  touches {other} {times(held, account.t)}"
        for other, held in motion.carried.items():
            yield f"  is carried by {other} {times(held, account.t)}"
    for drive in account.drives:
        yield driven(drive, account.t)
    for stop in account.stops:
        when = times(stop.bears, account.t)
        yield f"{stop.name} {when}, with at most {stop.force.max():.3g} {stop.unit}"
    for pair in account.pairs:
        yield from _pair(pair, account.t)
    yield from map(str, events(account))
    yield from (f"missing: {sentence}" for sentence in account.missing)
    yield from (f"finding: {sentence}" for sentence in account.findings)


def short(account: Account) -> Iterator[str]:
    """Some bodies, the joints farthest from their targets, and the first events.

    Parameters
    ----------
    account : Account
    """
    yield from map(moved, account.motions[:PRINTED])
    if len(account.motions) > PRINTED:
        yield f"{len(account.motions) - PRINTED} more free bodies: see --json"
    drives = sorted(account.drives, key=lambda drive: -float(drive.error[-1]))
    yield from (driven(drive, account.t) for drive in drives[:PRINTED])
    every = events(account)
    yield from map(str, every[:EVENTS])
    if len(every) > EVENTS:
        yield f"{len(every) - EVENTS} more events: see quasistatic-ref account"


def moved(motion: Motion) -> str:
    """How far a free body or a joint of it moved."""
    if not motion.of.lengths:
        return f"{motion.of.name}: turned by at most {degrees(motion.turned.max())}"
    name = motion.of.name.removesuffix("/base")
    way = motion.moved
    if isinstance(motion.of, Prismatic):
        return f"{name}: moved by {length(way[-1, 0])}"
    along = ", ".join(
        f"{axis} {signed(x)}" for axis, x in zip("xyz", way[-1], strict=True) if abs(x) > 5e-5
    )
    ends = f"ends {length(float(np.linalg.norm(way[-1])))} from its start"
    return (
        f"{name}: {ends}{f' ({along})' if along else ''}, largest rotation "
        f"{degrees(motion.turned.max())}, largest rise {length(way[:, 2].max())}"
    )


def slid(pair: PairAccount, span: Span) -> float:
    """How far a pair slid in a span [m]; 0 where slips are not known."""
    return 0.0 if pair.slip is None else float(pair.slip[span.first : span.last + 1].sum())


def turned(pair: PairAccount, span: Span) -> float:
    """How far a pair turned about its normals in a span [rad]; 0 where that is not known."""
    return 0.0 if pair.turn is None else float(pair.turn[span.first : span.last + 1].sum())


def driven(drive: Drive, t: Array) -> str:
    """How an actuated joint ended, and what its spring bore."""
    largest = ""
    if drive.spring is not None:
        k = int(drive.spring.argmax())
        unit = "N" if drive.unit == "m" else "N m"
        largest = f", largest force of its spring {drive.spring[k]:.3g} {unit} at {t[k]:.2f} s"
    off = amount(float(drive.error[-1]), drive.unit)
    return f"{drive.of.name}: ends {off} from its target{largest}"


def _pair(pair: PairAccount, t: Array) -> Iterator[str]:
    """Near, touching, sliding; normal force, friction, torque and share."""
    k = int(pair.phi.argmin())
    yield f"{pair.name}: least distance {signed(pair.phi[k])} at {t[k]:.2f} s"
    for word, held in (
        ("near", pair.near),
        ("touches", pair.contact),
        ("slides", pair.sliding),
        ("spins", pair.spinning),
    ):
        if held:
            yield f"  {word} {times(held, t)}"
    if pair.sliding:
        yield f"  slides by {length(sum(slid(pair, span) for span in pair.sliding))} in all"
    if pair.loads is None or not pair.contact:
        return
    normal = pair.loads.normal
    on = [k for span in pair.contact for k in (span.first, span.last)]
    peak = int(normal.argmax())
    yield (
        f"  normal force {normal[on[0]]:.3g} N at first, {normal[on[-1]]:.3g} N at last, at most "
        f"{normal[peak]:.3g} N at {t[peak]:.2f} s"
    )
    yield (
        f"  friction at most {pair.loads.friction.max():.3g} N, torque at most "
        f"{pair.loads.torque.max():.3g} N m, at most {100 * pair.loads.share.max():.0f} % of what "
        "friction can bear"
    )


def tables(account: Account) -> dict[str, Any]:
    """The account as one JSON object.

    Parameters
    ----------
    account : Account
    """
    t = account.t

    def seconds(held: list[Span]) -> list[list[float]]:
        return [[float(t[span.first]), float(t[span.last])] for span in held]

    return {
        "bodies": {
            motion.of.name: {
                "largest_rotation_deg": float(np.degrees(motion.turned.max())),
                "largest_rise_mm": 1e3 * float(motion.moved[:, 2].max()),
                "ends_from_start_m": float(np.linalg.norm(motion.moved[-1])),
                "moved_m": motion.moved[-1].tolist(),
                "touched_s": {other: seconds(held) for other, held in motion.touched.items()},
                "carried_s": {other: seconds(held) for other, held in motion.carried.items()},
            }
            for motion in account.motions
        },
        "joints": {
            drive.of.name: {
                f"ends_from_target_{drive.unit}": float(drive.error[-1]),
                "largest_spring": None if drive.spring is None else float(drive.spring.max()),
                "waypoints_s": list(drive.waypoints),
            }
            for drive in account.drives
        },
        "stops": {
            stop.name: {"bears_s": seconds(stop.bears), "largest_force": float(stop.force.max())}
            for stop in account.stops
        },
        "pairs": {
            pair.name: {
                "least_distance_m": float(pair.phi.min()),
                "near_s": seconds(pair.near),
                "touches_s": seconds(pair.contact),
                "slides_s": seconds(pair.sliding),
                "spins_s": seconds(pair.spinning),
                "slip_m": None if pair.slip is None else float(pair.slip.sum()),
            }
            | ({} if pair.loads is None else {
                "largest_normal_N": float(pair.loads.normal.max()),
                "largest_friction_N": float(pair.loads.friction.max()),
                "largest_torque_Nm": float(pair.loads.torque.max()),
                "largest_share": float(pair.loads.share.max()),
            })
            for pair in account.pairs
        },
        "events": [{"t": event.t, "words": event.words} for event in events(account)],
        "missing": list(account.missing),
        "findings": list(account.findings),
    }  # fmt: skip


def measures(account: Account) -> dict[str, float]:
    """Each number of :func:`tables` by its owner and name, such as ``bunny.largest_rise_mm``.

    Parameters
    ----------
    account : Account
    """
    found = tables(account)
    return {
        f"{name.removesuffix('/base')}.{key}": value
        for kind in ("bodies", "joints", "stops", "pairs")
        for name, numbers in found[kind].items()
        for key, value in numbers.items()
        if isinstance(value, float)
    }


def html(name: str, account: Account, png: bytes) -> str:
    """The account as a page that needs nothing from elsewhere.

    Parameters
    ----------
    name : str
        Of the run.
    account : Account
    png : bytes
        Its figure.
    """
    items = "".join(f"<li>{escape(line)}</li>" for line in lines(account))
    image = b64encode(png).decode()
    return (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{escape(name)}</title>'
        f'<h1>{escape(name)}</h1><ul>{items}</ul><img alt="contacts, loads and motions over time" '
        f'src="data:image/png;base64,{image}"></html>'
    )


def times(held: Iterable[Span], t: Array) -> str:
    """Spans in seconds, such as ``0.31 to 0.42 s and 1.00 to 2.50 s``."""
    return listed([f"{t[span.first]:.2f} to {t[span.last]:.2f} s" for span in held])


def _until(span: Span, t: Array) -> str:
    return "to the end" if span.last == len(t) - 1 else f"until {t[span.last]:.2f} s"


def amount(x: float, unit: str) -> str:
    """A length [m] or an angle [rad], as its unit says."""
    return length(x) if unit == "m" else degrees(x)


def length(x: float) -> str:
    """A length [m] in millimetres, to three digits, at least a hundredth of one."""
    return f"{signed(abs(x)).removeprefix('+')}"


def signed(x: float) -> str:
    """The same with its sign."""
    mm = 1e3 * x
    return "0 mm" if abs(mm) < 0.005 else f"{mm:+.3g} mm"


def degrees(x: float) -> str:
    """An angle [rad] in degrees, at least a hundredth of one."""
    found = np.degrees(x)
    return "0 deg" if abs(found) < 0.005 else f"{found:.3g} deg"

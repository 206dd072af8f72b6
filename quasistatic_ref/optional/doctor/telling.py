"""The most telling numbers of a run, and how they are printed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.measures import (
    Drive,
    Motion,
    PairMeasures,
    Rounding,
    measures,
    rounding_of,
)
from quasistatic_ref.tolerances import FILLED, UNMOVED

if TYPE_CHECKING:
    from quasistatic_ref.simulate.settings import Settings
    from quasistatic_ref.simulate.trajectory import Trajectory

PRINTED = 4
"""Bodies and joints that are printed, unless all are asked for."""

ROOM = 100
"""Columns of the second line of a body, which has its turns in hands."""

UNITS = ("m", "mm", "s", "deg", "rad", "N", "Nm")
"""Units at the end of a word."""

IN_HAND = "largest_turn_in_"

LONG = 999.5
"""Length that is said in metres, since three digits of it are 1e+03 [mm]."""

Numbers = Mapping[str, Mapping[str, Mapping[str, float]]]
"""By kind, name and word [any unit]."""


def motion_numbers(motion: Motion, up: Array, rounding: Rounding) -> dict[str, float]:
    """How far a body or joint turned, ended and rose along a unit vector `up`, (3,) [-]."""
    numbers = {"largest_rotation_deg": float(np.degrees(rounding.angle(motion.turned.max())))}
    if motion.of.lengths:
        numbers["ends_from_start_m"] = float(rounding.length(np.linalg.norm(motion.moved[-1])))
    if motion.of.free:
        numbers["largest_rise_mm"] = 1e3 * float(rounding.length((motion.moved @ up).max()))
    for hand, angle in motion.turned_in.items():
        numbers[f"{IN_HAND}{hand}_deg"] = float(np.degrees(rounding.angle(angle.max())))
    return numbers


def drive_numbers(drive: Drive, rounding: Rounding) -> dict[str, float]:
    """How far a joint ends from its target, and how its spring pushed."""
    error = rounding.length(drive.error) if drive.unit == "m" else rounding.angle(drive.error)
    numbers = {f"ends_from_target_{drive.unit}": float(error[-1])}
    if drive.way > UNMOVED:
        numbers["share_of_way_left"] = float(error[-1]) / drive.way
    if drive.spring is not None:
        unit = "N" if drive.unit == "m" else "Nm"
        numbers[f"largest_spring_{unit}"] = float(drive.spring[error > 0].max(initial=0.0))
    return numbers


def pair_numbers(pair: PairMeasures, t: Array, h: float, rounding: Rounding) -> dict[str, float]:
    """When a pair touched, slid and spun, in steps of `h` [s] that end at `t` [s]."""
    least = float(rounding.length(pair.phi.min()))
    numbers = {} if least >= FILLED else {"least_distance_m": least}  # else it is a filler's
    numbers["touches_s"] = h * float(pair.touches.sum())
    if pair.touches.any():
        touching = t[pair.touches]
        numbers["first_touch_s"] = float(touching[0])
        numbers["last_touch_s"] = float(touching[-1])
    if pair.slip is not None and pair.turn is not None:
        numbers["slides_s"] = h * float(pair.slides.sum())
        numbers["slip_m"] = float(rounding.length(pair.slip).sum())
        numbers["spins_s"] = h * float(pair.spins.sum())
        numbers["turn_deg"] = float(np.degrees(rounding.angle(pair.turn).sum()))
    return numbers


def numbers_of(trajectory: Trajectory, settings: Settings) -> Numbers:
    """The most telling numbers of a run of a scenario or simulator.

    Of each kind (``"bodies"``, ``"joints"``, ``"pairs"``) and each of its names, by words that end
    in their unit [any unit]. Where something is not known its word is missing; what float64 does
    not resolve in the run is 0.
    """
    did = measures(trajectory, settings)
    down = np.array(settings.gravity)
    down = down if down.any() else np.array([0.0, 0.0, -1.0])
    up = -down / np.linalg.norm(down)
    t = trajectory["t"]
    return {
        "bodies": {
            each.of.name.removesuffix("/base"): motion_numbers(each, up, did.rounding)
            for each in did.motions
        },
        "joints": {one.of.name: drive_numbers(one, did.rounding) for one in did.drives},
        "pairs": {one.name: pair_numbers(one, t, settings.h, did.rounding) for one in did.pairs},
    }


def least_artifacts(trajectory: Trajectory, settings: Settings) -> tuple[float, float]:
    """The least quasi-dynamic number [-] and boundary layer [m] that float64 resolves in a run."""
    least = rounding_of(trajectory, settings.system.joints).m
    fall = settings.h**2 * float(np.linalg.norm(settings.gravity))  # in a step, [m]
    return (least / fall if fall else 0.0), least


def in_words(word: str, value: float) -> str:
    """A number with its name and unit: ``largest spring 2.462 N`` for ``largest_spring_N``.

    Parameters
    ----------
    word : str
        Its name in records, which ends in its unit.
    value : float
        In that unit [any].
    """
    name, _, unit = word.rpartition("_")
    if unit not in UNITS:
        return f"{word.replace('_', ' ')} {value:.4g}"
    return f"{name.replace('_', ' ')} {value:.4g} {unit.replace('Nm', 'N m')}"


def lines(numbers: Numbers, every: bool = False) -> Iterator[str]:
    """A few numbers as text: two lines a body at most, one a joint, the others being counted.

    Parameters
    ----------
    numbers : mapping
    every : bool
        Whether none is left out.
    """
    for kind in ("bodies", "joints"):
        names = numbers[kind]
        for name, each in list(names.items())[: None if every else PRINTED]:
            words = {word: in_words(word, value) for word, value in each.items()}
            yield f"{name}: {', '.join(v for k, v in words.items() if not k.startswith(IN_HAND))}"
            yield from _in_hands([v for k, v in words.items() if k.startswith(IN_HAND)], every)
        if len(names) > PRINTED and not every:
            yield f"{len(names) - PRINTED} more {kind}: see --numbers"


def _in_hands(turns: list[str], every: bool) -> Iterator[str]:
    """The turns of a body in hands as one line, without those for which it has no room."""
    shown = len(turns)
    while not every and shown > 1 and len(", ".join(turns[:shown])) > ROOM:
        shown -= 1
    if turns:
        more = f", {len(turns) - shown} more: see --numbers" if shown < len(turns) else ""
        yield f"    {', '.join(turns[:shown])}{more}"


def pair_rows(numbers: Numbers) -> list[tuple[str, ...]]:
    """A table of all pairs: a row a pair, a column a number."""
    pairs = numbers["pairs"]
    words = list(dict.fromkeys(word for each in pairs.values() for word in each))
    rows = [("pair", *(in_words(word, 0.0).replace(" 0 ", " [") + "]" for word in words))]
    for name, each in pairs.items():
        rows.append((name, *(f"{each[word]:.4g}" if word in each else "-" for word in words)))
    return rows if pairs else []


def by_name(numbers: Numbers) -> dict[str, float]:
    """Each number by its owner and name, such as ``bunny.largest_rise_mm`` [any unit]."""
    return {
        f"{name.removesuffix('/base')}.{word}": value
        for names in numbers.values()
        for name, each in names.items()
        for word, value in each.items()
    }


def amount(x: float, unit: str) -> str:
    """A length [m] or an angle [rad], as its unit says."""
    return length(x) if unit == "m" else f"{np.degrees(x):.3g} deg"


def rounded(x: float, towards: Callable[[float], float]) -> float:
    """Two digits beyond x > 0 [any unit]: above it by ``np.ceil``, below it by ``np.floor``.

    A number that has two digits is left, too: at x itself rounding would decide.
    """
    digits = 10.0 ** np.floor(np.log10(x) - 1)
    beyond = 1e-9 * (2 * towards(0.5) - 1)
    return float(towards(x / digits * (1 + beyond)) * digits)


def length(x: float) -> str:
    """A length [m] of a motion, to three digits: none below a hundredth of a millimetre."""
    return "0 mm" if abs(x) < 5e-6 else distance(x)


def distance(x: float, digits: int = 3) -> str:
    """A length [m] to some digits, however short it is: in millimetres up to 1 m.

    A remedy has four: what is moved so is less than 1 mm off, up to 10 m.
    """
    mm = 1e3 * abs(x)
    return f"{abs(x):.{digits}g} m" if mm >= LONG else f"{mm:.{digits}g} mm"

"""The most telling numbers of a run, and how they are printed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.measures import Drive, Motion, PairMeasures, measures
from quasistatic_ref.tolerances import FILLED, UNMOVED

if TYPE_CHECKING:
    from quasistatic_ref.simulate.settings import Settings
    from quasistatic_ref.simulate.trajectory import Trajectory

PRINTED = 4
"""Lines of a kind that are printed."""

UNITS = ("m", "mm", "s", "deg", "rad", "N", "Nm")
"""Units at the end of a word."""

LONG = 999.5
"""Length that is said in metres, since three digits of it are 1e+03 [mm]."""

Numbers = Mapping[str, Mapping[str, Mapping[str, float]]]
"""By kind, name and word [any unit]."""


def motion_numbers(motion: Motion, up: Array) -> dict[str, float]:
    """How far a body or joint turned, ended and rose along a unit vector `up`, (3,) [-]."""
    numbers = {"largest_rotation_deg": float(np.degrees(motion.turned.max()))}
    for hand, angle in motion.turned_in.items():
        numbers[f"largest_turn_in_{hand}_deg"] = float(np.degrees(angle.max()))
    if motion.of.lengths:
        numbers["ends_from_start_m"] = float(np.linalg.norm(motion.moved[-1]))
    if motion.of.free:
        numbers["largest_rise_mm"] = 1e3 * float((motion.moved @ up).max())
    return numbers


def drive_numbers(drive: Drive) -> dict[str, float]:
    """How far a joint ends from its target, and how its spring pushed."""
    numbers = {f"ends_from_target_{drive.unit}": float(drive.error[-1])}
    if drive.way > UNMOVED:
        numbers["share_of_way_left"] = float(drive.error[-1]) / drive.way
    if drive.spring is not None:
        unit = "N" if drive.unit == "m" else "Nm"
        numbers[f"largest_spring_{unit}"] = float(drive.spring.max())
    return numbers


def pair_numbers(pair: PairMeasures, t: Array, h: float) -> dict[str, float]:
    """When a pair touched, slid and spun, in steps of `h` [s] that end at `t` [s]."""
    least = float(pair.phi.min())
    numbers = {} if least >= FILLED else {"least_distance_m": least}  # else it is a filler's
    numbers["touches_s"] = h * float(pair.touches.sum())
    if pair.touches.any():
        touching = t[pair.touches]
        numbers["first_touch_s"] = float(touching[0])
        numbers["last_touch_s"] = float(touching[-1])
    if pair.slip is not None and pair.turn is not None:
        numbers["slides_s"] = h * float(pair.slides.sum())
        numbers["slip_m"] = float(pair.slip.sum())
        numbers["spins_s"] = h * float(pair.spins.sum())
        numbers["turn_deg"] = float(np.degrees(pair.turn.sum()))
    return numbers


def numbers_of(trajectory: Trajectory, settings: Settings) -> Numbers:
    """The most telling numbers of a run of a scenario or simulator.

    Of each kind (``"bodies"``, ``"joints"``, ``"pairs"``) and each of its names, by words that end
    in their unit [any unit]. Where something is not known its word is missing.
    """
    did = measures(trajectory, settings)
    down = np.array(settings.gravity)
    down = down if down.any() else np.array([0.0, 0.0, -1.0])
    up = -down / np.linalg.norm(down)
    t = trajectory["t"]
    return {
        "bodies": {
            each.of.name.removesuffix("/base"): motion_numbers(each, up) for each in did.motions
        },
        "joints": {one.of.name: drive_numbers(one) for one in did.drives},
        "pairs": {one.name: pair_numbers(one, t, settings.h) for one in did.pairs},
    }


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


def lines(numbers: Numbers) -> Iterator[str]:
    """A few numbers of each kind as text, a line a name, the others being counted."""
    for kind, names in numbers.items():
        for name, each in list(names.items())[:PRINTED]:
            yield f"{name}: {', '.join(in_words(word, value) for word, value in each.items())}"
        if len(names) > PRINTED:
            yield f"{len(names) - PRINTED} more {kind}: see --json"


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

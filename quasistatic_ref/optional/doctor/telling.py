"""The most telling numbers of a run, and how they are printed."""

from collections.abc import Callable, Iterator

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.accounts import Account, Drive, Motion, PairAccount, Stop
from quasistatic_ref.tolerances import FILLED, UNMOVED

PRINTED = 4
"""Lines of a kind in a short table."""


def stop_numbers(stop: Stop, h: float) -> dict[str, float]:
    """How long a stop bears a joint, with steps of `h` [s], and its largest force."""
    bears = h * float((stop.force > 0).sum())
    return {"bears_s": bears, "largest_force": float(stop.force.max())}


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


def pair_numbers(pair: PairAccount, t: Array, h: float) -> dict[str, float]:
    """When a pair touched, slid and spun, in steps of `h` [s] that end at `t` [s]; its loads."""
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
    if pair.loads is not None:
        numbers["largest_normal_N"] = float(pair.loads.normal.max())
        numbers["largest_friction_N"] = float(pair.loads.friction.max())
        numbers["largest_torque_Nm"] = float(pair.loads.torque.max())
        numbers["largest_share"] = float(pair.loads.share.max())
    return numbers


def lines(account: Account, most: int | None = None) -> Iterator[str]:
    """The table as text, a line a name, and what the record does not hold.

    Parameters
    ----------
    account : Account
    most : int, optional
        Lines of a kind, the others being counted; by default all.
    """
    for kind, names in account.numbers.items():
        for name, numbers in list(names.items())[:most]:
            each = ", ".join(f"{word} {value:.4g}" for word, value in numbers.items())
            yield f"{name}: {each}"
        if most is not None and len(names) > most:
            yield f"{len(names) - most} more {kind}: see quasistatic-ref account"
    yield from (f"missing: {sentence}" for sentence in account.missing)


def measures(account: Account) -> dict[str, float]:
    """Each number by its owner and name, such as ``bunny.largest_rise_mm``.

    Parameters
    ----------
    account : Account
    """
    return {
        f"{name.removesuffix('/base')}.{word}": value
        for names in account.numbers.values()
        for name, numbers in names.items()
        for word, value in numbers.items()
    }


def table_of(pair: ContactPair) -> str:
    """The name of the table that a pair is of."""
    return pair.name.partition("(")[0]


def amount(x: float, unit: str) -> str:
    """A length [m] or an angle [rad], as its unit says."""
    return length(x) if unit == "m" else f"{np.degrees(x):.3g} deg"


def rounded(x: float, towards: Callable[[float], float]) -> float:
    """A number x > 0 [any unit] to two digits: up by ``np.ceil``, down by ``np.floor``."""
    digits = 10.0 ** np.floor(np.log10(x) - 1)
    return float(towards(x / digits) * digits)


def length(x: float) -> str:
    """A length [m] in millimetres, to three digits, at least a hundredth of one."""
    mm = 1e3 * abs(x)
    return "0 mm" if mm < 0.005 else f"{mm:.3g} mm"

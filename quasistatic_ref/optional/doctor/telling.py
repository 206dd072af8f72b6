"""The most telling numbers of a run, and how they are printed."""

from collections.abc import Iterator, Sequence

import numpy as np

from quasistatic_ref.simulate.account import Account, Drive, Motion, PairAccount, Stop
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import FILLED

PRINTED = 4
"""Lines of a kind in a short table."""
Numbers = dict[str, dict[str, dict[str, float]]]


def telling_numbers(
    t: Array,
    h: float,
    pairs: Sequence[PairAccount],
    motions: Sequence[Motion],
    drives: Sequence[Drive],
    stops: Sequence[Stop],
) -> Numbers:
    """The table of an account.

    Parameters
    ----------
    t : ndarray, shape (steps,)
        [s].
    h : float
    pairs : sequence of PairAccount
    motions : sequence of Motion
    drives : sequence of Drive
    stops : sequence of Stop
    """
    return {
        "bodies": {motion.of.name.removesuffix("/base"): _of_motion(motion) for motion in motions},
        "joints": {drive.of.name: _of_drive(drive) for drive in drives},
        "stops": {
            stop.name: {
                "bears_s": h * float((stop.force > 0).sum()),
                "largest_force": float(stop.force.max()),
            }
            for stop in stops
        },
        "pairs": {pair.name: _of_pair(pair, t, h) for pair in pairs},
    }


def _of_motion(motion: Motion) -> dict[str, float]:
    numbers = {"largest_rotation_deg": float(np.degrees(motion.turned.max()))}
    for hand, angle in motion.turned_in.items():
        numbers[f"largest_turn_in_{hand}_deg"] = float(np.degrees(angle.max()))
    if motion.of.lengths:
        numbers["ends_from_start_m"] = float(np.linalg.norm(motion.moved[-1]))
    if motion.of.free:
        numbers["largest_rise_mm"] = 1e3 * float(motion.moved[:, 2].max())
    return numbers


def _of_drive(drive: Drive) -> dict[str, float]:
    numbers = {f"ends_from_target_{drive.unit}": float(drive.error[-1])}
    if drive.way > 0:
        numbers["share_of_way_left"] = float(drive.error[-1]) / drive.way
    if drive.spring is not None:
        unit = "N" if drive.unit == "m" else "Nm"
        numbers[f"largest_spring_{unit}"] = float(drive.spring.max())
    return numbers


def _of_pair(pair: PairAccount, t: Array, h: float) -> dict[str, float]:
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


def amount(x: float, unit: str) -> str:
    """A length [m] or an angle [rad], as its unit says."""
    return length(x) if unit == "m" else f"{np.degrees(x):.3g} deg"


def length(x: float) -> str:
    """A length [m] in millimetres, to three digits, at least a hundredth of one."""
    mm = 1e3 * abs(x)
    return "0 mm" if mm < 0.005 else f"{mm:.3g} mm"

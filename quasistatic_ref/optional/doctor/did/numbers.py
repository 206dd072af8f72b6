"""The most telling numbers of a run: of each body, joint and pair."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.model.screw import between, rotation_between
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.doctor.frame.contacts import (
    contact_slips,
    motion_of_contacts,
    touching,
)
from quasistatic_ref.tolerances import FILLED, UNMOVED

if TYPE_CHECKING:
    from quasistatic_ref.simulate.record.trajectory import Trajectory
    from quasistatic_ref.simulate.settings import Settings

SLIDES: Final = 1e-4
"""Slip of a pair that slides, at least [m/s]: 1 mm in ten seconds."""

SPINS: Final = 1e-3
"""Turn about its normal of a pair that spins, at least [rad/s]: 0.6 deg in ten
seconds."""

ROUNDINGS: Final = 16
"""How many roundings a number of one step may have, to float64's last bit; each step has one."""

SMALL = 1e-6
"""Angle of a rotation whose axis is rounding [rad]."""

IN_HAND = "largest_turn_in_"
ROTATION = "largest_rotation_deg"
CARRIED = "largest_rotation_carried_deg"
CARRIED_FROM = "carried_from_s"
FROM_START = "ends_from_start_m"
RISE = "largest_rise_mm"
FROM_TARGET = "ends_from_target_"
BEYOND = "ends_beyond_target_"
LEFT = "share_of_way_left"
SPRING = "largest_spring_"
"""Words of numbers, or how they begin."""

Numbers = Mapping[str, Mapping[str, Mapping[str, float]]]
"""By kind, name and word [any unit]."""


class Rounding(NamedTuple):
    """The lengths and angles below which a run is mere rounding of float64.

    Parameters
    ----------
    m : float
        Of lengths [m]: of the farthest coordinate and contact.
    rad : float
        Of angles [rad].
    """

    m: float
    rad: float


def numbers_of(trajectory: Trajectory, settings: Settings) -> Numbers:
    """The most telling numbers of a run of a scenario or simulator.

    Of each kind (``"bodies"``, ``"joints"``, ``"pairs"``) and each of its names, by words that end
    in their unit [any unit]. Where something is not known its word is missing; what float64 does
    not resolve in the run is 0.
    """
    joints = settings.system.joints
    driven = [joint for joint in joints if joint.actuated]
    least = rounding_of(trajectory, joints)
    down = np.array(settings.gravity)
    down = down if down.any() else np.array([0.0, 0.0, -1.0])
    up = -down / np.linalg.norm(down)
    hands = [joint for joint in driven if joint.free]
    carried_from = min((_departure(hand, trajectory) for hand in hands), default=0)
    bodies = {
        joint.name.removesuffix("/base"): _of_body(
            joint, trajectory, hands, carried_from, up, least
        )
        for joint in joints
        if not joint.actuated
    }
    if not trajectory.steps:
        return {"bodies": bodies, "joints": {}, "pairs": {}}
    K = stiffness(settings.K_q)
    of_joints = {joint.name: _of_joint(joint, trajectory, K, least) for joint in driven}
    return {"bodies": bodies, "joints": of_joints, "pairs": dict(_of_pairs(trajectory, least))}


def rounding_of(run: Trajectory, joints: Sequence[Joint]) -> Rounding:
    """The rounding of a run, from its size in space and its number of steps."""
    places = [run["q"][:, joint.q][:, : joint.lengths].ravel() for joint in joints]
    if "alpha" in run.arrays:
        places.append(run["alpha"][run["phi"] < FILLED].ravel())
    farthest = np.abs(np.concatenate([*places, [0.0]])).max()
    share = float((ROUNDINGS + run.steps) * np.finfo(np.float64).eps)
    return Rounding(share * float(farthest), share)


def resolved(x: ArrayLike, least: float) -> Array:
    """Numbers of any shape [any unit], 0 where they are at most `least`."""
    return np.where(np.abs(x) > least, x, 0.0)


def resolved_number(x: float | None, least: float) -> float | None:
    """A number [any unit], 0 where it is at most `least`; None stays."""
    return x if x is None else float(resolved(x, least))


def least_artifacts(trajectory: Trajectory, settings: Settings) -> tuple[float, float]:
    """The least quasi-dynamic number [-] and boundary layer [m] that float64 resolves in a run."""
    least = rounding_of(trajectory, settings.system.joints).m
    fall = settings.h**2 * float(np.linalg.norm(settings.gravity))  # in a step, [m]
    return (least / fall if fall else 0.0), least


def _departure(hand: Joint, run: Trajectory) -> int:
    """The number of steps before the target of a free hand leaves its start; 0 if it never does."""
    target = run["q_bar_a"]
    start = np.broadcast_to(run["q"][0, : target.shape[1]], target.shape)
    return int(np.argmax(_distance(hand, start, target) > UNMOVED)) if len(target) else 0


def _of_body(
    joint: Joint,
    run: Trajectory,
    hands: Sequence[Joint],
    carried_from: int,
    up: Array,
    least: Rounding,
) -> dict[str, float]:
    """How far a body or joint turned, ended and rose along a unit vector `up`, (3,) [-].

    It is carried from that number of steps on, if that is not 0.
    """
    q = run["q"]
    moved = (q - q[0])[:, joint.q][:, : joint.lengths]
    turned = {ROTATION: _turned(_turns(joint, q, np.broadcast_to(q[0], q.shape)))}
    if joint.free and carried_from:
        carried = q[carried_from:]
        at_departure = np.broadcast_to(carried[0], carried.shape)
        turned[CARRIED] = _turned(_turns(joint, carried, at_departure))
    if joint.free:
        for hand in hands:
            turned[f"{IN_HAND}{hand.name.removesuffix('/base')}_deg"] = _turned_in(joint, hand, q)
    degrees = {
        word: float(np.degrees(resolved(angle.max(), least.rad))) for word, angle in turned.items()
    }
    numbers = {ROTATION: degrees[ROTATION]}
    if joint.lengths:
        numbers[FROM_START] = float(resolved(np.linalg.norm(moved[-1]), least.m))
    if joint.free:
        numbers[RISE] = 1e3 * float(resolved((moved @ up).max(), least.m))
    if CARRIED in degrees:
        numbers[CARRIED_FROM] = float(run["t"][carried_from - 1])
    return numbers | degrees


def _turns(joint: Joint, q: Array, q_0: Array) -> Array:
    """Rotation vectors from q_0 to q, both (n, n_q), shape (n, ...) [rad]; of a slide none."""
    with np.errstate(all="ignore"):  # as plain arithmetic
        changes = np.array(joint.change([*q_0[:, joint.q].T], [*q[:, joint.q].T]))
    return changes[joint.lengths :].T


def _turned(turns: Array) -> Array:
    """Angles of rotation vectors, (n, ...), of which each is within half a turn of the last [rad].

    Those of rotations are half a turn at most: whole turns about the same axis are added.
    """
    turned = [turns[0]]
    for turn in turns[1:]:
        angle = np.linalg.norm(turn)
        along = turn if angle > SMALL else turned[-1]
        axis = along / (np.linalg.norm(along) or 1.0)
        more = np.round((turned[-1] @ axis - angle) / (2 * np.pi))
        turned.append(turn + 2 * np.pi * more * axis)
    return np.asarray(np.linalg.norm(turned, axis=1))


def _turned_in(body: Joint, hand: Joint, q: Array) -> Array:
    """Angle [rad] by which a free body has turned in the frame of a free hand since the start."""
    of_body, of_hand = (q[:, one.q][:, one.lengths :].T for one in (body, hand))
    with np.errstate(all="ignore"):  # as plain arithmetic
        seen = between([*of_hand], [*of_body])
        start = [np.broadcast_to(part[0], part.shape) for part in seen]
        turns, _, _ = rotation_between(start, seen)
    return _turned(np.stack(turns, axis=1))


def stiffness(K_q: Array) -> Array:
    """The diagonal of K_q, shape (n_a,) [N/m, N m/rad]; zero where K_q has other entries."""
    diagonal = np.diag(K_q)
    return diagonal * np.array_equal(K_q, np.diag(diagonal))


def errors(joint: Joint, run: Trajectory) -> Array:
    """Distance of an actuated joint or base from its target after each step, (steps,) [m, rad]."""
    target = run["q_bar_a"]
    return _distance(joint, run["q"][1:, : target.shape[1]], target)


def _distance(joint: Joint, q: Array, target: Array) -> Array:
    """From q to a target, both of shape (n, n_q_a) [m]; of a joint that only turns [rad]."""
    if not joint.lengths:
        return np.asarray(np.linalg.norm(_turns(joint, q, target), axis=1))
    return np.asarray(np.linalg.norm((q - target)[:, joint.q][:, : joint.lengths], axis=1))


def _of_joint(joint: Joint, run: Trajectory, K: Array, least: Rounding) -> dict[str, float]:
    """How far an actuated joint or base ends from its target, and how its spring pushed."""
    unit = "m" if joint.lengths else "rad"
    target = run["q_bar_a"]
    start = np.broadcast_to(run["q"][0, : target.shape[1]], target.shape)
    way = float(_distance(joint, start, target).max())
    error = resolved(errors(joint, run), getattr(least, unit))
    numbers = {f"{FROM_TARGET}{unit}": float(error[-1])}
    if way > UNMOVED:
        numbers[LEFT] = float(error[-1]) / way
    single = len(joint.coordinates) == 1
    if single and error[-1] > 0 and _is_beyond(joint, run):
        numbers[f"{BEYOND}{unit}"] = float(error[-1])
    if single and K.any():
        force = "N" if joint.lengths else "Nm"
        numbers[f"{SPRING}{force}"] = float(error.max()) * float(K[joint.v.start])
    return numbers


def _is_beyond(joint: Joint, run: Trajectory) -> bool:
    """Whether a joint of one coordinate ends on the other side of its last target."""
    target = run["q_bar_a"][-1, joint.q].tolist()
    (way,), (left,) = (joint.change(q[joint.q].tolist(), target) for q in run["q"][[0, -1]])
    return bool(way * left < 0)


def _of_pairs(run: Trajectory, least: Rounding) -> Iterator[tuple[str, dict[str, float]]]:
    """When each pair touched, slid and spun: by the mean of the contacts that touch."""
    names = list(dict.fromkeys(run.pair_names))
    if not names:
        return
    starts = list(map(run.pair_names.index, names))
    h, t = run.header.h, run["t"]
    motion = motion_of_contacts(run)
    on = touching(run, motion)
    count = np.add.reduceat(on, starts, axis=1, dtype=np.int64)
    phi = np.minimum.reduceat(run["phi"], starts, axis=1).min(axis=0)
    slip, turn = np.zeros((2, *count.shape))
    if motion is not None:
        slips = contact_slips(run, motion)
        both = np.array([np.hypot(slips[..., 0], slips[..., 1]), np.abs(slips[..., 2])]) * on
        slip, turn = np.add.reduceat(both, starts, axis=2) / np.maximum(count, 1)
    for j, name in enumerate(names):
        touches = count[:, j] > 0
        numbers = {"touches_s": h * float(touches.sum())}
        if phi[j] < FILLED:  # else it is a filler's
            numbers = {"least_distance_m": float(resolved(phi[j], least.m))} | numbers
        if touches.any():
            first, last = t[touches][[0, -1]].tolist()
            numbers |= {"first_touch_s": first, "last_touch_s": last}
        if motion is not None:
            numbers |= {
                "slides_s": h * float((slip[:, j] > SLIDES * h).sum()),
                "slip_m": float(resolved(slip[:, j], least.m).sum()),
                "spins_s": h * float((turn[:, j] > SPINS * h).sum()),
                "turn_deg": float(np.degrees(resolved(turn[:, j], least.rad).sum())),
            }
        yield name, numbers


def by_name(numbers: Numbers) -> dict[str, float]:
    """Each number by its owner and name, such as ``bunny.largest_rise_mm`` [any unit]."""
    return {
        f"{name.removesuffix('/base')}.{word}": value
        for names in numbers.values()
        for name, each in names.items()
        for word, value in each.items()
    }

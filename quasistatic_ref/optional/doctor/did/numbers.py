"""The most telling numbers of a run: of each body, joint and pair."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.model.joints.joint import Joint
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
    bodies = {
        joint.name.removesuffix("/base"): _of_body(joint, trajectory["q"], hands, up, least)
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


def least_artifacts(trajectory: Trajectory, settings: Settings) -> tuple[float, float]:
    """The least quasi-dynamic number [-] and boundary layer [m] that float64 resolves in a run."""
    least = rounding_of(trajectory, settings.system.joints).m
    fall = settings.h**2 * float(np.linalg.norm(settings.gravity))  # in a step, [m]
    return (least / fall if fall else 0.0), least


def _of_body(
    joint: Joint, q: Array, hands: Sequence[Joint], up: Array, least: Rounding
) -> dict[str, float]:
    """How far a body or joint turned, ended and rose along a unit vector `up`, (3,) [-]."""
    moved = (q - q[0])[:, joint.q][:, : joint.lengths]
    turned = {"largest_rotation": _turned(_turns(joint, q, np.broadcast_to(q[0], q.shape)))}
    if joint.free:
        for hand in hands:
            turned[IN_HAND + hand.name.removesuffix("/base")] = _turned_in(joint, hand, q)
    degrees = {
        f"{word}_deg": float(np.degrees(resolved(angle.max(), least.rad)))
        for word, angle in turned.items()
    }
    numbers = {"largest_rotation_deg": degrees["largest_rotation_deg"]}
    if joint.lengths:
        numbers["ends_from_start_m"] = float(resolved(np.linalg.norm(moved[-1]), least.m))
    if joint.free:
        numbers["largest_rise_mm"] = 1e3 * float(resolved((moved @ up).max(), least.m))
    return numbers | degrees


def _turns(joint: Joint, q: Array, q_0: Array) -> Array:
    """Rotation vectors from q_0 to q, both (n, n_q), shape (n, ...) [rad]; of a slide none."""
    ends = zip(q_0[:, joint.q].tolist(), q[:, joint.q].tolist(), strict=True)
    return np.array([joint.change(*two)[joint.lengths :] for two in ends])


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
    from scipy.spatial.transform import Rotation  # takes as long as a short run

    of_body, of_hand = (Rotation.from_quat(q[:, one.q][:, one.lengths :]) for one in (body, hand))
    seen = of_hand.inv() * of_body
    return _turned((seen * seen[0].inv()).as_rotvec())


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
    numbers = {f"ends_from_target_{unit}": float(error[-1])}
    if way > UNMOVED:
        numbers["share_of_way_left"] = float(error[-1]) / way
    if len(joint.coordinates) == 1 and K.any():
        force = "N" if joint.lengths else "Nm"
        numbers[f"largest_spring_{force}"] = float(error.max()) * float(K[joint.v.start])
    return numbers


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

"""The account of a run, from its file alone: what each pair, body and joint did.

What it needs of a scene stands in the header of the file, as :func:`scene_notes` writes it.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import cache
from typing import Any, Final

import numpy as np
from scipy.spatial.transform import Rotation

from quasistatic_ref.certify.solution import UNKNOWN
from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.model.joints import BASES, JOINTS
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.optional.doctor.accounts import (
    Account,
    Drive,
    Loads,
    Motion,
    PairAccount,
    Stop,
)
from quasistatic_ref.optional.doctor.artifacts import gap_after, pressing
from quasistatic_ref.optional.doctor.telling import (
    drive_numbers,
    motion_numbers,
    pair_numbers,
    stop_numbers,
)
from quasistatic_ref.optional.doctor.tolerances import NEAR
from quasistatic_ref.optional.friction import slip_norm
from quasistatic_ref.shapes.placed_shape import PlacedShape
from quasistatic_ref.simulate.header import Header
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.observer import Recording
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.contacts import friction_coefficients

TOUCHES: Final = 1e-9
"""Slack of a row of a contact that touches, at most [m]: certified steps leave rounding, 1e-16, and
a spring of 1e5 N/m presses 1e-9 m with 0.1 mN."""

SLIDES: Final = 1e-4
"""Slip of a contact that an account says slides, at least [m/s]: 1 mm in ten seconds."""

SPINS: Final = 1e-3
"""Turn about its normal of a contact that an account says spins, at least [rad/s]: 0.6 deg in ten
seconds."""

SMALL = 1e-6
"""Angle of a rotation whose axis is rounding [rad]."""


def scene_notes(recorder: Recording) -> dict[str, Any]:
    """Names and constants that the arrays of a trajectory do not hold.

    Returns
    -------
    dict
        ``pairs`` (of each its name, what alpha is and what beta is: a link, or a shape of the
        world), ``stiffness`` (the diagonal of K_q, empty where K_q has other entries) and
        ``gravity`` [m/s^2].
    """
    return {
        "gravity": [float(x) for x in recorder.simulator.gravity],
        "pairs": [sides(recorder.system, pair) for pair in recorder.simulator.pairs],
        "stiffness": stiffness(recorder.simulator.K_q).tolist(),
    }


def sides(system: System, pair: ContactPair) -> list[str]:
    """A pair's name, and the names of what touches."""
    return [pair.name, side(system, pair.alpha), side(system, pair.beta)]


def side(system: System, placed: PlacedShape) -> str:
    """The link that a shape is fixed to, its body's name if they share it; or the world's shape."""
    link = system.links[placed.link]
    body, _, link_name = link.partition("/")
    if not placed.link:
        return placed.name
    return body if link_name == body else link


def stiffness(K_q: Array) -> Array:
    """The diagonal of K_q, shape (n_a,) [N/m, N m/rad]; empty where K_q has other entries."""
    diagonal = np.diag(K_q)
    return diagonal if np.array_equal(K_q, np.diag(diagonal)) else np.zeros(0)


def account_of(trajectory: Trajectory, forces: bool = True) -> Account:
    """The account of a run.

    Parameters
    ----------
    trajectory : Trajectory
    forces : bool
        Whether to form the forces of a full record.

    Raises
    ------
    InputError
        If the file has no names of its positions or no scene, or its scene is none.
    """
    header = trajectory.header
    scene = _scene(header)
    K = np.array(scene.sequence("stiffness"), dtype=np.float64)
    joints = list(joints_of(list(header.positions), header.n_a))
    missing: list[str] = []
    pairs: list[PairAccount] = []
    drives: list[Drive] = []
    if trajectory.steps:
        motion = _motion_of_contacts(trajectory)
        if motion is None:
            missing.append(
                f"a {header.record} record has no slips, and what touches without a positive "
                "multiplier is not known"
            )
        wrench = _forces(trajectory, forces, missing)
        pairs = pair_accounts(trajectory, scene.sequence("pairs"), motion, wrench)
        drives = [drive(joint, trajectory, K) for joint in joints if joint.actuated]
    hands = [joint for joint in joints if joint.actuated and joint.free]
    motions = [_motion(joint, trajectory["q"], hands) for joint in joints if not joint.actuated]
    stops = list(_stops(trajectory, {joint.name for joint in joints}))
    t = trajectory["t"]
    h = header.h
    down = np.array(scene.sequence("gravity"), dtype=np.float64)
    down = down if down.any() else np.array([0.0, 0.0, -1.0])
    up = -down / np.linalg.norm(down)
    return Account(
        t=t,
        h=h,
        pairs=tuple(pairs),
        motions=tuple(motions),
        drives=tuple(drives),
        stops=tuple(stops),
        missing=tuple(missing),
        numbers={
            "bodies": {
                each.of.name.removesuffix("/base"): motion_numbers(each, up) for each in motions
            },
            "joints": {one.of.name: drive_numbers(one) for one in drives},
            "stops": {one.name: stop_numbers(one, h) for one in stops},
            "pairs": {one.name: pair_numbers(one, t, h) for one in pairs},
        },
    )


def _scene(header: Header) -> TableReader:
    if header.scene is None:
        problem = "has no scene: it is from before there were accounts; run it again"
        raise InputError(problem, field="scene")
    return TableReader(header.scene, "scene")


def joints_of(positions: list[str], n_a: int) -> Iterator[Joint]:
    """The bases and joints of a file, by the names of its entries of q.

    Parameters
    ----------
    positions : list of str, length n_q
        Such as ``arm/elbow [rad]`` and ``mug.z [m]``.
    n_a : int

    Raises
    ------
    InputError
        If a name is none of a base or joint.
    """
    q = 0
    v = 0
    while q < len(positions):
        joint = _first_joint(positions[q:], v < n_a)
        n_q = len(joint.positions)
        n_v = len(joint.coordinates)
        yield replace(joint, q=slice(q, q + n_q), v=slice(v, v + n_v))
        q += n_q
        v += n_v


def _first_joint(positions: list[str], actuated: bool) -> Joint:
    """The joint to which the first of some entries of q belong."""
    entry = positions[0].rpartition(" [")[0]  # a unit is the last of a heading
    owner = entry.rpartition(".")[0]
    for kind in (*BASES.values(), *JOINTS.values()):
        for name in (owner if "/" in owner else f"{owner}/base", entry):
            joint = kind(name, actuated, slice(0), slice(0))
            headings = [position.heading for position in joint.positions]
            if headings == positions[: len(headings)]:
                return joint
    raise InputError("is no entry of a base or joint", field="positions", value=positions[0])


def _turns(joint: Joint, q: Array, q_0: Array) -> Array:
    """Rotation vectors from q_0 to q, both (n, n_q), shape (n, ...) [rad]; of a slide none."""
    here = q_0[:, joint.q].tolist()
    there = q[:, joint.q].tolist()
    turns = [joint.change(*ends)[joint.lengths :] for ends in zip(here, there, strict=True)]
    return np.array(turns)


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


def pair_accounts(
    run: Trajectory,
    named: Sequence[Sequence[str]],
    motion: Array | None,
    wrench: Array | None,
) -> list[PairAccount]:
    """The accounts of the pairs of a run that has steps.

    Parameters
    ----------
    run : Trajectory
    named : sequence of sequence of str
        Of each pair its name, what alpha is and what beta is.
    motion : ndarray, shape (steps, n_c, 4), or None
        J delta_q [m, m, m, rad].
    wrench : ndarray, shape (steps, n_c, 4), or None
        Forces of single contacts [N, N m].
    """
    slots = np.array(run.pair_names)
    h = run.header.h
    touch = touching(run, motion)
    slip = None
    turn = None
    if motion is not None:
        slips = contact_slips(run, motion)
        slip = np.hypot(slips[:, :, 0], slips[:, :, 1])
        turn = np.abs(slips[:, :, 2])
    accounts = []
    for name, alpha, beta in named:
        of_pair = slots == name
        if not of_pair.any():
            continue
        on = touch[:, of_pair]
        touches = np.asarray(on.any(axis=1))
        slid = None if slip is None else _mean(slip[:, of_pair], on)
        turned = None if turn is None else _mean(turn[:, of_pair], on)
        never = np.zeros(run.steps, dtype=bool)
        accounts.append(
            PairAccount(
                name=name,
                alpha=alpha,
                beta=beta,
                table=name.partition("(")[0],
                phi=run["phi"][:, of_pair].min(axis=1),
                touches=touches,
                slip=slid,
                turn=turned,
                slides=never if slid is None else slid > SLIDES * h,
                spins=never if turned is None else turned > SPINS * h,
                loads=None if wrench is None else _loads(run, wrench[:, of_pair], of_pair),
            )
        )
    return accounts


def touching(run: Trajectory, motion: Array | None) -> Mask:
    """Which contacts touch, shape (steps, n_c): a row of theirs has no slack, which is unique.

    Of a motion J delta_q, shape (steps, n_c, 4) [m, m, m, rad]; without it those that press.
    """
    touch = _bears(run)
    if motion is None:
        return touch
    rises = run.header.law == CONVEX
    slips = slip_norm(contact_mu(run) * contact_slips(run, motion), run.header.cone)
    slack = gap_after(run["phi"], run["n"], motion) - rises * slips
    touch &= slack <= NEAR
    if cone(run.header.cone).polyhedral:
        touch |= slack <= TOUCHES
    return touch


def _mean(values: Array, on: Mask) -> Array:
    """Mean over the contacts that are on, shape (steps,); 0 where none is."""
    total = np.where(on, values, 0.0).sum(axis=1)
    return np.asarray(total / np.maximum(on.sum(axis=1), 1))


def _loads(run: Trajectory, wrench: Array, of_pair: Mask) -> Loads:
    """Sums over the contacts of a pair, of wrenches (steps, n, 4) [N, N m]."""
    normal = wrench[:, :, 2].sum(axis=1)
    needs = gauge(run.header.cone, wrench, contact_mu(run)[of_pair]).sum(axis=1)
    return Loads(
        normal=normal,
        friction=np.hypot(wrench[:, :, 0], wrench[:, :, 1]).sum(axis=1),
        torque=np.abs(wrench[:, :, 3]).sum(axis=1),
        share=np.divide(needs, normal, out=np.zeros_like(needs), where=normal > 0),
    )


def gauge(name: str, wrench: Array, mu: Array) -> Array:
    """The normal force that contacts need for their friction and torsion, shape (..., n_c) [N].

    It is the gauge of the cone's base: in the pyramid (|f_1| + |f_2|) / mu_v + |tau| / mu_omega, in
    the ellipsoid the length of these three, in other polyhedral cones the least sum of multipliers.
    Terms whose coefficient is 0 are left out.

    Parameters
    ----------
    name : str
        Of the cone.
    wrench : ndarray, shape (..., n_c, 4)
        (f_d1, f_d2, f_n, tau_n) [N, N m].
    mu : ndarray, shape (n_c, 3)
        (mu_v, mu_v, mu_omega) [-, -, m].
    """
    parts = wrench[..., [0, 1, 3]]
    needs = np.divide(parts, mu, out=np.zeros_like(parts), where=mu > 0)
    if not cone(name).polyhedral:
        return np.asarray(np.linalg.norm(needs, axis=-1))
    return np.asarray((needs @ _facets(name).T).max(axis=-1, initial=0.0))


@cache
def _facets(name: str) -> Array:
    """Of the hull of a cone's directions the facets a, shape (F, 3), where it is a . x <= 1."""
    from scipy.spatial import ConvexHull  # takes as long as a short run

    directions = cone(name).matrix[:, 1:]
    if not directions.any():
        return np.zeros((0, 3))
    equations = ConvexHull(directions).equations
    return np.asarray(equations[:, :3] / -equations[:, 3:])


def _motion_of_contacts(run: Trajectory) -> Array | None:
    """J delta_q, shape (steps, n_c, 4) [m, m, m, rad], of a record that has it."""
    if "motion" in run.arrays:
        return run["motion"]
    if "J" not in run.arrays:
        return None
    delta_q = run["delta_q"]
    if "column" in run:
        every = np.pad(delta_q, ((0, 0), (0, 1)))[:, None]
        of_columns = np.take_along_axis(every, run["column"], axis=-1)
        return np.asarray(np.einsum("kciv,kcv->kci", run["J"], of_columns))
    return np.asarray(np.einsum("kciv,kv->kci", run["J"][..., : delta_q.shape[1]], delta_q))


def _forces(run: Trajectory, wanted: bool, missing: list[str]) -> Array | None:
    if "forces" in run.arrays or (wanted and run.header.record == "full"):
        try:
            forces = run.forces
        except InputError:
            missing.append(UNKNOWN)
            return None
        without = np.flatnonzero(np.isnan(forces).any(axis=(1, 2)))
        if not without.size:
            return forces
        missing.append(f"the forces are not known in {without.size} steps, first in {without[0]}")
    elif run.header.record == "full":
        missing.append("the forces are not formed here: 'quasistatic-ref account' does that")
    else:
        missing.append("a light record holds no forces: run again with record = 'forces'")
    return None


def _bears(run: Trajectory) -> Mask:
    """Which contacts have a positive multiplier, shape (steps, n_c).

    It is positive where it is a share of the largest; of an answer without a proof multipliers are
    noise in a step in which nothing presses, and count next to a small slack only.
    """
    counts = cone(run.header.cone).counts(run["rows"])
    of_rows = np.maximum(run["lam"][:, : counts.sum()], 0.0)
    return pressing(np.maximum.reduceat(of_rows, np.cumsum(counts) - counts, axis=1))


def contact_slips(run: Trajectory, motion: Array) -> Array:
    """Slips along d1 and d2 [m], and turns of what has torsion [rad], (steps, n_c, 3).

    They are of a motion, J delta_q, shape (steps, n_c, 4) [m, m, m, rad].
    """
    d1, d2 = (np.vecdot(motion[:, :, :3], run[axis]) for axis in ("d1", "d2"))
    return np.stack([d1, d2, np.where(run["rows"] == 6, motion[:, :, 3], 0.0)], axis=2)


def contact_mu(run: Trajectory) -> Array:
    """(mu_v, mu_v, mu_omega) of contacts, which is 0 where it is not used, (n_c, 3) [-, -, m]."""
    return friction_coefficients(run["mu_v"], run["mu_omega"], run["rows"])


def _motion(joint: Joint, q: Array, hands: Sequence[Joint]) -> Motion:
    moved = np.zeros((len(q), 3))
    moved[:, : joint.lengths] = (q - q[0])[:, joint.q][:, : joint.lengths]
    turned_in = {
        hand.name.removesuffix("/base"): _angle_in(joint, hand, q) for hand in hands if joint.free
    }
    turned = _turned(_turns(joint, q, np.broadcast_to(q[0], q.shape)))
    return Motion(joint, moved, turned, turned_in)


def _angle_in(body: Joint, hand: Joint, q: Array) -> Array:
    """Angle [rad] by which a free body has turned in the frame of a free hand since the start."""
    of_body, of_hand = (Rotation.from_quat(q[:, one.q][:, one.lengths :]) for one in (body, hand))
    seen = of_hand.inv() * of_body
    return _turned((seen * seen[0].inv()).as_rotvec())


def _stops(run: Trajectory, joints: set[str]) -> Iterator[Stop]:
    """The limits that a joint came to; they are rows of an extension, by their names."""
    for i, name in enumerate(run.header.extra):
        joint, at, end = name.rpartition(" at its ")
        if at and end.endswith(" limit") and joint in joints:
            force = run["lam_extra"][:, i] / run.header.h
            if (force > 0).any():
                yield Stop(name, force)


def drive(joint: Joint, run: Trajectory, K: Array) -> Drive:
    """What an actuated joint of a run did; K is :func:`stiffness`."""
    target = run["q_bar_a"]
    n = target.shape[1]
    error = _distance(joint, run["q"][1:, :n], target)
    way = float(_distance(joint, np.broadcast_to(run["q"][0, :n], target.shape), target).max())
    scalar = joint.v.stop == joint.v.start + 1
    spring = error * K[joint.v.start] if scalar and K.size else None
    return Drive(joint, "m" if joint.lengths else "rad", error, way, spring)


def _distance(joint: Joint, q: Array, target: Array) -> Array:
    """From q to a target, both of shape (n, n_q_a) [m]; of a joint that only turns [rad]."""
    if not joint.lengths:
        return np.asarray(np.linalg.norm(_turns(joint, q, target), axis=1))
    return np.asarray(np.linalg.norm((q - target)[:, joint.q][:, : joint.lengths], axis=1))

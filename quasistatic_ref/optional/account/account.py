"""The account of a run, from its file alone: what each pair, body and joint did, and when."""

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from quasistatic_ref.certify.solution import UNKNOWN
from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.table_reader import TableReader
from quasistatic_ref.model.joints import BASES, JOINTS
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.optional.account.gauges import gauge
from quasistatic_ref.optional.account.spans import spans
from quasistatic_ref.simulate.account import (
    Account,
    Drive,
    Loads,
    Motion,
    PairAccount,
    Span,
    Stop,
)
from quasistatic_ref.simulate.trajectory import ACCOUNT, Trajectory
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.data import Array, Mask
from quasistatic_ref.tolerances import BEARS, CARRIES, NEAR, SLIDES, SPINS, TOUCHES


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
    waypoints = scene.table("waypoints")
    times = {name: tuple(waypoints.sequence(name)) for name in waypoints.names_left()}
    stiffness = np.array(scene.sequence("stiffness"), dtype=np.float64)
    every = list(joints_of(header["positions"], header["n_a"]))
    missing: list[str] = []
    pairs = pair_accounts(trajectory, forces, missing)
    free = [joint for joint in every if not joint.actuated]
    return Account(
        t=trajectory["t"],
        h=float(header["h"]),
        pairs=pairs,
        motions=tuple(_motion(joint, trajectory["q"], pairs) for joint in free),
        drives=tuple(
            _drive(joint, trajectory, stiffness, times.get(joint.name, ()))
            for joint in every
            if joint.actuated and trajectory.steps
        ),
        stops=tuple(_stops(trajectory, {joint.name: joint for joint in every})),
        missing=tuple(missing),
        findings=tuple(str(finding) for finding in trajectory.findings),
    )


def pair_accounts(
    trajectory: Trajectory, forces: bool, missing: list[str]
) -> tuple[PairAccount, ...]:
    """The accounts of the pairs of a run; errors and `forces` as of :func:`account_of`.

    Parameters
    ----------
    trajectory : Trajectory
    forces : bool
    missing : list of str
        To which what is not known is added.
    """
    scene = _scene(trajectory.header)
    if not trajectory.steps:
        return ()
    gravity = np.array(scene.sequence("gravity"), dtype=np.float64)
    return tuple(_pairs(trajectory, scene.sequence("pairs"), gravity, forces, missing))


def _scene(header: Mapping[str, object]) -> TableReader:
    if "scene" not in header or "positions" not in header:
        problem = "has no scene: it is from before there were accounts; run it again"
        raise InputError(problem, field="scene")
    return TableReader(header["scene"], "scene")


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
    entry = positions[0].partition(" [")[0]
    owner = entry.rpartition(".")[0]
    for kind in (*BASES.values(), *JOINTS.values()):
        for name in (owner if "/" in owner else f"{owner}/base", entry):
            joint = kind(name, actuated, slice(0), slice(0))
            if list(joint.positions) == positions[: len(joint.positions)]:
                return joint
    raise InputError("is no entry of a base or joint", field="positions", value=positions[0])


def _angle(joint: Joint, q: Array, q_0: Array) -> Array:
    """Angle from q_0 to q, both of shape (n, n_q) [rad]; 0 of a joint that only slides."""
    here = q_0[:, joint.q].tolist()
    there = q[:, joint.q].tolist()
    turns = [joint.change(*ends)[joint.lengths :] for ends in zip(here, there, strict=True)]
    return np.asarray(np.linalg.norm(np.array(turns), axis=1))


def _pairs(
    run: Trajectory,
    named: list[tuple[str, str, str]],
    gravity: Array,
    forces: bool,
    missing: list[str],
) -> Iterator[PairAccount]:
    up = -gravity / (np.linalg.norm(gravity) or 1.0)
    slots = np.array(run.pair_names)
    motion = _motion_of_contacts(run)
    wrench = _forces(run, forces, missing)
    if motion is None:
        missing.append(f"a {run.header['record']} record has no slips, and what touches without a "
                       "positive multiplier is not known")  # fmt: skip
    touch = _touches(run, motion)
    slip = None
    turn = None
    if motion is not None:
        turn = np.where(run["rows"] == 6, np.abs(motion[:, :, 3]), 0.0)
        across = [np.vecdot(motion[:, :, :3], run[axis]) for axis in ("d1", "d2")]
        slip = np.hypot(*across)
    for name, alpha, beta in named:
        own = slots == name
        if not own.any():
            continue
        on = touch[:, own]
        count = np.maximum(on.sum(axis=1), 1)
        loads = None
        if wrench is not None:
            normal = wrench[:, own, 2].sum(axis=1)
            friction = np.hypot(wrench[:, own, 0], wrench[:, own, 1]).sum(axis=1)
            mu_omega = np.where(run["rows"] == 6, run["mu_omega"], 0.0)[own]
            needs = gauge(run.header["cone"], wrench[:, own], run["mu_v"][own], mu_omega)
            needs = needs.sum(axis=1)
            share = np.divide(needs, normal, out=np.zeros_like(needs), where=normal > 0)
            torque = np.abs(wrench[:, own, 3]).sum(axis=1)
            ways = np.stack([run[axis][:, own] @ up for axis in ("d1", "d2", "n")], axis=2)
            loads = Loads(
                normal, friction, torque, share, np.vecdot(wrench[:, own, :3], ways).sum(axis=1)
            )
        phi = run["phi"][:, own].min(axis=1)
        touches = np.asarray(on.any(axis=1))
        slid, turned = (
            None if way is None else np.where(on, way[:, own], 0.0).sum(axis=1) / count
            for way in (slip, turn)
        )
        h = float(run.header["h"])
        yield PairAccount(
            name=name,
            alpha=alpha,
            beta=beta,
            table=name.partition("(")[0],
            phi=phi,
            touches=touches,
            slip=slid,
            turn=turned,
            loads=loads,
            near=spans(phi <= NEAR),
            contact=spans(touches),
            sliding=[] if slid is None else spans(slid > SLIDES * h),
            spinning=[] if turned is None else spans(turned > SPINS * h),
        )


def _motion_of_contacts(run: Trajectory) -> Array | None:
    """J delta_q, shape (steps, n_c, 4) [m, m, m, rad], of a record that has it."""
    if "motion" in run.arrays:
        return run["motion"]
    if "J" not in run.arrays:
        return None
    delta_q = run["delta_q"]
    return np.asarray(np.einsum("kciv,kv->kci", run["J"][..., : delta_q.shape[1]], delta_q))


def _forces(run: Trajectory, wanted: bool, missing: list[str]) -> Array | None:
    if "forces" in run.arrays or (wanted and run.header["record"] == "full"):
        try:
            return run.forces
        except InputError:
            missing.append(UNKNOWN)
    elif run.header["record"] == "full":
        missing.append("the forces are not formed here: 'quasistatic-ref account' does that")
    else:
        missing.append("a light record holds no forces: run again with record = 'forces'")
    return None


def _touches(run: Trajectory, motion: Array | None) -> Mask:
    """Which contacts have a row without slack, shape (steps, n_c)."""
    friction = cone(run.header["cone"])
    counts = friction.counts(run["rows"])
    of_rows = np.maximum(run["lam"][:, : counts.sum()], 0.0)
    most = np.maximum.reduceat(of_rows, np.cumsum(counts) - counts, axis=1)
    touches = np.asarray(most > BEARS * most.max(axis=1, initial=0.0, keepdims=True))
    if motion is None or not friction.polyhedral:
        return touches
    gap = run["phi"] + np.vecdot(motion[:, :, :3], run["n"])
    across = [run["mu_v"] * np.vecdot(motion[:, :, :3], run[axis]) for axis in ("d1", "d2")]
    spin = np.where(run["rows"] == 6, run["mu_omega"], 0.0) * motion[:, :, 3]
    slack = np.min(friction.function(gap, across[0], across[1], spin), axis=0)
    return np.asarray(touches | (slack <= TOUCHES))


def _motion(joint: Joint, q: Array, pairs: tuple[PairAccount, ...]) -> Motion:
    moved = np.zeros((len(q), 3))
    moved[:, : joint.lengths] = (q - q[0])[:, joint.q][:, : joint.lengths]
    start = np.broadcast_to(q[0], q.shape)
    body = joint.name.partition("/")[0]
    touched: dict[str, Mask] = {}
    lifted: dict[str, Array] = {}
    for pair in pairs:
        for own, other, sign in ((pair.alpha, pair.beta, -1.0), (pair.beta, pair.alpha, 1.0)):
            if own.partition("/")[0] == body != other.partition("/")[0]:
                touched[other] = touched.get(other, False) | pair.touches
                if pair.loads is not None:
                    up = np.maximum(sign * pair.loads.lift, 0.0)
                    lifted[other] = lifted.get(other, 0.0) + up
    whole = sum(lifted.values(), np.zeros(len(q) - 1))
    carries = {who: (up > 0) & (up >= CARRIES * whole) for who, up in lifted.items()}
    return Motion(joint, moved, _angle(joint, q, start), _spans(touched), _spans(carries))


def _spans(held: Mapping[str, Mask]) -> dict[str, list[Span]]:
    """When each holds; what never does is left out."""
    return {who: found for who, holds in held.items() if (found := spans(holds))}


def _stops(run: Trajectory, joints: Mapping[str, Joint]) -> Iterator[Stop]:
    """The limits that a joint came to; they are rows of an extension, by their names."""
    for i, name in enumerate(run.header["extra"]):
        joint, at, end = name.partition(" at its ")
        if at and end.endswith(" limit") and joint in joints:
            force = run["lam_extra"][:, i] / float(run.header["h"])
            if (force > 0).any():
                unit = "N" if joints[joint].lengths else "N m"
                yield Stop(name, unit, force, spans(force > BEARS * force.max()))


def _drive(joint: Joint, run: Trajectory, stiffness: Array, waypoints: tuple[float, ...]) -> Drive:
    target = run["q_bar_a"]
    q = run["q"][1:, : target.shape[1]]
    away = np.linalg.norm((q - target)[:, joint.q][:, : joint.lengths], axis=1)
    error = away if joint.lengths else _angle(joint, q, target)
    scalar = joint.v.stop == joint.v.start + 1
    spring = error * stiffness[joint.v.start] if scalar and stiffness.size else None
    return Drive(joint, "m" if joint.lengths else "rad", error, spring, waypoints)


ACCOUNT.fill(account_of)

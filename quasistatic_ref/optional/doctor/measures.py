"""What each pair, body and joint did in a run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.model.system import System
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.numbers.ordered import dot
from quasistatic_ref.optional.doctor.tolerances import BEARS, NEAR
from quasistatic_ref.optional.friction import slip_norm
from quasistatic_ref.shapes.placed_shape import PlacedShape
from quasistatic_ref.simulate.law import CONVEX
from quasistatic_ref.simulate.trajectory import Trajectory
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.contacts import friction_coefficients
from quasistatic_ref.text.plain import Plain
from quasistatic_ref.tolerances import FILLED

if TYPE_CHECKING:
    from quasistatic_ref.simulate.settings import Settings

TOUCHES: Final = 1e-9
"""Slack of a row of a contact that touches, at most [m]: certified steps leave rounding, 1e-16, and
a spring of 1e5 N/m presses 1e-9 m with 0.1 mN."""

SLIDES: Final = 1e-4
"""Slip of a pair that slides, at least [m/s]: 1 mm in ten seconds."""

SPINS: Final = 1e-3
"""Turn about its normal of a pair that spins, at least [rad/s]: 0.6 deg in ten
seconds."""

ROUNDINGS: Final = 16
"""How many roundings a number of one step may have, to float64's last bit; each step has one."""

SMALL = 1e-6
"""Angle of a rotation whose axis is rounding [rad]."""


@dataclass(frozen=True, eq=False)
class PairMeasures(Plain):
    """Measures of one pair of shapes in a run: touching, sliding and spinning.

    Parameters
    ----------
    name : str
    table : str
        The table of contacts that it is of.
    phi : ndarray, shape (steps,)
        Least distance where a step starts [m].
    touches : ndarray of bool, shape (steps,)
        Whether a contact has a row without slack: phi + n'J delta_q is then the least that its slip
        allows, which is unique. Without J, only what has a positive multiplier is known to touch.
    slip : ndarray, shape (steps,), or None
        Mean slip of the contacts that touch [m]; None where the record has no J.
    turn : ndarray, shape (steps,), or None
        Mean turn about the normals of the contacts that touch [rad], likewise.
    slides, spins : ndarray of bool, shape (steps,)
        Whether these are fast; never where they are not known.
    """

    name: str
    table: str
    phi: Array
    touches: Mask
    slip: Array | None
    turn: Array | None
    slides: Mask
    spins: Mask


@dataclass(frozen=True, eq=False)
class Motion(Plain):
    """The motion of an undriven body, or of one of its joints.

    Parameters
    ----------
    of : Joint
    moved : ndarray, shape (steps + 1, 3)
        From the start, along the world's axes [m]; of a prismatic joint its position, along x.
    turned : ndarray, shape (steps + 1,)
        From the start, whole turns counted [rad].
    turned_in : dict of str to ndarray, shape (steps + 1,)
        The same of a free body as each driven base that moves freely sees it, such as a hand [rad].
    """

    of: Joint
    moved: Array
    turned: Array
    turned_in: dict[str, Array]


@dataclass(frozen=True, eq=False)
class Drive(Plain):
    """Measures of an actuated joint or base in a run: error, way and spring force.

    Parameters
    ----------
    of : Joint
    unit : str
        Of its error, ``"m"`` or ``"rad"``.
    error : ndarray, shape (steps,)
        Distance from its target at the end of each step [m], of a joint that turns [rad].
    way : float
        How far its target goes from where it starts, at most [m], of a joint that turns [rad].
    spring : ndarray, shape (steps,), or None
        Force of its spring where a step ends, K_q times that [N, N m]; None of a base, and where
        K_q is not diagonal.
    """

    of: Joint
    unit: str
    error: Array
    way: float
    spring: Array | None


@dataclass(frozen=True)
class Rounding:
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

    def length(self, x: ArrayLike) -> Array:
        """Lengths [m] of any shape, 0 where they are rounding."""
        return np.where(np.abs(x) > self.m, x, 0.0)

    def angle(self, x: ArrayLike) -> Array:
        """Angles [rad] of any shape, 0 where they are rounding."""
        return np.where(np.abs(x) > self.rad, x, 0.0)


@dataclass(frozen=True, eq=False)
class Measures(Plain):
    """Measures of all pairs, bodies and joints in a run.

    Parameters
    ----------
    pairs : tuple of PairMeasures
    motions : tuple of Motion
        Of what nothing drives.
    drives : tuple of Drive
    rounding : Rounding
    """

    pairs: tuple[PairMeasures, ...]
    motions: tuple[Motion, ...]
    drives: tuple[Drive, ...]
    rounding: Rounding


def measures(trajectory: Trajectory, settings: Settings) -> Measures:
    """Measures of a run, from its trajectory and the settings of its scenario."""
    system = settings.system
    joints = system.joints
    hands = [joint for joint in joints if joint.actuated and joint.free]
    K = stiffness(settings.K_q)
    driven = [joint for joint in joints if joint.actuated and trajectory.steps]
    return Measures(
        pairs=tuple(pair_measures(trajectory) if trajectory.steps else ()),
        motions=tuple(
            _motion(joint, trajectory["q"], hands) for joint in joints if not joint.actuated
        ),
        drives=tuple(drive(joint, trajectory, K) for joint in driven),
        rounding=rounding_of(trajectory, joints),
    )


def rounding_of(run: Trajectory, joints: Sequence[Joint]) -> Rounding:
    """The rounding of a run, from its size in space and its number of steps."""
    places = [run["q"][:, joint.q][:, : joint.lengths].ravel() for joint in joints]
    if "alpha" in run.arrays:
        places.append(run["alpha"][run["phi"] < FILLED].ravel())
    farthest = max((float(np.abs(place).max(initial=0.0)) for place in places), default=0.0)
    share = (ROUNDINGS + run.steps) * np.finfo(np.float64).eps
    return Rounding(m=share * farthest, rad=float(share))


def side(system: System, placed: PlacedShape) -> str:
    """The name of the link that carries a shape, or of its body, or of the world's shape."""
    link = system.links[placed.link]
    body, _, link_name = link.partition("/")
    if not placed.link:
        return placed.name
    return body if link_name == body else link


def stiffness(K_q: Array) -> Array:
    """The diagonal of K_q, shape (n_a,) [N/m, N m/rad]; empty where K_q has other entries."""
    diagonal = np.diag(K_q)
    return diagonal if np.array_equal(K_q, np.diag(diagonal)) else np.zeros(0)


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


def pair_measures(run: Trajectory, motion: Array | None = None) -> list[PairMeasures]:
    """Touching, sliding and spinning of each pair, in a run that has steps.

    Parameters
    ----------
    run : Trajectory
    motion : ndarray, shape (steps, n_c, 4), optional
        J delta_q [m, m, m, rad], where it is known; by default that of a record that has it.
    """
    motion = _motion_of_contacts(run) if motion is None else motion
    slots = np.array(run.pair_names)
    h = run.header.h
    touch = touching(run, motion)
    slip = None
    turn = None
    if motion is not None:
        slips = contact_slips(run, motion)
        slip = np.hypot(slips[:, :, 0], slips[:, :, 1])
        turn = np.abs(slips[:, :, 2])
    never = np.zeros(run.steps, dtype=bool)
    pairs = []
    for name in dict.fromkeys(run.pair_names):
        of_pair = slots == name
        on = touch[:, of_pair]
        slid = None if slip is None else _mean(slip[:, of_pair], on)
        turned = None if turn is None else _mean(turn[:, of_pair], on)
        pairs.append(
            PairMeasures(
                name=name,
                table=name.partition("(")[0],
                phi=run["phi"][:, of_pair].min(axis=1),
                touches=np.asarray(on.any(axis=1)),
                slip=slid,
                turn=turned,
                slides=never if slid is None else slid > SLIDES * h,
                spins=never if turned is None else turned > SPINS * h,
            )
        )
    return pairs


def _motion_of_contacts(run: Trajectory) -> Array | None:
    """Motions J delta_q of contacts, shape (steps, n_c, 4) [m, m, m, rad], if recorded."""
    if "motion" in run.arrays:
        return run["motion"]
    if "J" not in run.arrays:
        return None
    delta_q = run["delta_q"]
    return np.asarray(np.einsum("kciv,kv->kci", run["J"][..., : delta_q.shape[1]], delta_q))


def touching(run: Trajectory, motion: Array | None) -> Mask:
    """Mask of the contacts that touch, shape (steps, n_c): one of their rows has no slack.

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
    """Coefficients (mu_v, mu_v, mu_omega) of contacts, 0 where unused, (n_c, 3) [-, -, m]."""
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
    from scipy.spatial.transform import Rotation  # takes as long as a short run

    of_body, of_hand = (Rotation.from_quat(q[:, one.q][:, one.lengths :]) for one in (body, hand))
    seen = of_hand.inv() * of_body
    return _turned((seen * seen[0].inv()).as_rotvec())


def drive(joint: Joint, run: Trajectory, K: Array) -> Drive:
    """Error, way and spring force of an actuated joint in a run; K is :func:`stiffness`."""
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


def pressing(normal: Array) -> Mask:
    """Whether each contact's force is more than rounding, shape (..., n_c), as `normal`.

    Parameters
    ----------
    normal : ndarray, shape (..., n_c)
        Normal forces [N].
    """
    return np.asarray(normal > BEARS * normal.max(axis=-1, initial=0.0, keepdims=True))


def gap_after(phi: Array, n: Array, motion: Array) -> Array:
    """Gap phi + n'J delta_q [m] of each contact after its step, to first order, (steps, n_c).

    Parameters
    ----------
    phi, n : ndarray, shapes (steps, n_c) and (steps, n_c, 3)
        The distance [m], which Coulomb's law raises in the step, and the normal.
    motion : ndarray, shape (steps, n_c, 4)
        J delta_q [m, rad]: private rises are not in the gap.
    """
    return phi + dot(n, motion[:, :, :3])

"""What happened in a run, as ``optional/account`` finds it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.step.data import Array, Mask


class Span(NamedTuple):
    """Steps in a row.

    Parameters
    ----------
    first, last : int
    """

    first: int
    last: int


class Loads(NamedTuple):
    """Sums over the contacts of a pair.

    Parameters
    ----------
    normal : ndarray, shape (steps,)
        Of f_n [N].
    friction : ndarray, shape (steps,)
        Of the lengths of (f_d1, f_d2) [N].
    torque : ndarray, shape (steps,)
        Of the sizes of tau_n [N m].
    share : ndarray, shape (steps,)
        Normal force that the cone needs for their friction and torsion, over what there is [-]; 0
        where that is 0.
    lift : ndarray, shape (steps,)
        Of the parts of the forces on beta that are opposite to gravity [N].
    """

    normal: Array
    friction: Array
    torque: Array
    share: Array
    lift: Array


@dataclass(frozen=True, eq=False)
class PairAccount(Plain):
    """What two shapes did.

    Parameters
    ----------
    name, alpha, beta : str
        Its name, and what touches.
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
    loads : Loads or None
        None where the forces are not known.
    near, contact, sliding, spinning : list of Span
        When its shapes were near, when it touched, when it slid, and when it turned about a normal.
    """

    name: str
    alpha: str
    beta: str
    table: str
    phi: Array
    touches: Mask
    slip: Array | None
    turn: Array | None
    loads: Loads | None
    near: list[Span]
    contact: list[Span]
    sliding: list[Span]
    spinning: list[Span]


@dataclass(frozen=True, eq=False)
class Motion(Plain):
    """How a body that nothing drives moved, or a joint of it.

    Parameters
    ----------
    of : Joint
    moved : ndarray, shape (steps + 1, 3)
        From the start, along the world's axes [m]; of a prismatic joint its position, along x.
    turned : ndarray, shape (steps + 1,)
        From the start [rad].
    touched, carried : mapping of str to list of Span
        By what it touched, while it did; by what lifted it, while that was at least a `CARRIES` of
        all that lifted it. Nothing where the forces are not known, or without gravity.
    """

    of: Joint
    moved: Array
    turned: Array
    touched: Mapping[str, list[Span]]
    carried: Mapping[str, list[Span]]


@dataclass(frozen=True, eq=False)
class Drive(Plain):
    """What an actuated joint or base did.

    Parameters
    ----------
    of : Joint
    unit : str
        Of its error, ``"m"`` or ``"rad"``.
    error : ndarray, shape (steps,)
        Distance from its target at the end of each step [m], of a joint that turns [rad].
    spring : ndarray, shape (steps,), or None
        Force of its spring where a step ends, K_q times that [N, N m]; None of a base, and where
        K_q is not diagonal.
    waypoints : tuple of float
        Times [s].
    """

    of: Joint
    unit: str
    error: Array
    spring: Array | None
    waypoints: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class Stop(Plain):
    """A joint at one of its limits, with ``joint_limits = "urdf"``.

    Parameters
    ----------
    name : str
        Such as ``door/hinge at its upper limit``.
    unit : str
        Of its force, ``"N"`` or ``"N m"``.
    force : ndarray, shape (steps,)
        lam / h of its row [N, N m].
    bears : list of Span
        When it bore load.
    """

    name: str
    unit: str
    force: Array
    bears: list[Span]


@dataclass(frozen=True, eq=False)
class Account(Plain):
    """What happened in a run.

    Parameters
    ----------
    t : ndarray, shape (steps,)
        End of each step [s].
    h : float
    pairs : tuple of PairAccount
    motions : tuple of Motion
    drives : tuple of Drive
    stops : tuple of Stop
    missing : tuple of str
        What the record does not hold, in sentences.
    findings : tuple of str
    """

    t: Array
    h: float
    pairs: tuple[PairAccount, ...]
    motions: tuple[Motion, ...]
    drives: tuple[Drive, ...]
    stops: tuple[Stop, ...]
    missing: tuple[str, ...]
    findings: tuple[str, ...]

"""What happened in a run: numbers over time, and a table of the most telling ones."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

from quasistatic_ref.formats.plain import Plain
from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.numbers.arrays import Array, Mask
from quasistatic_ref.parts import needed_package

if TYPE_CHECKING:
    from pandas import DataFrame


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
    """

    normal: Array
    friction: Array
    torque: Array
    share: Array


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
    slides, spins : ndarray of bool, shape (steps,)
        Whether these are fast; never where they are not known.
    loads : Loads or None
        None where the forces are not known.
    """

    name: str
    alpha: str
    beta: str
    table: str
    phi: Array
    touches: Mask
    slip: Array | None
    turn: Array | None
    slides: Mask
    spins: Mask
    loads: Loads | None


@dataclass(frozen=True, eq=False)
class Motion(Plain):
    """How a body that nothing drives moved, or a joint of it.

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
    """What an actuated joint or base did.

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


@dataclass(frozen=True, eq=False)
class Stop(Plain):
    """A joint at one of its limits, with ``joint_limits = "urdf"``.

    Parameters
    ----------
    name : str
        Such as ``door/hinge at its upper limit``.
    force : ndarray, shape (steps,)
        lam / h of its row [N, N m].
    """

    name: str
    force: Array


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
    numbers : dict of str to dict of str to dict of str to float
        The table: of each kind (``"bodies"``, ``"joints"``, ``"stops"``, ``"pairs"``) what was
        measured of each of its names [any unit], by words that end in their unit. Where something
        is not known its word is missing.
    """

    t: Array
    h: float
    pairs: tuple[PairAccount, ...]
    motions: tuple[Motion, ...]
    drives: tuple[Drive, ...]
    stops: tuple[Stop, ...]
    missing: tuple[str, ...]
    numbers: Mapping[str, Mapping[str, Mapping[str, float]]]

    def to_pandas(self) -> DataFrame:
        """The table as a frame: a row a kind and name, a column a number.

        Raises
        ------
        InputError
            If pandas is not installed.
        """
        pandas = needed_package("pandas", "pandas", "a table")
        rows = [
            {"kind": kind, "name": name, **numbers}
            for kind, names in self.numbers.items()
            for name, numbers in names.items()
        ]
        return pandas.DataFrame(rows).set_index(["kind", "name"])

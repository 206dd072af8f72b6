"""The measured pushes that come with the package: objects on surfaces, loads, and motions."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.folders import reality_folder
from quasistatic_ref.lab.reality.outline import Outline
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.quoting import suggestion
from quasistatic_ref.text.content import json_read


@dataclass(frozen=True, eq=False)
class Pair:
    """An object on a surface.

    Parameters
    ----------
    name : str
        surface/shape.
    outline : Outline
    mu_finger : float
        The friction of the finger [-].
    published : float
        mu_omega / mu_v of the published ellipsoid w' A w = 1 [m], rho sqrt((A11 + A22) / (2 A33)):
        its twist (v, rho omega) lies along A w of the load w = (f, tau / rho), and A11 and A22
        differ by little.
    """

    name: str
    outline: Outline
    mu_finger: float
    published: float


@dataclass(frozen=True, eq=False)
class Loads:
    """Loads on an object and the motions that they caused, about its centre of mass.

    Parameters
    ----------
    wrench : ndarray, shape (n, 3)
        Force [N] and torque [N m].
    twist : ndarray, shape (n, 3)
        Velocity and turn, up to their length [m, rad].
    """

    wrench: Array
    twist: Array

    def about(self, centre: Array) -> "Loads":
        """The same loads and motions about a `centre`, shape (2,) [m]."""
        wrench = self.wrench.copy()
        twist = self.twist.copy()
        x, y = centre
        wrench[:, 2] -= x * wrench[:, 1] - y * wrench[:, 0]
        twist[:, 0] -= y * twist[:, 2]
        twist[:, 1] += x * twist[:, 2]
        return Loads(wrench, twist)


@dataclass(frozen=True, eq=False)
class Pushes:
    """The pushes of a pair: what is predicted, and never used to identify anything.

    Parameters
    ----------
    before, after : ndarray, shape (n, 3)
        Poses of the object's frame: x, y [m], angle [rad].
    path : ndarray, shape (n, 2, 2)
        Start and end of the finger's centre [m].
    published : ndarray, shape (n, 3)
        Poses after, by a published simulator [m, rad].
    """

    before: Array
    after: Array
    path: Array
    published: Array

    def every(self, step: int) -> "Pushes":
        """Every so manyth push, from the first."""
        return Pushes(*(rows[::step] for rows in vars(self).values()))


def pairs_read(only: Sequence[str] = ()) -> list[Pair]:
    """The pairs, perhaps only some.

    Raises
    ------
    InputError
        If there is no pair of a name.
    """
    shapes = json_read(reality_folder() / "shapes.json")
    pairs = {}
    for row in _table("patches"):
        name = f"{row['surface']}/{row['shape']}"
        published = row["rho"] * np.sqrt((row["A11"] + row["A22"]) / (2 * row["A33"]))
        outline = Outline(np.array(shapes[row["shape"]]))
        pairs[name] = Pair(name, outline, float(row["mu_pusher_used"]), float(published))
    for name in only:
        if name not in pairs:
            raise InputError(f"is not a pair{suggestion(name, pairs)}", field="--sets", value=name)
    return [pair for name, pair in pairs.items() if not only or name in only]


def loads_read(pairs: Sequence[Pair]) -> dict[str, Loads]:
    """The loads of each pair about the centre of its outline; loads without motion are left out.

    The name of a pair -> its loads.
    """
    loads = {}
    for pair, rows in _rows_of(pairs, "loads"):
        wrench = _columns(rows, "f_x", "f_y", "tau")
        twist = _columns(rows, "v_x", "v_y", "omega")
        moving = np.linalg.norm(twist, axis=1) * np.linalg.norm(wrench, axis=1) > 0
        loads[pair.name] = Loads(wrench[moving], twist[moving]).about(pair.outline.centre)
    return loads


def pushes_read(pairs: Sequence[Pair]) -> dict[str, Pushes]:
    """The pushes of each pair by the pair's name, in the order of their numbers."""
    return {
        pair.name: Pushes(
            _columns(rows, "x0", "y0", "theta0"),
            _columns(rows, "x1", "y1", "theta1"),
            _columns(rows, "tip_x0", "tip_y0", "tip_x1", "tip_y1").reshape(-1, 2, 2),
            _columns(rows, "lcp_x1", "lcp_y1", "lcp_theta1"),
        )
        for pair, rows in _rows_of(pairs, "pushes")
    }


def _table(name: str) -> NDArray[np.void]:
    """A file of measurements, shape (rows,): numbers and words by the names of their columns."""
    path = reality_folder() / f"{name}.csv"
    return np.genfromtxt(path, delimiter=",", names=True, dtype=None, encoding="utf-8")


def _rows_of(pairs: Sequence[Pair], name: str) -> list[tuple[Pair, NDArray[np.void]]]:
    table = _table(name)
    names = np.char.add(np.char.add(table["surface"], "/"), table["shape"])
    return [(pair, table[names == pair.name]) for pair in pairs]


def _columns(rows: NDArray[np.void], *names: str) -> Array:
    return np.column_stack([rows[name] for name in names])

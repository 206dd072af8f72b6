"""The contacts of a simulator's steps as the structure of scene.h: J, A, b and the load."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.contact.jacobian import ContactGeometry
from quasistatic_ref.optional.fast.compiled.poses import Poses
from quasistatic_ref.optional.fast.compiled.structure import Structure
from quasistatic_ref.optional.fast.posed import Constants
from quasistatic_ref.step.cones import cone, cone_function, cone_matrix
from quasistatic_ref.step.data import Array, Indices


@dataclass(frozen=True, eq=False)
class Columns:
    """The columns of joints that move contacts, and where each belongs in J.

    Parameters
    ----------
    joint_column, place : ndarray of int, shape (n_c or 1, n_x)
        Columns of pinocchio's Jacobian, and those of the contact's J to which they are added; one
        row where they are those of all contacts.
    alpha, beta : ndarray, shape (n_c, n_x)
        1.0 where the column moves alpha's or beta's body, else 0.0.
    kept : int
        Columns of a contact's J.
    """

    joint_column: Indices
    place: Indices
    alpha: Array
    beta: Array
    kept: int


def every_column(geometry: ContactGeometry) -> Columns:
    """All columns, for a dense J."""
    owner = geometry.column_map.owner
    alpha, beta = geometry.moves[:, :, 0]
    return Columns(np.arange(len(owner))[None], owner[None], alpha, beta, geometry.column_map.n_v)


class Scene(Structure):
    """``Scene`` of scene.h.

    Parameters
    ----------
    poses : Poses
        Where pinocchio writes the poses of the links.
    columns : Columns
    constant : Constants
    mu : ndarray, shape (n_c, 3)
        Friction of the contacts, as in :class:`~quasistatic_ref.step.contacts.Contacts` [-, m].
    weighs : ndarray, shape (n_v,)
        1.0 for each coordinate that feels gravity, else 0.0 [-].

    Attributes
    ----------
    points : ClosestPoints
        From which the contacts are made: to be written first.
    given : dtype
        Of what C writes of a step.
    written : ndarray of uint8
        Its bytes.
    """

    def __init__(
        self,
        poses: Poses,
        columns: Columns,
        constant: Constants,
        mu: Array,
        weighs: Array,
    ) -> None:
        layout = constant.row_layout
        rows = layout.counts
        friction_cone = cone(constant.cone)
        if not friction_cone.polyhedral:
            rows = np.zeros_like(rows)
        n_c = len(rows)
        m = int(rows.sum())
        n_a = len(constant.K_q)
        n_v = poses.column_map.n_v
        n_x = columns.alpha.shape[1]
        kept = columns.kept
        super().__init__("scene.h", "Scene")
        self.given = given = np.dtype(
            [
                *((name, np.int64, (n_c,)) for name in ("point", "tie")),
                ("phi", np.float64, (n_c,)),
                *((name, np.float64, (n_c, 3)) for name in ("n", "alpha", "beta", "d1", "d2")),
                ("J", np.float64, (n_c, 4, kept)), ("tau", np.float64, (n_v,)),
                ("g", np.float64, (n_v,)),
            ]
        )  # fmt: skip
        self.written = np.zeros(given.itemsize, np.uint8)
        written = np.ndarray((), given, self.written)
        terms = cone_terms(constant.cone) if friction_cone.polyhedral else {}
        self.put(
            {
                "n_c": n_c, "n_v": n_v, "n_a": n_a, "kept": kept, "moving": n_x,
                "same": int(len(columns.place) != n_c or n_c == 1),
                "links": len(poses.R), "t": poses.t, "column": poses.columns,
                "joint_column": columns.joint_column, "place": columns.place,
                "moves_alpha": columns.alpha, "moves_beta": columns.beta,
                "mu_v": mu[:, 0], "mu_omega": mu[:, 2], "rows": rows,
                **terms, **{name: written[name] for name in given.names or ()},
                "A": np.zeros((m, kept)), "b": np.zeros(m), "work": np.zeros(14 * n_x + 4 * kept),
                "h": np.array([constant.h]), "weighs": weighs, "gravity": poses.gravity,
                "force": np.zeros(n_v), "K_q": constant.K_q, "delta_q_bar_a": np.zeros(n_a),
            },
        )  # fmt: skip
        self.points = ClosestPoints._make(self[name] for name in ClosestPoints._fields)

    def taken(self) -> NDArray[np.void]:
        """What C has written of a step, of shape (): its arrays by their names."""
        # A copy of the bytes is read-only; copying field by field takes ten times as long.
        return np.ndarray((), self.given, self.written.tobytes())


def cone_terms(name: str) -> dict[str, Array | Indices]:
    """Coefficients of slip_1, slip_2 and spin in a cone's rows [-], and which terms exist; (R, 3).

    A term with coefficient zero differs from no term: it can change the sign of a zero.
    """
    of_nan = cone_function(name)(0.0, *np.where(np.eye(3) > 0, np.nan, 0.0))
    has = np.isnan(np.array([np.broadcast_to(row, 3) for row in of_nan]))
    return {"coefficient": cone_matrix(name)[:, 1:], "has": has.astype(np.int64)}

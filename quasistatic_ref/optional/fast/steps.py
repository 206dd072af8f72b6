"""The data of a simulator's steps, formed in C: right by construction, and not checked again."""

from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.certify.groups import parted
from quasistatic_ref.contact.distance import ClosestPoints
from quasistatic_ref.numbers.arrays import Array, Indices, read_only
from quasistatic_ref.numbers.pivots import positive_definite
from quasistatic_ref.optional.compiled.library import Structure, library
from quasistatic_ref.optional.fast.closest import Closest
from quasistatic_ref.optional.fast.joined import JoinedContacts, JoinedStep, Masses
from quasistatic_ref.optional.fast.poses import Poses
from quasistatic_ref.optional.friction import cone_matrix
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.cones import cone
from quasistatic_ref.step.contacts import friction_coefficients
from quasistatic_ref.step.data import no_rows, row_layout

FRAMES = ("d1", "d2", "J", "tau", "g")
"""What C writes of a step, beside its closest points."""
CLOSEST = itemgetter(*ClosestPoints._fields)


class Columns:
    """The columns of J that can differ from zero, of each contact.

    Parameters
    ----------
    simulator : Simulator

    Attributes
    ----------
    column : ndarray of int, shape (n_c, most)
        Which these are, ascending; n_v where a contact has fewer.
    fields : dict
        Of ``Rows`` of fast.h.
    """

    def __init__(self, simulator: Simulator) -> None:
        layout = simulator.layout
        column_map = simulator.system.column_map
        moves = column_map.moves[:, 0]
        of_link = [np.flatnonzero(one) for one in moves]
        both = zip(layout.link_alpha.tolist(), layout.link_beta.tolist(), strict=True)
        joints = [np.union1d(of_link[a], of_link[b]) for a, b in both]
        n_c = len(joints)
        counts = np.array(list(map(len, joints)), np.int64)
        self.most = int(counts.max(initial=1))
        joint = np.zeros((n_c, self.most), np.int64)
        of_joint = np.zeros((n_c, self.most), np.int64)
        self.column = np.full((n_c, self.most), simulator.system.n_v)
        for c, of_contact in enumerate(joints):
            count = len(of_contact)
            joint[c, :count] = of_contact
            every, of_joint[c, :count] = np.unique(
                column_map.owner[of_contact], return_inverse=True
            )
            self.column[c, : len(every)] = every
        self.fields: dict[str, int | NDArray[Any]] = {
            "most_joints": self.most,
            "joints": counts,
            "joint": joint,
            "coordinate": of_joint,
            "moves_alpha": moves[layout.link_alpha[:, None], joint],
            "moves_beta": moves[layout.link_beta[:, None], joint],
        }


def cone_terms(name: str) -> dict[str, Array | Indices]:
    """Coefficients of slip_1, slip_2 and spin in a cone's rows [-], and which terms exist; (R, 3).

    A term with coefficient zero differs from no term: it can change the sign of a zero.
    """
    of_nan = cone(name).function(0.0, *np.where(np.eye(3) > 0, np.nan, 0.0))
    has = np.isnan(np.array([np.broadcast_to(row, 3) for row in of_nan]))
    return {"coefficient": cone_matrix(name)[:, 1:], "has": has.astype(np.int64)}


class Steps:
    """The steps of a simulator, one after the other.

    Parameters
    ----------
    simulator : Simulator
    poses : Poses
        From which a step is formed.

    Attributes
    ----------
    template : JoinedStep
        A step of that kind, whose J has 1.0 where it can differ from zero.
    groups : tuple of Group
        Those of its steps.
    column : ndarray of int, shape (n_c, w)
        The columns that J and A have, as of :class:`Columns`.
    masses : Masses
        Those of the last step.
    rows : Structure
        ``Rows`` of fast.h; what C writes is overwritten by the next step.
    """

    def __init__(self, simulator: Simulator, poses: Poses) -> None:
        system = simulator.system
        layout = simulator.layout
        n_a = system.n_a
        n_v = system.n_v
        n_c = len(layout.rows)
        self._poses = poses
        self._layout = layout
        self._mass = system.varying_mass
        self._gravity = tuple(simulator.gravity.tolist())
        self._polyhedral = cone(simulator.cone).polyhedral
        constant = system.constant_mass_matrix
        blocks = system.mass_blocks if constant else system.M_u(system.q_start)
        blocks = positive_definite("M_u", blocks + 0.0)
        rows = row_layout(simulator.cone, layout.rows.tobytes())
        self.masses = Masses(simulator.h, simulator.K_q, blocks)
        self._of_all: dict[str, object] = {
            "h": simulator.h,
            "cone": simulator.cone,
            "K_q": simulator.K_q,
            "extra": no_rows(n_v),
            "row_layout": rows,
        }
        columns = Columns(simulator)
        mu = friction_coefficients(layout.mu_v, layout.mu_omega, layout.rows)
        self._of_contacts = {
            "mu_v": layout.mu_v,
            "mu_omega": layout.mu_omega,
            "rows": layout.rows,
            "mu": mu,
            "column": columns.column,
            "n_v": n_v,
        }
        self._dtype = np.dtype(
            [
                *((name, np.int64, (n_c,)) for name in ("point", "tie")),
                ("phi", np.float64, (n_c,)),
                *((name, np.float64, (n_c, 3)) for name in ("n", "alpha", "beta", "d1", "d2")),
                ("J", np.float64, (n_c, 4, columns.most)),
                ("tau", np.float64, (n_v,)),
                ("g", np.float64, (n_v,)),
            ]
        )
        self._bytes = np.zeros(self._dtype.itemsize, np.uint8)
        self._written = written = np.ndarray((), self._dtype, self._bytes)
        self._closest = Closest(
            simulator.pairs,
            poses,
            ClosestPoints._make(written[name] for name in ClosestPoints._fields),
        )
        counts = rows.counts if self._polyhedral else np.zeros(n_c, np.int64)
        m = int(counts.sum())
        self.rows = Structure(
            "Rows",
            {
                "n_c": n_c, "n_v": n_v, "n_a": n_a, **columns.fields,
                "column": poses.columns, "gravity": poses.gravity,
                "rows": counts, "mu_v": mu[:, 0], "mu_omega": mu[:, 2],
                **(cone_terms(simulator.cone) if self._polyhedral else {}),
                "h": np.array([simulator.h]),
                "weighs": np.append(simulator.gravity_acts, np.ones(n_v - n_a)),
                "force": np.zeros(n_v), "K_q": simulator.K_q, "delta_q_bar_a": np.zeros(n_a),
                **{name: written[name] for name in ("phi", "n", "alpha", "beta", *FRAMES)},
                "work": np.zeros(23 * columns.most), "A": np.zeros((m, columns.most)),
                "b": np.zeros(m),
            },
        )  # fmt: skip
        self._names: tuple[list[int], tuple[str, ...]] = [], ()
        self.column = columns.column
        of_mass = blocks != 0
        if self._mass is not None:
            of_mass.flat[self._mass.entry] = True
        *block, i, j = np.nonzero(of_mass)
        first = n_a + (6 * block[0] if block else 0)
        c, k = np.nonzero(self.column < n_v)
        of_K = np.nonzero(simulator.K_q)
        coupling = np.concatenate([c, n_c + of_K[0], n_c + first + i])
        coordinate = np.concatenate([self.column[c, k], of_K[1], first + j])
        shape = n_c + n_v, n_v
        self.groups = parted(coupling, coordinate, shape, rows.counts)
        there = np.where(self.column[:, None] < n_v, np.ones((4, 1)), 0.0)
        self.template = self._step(self._names_of([0] * n_c), written, np.zeros(n_a), there)

    def closest(self) -> None:
        """Write the closest points at the poses; ContactError as of ``closest_points``."""
        self._closest.write()

    def form(self, change: Array, force: Array) -> tuple[JoinedStep, ClosestPoints]:
        """The step from the poses and their closest points.

        Parameters
        ----------
        change : ndarray, shape (n_a,)
            delta_q_bar_a [m, rad].
        force : ndarray, shape (n_v,)
            In addition to gravity [N, N m].

        Raises
        ------
        StepDataError
            If M_u is not positive definite.
        """
        compiled = library()
        self.rows["force"][:] = force
        self.rows["delta_q_bar_a"][:] = change
        self._poses.weigh(self._gravity)
        compiled.contact_rows(self.rows.pointer)
        compiled.load(self.rows.pointer)
        if self._mass is not None:
            self._with_mass(self._mass.at(self._poses.kinematics()))
        # A copy of the bytes is read-only; copying field by field takes ten times as long.
        written = np.ndarray((), self._dtype, self._bytes.tobytes())
        points = ClosestPoints(*CLOSEST(written))
        names = self._names_of(points.point.tolist())
        return self._step(names, written, read_only(change), written["J"]), points

    def at(self, points: ClosestPoints, change: Array, tau: Array) -> JoinedStep:
        """The step from the poses, closest points at them, and all forces.

        Parameters
        ----------
        points : ClosestPoints
        change : ndarray, shape (n_a,)
            delta_q_bar_a [m, rad].
        tau : ndarray, shape (n_v,)
            With gravity, without springs [N, N m].

        Raises
        ------
        StepDataError
            As of :meth:`form`.
        """
        for name, values in points._asdict().items():
            self._written[name][...] = values
        step, _ = self.form(change, np.zeros_like(tau))
        n_a = len(change)
        loads = {"tau_a": read_only(tau[:n_a] + 0.0), "tau_u": read_only(tau[n_a:] + 0.0)}
        under: JoinedStep = step.with_fields(**loads)
        return under

    def _names_of(self, point: list[int]) -> tuple[str, ...]:
        names = self._names
        if point != names[0]:
            self._names = names = point, self._layout.contact_names(np.array(point, np.int64))
        return names[1]

    def _with_mass(self, M_u: Array) -> None:
        """Take over an M_u, (n_u, n_u) [kg, kg m^2]; StepDataError if it is not definite."""
        if M_u is not self.masses.blocks:
            positive_definite("M_u", M_u)
            self.masses = Masses(self.template.h, self.template.K_q, M_u)

    def _step(
        self, names: tuple[str, ...], written: NDArray[Any], change: Array, J: Array
    ) -> JoinedStep:
        frames = {name: written[name] for name in ("phi", "n", "d1", "d2")}
        contacts = JoinedContacts.unchecked(name=names, own_J=J, **frames, **self._of_contacts)
        tau = written["tau"]
        n_a = len(change)
        return JoinedStep.unchecked(
            tau_a=tau[:n_a],
            tau_u=tau[n_a:],
            delta_q_bar_a=change,
            contacts=contacts,
            of_masses=self.masses,
            **self._of_all,
        )

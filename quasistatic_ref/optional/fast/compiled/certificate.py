"""The exact optima of a step's groups on guessed working sets, proved in compiled fixed point."""

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.certify.rational import dyadic
from quasistatic_ref.optional.fast.compiled.library import library
from quasistatic_ref.optional.fast.compiled.structure import Structure
from quasistatic_ref.optional.fast.posed import Constants
from quasistatic_ref.solve.units import (
    HessianInBothUnits,
    StepInBothUnits,
    Units,
)
from quasistatic_ref.step.cones import cone_matrix
from quasistatic_ref.step.data import Array, Indices, StepData
from quasistatic_ref.step.groups import Group

DECIDED = 0
REFUTED = 7
NOT_POSED = 8
"""Outcomes of a proof, as in proof.h: it holds; the guess is wrong; or there is none of these
data. With all others something stays open: nothing is known then."""

LARGEST = 256
"""Most coordinates: the time grows with the cube of their number, the memory with its square."""


def kept_J(step: StepData) -> Array:
    """J as a step keeps it, of any shape: whole, or without its zeros."""
    contacts: Any = step.contacts
    J: Array = contacts.blocks.J if hasattr(contacts, "blocks") else contacts.J
    return J


def _kept_A(A: Any) -> Array:
    """The same of A."""
    kept: Array = A if isinstance(A, np.ndarray) else A.data
    return kept


class Places:
    """Where the entries of groups' J and A are among those that steps keep; -1 of a zero.

    Parameters
    ----------
    step : StepData
        One of the whole steps.
    A : ndarray or sparse matrix, optional
        Its A, if this is asked for.
    """

    def __init__(self, step: StepData, A: Any = None) -> None:
        self.A = A
        J = kept_J(step)
        numbered = np.arange(1.0, J.size + 1).reshape(J.shape)
        contacts: Any = step.contacts
        self.dense = not hasattr(contacts, "blocks")
        self.J: Any = numbered if self.dense else replace(contacts.blocks, J=numbered)

    def in_J(self, group: Group) -> Indices:
        """Of its J, shape (n_c, 4, n)."""
        if self.dense:
            own = self.J[group.contacts][:, :, group.coordinates]
        else:
            own = self.J.columns(group.contacts, group.coordinates)
        places: Indices = own.astype(np.int64) - 1
        return places

    def in_A(self, group: Group) -> Indices:
        """Of its A, shape (m, n)."""
        A = self.A
        rows = group.rows
        if A is None:
            return np.full((len(rows), len(group.coordinates)), -1)
        if isinstance(A, np.ndarray):
            places: Indices = rows[:, None] * A.shape[1] + group.coordinates
            return places
        own = np.full(A.shape[0], -1)
        own[rows] = np.arange(len(rows))
        places = np.full((len(rows), len(group.coordinates)), -1)
        for i, v in enumerate(group.coordinates.tolist()):
            entries = np.arange(A.indptr[v], A.indptr[v + 1])
            row = own[A.indices[entries]]
            places[row[row >= 0], i] = entries[row >= 0]
        return places


class GroupProof:
    """The proofs of one group of steps that have their H, rows and groups in common.

    Parameters
    ----------
    group : Group
        Of at most LARGEST coordinates, without rows of a user's own.
    own : Constants or StepData
        What its steps, which are in a polyhedral cone, have in common.
    hessian : HessianInBothUnits
        Their H.
    places : Places
        Of the whole steps.

    Attributes
    ----------
    usable : bool
        Whether H can be written in fixed point.
    """

    def __init__(
        self,
        group: Group,
        own: Constants | StepData,
        hessian: HessianInBothUnits,
        places: Places,
    ) -> None:
        found = library()
        self._prove = found.proof
        self._prove_nearby = found.proof_nearby
        n_a = len(own.K_q)
        n, n_c, m = len(group.coordinates), len(group.contacts), len(group.rows)
        contact, row = np.divmod(own.row_layout.numbers, own.row_layout.mask.shape[1])
        self.s = s = Structure("proof.h", "Proof")
        self._natural = Structure("natural.c", "Natural")
        s.put(
            {
                "n_a": n_a, "n_v": n, "n_c": n_c, "rows": m, "working": 0,
                "answered": 0, "code": NOT_POSED,
                "coordinates": group.coordinates, "contacts": group.contacts,
                "in_J": places.in_J(group), "in_A": places.in_A(group),
                "rows_of_step": group.rows, "natural": self._natural.address,
                "h": np.array([own.h]), "coordinate": hessian.coordinate,
                "K_q": own.K_q, "M_u": own.M_u, "inverse": hessian.H_inverse,
                "J": np.zeros((n_c, 4, n)), "A": np.zeros((m, n)),
                "answer": np.zeros(m, np.int64), "guess": np.zeros(m, np.int64),
                "cone": cone_matrix(own.cone), "integers": _combined(own.cone),
                "contact": contact, "row": row,
                "hessian": np.zeros(n * n * found.number_size() // 8 + 1, np.int64),
                "hessian_values": np.zeros((n, n)), "units": np.zeros(2),
                "idle": np.zeros(m, np.int64), "still": np.zeros(n, np.int64),
                "counts": np.zeros(2, np.int64), "claims": np.zeros(2, np.int64),
                **step_arrays(n_a, n, n_c, m),
            }
        )  # fmt: skip
        self._natural.put(
            {
                "n": n, "m": m, **{name: s[name] for name in ("g", "A", "b", "units")},
                "coordinate": hessian.coordinate, "squared": hessian.squared,
                "inverse": hessian.H_inverse, "squares": np.zeros(m),
            }
        )  # fmt: skip
        self.usable = bool(found.hessian(s.address))

    @property
    def code(self) -> int:
        """What the last proof came to."""
        return self.s.number("code")

    @property
    def guess(self) -> Indices:
        """The rows that the last proof took as the working set, shape (k,)."""
        return self.s["guess"][: self.s.number("working")]

    def nearby(self, units: Units) -> ExactOptimum | None:
        """The exact optimum, if the last answer leads to it; of units that C has not found."""
        if self.code == NOT_POSED:
            self.s["units"][:] = units.length, units.size
            self._prove_nearby(self.s.address)
        return self.decided()

    def on(self, guess: Indices, units: Units) -> ExactOptimum | None:
        """The exact optimum, if a guess of its working set is right and fixed point shows it.

        Parameters
        ----------
        guess : ndarray of int, shape (k,)
            Rows, in ascending order.
        units : Units
            Natural units of the step, whose data are those of the last call of :class:`Prover`.
        """
        s = self.s
        if len(guess) > s.number("n_v"):
            return None
        s.put({"working": len(guess)})
        s["guess"][: len(guess)] = guess
        s["units"][:] = units.length, units.size
        self._prove(s.address)
        return self.decided()

    def decided(self) -> ExactOptimum | None:
        """The exact optimum, if the last proof has shown it."""
        if self.code != DECIDED:
            return None
        return _optimum(self.s, self.guess.tolist())


def step_arrays(n_a: int, n: int, n_c: int, m: int) -> dict[str, Array]:
    """Arrays for the data of a step of such sizes, a backend's answer to it, and its optimum.

    Returns
    -------
    dict of str to ndarray
        Of the shapes that a StepData, a StandardForm and an ExactOptimum have: (n_v,), (m,), ...;
        without J and A.
    """
    frame = np.zeros((n_c, 4, 4))
    frame[:, 3, 3] = 1.0
    return {
        "delta_q_bar_a": np.zeros(n_a), "phi": np.zeros(n_c), "least": np.zeros(2),
        "frame": frame, "mu": np.ones((n_c, 4)),
        **{name: np.zeros(n) for name in ("g", "tau", "delta_q", "net", "rest", "bound")},
        **{name: np.zeros(m) for name in ("b", "pressure", "gap", "lam", "slack")},
    }  # fmt: skip


def lend_data(s: Structure, step: StepData) -> None:
    """Let C read the data of a step."""
    contacts = step.contacts
    s.lend("J", kept_J(step))
    s.lend("delta_q_bar_a", step.delta_q_bar_a)
    s.lend("phi", contacts.phi)
    s["tau"][: step.n_a] = step.tau_a
    s["tau"][step.n_a :] = step.tau_u
    s["mu"][:, 1:] = contacts.mu
    for i, axes in enumerate((contacts.n, contacts.d1, contacts.d2)):
        s["frame"][:, i, :3] = axes


def _optimum(s: Structure, working: Sequence[int]) -> ExactOptimum:
    """The optimum that C has written, of a group or of a step."""
    unique, smooth = s["claims"].astype(bool).tolist()
    least_slack, least_multiplier = s["least"].tolist()
    inactive = least_slack if least_slack < math.inf else None
    return ExactOptimum(
        delta_q=s["delta_q"].copy(),
        lam=s["lam"].copy(),
        net=s["net"].copy(),
        slack=s["slack"].copy(),
        working_set=tuple(working),
        multipliers_unique=unique,
        differentiable=smooth,
        smallest_inactive_slack=inactive if smooth else 0.0,
        smallest_active_multiplier=least_multiplier if working else None,
        walks=0,
    )


class Prover:
    """The proofs of all groups of steps that have their H, rows and groups in common.

    Parameters
    ----------
    both : StepInBothUnits
        One of them.
    groups : sequence of (Group, Constants or StepData, HessianInBothUnits)
        Its groups, each with what its steps have in common.

    Attributes
    ----------
    proofs : list of GroupProof or None
        None of a group that is not proved here.
    """

    def __init__(
        self,
        both: StepInBothUnits,
        groups: Sequence[tuple[Group, Constants | StepData, HessianInBothUnits]],
    ) -> None:
        step = both.si_step
        found = library()
        self._prove = found.groups_proved
        A = both.si_form.A
        places = Places(step, A)
        self.proofs = [group_proof(*each, places) for each in groups]
        addresses = [0 if proof is None else proof.s.address for proof in self.proofs]
        self.s = Structure("groups.c", "Step")
        self.s.put(
            {
                "groups": len(groups), "group": np.array(addresses, np.int64),
                "code": np.zeros(len(groups), np.int64), "claims": np.zeros(2, np.int64),
                "J": kept_J(step), "A": _kept_A(A),
                **step_arrays(step.n_a, step.n_v, step.contacts.n_c, step.m),
            }
        )  # fmt: skip

    def optimum(self, both: StepInBothUnits, lam: Array, slack: Array) -> ExactOptimum | None:
        """The exact optimum on the rows that an answer presses; None unless C proves all groups.

        Parameters
        ----------
        both : StepInBothUnits
        lam, slack : ndarray, shape (m,)
            Of the answer, both in natural units [-].
        """
        s = self.s
        form = both.si_form
        given = {"g": form.g, "A": _kept_A(form.A), "b": form.b, "pressure": lam, "gap": slack}
        for name, value in given.items():
            s.lend(name, value)
        lend_data(s, both.si_step)
        if not self._prove(s.address):
            return None
        return _optimum(s, s["lam"].nonzero()[0].tolist())

    def displacement(self) -> tuple[Array, Array, Array]:
        """delta_q, shape (n_v,), that C has proved; its rest, and a bound of more [m, rad]."""
        return self.s["delta_q"], self.s["rest"], self.s["bound"]


def group_proof(
    group: Group, own: Constants | StepData, hessian: HessianInBothUnits, places: Places
) -> GroupProof | None:
    """The proofs of a group of a step, or None of one that C does not prove."""
    if len(group.extra_rows) or len(group.coordinates) > LARGEST:
        return None
    proof = GroupProof(group, own, hessian, places)
    return proof if proof.usable else None


@cache
def _combined(name: str) -> Indices:
    """How the rows of a cone combine gap, slips and spin: integers (R, 4), times one factor > 0."""
    return np.array(dyadic(cone_matrix(name)).m.tolist(), dtype=np.int64)

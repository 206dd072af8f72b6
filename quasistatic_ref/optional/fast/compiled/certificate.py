"""The exact optima of a step's groups on guessed working sets, proved in compiled fixed point."""

import math
from collections.abc import Iterator, Sequence
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.certify.rational import dyadic
from quasistatic_ref.certify.slacks import KnownSlacks
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

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix

DECIDED = 0
REFUTED = 7
NOT_POSED = 8
"""Outcomes of a proof, as in proof.h: it holds; the guess is wrong; or there is none of these
data. With all others something stays open: nothing is known then."""

LARGEST = 256
"""Most coordinates: the time grows with the cube of their number, the memory with its square."""


def _kept_A(A: "Array | csc_matrix") -> Array:
    """A as a step keeps it: whole, or without its zeros."""
    kept: Array = A if isinstance(A, np.ndarray) else A.data
    return kept


CONSTANT = (
    "h", "coordinate", "K_q", "M_u", "inverse", "cone", "integers", "contact", "row",
    "hessian", "hessian_values",
)  # fmt: skip
"""What groups of equal constants have in common."""


class Places(NamedTuple):
    """Where the entries of a group's J and A are among those that steps keep; -1 of a zero.

    Parameters
    ----------
    in_J : ndarray of int, shape (n_c, 4, n)
    in_A : ndarray of int, shape (m, n)
    """

    in_J: Indices
    in_A: Indices


def places(step: StepData, A: "Array | csc_matrix | None", groups: Sequence[Group]) -> list[Places]:
    """Where the entries of J and A of each group stand among those that a step keeps.

    Parameters
    ----------
    step : StepData
    A : ndarray, sparse matrix in columns, or None
        Its A; None if this is not asked for.
    groups : sequence of Group
    """
    of = np.full((2, step.m + step.n_v + 1), -1)
    column = of[:, : step.n_v + 1]
    row = of[:, step.n_v + 1 :]
    for k, group in enumerate(groups):
        for numbered, own in ((column, group.coordinates), (row, group.rows)):
            numbered[0, own] = k
            numbered[1, own] = np.arange(len(own))
    return [*map(Places, _in_J(step, groups, column), _in_A(A, groups, column, row))]


def _in_J(step: StepData, groups: Sequence[Group], column: Indices) -> Iterator[Indices]:
    """Of each group; `column` (2, n_v + 1): the group of a coordinate, and its number there."""
    columns = step.contacts.kept_columns
    J = step.contacts.kept_J
    numbers = np.arange(J.size).reshape(J.shape)
    for k, group in enumerate(groups):
        own = numbers[group.contacts]
        if columns is None:
            yield own[:, :, group.coordinates]
            continue
        of, place = column[:, columns[group.contacts]]
        n = len(group.coordinates)
        wide = np.full((len(own), 4, n + 1), -1)
        of_contact = np.arange(len(own))[:, None, None]
        wide[of_contact, np.arange(4)[:, None], np.where(of == k, place, n)[:, None]] = own
        yield np.ascontiguousarray(wide[:, :, :n])


def _in_A(
    A: "Array | csc_matrix | None", groups: Sequence[Group], column: Indices, row: Indices
) -> Iterator[Indices]:
    """Of each group; `row` (2, m) is for rows what `column` is for coordinates."""
    if isinstance(A, np.ndarray):
        for group in groups:
            yield group.rows[:, None] * A.shape[1] + group.coordinates
        return
    found = [np.full((len(group.rows), len(group.coordinates)), -1) for group in groups]
    if A is not None:
        of_column = np.repeat(np.arange(A.shape[1]), np.diff(A.indptr))
        of = row[0, A.indices]
        order = np.argsort(of, kind="stable")
        ends = np.searchsorted(of[order], np.arange(len(groups) + 1))
        for k, own in enumerate(found):
            entries = order[ends[k] : ends[k + 1]]
            entries = entries[column[0, of_column[entries]] == k]  # a zero may be of another group
            own[row[1, A.indices[entries]], column[1, of_column[entries]]] = entries
    yield from found


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
    like : GroupProof, optional
        One of a group of the same constants and H.

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
        like: "GroupProof | None" = None,
    ) -> None:
        found = library()
        self._prove = found.proof
        self._prove_nearby = found.proof_nearby
        n_a = len(own.K_q)
        n, n_c, m = len(group.coordinates), len(group.contacts), len(group.rows)
        self.s = s = Structure("proof.h", "Proof")
        self._natural = Structure("natural.c", "Natural")
        s.put(
            {
                "n_a": n_a, "n_v": n, "n_c": n_c, "rows": m, "working": 0,
                "answered": 0, "code": NOT_POSED,
                "coordinates": group.coordinates, "contacts": group.contacts,
                "in_J": places.in_J, "in_A": places.in_A,
                "rows_of_step": group.rows, "natural": self._natural.address,
            }
        )  # fmt: skip
        zeros_for_step(s, n_a, n, n_c, m)
        s.zeros({"J": (n_c, 4, n), "A": (m, n), "units": (2,)})
        s.zeros(
            {"answer": (m,), "guess": (m,), "idle": (m,), "still": (n,), "counts": (3,)}, np.int64
        )
        if like is None:
            contact, row = np.divmod(own.row_layout.numbers, own.row_layout.mask.shape[1])
            s.put(
                {
                    "h": np.array([own.h]), "coordinate": hessian.coordinate,
                    "K_q": own.K_q, "M_u": own.M_u, "inverse": hessian.H_inverse,
                    "cone": cone_matrix(own.cone), "integers": _combined(own.cone),
                    "contact": contact, "row": row,
                    "hessian": np.zeros(n * n * found.number_size() // 8 + 1, np.int64),
                    "hessian_values": np.zeros((n, n)),
                }
            )  # fmt: skip
            self._natural.put({"squared": hessian.squared})
        else:
            s.share(like.s, CONSTANT)
            self._natural.share(like._natural, ("squared",))
        self._natural.put({"n": n, "m": m})
        self._natural.zeros({"squares": (m,)})
        self._natural.share(s, ("g", "A", "b", "units", "coordinate", "inverse"))
        self.usable: bool = bool(found.hessian(s.address)) if like is None else like.usable

    @property
    def code(self) -> int:
        """What the last proof came to."""
        return self.s.number("code")

    @property
    def guess(self) -> Indices:
        """The rows that the last proof took as the working set, shape (k,)."""
        return self.s.integers("guess")[: self.s.number("working")]

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
        s.integers("guess")[: len(guess)] = guess
        s["units"][:] = units.length, units.size
        self._prove(s.address)
        return self.decided()

    def decided(self) -> ExactOptimum | None:
        """The exact optimum, if the last proof has shown it."""
        if self.code != DECIDED:
            return None
        return _optimum(self.s, self.guess.tolist())


def zeros_for_step(s: Structure, n_a: int, n: int, n_c: int, m: int) -> None:
    """Arrays for the data of a step of such sizes, a backend's answer to it, and its optimum.

    Of the shapes that a StepData, a StandardForm and an ExactOptimum have: (n_v,), (m,), ...;
    without J and A.
    """
    of_coordinates = ("g", "tau", "delta_q", "net", "rest", "bound")
    of_rows = ("b", "pressure", "gap", "lam", "slack")
    s.zeros(
        {
            "delta_q_bar_a": (n_a,), "phi": (n_c,), "least": (2,),
            "frame": (n_c, 4, 4), "mu": (n_c, 4),
            **dict.fromkeys(of_coordinates, (n,)), **dict.fromkeys(of_rows, (m,)),
        }
    )  # fmt: skip
    s.zeros({"claims": (2,)}, np.int64)
    s["frame"][:, 3, 3] = 1.0
    s["mu"][:] = 1.0


def write_data(s: Structure, step: StepData) -> None:
    """Write the data of a step where C reads them."""
    contacts = step.contacts
    s.write("J", step.contacts.kept_J)
    s.write("delta_q_bar_a", step.delta_q_bar_a)
    s.write("phi", contacts.phi)
    s["tau"][: step.n_a] = step.tau_a
    s["tau"][step.n_a :] = step.tau_u
    s["mu"][:, 1:] = contacts.mu
    for i, axes in enumerate((contacts.n, contacts.d1, contacts.d2)):
        s["frame"][:, i, :3] = axes


def _optimum(s: Structure, working: Sequence[int]) -> ExactOptimum:
    """The optimum that C has written, of a group or of a step."""
    unique, smooth, least_slack, least_multiplier = claims_of(s.integers("claims"), s["least"])
    return ExactOptimum(
        delta_q=s["delta_q"].copy(),
        lam=s["lam"].copy(),
        net=s["net"].copy(),
        slacks=KnownSlacks(s["slack"].copy()),
        working_set=tuple(working),
        multipliers_unique=unique,
        differentiable=smooth,
        smallest_inactive_slack=least_slack,
        smallest_active_multiplier=least_multiplier if working else None,
        walks=0,
    )


def claims_of(claims: Indices, least: Array) -> tuple[bool, bool, float | None, float]:
    """What a certificate claims, as C has written it: shapes (2,), `least` in [m] and [N s].

    Whether multipliers are unique, and delta_q differentiable; the smallest inactive slack; and the
    smallest active multiplier, if there is one.
    """
    unique, smooth = claims.astype(bool).tolist()
    slack, multiplier = least.tolist()
    inactive = slack if slack < math.inf else None
    return unique, smooth, inactive if smooth else 0.0, multiplier


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
        self.proofs = list[GroupProof | None]()
        alike: dict[tuple[int, int], GroupProof | None] = {}
        of_each = places(step, A, [group for group, _, _ in groups])
        for (group, own, hessian), where in zip(groups, of_each, strict=True):
            key = id(own), id(hessian)
            proof = group_proof(group, own, hessian, where, alike.get(key))
            alike.setdefault(key, proof)
            self.proofs.append(proof)
        addresses = [0 if proof is None else proof.s.address for proof in self.proofs]
        self.s = Structure("groups.c", "Step")
        self.s.put(
            {
                "groups": len(groups), "group": np.array(addresses, np.int64),
                "code": np.zeros(len(groups), np.int64),
                "J": np.array(step.contacts.kept_J), "A": np.array(_kept_A(A)),
            }
        )  # fmt: skip
        zeros_for_step(self.s, step.n_a, step.n_v, step.contacts.n_c, step.m)

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
            s.write(name, value)
        write_data(s, both.si_step)
        if not self._prove(s.address):
            return None
        return _optimum(s, s["lam"].nonzero()[0].tolist())

    def displacement(self) -> tuple[Array, Array, Array]:
        """delta_q, shape (n_v,), that C has proved; its rest, and a bound of more [m, rad]."""
        return self.s["delta_q"], self.s["rest"], self.s["bound"]


def group_proof(
    group: Group,
    own: Constants | StepData,
    hessian: HessianInBothUnits,
    places: Places,
    like: GroupProof | None = None,
) -> GroupProof | None:
    """The proofs of a group of a step, or None of one that C does not prove."""
    if len(group.extra_rows) or len(group.coordinates) > LARGEST:
        return None
    proof = GroupProof(group, own, hessian, places, like)
    return proof if proof.usable else None


@cache
def _combined(name: str) -> Indices:
    """How the rows of a cone combine gap, slips and spin: integers (R, 4), times one factor > 0."""
    return np.array(dyadic(cone_matrix(name)).m.tolist(), dtype=np.int64)

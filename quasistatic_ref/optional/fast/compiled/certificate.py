"""The exact optima of a step's groups on guessed working sets, proved in compiled fixed point."""

import math
from collections.abc import Sequence
from functools import cache

import numpy as np

from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.certify.rational import dyadic
from quasistatic_ref.certify.rows import places
from quasistatic_ref.optional.fast.compiled.library import library
from quasistatic_ref.optional.fast.compiled.structure import Structure
from quasistatic_ref.solve.units import DenseStepInBothUnits, Units
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


class GroupProof:
    """The proofs of one group of steps that have their H, rows and groups in common.

    Parameters
    ----------
    group : Group
    own : DenseStepInBothUnits
        The step of the group, in a polyhedral cone, without rows of a user's own, of at most
        LARGEST coordinates.

    Attributes
    ----------
    usable : bool
        Whether H can be written in fixed point.
    """

    def __init__(self, group: Group, own: DenseStepInBothUnits) -> None:
        found = library()
        step = own.si_step
        hessian = own.hessian
        self._prove = found.proof
        self._prove_nearby = found.proof_nearby
        n = step.n_v
        m = step.m
        contact, row = places(step, range(m))
        self.s = s = Structure("proof.h", "Proof")
        self._natural = Structure("natural.c", "Natural")
        s.put(
            {
                "n_a": step.n_a, "n_v": n, "n_c": step.contacts.n_c, "rows": m, "working": 0,
                "answered": 0, "code": NOT_POSED,
                "coordinates": group.coordinates, "contacts": group.contacts,
                "rows_of_J": (4 * group.contacts[:, None] + np.arange(4)).ravel(),
                "rows_of_step": group.rows, "natural": self._natural.address,
                "h": np.array([step.h]), "coordinate": hessian.coordinate,
                "K_q": step.K_q, "M_u": step.M_u, "inverse": hessian.H_inverse,
                "answer": np.zeros(m, np.int64), "guess": np.zeros(m, np.int64),
                "cone": cone_matrix(step.cone), "integers": _combined(step.cone),
                "contact": contact, "row": row,
                "hessian": np.zeros(n * n * found.number_size() // 8 + 1, np.int64),
                "hessian_values": np.zeros((n, n)), "units": np.zeros(2), **step_arrays(step),
                "idle": np.zeros(m, np.int64), "still": np.zeros(n, np.int64),
                "counts": np.zeros(2, np.int64), "claims": np.zeros(2, np.int64),
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


def step_arrays(step: StepData) -> dict[str, Array]:
    """Arrays for the data of a step like one, a backend's answer to it, and its optimum.

    Returns
    -------
    dict of str to ndarray
        Of the shapes that a StepData, a StandardForm and an ExactOptimum have: (n_v,), (m,), ...
    """
    n_c = step.contacts.n_c
    n = step.n_v
    m = step.m
    return {
        "delta_q_bar_a": np.zeros(step.n_a), "phi": np.zeros(n_c), "J": np.zeros((n_c, 4, n)),
        "frame": np.tile(np.diag([0.0, 0.0, 0.0, 1.0]), (n_c, 1, 1)), "mu": np.ones((n_c, 4)),
        "A": np.zeros((m, n)), "least": np.zeros(2),
        **{name: np.zeros(n) for name in ("g", "tau", "delta_q", "net")},
        **{name: np.zeros(m) for name in ("b", "pressure", "gap", "lam", "slack")},
    }  # fmt: skip


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
    step : StepData
        One of them.
    groups : sequence of (Group, DenseStepInBothUnits)
        Its groups, each with its own step in natural units.

    Attributes
    ----------
    proofs : list of GroupProof or None
        None of a group that is not proved here.
    """

    def __init__(
        self, step: StepData, groups: Sequence[tuple[Group, DenseStepInBothUnits]]
    ) -> None:
        found = library()
        self._prove = found.groups_proved
        self.proofs = [group_proof(*each) for each in groups]
        addresses = [0 if proof is None else proof.s.address for proof in self.proofs]
        self.s = Structure("groups.c", "Step")
        self.s.put(
            {
                "n_v": step.n_v, "groups": len(groups),
                "group": np.array(addresses, np.int64), "code": np.zeros(len(groups), np.int64),
                "claims": np.zeros(2, np.int64),
                **step_arrays(step),
            }
        )  # fmt: skip

    def optimum(self, both: DenseStepInBothUnits, lam: Array, slack: Array) -> ExactOptimum | None:
        """The exact optimum on the rows that an answer presses; None unless C proves all groups.

        Parameters
        ----------
        both : DenseStepInBothUnits
        lam, slack : ndarray, shape (m,)
            Of the answer, both in natural units [-].
        """
        s = self.s
        step = both.si_step
        contacts = step.contacts
        form = both.si_form
        for name, value in {
            "delta_q_bar_a": step.delta_q_bar_a, "phi": contacts.phi, "J": contacts.J,
            "g": form.g, "A": form.A, "b": form.b, "pressure": lam, "gap": slack,
        }.items():  # fmt: skip
            s.fill(name, value)
        s["tau"][: step.n_a] = step.tau_a
        s["tau"][step.n_a :] = step.tau_u
        s["mu"][:, 1:] = contacts.mu
        for i, axes in enumerate((contacts.n, contacts.d1, contacts.d2)):
            s["frame"][:, i, :3] = axes
        if not self._prove(s.address):
            return None
        return _optimum(s, s["lam"].nonzero()[0].tolist())


def undivided(both: DenseStepInBothUnits) -> Prover:
    """The proofs of steps like one, all of which is a group."""
    step = both.si_step
    sizes = step.n_v, step.contacts.n_c, len(step.extra.names), step.m
    return Prover(step, [(Group(*map(np.arange, sizes)), both)])


def group_proof(group: Group, own: DenseStepInBothUnits) -> GroupProof | None:
    """The proofs of a group, or None of one that C does not prove."""
    if own.si_step.extra.names or own.si_step.n_v > LARGEST:
        return None
    proof = GroupProof(group, own)
    return proof if proof.usable else None


@cache
def _combined(name: str) -> Indices:
    """How the rows of a cone combine gap, slips and spin: integers (R, 4), times one factor > 0."""
    return np.array(dyadic(cone_matrix(name)).m.tolist(), dtype=np.int64)

"""The exact optimum on a guessed working set, proved in compiled fixed point."""

import math

import numpy as np

from quasistatic_ref.certify.exact import ExactOptimum
from quasistatic_ref.optional.fast.compiled.library import library
from quasistatic_ref.optional.fast.compiled.structure import Structure
from quasistatic_ref.optional.fast.guess.exchange import Proof, Refuted
from quasistatic_ref.optional.fast.guess.zeros import Degeneracy, combined, zeros
from quasistatic_ref.solve.units import Units
from quasistatic_ref.step.cones import cone_matrix
from quasistatic_ref.step.data import Array, Indices, RowLayout, StepData

NUMBERS = ("n_a", "n_v", "n_c", "rows", "working")
ARRAYS = (
    "h", "coordinate", "units",
    "K_q", "M_u", "delta_q_bar_a", "tau_a", "tau_u",
    "phi", "n", "d1", "d2", "J", "mu_v", "mu_omega",
    "cone", "integers", "contact", "row", "guess",
    "hessian", "hessian_values",
    "delta_q", "lam", "net", "slack", "idle", "still", "counts", "least",
)  # fmt: skip
"""The fields of ``Proof`` in proof.h."""

DECIDED, REFUTED, TO_BE_IMPLIED = 0, 6, 7
"""Outcomes of a proof: it holds; the guess is wrong; or it holds if some numbers are proved to be
zero."""

LARGEST = 256
"""Most coordinates: the time grows with the cube of their number, the memory with its square."""


class Prover:
    """Proofs for steps of one kind: of one H in the same units, and of the same rows.

    Parameters
    ----------
    step : StepData
        In a polyhedral cone, without rows of a user's own.
    coordinate : ndarray, shape (n_v,)
        Diagonal of S of its natural units [m or rad, per (N m s)^0.5].
    """

    def __init__(self, step: StepData, coordinate: Array) -> None:
        found = library()
        self.of = step.h, step.K_q, step.M_u, step.layout, coordinate
        self._proof = found.proof
        n = step.n_v
        m = int(step.offsets[-1])
        self.s = s = Structure(NUMBERS, ARRAYS, found.proof_size)
        s.put(
            {
                "n_a": step.n_a, "n_v": n, "n_c": step.contacts.n_c, "rows": m, "working": 0,
                "h": np.array([step.h]), "coordinate": coordinate, "units": np.zeros(2),
                "K_q": step.K_q, "M_u": step.M_u, "guess": np.zeros(n, np.int64),
                "cone": cone_matrix(step.cone), "integers": combined(step.cone),
                **places(step.layout),
                "hessian": np.zeros(n * n * found.number_size() // 8 + 1, np.int64),
                "hessian_values": np.zeros((n, n)),
                **{name: np.zeros(len(values)) for name, values in vectors(step).items()},
                **{name: np.zeros(n) for name in ("delta_q", "net")},
                "J": np.zeros(step.contacts.J.shape),
                "lam": np.zeros(m), "slack": np.zeros(m), "idle": np.zeros(m, np.int64),
                "still": np.zeros(n, np.int64), "counts": np.zeros(2, np.int64),
                "least": np.zeros(2),
            }
        )  # fmt: skip
        self.usable = n <= LARGEST and bool(found.hessian(s.address))

    def fits(self, step: StepData, coordinate: Array) -> bool:
        """Whether a step is of that kind; its S has the diagonal `coordinate` (n_v,) [m, rad]."""
        h, K_q, M_u, layout, unit = self.of
        own = step.layout is layout and coordinate is unit
        return own and h == step.h and K_q is step.K_q and M_u is step.M_u

    def optimum(self, step: StepData, guess: Indices, units: Units) -> Proof:
        """The exact optimum, if a guess of its working set is right and fixed point shows it.

        Parameters
        ----------
        step : StepData
            That :meth:`fits`.
        guess : ndarray of int, shape (k,)
            Rows, in ascending order.
        units : Units
            Natural units of the step.

        Returns
        -------
        ExactOptimum, Refuted or None
            None where something stays open: nothing is known then.
        """
        working = guess.tolist()
        s = self.s
        if not self.usable or len(working) > step.n_v:
            return None
        s.put({"working": len(working)})
        s["guess"][: len(working)] = guess
        s["units"][:] = units.length, units.size
        s["J"][:] = step.contacts.J
        for name, values in vectors(step).items():
            s[name][:] = values
        code = self._proof(s.address)
        rows, coordinates = s["counts"].tolist()
        if code == REFUTED:
            return Refuted(guess, s["lam"][guess], s["slack"].copy())
        least_slack, least_multiplier = s["least"].tolist()
        if code not in (DECIDED, TO_BE_IMPLIED):
            return None
        means: Degeneracy | None = Degeneracy(unique=not rows, smooth=True)
        if code == TO_BE_IMPLIED:
            means = zeros(
                step, working, s["idle"][:rows].tolist(), s["still"][:coordinates].tolist()
            )
        if means is None:
            return None
        inactive = least_slack if least_slack < math.inf else None
        return ExactOptimum(
            delta_q=s["delta_q"].copy(),
            lam=s["lam"].copy(),
            net=s["net"].copy(),
            slack=s["slack"].copy(),
            working_set=tuple(working),
            multipliers_unique=means.unique,
            differentiable=means.smooth,
            smallest_inactive_slack=inactive if means.smooth else 0.0,
            smallest_active_multiplier=least_multiplier if working else None,
            walks=0,
        )


def vectors(step: StepData) -> dict[str, Array]:
    """What changes from step to step, apart from J: flat arrays of shape (their size,)."""
    contacts = step.contacts
    mu = contacts.mu
    return {
        "delta_q_bar_a": step.delta_q_bar_a, "tau_a": step.tau_a, "tau_u": step.tau_u,
        "phi": contacts.phi, "mu_v": mu[:, 0], "mu_omega": mu[:, 2],
        "n": contacts.n.ravel(), "d1": contacts.d1.ravel(), "d2": contacts.d2.ravel(),
    }  # fmt: skip


def places(layout: RowLayout) -> dict[str, Indices]:
    """The contact of each row, and its number there; each of shape (m,)."""
    contact, row = np.nonzero(layout.mask)
    return {"contact": contact, "row": row}


def prover(step: StepData, coordinate: Array, kept: Prover | None) -> Prover | None:
    """What proves steps of this kind: the one that is kept, if it does; None if nothing does.

    Parameters
    ----------
    step : StepData
    coordinate : ndarray, shape (n_v,)
        Diagonal of S of its natural units [m or rad, per (N m s)^0.5].
    kept : Prover or None
    """
    if step.extra.names:
        return None
    return kept if kept is not None and kept.fits(step, coordinate) else Prover(step, coordinate)

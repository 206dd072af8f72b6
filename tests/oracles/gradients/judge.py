"""What the package says of a state against the reference: numbers, verdicts, kinds of contacts."""

from typing import Any, Final

import numpy as np

from quasistatic_ref.lab.vectors.layers.derivative import free_sizes
from quasistatic_ref.optional.derivatives.derivatives import Derivatives, derivatives
from quasistatic_ref.optional.derivatives.step.reason import ZERO_FRICTION
from quasistatic_ref.step.data import Array
from quasistatic_ref.step.friction import frame_jacobian
from tests.oracles.differences import unit
from tests.oracles.gradients.reference import FIELDS, Reference, reference, slope, tied_pairs
from tests.oracles.gradients.states import State

DIRECTIONS: Final = 2
STILL: Final = 1e-9
"""Motion of a contact, relative to the step's [-], below which it does not slip, spin or part."""


def claimed(state: State, found: Derivatives) -> dict[str, Array]:
    """The package's derivatives in the case's order of coordinates, links and pairs."""
    v, n_a = state.order, state.simulator.system.n_a
    columns = {"dq_dq": v, "dq_dq_bar_a": v[:n_a], "dq_dtau": v, "dq_dK_q": v[:n_a]}
    columns["dq_dmasses"] = state.links
    fields = {}
    for field in FIELDS:
        value = getattr(found, field).reshape(len(v), -1)[v]
        fields[field] = value[:, columns[field]] if field in columns else value
    return fields


def judged(state: State, rng: np.random.Generator, every_column: bool = False) -> dict[str, Any]:
    """The record of a state.

    Returns
    -------
    dict
        ``fields``: of each derivative the largest error, the largest entry, that of the step
        without contacts, and how many directions there were. ``kinks``: derivatives for which the
        reference bends where the package has numbers. ``refused``: of those that the package
        refuses, whether the reference bends or has a tie. Besides ``reasons``, ``modes``
        and ``same_contacts``.
    """
    found = derivatives(state.simulator, state.q, state.q_bar_a, state.force)
    one = reference(state)
    sizes = free_sizes(one)
    record: dict[str, Any] = {
        "group": state.group,
        "name": state.name,
        "contacts": found.result.step.contacts.n_c,
        "modes": modes(found),
        "same_contacts": same_contacts(state, found, one),
        "reasons": sorted({why.kind for why in found.reasons} - {ZERO_FRICTION}),
        "fields": {},
        "kinks": [],
        "refused": {},
    }
    for field, value in claimed(state, found).items():
        can = _can_move(state, field)
        known = np.isfinite(value).all(axis=0) & can
        size = float(np.abs(value[:, known]).max(initial=0.0))
        errors = []
        for e in _directions(rng, known, every_column):
            there, smooth = slope(one, field, e)
            if not smooth:
                record["kinks"].append(field)
                continue
            mine = value[:, known] @ e[known]
            errors.append(float(np.abs(mine - there).max()))
        if errors:
            free = sizes[FIELDS[field]]
            record["fields"][field] = [max(errors), size, free, len(errors)]
        if (can & ~known).any():
            e = np.where(can, unit(rng, len(can)), 0.0)
            record["refused"][field] = not slope(one, field, e)[1] or tied_pairs(one)
    return record


def same_contacts(state: State, found: Derivatives, one: Reference) -> bool:
    """Whether float64 and the reference keep the same candidates."""
    points, at = found.result.points.point.tolist(), 0
    for p, pair in enumerate(state.simulator.pairs):
        theirs = sorted(c.near.index for c in one.contacts if c.near.pair == p)
        if sorted(points[at : at + pair.n_c]) != theirs:
            return False
        at += pair.n_c
    return True


def _can_move(state: State, field: str) -> np.ndarray:
    """Which columns have two sides: a coefficient of zero cannot fall."""
    sizes = {
        "dq_dmu_v": [pair.mu_v for pair in state.simulator.pairs],
        "dq_dmu_omega": [pair.mu_omega for pair in state.simulator.pairs],
        "dq_dh": [1.0],
        "dq_dmasses": np.ones(len(state.links)),
    }
    system = state.simulator.system
    count = system.n_a if field in ("dq_dq_bar_a", "dq_dK_q") else system.n_v
    return np.asarray(sizes.get(field, np.ones(count)), dtype=float) > 0


def _directions(rng: np.random.Generator, known: np.ndarray, every_column: bool) -> list[Array]:
    """Two random directions of the columns that are known; or each of the other columns."""
    if not known.any():
        return []
    found = [np.eye(len(known))[j] for j in np.flatnonzero(known)] if every_column else []
    count = DIRECTIONS if known.sum() > 1 else 1
    for _ in range(count):
        e = np.where(known, rng.normal(size=len(known)), 0.0)
        found.append(e / np.linalg.norm(e))
    return found


def modes(found: Derivatives) -> list[str]:
    """What the contacts of a step do: separated, lifting, sliding, spinning, sticking.

    Parameters
    ----------
    found : Derivatives
    """
    step, solution = found.result.step, found.result.solution
    contacts = step.contacts
    if not contacts.n_c:
        return ["separated"]
    _, J_1, J_2, J_w = frame_jacobian(contacts, contacts.dense().J)
    x = solution.delta_q
    size = float(np.abs(x).max()) or 1.0
    load = np.bincount(np.argwhere(step.mask)[:, 0], weights=solution.lam, minlength=contacts.n_c)
    slip = np.hypot(J_1 @ x, J_2 @ x) > STILL * size
    spin = (np.abs(J_w @ x) > STILL * size) & (contacts.rows == 6)
    kinds = set()
    for j in range(contacts.n_c):
        if load[j] <= 0:
            kinds.add("separated" if contacts.phi[j] > 0 else "lifting")
        elif slip[j]:
            kinds.add("sliding")
        else:
            kinds.add("spinning" if spin[j] else "sticking")
    return sorted(kinds)

"""Contacts that a step finds deep and the step before did not predict."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import least, more_points, slices, table
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.step.data import Array
from quasistatic_ref.tolerances import FILLED, SUNK


def sunk(run: Run) -> Iterator[Finding]:
    """Of each table of contacts the first that is found."""
    first: dict[str, Finding] = {}
    gap = run.noted("gap")
    for pair, own in slices(run.pairs):
        said = _surprise(run, pair, run["phi"][:, own], run["point"][:, own], gap[:, own])
        name = table(run, pair)
        if said and (name not in first or said.numbers["step"] < first[name].numbers["step"]):
            first[name] = said
    yield from first.values()


def crossed(run: Run) -> Iterator[Finding]:
    """The first pair that comes from where MuJoCo looks for no contact into the other's depth."""
    counts = np.array([pair.n_c for pair in run.pairs], dtype=np.int64)
    nearest = np.cumsum(counts) - counts
    phi = run["phi"][:, nearest]
    if not (phi >= FILLED).any():
        return
    last = run.simulator.closest_points(run.system.kinematics(run["q"][-1])).phi[nearest]
    phi = np.vstack([phi, last])
    steps, pairs = np.nonzero((phi[:-1] >= FILLED) & (phi[1:] < 0))
    for k, j in zip(steps[:1].tolist(), pairs[:1].tolist(), strict=True):
        depth = -1e3 * float(phi[k + 1, j])
        cause = f"{run.pairs[j].name} comes from beyond the margin to {depth:.3g} mm deep in step "
        cause += f"{k}, which had no row for it"
        numbers = {"depth_mm": depth, "step": k}
        yield Finding("crossed margin", True, "raise margin, or take a smaller h", cause, numbers)


def _surprise(
    run: Run, pair: ContactPair, phi: Array, point: NDArray[np.generic], gap: Array
) -> Finding | None:
    deepest = SUNK * least(pair)
    k, j = np.nonzero(phi[1:] < -deepest)  # contacts are in ascending distance
    before = point[k]
    number = point[k + 1, j]
    same = before == number[:, None]
    # The closest pair of two solids has one number wherever it is: that names no point.
    considered = same.any(axis=1) | (pair.n_c == 1 and not pair.has_cloud)
    predicted = np.where(considered, gap[k, same.argmax(axis=1)], 0.0)
    surprising = np.flatnonzero(np.minimum(predicted, 0.0) - phi[k + 1, j] > deepest)
    if not surprising.size:
        return None
    i = surprising[0]
    step = int(k[i]) + 1
    depth = -1e3 * float(phi[k[i] + 1, j[i]])
    deep = f"{depth:.3g} mm deep at step {step}"
    numbers = {"depth_mm": depth, "step": step}
    what = "point" if pair.has_cloud or number[i] < pair.corners else "candidate"
    raised = more_points(run, pair)
    if not considered[i]:
        left_out = f"was not among its {pair.n_c} closest at step {step - 1}"
        return Finding(
            "sunk contact",
            True,
            raised,
            f"{what} {number[i]} of {pair.name} {left_out} and is {deep}",
            numbers,
        )
    more = f", or {raised}" if pair.n_c < pair.candidates else ""
    left = f"the step before, which is right to first order, left it at {1e3 * predicted[i]:.3g} mm"
    cause = f"{what} {number[i]} of {pair.name} is {deep}; {left}"
    return Finding("sunk contact", True, f"take a smaller h or move slower{more}", cause, numbers)

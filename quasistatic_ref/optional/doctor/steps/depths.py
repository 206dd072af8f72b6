"""Contacts that are deeper than the step before foresaw."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.optional.doctor.frame.run import Run
from quasistatic_ref.optional.doctor.frame.start import least, more_points, table
from quasistatic_ref.optional.doctor.frame.tolerances import SUNK
from quasistatic_ref.optional.doctor.texts import finding
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.tolerances import FILLED


def sunk(run: Run) -> Iterator[Finding]:
    """The first deep overlap of each contact table."""
    deep = (run["phi"][1:] < -SUNK * run.sizes).any(axis=0)
    pairs = [run.slices[i] for i in sorted(set(run.pair_of[deep].tolist()))]
    found = {pair: one for pair, slots in pairs if (one := _surprise(run, pair, slots))}
    first: dict[str, Finding] = {}
    for pair, one in sorted(found.items(), key=lambda item: item[1].numbers["step"]):
        first.setdefault(table(run, pair), one)
    yield from first.values()


def _surprise(run: Run, pair: ContactPair, slots: slice) -> Finding | None:
    """The first contact of a pair that is deep, and was not to be."""
    phi, point, gap = (x[:, slots] for x in (run["phi"], run["point"], run.gap))
    deepest = SUNK * least(pair)
    k, j = np.nonzero(phi[1:] < -deepest)  # contacts are in ascending distance
    number = point[k + 1, j]
    same = point[k] == number[:, None]
    # The closest pair of two solids has one number wherever it is: that names no point.
    considered = same.any(axis=1) | (pair.n_c == 1 and not pair.has_cloud)
    predicted = np.where(considered, gap[k, same.argmax(axis=1)], 0.0)
    surprising = np.flatnonzero(np.minimum(predicted, 0.0) - phi[k + 1, j] > deepest)
    if not surprising.size:
        return None
    i = surprising[0]
    step = int(k[i]) + 1
    remedy = more_points(run, pair)
    depth = -1e3 * float(phi[k[i] + 1, j[i]])
    deep = f"is {depth:.3g} mm deep at step {step}"
    why = f"was not among its {pair.n_c} closest at step {step - 1} and {deep}"
    if considered[i]:
        remedy = f"take a smaller h or move slower{f', or {remedy}' * (pair.n_c < pair.candidates)}"
        why = f"{deep}; the step before, which is right to first order, left it at "
        why += f"{1e3 * predicted[i]:.3g} mm"
    what = "point" if pair.has_cloud or number[i] < pair.corners else "candidate"
    cause = f"{what} {number[i]} of {pair.name} {why}"
    return finding("sunk-contact", cause, remedy, depth_mm=depth, step=step)


def crossed(run: Run) -> Iterator[Finding]:
    """The first pair that comes from where MuJoCo looks for no contact into the other's depth."""
    nearest = [at.start for _, at in run.slices]
    if not (run["phi"][:, nearest] >= FILLED).any():
        return
    last = run.simulator.closest_points(run.system.kinematics(run["q"][-1])).phi
    phi = np.vstack([run["phi"], last])[:, nearest]
    for k, i in np.argwhere((phi[:-1] >= FILLED) & (phi[1:] < 0))[:1].tolist():
        depth = -1e3 * float(phi[k + 1, i])
        cause = f"{run.pairs[i].name} comes from beyond the margin to {depth:.3g} mm deep in step "
        cause += f"{k}, which had no row for it"
        remedy = "raise margin, or take a smaller h"
        yield finding("crossed-margin", cause, remedy, depth_mm=depth, step=k)

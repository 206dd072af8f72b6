"""Steps that are too long for their first order, and contacts that they did not predict."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from quasistatic_ref.contact.pairs import ContactPair
from quasistatic_ref.optional.doctor.rings import ringing
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import least, more_points, slices, table
from quasistatic_ref.optional.doctor.telling import amount, distance
from quasistatic_ref.optional.doctor.tolerances import BEYOND, SUNK
from quasistatic_ref.optional.doctor.unsupported import falls
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.tolerances import FILLED

LEAP: Final = 0.25
"""Motion per step, relative to the size of what is moved [-], or turn [rad], that is worth a
warning: to first order the motion is wrong by 1 - cos 0.25 = 3 % of the size. The spun sphere of
sphere_spin reaches 0.15."""

JUMP = 0.1
"""Motion in the first step towards a waypoint that is elsewhere than the start, of the size of what
moves [-], or turn [rad], from which on it counts as a leap."""


def leaps(run: Run) -> Iterator[Finding]:
    """The first step that moves or turns a body by a large part of its size.

    A joint that does not start where its first waypoint is gets there in one step.
    A body that falls, or a coordinate that rings, has a finding of its own.
    """
    sides = run.sides
    known = {*falls(run), *(run.system.coordinates[i].joint for i in ringing(run))}
    jumps = {
        track.joint.name: abs(float(track.values[0, 0] - run.q_start[track.joint.q][0]))
        for track in run.tracks
        if track.joint.q.stop - track.joint.q.start == 1
    }
    links = np.array([side.link for side in sides], dtype=np.int64)
    leaps_of_pairs: list[tuple[int, float, Finding]] = []
    for joint in run.system.joints:
        if joint.name.removesuffix("/base") in known or joint.name in known:
            continue
        moved = [sides[i] for i in np.flatnonzero(run.moves[links, joint.v].any(axis=1))]
        motion = run["delta_q"][:, joint.v]
        lengths = joint.lengths
        extents = [side.shape.extent for side in moved]
        size = max((x for x in extents if 0 < x < np.inf), default=np.inf)
        way = np.linalg.norm(motion[:, :lengths], axis=1)
        angle = np.linalg.norm(motion[:, lengths:], axis=1)
        share = np.maximum(way / size, angle)
        jump = jumps.get(joint.name, 0.0) if share[0] > JUMP else 0.0
        long = share > (JUMP if jump > BEYOND else LEAP)
        if not (moved and long.any()):
            continue
        k = int(long.argmax())
        how = f"turns by {np.degrees(angle[k]):.3g} degrees"
        if way[k] / size > angle[k]:
            how = f"moves by {distance(way[k])}, {share[k]:.2g} of the size of what it moves"
        remedy = "take a smaller h, move slower, or start nearer to the first target"
        why = "and a step is right to first order only"
        if jump > BEYOND:
            remedy = f"start {joint.name} where its first waypoint is, or add one where it starts"
            why = f"towards a first target {amount(jump, joint.coordinates[0].unit)} from its start"
        finding = Finding(
            "leap",
            True,
            remedy,
            f"{joint.name} {how}, in step {k}, {why}",
            {"length_m": float(way[k]), "angle_rad": float(angle[k]), "step": k},
        )
        leaps_of_pairs.append((k, -float(share[k]), finding))
    if leaps_of_pairs:
        _, _, finding = min(leaps_of_pairs, key=lambda leap: leap[:2])
        yield finding


def sunk(run: Run) -> Iterator[Finding]:
    """The first deep overlap of each contact table."""
    first: dict[str, Finding] = {}
    for pair, slots in slices(run.pairs):
        finding = _surprise(run, pair, slots)
        name = table(run, pair)
        if finding and (name not in first or finding.numbers["step"] < first[name].numbers["step"]):
            first[name] = finding
    yield from first.values()


def crossed(run: Run) -> Iterator[Finding]:
    """The first pair that comes from where MuJoCo looks for no contact into the other's depth."""
    nearest = [at.start for _, at in slices(run.pairs)]
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
        yield Finding("crossed-margin", True, "raise margin, or take a smaller h", cause, numbers)


def _surprise(run: Run, pair: ContactPair, slots: slice) -> Finding | None:
    phi, point, gap = (x[:, slots] for x in (run["phi"], run["point"], run.gap))
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
    remedy = more_points(run, pair)
    cause = f"{what} {number[i]} of {pair.name} was not among its {pair.n_c} closest at step "
    cause += f"{step - 1} and is {deep}"
    if considered[i]:
        more = f", or {remedy}" if pair.n_c < pair.candidates else ""
        remedy = f"take a smaller h or move slower{more}"
        cause = f"{what} {number[i]} of {pair.name} is {deep}; the step before, which is right to "
        cause += f"first order, left it at {1e3 * predicted[i]:.3g} mm"
    return Finding("sunk-contact", True, remedy, cause, numbers)

"""Steps that are too long for their first order."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from quasistatic_ref.optional.doctor.frame.run import Run
from quasistatic_ref.optional.doctor.frame.tolerances import BEYOND
from quasistatic_ref.optional.doctor.start.falls import falls
from quasistatic_ref.optional.doctor.steps.rings import ringing
from quasistatic_ref.optional.doctor.texts import amount, distance, finding
from quasistatic_ref.simulate.finding import Finding

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
    known = {*falls(run), *(run.system.coordinates[i].joint for i in ringing(run))}
    sizes = np.full(len(run.system.links), -1.0)
    for side in run.sides:
        extent = side.shape.extent
        sizes[side.link] = max(sizes[side.link], extent if extent < np.inf else 0.0)
    tracks = {x.joint.name: x.values[0, 0] for x in run.tracks if len(x.joint.coordinates) == 1}
    found: list[tuple[int, float, Finding]] = []
    for joint in run.system.joints:
        size = sizes[run.moves[:, joint.v].any(axis=1)].max(initial=-1.0)
        if size < 0 or not known.isdisjoint((joint.name, joint.name.removesuffix("/base"))):
            continue
        motion = run["delta_q"][:, joint.v]
        way = np.linalg.norm(motion[:, : joint.lengths], axis=1)
        angle = np.linalg.norm(motion[:, joint.lengths :], axis=1)
        shares = np.maximum(way / (size or np.inf), angle)
        start = run.q_start[joint.q][0]
        jump = abs(float(tracks.get(joint.name, start) - start)) if shares[0] > JUMP else 0.0
        limit = JUMP if jump > BEYOND else LEAP
        k = int((shares > limit).argmax())
        share = float(shares[k])
        if share <= limit:
            continue
        how = f"turns by {np.degrees(angle[k]):.3g} degrees"
        if share > angle[k]:
            how = f"moves by {distance(way[k])}, {share:.2g} of the size of what it moves"
        remedy = "take a smaller h, move slower, or start nearer to the first target"
        why = "and a step is right to first order only"
        if jump > BEYOND:
            remedy = f"start {joint.name} where its first waypoint is, or add one where it starts"
            why = f"towards a first target {amount(jump, joint.coordinates[0].unit)} from its start"
        numbers = {"length_m": way[k], "angle_rad": angle[k], "step": k}
        cause = f"{joint.name} {how}, in step {k}, {why}"
        found.append((k, -share, finding("leap", cause, remedy, **numbers)))
    yield from (leap for *_, leap in sorted(found, key=lambda leap: leap[:2])[:1])

"""Steps that are too long for their first order."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.start import sizes
from quasistatic_ref.simulate.finding import Finding
from quasistatic_ref.tolerances import LEAP


def leaps(run: Run) -> Iterator[Finding]:
    """The first step that moves a body of a pair by much of its size, or turns it by much.

    How far a body moves that is not in equilibrium says nothing: it has a finding of its own.
    """
    column_map = run.system.column_map
    moves = column_map.of_coordinates(column_map.moves)[:, 0] != 0  # (L, n_v)
    sides = run.sides
    links = np.array([side.link for side in sides], dtype=np.int64)
    found: list[tuple[int, float, Finding]] = []
    for joint in run.system.joints:
        if joint.name.partition("/")[0] in run.compared.unbalanced:
            continue
        moved = [sides[i] for i in np.flatnonzero(moves[links, joint.v].any(axis=1))]
        motion = run["delta_q"][:, joint.v]
        lengths = joint.lengths
        size = max(sizes(moved), default=np.inf)
        length = np.linalg.norm(motion[:, :lengths], axis=1)
        angle = np.linalg.norm(motion[:, lengths:], axis=1)
        share = np.maximum(length / size, angle)
        if not (moved and (long := share > LEAP).any()):
            continue
        k = int(long.argmax())
        how = f"turns by {np.degrees(angle[k]):.3g} degrees"
        if length[k] / size > angle[k]:
            how = f"moves by {1e3 * length[k]:.3g} mm, {share[k]:.2g} of the {size:.3g} m it moves"
        said = Finding(
            "leap",
            True,
            "take a smaller h, move slower, or start nearer to the first target",
            f"{joint.name} {how}, in step {k}, and a step is right to first order only",
            {"length_m": float(length[k]), "angle_rad": float(angle[k]), "step": k},
        )
        found.append((k, -float(share[k]), said))
    if found:
        _, _, said = min(found, key=lambda leap: leap[:2])
        yield said

"""Measured pushes, predicted with friction that was identified from measured loads alone."""

from functools import cache

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Comparison, comparison, within
from quasistatic_ref.lab.reality.errors import pose_errors
from quasistatic_ref.lab.reality.identify import identified_ratio
from quasistatic_ref.lab.reality.measurements import loads_read, pairs_read, pushes_read
from quasistatic_ref.lab.reality.predict import prediction
from quasistatic_ref.lab.reality.push import pushed_scene
from quasistatic_ref.lab.reality.settings import Settings
from quasistatic_ref.numbers.arrays import Array

EVERY, ADVANCE = 100, 2e-3
"""Of the pushes of each pair; the finger's way in a step [m]."""

MORE_MM, MORE_DEG = 0.6, 0.9
"""Most by which the mean error may differ from the published simulator's: errors of a push differ
between the two by so much that the mean over 60 pushes scatters by 0.2 mm and 0.3 degrees; three
times that."""

WORSE = 1.5
"""Least ratio of the pyramid's errors to the ellipsoid's [-]: below it the sample does not tell the
two cones apart, since the mean of either scatters by a tenth."""


@cache
def errors(cone: str) -> tuple[Array, Array, int]:
    """Mean errors over pairs of the model and of the published simulator, and steps unproved.

    Returns
    -------
    ours, other : ndarray, shape (2,)
        Of place and angle [mm, deg].
    unproved : int
    """
    pairs = pairs_read()
    loads = loads_read(pairs)
    pushes = pushes_read(pairs)
    ours = []
    other = []
    unproved = 0
    for pair in pairs:
        ratio = identified_ratio(loads[pair.name], pair.outline.gyration)
        some = pushes[pair.name].every(EVERY)
        scene = pushed_scene(Settings(cone=cone, advance=ADVANCE), pair, ratio)
        ways = zip(some.before, some.path, strict=True)
        ends = [prediction(scene, before, path) for before, path in ways]
        unproved += sum(n for e in ends for kind, n in e.kinds.items() if kind not in PROOFS)
        ours.append(pose_errors(np.array([end.pose for end in ends]), some.after).mean(0))
        other.append(pose_errors(some.published, some.after).mean(0))
    units = np.array([1e3, np.degrees(1.0)])
    return units * np.mean(ours, axis=0), units * np.mean(other, axis=0), unproved


PROOFS = ("exact", "enclosure")


def evidence() -> list[Comparison]:
    """A hundredth of the pushes in two cones."""
    ours, other, unproved = errors("ellipsoid")
    pyramid, _, also = errors("pyramid")
    return [
        comparison("steps without a proof [-]", [unproved, also], 0.0, 0.0),
        within("mean error of the place less the published simulator's [mm]",
               ours[0] - other[0], -MORE_MM, MORE_MM),
        within("mean error of the angle less the published simulator's [deg]",
               ours[1] - other[1], -MORE_DEG, MORE_DEG),
        within("pyramid's error of the place over the ellipsoid's [-]", pyramid[0] / ours[0],
               WORSE, np.inf),
        within("pyramid's error of the angle over the ellipsoid's [-]", pyramid[1] / ours[1],
               WORSE, np.inf),
    ]  # fmt: skip


CLAIM = Claim(
    name="measured_pushes",
    sentence="With one number for each object and surface, mu_omega / mu_v, which measured loads "
    "alone identify, the ellipsoid predicts measured pushes about as well as the simulator "
    "that was published for these pushes; the pyramid does not.",
    where="docs/reality.md; data of Yu, Bauza, Fazeli & Rodriguez (2016), as processed by Zhou et "
    "al. (2017)",
    sweep="every hundredth push of 18 pairs of object and surface, steps of 2 mm; all of them: "
    "`validate reality`",
    reason="MORE_MM, MORE_DEG and WORSE: what the scatter of so few pushes leaves. A step without "
    "a proof would leave open whether the model or its solver errs.",
    measure=evidence,
)

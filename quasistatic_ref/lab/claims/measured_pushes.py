"""Measured pushes, predicted with friction that was identified from measured loads alone."""

import numpy as np

from quasistatic_ref.lab.claims.claim import Claim, Comparison, comparison, within
from quasistatic_ref.lab.reality.measurements import pairs_read
from quasistatic_ref.lab.reality.run import PROOFS, predicted_pushes
from quasistatic_ref.lab.reality.settings import Settings

EVERY, ADVANCE = 100, 2e-3
"""Of the pushes of each pair; the finger's way in a step [m]."""

MORE_MM, MORE_DEG = 0.6, 0.9
"""Most by which the mean error may differ from the published simulator's: errors of a push differ
between the two by so much that the mean over 60 pushes scatters by 0.2 mm and 0.3 degrees; three
times that."""

WORSE = 1.5
"""Least ratio of the pyramid's errors to the ellipsoid's [-]: below it the sample does not tell the
two cones apart, since the mean of either scatters by a tenth."""


def record_of(cone: str) -> tuple[list[float], list[float], int]:
    """Mean errors of the model and of the published simulator, over pairs, and steps unproved.

    Errors are of the place and of the angle [mm, deg].
    """
    record, _ = predicted_pushes(Settings(cone=cone, advance=ADVANCE), pairs_read(), EVERY)
    errors = record["pairs"]["all"]
    unproved = sum(count for kind, count in record["steps"].items() if kind not in PROOFS)
    return errors["error"]["mean"], errors["published"]["mean"], unproved


def evidence() -> list[Comparison]:
    """Errors of predicted end poses of a hundredth of the pushes, in two cones."""
    ours, other, unproved = record_of("ellipsoid")
    pyramid, _, also = record_of("pyramid")
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

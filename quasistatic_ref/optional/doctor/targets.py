"""Targets, joints and forces beyond the limits of a URDF, and columns of targets without effect."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.optional.doctor.measures import drive, stiffness
from quasistatic_ref.optional.doctor.run import Run
from quasistatic_ref.optional.doctor.telling import amount, rounded
from quasistatic_ref.optional.doctor.tolerances import BEYOND, IN_METRES
from quasistatic_ref.simulate.finding import Finding

SHARE = 1e-3
"""Of the way between a joint's limits, by which it may be beyond one [-]."""
MOST = {"m": 1e-4, "rad": 1e-3}
"""And the most that this may be [m, rad]."""
GROSS = 100.0
"""Force over effort that is grave [-]; an effort of 1, which many URDFs have for want of a number,
is asked no sooner."""


def beyond_limits(run: Run) -> Iterator[Finding]:
    """Targets beyond a limit that the URDF names, of each joint the farthest."""
    for joint, unit, target, limit, k in _beyond(run, "q_bar_a"):
        if unit == "rad" or abs(target) <= IN_METRES:  # else its unit is doubted already
            yield Finding(
                "target-beyond-a-limit",
                True,
                "change the target, or the limit in the URDF",
                f"the target of {joint.name} is {target:.6g} {unit} at step {k}, beyond its limit, "
                f"{limit:.6g} {unit}: the model ignores limits, the robot does not",
                {f"target_{unit}": target, f"limit_{unit}": limit, "step": k},
            )


def idle_columns(run: Run) -> Iterator[Finding]:
    """Columns of a table of targets whose numbers change, and no force does."""
    for name in run.idle_columns:
        yield Finding(
            "target-without-effect",
            True,
            f"drive another actuator than {name}, or look at its gain, ranges and group",
            f"the column {name} of the targets changes, and the forces of the scene at its start "
            "do not",
            {},
        )


def joints_beyond(run: Run) -> Iterator[Finding]:
    """Joints that are pushed beyond a limit that the URDF names, of each the farthest."""
    targeted = [joint for joint, *_ in _beyond(run, "q_bar_a")]  # which has a finding
    for joint, unit, position, limit, k in _beyond(run, "q"):
        if joint not in targeted:
            body = joint.name.partition("/")[0]
            yield Finding(
                "joint-beyond-a-limit",
                True,
                f'say bodies.{body}.joint_limits = "urdf", for stops at the limits',
                f"{joint.name} is at {position:.6g} {unit} at step {k}, beyond its limit, "
                f"{limit:.6g} {unit}, which the model ignores",
                {f"position_{unit}": position, f"limit_{unit}": limit, "step": k},
            )


def beyond_effort(run: Run) -> Iterator[Finding]:
    """Joints whose springs push harder than their motors can."""
    replaced = run.extension is not None and run.extension.without_stiffness
    K = stiffness(np.zeros((0, 0)) if replaced else run.simulator.K_q)
    for joint in run.system.joints:
        if not (joint.actuated and joint.effort < np.inf) or joint.v.start in run.bounded:
            continue
        did = drive(joint, run.trajectory, K)
        most = joint.effort * (GROSS if joint.effort == 1 else 1.0)
        if did.spring is None or (did.spring <= most).all():
            continue
        k = int(did.spring.argmax())
        unit = "N" if did.unit == "m" else "N m"
        softer = rounded(joint.effort / float(did.error[k]), np.floor)
        remedy = f"lower K_q of {joint.name} to {softer:.3g} {unit}/{did.unit}, move its target "
        remedy += "nearer, or correct its effort in the URDF"
        yield Finding(
            "force-beyond-a-limit",
            bool(did.spring[k] > GROSS * joint.effort),
            remedy,
            f"the spring of {joint.name} pushes with {did.spring[k]:.3g} {unit} at step {k}, "
            f"{amount(did.error[k], did.unit)} from its target, and its motor with "
            f"{joint.effort:.3g} {unit} at most, which the model ignores",
            {"force": float(did.spring[k]), "effort": joint.effort, "step": k},
            joint.name,
        )


def _beyond(run: Run, name: str) -> Iterator[tuple[Joint, str, float, float, int]]:
    """Joints beyond limits that nothing enforces: unit, position, limit and step.

    They are those of q, or of q_bar_a, that are farthest beyond. Springs give way: a joint may be
    beyond by little.
    """
    for joint in run.system.joints:
        if joint.limits is None or joint.v.start in run.bounded:
            continue
        if name == "q_bar_a" and not joint.actuated:
            continue
        unit = joint.coordinates[0].unit
        lower, upper = joint.limits
        at = run[name][:, joint.q][:, 0]
        within = np.clip(at, lower, upper)
        k = int(abs(at - within).argmax())
        if abs(at[k] - within[k]) > max(BEYOND, min(SHARE * (upper - lower), MOST[unit])):
            yield joint, unit, float(at[k]), float(within[k]), k

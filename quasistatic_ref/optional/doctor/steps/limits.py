"""Targets, joints and forces beyond the limits of a URDF, and columns of targets without effect."""

from collections.abc import Iterator

import numpy as np

from quasistatic_ref.model.joints.joint import Joint
from quasistatic_ref.optional.doctor.did.numbers import errors, stiffness
from quasistatic_ref.optional.doctor.frame.run import Run
from quasistatic_ref.optional.doctor.frame.tolerances import BEYOND, IN_METRES
from quasistatic_ref.optional.doctor.texts import amount, finding
from quasistatic_ref.simulate.finding import Finding

SHARE = 1e-3
"""Of the way between a joint's limits, by which it may be beyond one [-]."""
MOST_BEYOND = {"m": 1e-4, "rad": 1e-3}
"""And the most that this may be [m, rad]."""
GROSS = 100.0
"""Force over effort that is grave [-]; an effort of 1, which many URDFs have for want of a number,
is asked no sooner."""


def idle_columns(run: Run) -> Iterator[Finding]:
    """Columns of a table of targets whose numbers change, and no force does."""
    for name in run.idle_columns:
        cause = f"the column {name} of the targets changes, and the forces of the scene at its "
        cause += "start do not"
        remedy = f"drive another actuator than {name}, or look at its gain, ranges and group"
        yield finding("target-without-effect", cause, remedy)


def targets_beyond(run: Run) -> Iterator[Finding]:
    """Targets beyond a limit that the URDF names, of each joint the farthest."""
    for joint, at, says, numbers in _beyond(run, "q_bar_a"):
        if abs(at) * joint.lengths <= IN_METRES:  # else its unit is doubted already
            cause = f"the target of {joint.name} is {says}: the model ignores limits, the robot "
            cause += "does not"
            remedy = "change the target, or the limit in the URDF"
            yield finding("target-beyond-a-limit", cause, remedy, **numbers)


def joints_beyond(run: Run) -> Iterator[Finding]:
    """Joints that are pushed beyond a limit that the URDF names, of each the farthest."""
    targeted = [joint for joint, *_ in _beyond(run, "q_bar_a")]  # which has a finding
    for joint, _, says, numbers in _beyond(run, "q"):
        if joint not in targeted:
            body = joint.name.partition("/")[0]
            remedy = f'say bodies.{body}.joint_limits = "urdf", for stops at the limits'
            cause = f"{joint.name} is at {says}, which the model ignores"
            yield finding("joint-beyond-a-limit", cause, remedy, **numbers)


def _beyond(run: Run, name: str) -> Iterator[tuple[Joint, float, str, dict[str, float]]]:
    """Joints beyond limits that nothing enforces: position [m, rad], words and numbers.

    They are those of q, or of q_bar_a, that are farthest beyond. Springs give way: a joint may be
    beyond by little.
    """
    for joint in run.system.joints if name == "q" else run.actuated:
        if joint.limits is None or _bounded(run, joint):
            continue
        lower, upper = joint.limits
        at = run[name][:, joint.q][:, 0]
        within = np.clip(at, lower, upper)
        k = int(abs(at - within).argmax())
        unit = joint.coordinates[0].unit
        if abs(at[k] - within[k]) > max(BEYOND, min(SHARE * (upper - lower), MOST_BEYOND[unit])):
            says = f"{at[k]:.6g} {unit} at step {k}, beyond its limit, {within[k]:.6g} {unit}"
            yield joint, at[k], says, {f"at_{unit}": at[k], f"limit_{unit}": within[k], "step": k}


def _bounded(run: Run, joint: Joint) -> bool:
    """Whether rows of an extension bound a joint, such as its stops."""
    return bool(run.rows.A[:, joint.v.start].any())


def beyond_effort(run: Run) -> Iterator[Finding]:
    """Joints whose springs push harder than their motors can."""
    if run.extension is not None and run.extension.without_stiffness:
        return
    K = stiffness(run.simulator.K_q)
    for joint in run.actuated:
        name, effort, unit = joint.name, joint.effort, joint.coordinates[0].unit
        if effort == np.inf or len(joint.coordinates) > 1:
            continue
        error = errors(joint, run.trajectory)
        k = int(error.argmax())
        force = float(error[k] * K[joint.v.start])
        if force <= effort * (GROSS if effort == 1 else 1.0):
            continue
        of_force = "N" if unit == "m" else "N m"
        cause = f"the spring of {name} pushes with {force:.3g} {of_force} at step {k}, "
        cause += f"{amount(error[k], unit)} from its target, and its motor with "
        cause += f"{effort:.3g} {of_force} at most, which the model ignores"
        remedy = f"lower K_q of {name}, move its target nearer, or correct its effort in the URDF"
        numbers = {"force": force, "effort": effort, "step": k}
        grave = force > GROSS * effort
        yield finding("force-beyond-a-limit", cause, remedy, name, grave, **numbers)

"""A configuration q from outside, checked before anything is computed from it."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from quasistatic_ref.errors import ModelError
from quasistatic_ref.model.coordinates import Joint
from quasistatic_ref.step.arrays import Array, checked_numbers
from quasistatic_ref.step.ordered import length
from quasistatic_ref.tolerances import UNIT_QUATERNION, UNIT_ROUNDING

UNIT_PART = {"floating": 3, "planar": 2, "continuous": 0}
"""Where in a joint's entries of q its quaternion, or (cos, sin), begins."""

W_FIRST = [1.0, 0.0, 0.0, 0.0]
"""The quaternion of no turn where w comes first, as in MuJoCo and Drake."""


def configuration(joints: Sequence[Joint], n_q: int, q: ArrayLike) -> Array:
    """Copy of q, finite, of shape (n_q,), its quaternions of length one.

    Quaternions off by more than rounding are normalised; the others keep their bits, so that a
    recorded q replays as it was. (pinocchio and coal compute on with NaN and with a zero
    quaternion, and say nothing.)

    Raises
    ------
    ModelError
        If it is not a configuration; the message names the joint.
    """
    checked = checked_numbers(q, "q", ModelError) + 0.0
    if checked.shape != (n_q,):
        raise ModelError(f"must have shape ({n_q},)", field="q", value=checked.shape)
    for joint in joints:
        part = checked[joint.q]
        field = f"q[{joint.name}]"
        if not np.isfinite(part).all():
            raise ModelError("must be finite", field=field, value=part.tolist())
        if joint.kind not in UNIT_PART:
            continue
        unit = part[UNIT_PART[joint.kind] :]
        size = length(unit)
        if abs(size - 1) > UNIT_QUATERNION:
            what = "quaternion" if joint.kind == "floating" else "(cos, sin)"
            problem = f"its {what} must have length one"
            raise ModelError(problem, field=field, value=unit.tolist())
        if joint.kind == "floating" and unit.tolist() == W_FIRST:
            problem = (
                "looks like the identity as [w x y z]; quaternions are [x y z w], and the identity "
                "is [0 0 0 1] (half a turn about x is [1 0 0 1e-16])"
            )
            raise ModelError(problem, field=field, value=W_FIRST)
        if abs(size - 1) > UNIT_ROUNDING:
            unit /= size
    return checked

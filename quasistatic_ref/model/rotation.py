"""Roll, pitch and yaw, as URDF and scenarios give them."""

import numpy as np

from quasistatic_ref.numbers.angles import cos_sin
from quasistatic_ref.numbers.arrays import Array


def rotation(rpy: Array) -> Array:
    """Rotation Rz(yaw) Ry(pitch) Rx(roll), shape (3, 3), of roll, pitch, yaw (3,) [rad]."""
    (cr, sr), (cp, sp), (cy, sy) = map(cos_sin, rpy.tolist())
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def quaternion(rpy: Array) -> Array:
    """A rotation as a quaternion [x y z w], shape (4,)."""
    (cr, sr), (cp, sp), (cy, sy) = map(cos_sin, (rpy / 2).tolist())
    return np.array(
        [
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
            cr * cp * cy + sr * sp * sy,
        ]
    )

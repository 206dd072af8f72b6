"""Kinds of joints: each has a file, and a line here."""

from quasistatic_ref.model.joints.axis_joint import AxisJoint, Prismatic, Revolute
from quasistatic_ref.model.joints.ball import Ball
from quasistatic_ref.model.joints.continuous import Continuous
from quasistatic_ref.model.joints.floating import Floating
from quasistatic_ref.model.joints.planar import Planar
from quasistatic_ref.model.joints.twist_joint import TwistJoint

BASES: dict[str, type[TwistJoint]] = {"floating": Floating, "planar": Planar, "ball": Ball}
"""By the word that a body says of its base."""

JOINTS: dict[str, type[AxisJoint] | type[TwistJoint]] = {
    "revolute": Revolute,
    "continuous": Continuous,
    "prismatic": Prismatic,
    "ball": Ball,
}
"""By the word that a URDF says of a joint; the last is not URDF's."""

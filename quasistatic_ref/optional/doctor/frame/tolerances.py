"""Tolerances that several files of the doctor share."""

from typing import Final

BEARS: Final = 1e-9
"""Least normal force of a contact that bears load, over the largest normal force of its step [-]:
solvers leave 1e-12 of the largest on contacts that do not touch."""

BEYOND: Final = 1e-9
"""How far a target may exceed a limit of its URDF [m, rad] without a warning: rounding of its
interpolation between waypoints is 1e-16."""

IN_METRES: Final = 20.0
"""Size of a mesh or cloud, and largest coordinate of a target that is a length [m], up to which
numbers are taken for metres.

What hands hold is longer than 20 mm, mostly, and shorter than 20 m."""

NEAR: Final = 1e-3
"""Distance that counts as near [m]: what cameras and calibration leave open."""

SLIPPED: Final = 0.1
"""Slip of a grip that lost what it held, over the smaller shape of a pair [-]: a body that settles
between fingers slips by a hundredth of them."""

SUNK: Final = 0.01
"""Depth at a step, relative to the smaller shape of a pair [-], that the step before did not
predict and that is worth a warning: pushed out at once, it throws bodies about. The scenarios in
models/ stay below 1e-5; points that a pair's k leaves out sink by the size of its features."""

"""Tolerances that several files share, each with its reason.

A tolerance of one file stands in that file; those of the tests are in tests/.
"""

from typing import Final

ORTHONORMAL: Final = 1e-9
"""Largest entry of R'R - I for a contact frame R = [d1 d2 n], and of a rotation read from a file.

Frames computed in float64 reach 1e-15; ones that travelled as 10-digit text reach 1e-10."""

ACCURACY: Final = 1e-12
"""Default accuracy of every backend, in natural units [-].

With it Clarabel, DAQP and PIQP solve every step of ``bunny_grasp``, and so does OSQP, which is then
called with 1e-10, the least accuracy that the table of backends gives it."""

RESIDUAL_LIMIT: Final = 1e-6
"""Largest residual, in natural units [-], at which a solver's "optimal" is believed.

Six orders above the default accuracy: an answer beyond it is not a less exact answer but
a wrong one."""

LARGE: Final = 1e15
"""Largest number in a scenario, a URDF or a point cloud, in whatever unit.

Nothing that is simulated is larger; squares and fourth powers of it stay in float64's range."""

UNMOVED: Final = 1e-6
"""Displacement of the softest coordinate [m, rad] that errors are at least measured by: where
nothing happens, an answer that is off by 1e-14 m or rad has 8 digits. Steps that move are longer
(certify/norm.py)."""

ON_SURFACE: Final = 1e-12
"""Distance relative to a polytope's size below which its edges and corners count as its faces [-].

A direction computed from two points that near has fewer than four correct digits."""

OUTSIDE_FACE: Final = 1e-14
"""How far outside of the nearest face of a polytope a point projects onto its plane, relative to
the sizes, from which an edge or a corner is the nearest [-]: some ten roundings of coordinates.
Where it is less, the face's normal is as right as the direction of a difference of coordinates."""

UPRIGHT: Final = 1e-9
"""Tilt of a cylinder or a cone [rad] below which its rim counts as level.

The direction of its lowest point is then rounding; on a rim of 1 m all points are level to 1 nm."""

REPEATED: Final = 1e-9
"""Largest difference of distance and point [m] of candidates that are one contact.

Computed twice, one contact differs by 1e-16, or 3e-9 at worst between nearly parallel edges."""

FACING: Final = 0.25
"""Angle [rad] between a face and the face that it can lie on after a step: a step that turns by
more is worth a warning."""

OVER_FACE: Final = 1e-9
"""How far outside of a face the foot of a corner may be, relative to the shape's extent [-], for
the corner to be over the face: a body that is flush with another turns by about that."""

SKEW: Final = 1e-6
"""Sine of the angle between two edges or rims [-] up to which they have no crossing: its place is
known to rounding over that, and corners next to it bound the common area as well."""

SAME_NORMAL: Final = 1e-6
"""Largest difference of the components of two normals that count as one [-]: the coplanar
triangles of a mesh, or the face of one body and the face of another that lies flat on it."""

FILLED: Final = 1e6
"""Least distance [m] of a contact that stands for nothing.

It repeats one that is at most half as far, and so bears nothing however long the step is."""

CLOSED_FORM: Final = 1e-12
"""Largest difference of a certified step from its closed form, relative to the largest term.

The optimum is exact and rounded once; formula and data are a few dozen operations in float64."""

ON_RIM: Final = 1e-9
"""How near to the rim of a face or edge a closest point, relative to its shape, or a normal [-] is
on it. Closest points are right to 1e-15 but where the surfaces are nearly parallel."""

CREEP: Final = 1e-4
"""Speed up to which a contact of MuJoCo's holds [m/s]: 6 mm in a minute. Friction that is
regularised yields to any force, so that some speed has to count as none."""

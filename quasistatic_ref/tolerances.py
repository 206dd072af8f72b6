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

BORNE: Final = 1e-4
"""Share of the load [-] that forces of single contacts may leave without a finding."""

SURE: Final = 1e-3
"""Share of the load of a group [-] that noise in its gaps may change without a finding."""

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
"""Largest difference of distance [m], point [m] and normal [-] of candidates that are one contact.

Computed twice, one contact differs by 1e-16, or 3e-9 at worst between nearly parallel edges."""

FACING: Final = 0.25
"""Angle [rad] between a face and the face that it can lie on after a step: a step that turns by
more is worth a warning (LEAP)."""

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

BEARS: Final = 1e-9
"""Least normal force of a contact that bears load, over the largest normal force of its step [-]:
solvers leave 1e-12 of the largest on contacts that do not touch."""

SUNK: Final = 0.01
"""Depth at a step, relative to the smaller shape of a pair [-], that the step before did not
predict and that is worth a warning: pushed out at once, it throws bodies about. The scenarios in
models/ stay below 1e-5; points that a pair's k leaves out sink by the size of its features."""

LEAP: Final = 0.25
"""Motion per step, relative to the size of what is moved [-], or turn [rad], that is worth a
warning: to first order the motion is wrong by 1 - cos 0.25 = 3 % of the size. The spun sphere of
sphere_spin reaches 0.15."""

CRAWL: Final = 0.1
"""Speed [m/s, rad/s] up to which contacts that cannot rise may hold a body without a finding: what
is moved slowly enough for the model is slower."""

LOCKED: Final = 0.1
"""Share of the motion without a guide's own friction [-] below which a body is locked by it. A
block that begins to slide has 1 / (1 + mu_v^2) of it, one in a guide the guide's clearance."""

BEYOND: Final = 1e-9
"""How far a target may exceed a limit of its URDF [m, rad] without a warning: rounding of its
interpolation between waypoints is 1e-16."""

IN_METRES: Final = 20.0
"""Size of a mesh or cloud, and largest coordinate of a target that is a length [m], up to which
numbers are taken for metres.

What hands hold is longer than 20 mm, mostly, and shorter than 20 m."""

ON_RIM: Final = 1e-9
"""How near to the rim of a face or edge a closest point, relative to its shape, or a normal [-] is
on it. Closest points are right to 1e-15 but where the surfaces are nearly parallel."""

LEVEL: Final = 1e-5
"""Tilt of a cylinder or a cone [rad] below which its rim counts as level where a derivative is
computed. Its lowest point moves by 1 / tilt of a turn, right to 2e-16 / tilt of that; where it
cancels, errors were 1e-7 at a tilt of 3e-7, and fall with its square."""

LIGHT: Final = 1e-6
"""Mass of a private rise over that of what it lies on [-]: sliding is slower by as much, (R40)."""

NEAR: Final = 1e-3
"""Distance that counts as near [m]: what cameras and calibration leave open."""

TOUCHES: Final = 1e-9
"""Slack of a row of a contact that touches, at most [m]: certified steps leave rounding, 1e-16, and
a spring of 1e5 N/m presses 1e-9 m with 0.1 mN."""

SLIDES: Final = 1e-4
"""Slip of a contact that an account says slides, at least [m/s]: 1 mm in ten seconds."""

SPINS: Final = 1e-3
"""Turn about its normal of a contact that an account says spins, at least [rad/s]: 0.6 deg in ten
seconds."""

ROUGH: Final = 5.0
"""Friction coefficient above which a number is none [-]: racing tyres have 1.7."""

SLIPPED: Final = 0.1
"""Slip of a grip that lost what it held, over the smaller shape of a pair [-]: a body that settles
between fingers slips by a hundredth of them."""

LAGS: Final = 0.1
"""Distance of a joint from its last target, over the way that its target went [-], that is none of
a spring's usual lag."""

STALLED: Final = 0.25
"""Distance of a joint from its last target over the shape that presses [-], of what is to push."""

CREEP: Final = 1e-4
"""Speed up to which a contact of MuJoCo's holds [m/s]: 6 mm in a minute. Friction that is
regularised yields to any force, so that some speed has to count as none."""
